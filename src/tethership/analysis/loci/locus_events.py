"""What happens to tracks along a path: coalescence, splits, crossings, passages of the imaginary axis.

Depends on: analysis.loci.tracking.
"""

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tethership.analysis.loci.tracking import pairs_of, partners_of
from tethership.analysis.modes.spectrum import NULL, Complex, Real


class Event(NamedTuple):
    """Something that happens to tracks along a path.

    Attributes
    ----------
    kind : str
        `coalesce` (two real eigenvalues become a pair), `split` (the reverse), `cross` (two real ones pass each other),
        `unstable` or `stable` (one passes the imaginary axis).
    tracks : tuple of str
        Whose.
    position : float
        Where on the path, in points from its start.
    eigenvalue : complex
        λ there [1/s].
    """

    kind: str
    tracks: tuple[str, ...]
    position: float
    eigenvalue: complex


def find_events(values: Complex, valid: np.ndarray, tracks: list[str]) -> list[Event]:
    """Return what happens along a path.

    Parameters
    ----------
    values : ndarray
        λ of every track [1/s], shape (points, tracks).
    valid : ndarray of bool
        Points that have them.
    tracks : list of str
        Names.

    Notes
    -----
    Where two meet, the square of their difference goes through zero on a straight line: the place is interpolated.
    """
    points = np.flatnonzero(valid)
    if len(points) < 2:
        return []
    kept = values[points]
    step = _Step(points, kept, partners_of(kept), tracks)
    events = [*_meetings(step), *_crossings(step), *_axis(step)]
    return sorted(events, key=lambda event: event.position)


def unstable_throughout(values: Complex, valid: np.ndarray) -> np.ndarray:
    """Return which tracks grow at every point that has them: no event tells of these.

    Parameters
    ----------
    values : ndarray
        λ of every track [1/s], shape (points, tracks).
    valid : ndarray of bool
        Points that have them.

    Returns
    -------
    ndarray of bool
        Shape (tracks,); none where there is no valid point.
    """
    kept = values[valid]
    return np.all(kept.real > _rounding(kept)[:, None], axis=0) & bool(len(kept))


def _rounding(values: Complex) -> Real:
    """Return below which growth [1/s] a real part is rounding, for each point."""
    return NULL * np.abs(values).max(axis=1, initial=0.0)


class _Step(NamedTuple):
    """Valid points in a row, their eigenvalues by track, the conjugates' tracks, and the tracks' names."""

    points: np.ndarray
    values: Complex
    partners: np.ndarray
    tracks: list[str]

    def event(self, kind: str, tracks: tuple[int, ...], before: int, share: float) -> Event:
        """Return an event at a share of the way from one valid point to the next, at the tracks' mean eigenvalue."""
        first, last = self.values[before, list(tracks)].mean(), self.values[before + 1, list(tracks)].mean()
        position = self.points[before] + share * (self.points[before + 1] - self.points[before])
        value = complex((1.0 - share) * first + share * last)
        if kind in ("split", "coalesce"):
            value = complex(value.real)  # two that meet do so on the real axis
        return Event(kind, tuple(self.tracks[i] for i in tracks), float(position), value)


def _meetings(step: _Step) -> Iterator[Event]:
    """Yield where pairs come to be or break."""
    changed = np.flatnonzero((step.partners[:-1] != step.partners[1:]).any(axis=1))
    for before in map(int, changed):
        first, second = pairs_of(step.partners[before]), pairs_of(step.partners[before + 1])
        old, new = step.values[before], step.values[before + 1]
        for kind, pairs in (("split", first - second), ("coalesce", second - first)):
            for i, j in sorted(pairs):
                start, end = ((old[i] - old[j]) ** 2).real, ((new[i] - new[j]) ** 2).real
                share = start / (start - end) if start * end <= 0 and start != end else 0.5
                yield step.event(kind, (i, j), before, share)


def _crossings(step: _Step) -> Iterator[Event]:
    """Yield where two real eigenvalues pass each other."""
    real, null = step.values.imag == 0, step.values == 0
    for i, j in itertools.combinations(range(step.values.shape[1]), 2):
        apart = (step.values[:, i] - step.values[:, j]).real
        both = real[:, i] & real[:, j]
        for before, after in _sign_changes(apart):
            stands = null[[before, after]].all(axis=0)  # what passes zero passes every null mode: told by _axis once
            if both[before : after + 1].all() and not (stands[i] or stands[j]):
                place, share = _zero(apart, before, after)
                yield step.event("cross", (i, j), place, share)


def _axis(step: _Step) -> Iterator[Event]:
    """Yield passages of the imaginary axis; of a pair only the upper member's."""
    rounding = _rounding(step.values)
    for i in range(step.values.shape[1]):
        growth, upper = step.values[:, i].real, step.values[:, i].imag >= 0
        growth = np.where(np.abs(growth) < rounding, 0.0, growth)  # undamped in still air: a sign of 1e-33 is none
        for before, after in _sign_changes(growth):
            if upper[before : after + 1].all():
                place, share = _zero(growth, before, after)
                yield step.event("unstable" if growth[after] > 0 else "stable", (i,), place, share)


def _sign_changes(values: Real) -> Iterator[tuple[int, int]]:
    """Yield points between which a number changes its sign; zeros between them may be passed."""
    nonzero = np.flatnonzero(values)
    for before, after in itertools.pairwise(nonzero):
        if values[before] * values[after] < 0:
            yield int(before), int(after)


def _zero(values: Real, before: int, after: int) -> tuple[int, float]:
    """Return the point from which, and the share of the way at which, a number that changes its sign is zero."""
    if after > before + 1:
        return before + (after - before) // 2 - 1, 1.0
    return before, float(values[before] / (values[before] - values[after]))
