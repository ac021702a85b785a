"""dA/dp along the trims of a scenario, exactly, for any of its numbers, and the slopes to both sides.

Depends on: analysis, scenario. The theory is in the docstring of `analysis.loci.sensitivity`.
"""

from collections.abc import Sequence

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership._kept import kept
from tethership.analysis.linear.right_side import input_vector, right_side
from tethership.analysis.trim.problem import Question, ask, pose, posed
from tethership.analysis.trim.solve import Problem
from tethership.analysis.trim.trim import TrimPoint
from tethership.errors import ConfigError
from tethership.plant import open_state
from tethership.scenario import Parameter, Scenario, ScenarioConfig, build_system, with_values
from tethership.spatial import rotation_matrix

COEFFICIENTS = "vehicle.hull.coefficients."
"""Names of a Gertler hull's coefficients begin so."""

SIDE = 1e-4
"""How far to the sides the slopes are looked at, of an ordinary step: curvature is not felt, rounding neither."""

SAME_POINT = 1e-6
"""Largest difference of a point from what its unknowns make of the scenario [SI, rad]."""


def matrix_slopes(
    scenario: Scenario, point: TrimPoint, parameters: Sequence[Parameter], steps: np.ndarray
) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Return dA/dp along the trims, whether a trim beside this one exists, and the slopes of A to both sides.

    Parameters
    ----------
    scenario : Scenario
        With a trim.
    point : TrimPoint
        That trim: an answer to what the scenario's own `trim` table asks.
    parameters : sequence of Parameter
        With respect to which; one that stands for several numbers moves all of them alike.
    steps : ndarray
        An ordinary change of each [SI]; the sides are looked at `SIDE` of it away.

    Notes
    -----
    Slopes are [state unit/s per state unit, per unit of the parameter], shape (parameters, n, n) for n states: e.g. of
    a velocity over itself with a length [1/(s m)].

    Raises
    ------
    ConfigError
        The point answers another question (other unknowns, other fixed values).
    """
    config = scenario.config.as_arrays()
    question = ask(scenario)
    values = _values_of(posed(config, scenario.system, question), point)
    places = sorted({place for parameter in parameters for place in parameter.places})
    leaves = jax.tree_util.tree_leaves(config)
    current = jnp.stack([jnp.asarray(leaves[place]) for place in places])
    fixed = tuple((place,) for place in places)
    slopes, left, size, moved = _retrimmed(config, fixed, question, current, values)
    combine = np.array([[_share(parameter, place) for place in places] for parameter in parameters])
    missing = np.abs(np.einsum("kp,rp->kr", combine, left)).max(axis=1)
    scale = np.maximum(np.abs(np.einsum("kp,rp->kr", combine, size)).max(axis=1), 1e-9)
    sided = _one_sided(config, fixed, question, current, values, combine, combine @ moved.T, SIDE * steps)
    return np.einsum("kp,ijp->kij", combine, slopes), missing < 1e-6 * scale, sided


def _one_sided(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    current: Float[Array, "leaves"],
    values: Float[Array, "unknowns"],
    directions: np.ndarray,
    moved: np.ndarray,
    steps: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the slopes of A before and after the point along each direction of the numbers, the trim moving along."""
    sign = np.concatenate([[0.0], -np.ones(len(steps)), np.ones(len(steps))])
    reach = np.concatenate([[0.0], steps, steps]) * sign
    numbers = np.asarray(current) + reach[:, None] * np.vstack([directions[:1], directions, directions])
    unknowns = np.asarray(values) + reach[:, None] * np.vstack([moved[:1], moved, moved])
    found = np.asarray(_matrices(config, places, question, jnp.asarray(numbers), jnp.asarray(unknowns)))
    here, before, after = found[0], found[1 : len(steps) + 1], found[len(steps) + 1 :]
    return (here - before) / steps[:, None, None], (after - here) / steps[:, None, None]


@kept
def _matrices(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    numbers: Float[Array, "points leaves"],
    values: Float[Array, "points unknowns"],
) -> Float[Array, "points states states"]:
    """Return A at many numbers and unknowns."""
    return jax.vmap(lambda own, unknowns: _matrix(config, places, question, own, unknowns)[0])(numbers, values)


def _matrix(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    numbers: Float[Array, "leaves"],
    unknowns: Float[Array, "unknowns"],
) -> tuple[Float[Array, "states states"], Problem]:
    """Return A at numbers of the scenario and unknowns of its trim, and the trim's problem there."""
    here = with_values(config, places, numbers)
    problem = pose(here, build_system(here), question)
    state, command = problem.unpack(unknowns)
    inputs, vector = input_vector(problem.plant, command), open_state(problem.plant, state, command)
    return jax.jacfwd(lambda s: right_side(problem.plant, s, inputs))(vector), problem


def _values_of(problem: Problem, point: TrimPoint) -> Float[Array, "unknowns"]:
    """Return the unknowns, in their units, at a point; ConfigError where they and what is given do not make it."""
    state, command = point.state, point.command
    motion = [rotation_matrix(state.attitude) @ state.velocity, state.rates, state.attitude, state.position]
    everything = np.concatenate(
        [*map(np.asarray, motion), np.asarray(command.throttle), np.asarray(command.deflection)]
    )
    values = jnp.asarray(problem.unknowns.taken(everything))
    made, commanded = problem.unpack(values)
    apart = np.abs(np.asarray(made.as_vector() - state.as_vector())).max(initial=0.0)
    wrong = np.abs(np.asarray(commanded.throttle - command.throttle)).max(initial=0.0)
    if max(apart, wrong) > SAME_POINT:
        raise ConfigError(
            "sensitivities: the point is no answer to the scenario's own trim table (other unknowns or fixed values); "
            "set trim.unknowns in the scenario, or leave the point out"
        )
    return values


def _share(parameter: Parameter, place: int) -> float:
    """Return how far one number moves with a parameter: −1 for the coefficient that closes the hull's tail."""
    if place not in parameter.places:
        return 0.0
    return -1.0 if parameter.name.startswith(COEFFICIENTS) and place != parameter.places[0] else 1.0


def _retrimmed(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    current: Float[Array, "leaves"],
    values: Float[Array, "unknowns"],
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return dA/dp (states, states, leaves) along the trims.

    Then what is left of the balance's derivative after retrimming (6, leaves), that derivative itself, and the slopes
    of the unknowns (unknowns, leaves).
    """
    count = len(places)
    effort = np.diag(np.asarray(question.unknowns.effort))
    slope = np.asarray(_slopes(config, places, question, current, values, jnp.zeros(6))[1])[:, count:]
    multiplier = -np.linalg.pinv(slope.T, rcond=1e-9) @ (effort @ np.asarray(values))
    matrix, balance, stationary = map(
        np.asarray, _slopes(config, places, question, current, values, jnp.asarray(multiplier))
    )
    system = np.block([[effort + stationary[:, count:], slope.T], [slope, np.zeros((6, 6))]])
    right = np.vstack([stationary[:, :count], balance[:, :count]])
    moved = -(np.linalg.pinv(system, rcond=1e-10) @ right)[: len(slope.T)]
    total = matrix[..., :count] + matrix[..., count:] @ moved
    return total, balance[:, :count] + slope @ moved, balance[:, :count], moved


@kept
def _slopes(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    current: Float[Array, "leaves"],
    values: Float[Array, "unknowns"],
    multiplier: Float[Array, "6"],
) -> tuple[Array, Array, Array]:
    """Return the derivatives of A, of the balance and of Jᵀμ with respect to numbers and unknowns (last axis)."""
    count = len(places)

    def everything(together: Float[Array, "n"]) -> tuple[Array, Array, Array]:
        numbers, unknowns = together[:count], together[count:]
        matrix, problem = _matrix(config, places, question, numbers, unknowns)
        return matrix, problem.balance(unknowns), multiplier @ jax.jacfwd(problem.balance)(unknowns)

    return jax.jacfwd(everything)(jnp.concatenate([current, values]))
