"""Arithmetic on scalars of a graph: constants folded, neutral elements dropped. Depends on: scalars.

A constant factor 0 is taken for structure (a matrix's empty place): what it multiplies is never needed. Nothing else
is assumed that finite numbers alone would allow, so that a NaN is seen.
"""

import math
import operator
from collections.abc import Callable
from typing import Any

from tethership.lanes.scalars import FALSE, MASK, ONE, TRUE, ZERO, Graph, Scalar, constant, divided, folded

FOLDED: dict[str, Callable[..., Any]] = {
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "div": divided,
    "sqrt": math.sqrt,
    "abs": abs,
    **{name: getattr(math, name) for name in ("sin", "cos", "tan", "exp", "log", "expm1", "log1p", "tanh")},
    **{name: getattr(math, name) for name in ("sinh", "cosh", "asin", "acos", "atan", "asinh", "acosh", "atanh")},
    **{name: getattr(math, name) for name in ("floor", "ceil", "trunc", "erf", "atan2", "pow", "fmod")},
}
"""What gives the value of an operation on constants."""

COMPARED = {"gt": operator.gt, "lt": operator.lt, "ge": operator.ge, "le": operator.le, "eq": operator.eq}
COMPARED["ne"] = operator.ne

_SYMMETRIC = {"add", "mul"}
_MOST_FACTORS = 64
_order = operator.attrgetter("order")


def apply(graph: Graph, name: str, *arguments: Scalar) -> Scalar:
    """Return an operation of `FOLDED` on numbers."""
    values = [argument.value for argument in arguments]
    if None not in values and (found := folded(FOLDED[name], *values)) is not None:  # pyright: ignore[reportArgumentType]
        return found
    if name in _SYMMETRIC:
        arguments = tuple(sorted(arguments, key=_order))
    return graph.expression(name, arguments)


def add(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return x + y."""
    if x.value == 0.0:
        return y
    return x if y.value == 0.0 else apply(graph, "add", x, y)


def subtract(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return x − y."""
    if y.value == 0.0:
        return x
    return negative(graph, y) if x.value == 0.0 else apply(graph, "sub", x, y)


def multiply(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return x y."""
    for factor, other in ((x, y), (y, x)):
        if factor.value == 0.0:
            return ZERO
        if factor.value == 1.0:
            return other
        if factor.value == -1.0:
            return negative(graph, other)
    return apply(graph, "mul", x, y)


def divide(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return x/y as x (1/y), which is off by one unit in the last place: a division costs as much as 16 products."""
    if x.value is not None and y.value is not None:
        return constant(divided(x.value, y.value))
    return multiply(graph, x, apply(graph, "div", ONE, y))


def whole_quotient(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return the whole part of x/y of whole numbers, towards zero."""
    return apply(graph, "trunc", apply(graph, "div", x, y))


def negative(graph: Graph, x: Scalar) -> Scalar:
    """Return −x."""
    if x.value is not None:
        return constant(-x.value)
    return x.arguments[0] if x.operation == "neg" else graph.expression("neg", (x,))


def power(graph: Graph, x: Scalar, exponent: int) -> Scalar:
    """Return xⁿ for a whole n, by squares."""
    if exponent < 0:
        return divide(graph, ONE, power(graph, x, -exponent))
    if exponent > _MOST_FACTORS:
        return apply(graph, "pow", x, constant(float(exponent)))
    result, square = ONE, x
    while exponent:
        if exponent & 1:
            result = multiply(graph, result, square)
        exponent >>= 1
        square = multiply(graph, square, square) if exponent else square
    return result


def sign(graph: Graph, x: Scalar) -> Scalar:
    """Return −1, 0 or 1; NaN of NaN."""
    negative_or = select(graph, compare(graph, "lt", x, ZERO), x, constant(-1.0))
    return select(graph, compare(graph, "gt", x, ZERO), negative_or, ONE)


def compare(graph: Graph, name: str, x: Scalar, y: Scalar) -> Scalar:
    """Return the mask of a comparison of `COMPARED`; of two masks, of eq and ne."""
    if x.value is not None and y.value is not None:
        return constant(bool(COMPARED[name](x.value, y.value)))
    if x.kind == MASK:
        differ = graph.expression("xor", (x, y), MASK)
        return differ if name == "ne" else invert(graph, differ)
    return graph.expression(name, (x, y), MASK)


def is_finite(graph: Graph, x: Scalar) -> Scalar:
    """Return whether x is neither infinite nor NaN."""
    if x.value is not None:
        return constant(math.isfinite(x.value))
    return compare(graph, "le", apply(graph, "abs", x), constant(1.7976931348623157e308))


def invert(graph: Graph, x: Scalar) -> Scalar:
    """Return not x."""
    if x.value is not None:
        return constant(not x.value)
    return x.arguments[0] if x.operation == "not" else graph.expression("not", (x,), MASK)


def both(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return x and y."""
    for one, other in ((x, y), (y, x)):
        if one.value is not None:
            return other if one.value else FALSE
    return x if x is y else graph.expression("and", sorted((x, y), key=_order), MASK)


def either(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return x or y."""
    for one, other in ((x, y), (y, x)):
        if one.value is not None:
            return TRUE if one.value else other
    return x if x is y else graph.expression("or", sorted((x, y), key=_order), MASK)


def exclusive(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return x or y, not both."""
    return compare(graph, "ne", x, y)


def select(graph: Graph, which: Scalar, no: Scalar, yes: Scalar) -> Scalar:
    """Return `yes` where the mask is true, else `no`."""
    if which.value is not None:
        return yes if which.value else no
    if no is yes or (no.value is not None and no.value == yes.value and no.value != 0.0):
        return no
    if yes.kind == MASK:
        return either(graph, both(graph, which, yes), both(graph, invert(graph, which), no))
    return graph.expression("select", (which, yes, no))


def least(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return the smaller of two; NaN where either is."""
    return _extreme(graph, "min", min, x, y)


def greatest(graph: Graph, x: Scalar, y: Scalar) -> Scalar:
    """Return the larger of two; NaN where either is."""
    return _extreme(graph, "max", max, x, y)


def _extreme(graph: Graph, name: str, function: Callable, x: Scalar, y: Scalar) -> Scalar:
    if x.value is not None and y.value is not None:
        return constant(math.nan if math.isnan(x.value) or math.isnan(y.value) else function(x.value, y.value))
    return x if x is y else graph.expression(name, (x, y))


def as_number(graph: Graph, x: Scalar) -> Scalar:
    """Return 1 for true and 0 for false; a number as it is."""
    return select(graph, x, ZERO, ONE) if x.kind == MASK else x


def as_mask(graph: Graph, x: Scalar) -> Scalar:
    """Return whether a number is not zero; a mask as it is."""
    return x if x.kind == MASK else compare(graph, "ne", x, ZERO)
