"""Searching a box of unknowns for the least misfit and for all that fit nearly as well. Depends on: scipy, numpy.

The objective is called with many vectors at once (places between the bounds, 0 … 1) and returns residuals in
tolerances. Global: scrambled Sobol points, then differential evolution (scipy). Local: least squares (scipy, trust
region, soft L1, so the same misfit). The set: a random walk by differences of members, which accepts whatever fits
within a factor of the best, so that its members end up spread evenly over the set.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import scipy.optimize
import scipy.stats

Objective = Callable[[np.ndarray], np.ndarray]
"""From places (vectors, unknowns) to residuals (vectors, items)."""

Score = Callable[[np.ndarray], np.ndarray]
"""From residuals (vectors, items) to what is made small (vectors,)."""

NEARLY = 1.1
"""A vector whose misfit is within this factor of the best fits nearly as well."""

STEP = 0.02
"""Step of difference quotients, as a share of a bound's width."""


def misfit(residual: np.ndarray) -> np.ndarray:
    """Return the mean of 2(√(1 + r²) − 1) over the last axis [-]."""
    return np.mean(2.0 * (np.sqrt(1.0 + residual**2) - 1.0), axis=-1)


class Archive:
    """Every vector looked at, with its residuals; calls the objective.

    Attributes
    ----------
    places, residuals : list of ndarray
        What was asked, between the bounds, 0 … 1 [-], shape (vectors, unknowns), and what came, in tolerances [-],
        shape (vectors, items), call by call.
    score : callable
        What is made small [-].
    """

    def __init__(
        self, objective: Objective, report: Callable[[int, float], None] | None = None, score: Score = misfit
    ) -> None:
        self._objective, self._report, self.score = objective, report, score
        self.places: list[np.ndarray] = []
        self.residuals: list[np.ndarray] = []
        self.count = 0
        self.least = np.inf

    def __call__(self, places: np.ndarray) -> np.ndarray:
        """Return the residuals of vectors and keep them."""
        found = self._objective(places)
        self.keep(places, found)
        self.count += len(places)
        if self._report is not None:
            self._report(self.count, self.least)
        return found

    def keep(self, places: np.ndarray, found: np.ndarray) -> None:
        """Take up vectors, places 0 … 1 [-], whose residuals in tolerances [-] are known."""
        self.places.append(places.copy())
        self.residuals.append(found)
        self.least = min(self.least, float(self.score(found).min()))

    def all(self) -> tuple[np.ndarray, np.ndarray]:
        """Return places, 0 … 1 [-], and residuals in tolerances [-] of everything looked at, the vectors first."""
        return np.concatenate(self.places), np.concatenate(self.residuals)

    def residuals_of(self, place: np.ndarray) -> np.ndarray:
        """Return the residuals in tolerances [-], shape (items,), of one vector that was looked at."""
        places, residual = self.all()
        return residual[int(np.argmin(np.abs(places - place).sum(axis=1)))]

    def best(self, count: int = 1) -> np.ndarray:
        """Return the places, 0 … 1 [-], of the best vectors, best first, shape (count, unknowns)."""
        places, residual = self.all()
        return places[np.argsort(self.score(residual), kind="stable")[:count]]


def sobol(unknowns: int, power: int, seed: int) -> np.ndarray:
    """Return 2^power scrambled Sobol points, 0 … 1 [-], shape (2^power, unknowns)."""
    return scipy.stats.qmc.Sobol(unknowns, rng=np.random.default_rng(seed)).random_base2(power)


def evolve(archive: Archive, population: np.ndarray, generations: int, seed: int) -> None:
    """Improve a population by differential evolution; everything looked at is in the archive.

    Parameters
    ----------
    archive : Archive
        Whose score is made small.
    population : ndarray
        Places 0 … 1 [-], shape (vectors, unknowns).
    generations : int
        How many, besides the first.
    seed : int
        Of everything random.
    """
    scipy.optimize.differential_evolution(
        lambda x: archive.score(archive(np.atleast_2d(x.T))),
        [(0.0, 1.0)] * population.shape[1],
        init=population,  # pyright: ignore[reportArgumentType]
        maxiter=generations,
        tol=0.0,
        mutation=(0.4, 0.9),
        recombination=0.8,
        polish=False,
        vectorized=True,
        updating="deferred",
        rng=np.random.default_rng(seed),
    )


class Slopes(NamedTuple):
    """Which residuals have an exact derivative, and that derivative.

    Attributes
    ----------
    places : ndarray
        Places of those residuals.
    function : callable
        From one vector's places, 0 … 1 [-], to their derivative [-]: change in tolerances per width of a bound, shape
        (residuals, unknowns).
    """

    places: np.ndarray
    function: Callable[[np.ndarray], np.ndarray]


def refine(archive: Archive, start: np.ndarray, exact: Slopes, most: int = 12) -> None:
    """Go downhill from a vector by least squares; everything looked at is in the archive.

    Parameters
    ----------
    archive : Archive
        Whose residuals are made small.
    start : ndarray
        Places 0 … 1 [-], shape (unknowns,).
    exact : Slopes
        Of the residuals that have an exact derivative.
    most : int
        How many vectors are looked at, at most, besides those of difference quotients.

    Notes
    -----
    Residuals of flights get difference quotients (all in one batch), those of the linear model their exact
    derivative. A trust region keeps the steps short where a flight's number is rough.
    """

    def jacobian(x: np.ndarray) -> np.ndarray:
        forward = np.where(x + STEP <= 1.0, STEP, -STEP)
        found = archive(np.concatenate([x[None], x + np.diag(forward)]))
        slope = ((found[1:] - found[0]) / forward[:, None]).T
        slope[exact.places] = exact.function(x)
        return slope

    scipy.optimize.least_squares(
        lambda x: archive(x[None])[0],
        np.clip(start, 1e-6, 1.0 - 1e-6),
        jac=jacobian,  # pyright: ignore[reportArgumentType]
        bounds=(0.0, 1.0),
        loss="soft_l1",
        max_nfev=most,
        xtol=1e-4,
    )


def spread(archive: Archive, rounds: int, size: int, seed: int) -> np.ndarray:
    """Return places of the set that fits within `NEARLY` of the best, spread evenly over it.

    Parameters
    ----------
    archive : Archive
        After a search; the walk starts at its members of the set.
    rounds, size : int
        Moves of each walker, and walkers. On an ellipsoid in eleven dimensions 18 moves of 64 walkers see 0.6 to 1.1 of
        its widths, 200 of 96 see 0.9 to 1.0.
    seed : int
        Of the random moves.

    Returns
    -------
    ndarray
        Places 0 … 1 [-], shape (members, unknowns); a member comes again where a walker stayed.

    Notes
    -----
    Each walker moves by γ(a − b) + ε with a, b other walkers (ter Braak 2006, differential-evolution Markov chain),
    reflected at the bounds, and stays, and counts again, where the move leaves the set: a walk that is uniform over the
    set. Where it finds a better vector, the set is drawn from that one. The first half of the walk is left out.
    """
    generator = np.random.default_rng(seed)
    places, residual = archive.all()
    value = archive.score(residual)
    inside = np.flatnonzero(value <= NEARLY * value.min())
    chosen = generator.choice(inside, size, replace=len(inside) < size)
    walkers, level = places[chosen], value[chosen]
    scale = 2.38 / np.sqrt(2.0 * places.shape[1])
    kept = []
    for _ in range(rounds):
        first, second = (generator.permutation(size) for _ in range(2))
        step = scale * generator.uniform(0.2, 1.0, (size, 1)) * (walkers[first] - walkers[second])
        moved = walkers + step + generator.normal(0.0, 3e-3, walkers.shape)
        trial = 1.0 - np.abs(1.0 - np.mod(moved, 2.0))  # reflected at 0 and 1
        found = archive.score(archive(trial))
        accepted = found <= NEARLY * archive.least
        walkers, level = np.where(accepted[:, None], trial, walkers), np.where(accepted, found, level)
        kept.append((walkers, level))
    half = kept[len(kept) // 2 :]
    places, value = np.concatenate([k[0] for k in half]), np.concatenate([k[1] for k in half])
    return places[value <= NEARLY * archive.least]
