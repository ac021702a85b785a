"""Weight and buoyancy, held against the paper's numbers and against statics worked by hand.

Truth: Archimedes and the data of Table 2. If this failed, the ship would be light instead of 17 N heavy, would
pitch the wrong way under its own weight, or would float upside down.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from tethership.physics.buoyancy import Buoyancy
from tethership.physics.gravity import Gravity
from tethership.spatial import SEA_LEVEL_DENSITY, STANDARD_GRAVITY, rotation_matrix

MASS, VOLUME = 136.8, 110.3
Q_G = np.array([-0.06, 0.0, 0.455])
DOWN = jnp.array([0.0, 0.0, STANDARD_GRAVITY])

gravity = Gravity(jnp.asarray(MASS), jnp.asarray(Q_G))
buoyancy = Buoyancy(jnp.asarray(VOLUME), jnp.zeros(3))


@jax.jit
def statics(attitude, offset):
    """Return the sum of weight and buoyancy about a P moved by `offset`, and R."""
    rotation = rotation_matrix(attitude)
    local = rotation.T @ DOWN
    weight = Gravity(gravity.mass, gravity.centre - offset).wrench(local)
    lift = Buoyancy(buoyancy.volume, buoyancy.centre - offset).wrench(SEA_LEVEL_DENSITY, local)
    return (weight + lift), rotation


def test_displaced_air_at_sea_level_weighs_135_kg():
    force = buoyancy.wrench(jnp.asarray(SEA_LEVEL_DENSITY), DOWN).force
    # the notes section 5 prints 135.1 kg: half of its last digit.
    assert float(-force[2]) / STANDARD_GRAVITY == pytest.approx(135.1, abs=0.05)


def test_ship_is_seventeen_newton_heavy():
    total, _ = statics(jnp.zeros(3), jnp.zeros(3))
    # "About 17 N": 136.8 kg less 1.225 × 110.3 kg is 1.6825 kg, 16.5 N; the print rounds to the newton.
    assert float(total.force[2]) == pytest.approx(17.0, abs=0.6)
    # The same in full: ISA density 1.225000 kg/m³ is good to 1e-6, 1e-3 N in 1325 N.
    assert float(total.force[2]) == pytest.approx((MASS - 1.225 * VOLUME) * STANDARD_GRAVITY, abs=2e-3)


def test_centre_of_gravity_behind_b_pitches_the_nose_up():
    moment = np.asarray(gravity.wrench(DOWN).moment)
    # "+80 N m nose up": 0.06 m × 1341.5 N = 80.5 N m; the print rounds to the newton metre.
    assert moment[1] == pytest.approx(80.0, abs=0.6)
    assert moment[1] == pytest.approx(0.06 * MASS * STANDARD_GRAVITY, rel=1e-14)  # one product
    assert moment[0] == 0.0
    assert moment[2] == 0.0


@pytest.mark.parametrize(("axis", "name"), [(0, "roll"), (1, "pitch")])
def test_low_centre_of_gravity_rights_the_ship(axis, name):
    """A small angle is answered by −m g z_G per radian about its own axis: the pendulum."""
    step = 1e-5
    moments = [
        float(statics(jnp.zeros(3).at[axis].set(angle), jnp.zeros(3))[0].moment[axis]) for angle in (-step, step)
    ]
    slope = (moments[1] - moments[0]) / (2 * step)
    # Central difference of sine: step²/6 = 2e-11 relative, rounding 1e-13 · 600/1e-5 = 1e-8 relative.
    assert slope == pytest.approx(-MASS * STANDARD_GRAVITY * Q_G[2], rel=1e-7), name


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    attitude=arrays(np.float64, 3, elements=st.floats(-1.5, 1.5)),
    offset=arrays(np.float64, 3, elements=st.floats(-5, 5)),
)
def test_forces_are_vertical_and_the_moment_follows_the_reference_point(attitude, offset):
    about_p, rotation = statics(attitude, np.zeros(3))
    moved, _ = statics(attitude, offset)
    ground = np.asarray(rotation @ about_p.force)
    # Differences of terms of 1340 N (times a few metres): rounding of 1e-11.
    np.testing.assert_allclose(ground[:2], 0.0, atol=1e-11)
    assert ground[2] == pytest.approx((MASS - SEA_LEVEL_DENSITY * VOLUME) * STANDARD_GRAVITY, abs=1e-11)
    expected = np.asarray(about_p.moment) - np.cross(offset, np.asarray(about_p.force))
    np.testing.assert_allclose(np.asarray(moved.moment), expected, atol=1e-10)


def test_buoyancy_has_no_moment_about_its_own_centre_but_one_about_any_other():
    local = rotation_matrix(jnp.array([0.3, -0.2, 1.0])).T @ DOWN
    density = jnp.asarray(1.1)
    np.testing.assert_array_equal(np.asarray(buoyancy.wrench(density, local).moment), np.zeros(3))
    aft = Buoyancy(jnp.asarray(VOLUME), jnp.array([-2.0, 0.0, 0.0])).wrench(density, DOWN)
    # Lift two metres behind P pushes the nose down: −2 m × 1.1 × 110.3 × g.
    assert float(aft.moment[1]) == pytest.approx(-2.0 * 1.1 * VOLUME * STANDARD_GRAVITY, rel=1e-14)
