"""Air density: the International Standard Atmosphere in the troposphere, or a constant.

Depends on: spatial.

References
----------
ISO 2533:1975, Standard Atmosphere. The paper uses ISA for ρ(altitude); in every load ρ is the one at the
altitude of the centre of buoyancy B.
"""

import abc

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.spatial import (
    GAS_CONSTANT_AIR,
    SEA_LEVEL_PRESSURE,
    SEA_LEVEL_TEMPERATURE,
    STANDARD_GRAVITY,
    TEMPERATURE_LAPSE,
)


class AbstractAtmosphere(eqx.Module):
    """What gives the density of the air ρ [kg/m³] at an altitude [m]."""

    @abc.abstractmethod
    def density(self, altitude: Float[Array, ""]) -> Float[Array, ""]:
        """Return the density ρ [kg/m³] at an altitude [m] above the datum of the ground frame."""


class StandardAtmosphere(AbstractAtmosphere):
    """ISA troposphere: temperature falls linearly, the column is in hydrostatic balance.

    Attributes
    ----------
    origin_altitude : float
        Altitude of the origin of the ground frame above mean sea level [m].
    temperature_offset : float
        Deviation from ISA temperature, the pressure being kept [K].
    """

    origin_altitude: Float[Array, ""]
    temperature_offset: Float[Array, ""]

    def density(self, altitude: Float[Array, ""]) -> Float[Array, ""]:
        """Return the density ρ = p / (R T) [kg/m³].

        Parameters
        ----------
        altitude : Float[Array, ""]
            Height above the origin of the ground frame [m]; valid from −1 to 11 km above the sea.

        Notes
        -----
        T = T₀ − λh, p = p₀ (T/T₀)^(g/(Rλ)), ISO 2533.
        """
        standard = SEA_LEVEL_TEMPERATURE - TEMPERATURE_LAPSE * (altitude + self.origin_altitude)
        exponent = STANDARD_GRAVITY / (GAS_CONSTANT_AIR * TEMPERATURE_LAPSE)
        pressure = SEA_LEVEL_PRESSURE * jnp.exp(exponent * jnp.log(standard / SEA_LEVEL_TEMPERATURE))
        return pressure / (GAS_CONSTANT_AIR * (standard + self.temperature_offset))


class ConstantAtmosphere(AbstractAtmosphere):
    """The same density everywhere, for limit cases and conservation laws.

    Attributes
    ----------
    value : float
        Density ρ [kg/m³].
    """

    value: Float[Array, ""]

    def density(self, altitude: Float[Array, ""]) -> Float[Array, ""]:
        """Return ρ [kg/m³], whatever the altitude [m]."""
        return self.value + 0.0 * altitude
