"""The plant of parts: ship, air, cables, actuators, a law; named loads, all states and their derivative."""

from tethership.plant.cable import Cable, CableState
from tethership.plant.cable_between import cable_along, cable_between
from tethership.plant.environment import Air, Environment
from tethership.plant.instant import Instant
from tethership.plant.layout import Layout
from tethership.plant.loop import ClosedLoop
from tethership.plant.names import PartNames
from tethership.plant.part import AbstractPart, Seen
from tethership.plant.plant import TetheredAirship
from tethership.plant.ship import Airship, derivative, wrenches
from tethership.plant.state import Command, PlantState, State

__all__ = [
    "AbstractPart",
    "Air",
    "Airship",
    "Cable",
    "CableState",
    "ClosedLoop",
    "Command",
    "Environment",
    "Instant",
    "Layout",
    "PartNames",
    "PlantState",
    "Seen",
    "State",
    "TetheredAirship",
    "cable_along",
    "cable_between",
    "derivative",
    "wrenches",
]
