"""Following eigenvalues along a path of points by the likeness of their eigenvectors. Depends on: numpy, scipy."""

from typing import NamedTuple

import numpy as np
import scipy.optimize

from tethership.analysis.mode_names import Slot, assign, conjugates
from tethership.analysis.spectrum import NULL


class Path(NamedTuple):
    """Eigenvalues and eigenvectors of points in a row, comparable coordinates.

    Attributes
    ----------
    values : ndarray
        λ [1/s], complex, shape (points, n); null ones are exactly zero.
    vectors : ndarray
        Right eigenvectors as columns, of unit length, shape (points, n, n).
    valid : ndarray of bool
        Points that have them.
    """

    values: np.ndarray
    vectors: np.ndarray
    valid: np.ndarray


def eigen_path(matrices: np.ndarray, valid: np.ndarray) -> Path:
    """Return the path of many matrices [1/s] in comparable coordinates, shape (points, n, n)."""
    safe = np.where(valid[:, None, None], matrices, 0.0)
    values, vectors = np.linalg.eig(safe)
    size = np.abs(values).max(axis=1, keepdims=True)
    values = np.where(np.abs(values) < NULL * size, 0.0, values).astype(complex)
    return Path(values, vectors.astype(complex), valid)


def participation(vectors: np.ndarray) -> np.ndarray:
    """Return |w_k v_k| of one point's eigenvectors (columns) [-]; a singular matrix is taken by least squares."""
    try:
        left = np.linalg.inv(vectors)
    except np.linalg.LinAlgError:
        left = np.linalg.pinv(vectors)
    return np.abs(left.T * vectors)


def named_order(path: Path, index: int, states: tuple[str, ...]) -> np.ndarray:
    """Return the place of each slot's eigenvalue at a point, by names."""
    values = path.values[index]
    chosen = assign(participation(path.vectors[index]), states, conjugates(values))
    order = np.argsort(chosen)
    return _upper_first(values, order)


def _upper_first(values: np.ndarray, order: np.ndarray) -> np.ndarray:
    """Return the order with the upper member of each pair in the earlier slot."""
    order = order.copy()
    for first in range(len(order)):
        for second in range(first + 1, len(order)):
            a, b = values[order[first]], values[order[second]]
            if a.imag < 0 and a == b.conjugate():
                order[first], order[second] = order[second], order[first]
    return order


def matched(path: Path, before: int, after: int, order: np.ndarray) -> np.ndarray:
    """Return the order of the eigenvalues at a point `after` that continues the one at `before`.

    Notes
    -----
    Cost of a pair: one less |v₁ᴴv₂|², plus the relative distance of the eigenvalues.
    """
    first = path.vectors[before][:, order]
    old, new = path.values[before][order], path.values[after]
    likeness = np.abs(first.conj().T @ path.vectors[after]) ** 2
    reach = np.abs(old)[:, None] + np.abs(new)[None, :] + 1e-3 * np.abs(new).max()
    cost = 1.0 - likeness + np.abs(old[:, None] - new[None, :]) / reach
    row = np.argmin(cost, axis=1)
    if len(set(row.tolist())) == len(row):
        return row
    return scipy.optimize.linear_sum_assignment(cost)[1]


def follow(path: Path, start: int, order: np.ndarray, states: tuple[str, ...], slots: list[Slot]) -> np.ndarray:
    """Return the place of each track's eigenvalue at every point, shape (points, n).

    Parameters
    ----------
    path : Path
        Points close enough that eigenvectors change little.
    start : int
        A valid point.
    order : ndarray of int
        Place of each track's eigenvalue there.
    states : tuple of str
        Names of the states.
    slots : list of Slot
        What each track is called; settles which is which where a pair breaks into two real eigenvalues.
    """
    orders = np.tile(order, (len(path.values), 1))
    for direction in (range(start + 1, len(path.values)), range(start - 1, -1, -1)):
        before, here = start, order
        for after in direction:
            if path.valid[after]:
                here = _settled(path, before, after, here, matched(path, before, after, here), states, slots)
                before = after
            orders[after] = here
    return orders


def _settled(
    path: Path,
    before: int,
    after: int,
    old: np.ndarray,
    new: np.ndarray,
    states: tuple[str, ...],
    slots: list[Slot],
) -> np.ndarray:
    """Return the order with upper members first, and tracks of a pair that breaks told apart by their slots."""
    new = _upper_first(path.values[after], new)
    was, now = path.values[before][old], path.values[after][new]
    broken = [(i, j) for i, j in pairs_of(was) if now[i].imag == 0 and now[j].imag == 0]
    if not broken:
        return new
    share = participation(path.vectors[after])[:, new]
    for i, j in broken:
        straight = _fit(slots[i], share[:, i], states) + _fit(slots[j], share[:, j], states)
        swapped = _fit(slots[i], share[:, j], states) + _fit(slots[j], share[:, i], states)
        if swapped > straight + 1e-9 or (abs(swapped - straight) <= 1e-9 and abs(now[j]) > abs(now[i])):
            new[i], new[j] = new[j], new[i]
            share[:, [i, j]] = share[:, [j, i]]
    return new


def _fit(slot: Slot, share: np.ndarray, states: tuple[str, ...]) -> float:
    """Return how well a participation fits a slot [-]."""
    weights = np.array([slot.signature.get(state, 0.0) for state in states])
    return float(weights @ share / max(share.sum(), 1e-300))


def pairs_of(values: np.ndarray) -> set[tuple[int, int]]:
    """Return the pairs of tracks that are conjugates."""
    upper = np.flatnonzero(values.imag > 0)
    found = set()
    for i in upper:
        j = int(np.argmin(np.abs(values - values[i].conjugate())))
        found.add((min(int(i), j), max(int(i), j)))
    return found


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


def find_events(values: np.ndarray, valid: np.ndarray, tracks: list[str]) -> list[Event]:
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
    Where two meet, the square of their difference goes through zero on a straight line: the place is interpolated on it.
    """
    events: list[Event] = []
    points = np.flatnonzero(valid)
    for before, after in zip(points[:-1], points[1:], strict=True):
        step = (before, after, values[before], values[after])
        events += _meetings(*step, tracks) + _crossings(*step, tracks) + _axis(*step, tracks)
    return sorted(events, key=lambda event: event.position)


def _meetings(before: int, after: int, old: np.ndarray, new: np.ndarray, tracks: list[str]) -> list[Event]:
    first, second = pairs_of(old), pairs_of(new)
    events = []
    for kind, pairs in (("split", first - second), ("coalesce", second - first)):
        for i, j in sorted(pairs):
            start, end = ((old[i] - old[j]) ** 2).real, ((new[i] - new[j]) ** 2).real
            share = start / (start - end) if start * end < 0 else 0.5
            mean = 0.5 * ((1 - share) * (old[i] + old[j]) + share * (new[i] + new[j]))
            position = before + share * (after - before)
            events.append(Event(kind, (tracks[i], tracks[j]), float(position), complex(mean.real)))
    return events


def _crossings(before: int, after: int, old: np.ndarray, new: np.ndarray, tracks: list[str]) -> list[Event]:
    real = np.flatnonzero((old.imag == 0) & (new.imag == 0))
    events = []
    for a, i in enumerate(real):
        for j in real[a + 1 :]:
            start, end = (old[i] - old[j]).real, (new[i] - new[j]).real
            if start * end < 0:
                share = start / (start - end)
                value = (1 - share) * old[i] + share * new[i]
                position = before + share * (after - before)
                events.append(Event("cross", (tracks[i], tracks[j]), float(position), complex(value)))
    return events


def _axis(before: int, after: int, old: np.ndarray, new: np.ndarray, tracks: list[str]) -> list[Event]:
    """Return passages of the imaginary axis; of a pair only the upper member's."""
    events = []
    for i in np.flatnonzero((old.real * new.real < 0) & (old.imag >= 0) & (new.imag >= 0)):
        share = old[i].real / (old[i].real - new[i].real)
        value = (1 - share) * old[i] + share * new[i]
        kind = "unstable" if new[i].real > 0 else "stable"
        events.append(Event(kind, (tracks[i],), float(before + share * (after - before)), complex(value)))
    return events
