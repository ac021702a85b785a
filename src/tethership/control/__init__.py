"""Control laws: pure functions of time, measurement and memory. They never see the plant."""

from tethership.control.attitude import AttitudeLaw
from tethership.control.heading import HeadingLaw, LineHeadingLaw, SineHeadingLaw, misalignment
from tethership.control.law import AbstractLaw, Correction, Measurement, Request
from tethership.control.layers import LayeredLaw
from tethership.control.navigation import LineOfSightNavigationLaw, NavigationLaw
from tethership.control.rewind import RewindLaw
from tethership.control.sampling import Held, Sampling

__all__ = [
    "AbstractLaw",
    "AttitudeLaw",
    "Correction",
    "HeadingLaw",
    "Held",
    "LayeredLaw",
    "LineHeadingLaw",
    "LineOfSightNavigationLaw",
    "Measurement",
    "NavigationLaw",
    "Request",
    "RewindLaw",
    "Sampling",
    "SineHeadingLaw",
    "misalignment",
]
