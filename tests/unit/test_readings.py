"""The readings that the print leaves open, as options of a scenario: angle, range, unit of the gains, C, gust.

Truth: plane geometry and closed forms: arcsin sin χ, arctan tan χ, a point moved along the hull, a share scaled by a
ratio of thrusts, drag at a fraction of the velocity, one period of a cosine.
If this fails, a variant's misfit in the report is that of another reading than it names.
"""

import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership.control import Measurement, misalignment
from tethership.control.heading import HeadingLaw, LineHeadingLaw, SineHeadingLaw
from tethership.control.navigation import LineOfSightNavigationLaw, NavigationLaw
from tethership.physics.gust import BareCosine, CosineGust, RepeatedCosine
from tethership.plant import State
from tethership.plant.plant import cable_between
from tethership.spatial import rotation_matrix

ANGLES = np.random.default_rng(1).uniform(-np.pi, np.pi, 200)


def law(layer, changes):
    return ts.load_scenario("docking", changes).law(layers=(layer,), sas=False).laws[0]


def throttle(of, attitude=(0.0, 0.0, 0.0), offset=(-8.0, 3.0, -9.0), velocity=(0.0, 0.0, 0.0), rates=(0.0, 0.0, 0.0)):
    measured = Measurement(
        velocity=jnp.array(velocity),
        rates=jnp.array(rates),
        attitude=jnp.array(attitude),
        rate_of_climb=jnp.asarray(0.1),
        offset=jnp.array([offset]),
        tension=jnp.ones(1),
        length=jnp.ones(1),
        rewind_rate=jnp.ones(1),
    )
    return np.asarray(of(jnp.zeros(()), measured, of.initial_memory(measured))[0].throttle)


@pytest.mark.parametrize(
    ("word", "kind", "function"),
    [
        ("full", HeadingLaw, lambda chi: chi),
        ("sine", SineHeadingLaw, lambda chi: np.arcsin(np.sin(chi))),
        ("line", LineHeadingLaw, lambda chi: np.arctan(np.tan(chi))),
    ],
)
def test_heading_angle(word, kind, function):
    found = law("heading", {"control.heading.angle": word})
    assert type(found) is kind
    # arcsin near ±½π loses half of the digits
    np.testing.assert_allclose(found.angle(jnp.asarray(ANGLES)), function(ANGLES), atol=1e-7)
    for chi in ANGLES[:5]:
        offset = (-8.0 * np.cos(chi), 8.0 * np.sin(chi), -5.0)  # nose north, anchor at −χ
        expected = 5.0 * function(chi) * np.array([0, 0, 0, 0, -1, 1])
        np.testing.assert_allclose(throttle(found, offset=offset), expected, atol=1e-12)


def test_the_default_angle_is_chi_itself():
    assert type(law("heading", {})) is HeadingLaw
    assert ts.load_scenario("docking").config.control.heading.angle == "full"
    assert ts.load_scenario("docking_paper").config.control.heading.angle == "sine"


@pytest.mark.parametrize(("word", "astern"), [("full", 2.0), ("sine", 0.0), ("line", 0.0)])
def test_where_the_angle_jumps(word, astern):
    """χ jumps by 2π with the anchor astern; its sine does not, nor does the line."""
    of = law("heading", {"control.heading.angle": word}).angle
    little = jnp.asarray(1e-9)
    assert abs(float(of(jnp.pi - little) - of(-jnp.pi + little))) == pytest.approx(astern * np.pi, abs=1e-8)
    assert float(of(jnp.zeros(()))) == 0.0


def test_where_the_line_stands_across_it_jumps_and_the_sine_does_not():
    across = 0.5 * jnp.pi
    for word, jump in (("full", 0.0), ("sine", 0.0), ("line", np.pi)):
        of = law("heading", {"control.heading.angle": word}).angle
        assert abs(float(of(across + 1e-9) - of(across - 1e-9))) == pytest.approx(jump, abs=1e-8)


def test_passing_over_the_anchor_turns_the_sine_and_not_the_line():
    """The tether point flies over the anchor, 1 µm either side, 0.1 to starboard of it by the nose's direction."""
    before, after = (-1.0, 0.1, -3.0), (1.0, 0.1, -3.0)
    sine, line = (law("heading", {"control.heading.angle": word}) for word in ("sine", "line"))
    assert throttle(sine, offset=before)[5] == pytest.approx(throttle(sine, offset=after)[5])
    assert throttle(line, offset=before)[5] == pytest.approx(-throttle(line, offset=after)[5])


def test_chi_is_measured_behind_the_tether_point():
    """6.97 m behind the nose tip is B; heading and pitch shorten what is seen of it from above."""
    found = law("heading", {"control.heading.measured_behind": 6.97})
    attitude, offset = np.array([0.2, 0.5, 0.7]), np.array([-4.0, 2.5, -6.0])
    behind = offset - 6.97 * np.asarray(rotation_matrix(jnp.array(attitude)))[:, 0]
    chi = float(misalignment(jnp.array(attitude), jnp.array(behind)))
    assert abs(chi - float(misalignment(jnp.array(attitude), jnp.array(offset)))) > 0.1
    np.testing.assert_allclose(throttle(found, attitude, offset)[4:], [-5.0 * chi, 5.0 * chi], rtol=1e-12)
    # nose north over the anchor: seen from behind it is dead ahead, and stays so when the tip has passed it
    for north in (-1.0, 1.0, 6.0):
        np.testing.assert_allclose(throttle(found, offset=(north, 0.0, -3.0)), 0.0, atol=1e-12)


def test_range_along_the_line_of_sight():
    along, sight = (law("navigation", {"control.navigation.range": word}) for word in ("along_nose", "line_of_sight"))
    assert (type(along), type(sight)) == (NavigationLaw, LineOfSightNavigationLaw)
    for heading in ANGLES[:20]:
        nose, offset = np.array([np.cos(heading), np.sin(heading)]), np.array([-3.0, 4.0, -7.0])
        ahead = float(sight.ahead(jnp.array(offset), jnp.array(nose)))
        assert abs(ahead) == pytest.approx(5.0)
        assert np.sign(ahead) == np.sign(offset[:2] @ nose)
        assert float(along.ahead(jnp.array(offset), jnp.array(nose))) == pytest.approx(offset[:2] @ nose)
    # anchor ahead: thrust ahead, by the whole 5 m and not the 3 m along the nose (set-point 0.3 and 0.5 m/s)
    np.testing.assert_allclose(throttle(sight, offset=(-3.0, 4.0, 0.0))[0], 0.0033 * 5.0 + 0.033 * 0.5, rtol=1e-12)
    np.testing.assert_allclose(throttle(along, offset=(-3.0, 4.0, 0.0))[0], 0.0033 * 3.0 + 0.033 * 0.3, rtol=1e-12)
    assert np.isfinite(throttle(sight, offset=(0.0, 0.0, -3.0))).all()


NOMINAL = np.array([100.0, 150.0, 60.0, 60.0, 240.0, 240.0])


@pytest.mark.parametrize("layer", ["attitude", "heading", "navigation"])
def test_gains_in_thrust(layer):
    """Every throttle is its former value times 120 N over the thruster's own nominal thrust."""
    changes = {f"vehicle.thrusters.{i}.nominal_thrust": thrust for i, thrust in enumerate(NOMINAL)}

    def flown(more):
        scenario = ts.load_scenario("docking", {**changes, **more})
        layers = () if layer == "attitude" else (layer,)
        (only,) = scenario.law(layers=layers, sas=layer == "attitude").laws
        return throttle(only, attitude=(0.1, -0.2, 0.3), velocity=(0.4, 0.0, 0.0), rates=(0.01, 0.02, -0.03))

    plain, scaled = flown({}), flown({"control.gain_thrust": 120.0})
    assert np.count_nonzero(plain) >= 2
    np.testing.assert_allclose(scaled, plain * 120.0 / NOMINAL, rtol=1e-12)


def test_airspeed_of_the_cable_is_that_of_its_point():
    """Drag at C: λ v − w, and only λ v − w; at the anchor the ship's speed is nothing, at TP all of it."""
    air = {"atmosphere": {"model": "constant", "density": {"value": 1.225, "unit": "kg/m^3"}}}
    end, velocity, wind = jnp.array([-11.0, 2.0, -11.0]), jnp.array([0.6, -1.0, 0.4]), jnp.array([-6.0, 0.0, 0.0])

    def load(place, speed, moving=wind):
        plant = ts.load_scenario("docking", {**air, "cables.nose.load_reference": place}).system
        found = cable_between(plant.cables[0], plant.environment, end, jnp.zeros(3), jnp.asarray(20.0), speed, moving)
        return np.asarray(found.load)

    np.testing.assert_array_equal(load(0.0, velocity), load(0.0, jnp.zeros(3)))
    np.testing.assert_allclose(load(1.0, velocity), load(0.5, 2.0 * velocity), rtol=1e-14)
    weight = np.array([0.0, 0.0, 0.08 * 9.80665])
    np.testing.assert_allclose(load(1.0, velocity, velocity), weight, atol=1e-15)  # it flies with the wind
    np.testing.assert_allclose(load(0.5, velocity, 0.5 * velocity), weight, atol=1e-15)
    np.testing.assert_allclose(load(0.0, velocity, jnp.zeros(3)), weight, atol=1e-15)
    assert np.abs(load(0.5, velocity, velocity) - weight).max() > 1e-4


@pytest.mark.parametrize(("place", "height"), [(0.0, 1.0), (0.5, 10.0), (1.0, 19.0)])
def test_wind_of_the_cable_is_that_at_its_point(place, height):
    """In a power law of exponent 1, 6 m/s at 10 m, anchor 1 m up and tether point 19 m: 0.6 m/s per metre."""
    gradient = {
        "wind": {
            "model": "power_law",
            "speed": {"value": 6.0, "unit": "m/s"},
            "from_direction": {"value": 0.0, "unit": "deg"},
            "reference_height": {"value": 10.0, "unit": "m"},
            "exponent": {"value": 1.0, "unit": "1"},
            "lowest_height": {"value": 0.1, "unit": "m"},
        },
        "ground.anchor_height": 1.0,
        "atmosphere": {"model": "constant", "density": {"value": 1.2, "unit": "kg/m^3"}},
        "cables.nose.load_reference": place,
    }
    plant = ts.load_scenario("docking", gradient).system
    anchor = plant.cables[0].anchor
    state = State.at_rest(anchor + jnp.array([-6.97, 0.0, -18.0]))  # tether point plumb over the anchor
    (cable,) = plant.cable_states(jnp.zeros(()), state, jnp.array([20.0]))
    speed = 0.6 * height
    cross = 0.5 * 1.2 * 0.010 * (1.1 + 0.02) * speed**2  # square to the cable: both coefficients
    assert float(cable.load[0]) == pytest.approx(-cross, rel=1e-9)


START, PERIOD = 20.0, 5.0
AMPLITUDE = jnp.array([0.0, 2.0, -0.5])


def shaped(kind):
    return kind(AMPLITUDE, jnp.asarray(START), jnp.asarray(PERIOD))


def test_repeated_pulses():
    one, many = shaped(CosineGust), shaped(RepeatedCosine)
    for time in (-5.0, 0.0, START, 21.0, 22.5, 24.9):
        np.testing.assert_allclose(many.velocity(time), one.velocity(time), atol=1e-14)
    for time in (20.3, 22.5, 24.0):
        for later in (1, 2, 20):
            np.testing.assert_allclose(many.velocity(time + later * PERIOD), one.velocity(time), atol=1e-12)
    assert np.asarray(many.corners()).tolist() == [START]


def test_bare_cosine():
    bare = shaped(BareCosine)
    for phase in (0.0, 0.25, 0.5, 0.75, 0.999):
        expected = np.cos(2.0 * np.pi * phase) * np.asarray(AMPLITUDE)
        np.testing.assert_allclose(bare.velocity(START + phase * PERIOD), expected, atol=1e-14)
    for time in (0.0, START - 1e-9, START + PERIOD, 60.0):
        np.testing.assert_array_equal(bare.velocity(time), np.zeros(3))
    assert np.asarray(bare.corners()).tolist() == [START, START + PERIOD]


@pytest.mark.parametrize(
    ("word", "kind", "late"),
    [("one_minus_cosine", CosineGust, 0.0), ("repeated", RepeatedCosine, 2.0), ("cosine", BareCosine, 0.0)],
)
def test_gust_of_a_file(word, kind, late):
    environment = ts.load_scenario("docking", {"gusts.0.shape": word}).system.environment
    assert type(environment.gusts[0]) is kind
    wind = environment.wind_at(jnp.zeros(3), jnp.asarray(27.5))
    np.testing.assert_allclose(wind, [-6.0, late, 0.0], atol=1e-12)


def test_defaults_are_what_they_were():
    """Written out, the defaults are `docking` itself: the same laws and plant, so the same flights."""
    written = {
        "control.heading.angle": "full",
        "control.heading.measured_behind": 0.0,
        "control.navigation.range": "along_nose",
        "cables.nose.load_reference": 0.5,
        "gusts.0.shape": "one_minus_cosine",
    }
    assert ts.load_scenario("docking", written).config == ts.load_scenario("docking").config
    assert ts.load_scenario("docking").config.control.gain_thrust is None


WRONG = {
    ("control.heading.angle", "sin"): r"docking: control\.heading\.angle: it is 'sin'; input should be 'full', 'sine'",
    ("control.navigation.range", "nose"): r"control\.navigation\.range: it is 'nose'; input should be 'along_nose'",
    (
        "gusts.0.shape",
        "cos",
    ): r"gusts\.0\.shape: it is 'cos'; input should be 'one_minus_cosine', 'repeated'",
    ("control.gain_thrust", 0.0): r"control\.gain_thrust: it is 0 N; it must be above 0",
    ("cables.nose.load_reference", 1.5): r"cables\.nose\.load_reference: it is 1\.5.*; it must be at most 1",
    ("cables.nose.load_reference", -0.1): r"cables\.nose\.load_reference: it is -0\.1.*; it must be at least 0",
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_values(case):
    name, value = case
    with pytest.raises(ts.ConfigError, match=WRONG[case]) as caught:
        ts.load_scenario("docking", {name: value})
    assert "\n" not in str(caught.value)
