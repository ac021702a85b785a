"""How each primitive of JAX is written with scalars: a table of rules. Depends on: scalars, arithmetic, arrays.

A rule is given the graph, the equation and its operands, and returns the equation's results. Whole numbers are held as
float64, exact below 2⁵³, so that only division and remainder tell them from others. Loops and calls, which need the
walk itself, are in `control_flow`.
"""

import itertools
import math
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from tethership.lanes import arithmetic
from tethership.lanes.arrays import Operand, Table, each, filled, lifted, reduced
from tethership.lanes.not_compiled import NotCompiled
from tethership.lanes.scalars import FALSE, NUMBER, ONE, TRUE, ZERO, Graph, Scalar, constant

Rule = Callable[[Graph, Any, list[Operand]], list[Operand]]

RULES: dict[str, Rule] = {}
"""Rule of each primitive that is known, by the primitive's name."""


def rule(*names: str) -> Callable[[Rule], Rule]:
    """Return a decorator that makes a function the rule of these primitives."""

    def kept(function: Rule) -> Rule:
        RULES.update(dict.fromkeys(names, function))
        return function

    return kept


def dtype(variable: Any) -> np.dtype:
    """Return the type of the numbers of a variable of an equation."""
    return np.dtype(variable.aval.dtype)


def gathered(graph: Graph, operand: Operand) -> np.ndarray:
    """Return an operand as an array of scalars, a table's numbers read one by one.

    Raises
    ------
    NotCompiled
        It is a large table.
    """
    if not isinstance(operand, Table):
        return operand
    if operand.places.size > 256:
        raise NotCompiled(f"an array of shape {operand.shape} is used as a whole; only its single numbers can be read")
    return filled(operand.shape, [read(graph, operand, constant(float(place))) for place in operand.places.ravel()])


def read(graph: Graph, table: Table, place: Scalar) -> Scalar:
    """Return the number of a table at a place that a scalar gives."""
    return graph.expression("at", (place,), NUMBER, (table.number, table.shared), least=1 if table.shared else 2)


def scalarwise(function: Callable[..., Scalar]) -> Rule:
    """Return a rule that applies a function of a graph and scalars to every place."""

    def applied(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
        return [each(partial(function, graph), *(gathered(graph, operand) for operand in operands))]

    return applied


def _register_elementwise() -> None:
    for name in ("sin", "cos", "tan", "exp", "log", "expm1", "log1p", "tanh", "sinh", "cosh", "asin", "acos", "atan"):
        RULES[name] = scalarwise(lambda graph, x, name=name: arithmetic.apply(graph, name, x))
    for name in ("asinh", "acosh", "atanh", "sqrt", "abs", "floor", "ceil", "erf", "atan2", "pow"):
        RULES[name] = scalarwise(lambda graph, *x, name=name: arithmetic.apply(graph, name, *x))
    for name in arithmetic.COMPARED:
        RULES[name] = scalarwise(lambda graph, x, y, name=name: arithmetic.compare(graph, name, x, y))
    named = {
        "add": arithmetic.add,
        "add_any": arithmetic.add,
        "sub": arithmetic.subtract,
        "mul": arithmetic.multiply,
        "neg": arithmetic.negative,
        "sign": arithmetic.sign,
        "is_finite": arithmetic.is_finite,
        "min": arithmetic.least,
        "max": arithmetic.greatest,
        "square": lambda graph, x: arithmetic.multiply(graph, x, x),
    }
    RULES.update({name: scalarwise(function) for name, function in named.items()})
    joined = {"sum": (arithmetic.add, ZERO), "prod": (arithmetic.multiply, ONE)}
    joined |= {"max": (arithmetic.greatest, constant(-math.inf)), "min": (arithmetic.least, constant(math.inf))}
    joined |= {"and": (arithmetic.both, TRUE), "or": (arithmetic.either, FALSE)}
    RULES.update({f"reduce_{name}": reduction(*how) for name, how in joined.items()})


def reduction(function: Callable[[Graph, Scalar, Scalar], Scalar], neutral: Scalar) -> Rule:
    """Return a rule that joins some axes of an array by a function of two scalars; none of them give `neutral`."""

    def applied(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
        array = gathered(graph, operands[0])
        axes = equation.params["axes"]
        return [reduced(partial(function, graph), neutral, array, axes)] if axes else [array]

    return applied


_register_elementwise()


@rule("div")
def _div(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    function = arithmetic.divide if dtype(equation.outvars[0]).kind == "f" else arithmetic.whole_quotient
    return scalarwise(function)(graph, equation, operands)


@rule("rem")
def _rem(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    return scalarwise(lambda graph, x, y: arithmetic.apply(graph, "fmod", x, y))(graph, equation, operands)


@rule("and", "or", "xor", "not")
def _logic(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    name = equation.primitive.name
    if dtype(equation.outvars[0]).kind != "b":
        raise NotCompiled(f"the primitive {name!r} on whole numbers is not known")
    functions = {"and": arithmetic.both, "or": arithmetic.either, "xor": arithmetic.exclusive, "not": arithmetic.invert}
    return scalarwise(functions[name])(graph, equation, operands)


@rule("integer_pow")
def _integer_pow(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    exponent = equation.params["y"]
    return scalarwise(lambda graph, x: arithmetic.power(graph, x, exponent))(graph, equation, operands)


@rule("rsqrt")
def _rsqrt(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    inverse = lambda graph, x: arithmetic.divide(graph, ONE, arithmetic.apply(graph, "sqrt", x))  # noqa: E731
    return scalarwise(inverse)(graph, equation, operands)


@rule("select_n")
def _select(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    which, *cases = (gathered(graph, operand) for operand in operands)
    if len(cases) > 2 or dtype(equation.invars[0]).kind != "b":
        return [each(partial(_chosen, graph), which, *cases)]
    return [each(partial(arithmetic.select, graph), which, *cases)]


def _chosen(graph: Graph, which: Scalar, *cases: Scalar) -> Scalar:
    """Return the case that a number 0, 1, … names."""
    found = cases[0]
    for place, case in enumerate(cases[1:], 1):
        found = arithmetic.select(graph, arithmetic.compare(graph, "eq", which, constant(float(place))), found, case)
    return found


@rule("clamp")
def _clamp(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    def clamped(graph: Graph, low: Scalar, x: Scalar, high: Scalar) -> Scalar:
        return arithmetic.least(graph, arithmetic.greatest(graph, x, low), high)

    return scalarwise(clamped)(graph, equation, operands)


@rule("convert_element_type")
def _convert(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    before, after = dtype(equation.invars[0]), np.dtype(equation.params["new_dtype"])
    if before == after or (before.kind in "iu" and after.kind in "iuf") or (before.kind, after.kind) == ("f", "f"):
        if after.itemsize < before.itemsize and after.kind == "f":
            raise NotCompiled(f"numbers of type {after} are not known; only float64 is")
        return operands
    array = gathered(graph, operands[0])
    if after.kind == "b":
        return [each(partial(arithmetic.as_mask, graph), array)]
    if before.kind == "b":
        return [each(partial(arithmetic.as_number, graph), array)]
    if before.kind == "f" and after.kind in "iu":
        return [each(lambda x: arithmetic.apply(graph, "trunc", x), array)]
    raise NotCompiled(f"numbers of type {before} as {after} are not known")


@rule("iota")
def _iota(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    return [lifted(equation.primitive.bind(**equation.params))]


@rule("dot_general")
def _dot(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    (left_axes, right_axes), (left_batch, right_batch) = equation.params["dimension_numbers"]
    left, batch, left_free = _matrices(gathered(graph, operands[0]), left_batch, left_axes)
    right, _, right_free = _matrices(gathered(graph, operands[1]), right_batch, right_axes)
    shape = (*left.shape[:-1], right.shape[-2])
    result = np.empty(shape, dtype=object)
    for place in np.ndindex(*shape):
        row, column = left[place[:-1]], right[(*place[:-2], place[-1])]
        result[place] = _inner(graph, row, column)
    return [result.reshape((*batch, *left_free, *right_free))]


def _matrices(array: np.ndarray, batch: Any, axes: Any) -> tuple[np.ndarray, tuple, tuple]:
    """Return an array of shape (batch, free, contracted), and the shapes of what is batched and of what is free."""
    free = [axis for axis in range(array.ndim) if axis not in (*batch, *axes)]
    shape = [tuple(array.shape[axis] for axis in group) for group in (batch, free, axes)]
    moved = np.transpose(array, [*batch, *free, *axes])
    return moved.reshape(*shape[0], math.prod(shape[1]), math.prod(shape[2])), shape[0], shape[1]


def _inner(graph: Graph, row: np.ndarray, column: np.ndarray) -> Scalar:
    total = ZERO
    for x, y in zip(row, column, strict=True):
        total = arithmetic.add(graph, total, arithmetic.multiply(graph, x, y))
    return total


@rule("argmin", "argmax")
def _place_of_extreme(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    array, axis = gathered(graph, operands[0]), equation.params["axes"][0]
    better = "lt" if equation.primitive.name == "argmin" else "gt"
    rows = np.moveaxis(array, axis, -1)
    found = [_place(graph, rows[place], better) for place in np.ndindex(*rows.shape[:-1])]
    return [filled(rows.shape[:-1], found)]


def _place(graph: Graph, row: np.ndarray, better: str) -> Scalar:
    """Return the first place of the least or the greatest of some numbers; of the first NaN where there is one."""
    best, place = row[0], ZERO
    for number, x in enumerate(row[1:], 1):
        not_a_number = arithmetic.compare(graph, "ne", x, x)
        good = arithmetic.compare(graph, "eq", best, best)
        here = arithmetic.either(graph, arithmetic.compare(graph, better, x, best), not_a_number)
        here = arithmetic.both(graph, here, good)
        best = arithmetic.select(graph, here, best, x)
        place = arithmetic.select(graph, here, place, constant(float(number)))
    return place


@rule("dynamic_update_slice")
def _dynamic_update_slice(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    array, update, *starts = (gathered(graph, operand) for operand in operands)
    places = [clipped(graph, s.item(), n - k) for s, n, k in zip(starts, array.shape, update.shape, strict=True)]
    new: dict[tuple[int, ...], Any] = {offset: update[offset] for offset in np.ndindex(*update.shape)}
    result = array.copy()
    for target in np.ndindex(*array.shape):
        for offset, number in new.items():
            here = TRUE
            for start, shift, at in zip(places, offset, target, strict=True):
                same = arithmetic.compare(graph, "eq", start, constant(float(at - shift)))
                here = arithmetic.both(graph, here, same)
            result[target] = arithmetic.select(graph, here, result.item(target), number)
    return [result]


@rule("dynamic_slice")
def _dynamic_slice(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    array, *starts = operands
    sizes = equation.params["slice_sizes"]
    starts = [
        clipped(graph, gathered(graph, s).item(), n - k) for s, n, k in zip(starts, array.shape, sizes, strict=True)
    ]
    if isinstance(array, Table) and any(start.value is None for start in starts):
        return [table_part(graph, array, starts, sizes)]
    for axis, start in enumerate(starts):
        array = part(graph, array, axis, start, sizes[axis])
    return [array]


def clipped(graph: Graph, start: Scalar, last: int) -> Scalar:
    """Return a place that is kept within 0 … last, 0 for NaN."""
    above = arithmetic.compare(graph, "gt", start, ZERO)
    return arithmetic.least(graph, arithmetic.select(graph, above, ZERO, start), constant(float(last)))


def part(graph: Graph, array: Operand, axis: int, start: Scalar, size: int) -> Operand:
    """Return a part of an array along one axis: where its start is not known, one of all that it may be."""
    if start.value is not None:
        cut = (slice(None),) * axis + (slice(int(start.value), int(start.value) + size),)
        return array._replace(places=array.places[cut]) if isinstance(array, Table) else array[cut]
    rows = np.moveaxis(gathered(graph, array), axis, 0)
    found = rows[:size]
    for first in range(1, rows.shape[0] - size + 1):
        here = arithmetic.compare(graph, "eq", start, constant(float(first)))
        found = each(partial(arithmetic.select, graph, here), found, rows[first : first + size])
    return np.moveaxis(found, 0, axis)


def table_part(graph: Graph, table: Table, starts: list[Scalar], sizes: tuple[int, ...]) -> np.ndarray:
    """Return a small part of a table that begins where scalars say."""
    strides = table.strides()
    if strides is None:
        raise NotCompiled("an array's rows were put in another order before it is read at a place that is worked out")
    first = constant(float(table.places.flat[0]))
    for start, stride in zip(starts, strides, strict=True):
        first = arithmetic.add(graph, first, arithmetic.multiply(graph, start, constant(float(stride))))
    offsets = [sum(map(math.prod, zip(place, strides, strict=True))) for place in np.ndindex(*sizes)]
    places = [arithmetic.add(graph, first, constant(float(offset))) for offset in offsets]
    return filled(sizes, [read(graph, table, place) for place in places])


@rule("platform_index")
def _platform(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Choose what is written for processors, or for any platform."""
    platforms = equation.params["platforms"]
    chosen = next((i for i, names in enumerate(platforms) if names is None or "cpu" in names), None)
    if chosen is None:
        raise NotCompiled("a function that is written for other platforms only")
    return [lifted(np.asarray(chosen))]


@rule("cumsum")
def _cumsum(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    axis, order = equation.params["axis"], slice(None, None, -1 if equation.params["reverse"] else 1)
    rows = np.moveaxis(gathered(graph, operands[0]), axis, 0)[order]
    sums = itertools.accumulate(rows, lambda x, y: each(partial(arithmetic.add, graph), x, y))
    stacked = np.stack([np.asarray(x, dtype=object) for x in sums])
    return [np.moveaxis(stacked[order], 0, axis)]
