"""Trim: the equilibrium of a ship, with any unknowns against any fixed quantities. Depends on: plant, scenario."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import jax
import numpy as np
from jaxtyping import Array, Float

from tethership.analysis.trim.judgement import judge
from tethership.analysis.trim.outcome import TrimOutcome
from tethership.analysis.trim.problem import Question, ask, posed
from tethership.analysis.trim.solve import described, solve
from tethership.errors import ConfigError, SolveError, shown
from tethership.plant import Command, State, check_parts
from tethership.scenario import Scenario

__all__ = ["TrimOutcome", "TrimPoint", "solved", "trim"]


class TrimPoint(NamedTuple):
    """Where the ship rests, or flies steadily.

    Attributes
    ----------
    state : State
        The twelve states: velocity [m/s] and rates [rad/s] in body axes, φ, θ, ψ [rad], x_P in ground axes [m].
    command : Command
        Throttles [-] and deflections [rad], beyond their limits where saturated.
    tension : Float[Array, "cables"]
        Tension at each tether point [N].
    residual : Float[Array, "6"]
        Force and moment left over, about P, body axes, with commands clipped to their limits [N, N m].
    saturated : tuple of str
        Thrusters and fins asked for more than they have.
    outcome : TrimOutcome
        Whether this is an equilibrium.
    message : str
        How it ended, by how much, and the cure.
    warnings : tuple of str
        What must be known of it before it is used: limits passed, a cable below the ground.
    limits_passed : dict[str, float]
        Tension over limit [-] of every watched limit (`results.limits`) that is passed.
    clearance_hull, clearance_cable : float or None
        Height of the lowest points of hull and cables above the ground [m]; None without ground or cable.
    scenario : Scenario, optional
        What was trimmed.
    """

    state: State
    command: Command
    tension: Float[Array, "cables"]
    residual: Float[Array, "6"]
    saturated: tuple[str, ...]
    outcome: TrimOutcome
    message: str
    warnings: tuple[str, ...]
    limits_passed: dict[str, float]
    clearance_hull: float | None
    clearance_cable: float | None
    scenario: Scenario | None = None


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
        Values of quantities that are not looked for, or where the search starts: velocities in ground axes [m/s], rates
        in body axes [rad/s], angles and deflections [rad], places in ground axes [m], throttles [-].
    throw : bool
        Raise SolveError where there is no equilibrium.

    Notes
    -----
    Where heading is looked for, the search starts with the nose into the wind and downwind of the anchor: an
    aerostat has other equilibria too. The attitude must stand still, and on a cable the ship (`plant.balance`): a
    point with rates is none, nor is one below the ground. Where there are more unknowns than equations, the throttles
    and deflections of least Euclidean norm are taken.

    Raises
    ------
    ConfigError
        A name is not known, or a part of one's own does not rest where it says.
    SolveError
        With `throw`, no equilibrium.

    Examples
    --------
    >>> import tethership as ts
    >>> point = ts.trim(ts.load_scenario("docking"))
    >>> point.outcome.name, round(float(point.tension[0]), 2)
    ('converged', 14.17)
    """
    if not isinstance(scenario, Scenario):
        raise ConfigError(f"trim: {shown(scenario)} is no scenario; give load_scenario(...)")
    _, point = solved(scenario, ask(scenario, unknowns, fixed))
    check_parts(scenario.system, point.state)
    if throw and not point.outcome.is_start:
        raise SolveError(f"{point.message} Residual: {np.asarray(point.residual)} N, N m")
    return point


def solved(scenario: Scenario, question: Question) -> tuple[np.ndarray, TrimPoint]:
    """Return the unknowns and the point that answer what a scenario's trim asks.

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`.
    question : Question
        From `ask`.

    Returns
    -------
    tuple
        The unknowns in their units, as `solve` returns them, and the TrimPoint: tensions [N], residual [N, N m].
    """
    problem = posed(scenario.config.as_arrays(), scenario.system, question)
    values = solve(problem)
    found = described(problem, values)
    said = judge(scenario, jax.device_get(found), question.height_sought)
    return values, TrimPoint(found.state, found.command, found.tension, found.clipped, *said, scenario)
