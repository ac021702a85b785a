"""Steady wind: uniform, or a power-law or logarithmic profile over height. Depends on: nothing.

References
----------
Power law: IEC 61400-1 (2019), normal wind profile, V(h) = V_ref (h / h_ref)^α.
Logarithmic: neutral surface layer, e.g. Stull, *An Introduction to Boundary Layer Meteorology* (1988), section 9.7;
with z₀ = 0.15 ft the profile of MIL-F-8785C §3.7.3.2 for terminal flight phases.
"""

import abc

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float


class AbstractWind(eqx.Module):
    """A steady field of wind, ground axes [m/s]."""

    @abc.abstractmethod
    def velocity(self, position: Float[Array, "3"]) -> Float[Array, "3"]:
        """Return the wind velocity v_w [m/s], ground axes (N, E, D), at a position x [m], ground axes."""


class UniformWind(AbstractWind):
    """The same wind everywhere.

    Attributes
    ----------
    value : Float[Array, "3"]
        Velocity of the air v_w, ground axes [m/s]; a wind *from* the north is (−V, 0, 0).
    """

    value: Float[Array, "3"]

    def velocity(self, position: Float[Array, "3"]) -> Float[Array, "3"]:
        """Return v_w [m/s], ground axes, whatever the position x [m]."""
        return self.value


class PowerLawWind(AbstractWind):
    """Wind that grows with height above the ground, v_w = v_ref (h / h_ref)^α.

    Attributes
    ----------
    value : Float[Array, "3"]
        Wind at the reference height v_ref, ground axes [m/s].
    reference_height : float
        Height h_ref above the ground [m].
    exponent : float
        Shear exponent α [-], about 1/7 over open land.
    lowest_height : float
        Height below which the profile is held constant [m]: the law's slope is infinite at the ground.
    ground : float
        Down coordinate of the ground [m]; positive when the origin of the frame (the anchor) is above it.
    """

    value: Float[Array, "3"]
    reference_height: Float[Array, ""]
    exponent: Float[Array, ""]
    lowest_height: Float[Array, ""]
    ground: Float[Array, ""]

    def velocity(self, position: Float[Array, "3"]) -> Float[Array, "3"]:
        """Return v_w [m/s], ground axes, at a position x [m], ground axes."""
        height = jnp.maximum(self.ground - position[2], self.lowest_height)
        return self.value * jnp.exp(self.exponent * jnp.log(height / self.reference_height))


class LogarithmicWind(AbstractWind):
    """Wind of the neutral surface layer, v_w = v_ref ln(h/z₀) / ln(h_ref/z₀).

    Attributes
    ----------
    value : Float[Array, "3"]
        Wind at the reference height v_ref, ground axes [m/s].
    reference_height : float
        Height h_ref above the ground [m].
    roughness : float
        Roughness length z₀ [m], about 0.03 over grass.
    ground : float
        Down coordinate of the ground [m]; positive when the origin of the frame (the anchor) is above it.
    """

    value: Float[Array, "3"]
    reference_height: Float[Array, ""]
    roughness: Float[Array, ""]
    ground: Float[Array, ""]

    def velocity(self, position: Float[Array, "3"]) -> Float[Array, "3"]:
        """Return v_w [m/s], ground axes, at a position x [m], ground axes; none below z₀."""
        height = jnp.maximum(self.ground - position[2], self.roughness)
        return self.value * jnp.log(height / self.roughness) / jnp.log(self.reference_height / self.roughness)
