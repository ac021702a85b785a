"""Maximum likelihood of a generalised Pareto tail, of many weightings of the same excesses at once. Depends on: numpy.

References
----------
Grimshaw, Technometrics 35 (1993) 185: with θ = ξ/σ the likelihood has its maximum over σ in closed form. Censored
excesses enter by their probability of being larger: of m known excesses, S the sum of log(1 + θy) over all and S_u
over the known, σ(θ) = S/(θm), ξ = θσ, and log L = −m log σ − S_u − m is left to be maximised over θ alone.
"""

from typing import NamedTuple

import numpy as np

LEAST_SHAPE = -1.0
"""Below it the likelihood has no bound where the largest excess is known: it grows as the tail's end nears that [-]."""

PLACES = np.concatenate([np.geomspace(1e-9, 0.5, 60) - 1.0, np.linspace(-0.49, 0.5, 40), np.geomspace(0.51, 1e4, 60)])
"""θ times the largest excess, where the likelihood is looked at first [-]."""

ROUNDS = 60
"""Steps to a root at most; it takes about ten."""

CLOSE = 1e-12
"""Change of θ that is none [-]."""

BLOCK = 1_000_000
"""Numbers that are computed at once: memory stays small, whatever the number of flights."""


class Fits(NamedTuple):
    """Fitted tails, one for each weighting.

    Attributes
    ----------
    shapes : ndarray
        ξ [-].
    scales : ndarray
        σ, unit of the excesses.
    """

    shapes: np.ndarray
    scales: np.ndarray


def fit_pareto(excesses: np.ndarray, censored: np.ndarray, weights: np.ndarray) -> Fits:
    """Return the tails of largest likelihood.

    Parameters
    ----------
    excesses : ndarray
        Over the threshold, of one unit: tensions [N] in a campaign; shape (excesses,). A censored one below zero says
        nothing.
    censored : ndarray of bool
        Excesses that would have been larger, shape (excesses,).
    weights : ndarray
        How often each counts [-], as a bootstrap draws it, shape (fits, excesses); each row with known excesses.
    """
    heights, rows = np.maximum(excesses, 0.0), max(1, BLOCK // len(excesses))
    parts = [_fitted(_Counted.of(heights, censored, weights[i : i + rows])) for i in range(0, len(weights), rows)]
    return Fits(*(np.concatenate(column) for column in zip(*parts, strict=True)))


class _Counted(NamedTuple):
    """Excesses y and how often each weighting counts them.

    All and the known ones; m known ones; the largest; whether that is censored, so that the likelihood is bounded.
    """

    heights: np.ndarray
    weights: np.ndarray
    known: np.ndarray
    number: np.ndarray
    largest: np.ndarray
    bounded: np.ndarray

    @classmethod
    def of(cls, heights: np.ndarray, censored: np.ndarray, weights: np.ndarray) -> "_Counted":
        weights = weights.astype(float)
        known = weights * ~censored
        largest, own = (np.where(counted > 0, heights, 0.0).max(axis=1) for counted in (weights, known))
        return cls(heights, weights, known, known.sum(axis=1), largest, own < largest)


def _fitted(rows: _Counted) -> Fits:
    """Return the tail of largest likelihood of each row: the best of many places, then the root beside it."""
    best = _best_place(rows)
    left, place, right = (PLACES[np.clip(best + i, 0, len(PLACES) - 1)] / rows.largest for i in (-1, 0, 1))
    theta = _root(rows, left, place, right)
    grown = _grown(rows, theta)
    scale = np.einsum("ij,ij->i", rows.weights, np.log1p(grown)) / (theta * rows.number)
    return Fits(theta * scale, scale)


def _best_place(rows: _Counted) -> np.ndarray:
    """Return where in `PLACES` the likelihood is largest, shape (rows,).

    Rows with the same largest excess share their logarithms.
    """
    best = np.zeros(len(rows.number), int)
    for largest in np.unique(rows.largest):
        own = rows.largest == largest
        theta = PLACES / largest
        logarithms = np.log1p(theta[:, None] * np.minimum(rows.heights, largest)).T
        shape = rows.weights[own] @ logarithms / rows.number[own, None]
        value = -rows.number[own, None] * np.log(shape / theta) - rows.known[own] @ logarithms
        best[own] = np.argmax(np.where(rows.bounded[own, None] | (shape > LEAST_SHAPE), value, -np.inf), axis=1)
    return best


def _grown(rows: _Counted, theta: np.ndarray) -> np.ndarray:
    """Return θy of each row, zero where it has no such excess: its tail may end before that."""
    return np.where(rows.weights > 0, theta[:, None] * rows.heights, 0.0)


def _slope(rows: _Counted, theta: np.ndarray) -> np.ndarray:
    """Return d log L/dθ = m (1/θ − S′/S) − S_u′ at θ of shape (rows,), which is not zero."""
    grown = _grown(rows, theta)
    share = rows.heights / (1.0 + grown)
    whole = np.einsum("ij,ij->i", rows.weights, np.log1p(grown))
    slope = np.einsum("ij,ij->i", rows.weights, share)
    return rows.number * (1.0 / theta - slope / whole) - np.einsum("ij,ij->i", rows.known, share)


def _root(rows: _Counted, left: np.ndarray, place: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return where the slope falls through zero between two places (Illinois' rule), `place` where it does not."""
    low, high = _slope(rows, left), _slope(rows, right)
    falls = (low > 0.0) & (high < 0.0)
    for _ in range(ROUNDS):
        new = np.where(falls, right - high * (right - left) / np.where(falls, high - low, 1.0), place)
        new = np.where(new == 0.0, 1e-15 / rows.largest, new)
        value = _slope(rows, new)
        crossed = value * high < 0.0
        left, low = np.where(crossed, right, left), np.where(crossed, high, 0.5 * low)
        done = ~falls | (value == 0.0) | (np.abs(new - right) <= CLOSE * np.abs(new))
        place, right, high, falls = new, new, value, falls & ~done
        if done.all():
            break
    return place
