"""The plant's right-hand side as a function of two vectors, states and inputs, to be differentiated.

Depends on: plant, physics.gust.

Inputs are the throttles and deflections, the wind's change and its rate (ground axes), and the cables' lengths. The
rate of the wind is an input of its own: accelerating air pushes the ship by its pressure gradient and apparent mass.
"""

import dataclasses

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics import WindChange
from tethership.plant import Command, TetheredAirship, split_open
from tethership.spatial import Wrench

WIND_UNITS = ("m/s", "m/s", "m/s", "m/s^2", "m/s^2", "m/s^2")
"""SI units of the wind's inputs, `WIND_INPUTS`."""


def input_vector(plant: TetheredAirship, command: Command) -> Float[Array, "inputs"]:
    """Return the inputs at a point: throttles δ [-], deflections [rad], wind's change [m/s, m/s²], L_t [m]."""
    return jnp.concatenate([command.throttle, command.deflection, jnp.zeros(6), plant.initial_lengths()])


def unpack_inputs(
    plant: TetheredAirship, inputs: Float[Array, "inputs"]
) -> tuple[TetheredAirship, Command, Float[Array, "cables"]]:
    """Return the plant with the mean wind changed, the command and the lengths of the cables [m]."""
    thrusters, fins = plant.ship.thrusters.count, plant.ship.fins.count
    after = thrusters + fins
    command = Command(inputs[:thrusters], inputs[thrusters:after])
    change = WindChange(inputs[after : after + 3], inputs[after + 3 : after + 6])
    environment = dataclasses.replace(plant.environment, gusts=(*plant.environment.gusts, change), fluctuations=())
    return dataclasses.replace(plant, environment=environment), command, inputs[after + 6 :]


def right_side(plant: TetheredAirship, state: Float[Array, "n"], inputs: Float[Array, "inputs"]) -> Float[Array, "n"]:
    """Return the rates of all states whose channels are inputs [SI per second] at t = 0.

    Parameters
    ----------
    plant : TetheredAirship
    state : Float[Array, "n"]
        In the order of `plant.layout.open_loop`: the ship's twelve [m/s, rad/s, rad, m], then throttles [-] and
        deflections [rad] that actuators which lag have reached, then states of parts of one's own.
    inputs : Float[Array, "inputs"]
        As `input_vector` returns them; channels that lag are asked so much, the others do it.
    """
    changed, asked, lengths = unpack_inputs(plant, inputs)
    now, own = jnp.zeros(()), split_open(plant, state)
    command = changed.actuated(own.actuators, asked)
    rate = changed.derivative(now, own.ship, command, lengths, own.parts).as_vector()
    if len(state) == len(rate):
        return rate
    cables = changed.cable_states(now, own.ship, lengths)
    moving = (*changed.actuator_rates(own.actuators, asked), *changed.part_rates(now, own.ship, cables, own.parts))
    return jnp.concatenate([rate, *(part for part in moving if part.shape[0])])


def loads(
    plant: TetheredAirship, state: Float[Array, "n"], inputs: Float[Array, "inputs"]
) -> dict[str, Float[Array, "6"]]:
    """Return every load by name (f, m) about P, body axes [N, N m]; arguments as in `right_side`."""
    changed, asked, lengths = unpack_inputs(plant, inputs)
    now, own = jnp.zeros(()), split_open(plant, state)
    cables = changed.cable_states(now, own.ship, lengths)
    command = changed.actuated(own.actuators, asked)
    found: dict[str, Wrench] = changed.wrenches(now, own.ship, command, cables, own.parts)
    return {name: load.as_vector() for name, load in found.items()}
