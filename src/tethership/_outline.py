"""Structures of arguments and results as plain data: what a kept program is known by, and what it returns.

Depends on: jax. Only what this package and the libraries below it define can be written down: a class of one's own may
change its code and keep its name.
"""

import importlib
from typing import Any

import jax

KNOWN = ("builtins", "tethership", "equinox", "jax", "jaxlib", "numpy", "diffrax", "optimistix", "lineax")
"""Packages whose code is known by a digest or a version."""

PLAIN = (bool, int, float, str)
"""Kinds of values that are written as they are."""

_JOINED: Any = getattr(
    jax.tree_util.PyTreeDef,
    "from_node_data_and_children",
    getattr(jax.tree_util.PyTreeDef, "make_from_node_data_and_children", None),  # its name in earlier versions
)

Outline = Any
"""What JSON can hold."""

Structure = Any
"""A structure, `jax.tree_util.PyTreeDef`."""


class UnknownCodeError(Exception):
    """A structure has code, or a value, of which nobody knows whether it is the same in the next process."""


def outline(value: Any) -> Outline:
    """Return a value as plain data: its structure, then its leaves; arrays must have been taken out.

    Raises
    ------
    UnknownCodeError
        A class or a value in it is none of those that can be written.
    """
    leaves, structure = jax.tree.flatten(value)
    return [structure_outline(structure), [_written(leaf) for leaf in leaves]]


def restored(written: Outline) -> Any:
    """Return the value of which `outline` was taken."""
    structure, leaves = written
    return jax.tree.unflatten(restored_structure(structure), [_read(leaf) for leaf in leaves])


def structure_outline(structure: Structure) -> Outline:
    """Return a structure as plain data: of each node its class, what the class adds, and its children; "*" for leaves.

    Raises
    ------
    UnknownCodeError
        As `outline`.
    """
    node = structure.node_data()
    if node is None:
        return "*"
    kind, more = node
    added = None if more is None else outline(more)
    return [name_of(kind), added, [structure_outline(child) for child in structure.children()]]


def restored_structure(written: Outline) -> Structure:
    """Return the structure of which `structure_outline` was taken."""
    if written == "*":
        return jax.tree.structure(0)
    name, added, children = written
    if name == "builtins:NoneType":
        return jax.tree.structure(None)
    node = named(name), None if added is None else restored(added)
    return _JOINED(jax.tree_util.default_registry, node, [restored_structure(child) for child in children])


def name_of(thing: Any) -> str:
    """Return `module:name` of a class or function of a known package that is found there.

    Raises
    ------
    UnknownCodeError
        It is of another package, or made anew in every process.
    """
    name = f"{getattr(thing, '__module__', None)}:{getattr(thing, '__qualname__', None)}"
    if thing is not type(None) and named(name) is not thing:
        raise UnknownCodeError(name)
    return name


def named(name: str) -> Any:
    """Return what `module:name` says; the module may be one that was not used yet."""
    module, _, path = name.partition(":")
    if module.partition(".")[0] not in KNOWN:
        raise UnknownCodeError(name)
    try:
        found: Any = importlib.import_module(module)
    except ImportError as error:
        raise UnknownCodeError(name) from error
    for part in path.split("."):
        found = getattr(found, part, None)
    return found


def _written(leaf: Any) -> Outline:
    """Return a value that is no array as plain data."""
    if type(leaf) not in PLAIN:
        return ["name", name_of(leaf)]
    return ["float", leaf.hex()] if isinstance(leaf, float) else [type(leaf).__name__, leaf]


def _read(written: Outline) -> Any:
    """Return the value of which `_written` was taken."""
    kind, value = written
    match kind:
        case "name":
            return named(value)
        case "float":
            return float.fromhex(value)
        case _:
            return value
