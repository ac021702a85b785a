"""A plant under a law: sensors → law → allocation → actuators → loads → rates. Depends on: plant, control.

`instant` is everything at one time, `rate` the time derivative of all states, `look` and `act` the only places where a
state jumps. A vector of all states is in the order of `Layout`: ship, cable lengths, actuators, law, what a sampled law
holds; parts without states take no room. The parts of one's own come after the actuators.
"""

from collections.abc import Mapping
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float

from tethership.control import AbstractLaw, Asked, Correction, Held, Measurement, Sampling
from tethership.errors import ConfigError, suggestion
from tethership.plant.cable import CableState
from tethership.plant.instant import Instant
from tethership.plant.plant import TetheredAirship, reading_names
from tethership.plant.ship import derivative
from tethership.plant.state import Command, PlantState, State
from tethership.spatial import rotation_matrix, safe_norm


class ClosedLoop(eqx.Module):
    """A plant under a law, around a trimmed command.

    Attributes
    ----------
    plant : TetheredAirship
    law : AbstractLaw
    trimmed : Command
        Throttles δ₀ [-] and deflections [rad] to which the law's corrections are added.
    sampling : Sampling, optional
        Of a law that looks at intervals; none for a continuous one.
    allocation : dict of str to Command
        Shares of every channel in the demands that laws may make, by the demand's name [channel's unit per demand].
    """

    plant: TetheredAirship
    law: AbstractLaw
    trimmed: Command
    sampling: Sampling | None = None
    allocation: dict[str, Command] = eqx.field(default_factory=dict)

    def rest(self, state: State) -> PlantState:
        """Return all states at the start of a flight, t = 0: every part at its rest about a state of the ship.

        Cables have their lengths at the start [m], actuators have reached the trimmed command after clipping
        [-, rad], and a sampled law holds no correction.
        """
        now, lengths = jnp.zeros(()), self.plant.initial_lengths()
        cables = self.plant.cable_states(now, state, lengths)
        parts = self.plant.parts_at_rest(now, state, cables)
        told = self.plant.readings(now, state, cables, parts)
        memory = self.law.initial_memory(self.measure(state, lengths, cables, told))
        actuators = self.plant.actuators_at_rest(self._clipped(self.trimmed))
        return PlantState(state, lengths, actuators, parts, memory, self._held_at_first())

    def initial(self, state: State) -> Float[Array, "n"]:
        """Return `rest` as one vector, shape (n,), in the order of `Layout`: the ship's [m/s, rad/s, rad, m] first."""
        return ravel_pytree(self.rest(state))[0]

    def unpack(self, vector: Float[Array, "n"]) -> PlantState:
        """Return the states of all parts from one vector of them, the ship's [m/s, rad/s, rad, m] first."""
        return ravel_pytree(self._empty())[1](vector)

    def _empty(self) -> PlantState:
        """Return states of the right structure, all zero."""
        count = len(self.plant.cables)
        zero, none, many = jnp.zeros(3), jnp.zeros(()), jnp.zeros(count)
        told = dict.fromkeys(reading_names(self.plant), none)
        seen = Measurement(zero, zero, zero, none, jnp.zeros((count, 3)), many, many, many, told)
        actuators = self.plant.actuators_at_rest(self.trimmed)
        parts = tuple(jnp.zeros(len(part.states())) for part in self.plant.parts)
        memory = self.law.initial_memory(seen)
        return PlantState(State.at_rest(zero), many, actuators, parts, memory, self._held_at_first())

    def _held_at_first(self) -> Any:
        """Return what a sampled law holds before it has looked: no correction."""
        if self.sampling is None:
            return ()
        none = Correction(
            jnp.zeros_like(self.trimmed.throttle),
            jnp.zeros_like(self.trimmed.deflection),
            jnp.zeros(len(self.plant.cables)),
        )
        return Held(none, () if self.sampling.delay is None else none)

    def measure(
        self,
        state: State,
        lengths: Float[Array, "cables"],
        cables: tuple[CableState, ...],
        told: Mapping[str, Any] | None = None,
    ) -> Measurement:
        """Return what the sensors say: nothing of the plant but this reaches a law.

        Parameters
        ----------
        state : State
            Of the ship [m/s, rad/s, rad, m].
        lengths : Float[Array, "cables"]
            L_t [m].
        cables : tuple of CableState
            From `TetheredAirship.cable_states`.
        told : mapping, optional
            What parts of one's own read, by name, in their units.

        Notes
        -----
        Velocity is taken at B, V_B = V + ω × q_B, body axes; RoC = −i₃·R V_B, upward [m/s].
        """
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
            readings=told or {},
        )

    def allocated(self, asked: Asked) -> Correction:
        """Return what a law asks, its named channels and demands shared out to throttles [-] and deflections [rad].

        A demand d [-] adds its share times d to every channel, a channel's own change is added to it as it is.

        Raises
        ------
        ConfigError
            A law asks for a channel or a demand that is not there; the nearest is offered.
        """
        if isinstance(asked, Correction):
            return asked
        throttle, deflection, rewind_rate = asked.correction
        for name, demand in asked.demands.items():
            share = _known(self.allocation, name, "demand", "name it in control.allocation")
            throttle = throttle + share.throttle * demand
            deflection = deflection + share.deflection * demand
        names = self.plant.part_names
        places = {name: i for i, name in enumerate(names.channels)}
        for name, change in asked.channels.items():
            place = _known(places, name, "channel", "take one of these")
            if place < len(names.thrusters):
                throttle = jnp.zeros_like(self.trimmed.throttle).at[place].set(change) + throttle
            else:
                here = place - len(names.thrusters)
                deflection = jnp.zeros_like(self.trimmed.deflection).at[here].set(change) + deflection
        return Correction(throttle, deflection, rewind_rate)

    def _asked(self, correction: Correction) -> Command:
        """Return what the channels are asked, before clipping."""
        return Command(self.trimmed.throttle + correction.throttle, self.trimmed.deflection + correction.deflection)

    def _clipped(self, asked: Command) -> Command:
        return self.plant.ship.allowed(asked)

    def _rewind(self, correction: Correction) -> Float[Array, "cables"]:
        """Return Ψ of each winch [m/s]."""
        change = jnp.broadcast_to(jnp.asarray(correction.rewind_rate), (len(self.plant.cables),))
        rates = [cable.winch.rate(change[i]) for i, cable in enumerate(self.plant.cables)]
        return jnp.stack(rates) if rates else jnp.zeros(0)

    def instant(self, time: Float[Array, ""], vector: Float[Array, "n"]) -> Instant:
        """Return everything at time t [s] for a vector of all states."""
        now = self.unpack(vector)
        cables = self.plant.cable_states(time, now.ship, now.lengths)
        told = self.plant.readings(time, now.ship, cables, now.parts)
        measurement = self.measure(now.ship, now.lengths, cables, told)
        if self.sampling is None:
            wish, memory_rate = self.law(time, measurement, now.law)
            correction = self.allocated(wish)
        else:
            correction, memory_rate = now.held.now, jax.tree.map(jnp.zeros_like, now.law)
        wanted = self._asked(correction)
        asked = self._clipped(wanted)
        command = self.plant.actuated(now.actuators, asked)
        loads = self.plant.wrenches(time, now.ship, command, cables, now.parts)
        part_rates = self.plant.part_rates(time, now.ship, cables, now.parts)
        return Instant(
            now,
            cables,
            measurement,
            asked,
            command,
            wanted.throttle != asked.throttle,
            wanted.deflection != asked.deflection,
            self._rewind(correction),
            loads,
            part_rates,
            memory_rate,
        )

    def vector_field(self, time: Float[Array, ""], vector: Float[Array, "n"]) -> Float[Array, "n"]:
        """Return the time derivative of the vector of all states at time t [s]; dL_t/dt = −Ψ."""
        return self.rate(self.instant(time, vector))

    def rate(self, at: Instant) -> Float[Array, "n"]:
        """Return the time derivative of the vector of all states at an instant, shape (n,).

        The ship's part is V̇, ω̇ [m/s², rad/s²], body axes, the Euler rates [rad/s] and ẋ_P, ground axes [m/s]; then
        dL_t/dt = −Ψ [m/s], the actuators' rates [1/s, rad/s], parts and memory per second; what is held does not move.
        """
        ship = derivative(at.now.ship, at.loads, self.plant.ship, self.plant.environment)
        actuators = self.plant.actuator_rates(at.now.actuators, at.asked)
        held = jax.tree.map(jnp.zeros_like, at.now.held)
        return ravel_pytree(PlantState(ship, -at.rewind_rate, actuators, at.part_rates, at.memory_rate, held))[0]

    def look(self, time: Float[Array, ""], vector: Float[Array, "n"]) -> Float[Array, "n"]:
        """Return all states after a sampled law has looked at t = kT [s]: its correction waits for the delay, or acts.

        Notes
        -----
        The memory goes on by Euler's rule, m + T ṁ: a law written for a period may return (new − old)/T.
        """
        assert self.sampling is not None
        at = self.instant(time, vector)
        wish, memory_rate = self.law(time, at.measurement, at.now.law)
        found = self.allocated(wish)
        worked_out = jax.tree.map(
            lambda new, old: jnp.broadcast_to(jnp.asarray(new, dtype=old.dtype), old.shape),
            found,
            at.now.held.now,
        )
        memory = jax.tree.map(lambda m, r: m + self.sampling.period * r, at.now.law, memory_rate)  # pyright: ignore[reportOptionalMemberAccess]
        delayed = self.sampling.delay is not None
        held = Held(at.now.held.now, worked_out) if delayed else Held(worked_out, ())
        return ravel_pytree(at.now._replace(law=memory, held=held))[0]

    def act(self, vector: Float[Array, "n"]) -> Float[Array, "n"]:
        """Return all states after the delay, t = kT + d [s]: the correction that waited is in effect."""
        now = self.unpack(vector)
        return ravel_pytree(now._replace(held=Held(now.held.waiting, now.held.waiting)))[0]


def _known(table: Mapping[str, Any], name: str, what: str, cure: str) -> Any:
    """Return an entry of a table, or raise ConfigError that offers the nearest name."""
    if name in table:
        return table[name]
    there = ", ".join(table) or "none"
    raise ConfigError(f"a law asks for the {what} {name!r}{suggestion(name, table)} There are: {there}; {cure}")
