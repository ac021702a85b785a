"""The walk over a traced function, and the rules that need it: calls, loops, branches. Depends on: rules.

A loop goes on until no flight of its group needs it, by masks: who has ended keeps its numbers. A loop of known length
is written out. A branch is computed where at least one flight takes it.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from jax.extend.core import ClosedJaxpr, Jaxpr, Literal

from tethership.lanes import arithmetic, gather, linear_algebra, moves, scatter
from tethership.lanes.arrays import Operand, Table, each, filled, lifted
from tethership.lanes.not_compiled import NotCompiled
from tethership.lanes.rules import RULES, gathered, rule
from tethership.lanes.scalars import FALSE, MASK, Block, Branch, Graph, Loop, Scalar, constant

_ALSO = (gather, linear_algebra, moves, scatter)
"""Rooms of more rules, loaded with this one."""

MOST_ROUNDS = 64
"""Longest loop of known length that is written out."""


def walk(graph: Graph, jaxpr: Jaxpr, constants: Sequence[Operand], operands: Sequence[Operand]) -> list[Operand]:
    """Write a traced function into a graph, and return its results.

    Raises
    ------
    NotCompiled
        It has a primitive that is not known, or uses one in a way that is not.
    """
    known: dict[Any, Operand] = dict(zip([*jaxpr.constvars, *jaxpr.invars], [*constants, *operands], strict=True))

    def operand(variable: Any) -> Operand:
        return lifted(variable.val) if isinstance(variable, Literal) else known[variable]

    for equation in jaxpr.eqns:
        name = equation.primitive.name
        if name not in RULES:
            raise NotCompiled(f"the primitive {name!r} is not known")
        results = RULES[name](graph, equation, [operand(variable) for variable in equation.invars])
        known.update(zip(equation.outvars, results, strict=True))
    return [operand(variable) for variable in jaxpr.outvars]


def _called(graph: Graph, closed: ClosedJaxpr, operands: Sequence[Operand]) -> list[Operand]:
    return walk(graph, closed.jaxpr, [lifted(value) for value in closed.consts], operands)


@rule("jit", "pjit", "closed_call", "core_call", "custom_jvp_call", "custom_vjp_call", "remat", "checkpoint")
def _call(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    found = next(equation.params[name] for name in ("jaxpr", "call_jaxpr", "fun_jaxpr") if name in equation.params)
    if isinstance(found, Jaxpr):
        return walk(graph, found, [], operands)
    return _called(graph, found, operands)


@rule("custom_linear_solve")
def _linear_solve(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Do what the solver of a linear system does; how it is differentiated was settled when it was traced."""
    lengths, solvers = equation.params["const_lengths"], equation.params["jaxprs"]
    before = lengths.matvec + lengths.vecmat
    right = operands[before + lengths.solve + lengths.transpose_solve :]
    return _called(graph, solvers.solve, [*operands[before : before + lengths.solve], *right])


@rule("scan")
def _scan(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Write out a loop of known length."""
    parameters = equation.params
    length, fixed, moving = parameters["length"], parameters["num_consts"], parameters["num_carry"]
    if length > MOST_ROUNDS:
        raise NotCompiled(f"a loop of {length} rounds is too long to be written out; at most {MOST_ROUNDS}")
    consts, carry, rows = operands[:fixed], operands[fixed : fixed + moving], operands[fixed + moving :]
    kept: dict[int, list[Operand]] = {}
    for place in reversed(range(length)) if parameters["reverse"] else range(length):
        here = [_row(graph, row, place) for row in rows]
        results = _called(graph, parameters["jaxpr"], [*consts, *carry, *here])
        carry, kept[place] = results[:moving], results[moving:]
    histories = []
    for number, variable in enumerate(equation.outvars[moving:]):
        parts = [gathered(graph, kept[place][number]) for place in range(length)]
        histories.append(np.stack(parts) if parts else np.empty(variable.aval.shape, dtype=object))
    return [*carry, *histories]


def _row(graph: Graph, array: Operand, place: int) -> Operand:
    if isinstance(array, Table):
        return array._replace(places=array.places[place])
    return np.asarray(array[place], dtype=object)


class _Round(NamedTuple):
    """One walk over a loop: its block, its condition, and what it changes."""

    block: Block
    condition: Scalar
    split: int
    carried: list[np.ndarray]
    following: list[np.ndarray]

    def unchanged(self) -> set[tuple[int, int]]:
        """Return the numbers of arrays and places that are after a round what they were before."""
        return {
            (number, place)
            for number, (now, then) in enumerate(zip(self.carried, self.following, strict=True))
            for place, (before, after) in enumerate(zip(now.ravel(), then.ravel(), strict=True))
            if before is after
        }


@rule("while")
def _while(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Write a loop by masks; what it does not change is found by a first walk and kept out of it."""
    parameters = equation.params
    tests, fixed = parameters["cond_nconsts"], parameters["body_nconsts"]
    first = [gathered(graph, operand) for operand in operands[tests + fixed :]]

    def go_on(carried: list[np.ndarray]) -> Scalar:
        return _called(graph, parameters["cond_jaxpr"], [*operands[:tests], *carried])[0].item()  # pyright: ignore[reportAttributeAccessIssue]

    def onward(carried: list[np.ndarray]) -> list[np.ndarray]:
        results = _called(graph, parameters["body_jaxpr"], [*operands[tests : tests + fixed], *carried])
        return [gathered(graph, result) for result in results]

    unchanged: set[tuple[int, int]] = set()
    while not (found := _round(graph, first, unchanged, go_on, onward)).unchanged() <= unchanged:
        unchanged |= found.unchanged()
    starts = [(n, place, x) for n, array in enumerate(first) for place, x in enumerate(array.ravel())]
    now, then = ([x for array in arrays for x in array.ravel()] for arrays in (found.carried, found.following))
    moving = [i for i, (n, place, _) in enumerate(starts) if (n, place) not in unchanged]
    if found.condition.value is True or not moving:
        raise NotCompiled("a loop has no end")
    for i in moving:
        now[i].depth -= 1  # from here on it is a number of the block around the loop
    chosen = [tuple(group[i] for i in moving) for group in (now, [x for *_, x in starts], then)]
    graph.append(Loop(found.block, found.condition, found.split, *chosen))
    return list(found.carried)


def _round(
    graph: Graph,
    first: list[np.ndarray],
    unchanged: set[tuple[int, int]],
    go_on: Callable[[list[np.ndarray]], Scalar],
    onward: Callable[[list[np.ndarray]], list[np.ndarray]],
) -> _Round:
    """Walk over a loop once, with the starts in place of what is known not to change."""
    depth = len(graph.blocks)
    carried = [
        filled(
            array.shape,
            [x if (n, place) in unchanged else graph.changing(x.kind, depth) for place, x in enumerate(array.ravel())],
        )
        for n, array in enumerate(first)
    ]

    def written() -> tuple[Scalar, int, list[np.ndarray]]:
        condition = arithmetic.both(graph, graph.active[-1], go_on(carried))
        graph.active[-1] = condition
        return condition, len(graph.blocks[-1].statements), onward(carried)

    block, (condition, split, following) = graph.inside(graph.active[-1], branch=False, body=written)
    return _Round(block, condition, split, carried, following)


@rule("cond")
def _cond(graph: Graph, equation: Any, operands: list[Operand]) -> list[Operand]:
    """Write the branches, each computed where some flight takes it; one that every flight takes is no branch."""
    which, branches = operands[0].item(), equation.params["branches"]  # pyright: ignore[reportAttributeAccessIssue]
    rest = operands[1:]
    if which.value is not None:
        place = min(max(int(which.value), 0), len(branches) - 1)
        return _called(graph, branches[place], rest)
    number = arithmetic.as_number(graph, which)
    results: list[np.ndarray] | None = None
    for place, branch in enumerate(branches):
        taken = arithmetic.both(graph, graph.active[-1], _taken(graph, number, place, len(branches)))
        block, found = graph.inside(
            taken, branch=True, body=lambda branch=branch: [gathered(graph, x) for x in _called(graph, branch, rest)]
        )
        if results is None:
            results = [each(lambda x: FALSE if x.kind == MASK else constant(0.0), part) for part in found]
        results = _joined(graph, block, taken, results, found)
    return list(results or [])


def _taken(graph: Graph, number: Scalar, place: int, count: int) -> Scalar:
    """Return the mask of flights that take a branch; numbers beyond the first or last take that."""
    if place == 0:
        return arithmetic.compare(graph, "le", number, constant(0.0))
    if place == count - 1:
        return arithmetic.compare(graph, "ge", number, constant(float(place)))
    return arithmetic.compare(graph, "eq", number, constant(float(place)))


def _joined(
    graph: Graph, block: Any, taken: Scalar, before: list[np.ndarray], found: list[np.ndarray]
) -> list[np.ndarray]:
    """Close a branch: its results where it is taken, what was there before where it is not."""
    starts = [scalar for part in before for scalar in part.ravel()]
    ends = [scalar for part in found for scalar in part.ravel()]
    moving = [graph.changing(end.kind, len(graph.blocks) - 1) for end in ends]
    graph.append(Branch(block, taken, tuple(moving), tuple(starts), tuple(ends)))
    joined, place = [], 0
    for part in found:
        joined.append(filled(part.shape, moving[place : place + part.size]))
        place += part.size
    return joined
