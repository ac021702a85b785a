"""Thrusters: Eq. 11's moments worked by hand from Table 1, saturation, density and lapse.

Truth: the positions and directions of Table 1 of the paper, cross products by hand. If this failed, a throttle
would turn the ship the wrong way (the cross of q × T is lost in print), or give thrust that is not there.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import tethership as ts
from tethership.physics.thrusters import Thrusters
from tethership.spatial import SEA_LEVEL_DENSITY

NOMINAL = 120.0
SEA_LEVEL = jnp.asarray(SEA_LEVEL_DENSITY)
STILL = jnp.zeros(3)
# Per newton of positive thrust of #1 … #6: force along nose, down; moment about roll, pitch, yaw [m], from Table 1.
# #1 is on the axis; #2 pushes the tail down; #3, #4 lift ahead of B, port and starboard; #5, #6 push ahead.
BY_HAND = np.array(
    [
        [1, 0, 0, 0.0, 0.0, 0.0],
        [0, 0, 1, 0.0, 9.07, 0.0],
        [0, 0, -1, 1.8634, 2.0, 0.0],
        [0, 0, -1, -1.8634, 2.0, 0.0],
        [1, 0, 0, 0.0, 0.0, 1.9905],
        [1, 0, 0, 0.0, 0.0, -1.9905],
    ]
)


@pytest.fixture(scope="module")
def six():
    return ts.load_scenario("docking").system.ship.thrusters


def two(lowest=(-1.0, 0.0), lapse=(0.0, 0.0)):
    """Return two thrusters, ahead and up."""
    return Thrusters(
        position=jnp.array([[-2.0, 0.5, 0.0], [1.0, 0.0, 0.3]]),
        direction=jnp.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]),
        nominal=jnp.array([100.0, 40.0]),
        lowest_throttle=jnp.asarray(lowest),
        lapse=jnp.asarray(lapse),
    )


@pytest.mark.parametrize("number", range(6))
def test_each_thruster_of_table_1(six, number):
    throttle = jnp.zeros(6).at[number].set(0.5)
    found = np.asarray(six.wrench(SEA_LEVEL, STILL, STILL, throttle).as_vector())
    np.testing.assert_allclose(found, 0.5 * NOMINAL * BY_HAND[number], rtol=1e-14)  # one product each


@settings(deadline=None, derandomize=True, max_examples=30)
@given(throttle=arrays(np.float64, 6, elements=st.floats(-1.0, 1.0)))
def test_thrusters_add_up(six, throttle):
    found = np.asarray(six.wrench(SEA_LEVEL, STILL, STILL, jnp.asarray(throttle)).as_vector())
    np.testing.assert_allclose(found, NOMINAL * throttle @ BY_HAND, rtol=0, atol=1e-11)  # sums of 1e3 N m


def test_thrust_scales_with_density():
    """T_nom is the thrust at sea level; at 0.9 kg/m³ it is 0.9/1.225 of it."""
    found = two().thrust(jnp.asarray(0.9), STILL, STILL, jnp.array([1.0, 0.5]))
    # 1.225 kg/m³ is the ISA density to 1e-7.
    np.testing.assert_allclose(np.asarray(found), np.array([100.0, 20.0]) * 0.9 / 1.225, rtol=1e-6)


def test_throttle_is_clipped_to_what_a_thruster_can_do():
    """A reversible one goes from −1 to 1, another from 0 to 1; inside nothing changes."""
    asked = np.array([[-1.7, -1.7], [-0.4, -0.4], [0.6, 0.6], [3.0, 3.0]])
    given_back = np.asarray(jax.vmap(two().saturate)(asked))
    np.testing.assert_array_equal(given_back, [[-1.0, 0.0], [-0.4, 0.0], [0.6, 0.6], [1.0, 1.0]])


def test_thrust_itself_is_not_clipped():
    """Trim needs to know how much is missing: `thrust` takes a throttle beyond 1 as it comes."""
    found = two().thrust(SEA_LEVEL, STILL, STILL, jnp.array([2.0, -1.5]))
    np.testing.assert_allclose(np.asarray(found), [200.0, -60.0], rtol=1e-14)


def test_reversed_throttle_reverses_the_wrench():
    throttle = jnp.array([0.7, 0.3])
    ahead = two().wrench(SEA_LEVEL, STILL, STILL, throttle).as_vector()
    astern = two().wrench(SEA_LEVEL, STILL, STILL, -throttle).as_vector()
    np.testing.assert_array_equal(np.asarray(astern), -np.asarray(ahead))  # signs only


def test_lapse_takes_the_thrust_away_at_its_speed():
    """T = T_nom(δ − λ|δ|v_T·t): half at half the speed of no thrust, none at it, more with the air from behind."""
    lapsing = two(lapse=(1.0 / 20.0, 0.0))
    for speed, share in [(0.0, 1.0), (10.0, 0.5), (20.0, 0.0), (-10.0, 1.5)]:
        found = lapsing.thrust(SEA_LEVEL, jnp.array([speed, 3.0, -1.0]), STILL, jnp.array([1.0, 1.0]))
        # Side-slip and heave are across the first thruster's axis; the second has no lapse.
        np.testing.assert_allclose(np.asarray(found), [100.0 * share, 40.0], atol=1e-12)
    # Reversed thrust in forward flight grows: the air comes from behind the reversed propeller.
    reverse = lapsing.thrust(SEA_LEVEL, jnp.array([10.0, 0.0, 0.0]), STILL, jnp.array([-1.0, 0.0]))
    assert float(reverse[0]) == pytest.approx(-150.0, abs=1e-12)


def test_lapse_uses_the_airspeed_at_the_thruster():
    """A yaw rate moves the thruster 0.5 m to starboard at −0.5 r along the axis."""
    lapsing = two(lapse=(1.0 / 20.0, 0.0))
    found = lapsing.thrust(SEA_LEVEL, STILL, jnp.array([0.0, 0.0, 2.0]), jnp.array([1.0, 0.0]))
    assert float(found[0]) == pytest.approx(100.0 * (1.0 + 1.0 / 20.0), rel=1e-14)


def test_lapse_is_read_from_the_vehicle_file():
    changes = {"vehicle.thrusters.tail_forward.speed_of_no_thrust": 25.0}
    thrusters = ts.load_scenario("docking", changes).system.ship.thrusters
    np.testing.assert_allclose(np.asarray(thrusters.lapse), [0.04, 0, 0, 0, 0, 0], rtol=1e-15)


def test_irreversible_is_read_from_the_vehicle_file():
    thrusters = ts.load_scenario("docking", {"vehicle.thrusters.tail_down.reversible": False}).system.ship.thrusters
    np.testing.assert_array_equal(np.asarray(thrusters.lowest_throttle), [-1, 0, -1, -1, -1, -1])


def test_a_ship_without_thrusters_has_no_thrust():
    none = Thrusters(jnp.zeros((0, 3)), jnp.zeros((0, 3)), jnp.zeros(0), jnp.zeros(0), jnp.zeros(0))
    found = none.wrench(SEA_LEVEL, jnp.ones(3), jnp.ones(3), jnp.zeros(0))
    np.testing.assert_array_equal(np.asarray(found.as_vector()), np.zeros(6))
