"""Ground effect as the paper describes it: an extra vertical wind felt by the hull. Depends on: spatial.

Section 4.1 of Riboldi et al.: "a vertical wind component proportional to the ground speed and to the altitude
from the ground". The print gives no coefficient and no sign; both are in the one number here. It depends on the
ship's own speed, so it is no property of the air and stays out of the acceleration of the wind.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.spatial import safe_norm


class GroundEffect(eqx.Module):
    """Vertical wind c V h.

    Attributes
    ----------
    coefficient : float
        c [1/m], positive for upward air.
    ground : float
        Down coordinate of the ground [m].
    """

    coefficient: Float[Array, ""]
    ground: Float[Array, ""]

    def velocity(self, position: Float[Array, "3"], velocity: Float[Array, "3"]) -> Float[Array, "3"]:
        """Return the extra wind [m/s], ground axes.

        Parameters
        ----------
        position : Float[Array, "3"]
            Where the ship is (B), ground axes [m].
        velocity : Float[Array, "3"]
            Its ground velocity, ground axes [m/s].
        """
        height = jnp.maximum(self.ground - position[2], 0.0)
        upward = self.coefficient * safe_norm(velocity) * height
        return jnp.zeros(3).at[2].set(-upward)
