"""Extreme values of a peak: a generalised Pareto tail over a threshold. Depends on: scipy.

References
----------
Coles, *An Introduction to Statistical Modeling of Extreme Values* (2001), chapter 4: of the flights whose peak is
above u the excess is distributed as 1 − (1 + ξ y/σ)^(−1/ξ); the level exceeded with probability p is
u + (σ/ξ)((ζ_u/p)^ξ − 1), ζ_u being the share above u.
"""

from typing import Any, NamedTuple

import numpy as np
import scipy.stats

SHARE = 0.1
"""Share of the flights above the threshold."""

FEWEST = 30
"""Fewest excesses of which a tail is fitted."""

DRAWS = 200
"""Bootstrap samples of the uncertainty."""


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
    excesses : int
        Flights above u.
    distance : float
        Largest distance of fitted and empirical distribution (Kolmogorov) [-].
    """

    threshold: float
    share: float
    shape: float
    scale: float
    shapes: np.ndarray
    scales: np.ndarray
    shares: np.ndarray
    excesses: int
    distance: float

    def level(self, probability: float, confidence: float = 0.95) -> tuple[float, float, float]:
        """Return the level exceeded with a probability [-] per flight, and the ends of its bootstrap interval."""
        best = _level(self.threshold, self.share, self.shape, self.scale, probability)
        drawn = _level(self.threshold, self.shares, self.shapes, self.scales, probability)
        low, high = np.quantile(drawn, [0.5 - 0.5 * confidence, 0.5 + 0.5 * confidence])
        return float(best), float(low), float(high)

    @property
    def end(self) -> float | None:
        """Where the tail ends, u − σ/ξ, None if it does not."""
        return self.threshold - self.scale / self.shape if self.shape < 0 else None


def _level(threshold: float, share: Any, shape: Any, scale: Any, probability: float) -> np.ndarray:
    """Return u + (σ/ξ)((ζ/p)^ξ − 1), by its limit σ ln(ζ/p) where ξ is next to nothing."""
    logarithm = np.log(np.maximum(share, 1e-300) / probability)
    flat = np.abs(shape) < 1e-8
    safe = np.where(flat, 1.0, shape)
    return threshold + scale * np.where(flat, logarithm, np.expm1(safe * logarithm) / safe)


def fit_tail(values: np.ndarray, seed: int = 1, share: float = SHARE, draws: int = DRAWS) -> Tail | None:
    """Fit a generalised Pareto tail to the largest values of independent flights, None where there are too few.

    Parameters
    ----------
    values : ndarray
        One peak of each flight.
    seed : int
        Of the bootstrap.
    share : float
        Of the flights that lie above the threshold.
    draws : int
        Bootstrap samples.
    """
    finite = values[np.isfinite(values)]
    if len(finite) * share < FEWEST:
        return None
    threshold = float(np.quantile(finite, 1.0 - share))
    excess = finite[finite > threshold] - threshold
    if len(excess) < FEWEST or np.ptp(excess) == 0.0:
        return None
    shape, _, scale = scipy.stats.genpareto.fit(excess, floc=0.0)
    generator = np.random.default_rng(seed)
    drawn = []
    for _ in range(draws):
        sample = generator.choice(finite, len(finite))
        own = sample[sample > threshold] - threshold
        fitted = scipy.stats.genpareto.fit(own, floc=0.0) if len(own) > 5 else (shape, 0.0, scale)
        drawn.append((fitted[0], fitted[2], len(own) / len(sample)))
    shapes, scales, shares = np.array(drawn).T
    distance = scipy.stats.kstest(excess, "genpareto", args=(shape, 0.0, scale)).statistic
    return Tail(
        threshold,
        len(excess) / len(finite),
        float(shape),
        float(scale),
        shapes,
        scales,
        shares,
        len(excess),
        float(distance),
    )
