"""Everything around the ship: gravity, density, wind, gusts, fluctuations. Depends on: physics, spatial."""

import dataclasses

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics import AbstractAtmosphere, AbstractGust, AbstractWind, CosineGust, GroundEffect
from tethership.physics.turbulence import AbstractFluctuation


class Air(eqx.Module):
    """The air at the centre of buoyancy B at one instant.

    Attributes
    ----------
    density : float
        ρ [kg/m³].
    wind : Float[Array, "3"]
        Velocity of the air the ship feels, ground effect included, ground axes [m/s].
    wind_rate_ship : Float[Array, "3"]
        (∂t + v·∇) v_w along the ship's path, ground axes [m/s²].
    wind_rate_fluid : Float[Array, "3"]
        (∂t + v_w·∇) v_w, the air's own acceleration, ground axes [m/s²].
    rotation : Float[Array, "3"] or None
        Rate at which the air's gradient along the hull seems to turn it, ground axes [rad/s]; None without gradients.
    """

    density: Float[Array, ""]
    wind: Float[Array, "3"]
    wind_rate_ship: Float[Array, "3"]
    wind_rate_fluid: Float[Array, "3"]
    rotation: Float[Array, "3"] | None


class Environment(eqx.Module):
    """Fields of the flight.

    Attributes
    ----------
    gravity : Float[Array, "3"]
        Acceleration of gravity g, ground axes [m/s²].
    atmosphere : AbstractAtmosphere
        Gives ρ from altitude.
    wind : AbstractWind
        Steady wind.
    gusts : tuple of AbstractGust
        Added to the wind.
    fluctuations : tuple of AbstractFluctuation
        Turbulence or a measured history about the mean wind; a trim leaves them out.
    ground_effect : GroundEffect or None
        Extra vertical wind, or nothing.
    ground : float
        Down coordinate of the ground [m].
    """

    gravity: Float[Array, "3"]
    atmosphere: AbstractAtmosphere
    wind: AbstractWind
    gusts: tuple[AbstractGust, ...]
    fluctuations: tuple[AbstractFluctuation, ...]
    ground_effect: GroundEffect | None
    ground: Float[Array, ""]

    def density_at(self, position: Float[Array, "3"]) -> Float[Array, ""]:
        """Return ρ [kg/m³] at a position, ground axes [m]."""
        return self.atmosphere.density(-position[2])

    def wind_at(self, position: Float[Array, "3"], time: Float[Array, ""]) -> Float[Array, "3"]:
        """Return wind, gusts and fluctuations [m/s], ground axes, at a position [m] and time [s]."""
        total = self.wind.velocity(position)
        for addition in (*self.gusts, *self.fluctuations):
            total = total + addition.velocity(time)
        return total

    def rotation_at(self, time: Float[Array, ""], axis: Float[Array, "3"]) -> Float[Array, "3"] | None:
        """Return the apparent rotation of the air [rad/s], ground axes, at t [s] for a hull along a unit vector."""
        parts = [part for f in self.fluctuations if (part := f.rotation(time, axis)) is not None]
        return sum(parts[1:], parts[0]) if parts else None

    def without_fluctuations(self) -> "Environment":
        """Return the mean air: that in which a ship is trimmed."""
        return dataclasses.replace(self, fluctuations=())

    def with_a_gust(self) -> "Environment":
        """Return the same air with a gust, a silent one where there is none: one structure with and without."""
        return self if self.gusts else dataclasses.replace(self, gusts=(CosineGust.silent(),))

    def air(
        self,
        position: Float[Array, "3"],
        velocity: Float[Array, "3"],
        axis: Float[Array, "3"],
        time: Float[Array, ""],
    ) -> Air:
        """Return the air met at B.

        Parameters
        ----------
        position, velocity : Float[Array, "3"]
            Of B over the ground, ground axes [m, m/s].
        axis : Float[Array, "3"]
            Unit vector along the hull, ground axes.
        time : Float[Array, ""]
            t [s].
        """
        one = jnp.ones_like(time)
        wind, along_ship = jax.jvp(self.wind_at, (position, time), (velocity, one))
        _, along_fluid = jax.jvp(self.wind_at, (position, time), (wind, one))
        felt = wind
        if self.ground_effect is not None:
            felt = wind + self.ground_effect.velocity(position, velocity)
        return Air(self.density_at(position), felt, along_ship, along_fluid, self.rotation_at(time, axis))

    def corner_times(self) -> Float[Array, "n"]:
        """Return the times [s] at which a gust begins or ends, sorted."""
        if not self.gusts:
            return jnp.zeros(0)
        return jnp.sort(jnp.concatenate([gust.corners() for gust in self.gusts]))
