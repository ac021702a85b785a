"""Ship, cables and parts of one's own together: one more named load for each of them. Depends on: physics, plant."""

import dataclasses

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.errors import ConfigError
from tethership.physics import Actuators, HarmonicMotion, SteadyMotion
from tethership.plant.cable import Cable, CableState
from tethership.plant.cable_between import cable_between as cable_between
from tethership.plant.environment import Environment
from tethership.plant.names import PartNames
from tethership.plant.part import AbstractPart, PartStates, Seen, says
from tethership.plant.ship import Airship, derivative, wrenches
from tethership.plant.state import ActuatorState, Command, State
from tethership.spatial import Wrench, rotation_matrix


class TetheredAirship(eqx.Module):
    """The plant: ship, air around it, cables (none for a free ship).

    Attributes
    ----------
    ship : Airship
    environment : Environment
    cables : tuple of Cable
    thrusters, surfaces : Actuators
        What throttles and deflections do with what they are asked.
    parts : tuple of AbstractPart
        Parts of the ship with loads, states or readings of their own.
    origin : Float[Array, "3"]
        O, the origin of the vehicle file's axes that parts refer to, from P, body axes [m].
    names : PartNames
        Names of thrusters, fins, cables and parts; numbered where none are given.
    """

    ship: Airship
    environment: Environment
    cables: tuple[Cable, ...]
    thrusters: Actuators = eqx.field(default_factory=Actuators.ideal)
    surfaces: Actuators = eqx.field(default_factory=Actuators.ideal)
    parts: tuple[AbstractPart, ...] = ()
    origin: Float[Array, "3"] = eqx.field(default_factory=lambda: jnp.zeros(3))
    names: PartNames | None = eqx.field(static=True, default=None)

    @property
    def part_names(self) -> PartNames:
        """Names of thrusters, fins, cables and parts."""
        if self.names is not None:
            return self.names
        return PartNames.numbered(self.ship.thrusters.count, self.ship.fins.count, len(self.cables), len(self.parts))

    def actuated(self, own: ActuatorState, asked: Command) -> Command:
        """Return what the actuated channels do, throttles [-] and deflections [rad].

        Parameters
        ----------
        own : ActuatorState
            Throttles [-] and deflections [rad] reached by the channels that lag.
        asked : Command
            Of all channels, after clipping [-, rad].
        """
        return Command(
            self.thrusters.output(own.thrusters, asked.throttle), self.surfaces.output(own.surfaces, asked.deflection)
        )

    def actuators_at_rest(self, asked: Command) -> ActuatorState:
        """Return the states [-, rad] of the channels that lag once they have done what they are asked [-, rad]."""
        return ActuatorState(self.thrusters.rest(asked.throttle), self.surfaces.rest(asked.deflection))

    def actuator_rates(self, own: ActuatorState, asked: Command) -> ActuatorState:
        """Return the rates of these states [1/s, rad/s]."""
        return ActuatorState(
            self.thrusters.rate(own.thrusters, asked.throttle), self.surfaces.rate(own.surfaces, asked.deflection)
        )

    def cable_states(
        self, time: Float[Array, ""], state: State, lengths: Float[Array, "cables"]
    ) -> tuple[CableState, ...]:
        """Return the state of each cable at time t [s] for lengths L_t [m]."""
        return tuple(cable.state(time, state, lengths[i], self.environment) for i, cable in enumerate(self.cables))

    def seen(self, time: Float[Array, ""], state: State, cable_states: tuple[CableState, ...]) -> Seen:
        """Return what the parts meet at t [s], about O; arguments as in `wrenches`."""
        around, gravity = self.environment, self.environment.gravity
        rotation = rotation_matrix(state.attitude)
        met = self.ship.met(time, state, around)
        position = state.position + rotation @ self.origin
        return Seen(
            velocity=state.velocity + jnp.cross(state.rates, self.origin),
            air_velocity=met.at_p + jnp.cross(met.rates, self.origin),
            rates=state.rates,
            air_rates=met.rates,
            attitude=state.attitude,
            position=position,
            height=around.ground - position[2],
            density=met.air.density,
            gravity=rotation.T @ gravity,
            cables=tuple(cable.ship for cable in cable_states),
        )

    def parts_at_rest(self, time: Float[Array, ""], state: State, cable_states: tuple[CableState, ...]) -> PartStates:
        """Return the states of the parts that no longer change at t [s], in their units; arguments as in `seen`."""
        if not self.parts:
            return ()
        seen = self.seen(time, state, cable_states)
        return tuple(part.rest(seen) for part in self.parts)

    def part_rates(
        self, time: Float[Array, ""], state: State, cable_states: tuple[CableState, ...], own: PartStates
    ) -> PartStates:
        """Return the rates at t [s] of the parts' states `own` [their unit per second]; the rest as in `seen`."""
        if not self.parts:
            return ()
        seen = self.seen(time, state, cable_states)
        return tuple(part.rate(time, x, seen) for part, x in zip(self.parts, own, strict=True))

    def readings(
        self, time: Float[Array, ""], state: State, cable_states: tuple[CableState, ...], own: PartStates
    ) -> dict[str, Float[Array, ""]]:
        """Return what the parts tell the laws at t [s], by name, each in its own unit; arguments as in `part_rates`."""
        if not self.parts:
            return {}
        seen = self.seen(time, state, cable_states)
        told = (part.reading(time, x, seen) for part, x in zip(self.parts, own, strict=True))
        return {name: jnp.asarray(it) for name, it in zip(self.part_names.parts, told, strict=True) if it is not None}

    def wrenches(
        self,
        time: Float[Array, ""],
        state: State,
        command: Command,
        cable_states: tuple[CableState, ...],
        own: PartStates | None = None,
    ) -> dict[str, Wrench]:
        """Return every load by name, cables as `cable_1`, `cable_2`, …, about P, body axes [N, N m].

        Parameters
        ----------
        time : Float[Array, ""]
            t [s].
        state, command
            As in `plant.wrenches`.
        cable_states : tuple of CableState
            From `cable_states`.
        own : tuple of Float[Array, "states"], optional
            States of the parts; at rest if not given.

        Notes
        -----
        The moment of a cable is q_TP × F (the cross is lost in print in Eq. 25).
        """
        loads = wrenches(time, state, command, self.ship, self.environment)
        to_body = rotation_matrix(state.attitude).T
        for i, (cable, force) in enumerate(zip(self.cables, cable_states, strict=True)):
            loads[f"cable_{i + 1}"] = Wrench.at(cable.tether_point, to_body @ force.ship)
        own_loads = self._part_loads(time, state, cable_states, own)
        if twice := set(own_loads) & set(loads):
            raise ConfigError(f"a part is named {twice.pop()!r}, as another load on the ship; give it another name")
        return loads | own_loads

    def _part_loads(
        self, time: Float[Array, ""], state: State, cable_states: tuple[CableState, ...], own: PartStates | None
    ) -> dict[str, Wrench]:
        """Return the loads of the parts by name, about P, body axes [N, N m]."""
        if not self.parts:
            return {}
        seen = self.seen(time, state, cable_states)
        found = {}
        for i, (name, part) in enumerate(zip(self.part_names.parts, self.parts, strict=True)):
            load = part.wrench(time, part.rest(seen) if own is None else own[i], seen)
            if load is not None:
                found[name] = Wrench(load.force, load.moment + jnp.cross(self.origin, load.force))
        return found

    def derivative(
        self,
        time: Float[Array, ""],
        state: State,
        command: Command,
        lengths: Float[Array, "cables"],
        own: PartStates | None = None,
    ) -> State:
        """Return the time derivative of the state; arguments as in `wrenches` and `cable_states`.

        Its fields are V̇, ω̇, body axes [m/s², rad/s²], the Euler rates [rad/s] and ẋ_P, ground axes [m/s].
        """
        loads = self.wrenches(time, state, command, self.cable_states(time, state, lengths), own)
        return derivative(state, loads, self.ship, self.environment)

    def at_mean(self) -> "TetheredAirship":
        """Return the plant in mean air, its anchors about their places: the one that has an equilibrium."""
        swinging = [i for i, cable in enumerate(self.cables) if isinstance(cable.motion, HarmonicMotion)]
        cables = tuple(
            dataclasses.replace(cable, motion=None) if i in swinging else cable for i, cable in enumerate(self.cables)
        )
        return dataclasses.replace(self, environment=self.environment.without_fluctuations(), cables=cables)

    def with_a_gust(self) -> "TetheredAirship":
        """Return the plant in air that has a gust, a silent one where there is none: one structure, one program."""
        return dataclasses.replace(self, environment=self.environment.with_a_gust())

    def with_winches_held(self) -> "TetheredAirship":
        """Return the plant with default rewind rates Ψ̄ of 0 [m/s]: winches do only what laws ask."""
        cables = tuple(
            dataclasses.replace(
                cable, winch=dataclasses.replace(cable.winch, default_rate=jnp.zeros_like(cable.winch.default_rate))
            )
            for cable in self.cables
        )
        return dataclasses.replace(self, cables=cables)

    def anchor_velocity(self) -> Float[Array, "3"] | None:
        """Return the velocity over the ground of anchors that are under way [m/s]; None where they stand still."""
        under_way = [c.motion.mean_velocity() for c in self.cables if isinstance(c.motion, SteadyMotion)]
        return under_way[0] if under_way else None

    def initial_lengths(self) -> Float[Array, "cables"]:
        """Return the unstretched lengths at the start [m]."""
        if not self.cables:
            return jnp.zeros(0)
        return jnp.stack([cable.length for cable in self.cables])


def reading_names(plant: TetheredAirship) -> tuple[str, ...]:
    """Return the names of the parts that tell the laws something."""
    parts = zip(plant.part_names.parts, plant.parts, strict=True)
    return tuple(name for name, part in parts if says(part, "reading"))


@kept
def load_names(plant: TetheredAirship) -> tuple[str, ...]:
    """Return the names of all loads on the ship, by asking for the loads once for each structure of a plant."""
    now, state, ship = jnp.zeros(()), State.at_rest(jnp.zeros(3)), plant.ship
    command = Command(jnp.zeros(ship.thrusters.count), jnp.zeros(ship.fins.count))
    cables = plant.cable_states(now, state, plant.initial_lengths())
    return tuple(plant.wrenches(now, state, command, cables))
