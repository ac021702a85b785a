"""Rules of linear solvers: LU with partial pivoting, written out for small matrices. Depends on: rules, arithmetic.

Every flight picks its own pivots, by masks. What it costs grows with the cube of the size.
"""

from functools import partial
from typing import Any

import numpy as np

from tethership.lanes import arithmetic
from tethership.lanes.arrays import Operand, each, lifted
from tethership.lanes.not_compiled import NotCompiled
from tethership.lanes.rules import gathered, rule
from tethership.lanes.scalars import Graph, Scalar, constant

LARGEST = 24
"""Rows of the largest matrix that is written out."""


@rule("lu")
def _lu(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Return L below and U on and above the diagonal, the rows that were exchanged, and their order."""
    matrix: Any = gathered(graph, operands[0]).copy()
    _check(matrix)
    rows, columns = matrix.shape
    steps = min(rows, columns)
    pivots: Any = np.empty(steps, dtype=object)
    order: Any = lifted(np.arange(rows)).copy()
    for step in range(steps):
        pivots[step] = pivot = _largest(graph, matrix[step:, step], step)
        for row in range(step + 1, rows):
            here = arithmetic.compare(graph, "eq", pivot, constant(float(row)))
            for array in (matrix, order):
                upper, lower = np.atleast_1d(array[step]), np.atleast_1d(array[row])
                swapped = [
                    each(partial(arithmetic.select, graph, here), *two) for two in ((upper, lower), (lower, upper))
                ]
                array[step], array[row] = (part if array.ndim > 1 else part.item() for part in swapped)
        for row in range(step + 1, rows):
            factor = arithmetic.divide(graph, matrix[row, step], matrix[step, step])
            matrix[row, step] = factor
            for column in range(step + 1, columns):
                taken = arithmetic.multiply(graph, factor, matrix[step, column])
                matrix[row, column] = arithmetic.subtract(graph, matrix[row, column], taken)
    return [matrix, pivots, order]


def _largest(graph: Graph, column: np.ndarray, first: int) -> Scalar:
    """Return the row of the largest size in a column, counted from a first row on."""
    best, place = arithmetic.apply(graph, "abs", column[0]), constant(float(first))
    for row, number in enumerate(column[1:], first + 1):
        size = arithmetic.apply(graph, "abs", number)
        here = arithmetic.compare(graph, "gt", size, best)
        best = arithmetic.select(graph, here, best, size)
        place = arithmetic.select(graph, here, place, constant(float(row)))
    return place


@rule("lu_pivots_to_permutation")
def _permutation(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Return the order of rows after exchanging each with its pivot."""
    pivots = gathered(graph, operands[0])
    order: Any = lifted(np.arange(equation.params["permutation_size"])).copy()
    for step, pivot in enumerate(pivots):
        for row in range(step + 1, len(order)):
            here = arithmetic.compare(graph, "eq", pivot, constant(float(row)))
            upper, lower = order[step], order[row]
            order[step] = arithmetic.select(graph, here, upper, lower)
            order[row] = arithmetic.select(graph, here, lower, upper)
    return [order]


@rule("triangular_solve")
def _triangular(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Solve a x = b or x a = b for a triangular matrix, row by row."""
    matrix, right = (gathered(graph, operand) for operand in operands)
    _check(matrix)
    parameters = equation.params
    lower = parameters["lower"]
    if parameters["transpose_a"]:
        matrix, lower = matrix.T, not lower
    if not parameters["left_side"]:  # x a = b is aᵀ xᵀ = bᵀ
        matrix, right, lower = matrix.T, right.T, not lower
    found: Any = np.empty(right.shape, dtype=object)
    size = len(matrix)
    for row in range(size) if lower else reversed(range(size)):
        known = range(row) if lower else range(row + 1, size)
        for column in range(right.shape[1]):
            rest = right[row, column]
            for other in known:
                rest = arithmetic.subtract(
                    graph, rest, arithmetic.multiply(graph, matrix[row, other], found[other, column])
                )
            found[row, column] = (
                rest if parameters["unit_diagonal"] else arithmetic.divide(graph, rest, matrix[row, row])
            )
    return [found if parameters["left_side"] else found.T]


def _check(matrix: np.ndarray) -> None:
    """Raise NotCompiled for a stack of matrices, or a large one."""
    if matrix.ndim != 2 or max(matrix.shape) > LARGEST:
        raise NotCompiled(f"a solver for a matrix of shape {matrix.shape} is not written out; at most {LARGEST} rows")
