"""Navigation law: Eq. 43 by hand with the text's index sets and the damping sign of the speed term.

Truth: the notes section 11 with the gains of Table A.4. If this failed, the ship would fly away from the anchor,
climb from it, or (with the printed plus) be driven ever faster.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import tethership as ts
from tethership.control import Measurement

# Table A.4.
K_HOR, K_VER, K_U, K_ROC, SLOPE, LARGEST = 0.0033, 0.0033, 0.033, 0.033, 0.1, 0.5
AHEAD = np.array([1, 0, 0, 0, 1, 1])
"""Thrust ahead per throttle of each thruster (Table 1)."""
DOWN = np.array([0, 1, -1, -1, 0, 0])
"""Thrust down per throttle of each thruster."""


@pytest.fixture(scope="module")
def law():
    return ts.load_scenario("docking").law(layers=("navigation",), sas=False).laws[0]


@jax.jit
def throttle_of(law, offset, attitude, speed, climb):
    measurement = Measurement(
        velocity=jnp.stack([speed, 0.3 * jnp.ones(()), -0.2 * jnp.ones(())]),
        rates=jnp.array([0.1, 0.2, 0.3]),
        attitude=attitude,
        rate_of_climb=climb,
        offset=offset[None],
        tension=jnp.array([1000.0]),
        length=jnp.ones(1),
        rewind_rate=jnp.ones(1),
    )
    correction, memory = law(jnp.zeros(()), measurement, ())
    assert memory == ()
    assert correction.rewind_rate == 0.0
    return correction.throttle


def commanded(law, offset, attitude=(0.0, 0.0, 0.0), speed=0.0, climb=0.0):
    values = (
        np.asarray(offset, dtype=float),
        np.asarray(attitude, dtype=float),
        np.asarray(speed),
        np.asarray(climb),
    )
    return np.asarray(throttle_of(law, *values))


def by_hand(offset, heading, speed, climb):
    """Return Eq. 43 written out."""
    hor = offset[0] * np.cos(heading) + offset[1] * np.sin(heading)
    ver = offset[2]
    wanted_speed = min(max(-SLOPE * hor, -LARGEST), LARGEST)
    wanted_climb = min(max(SLOPE * ver, -LARGEST), LARGEST)
    ahead = -K_HOR * hor - K_U * (speed - wanted_speed)
    down = -K_VER * ver + K_ROC * (climb - wanted_climb)
    return np.array([ahead, down, -down, -down, ahead, ahead])


@settings(deadline=None, derandomize=True, max_examples=80)
@given(
    offset=arrays(np.float64, 3, elements=st.floats(-20.0, 20.0)),
    attitude=arrays(np.float64, 3, elements=st.floats(-1.2, 1.2)),
    speed=st.floats(-3.0, 3.0),
    climb=st.floats(-3.0, 3.0),
)
def test_law_is_equation_43(law, offset, attitude, speed, climb):
    """The horizontal unit of b₁ is (cos ψ, sin ψ) whatever roll and pitch."""
    found = commanded(law, offset, attitude, speed, climb)
    np.testing.assert_allclose(found, by_hand(offset, attitude[2], speed, climb), rtol=0, atol=1e-14)


def test_behind_and_above_the_anchor_the_ship_goes_ahead_and_down(law):
    """The docking's start: 11.3 m behind the anchor and 11.3 m above it, at rest."""
    throttle = commanded(law, [-11.3, 0.0, -11.3])
    assert throttle @ AHEAD > 0
    assert throttle @ DOWN > 0
    # Both set-points are at their bounds: 0.0033·11.3 + 0.033·0.5 of throttle each.
    assert throttle[0] == pytest.approx(0.0033 * 11.3 + 0.0165, rel=1e-12)
    assert throttle[1] == pytest.approx(0.0033 * 11.3 + 0.0165, rel=1e-12)


def test_ahead_of_and_below_the_anchor_it_backs_and_climbs(law):
    throttle = commanded(law, [5.0, 0.0, 3.0])
    assert throttle @ AHEAD < 0
    assert throttle @ DOWN < 0


def test_off_abeam_is_no_matter_of_this_law(law):
    np.testing.assert_array_equal(commanded(law, [0.0, 7.0, 0.0]), np.zeros(6))


@pytest.mark.parametrize("heading", [0.0, 1.0, 2.5])
def test_distance_is_taken_along_the_nose(law, heading):
    turned = commanded(law, [-6 * np.cos(heading), -6 * np.sin(heading), 0.0], (0, 0, heading))
    np.testing.assert_allclose(turned, commanded(law, [-6.0, 0.0, 0.0]), rtol=1e-12, atol=1e-15)


def test_speed_and_climb_are_damped(law):
    """The printed plus of the speed term would be anti-damping: more speed must mean less thrust ahead."""
    still, fast, rising = (
        commanded(law, [0.0, 0.0, 0.0], speed=speed, climb=climb) for speed, climb in [(0, 0), (1, 0), (0, 1)]
    )
    np.testing.assert_array_equal(still, np.zeros(6))
    assert fast @ AHEAD == pytest.approx(-3 * K_U, rel=1e-12)
    assert rising @ DOWN == pytest.approx(3 * K_ROC, rel=1e-12)


def test_set_points_are_bounded(law):
    """Beyond 5 m the wanted speed stays 0.5 m/s: only the position term goes on growing."""
    near, far, farther = (commanded(law, [-distance, 0.0, 0.0])[0] for distance in (5.0, 10.0, 15.0))
    assert far - near == pytest.approx(K_HOR * 5.0, rel=1e-12)
    assert farther - far == pytest.approx(K_HOR * 5.0, rel=1e-12)
    assert near - commanded(law, [-4.0, 0.0, 0.0])[0] == pytest.approx(K_HOR + 0.1 * K_U, rel=1e-11)


def test_pitch_neutral_shares_of_the_scenario_file_have_no_moment():
    """The comment in docking.toml: { tail_down = 0.441, port_up = −1, starboard_up = −1 } is free of moment."""
    shares = {"tail_down": 0.441, "port_up": -1.0, "starboard_up": -1.0}
    law = ts.load_scenario("docking", {"control.navigation.vertical_share": shares})
    throttle = commanded(law.law(layers=("navigation",), sas=False).laws[0], [0.0, 0.0, -10.0])
    pitch_arms = np.array([0.0, 9.07, 2.0, 2.0, 0.0, 0.0])
    assert throttle @ DOWN > 0
    # 0.441 is 2·2.0/9.07 = 0.44101 to three digits.
    assert abs(throttle @ pitch_arms) < 1e-4 * np.abs(throttle * pitch_arms).sum()
    printed = commanded(ts.load_scenario("docking").law(("navigation",), False).laws[0], [0.0, 0.0, -10.0])
    # As printed: 3 T of force down and 9.07 − 4 = 5.07 T m of moment nose up.
    assert (printed @ pitch_arms) / (printed @ DOWN) == pytest.approx(5.07 / 3.0, rel=1e-12)
