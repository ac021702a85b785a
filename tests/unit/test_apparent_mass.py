"""Apparent mass: its matrix about any point, and Kirchhoff's equations against the kinetic energy of the air.

Truth: the energy T(v_a, ω) of the air, differentiated by JAX into Lagrange's equations in quasi-velocities, which
share no line with the module; Munk's moment and the inertia force of accelerating air in closed form. If this
failed, the ship would gain energy from nothing, or feel a wind that blows steadily as a force.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tethership.physics.apparent_mass import KirchhoffApparentMass, PublishedApparentMass
from tethership.spatial import skew

VOLUME = 110.3
FACTORS = np.array([0.08, 0.86, 0.86])
ROTATIONAL = np.array([0.0, 0.69 * 13.6, 0.69 * 13.6])
DENSITY = 1.2
NONE = jnp.zeros(3)


def apparent(kind=KirchhoffApparentMass, centre=(0.0, 0.0, 0.0)):
    return kind(
        volume=jnp.asarray(VOLUME),
        centre=jnp.asarray(centre),
        translational=jnp.asarray(VOLUME * FACTORS),
        rotational=jnp.asarray(VOLUME * ROTATIONAL),
    )


def vectors(count, bound=5.0):
    return arrays(np.float64, count, elements=st.floats(-bound, bound))


def energy_of_air(motion, centre):
    """Return T/ρ of the air for the air-relative motion (v_P, ω) of a body whose B is at `centre`."""
    at_b = motion[:3] + jnp.cross(motion[3:], centre)
    return 0.5 * VOLUME * (jnp.sum(FACTORS * at_b**2) + jnp.sum(ROTATIONAL * motion[3:] ** 2))


@settings(deadline=None, derandomize=True, max_examples=40)
@given(centre=vectors(3), motion=vectors(6))
def test_matrix_carries_the_energy_to_any_reference_point(centre, motion):
    """½ wᵀ M_P w is the energy of the same motion about B, so M_P = TᵀM_BT."""
    matrix = np.asarray(apparent(centre=centre).matrix())
    transfer = np.block([[np.eye(3), -np.asarray(skew(jnp.asarray(centre)))], [np.zeros((3, 3)), np.eye(3)]])
    about_b = np.asarray(apparent().matrix())
    # Entries up to 5²·95 m⁵ = 2400; a dozen products each.
    np.testing.assert_allclose(matrix, transfer.T @ about_b @ transfer, rtol=0, atol=1e-10)
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=1e-10)
    size = np.abs(motion) @ np.abs(matrix) @ np.abs(motion)
    energy = float(energy_of_air(jnp.asarray(motion), jnp.asarray(centre)))
    assert abs(0.5 * motion @ matrix @ motion - energy) <= 1e-13 * max(size, 1e-200)


def test_matrix_at_b_is_diagonal_and_about_the_axis_nothing_turns():
    matrix = np.asarray(apparent().matrix())
    np.testing.assert_array_equal(matrix, np.diag(np.concatenate([VOLUME * FACTORS, VOLUME * ROTATIONAL])))
    assert matrix[3, 3] == 0.0
    assert np.linalg.eigvalsh(np.asarray(apparent(centre=(2.0, -1.0, 0.5)).matrix())).min() > -1e-9


@jax.jit
def lagrange(motion, acceleration, centre):
    """Return minus the rate of the air's impulse about P per ρ, for the *air-relative* motion and its rate.

    f = −d/dt ∂T/∂v − ω × ∂T/∂v,  m = −d/dt ∂T/∂ω − ω × ∂T/∂ω − v × ∂T/∂v.
    """
    impulse, rate = jax.jvp(jax.grad(energy_of_air), (motion, centre), (acceleration, jnp.zeros(3)))
    v, w = motion[:3], motion[3:]
    force = -rate[:3] - jnp.cross(w, impulse[:3])
    moment = -rate[3:] - jnp.cross(w, impulse[3:]) - jnp.cross(v, impulse[:3])
    return jnp.concatenate([force, moment])


@jax.jit
def reaction(ground_acceleration, velocity, rates, centre, wind, along_ship, along_fluid):
    """Return the module's whole reaction −Mᵃẇ + wrench about P."""
    model = KirchhoffApparentMass(
        jnp.asarray(VOLUME), centre, jnp.asarray(VOLUME * FACTORS), jnp.asarray(VOLUME * ROTATIONAL)
    )
    at_b = velocity + jnp.cross(rates, centre) - wind
    rest = model.wrench(jnp.asarray(DENSITY), at_b, rates, wind, along_ship, along_fluid).as_vector()
    return rest - DENSITY * model.matrix() @ ground_acceleration


@settings(deadline=None, derandomize=True, max_examples=60)
@given(motion=vectors(6), acceleration=vectors(6), centre=vectors(3, 3.0), winds=vectors(9))
def test_kirchhoff_is_lagrange_with_the_energy_of_the_air(motion, acceleration, centre, winds):
    """In moving, accelerating air: Lagrange in the relative motion, plus ρ𝒱 Dv_w/Dt at B."""
    wind, along_ship, along_fluid = winds.reshape(3, 3)
    v, w = motion.reshape(2, 3)
    found = np.asarray(reaction(acceleration, v, w, centre, wind, along_ship, along_fluid))
    # d/dt (Rᵀv_w) = −ω × Rᵀv_w + Rᵀ dv_w/dt: the wind seen from the turning body.
    relative_rate = np.concatenate([acceleration[:3] + np.cross(w, wind) - along_ship, acceleration[3:]])
    relative = np.concatenate([v - wind, w])
    expected = DENSITY * np.asarray(lagrange(relative, relative_rate, centre))
    push = DENSITY * VOLUME * along_fluid
    expected += np.concatenate([push, np.cross(centre, push)])
    # Terms up to 132 kg · 25 · 10 m²/s² · 3 m: 1e5, times rounding of some twenty operations.
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-9)


def test_munk_moment_turns_the_nose_away_from_the_flow():
    """Steady flight at incidence in still air: (k₃ − k₁)ρ𝒱uw nose-up for w > 0, −(k₂ − k₁)ρ𝒱uv for v > 0."""
    u, v, w = 8.0, 0.7, -1.1
    wrench = apparent().wrench(jnp.asarray(DENSITY), jnp.array([u, v, w]), NONE, NONE, NONE, NONE)
    munk = (0.86 - 0.08) * DENSITY * VOLUME
    # Moments of 1e3 N m, two products each; d'Alembert: no force.
    np.testing.assert_allclose(np.asarray(wrench.moment), [0.0, munk * u * w, -munk * u * v], rtol=0, atol=1e-11)
    np.testing.assert_array_equal(np.asarray(wrench.force), np.zeros(3))


def test_body_held_in_accelerating_air_feels_inertia_force():
    """ρ𝒱(1 + k)a along each axis (Morison), with both ways of differentiating the wind the same for a gust."""
    gust = jnp.array([0.3, -0.2, 0.5])
    wrench = apparent().wrench(jnp.asarray(DENSITY), NONE, NONE, NONE, gust, gust)
    expected = DENSITY * VOLUME * (1.0 + FACTORS) * np.asarray(gust)
    np.testing.assert_allclose(np.asarray(wrench.force), expected, rtol=1e-14)  # one product per axis


def test_steady_wind_on_a_body_at_rest_is_the_moment_of_the_flow_alone():
    """No force, and the same moment as flight through still air at −v_w."""
    wind = jnp.array([-6.0, 1.0, 0.5])
    held = apparent().wrench(jnp.asarray(DENSITY), -wind, NONE, wind, NONE, NONE)
    flying = apparent().wrench(jnp.asarray(DENSITY), -wind, NONE, NONE, NONE, NONE)
    np.testing.assert_array_equal(np.asarray(held.as_vector()), np.asarray(flying.as_vector()))
    assert float(jnp.abs(held.force).max()) == 0.0


@pytest.mark.parametrize("centre", [(0.0, 0.0, 0.0), (1.0, 0.2, -0.4)])
def test_published_adds_nothing_but_the_matrix(centre):
    """Eq. 1 as printed: the same Mᵃ, and not a single further term however the air moves."""
    model = apparent(PublishedApparentMass, centre)
    some = jnp.array([1.0, 2.0, 3.0])
    wrench = model.wrench(jnp.asarray(DENSITY), some, some, some, some, some)
    np.testing.assert_array_equal(np.asarray(wrench.as_vector()), np.zeros(6))
    np.testing.assert_array_equal(np.asarray(model.matrix()), np.asarray(apparent(centre=centre).matrix()))
