"""Programs that are traced once and kept: a new process neither traces nor lowers what an earlier one has.

Depends on: jax, equinox. `kept` stands where `equinox.filter_jit` would. Beside JAX's compiled programs it keeps the
program from which they are compiled (`jax.export`), under a digest of all that went into it: this package's files, the
versions of the libraries, JAX's settings, the function, and structure, shapes and types of what it was given. Whatever
cannot be kept (a class of one's own in it, a host callback, a transformation around it) is traced as ever.
"""

import functools
import hashlib
import importlib.metadata
import importlib.util
import json
import sys
from collections.abc import Callable, Hashable, Iterable
from pathlib import Path
from typing import Any, Generic, NamedTuple, TypeVar

import equinox as eqx
import jax
import jax.core
import jax.export
import jax.extend.core
from jax.interpreters import mlir

from tethership import _programs
from tethership._outline import (
    Outline,
    Structure,
    UnknownCodeError,
    named,
    outline,
    restored,
    restored_structure,
    structure_outline,
)

LIBRARIES = ("jax", "jaxlib", "equinox", "diffrax", "optimistix", "lineax", "numpy", "jaxtyping")
"""Whose versions a program depends on."""

PASSING = ("jax_enable_x64", "jax_default_matmul_precision", "jax_numpy_dtype_promotion")
"""Settings that may change within a process, and with them the program."""

TRACED = (
    "jax_disable_jit",
    "jax_debug_nans",
    "jax_debug_infs",
    "jax_check_tracer_leaks",
    "jax_enable_checks",
    "jax_default_device",
)
"""Settings by which somebody looks into programs, or has them run elsewhere: with any of them nothing kept is used."""

_CALL = jax.extend.core.Primitive("kept_program")
"""The call of an exported program. JAX binds what its own such call returns to a device: the next compiles anew."""

_CALL.multiple_results = True
_CALL.def_abstract_eval(lambda *given, exported: exported.out_avals)
mlir.register_lowering(_CALL, mlir.lower_fun(lambda *given, exported: exported.call(*given), multiple_results=True))

Result = TypeVar("Result")


def source_digest(root: Path = Path(__file__).parent) -> str:
    """Return a digest of all files of the package: code, vehicles, scenarios, fits."""
    digest = hashlib.sha256()
    for path in sorted(root.rglob("*")):
        if path.suffix in (".py", ".toml", ".json", ".css", ".js", ".html", ".h") and path.is_file():
            digest.update(str(path.relative_to(root)).encode())
            digest.update(path.read_bytes())
    return digest.hexdigest()


_SOURCE = source_digest()
"""Of the files as they were when this process began: who changes them later keeps nothing until the next start."""


class _Program(NamedTuple):
    """A kept program, and what its results make up."""

    call: Callable[..., list[jax.Array]]
    structure: Structure
    others: tuple[Any, ...]
    are_arrays: tuple[bool, ...]

    def __call__(self, arrays: Iterable[Any]) -> Any:
        found, others = iter(self.call(*arrays) if any(self.are_arrays) else ()), iter(self.others)
        return jax.tree.unflatten(self.structure, [next(found if array else others) for array in self.are_arrays])


class Kept(Generic[Result]):
    """A function whose traced programs are kept; made by `kept`."""

    __name__: str
    __qualname__: str
    __wrapped__: Callable[..., Result]

    def __init__(self, function: Callable[..., Result]) -> None:
        functools.update_wrapper(self, function)
        self._traced = eqx.filter_jit(function)
        self._programs: dict[Hashable, _Program | None] = {}

    def __call__(self, *args: Any, **kwargs: Any) -> Result:
        leaves, structure = jax.tree.flatten((args, kwargs))
        if _is_elsewhere() or any(isinstance(leaf, jax.core.Tracer) for leaf in leaves):
            return self._traced(*args, **kwargs)
        form = structure, tuple(map(_form, leaves)), tuple(getattr(jax.config, name) for name in PASSING)
        if form not in self._programs:
            self._programs[form] = self._found(leaves, structure)
        program = self._programs[form]
        if program is None:
            return self._traced(*args, **kwargs)
        try:
            return program([leaf for leaf in leaves if eqx.is_array(leaf)])
        except ValueError:  # the arguments lie on another device than the program is for
            self._programs[form] = None
            return self._traced(*args, **kwargs)

    def _found(self, leaves: list[Any], structure: Structure) -> _Program | None:
        """Return the program for what is given, from the folder or made; None where it cannot be kept."""
        if _programs.folder() is None or not _can_write():
            return None
        try:
            name = f"{self.__name__.strip('_')}-{_key(self, leaves, structure)}"
            return self._read(_programs.load(name)) or self._made(name, leaves, structure)
        except Exception:  # whatever stands against keeping it: traced as ever, a mistake is told there
            return None

    def _read(self, content: bytes | None) -> _Program | None:
        """Return the program of a file's content; None where there is none, or it cannot be read."""
        if content is None:
            return None
        head, _, body = content.partition(b"\n")
        try:
            exported = jax.export.deserialize(bytearray(body))
            call = functools.partial(_CALL.bind, exported=exported)
            structure, others, are_arrays = json.loads(head)
            return _Program(
                _named(call, self.__name__), restored_structure(structure), restored(others), tuple(are_arrays)
            )
        except Exception:  # of another version of its format, which no digest tells
            return None

    def _made(self, name: str, leaves: list[Any], structure: Structure) -> _Program | None:
        """Trace and lower, keep what comes of it, and return it as the next process will read it."""
        places = [i for i, leaf in enumerate(leaves) if eqx.is_array(leaf)]
        result: Outline = []

        def flat(*arrays: Any) -> list[Any]:
            given = list(leaves)
            for i, array in zip(places, arrays, strict=True):
                given[i] = array
            args, kwargs = jax.tree.unflatten(structure, given)
            found, kind = jax.tree.flatten(self.__wrapped__(*args, **kwargs))
            are_arrays = [eqx.is_array(leaf) for leaf in found]
            others = tuple(leaf for leaf in found if not eqx.is_array(leaf))
            result[:] = structure_outline(kind), outline(others), are_arrays
            return [leaf for leaf in found if eqx.is_array(leaf)]

        program = jax.export.export(jax.jit(_named(flat, self.__name__)))(*(leaves[i] for i in places))
        content = json.dumps(result).encode() + b"\n" + bytes(program.serialize())
        if source_digest() == _SOURCE:
            _programs.store(name, content)
        return self._read(content)


def kept(function: Callable[..., Result]) -> Kept[Result]:
    """Return a function compiled as by `equinox.filter_jit`, whose traced programs are kept between processes.

    Parameters
    ----------
    function : callable
        At the top of a module of this package; what it does follows from its arguments and the package's files alone.
    """
    return Kept(function)


def _named(call: Callable[..., Any], name: str) -> Any:
    """Return a function of arrays, compiled under a name by which it is found in JAX's cache and logs."""

    def program(*arrays: Any) -> Any:
        return call(*arrays)

    program.__name__ = program.__qualname__ = name
    return jax.jit(program)


def _is_elsewhere() -> bool:
    """Return whether settings ask for the traced function."""
    return any(getattr(jax.config, name) for name in TRACED)


def _form(leaf: Any) -> Hashable:
    """Return what of an argument makes another program."""
    if not eqx.is_array(leaf):
        return type(leaf), leaf
    return leaf.shape, leaf.dtype, getattr(leaf, "weak_type", False)


def _key(kept: Kept, leaves: list[Any], structure: Structure) -> str:
    """Return the digest of all that a program depends on; raises UnknownCodeError."""
    name = f"{kept.__module__}:{kept.__qualname__}"
    if not Path(__file__).is_file() or named(name) not in (kept, kept.__wrapped__):
        raise UnknownCodeError(name)
    return key_of(name, jax.tree.unflatten(structure, leaves))


def key_of(name: str, tree: Any) -> str:
    """Return a digest of all that something made of a PyTree, for its structure and shapes, depends on.

    Raises
    ------
    UnknownCodeError
        The structure has code that may change and keep its name.
    """
    leaves, structure = jax.tree.flatten(tree)
    arrays = [_described(leaf) for leaf in leaves if eqx.is_array(leaf)]
    others = outline(tuple(None if eqx.is_array(leaf) else leaf for leaf in leaves))
    whole = [_world(), name, structure_outline(structure), arrays, others]
    return hashlib.sha256(json.dumps(whole).encode()).hexdigest()[:32]


def _described(array: Any) -> list[Any]:
    """Return shape and type of an array."""
    kind = jax.typeof(array)
    return [list(kind.shape), str(kind.dtype), bool(kind.weak_type)]


def _world() -> list[Any]:
    """Return what all programs of a process depend on."""
    settings = {name: repr(getattr(jax.config, name, None)) for name in sorted(jax.config.values)}
    checks = getattr(sys.modules.get("equinox._errors"), "EQX_ON_ERROR", None)
    return [_SOURCE, _versions(), jax.default_backend(), checks, settings]


@functools.cache
def _can_write() -> bool:
    """Return whether what `jax.export` needs to write programs is there."""
    return importlib.util.find_spec("flatbuffers") is not None


@functools.cache
def _versions() -> dict[str, str]:
    """Return the versions of the libraries."""
    return {name: importlib.metadata.version(name) for name in LIBRARIES}
