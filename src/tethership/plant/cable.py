"""One cable from the ship to the ground: what it does for a state of the ship. Depends on: physics, plant."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership.physics import AbstractAnchorMotion, Winch
from tethership.physics.cable import AbstractTensionLaw, CableLoad
from tethership.plant.environment import Environment
from tethership.plant.state import State
from tethership.spatial import rotation_matrix, safe_norm


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


def end_tension(cable: CableState) -> Float[Array, ""]:
    """Return the largest tension along a cable [N]: it is at one of its ends."""
    return jnp.maximum(safe_norm(cable.ship), safe_norm(cable.anchor))
