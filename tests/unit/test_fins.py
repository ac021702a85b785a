"""Fins: one fin worked by hand, then any number at any roll angle.

Truth: the formula of the notes section 4 evaluated by hand for a single fin, and symmetry. If this failed, the
tail would destabilise instead of stabilise, or a deflection would turn the ship the wrong way.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import tethership as ts
from tethership.physics.fins import Fins

DENSITY = 1.2
AREA, SLOPE, EFFICIENCY, CROSS, FRICTION = 2.88, 5.73, 0.40, 1.0, 0.006
STATION, CROSS_STATION, RADIUS = -5.9, -6.3, 1.6
BODY_AXES = st.floats(-5.0, 5.0)


def fins_at(rolls, cross=CROSS, friction=FRICTION, lift=AREA * SLOPE * EFFICIENCY):
    """Return fins at roll angles [rad], built from s = (0, cos Γ, sin Γ) and n = b₁ × s."""
    rolls = np.asarray(rolls, dtype=float)
    span = np.stack([0 * rolls, np.cos(rolls), np.sin(rolls)], axis=1)
    normal = np.cross([1.0, 0.0, 0.0], span)
    axis = np.array([1.0, 0.0, 0.0])
    each = np.ones_like(rolls)
    return Fins(
        aerodynamic_centre=jnp.asarray(STATION * axis + RADIUS * span),
        cross_flow_centre=jnp.asarray(CROSS_STATION * axis + RADIUS * span),
        normal=jnp.asarray(normal),
        lift_area=jnp.asarray(lift * each),
        cross_flow_area=jnp.asarray(AREA * cross * each),
        friction_area=jnp.asarray(AREA * friction * each),
    )


@jax.jit
def load(fins, velocity, rates, deflection):
    return fins.wrench(jnp.asarray(DENSITY), velocity, rates, deflection).as_vector()


def wrench_of(fins, velocity, rates=(0.0, 0.0, 0.0), deflection=None):
    deflection = np.zeros(fins.count) if deflection is None else np.asarray(deflection, dtype=float)
    arguments = np.asarray(velocity, dtype=float), np.asarray(rates, dtype=float), deflection
    return np.asarray(load(fins, *arguments))


def test_one_fin_by_hand():
    """A starboard fin (n = +b₃) at 10 m/s ahead and 1 m/s of air from below."""
    found = wrench_of(fins_at([0.0]), [10.0, 0.0, 1.0])
    q = 0.5 * 1.2
    attached, separated, friction = (
        q * 2.88 * 5.73 * 0.40 * 10.0 * 1.0,
        q * 2.88 * 1.0,
        q * 2.88 * 0.006 * 100.0,
    )
    # Numbers of the vehicle file: 39.6 N, 1.73 N, 1.04 N, all against the motion.
    np.testing.assert_allclose([attached, separated, friction], [39.606, 1.728, 1.0368], rtol=1e-4)
    expected = np.zeros(6)
    expected[0], expected[2] = -friction, -attached - separated
    expected[3:] += np.cross([-5.9, 1.6, 0.0], [-friction, 0.0, -attached])
    expected[3:] += np.cross([-6.3, 1.6, 0.0], [0.0, 0.0, -separated])
    np.testing.assert_allclose(found, expected, rtol=1e-14, atol=1e-12)  # a handful of products
    assert found[4] < 0  # the tail lifts: nose down, against the incidence


def test_packaged_ship_has_that_fin():
    """What `lotte.toml` builds is this fin, at its place on the hull."""
    ship = ts.load_scenario("hover").system.ship.fins
    by_hand = fins_at(np.deg2rad([0.0, 90.0, 180.0, 270.0]))
    for name in Fins.__dataclass_fields__:
        # cos 90° is 6e-17, times 1.6 m.
        np.testing.assert_allclose(getattr(ship, name), getattr(by_hand, name), rtol=1e-14, atol=1e-15)


def test_a_vehicle_file_may_turn_a_fin():
    """`roll` is any angle: 0 starboard, 90° down."""
    ship = ts.load_scenario("hover", {"vehicle.fins.fin_top.roll": 0.7}).system.ship.fins
    np.testing.assert_allclose(ship.normal[3], [0.0, -np.sin(0.7), np.cos(0.7)], atol=1e-15)
    np.testing.assert_allclose(ship.aerodynamic_centre[3], [-5.9, 1.6 * np.cos(0.7), 1.6 * np.sin(0.7)], atol=1e-15)


@pytest.mark.parametrize(("axis", "name"), [(0, "roll"), (1, "pitch"), (2, "yaw")])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rates_are_damped(axis, name, sign):
    rates = np.zeros(3)
    rates[axis] = 0.2 * sign
    fins = fins_at(np.deg2rad([0.0, 90.0, 180.0, 270.0]))
    moment = wrench_of(fins, [8.0, 0.0, 0.0], rates)[3 + axis]
    assert moment * sign < 0, name
    backwards = wrench_of(fins, [-8.0, 0.0, 0.0], rates)[3 + axis]
    assert backwards * sign < 0, name  # |v_x|: damped in reversed flow too


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    count=st.integers(3, 7),
    offset=st.floats(0.0, 6.3),
    velocity=arrays(np.float64, 3, elements=BODY_AXES),
)
def test_any_three_or_more_even_fins_answer_side_slip_alike(count, offset, velocity):
    """Σ n nᵀ = ½N across the axis: the attached force opposes the cross-flow, whatever the roll angle."""
    fins = fins_at(offset + 2 * np.pi * np.arange(count) / count, cross=0.0, friction=0.0)
    found = wrench_of(fins, velocity)
    each = 0.5 * DENSITY * AREA * SLOPE * EFFICIENCY * abs(velocity[0])
    force = -0.5 * count * each * np.array([0.0, velocity[1], velocity[2]])
    expected = np.concatenate([force, np.cross([STATION, 0.0, 0.0], force)])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9)  # rounding of sums of 1e3 N m


@settings(deadline=None, derandomize=True, max_examples=40)
@given(
    roll=st.floats(-7.0, 7.0),
    motion=arrays(np.float64, 6, elements=BODY_AXES),
    deflection=st.floats(-0.5, 0.5),
)
def test_turning_a_fin_and_the_motion_turns_the_load(roll, motion, deflection):
    turn = np.array([[1, 0, 0], [0, np.cos(roll), -np.sin(roll)], [0, np.sin(roll), np.cos(roll)]])
    still = wrench_of(fins_at([0.3]), motion[:3], motion[3:], [deflection])
    turned = wrench_of(fins_at([0.3 + roll]), turn @ motion[:3], turn @ motion[3:], [deflection])
    expected = np.concatenate([turn @ still[:3], turn @ still[3:]])
    # Speeds up to 60 m/s at the tail (5 rad/s): loads of 1e4 N, 1e5 N m, rounding of a dozen operations.
    np.testing.assert_allclose(turned, expected, rtol=0, atol=1e-9)


@settings(deadline=None, derandomize=True, max_examples=40)
@given(speed=st.floats(-12.0, 12.0), slip=st.floats(-3.0, 3.0), angle=st.floats(-0.6, 0.6))
def test_deflection_adds_to_incidence(speed, slip, angle):
    """A fin deflected by δ feels the attached force of incidence v_n/v_x + δ; the cross-flow drag is unchanged."""
    fin = fins_at([0.0])
    found = wrench_of(fin, [speed, 0.0, slip], deflection=[angle])
    with_incidence = wrench_of(fins_at([0.0], cross=0.0), [speed, 0.0, slip + speed * angle])
    only_drag = wrench_of(fins_at([0.0], lift=0.0, friction=0.0), [speed, 0.0, slip])
    # The same sum in another order, 1e3 N m.
    np.testing.assert_allclose(found, with_incidence + only_drag, rtol=0, atol=1e-9)


def test_positive_deflection_of_the_starboard_fin_pitches_the_nose_down():
    """Its normal is +b₃: positive δ lifts the tail flying ahead, and pushes it down flying astern."""
    fin = fins_at([0.0], friction=0.0)
    ahead = wrench_of(fin, [10.0, 0.0, 0.0], deflection=[0.1])
    expected = -0.5 * DENSITY * AREA * SLOPE * EFFICIENCY * 100.0 * 0.1
    assert ahead[2] == pytest.approx(expected, rel=1e-14)  # one product
    assert ahead[4] == pytest.approx(STATION * -expected, rel=1e-13)
    assert ahead[4] < 0
    astern = wrench_of(fin, [-10.0, 0.0, 0.0], deflection=[0.1])
    assert astern[2] == pytest.approx(-expected, rel=1e-14)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    motion=arrays(np.float64, 6, elements=BODY_AXES),
    deflection=arrays(np.float64, 4, elements=st.floats(-0.5, 0.5)),
)
def test_port_and_starboard_mirror_each_other(motion, deflection):
    """Mirrored motion, with port and starboard fins exchanged and every deflection turned, mirrors the load."""
    fins = fins_at(np.deg2rad([0.0, 90.0, 180.0, 270.0]))
    vector, pseudo = np.array([1, -1, 1]), np.array([-1, 1, -1])
    still = wrench_of(fins, motion[:3], motion[3:], deflection)
    exchanged = -deflection[[2, 1, 0, 3]]
    found = wrench_of(fins, vector * motion[:3], pseudo * motion[3:], exchanged)
    expected = np.concatenate([vector * still[:3], pseudo * still[3:]])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9)  # as above


def test_a_ship_without_fins_feels_none():
    none = wrench_of(fins_at([]), [10.0, 2.0, 1.0], [0.1, 0.2, 0.3])
    np.testing.assert_array_equal(none, np.zeros(6))


def test_fins_feel_nothing_and_have_finite_slopes_in_still_air():
    fins = fins_at(np.deg2rad([0.0, 90.0, 180.0, 270.0]))

    def total(motion):
        return fins.wrench(jnp.asarray(DENSITY), motion[:3], motion[3:], 0.1 * jnp.ones(4)).as_vector()

    np.testing.assert_array_equal(np.asarray(total(jnp.zeros(6))), np.zeros(6))
    # All loads are quadratic: |x| has slope ±1 or 0 at rest, times zero.
    np.testing.assert_array_equal(np.asarray(jax.jacfwd(total)(jnp.zeros(6))), np.zeros((6, 6)))
