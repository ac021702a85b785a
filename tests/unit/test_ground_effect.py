"""Ground effect as the paper words it: a vertical wind proportional to ground speed and to height.

Truth: the proportionality itself, the sign (positive coefficient: air moves up, so D is negative) and rest.
If this fails, claim D7 is tested with another model, or a ship at rest has a NaN in its linear model.
"""

import jax
import jax.numpy as jnp
import numpy as np

from tethership.physics.ground_effect import GroundEffect

EFFECT = GroundEffect(jnp.asarray(0.01), jnp.asarray(5.0))  # 0.01 1/m, ground 5 m below the anchor
HERE = jnp.array([1.0, 2.0, -15.0])  # 20 m above ground
MOVING = jnp.array([0.0, 3.0, 4.0])  # 5 m/s


def test_upward_air_by_hand():
    np.testing.assert_allclose(EFFECT.velocity(HERE, MOVING), [0, 0, -0.01 * 5.0 * 20.0], rtol=1e-15)


def test_proportional_to_speed_and_to_height():
    base = np.asarray(EFFECT.velocity(HERE, MOVING))
    np.testing.assert_allclose(EFFECT.velocity(HERE, -3.0 * MOVING), 3.0 * base, rtol=1e-15)
    np.testing.assert_allclose(EFFECT.velocity(HERE.at[2].set(-35.0), MOVING), 2.0 * base, rtol=1e-15)


def test_nothing_below_ground():
    np.testing.assert_array_equal(EFFECT.velocity(HERE.at[2].set(6.0), MOVING), np.zeros(3))


def test_finite_gradient_at_rest_and_at_the_ground():
    for position in (HERE, HERE.at[2].set(5.0)):
        slopes = jax.jacrev(EFFECT.velocity, argnums=(0, 1))(position, jnp.zeros(3))
        assert all(np.isfinite(slope).all() for slope in slopes)
