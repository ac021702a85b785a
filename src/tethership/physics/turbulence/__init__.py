"""What the wind does about its mean: turbulence from a spectrum, or a measured history."""

from tethership.physics.turbulence.fluctuation import AbstractFluctuation
from tethership.physics.turbulence.history import MeasuredHistory
from tethership.physics.turbulence.record import INTERVAL, SAMPLES, Turbulence, make_turbulence
from tethership.physics.turbulence.spectra import (
    REFERENCE_HEIGHT,
    SPECTRA,
    Scales,
    dryden1952,
    low_altitude_scales,
    von_karman1948,
)

__all__ = [
    "INTERVAL",
    "REFERENCE_HEIGHT",
    "SAMPLES",
    "SPECTRA",
    "AbstractFluctuation",
    "MeasuredHistory",
    "Scales",
    "Turbulence",
    "dryden1952",
    "low_altitude_scales",
    "make_turbulence",
    "von_karman1948",
]
