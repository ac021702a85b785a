"""Rule of `gather`: parts of a small array at places that are worked out. Depends on: rules, arithmetic, arrays."""

import math
from functools import partial
from typing import Any

import numpy as np
from jax.lax import GatherScatterMode

from tethership.lanes import arithmetic
from tethership.lanes.arrays import Operand, Table, each, filled
from tethership.lanes.rules import clipped, dtype, gathered, part, rule, table_part
from tethership.lanes.scalars import TRUE, Graph, Scalar, constant


@rule("gather")
def _gather(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Cut one part for each index, drop its collapsed axes, and put the parts where the result has them."""
    array, indices = operands[0], gathered(graph, operands[1])
    numbers, sizes = equation.params["dimension_numbers"], equation.params["slice_sizes"]
    filling = _filling(equation)
    collapsed = (*numbers.collapsed_slice_dims, *numbers.operand_batching_dims)
    kept = [size for axis, size in enumerate(sizes) if axis not in collapsed]
    places = list(np.ndindex(*indices.shape[:-1]))
    parts = []
    for place in places:
        starts = [constant(0.0)] * len(sizes)
        for axis, number in zip(numbers.start_index_map, indices[place], strict=True):
            starts[axis] = number
        for axis, own in zip(numbers.operand_batching_dims, numbers.start_indices_batching_dims, strict=True):
            starts[axis] = constant(float(place[own]))
        parts.append(_cut(graph, array, starts, sizes, filling).reshape(kept))
    rows = np.stack(parts) if parts else np.empty((0, *kept), dtype=object)
    return [_laid_out(rows.reshape((*indices.shape[:-1], *kept)), numbers.offset_dims)]


def _filling(equation: Any) -> Scalar | None:
    """Return what is read outside an array, None where the nearest place inside is read instead."""
    if equation.params["mode"] != GatherScatterMode.FILL_OR_DROP:
        return None
    value, kind = equation.params["fill_value"], dtype(equation.outvars[0])
    if value is not None:
        return constant(bool(value) if kind.kind == "b" else float(value))
    if kind.kind == "f":
        return constant(math.nan)
    return TRUE if kind.kind == "b" else constant(float(np.iinfo(kind).min))


def _cut(
    graph: Graph, array: Operand, starts: list[Scalar], sizes: tuple[int, ...], filling: Scalar | None
) -> np.ndarray:
    lasts = [n - size for n, size in zip(array.shape, sizes, strict=True)]
    inside = TRUE
    for start, last in zip(starts, lasts, strict=True):
        for name, limit in (("ge", 0.0), ("le", float(last))):
            inside = arithmetic.both(graph, inside, arithmetic.compare(graph, name, start, constant(limit)))
    within = [clipped(graph, start, last) for start, last in zip(starts, lasts, strict=True)]
    if isinstance(array, Table) and any(start.value is None for start in within):
        found = table_part(graph, array, within, sizes)
    else:
        for axis, start in enumerate(within):
            array = part(graph, array, axis, start, sizes[axis])
        found = gathered(graph, array)
    if filling is None:
        return found
    return each(partial(arithmetic.select, graph, inside, filling), found)


def _laid_out(rows: np.ndarray, offsets: tuple[int, ...]) -> np.ndarray:
    """Return parts of shape (indices, part) with the axes of the parts where the result has them."""
    first = rows.ndim - len(offsets)
    order, index, offset = [], iter(range(first)), iter(range(first, rows.ndim))
    for axis in range(rows.ndim):
        order.append(next(offset) if axis in offsets else next(index))
    return np.transpose(rows, order) if rows.ndim else filled((), [rows.item()])
