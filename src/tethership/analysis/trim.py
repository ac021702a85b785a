"""Trim: the equilibrium of a ship, with any unknowns against any fixed quantities. Depends on: system, scenario."""

import enum
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership.analysis.equilibrium import RESIDUAL_LIMIT, Problem, described, solve
from tethership.analysis.unknowns import find_unknowns
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
def start_position(config: TrimConfig, plant: TetheredAirship) -> Float[Array, "3"]:
    """Return x_P [m], ground axes, from which a trim begins; arguments are the scenario's."""
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
    rotation = rotation_matrix(jnp.asarray(config.attitude))
    return cable.anchor + reach * direction - rotation @ cable.tether_point


def _arrays(config: TrimConfig) -> TrimConfig:
    """Return the settings with numbers as arrays, which do not recompile when they change."""
    return jax.tree.map(lambda leaf: np.asarray(leaf) if isinstance(leaf, float) else leaf, config)


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
    Where there are more unknowns than equations, the throttles and deflections of least Euclidean norm are taken.

    Raises
    ------
    ConfigError
        A name is not known.
    SolveError
        With `throw`, no equilibrium.
    """
    config = scenario.config.trim
    vehicle = scenario.config.vehicle
    plant = scenario.system
    thrusters = [thruster.name for thruster in vehicle.thrusters]
    fins = [fin.name for fin in vehicle.fins]
    hold = config.hold == "tether_point" and bool(plant.cables)
    names = tuple(config.unknowns if unknowns is None else unknowns)
    if hold and set(names) & {"north", "east", "down"}:
        raise ConfigError(
            f"trim: the tether point is held, so north, east and down follow; take them out of {list(names)} "
            'or set trim.hold = "reference_point"'
        )
    base = np.concatenate(
        [
            config.velocity,
            np.zeros(3),
            config.attitude,
            start_position(_arrays(config), plant),
            np.zeros(len(thrusters) + len(fins)),
        ]
    )
    chosen, base = find_unknowns(names, dict(fixed or {}), thrusters, fins, base)
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
