"""Load on a cable per unit length: weight and wind. Depends on: spatial.

References
----------
Eqs. 14–18 of Riboldi et al. Drag and lift of Eqs. 15–18 are together the cross-flow principle,

    l_d + l_n = −½ ρ D ( C_dc |v_n| v_n + C_dl |v_C| v_C ),    v_n = v_C − j (j·v_C)

which has no angle and no NaN at α = 0 (Hoerner, *Fluid-Dynamic Drag*, 1965: C_dc = 1.1, C_dl = 0.02).
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.spatial import STANDARD_GRAVITY, safe_norm


class CableLoad(eqx.Module):
    """What a cable weighs and how much wind it catches.

    Attributes
    ----------
    diameter : float
        D [m].
    linear_density : float
        Mass per unit unstretched length ρ_t [kg/m].
    cross_flow_drag_coefficient : float
        C_dc [-], on the diameter.
    longitudinal_drag_coefficient : float
        C_dl [-], on the diameter.
    """

    diameter: Float[Array, ""]
    linear_density: Float[Array, ""]
    cross_flow_drag_coefficient: Float[Array, ""]
    longitudinal_drag_coefficient: Float[Array, ""]

    def per_length(
        self, density: Float[Array, ""], air_velocity: Float[Array, "3"], span: Float[Array, "3"]
    ) -> Float[Array, "3"]:
        """Return the uniform load l per unit length, ground axes [N/m].

        Parameters
        ----------
        density : Float[Array, ""]
            ρ [kg/m³].
        air_velocity : Float[Array, "3"]
            Velocity of the reference point C relative to the air v_C, ground axes [m/s].
        span : Float[Array, "3"]
            d = x_TP − x_AP, ground axes [m]. Ends that coincide have no direction: the whole wind counts as
            cross-flow there.
        """
        square = jnp.dot(span, span)
        apart = square > 0
        direction = jnp.where(apart, span / jnp.sqrt(jnp.where(apart, square, 1.0)), 0.0)
        cross = air_velocity - direction * jnp.dot(direction, air_velocity)
        drag = (
            self.cross_flow_drag_coefficient * safe_norm(cross) * cross
            + self.longitudinal_drag_coefficient * safe_norm(air_velocity) * air_velocity
        )
        weight = jnp.stack([0.0, 0.0, STANDARD_GRAVITY]) * self.linear_density
        return weight - 0.5 * density * self.diameter * drag
