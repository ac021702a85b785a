"""The closed loop: measurement → law → command → derivative, winches included.

Depends on: plant, control. The integrator's vector is (12 states, cable lengths, the law's memory).
"""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float

from tethership.control.law import AbstractLaw, Correction, Measurement
from tethership.plant.plant import CableState, TetheredAirship
from tethership.plant.ship import derivative
from tethership.plant.state import Command, State
from tethership.spatial import Wrench, rotation_matrix, safe_norm


class Instant(NamedTuple):
    """Everything known at one time of a flight.

    Attributes
    ----------
    state : State
    lengths : Float[Array, "cables"]
        L_t [m].
    cables : tuple of CableState
    command : Command
        After clipping.
    saturated : Float[Array, "thrusters"]
        Whether a thruster is asked for more than it has.
    fins_saturated : Float[Array, "fins"]
        Whether a fin is asked for more than its limit.
    rewind_rate : Float[Array, "cables"]
        Ψ [m/s].
    loads : dict[str, Wrench]
        Named loads about P, body axes.
    memory_rate : Any
        Rate of the law's memory.
    """

    state: State
    lengths: Float[Array, "cables"]
    cables: tuple[CableState, ...]
    command: Command
    saturated: Float[Array, "thrusters"]
    fins_saturated: Float[Array, "fins"]
    rewind_rate: Float[Array, "cables"]
    loads: dict[str, Wrench]
    memory_rate: Any


class ClosedLoop(eqx.Module):
    """A plant under a law, around a trimmed command.

    Attributes
    ----------
    plant : TetheredAirship
    law : AbstractLaw
    trimmed : Command
        Throttles δ₀ [-] and deflections [rad] to which the law's corrections are added.
    """

    plant: TetheredAirship
    law: AbstractLaw
    trimmed: Command

    def initial(self, state: State) -> Float[Array, "n"]:
        """Return the integrator's vector for a start from `state` with the cables' initial lengths."""
        lengths = self.plant.initial_lengths()
        cables = self.plant.cable_states(jnp.zeros(()), state, lengths)
        memory = self.law.initial_memory(self.measure(state, lengths, cables))
        return jnp.concatenate([state.as_vector(), lengths, ravel_pytree(memory)[0]])

    def unpack(self, vector: Float[Array, "n"]) -> tuple[State, Float[Array, "cables"], Array]:
        """Return state, cable lengths [m] and flat memory of an integrator's vector."""
        count = len(self.plant.cables)
        return State.from_vector(vector[:12]), vector[12 : 12 + count], vector[12 + count :]

    def measure(self, state: State, lengths: Float[Array, "cables"], cables: tuple[CableState, ...]) -> Measurement:
        """Return what the sensors say: nothing of the plant but this reaches a law."""
        rotation = rotation_matrix(state.attitude)
        velocity_b = state.velocity + jnp.cross(state.rates, self.plant.ship.buoyancy.centre)
        count = len(cables)
        return Measurement(
            velocity=velocity_b,
            rates=state.rates,
            attitude=state.attitude,
            rate_of_climb=-rotation[2] @ velocity_b,
            offset=jnp.stack([c.span for c in cables]) if count else jnp.zeros((0, 3)),
            tension=jnp.stack([safe_norm(c.ship) for c in cables]) if count else jnp.zeros(0),
            length=lengths,
            rewind_rate=jnp.stack([c.winch.default_rate for c in self.plant.cables]) if count else jnp.zeros(0),
        )

    def _memory(self, flat: Array, measurement: Measurement) -> Any:
        """Return the law's memory with its own structure."""
        return ravel_pytree(self.law.initial_memory(measurement))[1](flat)

    def _rewind(self, correction: Correction) -> Float[Array, "cables"]:
        """Return Ψ of each winch [m/s]."""
        change = jnp.broadcast_to(jnp.asarray(correction.rewind_rate), (len(self.plant.cables),))
        rates = [cable.winch.rate(change[i]) for i, cable in enumerate(self.plant.cables)]
        return jnp.stack(rates) if rates else jnp.zeros(0)

    def instant(self, time: Float[Array, ""], vector: Float[Array, "n"]) -> Instant:
        """Return everything at time t [s] for an integrator's vector."""
        state, lengths, flat = self.unpack(vector)
        cables = self.plant.cable_states(time, state, lengths)
        measurement = self.measure(state, lengths, cables)
        correction, memory_rate = self.law(time, measurement, self._memory(flat, measurement))
        asked = Command(self.trimmed.throttle + correction.throttle, self.trimmed.deflection + correction.deflection)
        command = self.plant.ship.allowed(asked)
        loads = self.plant.wrenches(time, state, command, cables)
        return Instant(
            state,
            lengths,
            cables,
            command,
            asked.throttle != command.throttle,
            asked.deflection != command.deflection,
            self._rewind(correction),
            loads,
            memory_rate,
        )

    def vector_field(self, time: Float[Array, ""], vector: Float[Array, "n"]) -> Float[Array, "n"]:
        """Return the time derivative of the integrator's vector at time t [s]; dL_t/dt = −Ψ."""
        return self.rate(self.instant(time, vector))

    def rate(self, now: Instant) -> Float[Array, "n"]:
        """Return the time derivative of the integrator's vector at an instant."""
        rate = derivative(now.state, now.loads, self.plant.ship, self.plant.environment)
        return jnp.concatenate([rate.as_vector(), -now.rewind_rate, ravel_pytree(now.memory_rate)[0]])
