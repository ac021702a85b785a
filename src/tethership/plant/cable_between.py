"""One cable between two points that are given, as a question of statics. Depends on: plant.cable."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.plant.cable import Cable
from tethership.plant.environment import Environment
from tethership.spatial import safe_norm


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


@kept
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


@kept
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
