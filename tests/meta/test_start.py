"""The command starts with what it needs and nothing else, and JAX is set up whatever imports it first.

If one of these failed, `tethership --version` and every press of Tab would take seconds again, a room that is imported
first would compute in single precision, or two threads would meet a module half made.
"""

import ast
import os
import subprocess
import sys
import types
from pathlib import Path

import pytest

import tethership
from tethership._interrupt import _end_while_importing
from tethership._jax import computes
from tethership.cli import app

SOURCE = Path(tethership.__file__).parent

HEAVY = {"jax", "jaxlib", "pydantic", "numpy", "matplotlib", "scipy", "pandas", "xarray", "pint", "rich"}
"""None of these may be imported to tell what the command is."""

TYPER_S_OWN = {"pydantic"}
"""With this some versions of typer check values, of subcommands and where Tab is pressed: a twentieth of a second."""

RUN = """
import contextlib, io, sys
sys.argv = ["tethership", *{words!r}]
with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.suppress(SystemExit):
    from tethership.cli import main
    main()
print(out.getvalue()[:1000])
print(*sorted({{name.partition(".")[0] for name in sys.modules}}))
"""


def ran(*words, **variables):
    """Return what a command printed in a process of its own, and the packages that it imported."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith("JAX_ENABLE")}
    done = subprocess.run(
        [sys.executable, "-c", RUN.format(words=words)],
        env=kept | variables,
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    *printed, packages = done.stdout.splitlines()
    return "\n".join(printed), set(packages.split())


def test_the_version_imports_nothing_that_computes():
    printed, packages = ran("--version")
    assert printed.strip() == tethership.__version__
    assert packages & HEAVY == set()


def test_the_help_imports_nothing_that_computes():
    printed, packages = ran("--help")
    assert "dock" in printed
    assert packages & HEAVY == set()


@pytest.mark.parametrize("typed", ["tethership do", "tethership dock do", "tethership campaign gus"])
def test_a_press_of_tab_imports_nothing_that_computes(typed):
    """The shell asks by variables; names of packaged files are offered without reading what they mean."""
    place = str(len(typed.split()) - 1)
    asked = {"_TETHERSHIP_COMPLETE": "complete_bash", "COMP_WORDS": typed, "COMP_CWORD": place}
    printed, packages = ran(**asked)
    assert printed.split()[0].startswith(typed.split()[-1])
    assert packages & HEAVY <= TYPER_S_OWN


HELPS = """
import contextlib, io, sys
from tethership.cli import app, main
for registered in app.registered_commands:
    sys.argv = ["tethership", registered.name, "--help"]
    with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.suppress(SystemExit):
        main()
    assert f"Usage: tethership {registered.name} " in out.getvalue(), registered.name
print(*sorted({name.partition(".")[0] for name in sys.modules}))
"""


def test_no_command_s_help_imports_what_computes():
    done = subprocess.run([sys.executable, "-c", HELPS], capture_output=True, text=True, timeout=120, check=True)
    assert set(done.stdout.split()) & HEAVY <= TYPER_S_OWN
    assert len(app.registered_commands) > 14


def test_a_trim_imports_what_it_needs():
    printed, packages = ran("trim", "--wind", "7")
    assert printed.startswith("converged")
    unneeded = {"matplotlib", "plotly", "dash", "pandas", "xarray", "h5py", "h5netcdf", "pint", "diffrax", "zarr"}
    assert packages & unneeded == set()


ROOMS = """
import importlib, os, sys
for room in {rooms!r}:
    child = os.fork()
    if not child:
        face = importlib.import_module(room)
        for name in getattr(face, '__all__', ()):
            getattr(face, name)
            if "jax" in sys.modules:
                break
        import jax, jax.numpy
        os._exit(0 if jax.numpy.ones(1).dtype == "float64" and jax.config.jax_compilation_cache_dir else 1)
    assert os.waitpid(child, 0)[1] == 0, room
"""


def double(rooms):
    """Check that each of some rooms has double precision where it is imported first, in a process of its own."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("JAX_", "XLA_"))}
    code = "import tethership" + ROOMS.format(rooms=rooms)
    subprocess.run([sys.executable, "-c", code], env=kept, check=True, timeout=600)


def test_precision_is_double_whatever_is_imported_first():
    double(["tethership", "tethership.spatial", "tethership.scenario", "tethership.physics.gust"])


@pytest.mark.slow
def test_precision_is_double_whatever_room_is_imported_first():
    rooms = [f"tethership.{face.parent.name}" for face in sorted(SOURCE.glob("*/__init__.pyi"))]
    assert len(rooms) > 10
    double(rooms)


@pytest.mark.parametrize("first", ["import jax", "import jax.numpy", "import equinox"])
def test_precision_is_double_where_jax_was_there_before(first):
    code = f"{first}; import tethership, jax.numpy as jnp; print(jnp.ones(1).dtype)"
    assert subprocess.check_output([sys.executable, "-c", code], text=True) == "float64\n"


def imported_at_once(tree):
    """Yield the packages that a module imports when it is imported itself; functions and type checking come later."""
    for node in tree.body:
        if isinstance(node, ast.Import):
            yield from (name.name.partition(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield (node.module or "").partition(".")[0]


USERS = {*HEAVY, "equinox", "diffrax", "optimistix", "jaxtyping", "h5py"}
"""JAX, numpy, and what imports them."""


def test_what_computes_is_known():
    """JAX is imported as a whole before such a module, so that no thread meets it or numpy half made."""
    unknown = []
    for file in SOURCE.rglob("*.py"):
        parts = file.relative_to(SOURCE.parent).with_suffix("").parts
        name = ".".join(part for part in parts if part != "__init__")
        needs_it = USERS & set(imported_at_once(ast.parse(file.read_text(encoding="utf-8"))))
        if needs_it and not computes(name):
            unknown.append(name)
    assert unknown == []


THREADS = """
import sys, threading
import tethership as ts
sys.setswitchinterval(1e-5)
names = ["Wrench", "LinearModel", "Scenario", "AbstractPart", "TrimOutcome", "AbstractLaw", "plant", "load_scenario"]
begun, faults = threading.Barrier(4), []

def touch(which):
    begun.wait()
    for name in names[which::4]:
        try:
            getattr(ts, name)
        except BaseException as error:
            faults.append(f"{name}: {error!r}")

threads = [threading.Thread(target=touch, args=(which,)) for which in range(4)]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
print(*faults, sep="\\n")
"""


def test_threads_may_touch_the_library_first():
    """Python lets two threads into JAX at once ("partially initialized", "deadlock detected"); here one waits."""
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", THREADS], capture_output=True, text=True, timeout=120, check=True)
        assert done.stdout.strip() == "", done.stderr


def test_an_interrupt_is_told_while_a_module_is_loaded_later(monkeypatch):
    """Once the command runs, Ctrl-C is Python's own, but in the middle of an import."""
    ended = []
    monkeypatch.setattr("tethership._interrupt._end", lambda *_: ended.append("told"))
    with pytest.raises(KeyboardInterrupt):
        _end_while_importing(2, sys._getframe())
    assert ended == []
    importing = types.SimpleNamespace(
        f_code=types.SimpleNamespace(co_filename="<frozen importlib._bootstrap>"), f_back=None
    )
    inside = types.SimpleNamespace(f_code=types.SimpleNamespace(co_filename="numpy.py"), f_back=importing)
    with pytest.raises(KeyboardInterrupt):  # the process would have ended
        _end_while_importing(2, inside)
    assert ended == ["told"]


INTERRUPTED_LATER = """
import os, signal, sys
sys.argv = ["tethership", "trim"]
class Interrupt:
    def find_spec(self, name, *_):
        if name == "jax.numpy":
            os.kill(os.getpid(), signal.SIGINT)
from tethership.cli import main
sys.meta_path.insert(0, Interrupt())
main()
"""


def test_interrupt_while_a_command_loads():
    done = subprocess.run(
        [sys.executable, "-c", INTERRUPTED_LATER], capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr == "tethership: interrupted while it was being loaded\n"
