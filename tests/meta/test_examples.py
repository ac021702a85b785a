"""Every example runs as a user would run it and leaves its figure.

If one failed, the ladder of examples would have a broken rung.
"""

import runpy
from pathlib import Path

import pytest

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.py"))


def test_there_are_examples():
    assert EXAMPLES


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example(path, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(path), run_name="__main__")
    assert (tmp_path / "out" / f"{path.stem}.png").stat().st_size > 5000
    assert len(path.read_text().splitlines()) <= 40
