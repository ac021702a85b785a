"""Fins: lumped normal force, cross-flow drag and friction, any number at any roll angle. Depends on: spatial.

Each fin has a spanwise unit vector s = (0, cos Γ, sin Γ) with the roll angle Γ from starboard (0) through down
(90°), and a normal n = b₁ × s. Forces follow from the airspeed at its own centres, v_f = v_a + ω × q.

References
----------
Jones & DeLaurier, "Aerodynamic estimation techniques for aerostats and airships", J. Aircraft 20 (1983);
Mueller, Paluszek & Zhao, AIAA 2004-6243. The paper's own fins are not published.
"""

import math

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.spatial import Wrench

USUAL_DEFLECTION = math.radians(20.0)
"""Largest deflection of a fin whose file gives none [rad]: ±20°, assumed as the usual stop of an airship's surfaces."""


class Fins(eqx.Module):
    """All fins of a ship, one row each.

    Attributes
    ----------
    aerodynamic_centre : Float[Array, "fins 3"]
        Where the attached normal force acts, from P, body axes, q_f [m].
    cross_flow_centre : Float[Array, "fins 3"]
        Where the cross-flow drag acts, from P, body axes, q_c [m].
    normal : Float[Array, "fins 3"]
        Unit normal n, body axes [-].
    lift_area : Float[Array, "fins"]
        S C_Nα η_f, area times slope of the normal force times efficiency [m²/rad].
    cross_flow_area : Float[Array, "fins"]
        S C_Dc, area times cross-flow drag coefficient [m²].
    friction_area : Float[Array, "fins"]
        S C_D0, area times axial drag coefficient [m²].
    largest_deflection : Float[Array, "fins"] or float
        Largest |δ| of each [rad].
    """

    aerodynamic_centre: Float[Array, "fins 3"]
    cross_flow_centre: Float[Array, "fins 3"]
    normal: Float[Array, "fins 3"]
    lift_area: Float[Array, "fins"]
    cross_flow_area: Float[Array, "fins"]
    friction_area: Float[Array, "fins"]
    largest_deflection: Float[Array, "fins"] | float = USUAL_DEFLECTION

    @property
    def count(self) -> int:
        """Number of fins."""
        return self.lift_area.shape[0]

    def saturate(self, deflection: Float[Array, "fins"]) -> Float[Array, "fins"]:
        """Return the deflection δ [rad] clipped to what each fin can do."""
        return jnp.clip(deflection, -self.largest_deflection, self.largest_deflection)

    def wrench(
        self,
        density: Float[Array, ""],
        air_velocity: Float[Array, "3"],
        rates: Float[Array, "3"],
        deflection: Float[Array, "fins"],
    ) -> Wrench:
        """Return the wrench of all fins about P, body axes [N, N m].

        Parameters
        ----------
        density : Float[Array, ""]
            ρ [kg/m³].
        air_velocity : Float[Array, "3"]
            Velocity of P relative to the air v_a, body axes [m/s].
        rates : Float[Array, "3"]
            ω, body axes [rad/s].
        deflection : Float[Array, "fins"]
            δ [rad], added to the incidence v_n / v_x; within the limits of `saturate`.

        Notes
        -----
        Normal −½ρ [S C_Nα η_f |v_x| (v_n + v_x δ) at q_f, S C_Dc |v_n| v_n at q_c], axial −½ρ S C_D0 |v_x| v_x
        at q_f. The attached part is the ½ sin 2α form: |v_x| v_n = V² |cos α| sin α.
        """
        at_centre = air_velocity + jnp.cross(rates, self.aerodynamic_centre)
        at_cross = air_velocity + jnp.cross(rates, self.cross_flow_centre)
        axial = at_centre[:, 0]
        normal = jnp.sum(at_centre * self.normal, axis=1)
        cross = jnp.sum(at_cross * self.normal, axis=1)
        attached = self.lift_area * jnp.abs(axial) * (normal + axial * deflection)
        separated = self.cross_flow_area * jnp.abs(cross) * cross
        friction = self.friction_area * jnp.abs(axial) * axial
        nose = jnp.array([1.0, 0.0, 0.0])
        force_centre = -0.5 * density * (attached[:, None] * self.normal + friction[:, None] * nose)
        force_cross = -0.5 * density * separated[:, None] * self.normal
        moment = jnp.cross(self.aerodynamic_centre, force_centre) + jnp.cross(self.cross_flow_centre, force_cross)
        return Wrench(jnp.sum(force_centre + force_cross, axis=0), jnp.sum(moment, axis=0))
