"""Jobs of a study: order, reuse, what makes them be done again. Real processes."""

import json
import sys
from pathlib import Path

import pytest

from tethership.studies.docking_paper.jobs import Job, Settings, belongs, load_part, plain, run_jobs

pytestmark = pytest.mark.slow

MODULE = """
import time
from pathlib import Path

def note(folder, name):
    with (folder / "calls.txt").open("a") as file:
        file.write(name + "\\n")

def first(folder, settings):
    note(folder, "first")
    (folder / "made.txt").write_text("here")
    return {"seed": settings.seed, "files": ["made.txt"], "bad": float("nan")}

def second(folder, settings):
    import json
    note(folder, "second")
    known = json.loads((folder / "parts" / "first.json").read_text())["result"]
    return {"double": 2 * known["seed"]}

def failing(folder, settings):
    raise ValueError("no such luck")
"""


@pytest.fixture
def jobs(tmp_path, monkeypatch):
    """Two jobs, one needing the other, in a module that a fresh process can import."""
    (tmp_path / "study_jobs.py").write_text(MODULE)
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    sys.modules.pop("study_jobs", None)
    import study_jobs

    return {"second": Job(study_jobs.second, ("first",), "two"), "first": Job(study_jobs.first, (), "one")}


def calls(folder: Path) -> list[str]:
    return (folder / "calls.txt").read_text().split()


def test_order_reuse_and_repetition(jobs, tmp_path):
    """Needs come first; nothing is done twice; a setting or a missing file makes a job, and its dependants, anew."""
    folder = tmp_path / "out"
    seen = []
    anew = run_jobs(jobs, folder, Settings("published"), lambda title, share: seen.append((title, share)))
    assert anew == {"first": True, "second": True}
    assert calls(folder) == ["first", "second"]
    assert seen == [("one", 0.5), ("two", 1.0)]
    assert load_part(folder, "second") == {"double": 2}
    assert load_part(folder, "first")["bad"] is None
    assert not any(run_jobs(jobs, folder, Settings("published")).values())
    assert len(calls(folder)) == 2
    (folder / "made.txt").unlink()
    assert run_jobs(jobs, folder, Settings("published")) == {"first": True, "second": True}
    assert run_jobs(jobs, folder, Settings("published", seed=4)) == {"first": True, "second": True}
    assert load_part(folder, "second") == {"double": 8}


def test_after_only_orders(jobs, tmp_path):
    """A job that comes after another is not done again for it, and does not ask for it."""
    make = jobs["first"].function
    later = {"a": Job(make, (), "one", after=("b",)), "b": Job(make, (), "two")}
    folder, seen = tmp_path / "both", []
    run_jobs(later, folder, Settings("published"), lambda title, share: seen.append(title))
    assert seen == ["two", "one"]
    (folder / "parts" / "b.json").unlink()
    assert run_jobs(later, folder, Settings("published")) == {"a": False, "b": True}
    assert run_jobs({"a": later["a"]}, tmp_path / "one", Settings("published")) == {"a": True}


def test_a_failure_keeps_what_was_done(jobs, tmp_path):
    """A job that raises ends the study with its own error; results before it stand."""
    import study_jobs

    folder = tmp_path / "out"
    broken = {**jobs, "third": Job(study_jobs.failing, ("second",), "three")}
    with pytest.raises(ValueError, match="no such luck"):
        run_jobs(broken, folder, Settings("published"))
    assert load_part(folder, "second") == {"double": 2}
    assert not any(run_jobs(jobs, folder, Settings("published")).values())


def test_plain_data():
    """Everything becomes JSON; what is not finite becomes null."""
    import numpy as np

    value = plain({"a": np.array([1.0, np.nan]), 2: (np.float64(3.0), None, 1 + 2j), "t": np.bool_(True)})
    assert json.loads(json.dumps(value)) == {"a": [1.0, None], "2": [3.0, None, [1.0, 2.0]], "t": True}


def test_parts_of_one_study_belong_together(jobs, tmp_path, monkeypatch):
    """A part made with another seed belongs to the study still; of another formulation or by other code it does not."""
    folder = tmp_path / "out"
    run_jobs(jobs, folder, Settings("published", seed=2))
    assert belongs(folder, "second", Settings("published", seed=7))
    assert not belongs(folder, "second", Settings("consistent", seed=2))
    assert not belongs(folder, "third", Settings("published", seed=2))
    monkeypatch.setattr("tethership.studies.docking_paper.jobs.source_digest", lambda: "other code")
    assert not belongs(folder, "second", Settings("published", seed=2))
