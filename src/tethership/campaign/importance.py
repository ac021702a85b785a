"""Which of the varied quantities a peak hangs on: rank correlation, and Sobol's indices. Depends on: scipy.

References
----------
Saltelli et al., Computer Physics Communications 181 (2010) 259: first-order and total indices from the points A,
B and A with one column of B (`sampling.saltelli_design`), as scipy computes them.
"""

import warnings
from typing import Any, NamedTuple

import numpy as np
import scipy.stats


class Importance(NamedTuple):
    """How much one quantity matters.

    Attributes
    ----------
    name : str
        Dotted name.
    rank_correlation : float
        Spearman's ρ with the output [-].
    p_value : float
        Probability of a ρ as far from zero were there none [-].
    first, first_low, first_high : float or None
        Sobol's first-order index and its 95 % bootstrap interval [-]; None without the design.
    total, total_low, total_high : float or None
        Sobol's total index and its interval [-].
    """

    name: str
    rank_correlation: float
    p_value: float
    first: float | None = None
    first_low: float | None = None
    first_high: float | None = None
    total: float | None = None
    total_low: float | None = None
    total_high: float | None = None


def rank_importance(names: tuple[str, ...], values: np.ndarray, output: np.ndarray) -> list[Importance]:
    """Return the rank correlation of each quantity with an output, strongest first.

    Parameters
    ----------
    names : tuple of str
        Quantities.
    values : ndarray
        [SI], shape (cases, names).
    output : ndarray
        One number of each case, any unit (a peak tension [N]), shape (cases,); what is not finite is left out.
    """
    finite = np.isfinite(output)
    found = []
    for i, name in enumerate(names):
        column = values[finite, i]
        if len(column) < 4 or np.ptp(column) == 0 or np.ptp(output[finite]) == 0:
            found.append(Importance(name, 0.0, 1.0))
            continue
        result: Any = scipy.stats.spearmanr(column, output[finite])
        found.append(Importance(name, float(result.statistic), float(result.pvalue)))
    return sorted(found, key=lambda entry: -abs(entry.rank_correlation))


def sobol_importance(names: tuple[str, ...], values: np.ndarray, output: np.ndarray, seed: int = 1) -> list[Importance]:
    """Return Sobol's indices of each quantity for an output over the points of `saltelli_design`, largest total first.

    Parameters
    ----------
    names : tuple of str
        Quantities d.
    values : ndarray
        [SI], shape (n(d + 2), d).
    output : ndarray
        One number of each point, any unit (a peak tension [N]), shape (n(d + 2),); a point without takes the median, so
        that the design stays whole.
    seed : int
        Of the bootstrap.
    """
    size = len(names)
    blocks = np.where(np.isfinite(output), output, np.nanmedian(output)).reshape(size + 2, -1)
    evaluated = {"f_A": blocks[:1], "f_B": blocks[1:2], "f_AB": blocks[2:, None, :]}
    if np.ptp(blocks) == 0.0:
        return list(rank_importance(names, values, output))
    indices: Any = scipy.stats.sobol_indices(func=evaluated, n=blocks.shape[1], rng=np.random.default_rng(seed))
    with warnings.catch_warnings():  # resamples without variance: their ends are NaN
        warnings.simplefilter("ignore", RuntimeWarning)
        ends = indices.bootstrap(confidence_level=0.95)
    ranks = {entry.name: entry for entry in rank_importance(names, values, output)}
    found = [
        ranks[name]._replace(
            first=float(np.ravel(indices.first_order)[i]),
            first_low=float(np.ravel(ends.first_order.confidence_interval.low)[i]),
            first_high=float(np.ravel(ends.first_order.confidence_interval.high)[i]),
            total=float(np.ravel(indices.total_order)[i]),
            total_low=float(np.ravel(ends.total_order.confidence_interval.low)[i]),
            total_high=float(np.ravel(ends.total_order.confidence_interval.high)[i]),
        )
        for i, name in enumerate(names)
    ]
    return sorted(found, key=lambda entry: -(entry.total or 0.0))
