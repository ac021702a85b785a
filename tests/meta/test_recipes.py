"""The developer's recipes, done in a temporary folder as a reader would: what each touches, and that it works.

A recipe that needs a fourth file, or a list to be kept by hand somewhere in the package, would show here.
"""

import re
import shlex
import sys
from pathlib import Path

import numpy as np
import pytest

import tethership as ts
from tethership.cli import main

PAGE = Path(__file__).parents[2] / "docs" / "developer" / "recipes.md"
RECIPES = ("a load", "a part with states", "a sensor", "a control law", "a line model")
MOST_FILES = 3


def blocks(title):
    """Return kind and text of the blocks of a recipe, dedented as the page's lists indent them."""
    section = re.search(
        rf"^## Add {title}$(.*?)(?=^## |\Z)", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    found = re.findall(r"^( *)```(python|toml|sh)\n(.*?)^ *```$", section[1], re.MULTILINE | re.DOTALL)
    return [(kind, re.sub(rf"^{indent}", "", text, flags=re.MULTILINE)) for indent, kind, text in found]


def done(title, folder, monkeypatch):
    """Lay the files of a recipe, run its commands and its tests, and return the files."""
    monkeypatch.chdir(folder)
    monkeypatch.syspath_prepend(str(folder))
    laid, ran = [], 0
    for kind, text in blocks(title):
        if kind == "sh":
            for line in text.splitlines():
                ran += 1
                monkeypatch.setattr(sys, "argv", shlex.split(line))
                with pytest.raises(SystemExit) as end:
                    main()
                assert end.value.code == 0, line
            continue
        name = re.match(r"# (\w+\.(?:py|toml))$", text.splitlines()[0])
        assert name, f"a block of {title} names no file"
        (folder / name[1]).write_text(text, encoding="utf-8")
        laid.append(name[1])
    assert ran > 0
    for name in laid:
        if name.startswith("test_"):
            space = {}
            exec(compile((folder / name).read_text(encoding="utf-8"), name, "exec"), space)
            tests = [function for key, function in space.items() if key.startswith("test_")]
            assert tests
            for test in tests:
                test()
    return laid


@pytest.mark.slow
@pytest.mark.parametrize("title", RECIPES)
def test_a_recipe_works_and_touches_at_most_three_files(title, tmp_path, monkeypatch, is_whole):
    laid = done(title, tmp_path, monkeypatch)
    assert len(laid) <= MOST_FILES
    assert sum(name.endswith(".toml") for name in laid) == 1
    flights = list(tmp_path.glob("*/flight.nc"))
    assert len(flights) == 1
    data = ts.Flight.load(flights[0]).data
    match title:
        case "a load":
            drag = data["load_force"].sel(load="drogue").values
            assert np.linalg.norm(drag, axis=1).max() > 1.0
        case "a part with states":
            fill = data["part_states"].sel(part_state="chute.fill").values
            assert 0.0 < fill.min() < fill.max() < 1.0
        case "a sensor":
            shown = data["readings"].sel(reading="altimeter").values
            assert np.abs(shown + data["position"].values[:, 2]).max() < 2.0
        case "a control law":
            assert "climb" in ts.load_scenario("climb.toml", trust=True).law().names
        case "a line model":
            assert ts.Flight.load(flights[0]).attributes["line"] == {"nose": {"model": "spring:Spring"}}
    for written in ("docking.png", "replay.html"):
        assert is_whole(flights[0].parent / written)
    for name in laid:
        sys.modules.pop(name.removesuffix(".py"), None)
