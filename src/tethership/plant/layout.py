"""Layout: names and units of all states of a closed loop, in the order of its vector. Depends on: plant.

Nobody counts places by hand: a part that has states gives their names here, and files, linear models and modes follow.
"""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership.plant.loop import ClosedLoop
from tethership.plant.names import HELD, LENGTH, MEMORY, NEXT, REACHED, REWIND_RATE
from tethership.plant.plant import TetheredAirship
from tethership.plant.state import STATE_NAMES, STATE_UNITS, ActuatorState, Command, State


class Layout(NamedTuple):
    """Names and units of states.

    Attributes
    ----------
    names, units : tuple of str
        In the order of the vector; SI units.
    """

    names: tuple[str, ...]
    units: tuple[str, ...]

    def plus(self, other: "Layout") -> "Layout":
        """Return this layout with another one behind it."""
        return Layout(self.names + other.names, self.units + other.units)


SHIP = Layout(STATE_NAMES, STATE_UNITS)
"""The twelve states of the ship."""


def actuators(plant: TetheredAirship) -> Layout:
    """Return the states of the actuated channels that lag: throttles reached [-], deflections reached [rad]."""
    names = plant.part_names
    throttles = tuple(f"{REACHED}{names.thrusters[i]}" for i in plant.thrusters.slow)
    deflections = tuple(f"{REACHED}{names.fins[i]}" for i in plant.surfaces.slow)
    return Layout(throttles + deflections, ("1",) * len(throttles) + ("rad",) * len(deflections))


def open_loop(plant: TetheredAirship) -> Layout:
    """Return the states of a plant whose channels are inputs: ship, then actuators."""
    return SHIP.plus(actuators(plant))


def closed_loop(loop: ClosedLoop) -> Layout:
    """Return all states of a closed loop, in the order of its vector."""
    names = loop.plant.part_names
    lengths = Layout(tuple(f"{LENGTH}{name}" for name in names.cables), ("m",) * len(names.cables))
    memories = jax.eval_shape(lambda: loop.unpack(jnp.zeros(size(loop))).law)
    count = sum(int(np.prod(leaf.shape)) for leaf in jax.tree.leaves(memories))
    memory = Layout(tuple(f"{MEMORY}{i + 1}" for i in range(count)), ("1",) * count)
    layout = SHIP.plus(lengths).plus(actuators(loop.plant)).plus(memory)
    if loop.sampling is None:
        return layout
    channels = Layout(
        (*names.channels, *(f"{REWIND_RATE}{name}" for name in names.cables)),
        ("1",) * len(names.thrusters) + ("rad",) * len(names.fins) + ("m/s",) * len(names.cables),
    )
    for prefix in (HELD,) if loop.sampling.delay is None else (HELD, NEXT):
        layout = layout.plus(Layout(tuple(prefix + name for name in channels.names), channels.units))
    return layout


def size(loop: ClosedLoop) -> int:
    """Return the number of states of a closed loop."""
    shape = eqx.filter_eval_shape(loop.initial, State.at_rest(jnp.zeros(3)))
    return int(shape.shape[0])


def open_state(plant: TetheredAirship, state: State, command: Command) -> Float[Array, "n"]:
    """Return the vector of `open_loop` at a point: the actuators have reached the command."""
    own = plant.actuators_at_rest(command)
    return jnp.concatenate([state.as_vector(), own.thrusters, own.surfaces])


def split_open(plant: TetheredAirship, vector: Float[Array, "n"]) -> tuple[State, ActuatorState]:
    """Return the states of ship and actuators from the vector of `open_loop`."""
    first = len(STATE_NAMES) + len(plant.thrusters.slow)
    return State.from_vector(vector), ActuatorState(vector[len(STATE_NAMES) : first], vector[first:])
