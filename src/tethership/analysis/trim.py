"""Trim: the equilibrium of a ship, with any unknowns against any fixed quantities. Depends on: system, scenario."""

import enum
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership.analysis.equilibrium import RESIDUAL_LIMIT, described, solve
from tethership.analysis.posing import Question, ask, posed
from tethership.errors import SolveError
from tethership.scenario import Scenario
from tethership.spatial import STANDARD_GRAVITY
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

    Examples
    --------
    >>> import tethership as ts
    >>> point = ts.trim(ts.load_scenario("docking"))
    >>> point.outcome.name, round(float(point.tension[0]), 2)
    ('converged', 14.17)
    """
    _, point = solved(scenario, ask(scenario, unknowns, fixed))
    if throw and point.outcome is TrimOutcome.no_equilibrium:
        raise SolveError(f"{point.outcome.value} Residual: {np.asarray(point.residual)} N, N m")
    return point


def solved(scenario: Scenario, question: Question) -> tuple[np.ndarray, TrimPoint]:
    """Return the unknowns, in their units, and the point that answer what a scenario's trim asks."""
    thrusters = [thruster.name for thruster in scenario.config.vehicle.thrusters]
    problem = posed(scenario.config.as_arrays(), scenario.system, question)
    values = solve(problem)
    return values, _judged(scenario.system, thrusters, *described(problem, jnp.asarray(values)))


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
