"""Two laws on the same cases: what changing from one to the other does. Depends on: scipy."""

from typing import Any, NamedTuple

import numpy as np
import scipy.stats


class PairedMetric(NamedTuple):
    """A metric under two laws.

    Attributes
    ----------
    name : str
    first, second : float
        Means over the cases both flew, in the metric's unit (`campaign.store.UNITS`).
    difference, low, high : float
        Mean of second − first and its 95 % interval (Student, pairs), in the metric's unit.
    lower : float
        Share of cases in which the second law's is lower [-].
    p_value : float
        Wilcoxon's signed-rank test of no difference [-].
    cases : int
        Cases that both have.
    """

    name: str
    first: float
    second: float
    difference: float
    low: float
    high: float
    lower: float
    p_value: float
    cases: int


class PairedLimit(NamedTuple):
    """A limit under two laws.

    Attributes
    ----------
    name : str
    only_first, only_second, both : int
        Cases that exceed it under one law alone, and under both.
    p_value : float
        Exact McNemar test of equal probability [-].
    """

    name: str
    only_first: int
    only_second: int
    both: int
    p_value: float


def paired_metric(name: str, first: np.ndarray, second: np.ndarray) -> PairedMetric | None:
    """Return a metric compared case by case, None where fewer than three cases have it under both laws.

    Parameters
    ----------
    name : str
        Of the metric, e.g. `tension_max`.
    first, second : ndarray
        Its values under each law, of one unit ([N] of a tension, [s] of a time), shape (cases,); what is not finite is
        left out.
    """
    both = np.isfinite(first) & np.isfinite(second)
    if np.sum(both) < 3:
        return None
    change = second[both] - first[both]
    mean, error = float(np.mean(change)), float(scipy.stats.sem(change))
    reach = float(scipy.stats.t.ppf(0.975, len(change) - 1)) * error
    tested: Any = scipy.stats.wilcoxon(change) if np.any(change) else None
    p_value = 1.0 if tested is None else float(tested.pvalue)
    lower = float(np.mean(change < 0))
    return PairedMetric(
        name,
        float(np.mean(first[both])),
        float(np.mean(second[both])),
        mean,
        mean - reach,
        mean + reach,
        lower,
        p_value,
        len(change),
    )


def paired_limit(name: str, first: np.ndarray, second: np.ndarray) -> PairedLimit:
    """Return a limit compared case by case, for whether each case exceeds it under each law."""
    only_first, only_second = int(np.sum(first & ~second)), int(np.sum(second & ~first))
    discordant = only_first + only_second
    p_value = 1.0 if discordant == 0 else float(scipy.stats.binomtest(only_first, discordant).pvalue)
    return PairedLimit(name, only_first, only_second, int(np.sum(first & second)), p_value)
