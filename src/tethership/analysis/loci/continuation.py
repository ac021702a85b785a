"""Trim and linear model of many points in one batched, compiled call, by continuation from a known trim.

Depends on: analysis.trim.problem, analysis.trim.solve, analysis.linear.linearize, scenario.

Every point is reached from the reference along a straight path in the parameters, all points together: first in one
step; those that do not converge, and all where states are looked for (several equilibria may exist), in more and
shorter ones. The batch is the last axis.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.linear.closed import state_matrix
from tethership.analysis.linear.linearize import comparable_coordinates
from tethership.analysis.linear.right_side import input_vector, right_side
from tethership.analysis.trim.problem import Question, pose
from tethership.analysis.trim.solve import EFFORT, Problem, described
from tethership.plant import DRIFT_LIMIT, open_state, residual_limit
from tethership.scenario import ScenarioConfig, build_loop, build_system, with_values

BATCH = 128
"""Points of one compiled call: fixed, so that every sweep runs the same program."""

STAGES = (1, 8, 64)
"""Steps of the path from the reference, tried in turn."""

ROUNDS = 40
"""How often points off the branch of their line are solved again from their neighbours."""

MOST_ITERATIONS = 30
LARGEST_STEP = 3.0
"""Longest Newton step of a state, in its unit (0.1 rad, 1 m, 1 m/s)."""

CONVERGED = 1e-11
"""Newton step below which a trim is done, in the unknowns' units."""

_RIDGE = 1e-14
"""Added to the normal equations, relative: directions without any effect stay where they are."""


class Batch(NamedTuple):
    """What is known of a batch of points: JAX arrays with the batch last, or numpy arrays with the points first.

    Attributes
    ----------
    unknowns : array
        Solution in the unknowns' units (`analysis.trim.unknowns.SCALES`).
    state : array
        Twelve states in the order of `STATE_NAMES` [m/s, rad/s, rad, m].
    throttle, deflection : array
        δ [-] of thrusters and [rad] of fins, not clipped.
    tension, largest : array
        Tension of each cable at its tether point, and the largest along it [N].
    residual : array
        Force and moment left over with commands not clipped [N, N m].
    drift : array
        Rates of what must stand still [rad/s, m/s].
    hull, cables : array
        Height of the lowest point of the hull and of each cable above the ground [m].
    limit : array
        Largest residual of an equilibrium [N, N m].
    matrix : array
        A [state unit/s per state unit], (states, states).
    comparable : array
        Matrix to comparable coordinates, (states, states), as `comparable_coordinates` returns it.
    """

    unknowns: Any
    state: Any
    throttle: Any
    deflection: Any
    tension: Any
    largest: Any
    residual: Any
    drift: Any
    hull: Any
    cables: Any
    limit: Any
    matrix: Any
    comparable: Any


def nearby_equilibrium(problem: Problem, start: Float[Array, "unknowns"]) -> Float[Array, "unknowns"]:
    """Return the unknowns of an equilibrium with the least effort, from a start nearby.

    Parameters
    ----------
    problem : Problem
        As `pose` returns it.
    start : Float[Array, "unknowns"]
        Where to begin, each in its unit: 1 m/s, 0.1 rad/s, 0.1 rad, 1 m, and throttles [-] and deflections [rad].

    Notes
    -----
    Gauss–Newton on the balance and a small weight on the effort (as `analysis.trim.solve.solve`): the fixed point has
    the least norm of throttles to 1e-6 and a residual far below that of an equilibrium.
    """
    effort = EFFORT**2 * problem.unknowns.effort
    longest = jnp.where(problem.unknowns.effort > 0, jnp.inf, LARGEST_STEP)

    def step(carry: tuple[Array, Array, Array]) -> tuple[Array, Array, Array]:
        count, values, _ = carry
        residual, slope = problem.balance(values), jax.jacfwd(problem.balance)(values)
        normal = slope.T @ slope
        ridge = _RIDGE * jnp.trace(normal) + 1e-30
        move = -jnp.linalg.solve(normal + jnp.diag(effort + ridge), slope.T @ residual + effort * values)
        move = jnp.where(jnp.isfinite(move), move, 0.0)
        shrink = jnp.minimum(1.0, jnp.min(longest / jnp.maximum(jnp.abs(move), 1e-300)))
        return count + 1, values + shrink * move, jnp.max(jnp.abs(move))

    def unfinished(carry: tuple[Array, Array, Array]) -> Array:
        count, _, moved = carry
        return (count < MOST_ITERATIONS) & (moved > CONVERGED)

    return jax.lax.while_loop(unfinished, step, (jnp.zeros((), int), start, jnp.asarray(jnp.inf)))[1]


@kept
def _solve_batch(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    values: Float[Array, "parameters batch"],
    starts: Float[Array, "unknowns batch"],
    closed: bool,
) -> Batch:
    """Return a batch of trims with their state matrices; `places` are the leaves that each parameter moves."""

    def point(value: Float[Array, "parameters"], start: Float[Array, "unknowns"]) -> Batch:
        numbers = with_values(config, places, value)
        plant = build_system(numbers).at_mean()
        problem = pose(numbers, plant, question)
        found = nearby_equilibrium(problem, start)
        here = described(problem, found)
        vector, inputs = open_state(plant, here.state, here.command), input_vector(plant, here.command)
        comparable = comparable_coordinates(plant, vector)
        if closed:
            matrix = state_matrix(build_loop(numbers, plant, here.command), here.state)
            comparable = jnp.eye(len(matrix)).at[: len(vector), : len(vector)].set(comparable)
        else:
            matrix = jax.jacfwd(lambda s: right_side(plant, s, inputs))(vector)
        return Batch(
            found,
            here.state.as_vector(),
            here.command.throttle,
            here.command.deflection,
            here.tension,
            here.largest,
            here.residual,
            here.drift,
            here.hull,
            here.cables,
            residual_limit(plant),
            matrix,
            comparable,
        )

    return jax.vmap(point, in_axes=-1, out_axes=-1)(values, starts)


def solve_points(
    config: ScenarioConfig,
    places: Sequence[tuple[int, ...]],
    question: Question,
    values: np.ndarray,
    reference: np.ndarray,
    start: np.ndarray,
    per_line: int,
    usual: Sequence[int] = (),
    closed: bool = False,
) -> Batch:
    """Return trims and state matrices of many points.

    Where states are looked for, several equilibria may exist: points that do not continue their neighbours are solved
    again from those, and an equilibrium that is then still of another branch (this one may have ended) is marked by an
    infinite residual.

    Parameters
    ----------
    config : ScenarioConfig
        The scenario; its numbers as arrays.
    places : sequence
        Leaves that each parameter moves (`Parameter.places`).
    question : Question
        What the trim looks for.
    values : ndarray
        Parameters of every point [SI], shape (points, parameters).
    reference : ndarray
        Parameters of the known trim [SI].
    start : ndarray
        Its unknowns, in their units, shape (unknowns,).
    per_line : int
        How many points each line has, neighbours close to each other.
    usual : sequence of int
        Leaves that the program can move although these points do not: sweeps of any of them share it.
    closed : bool
        Matrices of the closed loop, with the scenario's laws.

    Returns
    -------
    Batch
        Numpy arrays, the points first: tensions [N], heights [m], residuals [N, N m] and so on.
    """
    leaves = jax.tree.leaves(config)
    column = {place: i for i, group in enumerate(places) for place in group}
    every = sorted({*column, *usual})
    fixed = tuple((place,) for place in every)

    def at(where: np.ndarray, begin: np.ndarray) -> Batch:
        own = [where[:, column[p]] if p in column else np.full(len(where), float(leaves[p])) for p in every]
        return _in_batches(config, fixed, question, np.stack(own, axis=1), begin, closed)

    def along(stages: int, chosen: np.ndarray) -> Batch:
        begin = np.repeat(start[None], len(chosen), axis=0)
        found = None
        for stage in range(1, stages + 1):
            share = stage / stages
            found = at(reference + share * (chosen - reference), begin)
            begin = np.where(np.isfinite(found.unknowns), found.unknowns, begin)
        assert found is not None
        return found

    searched_states = bool(np.any(np.asarray(question.unknowns.effort) == 0.0))
    stages = STAGES[1:] if searched_states else STAGES
    result = along(stages[0], values)
    for count in stages[1:]:
        missing = np.flatnonzero(~in_equilibrium(result))
        if not len(missing):
            break
        better = along(count, values[missing])
        _replace(result, missing, better)
    if searched_states:
        nearest = np.abs((values - reference) / np.maximum(np.ptp(values, axis=0), 1e-12)).sum(axis=1)
        _keep_to_branch(at, result, values, nearest, per_line, np.asarray(question.unknowns.effort) == 0.0)
    return result


def _replace(batch: Batch, places: np.ndarray, better: Batch) -> None:
    """Put points into a batch, in place."""
    for old, new in zip(batch, better, strict=True):
        old[places] = new


def _keep_to_branch(
    at: Callable[[np.ndarray, np.ndarray], Batch],
    batch: Batch,
    values: np.ndarray,
    nearest: np.ndarray,
    per_line: int,
    states: np.ndarray,
) -> None:
    """Solve points again that are not on the branch of their line, in place; mark those that stay off it.

    Parameters
    ----------
    at : callable
        Trims of points from starts.
    batch : Batch
        All points.
    values : ndarray
        Their parameters.
    nearest : ndarray
        Distance of each from the reference; each line's branch is that of its nearest point.
    per_line : int
        Points of each line.
    states : ndarray of bool
        Which unknowns are states.
    """
    lines = [np.arange(first, first + per_line) for first in range(0, len(values), per_line)]
    off = np.zeros(0, dtype=int)
    for _ in range(ROUNDS):
        good = in_equilibrium(batch)
        neighbours = np.concatenate([_branch(batch.unknowns[:, states], good, nearest, line) for line in lines])
        off = np.flatnonzero(neighbours != np.arange(len(values)))
        if not len(off) or np.all(neighbours[off] < 0):
            break
        chosen = off[neighbours[off] >= 0]
        _replace(batch, chosen, at(values[chosen], batch.unknowns[neighbours[chosen]]))
    batch.residual[off[in_equilibrium(batch)[off]]] = np.inf


def _branch(unknowns: np.ndarray, good: np.ndarray, nearest: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Return for each point of a line itself if it is on the branch, else the last one that is; −1 where none is.

    Notes
    -----
    Walking away from the point nearest to the reference, a step of the states may be one unit (0.1 rad, 1 m) and three
    times the last one; up to three points that are off are passed over.
    """
    result = np.full(len(line), -1)
    if not good[line].any():
        return result
    seed = int(np.argmin(np.where(good[line], nearest[line], np.inf)))
    result[seed] = line[seed]
    for path in (range(seed + 1, len(line)), range(seed - 1, -1, -1)):
        last, moved = seed, 0.0
        for here in path:
            gap = abs(here - last)
            step = np.abs(unknowns[line[here]] - unknowns[line[last]]).max() / gap
            if good[line[here]] and gap <= 4 and step <= 1.0 + 3.0 * moved:
                last, moved = here, step
            result[here] = line[last]
    return result


def in_equilibrium(batch: Batch) -> np.ndarray:
    """Return which points (first axis) are in equilibrium, with a state matrix that is finite.

    Residuals are held against the batch's own limit [N, N m], rates of what must stand still against `DRIFT_LIMIT`
    [rad/s, m/s].
    """
    small = np.abs(batch.residual).max(axis=1) <= batch.limit
    small &= np.abs(batch.drift).max(axis=1) <= DRIFT_LIMIT
    return small & np.isfinite(batch.matrix).all(axis=(1, 2))


def _in_batches(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    values: np.ndarray,
    starts: np.ndarray,
    closed: bool,
) -> Batch:
    """Return the points of `values` (points first), computed in batches of one size."""
    parts = []
    for first in range(0, len(values), BATCH):
        rows = np.minimum(np.arange(first, first + BATCH), len(values) - 1)
        where, begin = jnp.asarray(values[rows].T), jnp.asarray(starts[rows].T)
        parts.append(_solve_batch(config, places, question, where, begin, closed))
    fields = []
    for name in Batch._fields:
        arrays = [np.moveaxis(np.asarray(getattr(part, name)), -1, 0) for part in parts]
        fields.append(np.concatenate(arrays)[: len(values)])
    return Batch(*fields)
