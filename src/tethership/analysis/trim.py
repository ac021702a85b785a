"""Trim: the equilibrium of a ship, with any unknowns against any fixed quantities. Depends on: system, scenario."""

import enum
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership.analysis.equilibrium import RESIDUAL_LIMIT, Problem, described, solve
from tethership.analysis.unknowns import find_unknowns, place_values
from tethership.errors import ConfigError, SolveError
from tethership.scenario import Scenario
from tethership.scenario.schema import TrimConfig
from tethership.spatial import STANDARD_GRAVITY, rotation_matrix
from tethership.system import Command, State, TetheredAirship


class TrimOutcome(enum.Enum):
    """How a trim ended; the value is a sentence with the cure where one is needed."""

    converged = "In equilibrium."
    saturated = (
        "In equilibrium only with more thrust than there is; the named thrusters lack it. "
        "Less wind, a slacker cable or more nominal thrust are needed."
    )
    no_equilibrium = (
        "No equilibrium with these unknowns; the residual is what is left. "
        "Free more quantities (trim.unknowns) or start the search elsewhere (trim.position)."
    )


class TrimPoint(NamedTuple):
    """Where the ship rests, or flies steadily.

    Attributes
    ----------
    state : State
        The twelve states.
    command : Command
        Throttles [-] (beyond their limits where saturated) and deflections [rad].
    tension : Float[Array, "cables"]
        Tension at each tether point [N].
    residual : Float[Array, "6"]
        Force and moment left over, about P, body axes, with throttles clipped to their limits [N, N m].
    saturated : tuple of str
        Thrusters asked for more than they have.
    outcome : TrimOutcome
        Whether this is an equilibrium.
    """

    state: State
    command: Command
    tension: Float[Array, "cables"]
    residual: Float[Array, "6"]
    saturated: tuple[str, ...]
    outcome: TrimOutcome


@eqx.filter_jit
def start_position(config: TrimConfig, plant: TetheredAirship, attitude: Float[Array, "3"]) -> Float[Array, "3"]:
    """Return x_P [m], ground axes, from which a trim begins, for an attitude φ, θ, ψ [rad]."""
    if config.position is not None:
        return jnp.asarray(config.position)
    cable = plant.cables[0]
    level = jnp.cos(config.elevation)
    direction = jnp.stack(
        [
            level * jnp.cos(jnp.asarray(config.bearing)),
            level * jnp.sin(jnp.asarray(config.bearing)),
            -jnp.sin(jnp.asarray(config.elevation)),
        ]
    )
    reach = jnp.asarray(config.elongation) * cable.length
    rotation = rotation_matrix(jnp.asarray(attitude))
    return cable.anchor + reach * direction - rotation @ cable.tether_point


def _search_start(
    scenario: Scenario, heading_free: bool, hold: bool, place_fixed: Callable[[np.ndarray], None]
) -> np.ndarray:
    """Return all quantities (12 of the motion, throttles, deflections) where the search starts [SI, rad]."""
    config, plant = scenario.config.trim, scenario.system
    ship = plant.ship
    base = np.zeros(12 + ship.thrusters.count + ship.fins.count)
    base[0:3], base[6:9] = config.velocity, config.attitude
    into_wind = scenario.config.wind.from_direction
    turned = heading_free and scenario.config.wind.speed > 0
    if turned:
        base[8] = into_wind
    place_fixed(base)
    base[9:12] = start_position(config.as_arrays(), plant, jnp.asarray(base[6:9]))
    if turned and plant.cables and not hold:
        base[9:11] = _downwind(base[9:11], np.asarray(plant.cables[0].anchor)[:2], into_wind)
    place_fixed(base)
    return base


def _downwind(place: np.ndarray, anchor: np.ndarray, from_direction: float) -> np.ndarray:
    """Return a horizontal place (north, east) [m] turned about the anchor until it is downwind of it."""
    distance = np.linalg.norm(place - anchor)
    return anchor - distance * np.array([np.cos(from_direction), np.sin(from_direction)])


def trim(
    scenario: Scenario,
    unknowns: Sequence[str] | None = None,
    fixed: Mapping[str, float] | None = None,
    throw: bool = False,
) -> TrimPoint:
    """Return the equilibrium of a scenario.

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`; its `trim` table holds the defaults.
    unknowns : sequence of str, optional
        What is looked for: `velocity_north` … `down` (see `unknowns.QUANTITIES`), names of thrusters
        or fins, `throttle`, `deflection`.
    fixed : mapping, optional
        Values of quantities that are not looked for, or where the search starts [SI, rad].
    throw : bool
        Raise SolveError where there is no equilibrium.

    Notes
    -----
    Where heading is looked for, the search starts with the nose into the wind and downwind of the anchor: an
    aerostat has other equilibria too. Where there are more unknowns than equations, the throttles and deflections of
    least Euclidean norm are taken.

    Raises
    ------
    ConfigError
        A name is not known.
    SolveError
        With `throw`, no equilibrium.
    """
    vehicle = scenario.config.vehicle
    plant = scenario.system
    thrusters = [thruster.name for thruster in vehicle.thrusters]
    fins = [fin.name for fin in vehicle.fins]
    hold = scenario.config.trim.hold == "tether_point" and bool(plant.cables)
    names = tuple(scenario.config.trim.unknowns if unknowns is None else unknowns)
    followers = (set(names) | set(fixed or {})) & {"north", "east", "down"}
    if hold and followers:
        raise ConfigError(
            f"trim: the tether point is held, so north, east and down follow; take out {', '.join(sorted(followers))} "
            'or set trim.hold = "reference_point"'
        )
    chosen = find_unknowns(names, thrusters, fins)
    base = _search_start(scenario, "psi" in names, hold, partial(place_values, dict(fixed or {}), thrusters, fins))
    problem = Problem(plant, jnp.asarray(base), chosen, hold)
    point = _judged(plant, thrusters, *described(problem, jnp.asarray(solve(problem))))
    if throw and point.outcome is TrimOutcome.no_equilibrium:
        raise SolveError(f"{point.outcome.value} Residual: {np.asarray(point.residual)} N, N m")
    return point


def _judged(plant: TetheredAirship, thrusters: list[str], *found: Any) -> TrimPoint:
    """Return the point with its outcome."""
    state, command, tension, free, clipped = found
    weight = float(plant.ship.gravity.mass) * STANDARD_GRAVITY
    throttle = np.asarray(command.throttle)
    allowed = np.asarray(plant.ship.thrusters.saturate(command.throttle))
    saturated = tuple(name for name, over in zip(thrusters, throttle != allowed, strict=True) if over)
    left = np.abs(np.asarray(free)).max()
    if not np.isfinite(left) or left > RESIDUAL_LIMIT * max(weight, 1.0):
        outcome = TrimOutcome.no_equilibrium
    else:
        outcome = TrimOutcome.saturated if saturated else TrimOutcome.converged
    return TrimPoint(state, command, tension, clipped, saturated, outcome)
