"""Ship and cables together: one more named load per cable. Depends on: physics, system."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics.cable import AbstractTensionLaw, CableLoad
from tethership.physics.winch import Winch
from tethership.spatial import Wrench, rotation_matrix, safe_norm
from tethership.system.airship import Airship, derivative, wrenches
from tethership.system.environment import Environment
from tethership.system.state import Command, State


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
    """

    span: Float[Array, "3"]
    ship: Float[Array, "3"]
    anchor: Float[Array, "3"]
    load: Float[Array, "3"]


class Cable(eqx.Module):
    """One cable from the ship to the ground.

    Attributes
    ----------
    tether_point : Float[Array, "3"]
        TP from P, body axes, q_TP [m].
    anchor : Float[Array, "3"]
        x_AP, ground axes [m].
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
    """

    tether_point: Float[Array, "3"]
    anchor: Float[Array, "3"]
    length: Float[Array, ""]
    breaking_force: Float[Array, ""]
    load: CableLoad
    law: AbstractTensionLaw
    winch: Winch

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
            Wind and density at the cable's mid-point, the reference point C of Eqs. 15–18; C moves at half the
            velocity of TP, the anchor being at rest.
        """
        rotation = rotation_matrix(state.attitude)
        span = state.position + rotation @ self.tether_point - self.anchor
        velocity = rotation @ (state.velocity + jnp.cross(state.rates, self.tether_point))
        middle = self.anchor + 0.5 * span
        air_velocity = 0.5 * velocity - environment.wind_at(middle, time)
        load = self.load.per_length(environment.density_at(middle), air_velocity, span)
        force = self.law.force(span, length, load)
        return CableState(span, force.ship, force.anchor, load)


class TetheredAirship(eqx.Module):
    """The plant: ship, air around it, cables (none for a free ship).

    Attributes
    ----------
    ship : Airship
    environment : Environment
    cables : tuple of Cable
    """

    ship: Airship
    environment: Environment
    cables: tuple[Cable, ...]

    def cable_states(
        self, time: Float[Array, ""], state: State, lengths: Float[Array, "cables"]
    ) -> tuple[CableState, ...]:
        """Return the state of each cable at time t [s] for lengths L_t [m]."""
        return tuple(
            cable.state(time, state, lengths[i], self.environment) for i, cable in enumerate(self.cables)
        )

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

    def initial_lengths(self) -> Float[Array, "cables"]:
        """Return the unstretched lengths at the start [m]."""
        if not self.cables:
            return jnp.zeros(0)
        return jnp.stack([cable.length for cable in self.cables])


def end_tension(cable: CableState) -> Float[Array, ""]:
    """Return the largest tension along a cable [N]: it is at one of its ends."""
    return jnp.maximum(safe_norm(cable.ship), safe_norm(cable.anchor))
