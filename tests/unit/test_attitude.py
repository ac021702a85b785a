"""SAS/attitude law: Eq. 40 written out by hand, and that it damps the ship it is meant for.

Truth: the corrected form in the notes section 11 with the gains of Table A.1, and the arms of Table 1. If this
failed, the ship would be driven away from level, or (with the printed sign of the ratio of arms) not damped at all.
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

# Table A.1.
K_P, K_Q, K_R, K_PHI, K_THETA = 2.0, 1.0, 5.0, 0.5, 0.5
RATIO = 9.07 / 2.0  # |q_T2x / q_T3x|, Table 1
ARMS = np.array([[0, 0, 0], [0, 9.07, 0], [1.8634, 2, 0], [-1.8634, 2, 0], [0, 0, 1.9905], [0, 0, -1.9905]])
"""Moment about roll, pitch and yaw per newton of each thruster [m], Table 1."""


def measured(rates=(0.0, 0.0, 0.0), attitude=(0.0, 0.0, 0.0)):
    zero = jnp.zeros(())
    return Measurement(
        velocity=jnp.ones(3),
        rates=jnp.asarray(rates, dtype=float),
        attitude=jnp.asarray(attitude, dtype=float),
        rate_of_climb=zero,
        offset=jnp.array([[-10.0, 1.0, -10.0]]),
        tension=jnp.array([500.0]),
        length=jnp.array([20.0]),
        rewind_rate=jnp.array([0.3]),
    )


@pytest.fixture(scope="module")
def law():
    return ts.load_scenario("docking").law(layers=()).laws[0]


@jax.jit
def throttle_of(law, rates, attitude):
    correction, memory = law(jnp.zeros(()), measured(rates, attitude), ())
    assert memory == ()
    assert correction.rewind_rate == 0.0
    assert correction.deflection == 0.0
    return correction.throttle


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    rates=arrays(np.float64, 3, elements=st.floats(-1, 1)),
    attitude=arrays(np.float64, 3, elements=st.floats(-1, 1)),
)
def test_law_is_equation_40_with_the_modulus(law, rates, attitude):
    p, q, r = rates
    phi, theta, _ = attitude
    a, b = K_Q * q + K_THETA * theta, K_P * p + K_PHI * phi
    by_hand = [0.0, -a, -b - 0.5 * RATIO * a, b - 0.5 * RATIO * a, -K_R * r, K_R * r]
    found = np.asarray(throttle_of(law, rates, attitude))
    np.testing.assert_allclose(found, by_hand, rtol=0, atol=1e-14)  # sums of numbers up to 10


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rates_are_opposed_by_the_moment_about_their_own_axis(law, axis, sign):
    rates = np.zeros(3)
    rates[axis] = 0.1 * sign
    moment = np.asarray(throttle_of(law, rates, np.zeros(3))) @ ARMS
    assert moment[axis] * sign < 0
    others = np.delete(moment, axis)
    # The pairs cancel exactly; #3, #4 share roll and pitch without mixing them.
    np.testing.assert_allclose(others, 0.0, atol=1e-14)


def test_pitch_is_shared_equally_by_the_tail_and_the_pair_ahead(law):
    """#2 alone, and #3 with #4, are the text's "two equal contributions"; the printed sign cancels them."""
    throttle = np.asarray(throttle_of(law, np.array([0.0, 0.2, 0.0]), np.zeros(3)))
    moments = throttle * ARMS[:, 1]
    assert moments[1] == pytest.approx(moments[2] + moments[3], rel=1e-14)  # 2.2675 · 2 · 2 = 9.07 exactly
    assert moments.sum() == pytest.approx(-2.0 * 9.07 * K_Q * 0.2, rel=1e-14)


@pytest.mark.parametrize(("axis", "gain"), [(0, K_PHI), (1, K_THETA)])
def test_level_is_sought_in_roll_and_pitch(law, axis, gain):
    attitude = np.zeros(3)
    attitude[axis] = 0.3
    moment = np.asarray(throttle_of(law, np.zeros(3), attitude)) @ ARMS
    lever = {0: 2 * 1.8634, 1: 2 * 9.07}[axis]
    assert moment[axis] == pytest.approx(-gain * 0.3 * lever, rel=1e-14)  # two products


def test_heading_itself_is_left_alone(law):
    found = np.asarray(throttle_of(law, np.zeros(3), np.array([0.0, 0.0, 1.0])))
    np.testing.assert_array_equal(found, np.zeros(6))


def test_targets_shift_the_level():
    changes = {"control.attitude.pitch_target": 0.1, "control.attitude.roll_target": -0.05}
    law = ts.load_scenario("docking", changes).law(layers=()).laws[0]
    at_target = np.asarray(throttle_of(law, np.zeros(3), np.array([-0.05, 0.1, 2.0])))
    np.testing.assert_allclose(at_target, 0.0, atol=1e-16)
    level = np.asarray(throttle_of(law, np.zeros(3), np.zeros(3)))
    assert level[1] == pytest.approx(K_THETA * 0.1, rel=1e-14)  # #2 pushes the tail down: nose up, as asked
    assert level[2] - level[3] == pytest.approx(-2 * K_PHI * 0.05, rel=1e-14)
