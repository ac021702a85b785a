"""Fewer samples of a flight for the browser, with its peaks, and numbers of four digits. Depends on: numpy."""

import itertools

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

DIGITS = 4
"""Significant digits."""


def evenly(time: Array, interval: float, most: int) -> NDArray[np.intp]:
    """Return the samples nearest to every multiple of an interval, and the last.

    Parameters
    ----------
    time : Array
        Rising [s], shape (n,).
    interval : float
        Doubled until at most so many multiples fit [s].
    most : int
        How many.
    """
    while (time[-1] - time[0]) / interval > most:
        interval *= 2.0
    wanted = np.arange(time[0], time[-1], interval)
    right = np.clip(np.searchsorted(time, wanted), 1, max(len(time) - 1, 1))
    left = right - 1
    right = np.minimum(right, len(time) - 1)
    nearest = np.where(wanted - time[left] <= time[right] - wanted, left, right)
    return np.unique(np.append(nearest, len(time) - 1)).astype(np.intp)


def with_peaks(values: Array, buckets: int) -> NDArray[np.intp]:
    """Return samples with the lowest and highest value of each of so many equal stretches, and both ends.

    Parameters
    ----------
    values : Array
        Any unit (tensions [N] of a replay), shape (n, series).
    buckets : int
        Stretches; with fewer samples than twice that, all are kept.
    """
    count = len(values)
    if count <= 2 * buckets:
        return np.arange(count)
    edges = np.linspace(0, count, buckets + 1).astype(int)
    kept = [np.array([0, count - 1])]
    for start, end in itertools.pairwise(edges.tolist()):
        part = values[start:end]
        kept += [start + part.argmin(axis=0), start + part.argmax(axis=0)]
    return np.unique(np.concatenate(kept)).astype(np.intp)


def listed(values: Array) -> list[float | None]:
    """Return numbers of four significant digits, None for what is not finite."""
    return [float(f"{value:.{DIGITS}g}") + 0.0 if np.isfinite(value) else None for value in np.asarray(values)]
