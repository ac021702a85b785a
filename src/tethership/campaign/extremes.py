"""Extreme values of a peak: a generalised Pareto tail over a threshold. Depends on: scipy, campaign.pareto.

References
----------
Coles, *An Introduction to Statistical Modeling of Extreme Values* (2001), chapter 4: of the flights whose peak is
above u the excess is distributed as 1 − (1 + ξ y/σ)^(−1/ξ); the level exceeded with probability p is
u + (σ/ξ)((ζ_u/p)^ξ − 1), ζ_u being the share above u.
"""

from typing import Any, NamedTuple

import numpy as np
import scipy.stats

from tethership.campaign.pareto import fit_pareto

SHARE = 0.1
"""Share of the flights above the threshold."""

FEWEST = 30
"""Fewest excesses of which a tail is fitted."""

DRAWS = 200
"""Bootstrap samples of the uncertainty."""


KOLMOGOROV = 1.36
"""Kolmogorov's distance times √n that a true distribution passes in 5 % of samples; fitted ones pass it more rarely."""


class Tail(NamedTuple):
    """A fitted tail.

    Attributes
    ----------
    threshold : float
        u, unit of the value.
    share : float
        ζ_u, share of flights above it [-].
    shape : float
        ξ [-]; below zero the tail has an end.
    scale : float
        σ, unit of the value.
    shapes, scales, shares : ndarray
        The same of each bootstrap sample, ξ [-], σ and ζ_u.
    excesses, censored : int
        Flights above u whose peak is known, and whose cable broke at it.
    distance : float
        Largest distance of fitted and empirical distribution of the known excesses (Kolmogorov) [-].
    """

    threshold: float
    share: float
    shape: float
    scale: float
    shapes: np.ndarray
    scales: np.ndarray
    shares: np.ndarray
    excesses: int
    censored: int
    distance: float

    @property
    def adequate(self) -> bool:
        """Whether the known excesses could be of the tail: Kolmogorov's distance [-] below its 5 % limit 1.36/√n."""
        return self.distance < KOLMOGOROV / np.sqrt(max(self.excesses, 1))

    def level(self, probability: float, confidence: float = 0.95) -> tuple[float, float, float]:
        """Return the level exceeded with a probability [-] per flight, and the ends of its bootstrap interval.

        All three in the unit of the values: [N] of peak tensions. `confidence` is of the interval, two-sided [-].
        """
        best = _level(self.threshold, self.share, self.shape, self.scale, probability)
        drawn = _level(self.threshold, self.shares, self.shapes, self.scales, probability)
        low, high = np.quantile(drawn, [0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence])
        return float(best), float(low), float(high)

    @property
    def end(self) -> float | None:
        """Where the tail ends, u − σ/ξ, in the unit of the values ([N] of tensions); None if it does not."""
        return self.threshold - self.scale / self.shape if self.shape < 0 else None


def _level(threshold: float, share: Any, shape: Any, scale: Any, probability: float) -> np.ndarray:
    """Return u + (σ/ξ)((ζ/p)^ξ − 1), by its limit σ ln(ζ/p) where ξ is next to nothing."""
    logarithm = np.log(np.maximum(share, 1e-300) / probability)
    flat = np.abs(shape) < 1e-8
    safe = np.where(flat, 1.0, shape)
    return threshold + scale * np.where(flat, logarithm, np.expm1(safe * logarithm) / safe)


def fit_tail(
    values: np.ndarray,
    censored: np.ndarray | None = None,
    seed: int = 1,
    share: float = SHARE,
    draws: int = DRAWS,
) -> Tail | None:
    """Fit a generalised Pareto tail to the largest values of independent flights, None where there are too few.

    Parameters
    ----------
    values : ndarray
        One peak of each flight, of one unit: tensions [N] in a campaign. Shape (flights,); what is not finite is left
        out.
    censored : ndarray of bool, optional
        Flights that ended at their peak (the cable broke): it would have been higher, nobody knows by how much.
    seed : int
        Of the bootstrap.
    share : float
        Of the flights that lie above the threshold and are not censored [-].
    draws : int
        Bootstrap samples.

    Notes
    -----
    Maximum likelihood; a censored flight contributes the probability of a larger excess.
    """
    kept = np.isfinite(values)
    over = np.zeros(len(values), bool) if censored is None else censored
    values, over = values[kept], over[kept]
    if len(values) == 0 or np.sum(~over) * share < FEWEST:
        return None
    threshold = float(np.quantile(np.where(over, np.inf, values), 1.0 - share - np.mean(over), method="lower"))
    place = np.flatnonzero((values > threshold) | over)
    excesses, broken = values[place] - threshold, over[place]
    weights = np.concatenate([np.ones((1, len(place)), np.int16), _drawn(len(values), place, draws, seed)])
    shapes, scales, shares = _fitted(excesses, broken, weights, len(values))
    if np.isnan(shapes[0]):
        return None
    whole = excesses[~broken]
    last = np.max(whole) if np.any(over) else np.inf
    shape, scale, lost = shapes[0], scales[0], np.isnan(shapes)
    shapes, scales, shares = (np.where(lost, of[0], of) for of in (shapes, scales, shares))
    inside = scipy.stats.genpareto.cdf(last, shape, 0.0, scale)
    distance = scipy.stats.kstest(whole, lambda x: scipy.stats.genpareto.cdf(x, shape, 0.0, scale) / inside).statistic
    return Tail(
        threshold,
        float(shares[0]),
        float(shape),
        float(scale),
        shapes[1:],
        scales[1:],
        shares[1:],
        len(whole),
        int(np.sum(over)),
        float(distance),
    )


def _drawn(flights: int, place: np.ndarray, draws: int, seed: int) -> np.ndarray:
    """Return how often the flights at `place` are in each bootstrap sample of all, shape (draws, places)."""
    generator = np.random.default_rng(seed)
    counts = np.empty((draws, len(place)), np.int16)
    for row in counts:
        row[:] = np.bincount(generator.integers(flights, size=flights), minlength=flights)[place]
    return counts


def _fitted(
    excesses: np.ndarray, broken: np.ndarray, weights: np.ndarray, flights: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return ξ, σ and the share above the threshold of each sample; ξ and σ are NaN where too few excesses are known.

    So they are where all are the same.
    """
    known = weights[:, ~broken] > 0
    heights = excesses[~broken]
    spread = np.where(known, heights, -np.inf).max(1, initial=-np.inf) > np.where(known, heights, np.inf).min(
        1, initial=np.inf
    )
    enough = spread & (weights[:, ~broken].sum(axis=1) >= 0.5 * FEWEST)
    shapes, scales = np.full((2, len(weights)), np.nan)
    if enough.any():
        shapes[enough], scales[enough] = fit_pareto(excesses, broken, weights[enough])
    return shapes, scales, weights.sum(axis=1) / flights
