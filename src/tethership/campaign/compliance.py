"""Requirements and their verdicts: what the flights allow to be said, and what they do not. Depends on: campaign.

A verdict is conditional on the model, the distributions and the fixed steps; none of them is in its interval.
"""

import math
from typing import Any

import numpy as np

from tethership.campaign.probability import Estimate, estimate
from tethership.campaign.schema import Requirement

MOST_FAILED = 0.05
"""Share of flights without a result beyond which no verdict is given [-]: it would be about the model."""

FEWEST_EVENTS = 5
"""Fewest flights of each scramble on either side of a limit for Student's interval to be trusted: below, it is too
short (of 1 024 Sobol points with 3.5 events expected it misses upwards in 7 % of cases instead of 2.5 %)."""


def least_flights(allowed: float, confidence: float) -> int:
    """Return the fewest independent flights, none exceeding, whose interval lies at or below a probability.

    Parameters
    ----------
    allowed : float
        Probability [-].
    confidence : float
        Of the two-sided interval [-].

    Examples
    --------
    >>> least_flights(0.005, 0.95)
    736
    """
    return math.ceil(math.log(0.5 - 0.5 * confidence) / math.log1p(-allowed))


def judge(
    requirement: Requirement,
    exceeded: np.ndarray,
    undetermined: np.ndarray,
    failed: np.ndarray,
    sampling: str,
    replicate: np.ndarray,
) -> dict[str, Any]:
    """Return a requirement's numbers and verdict.

    Parameters
    ----------
    requirement : Requirement
        What is asked.
    exceeded, undetermined, failed : ndarray of bool
        Flights that exceed the limit; that ended early without; that have no result. Shape (cases,).
    sampling : str
        As in `CampaignConfig`.
    replicate : ndarray
        Scramble of each case, shape (cases,).

    Returns
    -------
    dict
        `allowed`, `probability`, `low`, `high` and `confidence` [-], numbers of flights, `verdict` and `reason`.

    Notes
    -----
    *Met*: the whole interval is at or below what is allowed, flights that ended early being counted as exceeding.
    *Not met*: the whole interval is above it, they being counted as not exceeding. Else *undecided*. *No verdict*
    where the sampling gives no interval to trust or too many flights have no result; `reason` says which.
    """
    confidence, allowed = requirement.confidence, requirement.probability
    least = estimate(exceeded, sampling, replicate, confidence)
    most = estimate(exceeded | undetermined, sampling, replicate, confidence)
    reason = _reason(least, sampling, int(failed.sum()), replicate)
    verdict = "no verdict" if reason else "undecided"
    if not reason and most.high is not None and most.high <= allowed:
        verdict = "met"
    elif not reason and least.low is not None and least.low > allowed:
        verdict = "not met"
    return {
        "requirement": requirement.text or f"{requirement.limit} in at most {100.0 * allowed:g} % of flights",
        "limit": requirement.limit,
        "allowed": allowed,
        "exceeding": least.exceeding,
        "undetermined": int(undetermined.sum()),
        "failed": int(failed.sum()),
        "flights": least.flights,
        "probability": least.probability,
        "low": least.low,
        "high": most.high,
        "confidence": confidence,
        "least_flights": least_flights(allowed, confidence),
        "verdict": verdict,
        "reason": reason,
    }


def _reason(found: Estimate, sampling: str, failed: int, replicate: np.ndarray) -> str:
    """Return why there can be no verdict, or nothing."""
    if failed > MOST_FAILED * found.flights:
        return f"{failed} of {found.flights} flights have no result"
    if found.low is None:
        return f"sampling {sampling} gives no interval"
    fewest = FEWEST_EVENTS * len(np.unique(replicate))
    if sampling != "random" and not fewest <= found.exceeding <= found.flights - fewest:
        return f"too rare for sampling {sampling}: it needs {fewest} flights on either side; use random"
    return ""
