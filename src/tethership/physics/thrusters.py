"""Thrusters: any number, place and direction, reversible, saturating, scaled by density. Depends on: spatial.

References
----------
Eqs. 10–11 and Table 1 of Riboldi et al. (the cross of q_Ti × T_i is lost in print). The throttle law is not
published: thrust linear in throttle and in density, with a linear lapse in axial speed as an option.
"""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.spatial import SEA_LEVEL_DENSITY, Wrench


class Thrusters(eqx.Module):
    """All thrusters of a ship, one row each.

    Attributes
    ----------
    position : Float[Array, "thrusters 3"]
        Where each acts, from P, body axes, q_T [m].
    direction : Float[Array, "thrusters 3"]
        Unit vector of positive thrust t, body axes [-].
    nominal : Float[Array, "thrusters"]
        Thrust at full throttle, at rest, at sea level T_nom [N].
    lowest_throttle : Float[Array, "thrusters"]
        −1 where reversible, else 0 [-].
    lapse : Float[Array, "thrusters"]
        Loss of thrust per axial airspeed λ [s/m]; 1/λ is the speed at which thrust vanishes, 0 for none.
    """

    position: Float[Array, "thrusters 3"]
    direction: Float[Array, "thrusters 3"]
    nominal: Float[Array, "thrusters"]
    lowest_throttle: Float[Array, "thrusters"]
    lapse: Float[Array, "thrusters"]

    @property
    def count(self) -> int:
        """Number of thrusters."""
        return self.nominal.shape[0]

    def saturate(self, throttle: Float[Array, "thrusters"]) -> Float[Array, "thrusters"]:
        """Return the throttle δ [-] clipped to what each thruster can do, [−1 or 0, 1]."""
        return jnp.clip(throttle, self.lowest_throttle, 1.0)

    def thrust(
        self,
        density: Float[Array, ""],
        air_velocity: Float[Array, "3"],
        rates: Float[Array, "3"],
        throttle: Float[Array, "thrusters"],
    ) -> Float[Array, "thrusters"]:
        """Return the thrust of each along its direction [N]; the throttle is used as it comes, not clipped.

        Notes
        -----
        T = T_nom (ρ/ρ₀) (δ − λ |δ| v_T·t), v_T the airspeed at the thruster.
        """
        local = air_velocity + jnp.cross(rates, self.position)
        advance = jnp.sum(local * self.direction, axis=1)
        effective = throttle - self.lapse * jnp.abs(throttle) * advance
        return self.nominal * (density / SEA_LEVEL_DENSITY) * effective

    def wrench(
        self,
        density: Float[Array, ""],
        air_velocity: Float[Array, "3"],
        rates: Float[Array, "3"],
        throttle: Float[Array, "thrusters"],
    ) -> Wrench:
        """Return the wrench of all thrusters about P, body axes [N, N m].

        Parameters
        ----------
        density : Float[Array, ""]
            ρ [kg/m³].
        air_velocity : Float[Array, "3"]
            Velocity of P relative to the air v_a, body axes [m/s].
        rates : Float[Array, "3"]
            ω, body axes [rad/s].
        throttle : Float[Array, "thrusters"]
            δ [-], within the limits of `saturate`.

        Notes
        -----
        Σ (T_i, q_Ti × T_i), Eq. 11.
        """
        thrust = self.thrust(density, air_velocity, rates, throttle)
        arms = jnp.cross(self.position, self.direction)
        return Wrench(thrust @ self.direction, thrust @ arms)
