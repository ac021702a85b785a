"""The trim problem of a scenario: what is looked for, what is held, where the search starts.

Depends on: analysis.trim.unknowns, analysis.trim.solve, scenario. `pose` can be traced: a sweep poses thousands at
once.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.trim.solve import Problem
from tethership.analysis.trim.unknowns import DOWN, Unknowns, find_places, find_unknowns
from tethership.errors import ConfigError
from tethership.plant import TetheredAirship
from tethership.scenario import Scenario, ScenarioConfig, TrimConfig
from tethership.spatial import rotation_matrix, safe_norm


class Question(NamedTuple):
    """What a trim asks.

    Attributes
    ----------
    unknowns : Unknowns
        What is looked for.
    hold : bool
        Whether the first tether point stays where it is put.
    heading_free : bool
        Whether ψ is looked for; the search then starts nose into the wind.
    places : tuple of int
        Places of quantities that are given.
    values : Float[Array, "given"]
        Their values in SI: of velocities [m/s], rates [rad/s], angles [rad], places [m], throttles [-].
    """

    unknowns: Unknowns
    hold: bool
    heading_free: bool
    places: tuple[int, ...]
    values: Float[Array | np.ndarray, "given"]

    @property
    def height_sought(self) -> bool:
        """Whether the height of P, which is −down [m], is looked for."""
        return DOWN in self.unknowns.index


def ask(
    scenario: Scenario, unknowns: Sequence[str] | None = None, fixed: Mapping[str, float] | None = None
) -> Question:
    """Return what a scenario's trim asks.

    Parameters
    ----------
    scenario : Scenario
        Its `trim` table says what `unknowns` and `fixed` leave open.
    unknowns : sequence of str, optional
        As in `trim`.
    fixed : mapping, optional
        As in `trim`, values in SI: [m/s], [rad/s], [rad], [m], throttles [-].

    Raises
    ------
    ConfigError
        A name is not known; or it follows from what is held (north, east, down) or from a turn (p, q, r).
    """
    vehicle = scenario.config.vehicle
    thrusters = [thruster.name for thruster in vehicle.thrusters]
    fins = [fin.name for fin in vehicle.fins]
    hold = scenario.config.trim.hold == "tether_point" and bool(scenario.config.cables)
    names = tuple(scenario.config.trim.unknowns if unknowns is None else unknowns)
    followers = (set(names) | set(fixed or {})) & {"north", "east", "down"}
    if hold and followers:
        raise ConfigError(
            f"trim: the tether point is held, so north, east and down follow; take out {', '.join(sorted(followers))} "
            'or set trim.hold = "reference_point"'
        )
    rates = (set(names) | set(fixed or {})) & {"p", "q", "r"}
    if rates and scenario.config.turning() is not None:
        raise ConfigError(
            f"trim: turn_rate and pull_up_rate say what p, q and r are; take out {', '.join(sorted(rates))}"
        )
    places = find_places(tuple(fixed or ()), thrusters, fins)
    values = np.asarray(list((fixed or {}).values()), dtype=float)
    return Question(find_unknowns(names, thrusters, fins), hold, "psi" in names, places, values)


def pose(config: ScenarioConfig, plant: TetheredAirship, question: Question) -> Problem:
    """Return the problem that a solver needs: all quantities where the search starts [m/s, rad/s, rad, m, -].

    Parameters
    ----------
    config : ScenarioConfig
        Its numbers as arrays; they may be traced.
    plant : TetheredAirship
        Built from it.
    question : Question
        From `ask`.
    """
    base = jnp.zeros(12 + plant.ship.thrusters.count + plant.ship.fins.count)
    velocity, drawn = jnp.asarray(config.trim.velocity), plant.anchor_velocity()
    base = (
        base.at[0:3].set(velocity if drawn is None else velocity + drawn).at[6:9].set(jnp.asarray(config.trim.attitude))
    )
    into_wind = jnp.asarray(config.wind.from_direction)
    turned = jnp.asarray(config.wind.speed) > 0
    if question.heading_free:
        base = base.at[8].set(jnp.where(turned, into_wind, base[8]))
    base = _given(base, question)
    place = start_position(config.trim, plant, base[6:9])
    if question.heading_free and plant.cables and not question.hold:
        aside = _downwind(place[:2], plant.cables[0].anchor[:2], into_wind)
        place = place.at[:2].set(jnp.where(turned, aside, place[:2]))
    base = _given(base.at[9:12].set(place), question)
    turning = config.turning()
    given = None if turning is None else jnp.stack([jnp.asarray(rate, dtype=float) for rate in turning])
    return Problem(plant.at_mean(), base, question.unknowns, question.hold, given)


@kept
def posed(config: ScenarioConfig, plant: TetheredAirship, question: Question) -> Problem:
    """Return `pose`, compiled."""
    return pose(config, plant, question)


def start_position(config: TrimConfig, plant: TetheredAirship, attitude: Float[Array, "3"]) -> Float[Array, "3"]:
    """Return x_P [m], ground axes, from which a trim begins, for an attitude φ, θ, ψ [rad]."""
    if config.position is not None:
        return jnp.asarray(config.position)
    cable = plant.cables[0]
    bearing, elevation = jnp.asarray(config.bearing), jnp.asarray(config.elevation)
    level = jnp.cos(elevation)
    direction = jnp.stack([level * jnp.cos(bearing), level * jnp.sin(bearing), -jnp.sin(elevation)])
    reach = jnp.asarray(config.elongation) * cable.length
    return cable.anchor + reach * direction - rotation_matrix(attitude) @ cable.tether_point


def _given(base: Float[Array, "n"], question: Question) -> Float[Array, "n"]:
    """Return all quantities with the given ones in place."""
    return base.at[np.array(question.places, dtype=int)].set(question.values)


def _downwind(
    place: Float[Array, "2"], anchor: Float[Array, "2"], from_direction: Float[Array, ""]
) -> Float[Array, "2"]:
    """Return a horizontal place (north, east) [m] turned about the anchor until it is downwind of it."""
    return anchor - safe_norm(place - anchor) * jnp.stack([jnp.cos(from_direction), jnp.sin(from_direction)])
