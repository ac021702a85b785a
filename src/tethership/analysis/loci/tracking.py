"""Following eigenvalues along a path of points by the likeness of their eigenvectors. Depends on: numpy, scipy."""

from typing import NamedTuple

import numpy as np
import scipy.optimize

from tethership.analysis.modes.names import Slot, assign
from tethership.analysis.modes.spectrum import NULL, Complex, Real


class Path(NamedTuple):
    """Eigenvalues and eigenvectors of points in a row, comparable coordinates.

    Attributes
    ----------
    values : ndarray
        λ [1/s], complex, shape (points, n); null ones are exactly zero.
    vectors : ndarray
        Right eigenvectors as columns, of unit length, shape (points, n, n).
    left : ndarray
        Left eigenvectors as rows, the inverse of `vectors`, shape (points, n, n).
    partners : ndarray of int
        Place of each eigenvalue's conjugate, its own where it is real, shape (points, n).
    valid : ndarray of bool
        Points that have them.
    """

    values: Complex
    vectors: Complex
    left: Complex
    partners: np.ndarray
    valid: np.ndarray

    def part(self, rows: slice) -> "Path":
        """Return some of the points."""
        return Path(*(array[rows] for array in self))


def eigen_path(matrices: np.ndarray, valid: np.ndarray) -> Path:
    """Return the path of many matrices [1/s] in comparable coordinates, shape (points, n, n)."""
    safe = np.where(valid[:, None, None], matrices, 0.0)
    values, vectors = np.linalg.eig(safe)
    size = np.abs(values).max(axis=1, keepdims=True)
    values = np.where(np.abs(values) < NULL * size, 0.0, values).astype(complex)
    return Path(values, vectors.astype(complex), _inverses(vectors.astype(complex)), partners_of(values), valid)


def _inverses(vectors: Complex) -> Complex:
    """Return the inverses of many matrices; a singular one (a defective eigenvalue) is taken by least squares."""
    try:
        return np.asarray(np.linalg.inv(vectors), dtype=np.complex128)
    except np.linalg.LinAlgError:
        return np.stack([np.linalg.pinv(matrix) for matrix in vectors])


def partners_of(values: Complex) -> np.ndarray:
    """Return the place of each eigenvalue's conjugate; its own where it is real.

    Parameters
    ----------
    values : ndarray
        λ [1/s], complex, the eigenvalues along the last axis.
    """
    distance = np.abs(values[..., :, None] - values[..., None, :].conj())
    return np.where(values.imag == 0.0, np.arange(values.shape[-1]), np.argmin(distance, axis=-1))


def participation(path: Path, index: int) -> Real:
    """Return |w_k v_k| of a point [-]: states as rows, eigenvalues as columns."""
    return np.abs(path.left[index].T * path.vectors[index])


def named_order(path: Path, index: int, states: tuple[str, ...]) -> np.ndarray:
    """Return the place of each slot's eigenvalue at a point, by participation [-]; shape (n,)."""
    chosen = assign(participation(path, index), states, path.partners[index])
    return _upper_first(path, index, np.argsort(chosen))


def _upper_first(path: Path, index: int, order: np.ndarray) -> np.ndarray:
    """Return the order with the upper member of each pair in the earlier slot."""
    partner = np.argsort(order)[path.partners[index][order]]
    lower = np.flatnonzero((path.values[index][order].imag < 0) & (partner > np.arange(len(order))))
    if len(lower):
        order = order.copy()
        order[lower], order[partner[lower]] = order[partner[lower]], order[lower]
    return order


def matched(path: Path, before: int, after: int, order: np.ndarray) -> np.ndarray:
    """Return the order of the eigenvalues at a point `after` that continues the one at `before`.

    Parameters
    ----------
    path : Path
        Its points.
    before, after : int
        Two of them, valid ones.
    order : ndarray of int
        Place of each track's eigenvalue at `before`, shape (n,).

    Notes
    -----
    Cost of a pair [-]: one less |w₁v₂ w₂v₁|, plus the relative distance of the eigenvalues. With w₁v₁ = 1 the product
    is 1 for a mode and its continuation and 0 for any other, even where right eigenvectors are nearly parallel (the
    slow modes, which all drift mostly north); |v₁ᴴv₂|² settles what it leaves open at a defective eigenvalue.
    """
    right, left = path.vectors[before][:, order], path.left[before][order]
    old, new = path.values[before][order], path.values[after]
    likeness = np.minimum(np.abs(left @ path.vectors[after]) * np.abs(path.left[after] @ right).T, 1.0)
    parallel = np.abs(right.conj().T @ path.vectors[after]) ** 2
    reach = np.abs(old)[:, None] + np.abs(new)[None, :] + 1e-3 * np.abs(new).max()
    cost = 1.1 - likeness - 0.1 * parallel + np.abs(old[:, None] - new[None, :]) / reach
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
        A valid point, where following starts both ways.
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
    new = _upper_first(path, after, new)
    was, now = path.values[before][old], path.values[after][new]
    real = now.imag == 0
    if not np.any(real & (was.imag != 0)):
        return new
    broken = [(i, j) for i, j in pairs_of(partners_of(was)) if real[i] and real[j]]
    share = participation(path, after)[:, new]
    for i, j in broken:
        straight = _fit(slots[i], share[:, i], states) + _fit(slots[j], share[:, j], states)
        swapped = _fit(slots[i], share[:, j], states) + _fit(slots[j], share[:, i], states)
        if swapped > straight + 1e-9 or (abs(swapped - straight) <= 1e-9 and abs(now[j]) > abs(now[i])):
            new[i], new[j] = new[j], new[i]
            share[:, [i, j]] = share[:, [j, i]]
    return new


def _fit(slot: Slot, share: Real, states: tuple[str, ...]) -> float:
    """Return how well a participation fits a slot [-]."""
    weights = np.array([slot.signature.get(state, 0.0) for state in states])
    return float(weights @ share / max(share.sum(), 1e-300))


def pairs_of(partners: np.ndarray) -> set[tuple[int, int]]:
    """Return the pairs of tracks that are conjugates."""
    return {(i, int(j)) for i, j in enumerate(partners) if i < j}
