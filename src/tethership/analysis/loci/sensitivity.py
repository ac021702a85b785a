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

import numpy as np

from tethership.analysis.linear.linearize import linearize
from tethership.analysis.loci.matrix_slopes import COEFFICIENTS, matrix_slopes
from tethership.analysis.modes.modes import find_modes
from tethership.analysis.modes.spectrum import Spectrum, analyse
from tethership.analysis.trim.trim import TrimOutcome, TrimPoint, trim
from tethership.errors import SolveError
from tethership.scenario import Parameter, Scenario, ScenarioConfig, list_parameters

TABLES = ("vehicle.", "atmosphere.", "wind.", "ground.", "cables.", "trim.")
"""Parts of a scenario on which a trim and its linear model depend."""

WITHOUT_EFFECT = (".breaking_force", ".rewind_rate", ".fastest_rate")

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
        A change of ordinary size [SI]: 1 % of the value; of a value of zero or an angle, see `ordinary_step`.
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
        Largest shift first; those without a derivative last.
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

    Returns
    -------
    Sensitivities
        dλ/dp [1/s per unit of p] of every parameter, ranked by the shift |dλ/dp · step| [1/s] of an ordinary step.

    Raises
    ------
    SolveError
        The scenario has no trim.
    ConfigError
        There is no such mode, or the point is no answer to the scenario's own trim table.

    Notes
    -----
    Of a Gertler hull's coefficients the last moves against each of the others, so that the tail stays closed: to try
    such a row, change both. Components along a unit vector have no row.
    """
    return rank_sensitivities(scenario, [mode], point)[0]


def rank_sensitivities(
    scenario: Scenario, modes: Sequence[str], point: TrimPoint | None = None
) -> tuple[Sensitivities, ...]:
    """Return the tables of several modes, λ and shifts [1/s]; arguments and errors as in `sensitivities`."""
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
    slopes, exists, sided = matrix_slopes(scenario, found, list(parameters.values()), steps)
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
    if closing is None:
        return known
    last = closing.leaves[0]
    shape = {name: known[name]._replace(leaves=(*known[name].leaves, last)) for name in known if COEFFICIENTS in name}
    return known | shape


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

    Parameters
    ----------
    parameter : Parameter
        Its value is in its SI unit.
    length : float
        Length of the hull [m].

    Notes
    -----
    1 % of the value. Where that is zero 1 % of the hull's length for lengths [m], else 0.01 of the unit; for angles
    0.01 rad; for a coefficient of the hull's profile [-] 0.01.
    """
    if parameter.value != 0.0 and parameter.unit != "rad" and not parameter.name.startswith(COEFFICIENTS):
        return 0.01 * abs(parameter.value)
    return 0.01 * (length if parameter.unit == "m" else 1.0)
