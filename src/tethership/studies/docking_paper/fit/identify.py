"""Identification of the unpublished parameters from the published rows. Depends on: fitting, scenario.

In order: Sobol points over the whole box; how far each published number moves when the initial attitude moves by 1 %,
which widens its tolerance (a chaotic peak is not fitted tightly); differential evolution; least squares from the best;
the set of all vectors that fit within 10 % of the best; and, for each table, the same search without it.
"""

import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from tethership.scenario import Scenario
from tethership.studies.docking_paper.fit.misfit import Item, fly_rows, items, residuals
from tethership.studies.docking_paper.fit.space import UNKNOWNS, to_shares, to_values
from tethership.studies.docking_paper.fit.spectrum import Spectrum
from tethership.studies.docking_paper.fit.targets import TABLES, Row, fitted_rows
from tethership.tuning import Archive, Slopes, evolve, misfit, refine, sobol, spread

NUDGE = 1.01
"""Factor on the initial attitude by which sensitivity is judged."""

JUDGED = 32
"""Best vectors over which the sensitivity of each number is judged (their median)."""

Progress = Callable[[str, float, float], None]
"""Called with the stage, the share of the whole that is done (0 … 1) and the least misfit so far."""


class Budget(NamedTuple):
    """How much is looked at.

    Attributes
    ----------
    power : int
        2^power Sobol points.
    population, generations : int
        Of the differential evolution.
    rounds : int
        Moves of each walker over the set.
    left_out : int
        Generations of each search without one table; 0 leaves that validation out.
    """

    power: int = 11
    population: int = 96
    generations: int = 60
    rounds: int = 100
    left_out: int = 24


class Identification(NamedTuple):
    """What a fit found.

    Attributes
    ----------
    formulation : str
    values : ndarray
        The best vector in SI [m², m, -, N], in the order of `UNKNOWNS`.
    misfit : float
        Its misfit, tables and spectrum [-].
    tables_misfit : float
        Of the tables alone [-].
    residuals : ndarray
        Its residuals in tolerances [-], tables first, then the four of the spectrum.
    items : tuple of Item
        What was fitted, with the tolerances used.
    nudged : ndarray
        Median |Δ ln| of each number under 1 % of initial attitude [-].
    members : ndarray
        Vectors [SI] that fit within 10 % of the best, shape (members, unknowns).
    left_out : dict
        Table → misfit of it when it was not fitted, and the vector.
    vectors : int
        Vectors looked at.
    seconds : float
        Wall time [s].
    """

    formulation: str
    values: np.ndarray
    misfit: float
    tables_misfit: float
    residuals: np.ndarray
    items: tuple[Item, ...]
    nudged: np.ndarray
    members: np.ndarray
    left_out: dict[str, dict[str, Any]]
    vectors: int
    seconds: float


class Objective:
    """Residuals of tables and spectrum, in tolerances [-], for places between the bounds, 0 … 1 [-]."""

    def __init__(self, scenario: Scenario, rows: Sequence[Row], what: Sequence[Item], spectrum: Spectrum) -> None:
        self.scenario, self.rows, self.what, self.spectrum = scenario, rows, what, spectrum

    def __call__(self, places: np.ndarray) -> np.ndarray:
        """Return residuals in tolerances, tables first, then the four of the spectrum."""
        values = to_values(places)
        tables = residuals(fly_rows(self.scenario, values, self.rows), self.rows, self.what)
        return np.concatenate([tables, self.spectrum.residuals(values)], axis=1)

    def slopes(self) -> Slopes:
        """Return the exact derivatives of the spectrum's residuals with respect to the places [-]: four rows."""

        def function(place: np.ndarray) -> np.ndarray:
            step = 1e-6
            scale = (to_values(place + step) - to_values(place - step)) / (2.0 * step)
            return self.spectrum.slopes(to_values(place)) * scale

        count = len(self.what)
        return Slopes(np.arange(count, count + 4), function)


def nudged(scenario: Scenario, values: np.ndarray, rows: Sequence[Row], what: Sequence[Item]) -> np.ndarray:
    """Return the median |Δ ln| [-] of each fitted number under 1 % of initial attitude, over vectors [SI].

    Parameters
    ----------
    scenario : Scenario
        With the paper's initial attitude [rad].
    values : ndarray
        Unknowns in SI [m², m, -, N], shape (vectors, unknowns).
    rows : sequence of Row
        Winds and layers to be flown.
    what : sequence of Item
        What is fitted.
    """
    offset = scenario.config.start.attitude_offset
    names = [f"start.attitude_offset.{i}" for i in range(3)]
    found = []
    for factor in (1.0, NUDGE):
        more = {name: np.full(len(values), factor * angle) for name, angle in zip(names, offset, strict=True)}
        found.append(residuals(fly_rows(scenario, values, rows, more), rows, what))
    tolerance = np.array([item.tolerance for item in what])
    return np.median(np.abs(found[1] - found[0]), axis=0) * tolerance


def widened(what: Sequence[Item], moved: np.ndarray) -> tuple[Item, ...]:
    """Return the items with tolerances √(tolerance² + Δ²) [-], so that what is chaotic counts little."""
    pairs = zip(what, moved, strict=True)
    return tuple(item._replace(tolerance=float(np.hypot(item.tolerance, shift))) for item, shift in pairs)


def _searched(
    objective: Objective, first: np.ndarray, found: np.ndarray, budget: Budget, generations: int, seed: int, report: Any
) -> Archive:
    """Return the archive of a search that starts at the best of given vectors, whose residuals are known."""
    archive = Archive(objective, report)
    archive.keep(first, found)
    evolve(archive, archive.best(budget.population), generations, seed)
    refine(archive, archive.best()[0], objective.slopes())
    return archive


def identify(
    scenario: Scenario, budget: Budget | None = None, seed: int = 1, progress: Progress | None = None
) -> Identification:
    """Fit the unpublished parameters of a docking scenario to the published rows.

    Parameters
    ----------
    scenario : Scenario
        Docking; its formulation, its control laws and whatever is not in `UNKNOWNS` stay.
    budget : Budget, optional
        How much is looked at.
    seed : int
        Of everything random: the same seed gives the same answer.
    progress : callable, optional
        See `Progress`.

    Returns
    -------
    Identification
        The best vector and all that fit nearly as well, in SI [m², m, -, N]; misfits [-].
    """
    budget = budget or Budget()
    begun = time.perf_counter()
    rows = fitted_rows()
    spectrum = Spectrum(scenario.formulation)
    plain = items(rows)
    start = sobol(len(UNKNOWNS), budget.power, seed)
    total = len(start) + budget.population * (budget.generations + 1 + budget.rounds) + 260
    total += 3 * (budget.population * (budget.left_out + 1) + 200) if budget.left_out else 0
    done = 0

    def reporter(stage: str) -> Callable[[int, float], None]:
        before = done

        def report(count: int, least: float) -> None:
            nonlocal done
            done = before + count
            if progress is not None:
                progress(stage, min(done / total, 1.0), least)

        return report

    first = Archive(Objective(scenario, rows, plain, spectrum), reporter("Sobol points"))
    for part in np.array_split(start, max(1, len(start) // 128)):
        first(part)
    places, found = first.all()
    moved = nudged(scenario, to_values(first.best(JUDGED)), rows, plain)
    what = widened(plain, moved)
    rescale = np.array([a.tolerance / b.tolerance for a, b in zip(plain, what, strict=True)])
    found = np.concatenate([found[:, : len(what)] * rescale, found[:, len(what) :]], axis=1)
    objective = Objective(scenario, rows, what, spectrum)
    archive = _searched(objective, places, found, budget, budget.generations, seed, reporter("evolution"))
    members = spread(archive, budget.rounds, budget.population, seed)
    best = archive.best()[0]
    at_best = archive.residuals_of(best)
    left_out = {}
    for table in TABLES if budget.left_out else ():
        left_out[table] = _without(objective, table, (places, found), budget, seed, reporter(f"without {table}"))
    return Identification(
        scenario.formulation,
        to_values(best),
        float(misfit(at_best)),
        float(misfit(at_best[: len(what)])),
        at_best,
        what,
        moved,
        to_values(_thinned(members, seed)),
        left_out,
        first.count + archive.count + sum(entry["vectors"] for entry in left_out.values()),
        time.perf_counter() - begun,
    )


MEMBERS = 200
"""Members of the set that are kept."""


def _thinned(members: np.ndarray, seed: int) -> np.ndarray:
    """Return at most `MEMBERS` of the set, drawn at random."""
    chosen = np.random.default_rng(seed).permutation(len(members))[:MEMBERS]
    return members[np.sort(chosen)]


def _without(
    whole: Objective, table: str, known: tuple[np.ndarray, np.ndarray], budget: Budget, seed: int, report: Any
) -> dict[str, Any]:
    """Return what a fit without one table says of it.

    Notes
    -----
    The Sobol points are flown already: their residuals without the table's columns start this search, so that
    nothing the table says comes into it.
    """
    kept = np.array([item.table != table for item in whole.what] + [True] * 4)
    rows = [row for row in whole.rows if row.table != table]
    partial = Objective(whole.scenario, rows, [item for item in whole.what if item.table != table], whole.spectrum)
    archive = _searched(partial, known[0], known[1][:, kept], budget, budget.left_out, seed, report)
    best = archive.best()[0]
    everything = whole(best[None])[0]
    return {
        "values": to_values(best).tolist(),
        "fitted_misfit": float(misfit(everything[kept])),
        "left_out_misfit": float(misfit(everything[~kept])),
        "left_out_residuals": everything[~kept].tolist(),
        "vectors": archive.count,
    }


def at_bounds(values: np.ndarray, margin: float = 0.02) -> list[str]:
    """Return the names of unknowns whose value lies within a share of the bounds' width from a bound.

    Parameters
    ----------
    values : ndarray
        In SI [m², m, -, N], shape (unknowns,).
    margin : float
        That share [-], of the width of the logarithm where an unknown is searched in it.
    """
    shares = to_shares(values)
    return [u.name for u, share in zip(UNKNOWNS, shares, strict=True) if share < margin or share > 1.0 - margin]
