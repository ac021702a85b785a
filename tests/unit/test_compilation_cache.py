"""Compiled programs are kept, whatever was imported before.

Truth: the files of an empty compilation cache after a program with a run-time check was compiled. If this fails, every
start of a user who imports diffrax first compiles everything again and takes three times as long.
"""

import os
import subprocess
import sys
import types

import pytest

from tethership._cache import checks_without_callbacks

PROGRAM = """
import {first}
import tethership
import equinox as eqx
import jax.numpy as jnp

@eqx.filter_jit
def guarded(x):
    return eqx.error_if(x, x < 0, "negative")

print(guarded(jnp.array(-1.0)))
"""


def run(first, folder, **variables):
    """Return the process and the kept programs that are called `guarded`."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("EQX_", "JAX_"))}
    place = {
        "JAX_COMPILATION_CACHE_DIR": str(folder),
        "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0",
        "JAX_PERSISTENT_CACHE_MIN_ENTRY_SIZE_BYTES": "-1",
    }
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM.format(first=first)],
        env=kept | place | variables,
        capture_output=True,
        text=True,
        check=False,
    )
    return done, sorted(path.name for path in folder.glob("jit_guarded*-cache"))


@pytest.mark.parametrize("first", ["tethership", "equinox", "diffrax"])
def test_programs_are_kept_whatever_is_imported_first(first, tmp_path):
    done, kept = run(first, tmp_path)
    assert done.stdout == "nan\n", done.stderr
    assert len(kept) == 1


def test_what_the_user_sets_stays(tmp_path):
    done, kept = run("equinox", tmp_path, EQX_ON_ERROR="raise")
    assert done.returncode != 0
    assert "negative" in done.stderr
    assert kept == []  # and this is what the test above would see


def test_an_equinox_that_cannot_be_told_is_a_warning(monkeypatch):
    monkeypatch.delenv("EQX_ON_ERROR", raising=False)
    monkeypatch.setitem(sys.modules, "equinox", types.ModuleType("equinox"))
    monkeypatch.setitem(sys.modules, "equinox._errors", types.ModuleType("equinox._errors"))
    with pytest.warns(UserWarning, match="import tethership first, or set EQX_ON_ERROR=nan"):
        checks_without_callbacks()
