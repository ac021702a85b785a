"""One flight: its start, integration, end, record and outcome."""

from tethership.plant.loop import ClosedLoop
from tethership.simulation.docking import dock, fly_again
from tethership.simulation.events import Stop
from tethership.simulation.flight import Flight
from tethership.simulation.fly import fly
from tethership.simulation.outcome import Outcome

__all__ = ["ClosedLoop", "Flight", "Outcome", "Stop", "dock", "fly", "fly_again"]
