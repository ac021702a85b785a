"""The plant: state, ship, air, cables; named loads and the derivative of the state."""

from tethership.system.airship import Airship, derivative, wrenches
from tethership.system.environment import Air, Environment
from tethership.system.state import Command, State
from tethership.system.tethered import Cable, CableState, TetheredAirship

__all__ = [
    "Air",
    "Airship",
    "Cable",
    "CableState",
    "Command",
    "Environment",
    "State",
    "TetheredAirship",
    "derivative",
    "wrenches",
]
