"""The plant's right-hand side as a function of two vectors, states and inputs, to be differentiated.

Depends on: plant, physics.gust.

Inputs are the throttles and deflections, the wind's change and its rate (ground axes), and the cables' lengths. The
rate of the wind is an input of its own: accelerating air pushes the ship by its pressure gradient and apparent mass.
"""

import dataclasses

import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.gust import WindChange
from tethership.plant import Command, State, TetheredAirship
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


def right_side(plant: TetheredAirship, state: Float[Array, "12"], inputs: Float[Array, "inputs"]) -> Float[Array, "12"]:
    """Return the rates of the twelve states [SI per second] at t = 0.

    Parameters
    ----------
    plant : TetheredAirship
    state : Float[Array, "12"]
        In the order of `STATE_NAMES`.
    inputs : Float[Array, "inputs"]
        As `input_vector` returns them.
    """
    changed, command, lengths = unpack_inputs(plant, inputs)
    return changed.derivative(jnp.zeros(()), State.from_vector(state), command, lengths).as_vector()


def loads(
    plant: TetheredAirship, state: Float[Array, "12"], inputs: Float[Array, "inputs"]
) -> dict[str, Float[Array, "6"]]:
    """Return every load by name (f, m) about P, body axes [N, N m]; arguments as in `right_side`."""
    changed, command, lengths = unpack_inputs(plant, inputs)
    now, pose = jnp.zeros(()), State.from_vector(state)
    found: dict[str, Wrench] = changed.wrenches(now, pose, command, changed.cable_states(now, pose, lengths))
    return {name: load.as_vector() for name, load in found.items()}
