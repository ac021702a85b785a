"""States of the plant and command to it, as types. Depends on nothing."""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

STATE_NAMES = ("u", "v", "w", "p", "q", "r", "phi", "theta", "psi", "north", "east", "down")
"""Names of the twelve states, in the order of the vector."""

STATE_UNITS = ("m/s", "m/s", "m/s", "rad/s", "rad/s", "rad/s", "rad", "rad", "rad", "m", "m", "m")
"""Their SI units."""


class State(eqx.Module):
    """Motion of the body frame, origin P.

    Attributes
    ----------
    velocity : Float[Array, "3"]
        *Ground* velocity of P, (U, V, W), body axes [m/s].
    rates : Float[Array, "3"]
        ω = (p, q, r), body axes [rad/s].
    attitude : Float[Array, "3"]
        Euler angles φ, θ, ψ, 3-2-1 [rad].
    position : Float[Array, "3"]
        x_P = (N, E, D), ground axes [m]; the origin is the first anchor unless the scenario puts that elsewhere.
    """

    velocity: Float[Array, "3"]
    rates: Float[Array, "3"]
    attitude: Float[Array, "3"]
    position: Float[Array, "3"]

    def as_vector(self) -> Float[Array, "12"]:
        """Return the twelve states as one vector, in the order of `STATE_NAMES` [m/s, rad/s, rad, m, three of each]."""
        return jnp.concatenate([self.velocity, self.rates, self.attitude, self.position])

    @classmethod
    def from_vector(cls, vector: Float[Array, "12"]) -> "State":
        """Return the state of a vector of twelve: u, v, w [m/s], p, q, r [rad/s], φ, θ, ψ [rad], N, E, D [m]."""
        return cls(vector[0:3], vector[3:6], vector[6:9], vector[9:12])

    @classmethod
    def at_rest(cls, position: Float[Array, "3"], attitude: Float[Array, "3"] | None = None) -> "State":
        """Return a ship at rest over the ground.

        Parameters
        ----------
        position : Float[Array, "3"]
            x_P, ground axes [m].
        attitude : Float[Array, "3"], optional
            φ, θ, ψ [rad]; level and pointing north if not given.
        """
        zero = jnp.zeros(3)
        return cls(zero, zero, zero if attitude is None else jnp.asarray(attitude), jnp.asarray(position))


class Command(eqx.Module):
    """What the laws ask of the ship, after clipping.

    Attributes
    ----------
    throttle : Float[Array, "thrusters"]
        δ [-].
    deflection : Float[Array, "fins"]
        Deflection of each fin [rad].
    """

    throttle: Float[Array, "thrusters"]
    deflection: Float[Array, "fins"]


class ActuatorState(NamedTuple):
    """States of the actuated channels that lag.

    Attributes
    ----------
    thrusters : Float[Array, "slow"]
        Throttle that each of them has reached [-].
    surfaces : Float[Array, "slow"]
        Deflection that each of them has reached [rad].
    """

    thrusters: Float[Array, "slow"]
    surfaces: Float[Array, "slow"]


class PlantState(NamedTuple):
    """States of all parts of a plant under a law; a part without any has an empty place.

    Attributes
    ----------
    ship : State
    lengths : Float[Array, "cables"]
        Unstretched length of each cable L_t [m], the state of its winch.
    actuators : ActuatorState
    parts : tuple of Float[Array, "states"]
        States of the parts of one's own.
    law : Any
        The law's memory.
    held : Any
        What a sampled law holds (`control.sampling.Held`); empty for a continuous one.
    """

    ship: State
    lengths: Float[Array, "cables"]
    actuators: ActuatorState
    parts: tuple[Any, ...]
    law: Any
    held: Any
