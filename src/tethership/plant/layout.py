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
from tethership.plant.part import PartStates
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


def part_layout(plant: TetheredAirship) -> Layout:
    """Return the states of the parts of one's own, `part.state`."""
    own = [
        (f"{name}.{state}", unit)
        for name, part in zip(plant.part_names.parts, plant.parts, strict=True)
        for state, unit in part.states()
    ]
    return Layout(tuple(name for name, _ in own), tuple(unit for _, unit in own))


def open_loop(plant: TetheredAirship) -> Layout:
    """Return the states of a plant whose channels are inputs.

    They are those of the ship [m/s, rad/s, rad, m], what actuators that lag have reached [-, rad], and the states of
    parts of one's own in their units.
    """
    return SHIP.plus(actuators(plant)).plus(part_layout(plant))


def closed_loop(loop: ClosedLoop) -> Layout:
    """Return all states of a closed loop, in the order of its vector.

    They are those of the ship [m/s, rad/s, rad, m], the cables' unstretched lengths [m], what actuators that lag have
    reached [-, rad], parts of one's own in their units, and the law's memory, said to be in [-] for want of a unit of
    its own. A sampled law adds what it holds: changes of throttle [-], deflection [rad] and rewind rate [m/s].
    """
    names = loop.plant.part_names
    lengths = Layout(tuple(f"{LENGTH}{name}" for name in names.cables), ("m",) * len(names.cables))
    memories = jax.eval_shape(lambda: loop.unpack(jnp.zeros(size(loop))).law)
    count = sum(int(np.prod(leaf.shape)) for leaf in jax.tree.leaves(memories))
    memory = Layout(tuple(f"{MEMORY}{i + 1}" for i in range(count)), ("1",) * count)
    layout = SHIP.plus(lengths).plus(actuators(loop.plant)).plus(part_layout(loop.plant)).plus(memory)
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
    """Return the vector of `open_loop` at a point: actuators have reached the command, parts are at rest at t = 0.

    Parameters
    ----------
    plant : TetheredAirship
        With its cables at their lengths at the start.
    state : State
        Of the ship [m/s, rad/s, rad, m].
    command : Command
        Throttles δ [-] and deflections [rad].
    """
    own = plant.actuators_at_rest(command)
    if not plant.parts:
        return jnp.concatenate([state.as_vector(), *own])
    now = jnp.zeros(())
    cables = plant.cable_states(now, state, plant.initial_lengths())
    return jnp.concatenate([state.as_vector(), *own, *plant.parts_at_rest(now, state, cables)])


class OpenState(NamedTuple):
    """States of a plant whose channels are inputs.

    Attributes
    ----------
    ship : State
        Velocity and ω, body axes [m/s, rad/s], φ, θ, ψ [rad], x_P, ground axes [m].
    actuators : ActuatorState
        Throttles [-] and deflections [rad] reached by the channels that lag.
    parts : tuple of Float[Array, "states"]
        In their units.
    """

    ship: State
    actuators: ActuatorState
    parts: PartStates


def split_open(plant: TetheredAirship, vector: Float[Array, "n"]) -> OpenState:
    """Return the states of ship, actuators and parts from the vector of `open_loop`, shape (n,).

    Its order is u, v, w [m/s], p, q, r [rad/s], φ, θ, ψ [rad], N, E, D [m], the throttles [-] and deflections [rad]
    reached by the channels that lag, then the states of each part in their units.
    """
    counts = [len(STATE_NAMES), len(plant.thrusters.slow), len(plant.surfaces.slow)]
    counts += [len(part.states()) for part in plant.parts]
    ends = np.cumsum(counts)
    ship, throttles, deflections, *own = (vector[end - n : end] for n, end in zip(counts, ends, strict=True))
    return OpenState(State.from_vector(ship), ActuatorState(throttles, deflections), tuple(own))
