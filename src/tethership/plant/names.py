"""Names that mean something of the ship's motion, its air or its cables. Depends on: plant.state.

A thruster or fin is named beside them, in a trim's unknowns, in the linear model's inputs and in tables, so none may
bear one of them (`taken`). Cables, laws and loads have lists and labels of their own, where nothing else is named.
"""

from typing import NamedTuple

from tethership.plant.state import STATE_NAMES

QUANTITIES = ("velocity_north", "velocity_east", "velocity_down", *STATE_NAMES[3:])
"""Names of the motion's twelve quantities: ground velocity of P in *ground* axes, then as the states. In ground axes a
level flight stays level whatever the attitude that is looked for."""

ALL_THRUSTERS, ALL_FINS = "throttle", "deflection"
"""Names in a trim's unknowns that stand for all thrusters, all fins."""

WIND_INPUTS = ("wind_north", "wind_east", "wind_down", "wind_rate_north", "wind_rate_east", "wind_rate_down")
"""Names of the wind's inputs to the linear model [m/s, m/s²]."""

LENGTH, REWIND_RATE = "length_", "rewind_rate_"
"""What stands before a cable's name in the linear model: its length [m], the rate at which it is taken in [m/s]."""

REACHED = "reached_"
"""What stands before a channel's name in the name of its actuator's state: the throttle [-] or deflection [rad] that it
has reached."""

MEMORY, HELD, NEXT = "memory_", "held_", "next_"
"""What stands before the names of a law's memories, and of what a sampled law holds and has worked out."""


def taken(name: str) -> bool:
    """Return whether a name is one of a state, an unknown of the trim or an input of the linear model."""
    fixed = (*STATE_NAMES, *QUANTITIES, ALL_THRUSTERS, ALL_FINS, *WIND_INPUTS)
    return name in fixed or name.startswith((LENGTH, REWIND_RATE, REACHED, MEMORY, HELD, NEXT))


class PartNames(NamedTuple):
    """Names of the parts of a plant, in their order.

    Attributes
    ----------
    thrusters, fins, cables, parts : tuple of str
    """

    thrusters: tuple[str, ...]
    fins: tuple[str, ...]
    cables: tuple[str, ...]
    parts: tuple[str, ...] = ()

    @classmethod
    def numbered(cls, thrusters: int, fins: int, cables: int, parts: int = 0) -> "PartNames":
        """Return names with numbers: thruster_1, fin_1, cable_1, part_1 and so on."""
        counts = {"thruster": thrusters, "fin": fins, "cable": cables, "part": parts}
        return cls(*(tuple(f"{kind}_{i + 1}" for i in range(count)) for kind, count in counts.items()))

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of what a law may command besides the winches: throttles, then deflections."""
        return (*self.thrusters, *self.fins)
