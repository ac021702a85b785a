"""What happens to tracks along a path: coalescence, splits, crossings, passages of the imaginary axis.

Depends on: analysis.tracking.
"""

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tethership.analysis.spectrum import Complex
from tethership.analysis.tracking import pairs_of, partners_of


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
                share = start / (start - end) if start * end < 0 else 0.5
                yield step.event(kind, (i, j), before, share)


def _crossings(step: _Step) -> Iterator[Event]:
    """Yield where two real eigenvalues pass each other."""
    real = step.values.imag == 0
    for i, j in itertools.combinations(range(step.values.shape[1]), 2):
        apart = (step.values[:, i] - step.values[:, j]).real
        both = real[:, i] & real[:, j]
        for before in map(int, np.flatnonzero((apart[:-1] * apart[1:] < 0) & both[:-1] & both[1:])):
            yield step.event("cross", (i, j), before, apart[before] / (apart[before] - apart[before + 1]))


def _axis(step: _Step) -> Iterator[Event]:
    """Yield passages of the imaginary axis; of a pair only the upper member's."""
    for i in range(step.values.shape[1]):
        growth, upper = step.values[:, i].real, step.values[:, i].imag >= 0
        for before in map(int, np.flatnonzero((growth[:-1] * growth[1:] < 0) & upper[:-1] & upper[1:])):
            kind = "unstable" if growth[before + 1] > 0 else "stable"
            yield step.event(kind, (i,), before, growth[before] / (growth[before] - growth[before + 1]))
