"""Ship and cables together: one more named load per cable. Depends on: physics, plant."""

import dataclasses
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.actuators import Actuators
from tethership.physics.anchor import AbstractAnchorMotion, HarmonicMotion, SteadyMotion
from tethership.physics.cable import AbstractTensionLaw, CableLoad
from tethership.physics.winch import Winch
from tethership.plant.environment import Environment
from tethership.plant.names import PartNames
from tethership.plant.ship import Airship, derivative, wrenches
from tethership.plant.state import ActuatorState, Command, State
from tethership.spatial import Wrench, rotation_matrix, safe_norm


class CableState(NamedTuple):
    """What one cable does at one instant, ground axes.

    Attributes
    ----------
    span : Float[Array, "3"]
        d = x_TP − x_AP [m].
    ship : Float[Array, "3"]
        Force of the cable on the ship [N].
    anchor : Float[Array, "3"]
        Force of the cable on the anchor [N].
    load : Float[Array, "3"]
        Load per unit length l [N/m].
    place : Float[Array, "3"]
        Where the anchor is x_AP [m].
    """

    span: Float[Array, "3"]
    ship: Float[Array, "3"]
    anchor: Float[Array, "3"]
    load: Float[Array, "3"]
    place: Float[Array, "3"]


class Cable(eqx.Module):
    """One cable from the ship to the ground.

    Attributes
    ----------
    tether_point : Float[Array, "3"]
        TP from P, body axes, q_TP [m].
    anchor : Float[Array, "3"]
        x_AP, ground axes [m]; where it moves, the place that it moves about or from.
    length : float
        Unstretched length at the start L_t [m].
    breaking_force : float
        F_b [N].
    load : CableLoad
        Weight and drag.
    law : AbstractTensionLaw
        Tension from span, length and load.
    winch : Winch
        Its drive at the anchor.
    load_reference : float
        Where the reference point C of the cable's wind load sits, as a fraction of the span from the anchor [-]; ½ is
        the mid-point.
    motion : AbstractAnchorMotion, optional
        Of the anchor; none for one that stands still.
    """

    tether_point: Float[Array, "3"]
    anchor: Float[Array, "3"]
    length: Float[Array, ""]
    breaking_force: Float[Array, ""]
    load: CableLoad
    law: AbstractTensionLaw
    winch: Winch
    load_reference: Float[Array, ""]
    motion: AbstractAnchorMotion | None = None

    def state(
        self, time: Float[Array, ""], state: State, length: Float[Array, ""], environment: Environment
    ) -> CableState:
        """Return the cable's forces for a state of the ship.

        Parameters
        ----------
        time : Float[Array, ""]
            t [s].
        state : State
            Of the ship.
        length : Float[Array, ""]
            Present unstretched length L_t [m].
        environment : Environment
            Wind and density at the reference point C of Eqs. 15–18; on the chord between the ends C moves at its
            fraction of the velocity of TP and the rest of that of the anchor.
        """
        rotation = rotation_matrix(state.attitude)
        place, drawn = self.anchor, None
        if self.motion is not None:
            place, drawn = place + self.motion.displacement(time), self.motion.velocity(time)
        span = state.position + rotation @ self.tether_point - place
        velocity = rotation @ (state.velocity + jnp.cross(state.rates, self.tether_point))
        wind = environment.wind_at(place + self.load_reference * span, time)
        return self.between(span, velocity, length, wind, environment, place, drawn)

    def between(
        self,
        span: Float[Array, "3"],
        velocity: Float[Array, "3"],
        length: Float[Array, ""],
        wind: Float[Array, "3"],
        environment: Environment,
        place: Float[Array, "3"] | None = None,
        drawn: Float[Array, "3"] | None = None,
    ) -> CableState:
        """Return the cable's forces between two points, ground axes.

        Parameters
        ----------
        span : Float[Array, "3"]
            d = x_TP − x_AP [m].
        velocity : Float[Array, "3"]
            Ground velocity of TP [m/s].
        length : Float[Array, ""]
            L_t [m].
        wind : Float[Array, "3"]
            Wind at C [m/s].
        environment : Environment
            Gives the density there.
        place, drawn : Float[Array, "3"], optional
            Where an anchor is that moves [m], and its velocity [m/s]; the cable's own place, at rest, if not given.
        """
        place = self.anchor if place is None else place
        density = environment.density_at(place + self.load_reference * span)
        along = self.load_reference * velocity
        if drawn is not None:
            along = along + (1.0 - self.load_reference) * drawn
        load = self.load.per_length(density, along - wind, span)
        force = self.law.force(span, length, load)
        return CableState(span, force.ship, force.anchor, load, place)

    def lowest_point(self, cable: CableState, length: Float[Array, ""]) -> Float[Array, "3"]:
        """Return the lowest point of the cable, ground axes [m]; arguments as `state` returns them.

        Notes
        -----
        The tension vector at s is F_AP − l s: level where its down component vanishes, else an end is lowest.
        """
        down = cable.load[2]
        level = cable.anchor[2] / jnp.where(jnp.abs(down) > 0, down, 1.0)
        arc = jnp.stack([jnp.zeros_like(length), jnp.clip(level, 0.0, length), length])
        points = cable.place + self.law.shape(cable.span, length, cable.load, arc)
        return points[jnp.argmax(points[:, 2])]


class TetheredAirship(eqx.Module):
    """The plant: ship, air around it, cables (none for a free ship).

    Attributes
    ----------
    ship : Airship
    environment : Environment
    cables : tuple of Cable
    thrusters, surfaces : Actuators
        What throttles and deflections do with what they are asked.
    names : PartNames
        Names of thrusters, fins and cables; numbered where none are given.
    """

    ship: Airship
    environment: Environment
    cables: tuple[Cable, ...]
    thrusters: Actuators = eqx.field(default_factory=Actuators.ideal)
    surfaces: Actuators = eqx.field(default_factory=Actuators.ideal)
    names: PartNames | None = eqx.field(static=True, default=None)

    @property
    def part_names(self) -> PartNames:
        """Names of thrusters, fins and cables."""
        if self.names is not None:
            return self.names
        return PartNames.numbered(self.ship.thrusters.count, self.ship.fins.count, len(self.cables))

    def actuated(self, own: ActuatorState, asked: Command) -> Command:
        """Return what the actuated channels do, for their states and what they are asked."""
        return Command(
            self.thrusters.output(own.thrusters, asked.throttle), self.surfaces.output(own.surfaces, asked.deflection)
        )

    def actuators_at_rest(self, asked: Command) -> ActuatorState:
        """Return the states of the actuated channels that have done what they are asked."""
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

    def wrenches(
        self,
        time: Float[Array, ""],
        state: State,
        command: Command,
        cable_states: tuple[CableState, ...],
    ) -> dict[str, Wrench]:
        """Return every load by name, cables as `cable_1`, `cable_2`, …, about P, body axes [N, N m].

        Notes
        -----
        The moment of a cable is q_TP × F (the cross is lost in print in Eq. 25).
        """
        loads = wrenches(time, state, command, self.ship, self.environment)
        to_body = rotation_matrix(state.attitude).T
        for i, (cable, force) in enumerate(zip(self.cables, cable_states, strict=True)):
            loads[f"cable_{i + 1}"] = Wrench.at(cable.tether_point, to_body @ force.ship)
        return loads

    def derivative(
        self, time: Float[Array, ""], state: State, command: Command, lengths: Float[Array, "cables"]
    ) -> State:
        """Return the time derivative of the state; arguments as in `wrenches` and `cable_states`."""
        loads = self.wrenches(time, state, command, self.cable_states(time, state, lengths))
        return derivative(state, loads, self.ship, self.environment)

    def at_mean(self) -> "TetheredAirship":
        """Return the plant in mean air, its anchors about their places: the one that has an equilibrium."""
        swinging = [i for i, cable in enumerate(self.cables) if isinstance(cable.motion, HarmonicMotion)]
        cables = tuple(
            dataclasses.replace(cable, motion=None) if i in swinging else cable for i, cable in enumerate(self.cables)
        )
        return dataclasses.replace(self, environment=self.environment.without_fluctuations(), cables=cables)

    def with_winches_held(self) -> "TetheredAirship":
        """Return the plant with winches that take in nothing by themselves; what laws ask they still do."""
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


_LOADS: dict[Any, tuple[str, ...]] = {}


def load_names(plant: TetheredAirship) -> tuple[str, ...]:
    """Return the names of all loads on the ship, by asking for the loads once for each structure of a plant."""
    structure = jax.tree.structure(plant)
    if structure not in _LOADS:
        found: list[str] = []

        def asked() -> Any:
            now, state = jnp.zeros(()), State.at_rest(jnp.zeros(3))
            ship = plant.ship
            command = Command(jnp.zeros(ship.thrusters.count), jnp.zeros(ship.fins.count))
            cables = plant.cable_states(now, state, plant.initial_lengths())
            loads = plant.wrenches(now, state, command, cables)
            found.extend(loads)
            return loads

        jax.eval_shape(asked)
        _LOADS[structure] = tuple(found)
    return _LOADS[structure]


def end_tension(cable: CableState) -> Float[Array, ""]:
    """Return the largest tension along a cable [N]: it is at one of its ends."""
    return jnp.maximum(safe_norm(cable.ship), safe_norm(cable.anchor))


class CableBetween(NamedTuple):
    """One cable between two given points, ground axes.

    Attributes
    ----------
    ship, anchor : Float[Array, "3"]
        Forces of the cable on the ship and on the anchor [N].
    load : Float[Array, "3"]
        l [N/m].
    lowest : Float[Array, "3"]
        Lowest point [m].
    regime : Float[Array, ""]
        0 slack, 1 joint, 2 taut.
    """

    ship: Float[Array, "3"]
    anchor: Float[Array, "3"]
    load: Float[Array, "3"]
    lowest: Float[Array, "3"]
    regime: Float[Array, ""]


@eqx.filter_jit
def cable_between(
    cable: Cable,
    environment: Environment,
    end: Float[Array, "3"],
    anchor: Float[Array, "3"],
    length: Float[Array, ""],
    velocity: Float[Array, "3"],
    wind: Float[Array, "3"] | None,
) -> CableBetween:
    """Return forces and lowest point of a cable whose ends are given.

    Parameters
    ----------
    cable, environment
        Parameters.
    end, anchor : Float[Array, "3"]
        Ends, ground axes [m].
    length : Float[Array, ""]
        L_t [m].
    velocity : Float[Array, "3"]
        Ground velocity of the ship's end [m/s].
    wind : Float[Array, "3"], optional
        Wind at the reference point C [m/s]; the environment's at time zero if not given.
    """
    moved = eqx.tree_at(lambda c: c.anchor, cable, anchor)
    span = end - anchor
    if wind is None:
        wind = environment.wind_at(anchor + cable.load_reference * span, jnp.zeros(()))
    state = moved.between(span, velocity, jnp.asarray(length), wind, environment)
    regime = cable.law.regime(safe_norm(span) / length)
    lowest = moved.lowest_point(state, jnp.asarray(length))
    return CableBetween(state.ship, state.anchor, state.load, lowest, regime)


@eqx.filter_jit
def cable_along(
    cable: Cable, found: CableBetween, end: Float[Array, "3"], anchor: Float[Array, "3"], arc: Float[Array, "n"]
) -> tuple[Float[Array, "n 3"], Float[Array, "n"]]:
    """Return points of a cable, ground axes [m], and the tension there [N].

    Parameters
    ----------
    cable : Cable
        Parameters.
    found : CableBetween
        From `cable_between`, for the same ends.
    end, anchor : Float[Array, "3"]
        Ends, ground axes [m].
    arc : Float[Array, "n"]
        Unstretched distance from the anchor s [m], the last one being the length.

    Notes
    -----
    The tension vector falls linearly from that at the anchor to that at the ship, t(s) = F_AP − (s/L)(F_AP + F_TP).
    """
    points = anchor + cable.law.shape(end - anchor, arc[-1], found.load, arc)
    vectors = found.anchor - (arc / arc[-1])[:, None] * (found.anchor + found.ship)
    return points, jnp.sqrt(jnp.sum(vectors**2, axis=1))
