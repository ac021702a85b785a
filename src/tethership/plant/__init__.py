"""The plant: state, ship, air, cables; named loads and the derivative of the state."""

from tethership.plant.environment import Air, Environment
from tethership.plant.plant import Cable, CableState, TetheredAirship
from tethership.plant.ship import Airship, derivative, wrenches
from tethership.plant.state import Command, State

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
