"""Everything known at one instant of a flight. Depends on: plant, control."""

from typing import Any, NamedTuple

from jaxtyping import Array, Float

from tethership.control import Measurement
from tethership.plant.cable import CableState
from tethership.plant.part import PartStates
from tethership.plant.state import Command, PlantState, State
from tethership.spatial import Wrench


class Instant(NamedTuple):
    """Everything known at one time of a flight.

    Attributes
    ----------
    now : PlantState
        States of all parts.
    cables : tuple of CableState
    measurement : Measurement
        What the sensors say.
    asked : Command
        What the actuated channels are asked, after clipping.
    command : Command
        What they do: throttles δ [-] and deflections [rad].
    saturated : Float[Array, "thrusters"]
        Whether a thruster is asked for more than it has.
    fins_saturated : Float[Array, "fins"]
        Whether a fin is asked for more than its limit.
    rewind_rate : Float[Array, "cables"]
        Ψ [m/s].
    loads : dict[str, Wrench]
        Named loads about P, body axes.
    part_rates : tuple of Float[Array, "states"]
        Rates of the states of parts of one's own [their unit per second].
    memory_rate : Any
        Rate of the law's memory.
    """

    now: PlantState
    cables: tuple[CableState, ...]
    measurement: Measurement
    asked: Command
    command: Command
    saturated: Float[Array, "thrusters"]
    fins_saturated: Float[Array, "fins"]
    rewind_rate: Float[Array, "cables"]
    loads: dict[str, Wrench]
    part_rates: PartStates
    memory_rate: Any

    @property
    def state(self) -> State:
        """State of the ship: velocity of P and ω, body axes [m/s, rad/s], φ, θ, ψ [rad], x_P, ground axes [m]."""
        return self.now.ship

    @property
    def lengths(self) -> Float[Array, "cables"]:
        """L_t [m]."""
        return self.now.lengths
