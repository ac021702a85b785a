"""One flight: the closed loop, its integration, its outcome and record."""

from tethership.simulation.closed_loop import ClosedLoop
from tethership.simulation.docking import dock, fly_again
from tethership.simulation.flight import Flight
from tethership.simulation.outcome import Outcome

__all__ = ["ClosedLoop", "Flight", "Outcome", "dock", "fly_again"]
