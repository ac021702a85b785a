"""Rules of primitives that only move numbers: done once, while a program is written. Depends on: rules, arrays.

The same movement serves an array of scalars and the places of a table that stays in memory.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from tethership.lanes.arrays import Operand, Table
from tethership.lanes.not_compiled import NotCompiled
from tethership.lanes.rules import RULES, gathered
from tethership.lanes.scalars import Graph

Move = Callable[..., Any]

MOVES: dict[str, Move] = {
    "squeeze": lambda p, x: np.squeeze(x, axis=tuple(p["dimensions"])),
    "expand_dims": lambda p, x: np.expand_dims(x, tuple(p["dimensions"])),
    "transpose": lambda p, x: np.transpose(x, p["permutation"]),
    "rev": lambda p, x: np.flip(x, tuple(p["dimensions"])),
    "concatenate": lambda p, *xs: np.concatenate(xs, axis=p["dimension"]),
    "stack": lambda p, *xs: np.stack(xs, axis=p["axis"]),
    "unstack": lambda p, x: list(np.moveaxis(x, p["axis"], 0)),
    "split": lambda p, x: np.split(x, np.cumsum(p["sizes"])[:-1], axis=p["axis"]),
    "copy": lambda p, x: x,
    "copy_p": lambda p, x: x,
    "stop_gradient": lambda p, x: x,
    "tile": lambda p, x: np.tile(x, p["reps"]),
}
"""Results of each primitive, from its parameters and operands."""


def _move(function: Move) -> Move:
    MOVES[function.__name__.strip("_")] = function
    return function


@_move
def _reshape(parameters: dict[str, Any], x: np.ndarray) -> np.ndarray:
    if parameters.get("dimensions") is not None:
        x = np.transpose(x, parameters["dimensions"])
    return x.reshape(parameters["new_sizes"])


@_move
def _slice(parameters: dict[str, Any], x: np.ndarray) -> np.ndarray:
    starts, ends = parameters["start_indices"], parameters["limit_indices"]
    steps = parameters["strides"] or (1,) * x.ndim
    return x[tuple(slice(*cut) for cut in zip(starts, ends, steps, strict=True))]


@_move
def _broadcast_in_dim(parameters: dict[str, Any], x: np.ndarray) -> np.ndarray:
    shape = parameters["shape"]
    sizes = [1] * len(shape)
    for axis, place in enumerate(parameters["broadcast_dimensions"]):
        sizes[place] = x.shape[axis]
    return np.broadcast_to(x.reshape(sizes), shape)


@_move
def _pad(parameters: dict[str, Any], x: np.ndarray, filling: np.ndarray) -> np.ndarray:
    widths = parameters["padding_config"]
    if any(low < 0 or high < 0 for low, high, _ in widths):
        raise NotCompiled("the primitive 'pad' that cuts an array is not known")
    spread = [size + max(size - 1, 0) * inside for size, (_, _, inside) in zip(x.shape, widths, strict=True)]
    shape = [low + high + size for size, (low, high, _) in zip(spread, widths, strict=True)]
    padded = np.full(math.prod(shape), filling.item(), dtype=object).reshape(shape)
    places = [slice(low, low + n, inside + 1) for n, (low, _, inside) in zip(spread, widths, strict=True)]
    padded[tuple(places)] = x
    return padded


def _rule(move: Move) -> Any:
    def applied(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
        alone = operands[0] if len(operands) == 1 else None
        if isinstance(alone, Table):
            found = move(equation.params, alone.places)
            return [alone._replace(places=part) for part in (found if isinstance(found, list) else [found])]
        found = move(equation.params, *(gathered(graph, operand) for operand in operands))
        return [np.asarray(part, dtype=object) for part in (found if isinstance(found, list) else [found])]

    return applied


RULES.update({name: _rule(move) for name, move in MOVES.items()})
