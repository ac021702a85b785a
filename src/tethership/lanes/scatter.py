"""Rule of `scatter`: numbers of a small array replaced, or added to, at places that may be worked out.

Depends on: rules, arithmetic.
"""

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
from jax.lax import GatherScatterMode

from tethership.lanes import arithmetic
from tethership.lanes.arrays import Operand
from tethership.lanes.rules import clipped, gathered, rule
from tethership.lanes.scalars import TRUE, Graph, Scalar, constant

JOINED: dict[str, Callable[[Graph, Scalar, Scalar], Scalar]] = {
    "scatter": lambda graph, old, new: new,
    "scatter-add": arithmetic.add,
    "scatter_add": arithmetic.add,
    "scatter-mul": arithmetic.multiply,
    "scatter_mul": arithmetic.multiply,
    "scatter-min": arithmetic.least,
    "scatter_min": arithmetic.least,
    "scatter-max": arithmetic.greatest,
    "scatter_max": arithmetic.greatest,
}
"""What an old number and a new one make, by the primitive's name."""


@rule(*JOINED)
def _scatter(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Write the updates one after the other, window by window."""
    array, indices, updates = (gathered(graph, operand) for operand in operands)
    numbers, join = equation.params["dimension_numbers"], JOINED[equation.primitive.name]
    clip = equation.params["mode"] == GatherScatterMode.CLIP
    windows = numbers.update_window_dims
    fixed = (*numbers.inserted_window_dims, *numbers.operand_batching_dims)
    inner = [axis for axis in range(array.ndim) if axis not in fixed]
    sizes = [1] * array.ndim
    for axis, window in zip(inner, windows, strict=True):
        sizes[axis] = updates.shape[window]
    outer = [axis for axis in range(updates.ndim) if axis not in windows]
    result: Any = array.copy()
    for place in np.ndindex(*(updates.shape[axis] for axis in outer)):
        starts = _starts(numbers, indices, place, array.ndim)
        taken, starts = _within(graph, starts, array.shape, sizes, clip)
        for offset in np.ndindex(*(sizes[axis] for axis in inner)):
            update = updates[_joined_index(outer, place, windows, offset)]
            target = dict(zip(inner, offset, strict=True))
            shifts = [target.get(axis, 0) for axis in range(array.ndim)]
            _write(graph, result, starts, shifts, taken, lambda old, new=update: join(graph, old, new))
    return [result]


def _starts(numbers: Any, indices: np.ndarray, place: tuple[int, ...], axes: int) -> list[Scalar]:
    """Return where a window begins, along each axis of the array."""
    starts = [constant(0.0)] * axes
    for axis, start in zip(numbers.scatter_dims_to_operand_dims, indices[place], strict=True):
        starts[axis] = start
    for axis, own in zip(numbers.operand_batching_dims, numbers.scatter_indices_batching_dims, strict=True):
        starts[axis] = constant(float(place[own]))
    return starts


def _within(
    graph: Graph, starts: list[Scalar], shape: tuple[int, ...], sizes: list[int], clip: bool
) -> tuple[Scalar, list[Scalar]]:
    """Return whether a window lies inside the array, and its start moved inside."""
    lasts = [n - size for n, size in zip(shape, sizes, strict=True)]
    inside = TRUE
    for start, last in zip(starts, lasts, strict=True):
        for name, limit in (("ge", 0.0), ("le", float(last))):
            inside = arithmetic.both(graph, inside, arithmetic.compare(graph, name, start, constant(limit)))
    moved = [clipped(graph, start, last) for start, last in zip(starts, lasts, strict=True)]
    return TRUE if clip else inside, moved


def _joined_index(
    outer: list[int], place: tuple[int, ...], windows: tuple[int, ...], offset: tuple[int, ...]
) -> tuple[int, ...]:
    """Return an index of the updates from its two parts."""
    whole = dict(zip([*outer, *windows], [*place, *offset], strict=True))
    return tuple(whole[axis] for axis in sorted(whole))


def _write(
    graph: Graph,
    array: Any,
    starts: list[Scalar],
    shifts: list[int],
    taken: Scalar,
    joined: Callable[[Scalar], Scalar],
) -> None:
    """Change the number at start + shift where the mask is true; of a start that is worked out, at all it may be."""
    ranges = []
    for start, shift, size in zip(starts, shifts, array.shape, strict=True):
        known = start.value
        ranges.append(range(size) if known is None else [int(known) + shift])
    for target in itertools.product(*ranges):
        here = taken
        for start, shift, at in zip(starts, shifts, target, strict=True):
            here = arithmetic.both(graph, here, arithmetic.compare(graph, "eq", start, constant(float(at - shift))))
        if here.value is not False:
            array[target] = arithmetic.select(graph, here, array[target], joined(array[target]))
