"""Exact derivatives of eigenvalues with respect to every number of vehicle and scenario, the trim moving along.

Depends on: analysis, scenario.

    dA/dp = ∂A/∂p + ∂A/∂z dz/dp,     dλ/dp = tr(P dA/dp)/k

z are the trim's unknowns, P the spectral projector of λ and k its multiplicity. dz/dp follows from the implicit
function theorem on the optimality conditions of the trim, balance(z, p) = 0 with least effort ½|Wz|²:

    [[W + Σμᵢ∇²rᵢ, Jᵀ], [J, 0]] (dz, dμ) = −(∂ₚ(Jᵀμ), ∂ₚr),     J = ∂r/∂z,   Wz + Jᵀμ = 0

A repeated or defective eigenvalue has no derivative: the group's mean has, and is what is given for it. Where A itself
has a corner (|v| of a cross-flow that is zero, as of a symmetric ship whose tether point moves sideways) there is none
either: the slopes of A to both sides along the trims are compared, and where they differ none is given.
"""

from collections.abc import Sequence
from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from tethership.analysis.continuation import place_values
from tethership.analysis.equilibrium import Problem, solve
from tethership.analysis.linearize import linearize
from tethership.analysis.modes import find_modes
from tethership.analysis.posing import Question, ask, pose, posed
from tethership.analysis.right_side import input_vector, right_side
from tethership.analysis.spectrum import Spectrum, analyse
from tethership.analysis.trim import TrimOutcome, TrimPoint, trim
from tethership.errors import SolveError
from tethership.scenario import Scenario, ScenarioConfig
from tethership.scenario.build import build_system
from tethership.scenario.parameters import Parameter, list_parameters
from tethership.spatial import STANDARD_GRAVITY

TABLES = ("vehicle.", "atmosphere.", "wind.", "ground.", "cables.", "trim.")
"""Parts of a scenario on which a trim and its linear model depend."""

COEFFICIENTS = "vehicle.hull.coefficients."

WITHOUT_EFFECT = (".breaking_force", ".rewind_rate", ".fastest_rate")

SIDE = 1e-4
"""How far to the sides the slopes are looked at, of an ordinary step: curvature is not felt, rounding neither."""

CORNER = 0.02
"""Relative difference of the slopes to both sides beyond which there is a corner."""

CLUSTER = 1e-7
"""Eigenvalues that an error of A of this relative size would let coalesce are taken as one group."""


class Sensitivity(NamedTuple):
    """What one parameter does to an eigenvalue.

    Attributes
    ----------
    parameter : str
        Dotted name.
    unit : str
        Its SI unit.
    value : float
        Its value [SI].
    derivative : complex or None
        dλ/dp [1/s per unit]; None where there is none, see `reason`.
    step : float
        A change of ordinary size: 1 % of the value; of a value of zero or an angle, see `ordinary_step`.
    shift : complex or None
        derivative · step [1/s]; rows are ranked by its modulus.
    reason : str
        Why there is no derivative: `no trim` beside this point, or `corner`, where the slopes to both sides differ.
    """

    parameter: str
    unit: str
    value: float
    derivative: complex | None
    step: float
    shift: complex | None
    reason: str = ""


class Sensitivities(NamedTuple):
    """The ranked table of one mode.

    Attributes
    ----------
    mode : str
        Name of the mode.
    eigenvalue : complex
        λ [1/s], or the mean of its group.
    multiplicity : int
        Size of the group: above 1 the derivatives are those of the group's mean, λ itself having none.
    rows : tuple of Sensitivity
        Largest shift first; parameters that cannot be trimmed beside this point last.
    """

    mode: str
    eigenvalue: complex
    multiplicity: int
    rows: tuple[Sensitivity, ...]

    @property
    def message(self) -> str:
        """One sentence on what the derivatives are."""
        if self.multiplicity == 1:
            return f"derivatives of the eigenvalue of {self.mode}"
        return (
            f"{self.mode} is one of {self.multiplicity} eigenvalues that coincide: none of them has a derivative; "
            "derivatives of their mean"
        )


def sensitivities(scenario: Scenario, mode: str, point: TrimPoint | None = None) -> Sensitivities:
    """Return how every number of vehicle and scenario moves a mode, ranked.

    Parameters
    ----------
    scenario : Scenario
        From `load_scenario`.
    mode : str
        Name of a mode of the trimmed ship (see `LinearModel.modes`).
    point : TrimPoint, optional
        Its trim; computed if not given.

    Raises
    ------
    SolveError
        The scenario has no trim.
    ConfigError
        There is no such mode.

    Notes
    -----
    Of a Gertler hull's coefficients the last moves against each of the others, so that the tail stays closed: to try
    such a row, change both. Components along a unit vector have no row.
    """
    return rank_sensitivities(scenario, [mode], point)[0]


def rank_sensitivities(
    scenario: Scenario, modes: Sequence[str], point: TrimPoint | None = None
) -> tuple[Sensitivities, ...]:
    """Return the tables of several modes; arguments and errors as in `sensitivities`."""
    found = trim(scenario) if point is None else point
    if found.outcome is TrimOutcome.no_equilibrium:
        raise SolveError(f"{found.outcome.value} Without it there are no modes.")
    model = linearize(scenario, found)
    named = find_modes(model)
    spectrum = analyse(model.comparable_matrix(), CLUSTER)
    chosen = [named.find(name) for name in modes]
    parameters = _relevant(scenario.config)
    length = scenario.config.vehicle.hull.length
    steps = np.array([ordinary_step(parameter, length) for parameter in parameters.values()])
    slopes, exists, sided = matrix_slopes(scenario, list(parameters.values()), steps)
    to_comparable, back = model.comparable, np.linalg.inv(model.comparable)
    tables = []
    for one in chosen:
        group, projector = _group(spectrum, one.eigenvalue)
        projector = back @ projector @ to_comparable
        derivative, before, after = (np.einsum("ij,kji->k", projector, a) / len(group) for a in (slopes, *sided))
        smooth = np.abs(after - before) * steps <= CORNER * (np.abs(derivative) * steps) + 1e-8
        reasons = np.where(exists, np.where(smooth, "", "corner"), "no trim")
        rows = _rows(parameters, derivative, steps, reasons)
        rows.sort(key=lambda row: (row.shift is None, -abs(row.shift or 0.0), row.parameter))
        mean = complex(spectrum.eigenvalues[list(group)].mean())
        tables.append(Sensitivities(one.name, mean, len(group), tuple(rows)))
    return tuple(tables)


def _relevant(config: ScenarioConfig) -> dict[str, Parameter]:
    """Return the parameters on which a trim may depend and that can change by themselves.

    Notes
    -----
    Components along a unit vector cannot, and of a Gertler hull's six coefficients the last closes the tail: it moves
    against each of the others and has no row of its own.
    """
    known = {
        name: parameter
        for name, parameter in list_parameters(config).items()
        if name.startswith(TABLES)
        and not name.endswith(WITHOUT_EFFECT)
        and not (".direction." in name and parameter.value != 0.0)
    }
    closing = known.pop(f"{COEFFICIENTS}5", None)
    return (
        known
        if closing is None
        else known
        | {
            name: parameter._replace(leaves=(*parameter.leaves, closing.leaves[0]))
            for name, parameter in known.items()
            if name.startswith(COEFFICIENTS)
        }
    )


def _group(spectrum: Spectrum, eigenvalue: complex) -> tuple[tuple[int, ...], np.ndarray]:
    """Return the group that an eigenvalue belongs to, and its projector."""
    nearest = int(np.argmin(np.abs(spectrum.eigenvalues - eigenvalue)))
    index = next(i for i, group in enumerate(spectrum.groups) if nearest in group)
    return spectrum.groups[index], spectrum.projectors[index]


def _rows(
    parameters: dict[str, Parameter], derivative: np.ndarray, steps: np.ndarray, reasons: np.ndarray
) -> list[Sensitivity]:
    """Return the rows of the table."""
    rows = []
    for (name, parameter), slope, step, reason in zip(parameters.items(), derivative, steps, reasons, strict=True):
        given = None if reason else complex(slope)
        shift = None if given is None else given * float(step)
        rows.append(Sensitivity(name, parameter.unit, parameter.value, given, float(step), shift, str(reason)))
    return rows


def ordinary_step(parameter: Parameter, length: float) -> float:
    """Return a change of ordinary size, in the unit of the parameter.

    Notes
    -----
    1 % of the value. Where that is zero 1 % of the hull's length for lengths, else 0.01 of the unit; for angles
    0.01 rad; for a coefficient of the hull's profile 0.01.
    """
    if parameter.value != 0.0 and parameter.unit != "rad" and not parameter.name.startswith(COEFFICIENTS):
        return 0.01 * abs(parameter.value)
    return 0.01 * (length if parameter.unit == "m" else 1.0)


def matrix_slopes(
    scenario: Scenario, parameters: Sequence[Parameter], steps: np.ndarray
) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """Return dA/dp along the trims, whether a trim beside this one exists, and the slopes of A to both sides.

    Parameters
    ----------
    scenario : Scenario
        With a trim.
    parameters : sequence of Parameter
        With respect to which; one that stands for several numbers moves all of them alike.
    steps : ndarray
        An ordinary change of each [SI]; the sides are looked at `SIDE` of it away.

    Notes
    -----
    Slopes have the shape (parameters, 12, 12).
    """
    config = scenario.config.as_arrays()
    question = ask(scenario)
    values = jnp.asarray(solve(posed(config, scenario.system, question)))
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


@eqx.filter_jit
def _matrices(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    numbers: Float[Array, "points leaves"],
    values: Float[Array, "points unknowns"],
) -> Float[Array, "points 12 12"]:
    """Return A at many numbers and unknowns."""
    return jax.vmap(lambda own, unknowns: _matrix(config, places, question, own, unknowns)[0])(numbers, values)


def _matrix(
    config: ScenarioConfig,
    places: tuple[tuple[int, ...], ...],
    question: Question,
    numbers: Float[Array, "leaves"],
    unknowns: Float[Array, "unknowns"],
) -> tuple[Float[Array, "12 12"], Problem]:
    """Return A at numbers of the scenario and unknowns of its trim, and the trim's problem there."""
    here = place_values(config, places, numbers)
    problem = pose(here, build_system(here), question)
    state, command = problem.unpack(unknowns)
    inputs = input_vector(problem.plant, command)
    return jax.jacfwd(lambda s: right_side(problem.plant, s, inputs))(state.as_vector()), problem


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
    """Return dA/dp (12, 12, leaves) along the trims.

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


@eqx.filter_jit
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
        plant = problem.plant

        def balance(unknowns: Array) -> Array:
            unit = 1e-3 * plant.ship.gravity.mass * STANDARD_GRAVITY
            return problem.residual(*problem.unpack(unknowns)) / unit

        return matrix, balance(unknowns), multiplier @ jax.jacfwd(balance)(unknowns)

    return jax.jacfwd(everything)(jnp.concatenate([current, values]))
