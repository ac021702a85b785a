"""Values changed by dotted names: `*` for every item of a list, a number for a component of a vector.

Truth: the numbers that were asked for. If this fails, `--set` moves another number than the one it names.
"""

import pytest

import tethership as ts


def test_items_stay_apart_after_a_table_for_all():
    """One table given to all is not one and the same: a later change of one cable leaves the other."""
    both = ts.load_scenario("side_cables", {"cables.*.line": {"model": "catenary"}})
    name = both.config.cables[0].name
    one = both.changed({f"cables.{name}.line.model": "published"})
    assert [cable.line.model for cable in one.config.cables] == ["published", "catenary"]


def test_component_keeps_the_unit_of_its_vector():
    """The offset is written in degrees; a bare number is SI."""
    before = ts.load_scenario("docking").config.start.attitude_offset
    after = ts.load_scenario("docking", {"start.attitude_offset.1": 0.2}).config.start.attitude_offset
    assert after[1] == pytest.approx(0.2, rel=1e-15)
    assert (after[0], after[2]) == (before[0], before[2])


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("cables.nose.anchor.²", 1.0, r"docking: cables\.nose\.anchor"),
        ("cables.nose.anchor.0", {"value": 1.0}, r"'cables\.nose\.anchor\.0': the unit is missing or no text"),
        ("cables.nose.anchor.0", {"value": 1.0, "unit": "kg"}, r"the unit is 'kg', which is no 'm'"),
        ("cables.nose.line.model", "ppublished", r"line: give 'model' as one of .*; did you mean 'published'\?"),
    ],
)
def test_refused_in_one_line(name, value, message):
    with pytest.raises(ts.ConfigError, match=message):
        ts.load_scenario("docking", {name: value})
