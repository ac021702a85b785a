"""What flies a batch: a program compiled over lanes of flights, or XLA's. Depends on: lanes, simulation.

One program flies all flights of a structure, whatever differs between them: every number is each flight's own. XLA's
program, the reference, holds once what all share.
"""

import os
import warnings
from collections.abc import Callable
from typing import Any, NamedTuple

import equinox as eqx
import jax
import platformdirs
from jaxtyping import Array, Float

from tethership.errors import ConfigError, shown
from tethership.lanes import NotCompiled, Program, identity
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
    asked = os.environ.get("TETHERSHIP_ENGINE") or "lanes"
    if asked not in ENGINES:
        raise ConfigError(f"TETHERSHIP_ENGINE is {shown(asked)}; set {' or '.join(ENGINES)}, or leave it out")
    if asked == "lanes":
        program = _program(loops, vectors, terms)
        if isinstance(program, Program):
            return _by_lanes(program, terms)
    return _by_xla(differing(loops), terms)


def _by_lanes(program: Program, terms: Terms) -> Engine:
    def fly(loops: ClosedLoop, vectors: Float[Array, "n flights"], threads: int) -> BatchResult:
        arrays = jax.tree.leaves(eqx.filter(loops, eqx.is_array))
        shared = jax.tree.leaves(eqx.filter(terms, eqx.is_array))
        return program(shared, (arrays, vectors), threads)

    return fly


_flown = eqx.filter_jit(fly_lanes)


def _by_xla(differ: tuple[bool, ...], terms: Terms) -> Engine:
    def fly(loops: ClosedLoop, vectors: Float[Array, "n flights"], threads: int) -> BatchResult:
        held, axes = hoisted(loops, differ)
        return _flown(held, axes, terms.stop, terms.limits, vectors, terms.time_limit, terms.rhythm)

    return fly


def _program(loops: ClosedLoop, vectors: Float[Array, "n flights"], terms: Terms) -> Program | NotCompiled:
    """Return the program of flights of this structure, made once a process, or why there is none."""
    (loop_leaves, loop_rest), (term_leaves, term_rest) = (_parted(tree) for tree in (loops, terms))
    shapes = tuple((leaf.shape[:-1], str(leaf.dtype)) for leaf in loop_leaves)
    key = (loop_rest, term_rest, shapes, tuple(leaf.shape for leaf in term_leaves))
    if key not in _programs:
        _programs[key] = _made(loop_leaves, loop_rest, vectors, term_leaves, term_rest)
    return _programs[key]


def _made(loop_leaves: Any, loop_rest: Any, vectors: Any, term_leaves: Any, term_rest: Any) -> Program | NotCompiled:
    def flight(shared: list[Array], own: tuple[list[Array], Array]) -> BatchResult:
        terms, loop = _whole(shared, term_rest), _whole(own[0], loop_rest)
        return fly_to_its_end(loop, terms.stop, terms.limits, own[1], terms.time_limit, terms.rhythm)

    own = jax.tree.map(lambda leaf: leaf[..., 0], (loop_leaves, vectors))
    try:
        return Program(flight, term_leaves, own, folder=platformdirs.user_cache_path("tethership") / "lanes")
    except NotCompiled as error:
        warnings.warn(f"batches are flown by XLA, some ten times slower: {error}", stacklevel=2)
        return error


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
    if (os.environ.get("TETHERSHIP_ENGINE") or "lanes") == "xla":
        return "xla"
    try:
        return identity()
    except NotCompiled:
        return "xla"
