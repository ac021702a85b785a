"""Scalars of one flight as a graph of expressions, and the blocks in which they are computed. Depends on: nothing.

A traced function of one flight is written out number by number. Equal expressions are one; what is constant is folded;
and every expression is computed in the outermost block where its arguments are known: what depends on shared numbers
alone once a call, what a loop does not change once before the loop.
"""

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple, TypeVar

NUMBER, MASK = "number", "mask"
"""Kinds of scalars: float64 (whole numbers too, exact below 2⁵³), and true or false."""


Result = TypeVar("Result")


class Scalar:
    """One number of one flight.

    Attributes
    ----------
    operation : str
        What gives it: "const", "shared", "own", "at", "carried", or a name of `vectors.h` such as "add" or "sin".
    arguments : tuple of Scalar
    detail : object
        What the operation needs besides: the value of a constant, the row of an input, the number of a table.
    kind : str
        `NUMBER` or `MASK`.
    depth : int
        Place of its block among the open ones: 0 for constants, 1 for what is the same in all flights.
    order : int
        Which expression of its graph it is, 0 for constants: sums of two are written in this order.
    """

    __slots__ = ("arguments", "depth", "detail", "kind", "operation", "order")

    def __init__(
        self,
        operation: str,
        arguments: tuple["Scalar", ...],
        detail: object,
        kind: str,
        depth: int,
        order: int = 0,
    ) -> None:
        self.operation, self.arguments, self.detail = operation, arguments, detail
        self.kind, self.depth, self.order = kind, depth, order

    @property
    def value(self) -> float | bool | None:
        """Its value where it is a constant, else None."""
        return self.detail if self.operation == "const" else None  # pyright: ignore[reportReturnType]


class Block:
    """Statements that are computed together: the body of a call, of a loop, or of a branch.

    Attributes
    ----------
    statements : list of Scalar or Loop or Branch
        In the order in which they are computed.
    known : dict
        Expressions that are in it, by what they are.
    branch : bool
        Whether it is computed only where some flight needs it; nothing that is needed there alone is taken out of it.
    """

    def __init__(self, branch: bool = False) -> None:
        self.statements: list[Scalar | Loop | Branch] = []
        self.known: dict[tuple, Scalar] = {}
        self.branch = branch


class Loop(NamedTuple):
    """A block that is repeated until no flight goes on; a flight that has ended keeps its numbers.

    Attributes
    ----------
    block : Block
        Its body; the condition is computed at its start.
    condition : Scalar
        Mask of flights that go on.
    split : int
        How many of the block's statements the condition needs.
    carried, first, following : tuple of Scalar
        Numbers that change, their starts, and their values one round later.
    """

    block: Block
    condition: Scalar
    split: int
    carried: tuple[Scalar, ...]
    first: tuple[Scalar, ...]
    following: tuple[Scalar, ...]


class Branch(NamedTuple):
    """A block that is computed where at least one flight takes it.

    Attributes
    ----------
    block : Block
    taken : Scalar
        Mask of flights that take it.
    carried, first, following : tuple of Scalar
        Its results, what they are where it is not taken, and where it is.
    """

    block: Block
    taken: Scalar
    carried: tuple[Scalar, ...]
    first: tuple[Scalar, ...]
    following: tuple[Scalar, ...]


def constant(value: float | bool) -> Scalar:
    """Return a constant, float64 or true or false."""
    if isinstance(value, bool):
        return Scalar("const", (), value, MASK, 0)
    return Scalar("const", (), float(value), NUMBER, 0)


ZERO, ONE = constant(0.0), constant(1.0)
TRUE, FALSE = constant(True), constant(False)


def named(scalar: Scalar) -> object:
    """Return what tells a scalar from others: constants are told by kind and value (NaN, −0 too)."""
    if scalar.operation != "const":
        return id(scalar)
    return scalar.kind, str(scalar.detail)


class Graph:
    """Expressions that are being written, block by block.

    Attributes
    ----------
    blocks : list of Block
        Open ones: nothing at 0 (constants), the call's start at 1, a group of flights at 2, loops and branches above.
    active : list of Scalar
        Masks of the flights for which the innermost loops and branches are computed.
    """

    def __init__(self) -> None:
        self.blocks = [Block(), Block(), Block()]
        self.active = [TRUE]
        self._count = 0

    def expression(
        self, operation: str, arguments: Iterable[Scalar], kind: str = NUMBER, detail: object = None, least: int = 1
    ) -> Scalar:
        """Return an expression, the one that is there already where there is an equal one.

        Parameters
        ----------
        operation, arguments, kind, detail
            As in `Scalar`.
        least : int
            Outermost block in which it may be computed.
        """
        arguments = tuple(arguments)
        key = (operation, detail, kind, *map(named, arguments))
        outermost = depth = max([least, *(argument.depth for argument in arguments)])
        while depth + 1 < len(self.blocks) and self.blocks[depth + 1].branch:
            depth += 1
        for block in self.blocks[outermost : depth + 1]:
            if key in block.known:
                return block.known[key]
        self._count += 1
        found = Scalar(operation, arguments, detail, kind, depth, self._count)
        self.blocks[depth].known[key] = found
        self.blocks[depth].statements.append(found)
        return found

    def changing(self, kind: str, depth: int) -> Scalar:
        """Return a number that a loop or a branch changes, of the block at a depth."""
        self._count += 1
        return Scalar("carried", (), None, kind, depth, self._count)

    def inside(self, active: Scalar, branch: bool, body: Callable[[], Result]) -> tuple[Block, Result]:
        """Return a new block and what a function returned that wrote into it, for the flights of a mask."""
        block = Block(branch)
        self.blocks.append(block)
        self.active.append(active)
        try:
            return block, body()
        finally:
            self.blocks.pop()
            self.active.pop()

    def append(self, statement: Loop | Branch) -> None:
        """Write a loop or a branch into the innermost block."""
        self.blocks[-1].statements.append(statement)


def folded(function: Callable[..., float], *values: float) -> Scalar | None:
    """Return a constant that a function of constants gives, None where Python's mathematics refuses it."""
    try:
        return constant(function(*values))
    except (ValueError, OverflowError, ZeroDivisionError):
        return None


def divided(x: float, y: float) -> float:
    """Return x/y as float64 does: ±∞ or NaN for y = 0."""
    if y != 0.0:
        return x / y
    return math.nan if x == 0.0 or math.isnan(x) else math.copysign(math.inf, x) * math.copysign(1.0, y)
