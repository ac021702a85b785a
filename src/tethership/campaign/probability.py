"""Probabilities of exceeding a limit, with their confidence intervals. Depends on: scipy.

Independent draws have the exact interval of Clopper and Pearson (1934). Points of a Sobol sequence or a Latin hypercube
are not independent: there the interval is that of Student from the means of independent scrambles.
"""

from typing import NamedTuple

import numpy as np
import scipy.special
import scipy.stats


class Estimate(NamedTuple):
    """A probability.

    Attributes
    ----------
    exceeding, flights : int
        Flights that exceed, and all.
    probability : float
        Share that exceeds [-].
    low, high : float or None
        Ends of the interval [-]; None where the sampling gives none.
    confidence : float
        Of the interval [-].
    method : str
        How the interval comes about.
    """

    exceeding: int
    flights: int
    probability: float
    low: float | None
    high: float | None
    confidence: float
    method: str


def estimate(exceeded: np.ndarray, sampling: str, replicate: np.ndarray, confidence: float = 0.95) -> Estimate:
    """Return the probability that a limit is exceeded.

    Parameters
    ----------
    exceeded : ndarray
        Whether each flight exceeds it, shape (cases,).
    sampling : str
        As in `CampaignConfig`.
    replicate : ndarray
        Which scramble each case belongs to.
    confidence : float
        Of the interval, two-sided [-].
    """
    count, flights = int(np.sum(exceeded)), len(exceeded)
    share = count / flights
    if sampling == "random":
        low, high = clopper_pearson1934(count, flights, confidence)
        return Estimate(count, flights, share, low, high, confidence, "Clopper-Pearson")
    if sampling in ("sobol", "latin_hypercube"):
        low, high = _from_scrambles(exceeded, replicate, confidence)
        method = "scrambled replicates" if low is not None else "none: all scrambles agree; use random draws"
        return Estimate(count, flights, share, low, high, confidence, method)
    method = "none: share of the grid's points" if sampling == "grid" else f"none: sampling {sampling}"
    return Estimate(count, flights, share, None, None, confidence, method)


def clopper_pearson1934(count: int, flights: int, confidence: float = 0.95) -> tuple[float, float]:
    """Return the exact two-sided interval of a binomial share [-], for a confidence [-]."""
    low, high = clopper_pearson_ends(np.array(count), np.array(flights), confidence)
    return float(low), float(high)


def clopper_pearson_ends(count: np.ndarray, flights: np.ndarray, confidence: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the ends of many such intervals at once [-], each of the shape of the counts.

    Notes
    -----
    They are quantiles of the beta distribution: of k in n the lower that of B(k, n − k + 1), the upper of
    B(k + 1, n − k).
    """
    outside, rest = 0.5 - 0.5 * confidence, flights - count
    low = scipy.special.betaincinv(np.maximum(count, 1), rest + 1, outside)
    high = scipy.special.betaincinv(count + 1, np.maximum(rest, 1), 1.0 - outside)
    return np.where(count == 0, 0.0, low), np.where(rest == 0, 1.0, high)


def _from_scrambles(
    exceeded: np.ndarray, replicate: np.ndarray, confidence: float
) -> tuple[float | None, float | None]:
    """Return Student's interval of the scrambles' shares, clipped to 0 … 1; None where they are all the same."""
    shares = np.array([np.mean(exceeded[replicate == r]) for r in np.unique(replicate)])
    spread = float(np.std(shares, ddof=1)) if len(shares) > 1 else 0.0
    if spread == 0.0:
        return None, None
    reach = float(scipy.stats.t.ppf(0.5 + 0.5 * confidence, len(shares) - 1)) * spread / np.sqrt(len(shares))
    middle = float(np.mean(shares))
    return max(middle - reach, 0.0), min(middle + reach, 1.0)


def running(exceeded: np.ndarray, confidence: float = 0.95, points: int = 60) -> dict[str, np.ndarray]:
    """Return how a probability and its exact interval settle with the number of independent flights.

    Parameters
    ----------
    exceeded : ndarray of bool
        Whether each flight exceeds the limit, in the order in which they were drawn.
    confidence : float
        Of the interval, two-sided [-].
    points : int
        How many numbers of flights, at most, evenly spread in their logarithm.

    Returns
    -------
    dict
        `flights`; `probability`, `low`, `high` [-]; each of shape (points,) at most.
    """
    flights = np.unique(np.geomspace(min(10, len(exceeded)), len(exceeded), points).astype(int))
    counts = np.cumsum(exceeded)[flights - 1]
    low, high = clopper_pearson_ends(counts, flights, confidence)
    return {"flights": flights, "probability": counts / flights, "low": low, "high": high}
