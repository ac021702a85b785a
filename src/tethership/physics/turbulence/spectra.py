"""Spectra, scales and intensities of low-altitude turbulence. Depends on: nothing.

References
----------
MIL-F-8785C (1980) §3.7.1 (spectra), §3.7.3.4 (scales and intensities below 1000 ft); MIL-HDBK-1797 (1997) appendix A
writes the same spectra with transverse scales of half the length. One-sided: σ² = ∫₀^∞ Φ dΩ.
"""

from collections.abc import Callable
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

FOOT = 0.3048
"""[m]."""

REFERENCE_HEIGHT = 20.0 * FOOT
"""Height of the wind W₂₀ to which intensities below 1000 ft are referred [m]."""

CEILING = 1000.0 * FOOT
"""Height up to which the low-altitude model holds [m]."""

FLOOR = 10.0 * FOOT
"""Height below which its scales stay as they are [m]."""


class Scales(NamedTuple):
    """Lengths and intensities of turbulence, components along the mean wind, across it and vertical.

    Attributes
    ----------
    length : Float[Array, "3"]
        L_u, L_v, L_w [m].
    deviation : Float[Array, "3"]
        σ_u, σ_v, σ_w [m/s].
    """

    length: Float[Array, "3"]
    deviation: Float[Array, "3"]


def low_altitude_scales(height: Float[Array, ""], wind_at_20_ft: Float[Array, ""]) -> Scales:
    """Return scales and intensities below 1000 ft (MIL-F-8785C §3.7.3.4).

    Parameters
    ----------
    height : Float[Array, ""]
        h above the ground [m], taken between 10 and 1000 ft.
    wind_at_20_ft : Float[Array, ""]
        Mean wind W₂₀ at 20 ft (6.1 m) [m/s].

    Notes
    -----
    With h in feet: L_w = h, L_u = L_v = h/(0.177 + 0.000823 h)^1.2; σ_w = 0.1 W₂₀,
    σ_u = σ_v = σ_w/(0.177 + 0.000823 h)^0.4.
    """
    metres = jnp.clip(height, FLOOR, CEILING)
    shape = 0.177 + 0.000823 * metres / FOOT
    level, vertical = metres / shape**1.2, 0.1 * wind_at_20_ft
    return Scales(jnp.stack([level, level, metres]), vertical * jnp.stack([shape**-0.4, shape**-0.4, jnp.ones(())]))


def dryden1952(wavenumber: Float[Array, "n 1"], scales: Scales) -> Float[Array, "n 3"]:
    """Return Φ_u, Φ_v, Φ_w of Dryden's form [m³/s² per rad] at spatial frequencies Ω [rad/m].

    Notes
    -----
    Φ_u = σ² (2L/π)/(1 + (LΩ)²); Φ_v,w = σ² (L/π)(1 + 3(LΩ)²)/(1 + (LΩ)²)².
    """
    square = (scales.length * wavenumber) ** 2
    density = scales.deviation**2 * scales.length / jnp.pi
    along = 2.0 / (1.0 + square)
    across = (1.0 + 3.0 * square) / (1.0 + square) ** 2
    return density * jnp.where(np.array([True, False, False]), along, across)


def von_karman1948(wavenumber: Float[Array, "n 1"], scales: Scales) -> Float[Array, "n 3"]:
    """Return Φ_u, Φ_v, Φ_w of von Kármán's form [m³/s² per rad] at spatial frequencies Ω [rad/m].

    Notes
    -----
    With x = 1.339 LΩ: Φ_u = σ² (2L/π)/(1 + x²)^(5/6); Φ_v,w = σ² (L/π)(1 + (8/3) x²)/(1 + x²)^(11/6).
    """
    square = (1.339 * scales.length * wavenumber) ** 2
    density = scales.deviation**2 * scales.length / jnp.pi
    along = 2.0 / (1.0 + square) ** (5.0 / 6.0)
    across = (1.0 + 8.0 / 3.0 * square) / (1.0 + square) ** (11.0 / 6.0)
    return density * jnp.where(np.array([True, False, False]), along, across)


Spectrum = Callable[[Float[Array, "n 1"], Scales], Float[Array, "n 3"]]
"""From spatial frequencies [rad/m] and scales to one-sided densities."""

SPECTRA: dict[str, Spectrum] = {"dryden": dryden1952, "von_karman": von_karman1948}
"""Spectra by the name that a file gives."""
