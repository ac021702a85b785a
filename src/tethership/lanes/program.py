"""A function of one flight, compiled over lanes of flights. Depends on: compiler, control_flow, render; JAX.

    program = Program(function, shared, own)  # examples of the arguments of one flight
    results = program(shared, own)            # arrays of `own` with the flights last

The function is traced by JAX, so that no equation is written twice, and it computes what `jax.vmap` of it would, to
rounding. A loop inside it ends for each group of lanes by itself.
"""

import ctypes
import os
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import jax
import numpy as np

from tethership.lanes import arithmetic
from tethership.lanes.arrays import LARGE, Operand, Table, filled, lifted
from tethership.lanes.compiler import library, widest
from tethership.lanes.control_flow import walk
from tethership.lanes.render import program as rendered
from tethership.lanes.rules import gathered
from tethership.lanes.scalars import Graph, Scalar

_Doubles = ctypes.POINTER(ctypes.c_double)


class Recipe(NamedTuple):
    """What a traced function is compiled from: whoever keeps it need not trace again.

    Attributes
    ----------
    source : str
        C++.
    statements : int
        Expressions that are computed for a group of flights, those of a loop counted once.
    results : tuple of (tuple of int, str)
        Shape and type of each array of the results.
    structure : PyTreeDef
        What they make up.
    """

    source: str
    statements: int
    results: tuple[tuple[tuple[int, ...], str], ...]
    structure: Any


class Program:
    """A compiled function of flights.

    Parameters
    ----------
    function : callable
        Of (shared, own), two PyTrees of arrays, for one flight; returns a PyTree of arrays.
    shared, own : PyTree of arrays
        Examples: what is the same for all flights, and what each has of its own.
    width : int, optional
        Flights in a vector; what the processor holds where it is not given.
    folder : Path, optional
        Where its library is kept for the next process.
    compiler : str, optional
        As in `compiler.library`.
    recipe : Recipe, optional
        Of the same function, arguments and width, made before; the function is then not called.

    Attributes
    ----------
    recipe : Recipe
    width : int
        Flights in a vector.

    Raises
    ------
    NotCompiled
        There is no compiler, it fails, or the function uses a primitive that is not known.
    """

    def __init__(
        self,
        function: Callable[[Any, Any], Any],
        shared: Any,
        own: Any,
        width: int | None = None,
        folder: Path | None = None,
        compiler: str | None = None,
        recipe: Recipe | None = None,
    ) -> None:
        self.width = width or widest()
        shared_leaves, self._shared_tree = jax.tree.flatten(shared)
        own_leaves, self._own_tree = jax.tree.flatten(own)
        self._shared_shapes = [np.shape(leaf) for leaf in shared_leaves]
        self._own_shapes = [np.shape(leaf) for leaf in own_leaves]
        self.recipe = recipe or self._traced(function, shared_leaves, own_leaves)
        self._results = [(shape, np.dtype(kind)) for shape, kind in self.recipe.results]
        self._run = library(self.recipe.source, self.width, folder, compiler).tethership_lanes_run
        self._run.argtypes = [_Doubles, ctypes.POINTER(_Doubles), _Doubles, _Doubles, ctypes.c_long]
        self._run.argtypes += [ctypes.POINTER(ctypes.c_long)]
        self._run.restype = None

    def _traced(self, function: Callable[[Any, Any], Any], shared: list[Any], own: list[Any]) -> Recipe:
        """Have JAX trace the function, and write it out."""
        structure: Any = None

        def flat(*leaves: Any) -> list[Any]:
            nonlocal structure
            given = leaves[: len(shared)], leaves[len(shared) :]
            found, structure = jax.tree.flatten(
                function(self._shared_tree.unflatten(given[0]), self._own_tree.unflatten(given[1]))
            )
            return found

        closed = jax.make_jaxpr(flat)(*shared, *own)
        graph, operands = Graph(), []
        shapes = [*((shape, True) for shape in self._shared_shapes), *((shape, False) for shape in self._own_shapes)]
        places, tables = {True: 0, False: 0}, 0
        for (shape, is_shared), variable in zip(shapes, closed.jaxpr.invars, strict=True):
            size = int(np.prod(shape))
            if size > LARGE:
                operands.append(Table(tables, is_shared, np.arange(size).reshape(shape)))
                tables += 1
                continue
            boolean = np.dtype(variable.aval.dtype) == bool
            operands.append(_inputs(graph, shape, is_shared, places[is_shared], boolean))
            places[is_shared] += size
        results = walk(graph, closed.jaxpr, [lifted(value) for value in closed.consts], operands)
        rows = [scalar for result in results for scalar in gathered(graph, result).ravel()]
        described = tuple((tuple(value.shape), str(value.dtype)) for value in closed.out_avals)
        return Recipe(rendered(graph, rows, self.width), _count(graph.blocks[2]), described, structure)

    def __call__(self, shared: Any, own: Any, threads: int | None = None, taken: "Taken | None" = None) -> Any:
        """Return the function's results for many flights.

        Parameters
        ----------
        shared, own : PyTree of arrays
            As the examples, the arrays of `own` with the flights as an axis more, the last.
        threads : int, optional
            How many compute at once; one for each core where it is not given.
        taken : Taken, optional
            Tells how far it is, and stops it.

        Returns
        -------
        PyTree of ndarray
            As the function's, with the flights last. Where it was stopped, the flights not reached are NaN (0 where
            whole numbers are asked for).
        """
        shared_leaves = self._checked(shared, self._shared_tree, self._shared_shapes, None)
        flights = np.shape(jax.tree.leaves(own)[0])[-1]
        own_leaves = self._checked(own, self._own_tree, self._own_shapes, flights)
        padded = -(-flights // self.width) * self.width
        numbers = [leaf.ravel() for leaf in shared_leaves if leaf.size <= LARGE]
        tables = [leaf for leaf in shared_leaves if leaf.size > LARGE]
        rows = [leaf.reshape(-1, flights) for leaf in own_leaves]
        small = [row for row in rows if len(row) <= LARGE]
        tables += [_padded([row], padded) for row in rows if len(row) > LARGE]
        mine = _padded(small, padded)
        packed = np.concatenate([*numbers, np.zeros(1)])
        results = np.full((sum(int(np.prod(shape)) for shape, _ in self._results), padded), np.nan)
        taken = taken if taken is not None else Taken()
        pointers = (_Doubles * max(len(tables), 1))(*map(_pointer, tables))
        arguments = (_pointer(packed), pointers, _pointer(mine), _pointer(results), padded, ctypes.byref(taken.groups))
        _together(lambda: self._run(*arguments), min(threads or os.cpu_count() or 1, padded // self.width))
        return self._unpacked(results[:, :flights])

    def _checked(self, given: Any, tree: Any, shapes: list[tuple[int, ...]], flights: int | None) -> list[np.ndarray]:
        """Return the arrays of an argument as float64, or raise ValueError where they are not as the example's."""
        leaves, found = jax.tree.flatten(given)
        if found != tree:
            raise ValueError(f"arguments are built as {found}; the example was {tree}")
        arrays = [np.asarray(leaf, dtype=np.float64, order="C") for leaf in leaves]
        for array, shape in zip(arrays, shapes, strict=True):
            wanted = shape if flights is None else (*shape, flights)
            if array.shape != wanted:
                raise ValueError(f"an array has shape {array.shape}; it must be {wanted}")
        return arrays

    def _unpacked(self, rows: np.ndarray) -> Any:
        """Return the results as the function gives them, from rows of numbers."""
        found, first = [], 0
        for shape, dtype in self._results:
            size = int(np.prod(shape))
            part = rows[first : first + size].reshape(*shape, rows.shape[-1])
            found.append(part if dtype == np.float64 else np.nan_to_num(part).astype(dtype))
            first += size
        return self.recipe.structure.unflatten(found)


class Taken:
    """How many groups of flights have been begun; may be read, and stopped, while a program runs in other threads."""

    def __init__(self) -> None:
        self.groups = ctypes.c_long(0)

    def stop(self) -> None:
        """Let no further group be begun."""
        self.groups.value = 2**40


def _inputs(graph: Graph, shape: Sequence[int], shared: bool, first: int, boolean: bool) -> Operand:
    """Return an input as an array of scalars, from a row on."""
    operation, least = ("shared", 1) if shared else ("own", 2)
    rows = range(first, first + int(np.prod(shape)))
    scalars: list[Scalar] = [graph.expression(operation, (), detail=row, least=least) for row in rows]
    return filled(shape, [arithmetic.as_mask(graph, scalar) for scalar in scalars] if boolean else scalars)


def _count(block: Any) -> int:
    return sum(1 if isinstance(statement, Scalar) else _count(statement.block) for statement in block.statements)


def _padded(rows: list[np.ndarray], flights: int) -> np.ndarray:
    """Return rows one under the other, the last flight repeated up to so many."""
    joined = rows[0] if len(rows) == 1 else np.concatenate(rows) if rows else np.zeros((1, flights))
    missing = flights - joined.shape[1]
    joined = np.concatenate([joined, np.repeat(joined[:, -1:], missing, axis=1)], axis=1) if missing else joined
    return np.ascontiguousarray(joined)


def _pointer(array: np.ndarray) -> Any:
    return array.ctypes.data_as(_Doubles)


def _together(work: Callable[[], None], threads: int) -> None:
    """Do the same work on so many threads, this one among them."""
    others = [threading.Thread(target=work, daemon=True) for _ in range(threads - 1)]
    for thread in others:
        thread.start()
    work()
    for thread in others:
        thread.join()
