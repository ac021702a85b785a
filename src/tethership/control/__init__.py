"""Control laws: pure functions of time, measurement and memory. They never see the plant."""

from tethership.control.attitude import AttitudeLaw
from tethership.control.heading import HeadingLaw, LineHeadingLaw, SineHeadingLaw, misalignment
from tethership.control.law import AbstractLaw, Correction, Measurement
from tethership.control.layers import LayeredLaw
from tethership.control.navigation import LineOfSightNavigationLaw, NavigationLaw
from tethership.control.rewind import RewindLaw

__all__ = [
    "AbstractLaw",
    "AttitudeLaw",
    "Correction",
    "HeadingLaw",
    "LayeredLaw",
    "LineHeadingLaw",
    "LineOfSightNavigationLaw",
    "Measurement",
    "NavigationLaw",
    "RewindLaw",
    "SineHeadingLaw",
    "misalignment",
]
