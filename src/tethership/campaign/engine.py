"""What flies a batch: a program compiled over lanes of flights, or XLA's. Depends on: lanes, simulation.

One program flies all flights of a structure, whatever differs between them: every number is each flight's own. XLA's
program, the reference, holds once what all share.
"""

import contextlib
import json
import os
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import equinox as eqx
import jax
from jaxtyping import Array, Float

from tethership._kept import UnknownCodeError, key_of
from tethership._outline import restored_structure, structure_outline
from tethership._programs import folder, load, store
from tethership.errors import ConfigError, TethershipWarning, shown
from tethership.lanes import NotCompiled, Program, Recipe, identity, widest
from tethership.plant import ClosedLoop
from tethership.simulation import BatchResult, Beat, StopConditions, differing, fly_lanes, fly_to_its_end, hoisted

ENGINES = ("lanes", "xla")
"""What may be asked for in `TETHERSHIP_ENGINE`."""


class Terms(NamedTuple):
    """What all flights of a batch have in common, as `fly_lanes` takes it."""

    stop: StopConditions
    limits: Float[Array, "limits"]
    time_limit: Float[Array, ""]
    rhythm: Beat


Engine = Callable[[ClosedLoop, Float[Array, "n flights"], int], BatchResult]
"""Flies loops and starts, the flight last, on so many threads."""

_programs: dict[Any, Program | NotCompiled] = {}


def find_engine(loops: ClosedLoop, vectors: Float[Array, "n flights"], terms: Terms) -> Engine:
    """Return what flies a batch: lanes, or where they cannot be compiled XLA, which one warning says.

    Parameters
    ----------
    loops : ClosedLoop
        Examples that differ in every number that may, the flight last.
    vectors : Float[Array, "n flights"]
        Their starts.
    terms : Terms

    Raises
    ------
    ConfigError
        `TETHERSHIP_ENGINE` names another engine.
    """
    return find_lanes(loops, vectors, terms) or by_xla(differing(loops), terms)


def find_lanes(loops: ClosedLoop, vectors: Float[Array, "n flights"], terms: Terms) -> Engine | None:
    """Return what flies a batch by lanes, None where there are none; arguments and errors as in `find_engine`."""
    if _asked() == "xla":
        return None
    program = _program(loops, vectors, terms)
    return by_lanes(program, terms) if isinstance(program, Program) else None


def _asked() -> str:
    """Return the engine that `TETHERSHIP_ENGINE` asks for."""
    asked = os.environ.get("TETHERSHIP_ENGINE") or "lanes"
    if asked not in ENGINES:
        raise ConfigError(f"TETHERSHIP_ENGINE is {shown(asked)}; set {' or '.join(ENGINES)}, or leave it out")
    return asked


def by_lanes(program: Program, terms: Terms) -> Engine:
    """Return an engine that flies by a program of `compile_flights`."""

    def fly(loops: ClosedLoop, vectors: Float[Array, "n flights"], threads: int) -> BatchResult:
        arrays = jax.tree.leaves(eqx.filter(loops, eqx.is_array))
        shared = jax.tree.leaves(eqx.filter(terms, eqx.is_array))
        return program(shared, (arrays, vectors), threads)

    return fly


_flown = eqx.filter_jit(fly_lanes)


def by_xla(differ: tuple[bool, ...], terms: Terms) -> Engine:
    """Return an engine that flies by XLA, for loops of which these arrays differ (`differing`)."""

    def fly(loops: ClosedLoop, vectors: Float[Array, "n flights"], threads: int) -> BatchResult:
        held, axes = hoisted(loops, differ)
        return _flown(held, axes, terms.stop, terms.limits, vectors, terms.time_limit, terms.rhythm)

    return fly


def _program(loops: ClosedLoop, vectors: Float[Array, "n flights"], terms: Terms) -> Program | NotCompiled:
    """Return the program of flights of this structure, made once a process, or why there is none."""
    leaves, rest = _parted((_first(loops), terms))
    key = (rest, tuple((leaf.shape, str(leaf.dtype)) for leaf in leaves))
    if key not in _programs:
        try:
            _programs[key] = compile_flights(loops, vectors, terms)
        except NotCompiled as error:
            warnings.warn(f"batches are flown by XLA, some ten times slower: {error}", TethershipWarning, stacklevel=3)
            _programs[key] = error
    return _programs[key]


def compile_flights(
    loops: ClosedLoop, vectors: Float[Array, "n flights"], terms: Terms, width: int | None = None
) -> Program:
    """Return the program that flies loops and starts of this structure to their ends.

    Parameters
    ----------
    loops, vectors, terms
        As in `find_engine`.
    width : int, optional
        Flights in a vector.

    Raises
    ------
    NotCompiled
        There is no compiler, or the plant uses a primitive that is not known.
    """
    one = _first(loops), vectors[..., 0]
    (loop_leaves, loop_rest), (term_leaves, term_rest) = _parted(one[0]), _parted(terms)

    def flight(shared: list[Array], own: tuple[list[Array], Array]) -> BatchResult:
        common, loop = _whole(shared, term_rest), _whole(own[0], loop_rest)
        return fly_to_its_end(loop, common.stop, common.limits, own[1], common.time_limit, common.rhythm)

    own = loop_leaves, one[1]
    width = width or widest()
    with contextlib.suppress(UnknownCodeError):  # a law of one's own is traced every time
        name = f"lanes-{key_of(f'flights over {width} lanes', (*one, terms))}"
        recipe = _read(load(name))
        program = Program(flight, term_leaves, own, width, _libraries(), recipe=recipe)
        if recipe is None:
            store(name, _written(program.recipe))
        return program
    return Program(flight, term_leaves, own, width, _libraries())


def _first(loops: ClosedLoop) -> ClosedLoop:
    """Return the first flight's loop: programs are the same for any number of flights."""
    return jax.tree.map(lambda leaf: leaf[..., 0] if eqx.is_array(leaf) else leaf, loops)


def _libraries() -> Path | None:
    """Return where compiled libraries are kept: beside other kept programs; None where nothing is kept."""
    programs = folder()
    return None if programs is None else programs.parent / "lanes"


def _written(recipe: Recipe) -> bytes:
    """Return a recipe as a file's content."""
    return json.dumps(recipe._replace(structure=structure_outline(recipe.structure))).encode()


def _read(content: bytes | None) -> Recipe | None:
    """Return the recipe of a file's content, None where there is none."""
    if content is None:
        return None
    source, statements, results, structure = json.loads(content)
    described = tuple((tuple(shape), kind) for shape, kind in results)
    return Recipe(source, statements, described, restored_structure(structure))


def _parted(tree: Any) -> tuple[list[Array], Any]:
    """Return the arrays of a PyTree, and the rest as something that tells structures apart."""
    arrays, rest = eqx.partition(tree, eqx.is_array)
    leaves, structure = jax.tree.flatten(arrays)
    others, other_structure = jax.tree.flatten(rest)
    return leaves, (structure, tuple(others), other_structure)


def _whole(leaves: Any, rest: Any) -> Any:
    """Undo `_parted`."""
    structure, others, other_structure = rest
    return eqx.combine(structure.unflatten(leaves), other_structure.unflatten(others))


def engine_name() -> str:
    """Return what flies batches here: "xla", or width, compiler and processor of lanes; two never mix in a campaign."""
    if _asked() == "xla":
        return "xla"
    try:
        return identity()
    except NotCompiled:
        return "xla"
