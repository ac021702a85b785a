"""Every number of a scenario has one dotted name, its SI unit, and can be set by it.

Truth: the validated tables walked in another way (`model_dump`), and the units as the packaged files write them.
If this fails, a sweep or a sensitivity moves another number than the one it names, in another unit, or a number too
many.
"""

import copy
import tomllib

import jax
import pytest

import tethership as ts
from tethership.scenario.load import from_document, list_packaged, packaged_text
from tethership.scenario.parameters import ALIASES, TIED, find_parameter
from tethership.scenario.quantity import ANGLE_UNITS, unit_registry

SCENARIOS = list_packaged()["scenarios"]


def numbers(value, path=()):
    """Yield dotted name and value of every float of plain nested data; items of lists by name where they have one."""
    if isinstance(value, float):
        yield ".".join(path), value
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from numbers(item, (*path, key))
    elif isinstance(value, list | tuple):
        for index, item in enumerate(value):
            label = item.get("name", str(index)) if isinstance(item, dict) else str(index)
            yield from numbers(item, (*path, label))


def quantities(value, path=()):
    """Yield dotted name, number and unit of every datum of a TOML document."""
    if isinstance(value, dict) and "unit" in value:
        for name, number in numbers(value["value"], path):
            yield name, number, value["unit"]
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from quantities(item, (*path, key))
    elif isinstance(value, list):
        for index, item in enumerate(value):
            label = item.get("name", str(index)) if isinstance(item, dict) else str(index)
            yield from quantities(item, (*path, label))


def single(config):
    """Return the parameters that are no `*` name."""
    return {name: p for name, p in ts.list_parameters(config).items() if "*" not in name}


def changed_names(old, new):
    """Return the names, `*` names left out, whose values differ."""
    before, after = single(old.config), single(new.config)
    return {name for name in before if after[name].value != before[name].value}


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_number_is_listed_once(name):
    config = ts.load_scenario(name).config
    listed = single(config)
    expected = dict(numbers(config.model_dump()))
    assert set(listed) == set(expected) - set(TIED)
    for dotted, parameter in listed.items():
        assert parameter.name == dotted
        assert parameter.value == expected[dotted]
    places = [place for parameter in listed.values() for place in parameter.places]
    floats = [i for i, leaf in enumerate(jax.tree_util.tree_leaves(config)) if type(leaf) is float]
    assert sorted(places) == floats


@pytest.mark.parametrize("name", SCENARIOS)
def test_units_are_those_of_the_file(name):
    document = tomllib.loads(packaged_text("scenarios", name))
    changed = set(document.pop("changes", {}))
    document["vehicle"] = tomllib.loads(packaged_text("vehicles", document["vehicle"]))
    listed = single(ts.load_scenario(name).config)
    checked = 0
    for dotted, number, unit in quantities(document):
        parameter = listed.get(TIED.get(dotted, dotted))
        assert parameter is not None, dotted
        if dotted in changed:
            continue
        plain = {"1": "dimensionless"}
        si = unit_registry().Quantity(number, plain.get(unit, unit)).m_as(plain.get(parameter.unit, parameter.unit))
        assert parameter.value == pytest.approx(si, rel=1e-14, abs=1e-300)  # one rounding of the conversion
        # to pint angles are plain numbers: they are told apart here
        assert (unit in ANGLE_UNITS) == (parameter.unit == "rad")
        checked += 1
    assert checked > 90  # a vehicle alone has as many


UNITS = {
    "wind.speed": "m/s",
    "vehicle.body.mass": "kg",
    "vehicle.body.inertia.0.2": "kg m^2",
    "vehicle.fins.*.lift_slope": "1/rad",
    "trim.elevation": "rad",
    "trim.elongation": "1",
    "trim.velocity.0": "m/s",
    "cables.nose.tether_point.0": "m",
    "cables.nose.linear_density": "kg/m",
    "control.attitude.roll_share.port_up": "1",
    "control.rewind.gain": "m/(s N)",
}


@pytest.mark.parametrize("name", UNITS)
def test_unit(docking, name):
    assert ts.list_parameters(docking.config)[name].unit == UNITS[name]


def test_unit_of_an_optional_vector():
    # `position` may be absent: its unit stands deeper in the annotation
    parameter = ts.list_parameters(ts.load_scenario("hover").config)["trim.position.2"]
    assert (parameter.unit, parameter.value) == ("m", -50.0)


def test_star_only_where_all_agree(docking):
    known = ts.list_parameters(docking.config)
    assert known["vehicle.fins.*.area"].value == 2.88
    assert len(known["vehicle.fins.*.area"].places) == 4
    assert len(known["vehicle.thrusters.*.nominal_thrust"].places) == 6
    assert "vehicle.fins.*.roll" not in known  # 0°, 90°, 180°, 270°
    assert "vehicle.thrusters.*.position.0" not in known
    assert "cables.*.length" not in known  # one cable: its own name is enough
    other = ts.list_parameters(ts.scenario_at(docking, {"vehicle.fins.fin_top.area": 3.0}).config)
    assert "vehicle.fins.*.area" not in other
    assert "vehicle.fins.*.lift_slope" in other
    assert len(ts.list_parameters(ts.load_scenario("side_cables").config)["cables.*.diameter"].places) == 2


def test_aliases(docking):
    known = ts.list_parameters(docking.config)
    for short, full in ALIASES.items():
        assert find_parameter(known, short, "docking") is known[full]


@pytest.mark.parametrize(
    ("asked", "moved"),
    [
        ("wind.speed", {"wind.speed"}),
        ("wind", {"wind.speed"}),
        ("cables.nose.tether_point.2", {"cables.nose.tether_point.2"}),
        ("trim.velocity.1", {"trim.velocity.1"}),  # a default that the file does not write
        ("vehicle.thrusters.port_up.position.1", {"vehicle.thrusters.port_up.position.1"}),
        ("control.attitude.roll_share.port_up", {"control.attitude.roll_share.port_up"}),
        ("vehicle.fins.*.area", {f"vehicle.fins.fin_{side}.area" for side in ("starboard", "bottom", "port", "top")}),
        ("vehicle.body.inertia.0.2", {"vehicle.body.inertia.0.2"}),
        ("vehicle.body.inertia.2.0", {"vehicle.body.inertia.0.2"}),
        ("vehicle.apparent_mass.k3", {"vehicle.apparent_mass.k2"}),
    ],
)
def test_only_what_is_named_moves(docking, asked, moved):
    value = find_parameter(ts.list_parameters(docking.config), asked, "docking").value
    there = ts.scenario_at(docking, {asked: value + 0.0625})
    assert changed_names(docking, there) == moved
    for name in moved:
        assert single(there.config)[name].value == value + 0.0625
    # the document is the file of that scenario
    assert from_document(there.document, "again").config == there.config


def test_tied_numbers_move_together(docking):
    body = ts.scenario_at(docking, {"vehicle.body.inertia.0.2": -90.0}).config.vehicle.body
    assert body.inertia[0][2] == body.inertia[2][0] == -90.0
    apparent = ts.scenario_at(docking, {"vehicle.apparent_mass.k2": 0.9}).config.vehicle.apparent_mass
    assert apparent.k2 == apparent.k3 == 0.9


def test_the_plant_is_built_anew(docking):
    there = ts.scenario_at(docking, {"vehicle.body.mass": 150.0})
    assert float(there.system.ship.gravity.mass) == 150.0


def test_what_was_given_is_not_changed(docking):
    document, config = copy.deepcopy(docking.document), docking.config.model_copy(deep=True)
    ts.scenario_at(docking, {"cables.nose.tether_point.0": 6.0, "vehicle.fins.*.area": 3.0, "wind": 9.0})
    assert docking.document == document
    assert docking.config == config


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"wind.speed": -1.0}, r"docking: wind\.speed: it is -1 m/s; it must be at least 0"),
        ({"cables.nose.length": 0.0}, r"cables\.nose\.length: it is 0 m; it must be above 0"),
        ({"trim.elevation": 2.0}, r"trim\.elevation: it is 2 rad; it must be at most 1\.57"),
        ({"vehicle.body.mass": float("nan")}, r"body\.mass: the value is nan, not a finite number"),
        ({"vehicle.body.inertia.0.2": -1e4}, r"inertia is not positive definite"),
        ({"vehicle.thrusters.tail_down.direction.0": 0.5}, r"direction has length 1\.118"),
        ({"cables.nose.joint_start": 1.2}, r"joint_start 1\.2 and joint_end 1\.05"),
    ],
)
def test_bounds_of_the_file_hold(docking, values, message):
    with pytest.raises(ts.ConfigError, match=message):
        ts.scenario_at(docking, values)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ("wnd.speed", r"scenario docking has no number 'wnd\.speed'; nearest: wind\.speed"),
        ("cables.nose.lengthe", r"no number 'cables\.nose\.lengthe'; nearest: cables\.nose\.length,"),
        ("vehicle.fin.*.area", r"nearest: vehicle\.fins\.\*\.area"),
        ("vehicle.body.weight", r"nearest: .*A dotted name of its file is meant, e\.g\. wind\.speed"),
        ("xyzzy", r"no number 'xyzzy'\. A dotted name"),
        ("trim.hold", r"no number 'trim\.hold'"),  # it is a word, not a number
        ("", r"no number ''"),
    ],
)
def test_unknown_names_offer_the_nearest(docking, asked, message):
    with pytest.raises(ts.ConfigError, match=message):
        ts.scenario_at(docking, {asked: 1.0})


def test_tables_left_to_their_defaults_can_be_changed():
    """`hover` says nothing of its air: its numbers are parameters all the same."""
    warmer = ts.scenario_at(ts.load_scenario("hover"), {"atmosphere.temperature_offset": 5.0})
    assert warmer.config.atmosphere.temperature_offset == 5.0


def test_a_change_may_carry_a_unit_where_the_file_needs_a_source():
    """As `--set vehicle.hull.length=50ft` gives it; a file without a source stays refused."""
    longer = ts.load_scenario("three_lines", {"vehicle.hull.length": {"value": 60.0, "unit": "ft"}})
    assert longer.config.vehicle.hull.length == pytest.approx(60.0 * 0.3048, rel=1e-14)
    with pytest.raises(ts.ConfigError, match="the unit is 'kg', which is no 'm'"):
        ts.load_scenario("three_lines", {"vehicle.hull.length": {"value": 60.0, "unit": "kg"}})
