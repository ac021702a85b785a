"""Every example runs as a user would run it and leaves its figure.

If one failed, the ladder of examples would have a broken rung.
"""

import runpy
from pathlib import Path

import matplotlib.figure
import numpy as np
import pytest

pytestmark = pytest.mark.slow

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.py"))


def drawn(axes):
    """Return how many lines, markers, areas and pictures of an axes have at least two finite points that differ."""
    lines = [np.column_stack(line.get_data()) for line in axes.lines]
    areas = [np.vstack([path.vertices for path in one.get_paths()] or [[]]) for one in axes.collections]
    markers = [np.ma.filled(one.get_offsets(), np.nan) for one in axes.collections]
    bars = [
        patch.get_path().vertices * [patch.get_width(), 1.0] for patch in axes.patches if hasattr(patch, "get_width")
    ]
    points = [np.asarray(one, float) for one in (*lines, *areas, *markers, *bars) if np.ndim(one) == 2]
    finite = [one[np.isfinite(one).all(axis=1)] for one in points if one.shape[1] == 2]
    return sum(len(np.unique(one, axis=0)) > 1 for one in finite) + len(axes.images)


@pytest.fixture
def figures(monkeypatch):
    """Every figure that is saved, by the name of its file."""
    saved = {}
    save = matplotlib.figure.Figure.savefig

    def keep(figure, name, **options):
        saved[Path(name).name] = figure
        save(figure, name, **options)

    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", keep)
    return saved


def test_there_are_examples():
    assert EXAMPLES


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example(path, tmp_path, monkeypatch, figures):
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(path), run_name="__main__")
    assert (tmp_path / "out" / f"{path.stem}.png").read_bytes().startswith(b"\x89PNG")
    axes = [one for one in figures[f"{path.stem}.png"].axes if one.axison]
    assert axes
    assert [one.get_title() for one in axes if not drawn(one)] == []
    assert any(one.get_xlabel() or one.get_ylabel() or one.get_title() for one in axes)
    assert len(path.read_text().splitlines()) <= 40
