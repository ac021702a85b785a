"""Rigid-body inertia, held against a cloud of point masses summed one by one.

Truth: Newton's law for each point of the cloud. If this failed, Eq. 1 would carry a wrong sign or a lost cross
product, and every motion with rotation, or with G away from P, would be wrong.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tethership.physics.rigid_body import RigidBody
from tethership.spatial import skew

POINTS = 7
# Sums of a few hundred products of numbers up to 1e4: rounding stays below 1e-12 of the largest term.
ROUNDING = 1e-12


def vectors(count, bound=3.0):
    return arrays(np.float64, count, elements=st.floats(-bound, bound))


def cloud(seed):
    """Return masses [kg] and places [m] of a cloud of points, G well away from P."""
    rng = np.random.default_rng(seed)
    return rng.uniform(1.0, 30.0, POINTS), rng.uniform(-4.0, 4.0, (POINTS, 3)) + rng.uniform(-2.0, 2.0, 3)


def body_of(masses, places):
    """Return the rigid body of a cloud, by the definitions of mass, centre and inertia matrix."""
    inertia = sum(m * (q @ q * np.eye(3) - np.outer(q, q)) for m, q in zip(masses, places, strict=True))
    return RigidBody(jnp.asarray(masses.sum()), jnp.asarray(masses @ places / masses.sum()), jnp.asarray(inertia))


@jax.jit
def left_side(body, velocity, rates, acceleration, spin_up):
    """Return Mⁱẇ + w × Mⁱw."""
    turned = body.gyroscopic(velocity, rates)
    return body.mass_matrix() @ jnp.concatenate([acceleration, spin_up]) + turned.as_vector()


@settings(deadline=None, derandomize=True, max_examples=60)
@given(seed=st.integers(0, 10**6), motion=vectors(12))
def test_left_side_is_newtons_law_of_every_point(seed, motion):
    masses, places = cloud(seed)
    v, w, a, b = motion.reshape(4, 3)
    point_acceleration = a + np.cross(w, v) + np.cross(b, places) + np.cross(w, np.cross(w, places))
    forces = masses[:, None] * point_acceleration
    expected = np.concatenate([forces.sum(axis=0), np.cross(places, forces).sum(axis=0)])
    found = np.asarray(left_side(body_of(masses, places), v, w, a, b))
    size = np.abs(masses[:, None] * (1.0 + np.abs(places).max()) ** 2).sum() * (1.0 + np.abs(motion).max()) ** 2
    assert np.abs(found - expected).max() < ROUNDING * size


@settings(deadline=None, derandomize=True, max_examples=40)
@given(seed=st.integers(0, 10**6), motion=vectors(6))
def test_mass_matrix_gives_the_kinetic_energy_of_every_point(seed, motion):
    masses, places = cloud(seed)
    v, w = motion.reshape(2, 3)
    energy = 0.5 * masses @ np.sum((v + np.cross(w, places)) ** 2, axis=1)
    matrix = np.asarray(body_of(masses, places).mass_matrix())
    # The two sums cancel where the cloud nearly rests; compared against the size of their terms.
    size = 0.5 * np.abs(motion) @ np.abs(matrix) @ np.abs(motion)
    assert abs(0.5 * motion @ matrix @ motion - energy) <= ROUNDING * max(size, 1e-200)


@pytest.mark.parametrize("seed", range(5))
def test_mass_matrix_is_symmetric_and_positive_definite(seed):
    matrix = np.asarray(body_of(*cloud(seed)).mass_matrix())
    np.testing.assert_array_equal(matrix, matrix.T)  # built from the same entries: no rounding between them
    assert np.linalg.eigvalsh(matrix).min() > 0


@settings(deadline=None, derandomize=True, max_examples=40)
@given(seed=st.integers(0, 10**6), motion=vectors(6))
def test_gyroscopic_wrench_does_no_work(seed, motion):
    body = body_of(*cloud(seed))
    v, w = motion.reshape(2, 3)
    wrench = np.asarray(body.gyroscopic(jnp.asarray(v), jnp.asarray(w)).as_vector())
    # Every product of the sum is bounded by |wrench||motion|.
    assert abs(wrench @ motion) <= ROUNDING * max(np.abs(wrench).max() * np.abs(motion).max() * 6, 1e-200)


def test_off_diagonal_inertia_is_the_matrix_entry():
    """J₁₃ = −88 kg m²: a steady roll rate needs ω × Jω = (0, −J₁₃p², 0), +88 p² N m about pitch."""
    inertia = jnp.array([[214.0, 0.0, -88.0], [0.0, 3310.0, 0.0], [-88.0, 0.0, 3211.0]])
    body = RigidBody(jnp.asarray(136.8), jnp.zeros(3), inertia)
    wrench = body.gyroscopic(jnp.zeros(3), jnp.array([0.5, 0.0, 0.0]))
    # Exact in binary: 88 · 0.25.
    np.testing.assert_array_equal(np.asarray(wrench.moment), [0.0, 22.0, 0.0])
    np.testing.assert_array_equal(np.asarray(wrench.force), np.zeros(3))


def test_j13_is_negative_for_mass_forward_and_low():
    """The sign convention itself: −Σ m x z, so mass ahead and below (x, z > 0) gives a negative J₁₃."""
    body = body_of(np.array([2.0, 2.0]), np.array([[3.0, 0.0, 1.0], [-3.0, 0.0, -1.0]]))
    assert float(body.mass_matrix()[3, 5]) == -12.0


@pytest.mark.parametrize("seed", range(4))
def test_mass_matrix_moves_with_the_reference_point(seed):
    """Taken about P′ = P + Δ the same cloud has M′ = TᵀMT, v_P = v_P′ − ω × Δ."""
    masses, places = cloud(seed)
    offset = np.array([1.3, -0.4, 0.8])
    transfer = np.block([[np.eye(3), np.asarray(skew(jnp.asarray(offset)))], [np.zeros((3, 3)), np.eye(3)]])
    here = np.asarray(body_of(masses, places).mass_matrix())
    there = np.asarray(body_of(masses, places - offset).mass_matrix())
    # Entries up to a few thousand, a handful of products each.
    np.testing.assert_allclose(transfer.T @ here @ transfer, there, rtol=0, atol=1e-10)
