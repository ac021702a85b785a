"""Rotations: the ground and body axes mean what the paper's section 2 and Eqs. 6-7 say.

Truth: hand-turned axes, scipy's own rotations, Poisson's rule dR/dt = R skew(omega), and limits at zero.
If this fails, a sign or a frame is wrong everywhere else: nose-up would be nose-down, or body loads would be
summed in ground axes; or the gradient of a norm at rest is NaN and no trim point can be linearised.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tethership.spatial import (
    euler_rate_matrix,
    euler_rates,
    horizontal_unit,
    rotation_matrix,
    safe_norm,
    skew,
)

ROUNDING = 1e-14
"""Products of three sines and sums of two such: a few units of 1.1e-16, two decades to spare."""

SETTINGS = settings(deadline=None, derandomize=True, max_examples=200)
angles = st.tuples(
    st.floats(-np.pi, np.pi),
    st.floats(-1.5, 1.5),  # pitch short of 90 degrees, where 3-2-1 angles are unique
    st.floats(-np.pi, np.pi),
).map(jnp.array)
vectors = st.tuples(*[st.floats(-100.0, 100.0, allow_subnormal=False)] * 3).map(jnp.array)

rotate = jax.jit(rotation_matrix)


@pytest.mark.parametrize(
    ("degrees", "body", "ground"),
    [
        ((0, 0, 90), (1, 0, 0), (0, 1, 0)),  # yaw to the right: the nose points east
        ((0, 90, 0), (1, 0, 0), (0, 0, -1)),  # pitch up: the nose points up, D is down
        ((90, 0, 0), (0, 1, 0), (0, 0, 1)),  # roll to the right: starboard points down
        ((0, 0, 90), (0, 1, 0), (-1, 0, 0)),  # yaw to the right: starboard points south
        ((90, 0, 90), (0, 0, 1), (1, 0, 0)),  # yawed east, rolled right: the keel points north
        ((0, 30, 0), (1, 0, 0), (np.sqrt(3) / 2, 0, -0.5)),
    ],
)
def test_axes_turned_by_hand(degrees, body, ground):
    turned = rotate(jnp.radians(jnp.array(degrees, float))) @ jnp.array(body, float)
    np.testing.assert_allclose(turned, ground, atol=ROUNDING)


@SETTINGS
@given(angles)
def test_matrix_is_scipys_intrinsic_zyx(attitude):
    phi, theta, psi = np.asarray(attitude)
    np.testing.assert_allclose(
        rotate(attitude), Rotation.from_euler("ZYX", [psi, theta, phi]).as_matrix(), atol=ROUNDING
    )


@SETTINGS
@given(angles)
def test_angles_come_back_from_the_matrix(attitude):
    r = np.asarray(rotate(attitude))
    back = np.array([np.arctan2(r[2, 1], r[2, 2]), -np.arcsin(r[2, 0]), np.arctan2(r[1, 0], r[0, 0])])
    turns = np.exp(1j * back) - np.exp(1j * np.asarray(attitude))  # pi and -pi are the same angle
    # arcsin within 0.07 rad of 90 degrees multiplies rounding by 1/cos(1.5) = 14
    np.testing.assert_allclose(np.abs(turns), 0.0, atol=1e-13)


@SETTINGS
@given(angles)
def test_matrix_is_a_proper_rotation(attitude):
    r = np.asarray(rotate(attitude))
    np.testing.assert_allclose(r @ r.T, np.eye(3), atol=ROUNDING)
    np.testing.assert_allclose(np.linalg.det(r), 1.0, atol=ROUNDING)


@jax.jit
def _poisson(attitude, rates):
    _, turning = jax.jvp(rotation_matrix, (attitude,), (euler_rates(attitude, rates),))
    return turning, rotation_matrix(attitude) @ skew(rates)


@SETTINGS
@given(angles, vectors)
def test_euler_rates_obey_poissons_rule(attitude, rates):
    turning, expected = _poisson(attitude, rates)
    # rates of up to 170 rad/s times the 1/cos(1.5) = 14 of the kinematics near the pole
    np.testing.assert_allclose(turning, expected, atol=1e-11)


def test_euler_rates_in_a_banked_turn():
    # Level flight banked by phi, turning at psi_dot: q = psi_dot sin(phi), r = psi_dot cos(phi), p = 0.
    phi, turn = 0.4, 0.1
    rates = turn * jnp.array([0.0, np.sin(phi), np.cos(phi)])
    np.testing.assert_allclose(euler_rates(jnp.array([phi, 0.0, 1.0]), rates), [0, 0, turn], atol=ROUNDING)


def test_euler_rate_matrix_is_singular_at_the_pole():
    # det S^-1 = 1/cos(theta) exactly; at 89.9 degrees it is 573, not hidden by any guard.
    theta = np.radians(89.9)
    det = np.linalg.det(np.asarray(euler_rate_matrix(jnp.array([0.3, theta, -2.0]))))
    np.testing.assert_allclose(det, 1.0 / np.cos(theta), rtol=1e-9)  # 1e-16 / cos^2


@SETTINGS
@given(vectors, vectors)
def test_skew_is_the_cross_product(a, b):
    scale = float(jnp.linalg.norm(a) * jnp.linalg.norm(b))
    np.testing.assert_allclose(skew(a) @ b, np.cross(a, b), atol=1e-15 * scale)  # two products, one difference
    np.testing.assert_array_equal(skew(a), -skew(a).T)


@SETTINGS
@given(vectors)
def test_safe_norm_is_the_norm(a):
    np.testing.assert_allclose(safe_norm(a), np.linalg.norm(a), rtol=1e-15, atol=1e-150)  # squares underflow


def test_safe_norm_has_a_finite_gradient_at_zero():
    np.testing.assert_array_equal(jax.grad(safe_norm)(jnp.zeros(3)), np.zeros(3))
    np.testing.assert_array_equal(jax.jacfwd(safe_norm)(jnp.zeros(3)), np.zeros(3))
    a = jnp.array([3.0, -4.0, 12.0])
    np.testing.assert_allclose(jax.grad(safe_norm)(a), a / 13.0, rtol=1e-15)  # the unit vector


@SETTINGS
@given(angles)
def test_horizontal_unit_is_the_heading(attitude):
    # cos(theta) > 0.07 here, so the nose seen from above points along (cos psi, sin psi) whatever roll and
    # pitch.
    psi = float(attitude[2])
    np.testing.assert_allclose(horizontal_unit(rotate(attitude)), [np.cos(psi), np.sin(psi)], atol=1e-13)


def test_horizontal_unit_of_a_nose_straight_up_is_zero():
    up = jnp.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
    np.testing.assert_array_equal(horizontal_unit(up), [0.0, 0.0])
    assert np.isfinite(jax.jacfwd(horizontal_unit)(up)).all()
    assert np.isfinite(jax.jacrev(horizontal_unit)(up)).all()
