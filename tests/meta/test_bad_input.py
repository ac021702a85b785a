"""Every wrong input has one clear line that says what came, what is allowed and what to do.

If one of these failed, a user would meet a traceback, or worse, a number computed from a file that says something else.
"""

import re

import pytest

import tethership as ts
from tethership.scenario.load import packaged_text

DOCKING = packaged_text("scenarios", "docking")
LOTTE = packaged_text("vehicles", "lotte")


def written(tmp_path, scenario=DOCKING, vehicle=LOTTE):
    """Write both files and return the scenario's path."""
    (tmp_path / "ship.toml").write_text(vehicle)
    text = scenario.replace('vehicle = "lotte"', 'vehicle = "ship.toml"')
    path = tmp_path / "case.toml"
    path.write_text(text)
    return str(path)


def refused(path):
    """Return the message with which a file is refused, on one line."""
    with pytest.raises(ts.ConfigError) as caught:
        ts.load_scenario(path)
    message = str(caught.value)
    assert "\n" not in message
    return message


WIND = 'speed = { value = 6.0, unit = "m/s", source = "Riboldi et al., section 4: 6, 9 and 12 m/s" }'
MASS = 'mass = { value = 136.8, unit = "kg", source = "Riboldi et al., Table 2" }'
LENGTH = 'length = { value = 20.0, unit = "m", source = "Riboldi et al., section 3" }'

SCENARIO_CASES = {
    "unknown key": (
        WIND,
        WIND.replace("speed", "sped"),
        r"case.toml: wind: unknown key 'sped'; did you mean 'speed'\?",
    ),
    "missing unit": (WIND, "speed = 6.0", r"case.toml: wind.speed: it is 6.0; a number needs its unit: write \{ value"),
    "no unit key": (WIND, "speed = { value = 6.0 }", r"wind.speed: missing \['unit'\]"),
    "wrong unit": (WIND, 'speed = { value = 6.0, unit = "kg" }', r"wind.speed: the unit is 'kg', which is no 'm/s'"),
    "nonsense unit": (WIND, 'speed = { value = 6.0, unit = "parsnip" }', r"the unit is 'parsnip', which is not known"),
    "text for number": (WIND, 'speed = { value = "fast", unit = "m/s" }', r"the value is 'fast', not a number"),
    "not finite": (WIND, 'speed = { value = nan, unit = "m/s" }', r"the value is nan, not a finite number"),
    "negative length": (
        LENGTH,
        LENGTH.replace("20.0", "-20.0"),
        r"case.toml: cables.nose.length: it is -20 m; it must be above 0",
    ),
    "misspelt layer": (
        'layers = ["rewind", "heading", "navigation"]',
        'layers = ["rewind", "heding"]',
        r"control.layers: unknown layer 'heding'; did you mean 'heading'\? Allowed: rewind, heading, navigation",
    ),
    "misspelt gain": (
        "pitch_rate_gain =",
        "pich_rate_gain =",
        r"control.attitude: unknown key 'pich_rate_gain'; did you mean 'pitch_rate_gain'\?",
    ),
    "misspelt thruster": (
        "share = { port_forward = -1.0, starboard_forward = 1.0 }",
        "share = { prt_forward = -1.0, starboard_forward = 1.0 }",
        r"names the thruster 'prt_forward', which the vehicle does not have; did you mean 'port_forward'\?",
    ),
    "not TOML": ("[wind]", "[wind", r"case.toml is not TOML: .*line"),
    "wind kind": (
        'model = "uniform"',
        'model = "unifrm"',
        r"case.toml: wind: give 'model' as one of 'uniform', 'power_law'",
    ),
    "missing table": ("[limits]", "[limts]", r"unknown key 'limts'; did you mean 'limits'\?"),
    "both gust amplitudes": (
        "[[gusts]]",
        '[[gusts]]\nspeed = { value = 2.0, unit = "m/s" }',
        r"gusts.0: give either fraction \(of the wind\) or speed",
    ),
    "formulation": (
        'formulation = "consistent"',
        'formulation = "consistant"',
        r"formulation: it is 'consistant'; input should be 'consistent' or 'published'",
    ),
    "angle for a fraction": (
        'fraction = { value = 0.3333333333333333, unit = "1"',
        'fraction = { value = 0.3333333333333333, unit = "deg"',
        r"gusts.0.fraction: the unit is 'deg', which is no '1'",
    ),
    "number for an angle": (
        'from_direction = { value = 270.0, unit = "deg"',
        'from_direction = { value = 270.0, unit = "1"',
        r"gusts.0.from_direction: the unit is '1', which is no 'rad'; give deg or rad",
    ),
    "layer twice": (
        'layers = ["rewind", "heading", "navigation"]',
        'layers = ["rewind", "rewind"]',
        r"control.layers: layer 'rewind' is named twice",
    ),
    "winch too slow": (
        'rewind_rate = { value = 0.3, unit = "m/s"',
        'rewind_rate = { value = 3.0, unit = "m/s"',
        r"cables.nose.winch: rewind_rate 3 m/s is beyond fastest_rate 0.5 m/s",
    ),
    "two breaking forces": (
        "control_threshold = {",
        'cable_break = { value = 100.0, unit = "N" }\ncontrol_threshold = {',
        r"limits.cable_break 100 N is not the breaking_force 3040 N; leave it out of limits",
    ),
    "two numbers for three": (
        "tether_point = { value = [6.97, 0.0, 0.0]",
        "tether_point = { value = [6.97, 0.0]",
        r"cables.nose.tether_point.2: there are too few numbers in the list",
    ),
    "joint": ("joint_start = { value = 0.99", "joint_start = { value = 1.01", r"joint_start 1.01 and joint_end 1.05"),
    "vehicle not there": ('vehicle = "lotte" ', 'vehicle = "loti" ', r"no vehicle 'loti'; did you mean 'lotte'\?"),
}


@pytest.mark.parametrize("case", SCENARIO_CASES)
def test_scenario_file(case, tmp_path):
    old, new, message = SCENARIO_CASES[case]
    assert old in DOCKING
    assert re.search(message, refused(written(tmp_path, DOCKING.replace(old, new))))


VEHICLE_CASES = {
    "negative mass": (
        MASS,
        MASS.replace("136.8", "-136.8"),
        r"ship.toml: body.mass: it is -136.8 kg; it must be above 0",
    ),
    "no source": (MASS, 'mass = { value = 136.8, unit = "kg" }', r"body.mass: missing \['source'\]"),
    "inertia": ("3211.0]]", "-3211.0]]", r"ship.toml: body: inertia is not positive definite"),
    "inertia not symmetric": ("[-88.0, 0.0, 3211.0]]", "[88.0, 0.0, 3211.0]]", r"body: inertia is not symmetric"),
    "hull negative": ("24.55536, -51.15841", "24.55536, -61.15841", r"hull: the profile goes negative \(r² ≤ 0\) at"),
    "hull open": ("-15.22792]", "-15.12792]", r"hull: \(r/D\)² is 0.1 at the tail; the coefficients must add up to 0"),
    "volume": (
        "value = 110.3",
        "value = 80.3",
        r"buoyancy.volume 80.3 m³ is more than 25 % from the hull's own 110.3 m³",
    ),
    "direction": ("value = [1.0, 0.0, 0.0], unit", "value = [1.0, 1.0, 0.0], unit", r"direction has length 1.41421"),
    "names": ('name = "tail_down"', 'name = "tail_forward"', r"two fins or thrusters are named 'tail_forward'"),
    "k2 k3": ("k3 = { value = 0.86", "k3 = { value = 0.80", r"a body of revolution has k2 = k3"),
    "length of vector": ("[-0.06, 0.0, 0.455]", "[-0.06, 0.455]", r"ship.toml: body.centre_of_gravity"),
}


@pytest.mark.parametrize("case", VEHICLE_CASES)
def test_vehicle_file(case, tmp_path):
    old, new, message = VEHICLE_CASES[case]
    assert old in LOTTE
    assert re.search(message, refused(written(tmp_path, vehicle=LOTTE.replace(old, new))))


def test_the_unchanged_copies_are_accepted(tmp_path):
    """The guard of the cases above: only what they change makes them wrong."""
    assert ts.load_scenario(written(tmp_path)).config == ts.load_scenario("docking").config


def test_names():
    with pytest.raises(ts.ConfigError, match=r"no scenario 'doking'; did you mean 'docking'\?"):
        ts.load_scenario("doking")
    with pytest.raises(ts.ConfigError, match=r"cannot read nowhere.toml: No such file"):
        ts.load_scenario("nowhere.toml")
    with pytest.raises(ts.ConfigError, match=r"wind: unknown key 'speeed'; did you mean 'speed'"):
        ts.load_scenario("docking", {"wind.speeed": 1.0})
    with pytest.raises(ts.ConfigError, match=r"no item 'nos' in a list of 1; there are nose"):
        ts.load_scenario("docking", {"cables.nos.length": 1.0})


def test_binary_file(tmp_path):
    path = tmp_path / "noise.toml"
    path.write_bytes(bytes(range(256)))
    assert "it is not a text file" in refused(str(path))


def test_start_beyond_breaking(docking):
    taut = docking.changed({"trim.elongation": 1.06})
    point = ts.trim(taut)
    with pytest.raises(
        ts.ConfigError, match=r"the start is beyond breaking: a cable is at 1\.\d+ of its breaking force"
    ):
        ts.dock(taut, point)


def test_start_docked_underground_or_pitched(docking, point):
    with pytest.raises(ts.ConfigError, match="the start is docked already"):
        ts.dock(docking.changed({"stop.cable_length": 30.0}), point)
    low = docking.changed({"ground.anchor_height": 0.0, "trim.elevation": -0.3})
    below = ts.trim(low)
    with pytest.raises(ts.ConfigError, match=r"the start has the hull \d+\.\d+ m below ground"):
        ts.dock(low, below)
    with pytest.raises(ts.ConfigError, match=r"beyond stop\.largest_pitch"):
        ts.dock(docking.changed({"stop.largest_pitch": 0.1}), point)


def test_layers_without_a_cable(point):
    hover = ts.load_scenario("hover")
    with pytest.raises(ts.ConfigError, match=r"layers heading need a cable, and hover has none; use --layers none"):
        ts.dock(hover, point, layers=["heading"])


def test_own_law_with_a_name_of_the_package(docking, point):
    with pytest.raises(ts.ConfigError, match="a law of one's own is named 'rewind', as one of the package"):
        ts.dock(docking, point, own_laws={"rewind": docking.law([])})


def test_layers_and_unknowns(docking, point):
    with pytest.raises(ts.ConfigError, match=r"unknown layer 'rewnd'; did you mean 'rewind'"):
        ts.dock(docking, point, layers=["rewnd"])
    with pytest.raises(ts.ConfigError, match=r"unknown quantity 'thota'; did you mean 'theta'"):
        ts.trim(docking, unknowns=["thota"])
    with pytest.raises(ts.ConfigError, match="the tether point is held, so north, east and down follow"):
        ts.trim(docking, unknowns=["north"])
    with pytest.raises(ts.ConfigError, match="nothing is looked for"):
        ts.trim(docking, unknowns=[])
