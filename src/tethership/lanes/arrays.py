"""Arrays of scalars, and tables that stay in memory. Depends on: scalars.

A small array of one flight is an object array of scalars. A large one (a record of turbulence) is a `Table`: only where
its numbers lie is known, and reading one at a place that a flight works out is an expression.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from tethership.lanes.scalars import Scalar, constant

LARGE = 256
"""Inputs with more numbers than this stay in memory."""


class Table(NamedTuple):
    """A large input, or a part of it.

    Attributes
    ----------
    number : int
        Which of the program's tables.
    shared : bool
        Whether it is the same for all flights.
    places : ndarray of int
        Where each number lies in it.
    """

    number: int
    shared: bool
    places: np.ndarray

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the part [-]."""
        return self.places.shape

    def strides(self) -> tuple[int, ...] | None:
        """Return how far apart neighbours lie along each axis, None where that is not the same everywhere."""
        steps = []
        for axis, length in enumerate(self.places.shape):
            apart = np.diff(self.places, axis=axis)
            if length > 1 and not (apart == apart.flat[0]).all():
                return None
            steps.append(int(apart.flat[0]) if length > 1 else 0)
        return tuple(steps)


Operand = np.ndarray | Table


def filled(shape: Sequence[int], values: Sequence[Scalar]) -> np.ndarray:
    """Return an object array of a shape with these scalars in it, in the order of rows."""
    array = np.empty(len(values), dtype=object)
    array[:] = values
    return array.reshape(shape)


def lifted(array: object) -> np.ndarray:
    """Return an array of constants."""
    numbers = np.asarray(array)
    boolean = numbers.dtype == bool
    values = [constant(bool(x) if boolean else float(x)) for x in numbers.ravel().tolist()]
    return filled(numbers.shape, values)


def each(function: Callable[..., Scalar], *arrays: np.ndarray) -> np.ndarray:
    """Return a function of scalars applied to every place of arrays of one shape; a lone number fits any."""
    spread = np.broadcast_arrays(*arrays)
    return filled(spread[0].shape, [function(*row) for row in zip(*(array.ravel() for array in spread), strict=True)])


def reduced(
    function: Callable[[Scalar, Scalar], Scalar], neutral: Scalar, array: np.ndarray, axes: Sequence[int]
) -> np.ndarray:
    """Return an array with some axes joined by a function of two scalars, from the first on; `neutral` for none."""
    kept = [axis for axis in range(array.ndim) if axis not in axes]
    shape, count = [array.shape[axis] for axis in kept], math.prod(array.shape[axis] for axis in axes)
    rows = np.transpose(array, [*kept, *axes]).reshape((*shape, count))
    result = rows[..., 0] if count else filled(shape, [neutral] * math.prod(shape))
    for place in range(1, rows.shape[-1]):
        result = each(function, np.asarray(result, dtype=object), rows[..., place])
    return np.asarray(result, dtype=object).reshape(shape)
