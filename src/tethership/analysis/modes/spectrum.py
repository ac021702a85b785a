"""Eigenvalues that may be repeated or defective: groups, spectral projectors, participation. Depends on numpy, scipy.

A free ship has a triple zero eigenvalue with only two eigenvectors. What single eigenvectors say there is rounding; the
projector on the group's invariant subspace is well defined, and so are its mean eigenvalue and its participation.
"""

from typing import Any, NamedTuple

import numpy as np
import scipy.linalg
import scipy.optimize
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

ROUNDING = 1e3 * np.finfo(float).eps
"""Relative error of A that rounding and the trim may leave."""

NULL = 1e-7
"""Eigenvalues below this fraction of ‖A‖ are null."""


class Spectrum(NamedTuple):
    """Eigenvalues and invariant subspaces of a matrix.

    Attributes
    ----------
    eigenvalues : ndarray
        λ [1/s], complex, shape (n,); those of a group that belong together are all its mean.
    vectors : ndarray
        Right eigenvectors as columns, largest entry 1 [-], shape (n, n).
    participation : ndarray
        |share| of each state (rows) in each eigenvalue (columns) [-], shape (n, n): |w_k v_k|, for a group the diagonal
        of its projector over its size.
    groups : tuple
        Groups of places, one for every distinct eigenvalue.
    projectors : tuple of ndarray
        Spectral projector of each group, shape (n, n).
    blocks : tuple of int
        Number of eigenvectors of each group: fewer than its size where it is defective.
    """

    eigenvalues: Complex
    vectors: Complex
    participation: Real
    groups: tuple[tuple[int, ...], ...]
    projectors: tuple[Complex, ...]
    blocks: tuple[int, ...]


def analyse(matrix: Real, error: float = ROUNDING) -> Spectrum:
    """Return the spectrum of a real matrix, fastest first.

    Parameters
    ----------
    matrix : ndarray
        A in comparable coordinates [1/s], shape (n, n).
    error : float
        Relative error of A within which eigenvalues are not told apart [-].
    """
    found: Any = scipy.linalg.eig(matrix, left=True, right=True)
    values: Complex = np.asarray(found[0], dtype=np.complex128)
    left, right = (np.asarray(part, dtype=np.complex128) for part in found[1:])
    order = np.lexsort((-values.imag, -values.real, -np.abs(values).round(9)))
    values, left, right = values[order], left[:, order], right[:, order]
    size = max(float(np.linalg.norm(matrix, 2)), 1e-300)
    cosine = np.abs(np.sum(left.conj() * right, axis=0))
    slack = np.minimum(error * size / np.maximum(cosine, 1e-300), 1e-3 * size)
    groups = _grouped(values, slack, size)
    vectors: Complex = right / right[np.argmax(np.abs(right), axis=0), np.arange(len(values))]
    participation = np.abs(left.conj() * right) / np.maximum(cosine, 1e-300)
    projectors, blocks = [], []
    for group in groups:
        projector, block = _projector(matrix, values, group)
        projectors.append(projector)
        if len(group) > 1:
            mean = np.trace(block) / len(group)
            values[list(group)] = mean.real if abs(mean.imag) < 1e-9 * size else mean
            participation[:, group] = np.abs(np.diag(projector))[:, None] / len(group)
        spread = np.linalg.svd(block - np.eye(len(group)) * np.trace(block) / len(group), compute_uv=False)
        blocks.append(int(np.sum(spread < 1e-6 * size)) if len(group) > 1 else 1)
    return Spectrum(values, vectors, participation, groups, tuple(projectors), tuple(blocks))


def _grouped(values: Complex, slack: Real, size: float) -> tuple[tuple[int, ...], ...]:
    """Return the groups of eigenvalues that rounding cannot tell apart.

    Notes
    -----
    Two are linked that are closer than the slack of both, or, closer still, than that of one of them: a third zero
    beside a defective pair of zeros is as exact as they are not.
    """
    certain = 10.0 * np.sqrt(ROUNDING) * size
    groups: list[set[int]] = []
    for i in range(len(values)):
        distance = np.abs(values[:i] - values[i])
        linked = (distance <= np.minimum(slack[:i], slack[i])) | (
            distance <= np.minimum(np.maximum(slack[:i], slack[i]), certain)
        )
        near = set(np.flatnonzero(linked).tolist())
        merged = {i}.union(*(group for group in groups if group & near))
        groups = [group for group in groups if not group & near] + [merged]
    return tuple(tuple(sorted(group)) for group in sorted(groups, key=min))


def _projector(matrix: Real, values: Complex, group: tuple[int, ...]) -> tuple[Complex, Complex]:
    """Return the spectral projector of a group and the block of A on its subspace.

    Notes
    -----
    A = Q [[T₁₁, T₁₂], [0, T₂₂]] Qᴴ with the group first; T₁₁X − XT₂₂ = −T₁₂ gives P = Q [[I, −X], [0, 0]] Qᴴ. The
    diagonal of T has eigenvalues of its own rounding: they are paired with the given ones, all at once.
    """
    complex_matrix = matrix.astype(np.complex128)
    own = np.diag(scipy.linalg.schur(complex_matrix, output="complex")[0])
    _, paired = scipy.optimize.linear_sum_assignment(np.abs(values[:, None] - own[None, :]))
    wanted = own[paired[list(group)]]

    def chosen(value: complex) -> bool:
        return bool(np.any(wanted == value))

    triangle, basis, count = scipy.linalg.schur(complex_matrix, output="complex", sort=chosen)  # pyright: ignore
    head, corner, tail = triangle[:count, :count], triangle[:count, count:], triangle[count:, count:]
    solution = scipy.linalg.solve_sylvester(head, -tail, -corner) if count < len(values) else np.zeros((count, 0))
    projector = basis[:, :count] @ np.hstack([np.eye(count), -solution]) @ basis.conj().T
    return projector, head
