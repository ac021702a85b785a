"""A few whole flights keep their numbers. They prove sameness, not truth: the truth is in validation and property.

If this fails, a number of every user changed: find out why, and enter it in CHANGELOG.md, *Numbers that changed*.
"""

import copy
import importlib.util
import json
from pathlib import Path

import pytest

spec = importlib.util.spec_from_file_location("regenerate", Path(__file__).parent / "regenerate.py")
regenerate = importlib.util.module_from_spec(spec)
spec.loader.exec_module(regenerate)

REFERENCE = json.loads(regenerate.REFERENCE.read_text())


@pytest.mark.parametrize("name", regenerate.CASES)
def test_flight(name):
    assert regenerate.differences(regenerate.flown(name), REFERENCE[name]) == []


def test_this_test_can_fail():
    """One metric off by one per cent, or another outcome, is noticed."""
    name = next(iter(REFERENCE))
    moved = copy.deepcopy(REFERENCE[name])
    moved["tension_max"] *= 1.01
    assert len(regenerate.differences(moved, REFERENCE[name])) == 1
    moved = {**REFERENCE[name], "outcome": "diverged"}
    assert len(regenerate.differences(moved, REFERENCE[name])) == 1
