"""Code of one's own that a scenario names, imported and made: laws, parts, lines. Depends on: control, plant, physics.

A file that names code runs it only when told so: a scenario from elsewhere must not.
"""

import dataclasses
import importlib
import sys
from pathlib import Path
from typing import Any, TypeVar

import jax
import jax.numpy as jnp
import numpy as np

from tethership.control import AbstractLaw
from tethership.errors import ConfigError, failure, suggestion
from tethership.physics.cable import AbstractTensionLaw
from tethership.plant import AbstractPart, Seen, says
from tethership.scenario.own_schema import OwnCode, OwnLawConfig, OwnLine, OwnPartConfig
from tethership.scenario.schema import CableConfig
from tethership.spatial import Wrench

Own = TypeVar("Own")

_GIVEN: dict[str, type] = {}
"""Classes given in Python in this process, by `module:Class`: a notebook's or a console's is in no module's file."""


def make_law(config: OwnLawConfig) -> AbstractLaw:
    """Return a law of one's own with its numbers; raises ConfigError as `_made`."""
    return _made(config, f"law {config.name!r}", AbstractLaw, "tethership.AbstractLaw")


def make_part(config: OwnPartConfig, cables: int) -> AbstractPart:
    """Return a part of one's own with its numbers, for a ship on so many cables.

    Raises
    ------
    ConfigError
        As for `_made`, or its states are no names with units, or it has states and does not say how they change.
    """
    what = f"part {config.name!r}"
    part = _made(config, what, AbstractPart, "tethership.AbstractPart")
    check_part(part, cables, what, config.model)
    return part


def make_line(config: OwnLine, cable: CableConfig) -> AbstractTensionLaw:
    """Return a line of one's own with its numbers and those of its cable; raises ConfigError as `_made`.

    Parameters
    ----------
    config : OwnLine
        Class and numbers, in units of the class's own.
    cable : CableConfig
        Gives `stiffness` [N], `joint_start` and `joint_end` [-], `diameter` [m] and `linear_density` [kg/m], each where
        the class has a field of that name.
    """
    what = f"line of {cable.name!r}"
    kind = _kind(config, what, AbstractTensionLaw, "tethership.physics.cable.AbstractTensionLaw")
    known = ("stiffness", "joint_start", "joint_end", "diameter", "linear_density")
    wanted = {field.name for field in dataclasses.fields(kind)}
    return _with_numbers(kind, {**{k: getattr(cable, k) for k in known if k in wanted}, **config.numbers}, config, what)


def check_part(part: AbstractPart, cables: int, what: str, model: str) -> None:
    """Raise ConfigError where a part's states are not named, or nothing is said of how they rest and change."""
    states = part.states()
    named = isinstance(states, tuple | list) and all(
        isinstance(pair, tuple | list) and len(pair) == 2 and all(isinstance(word, str) for word in pair)
        for pair in states
    )
    if not named:
        raise ConfigError(f"{what}: {model}.states() gives {states!r}; give names with SI units, e.g. (('fill', '1'),)")
    if len({name for name, _ in states}) < len(states):
        raise ConfigError(f"{what}: {model}.states() names a state twice; give each its own name")
    lacking = [method for method in ("rest", "rate") if states and not says(part, method)]
    if lacking:
        raise ConfigError(f"{what}: {model} has states and no {' and no '.join(lacking)}; say how they rest and change")
    _try(part, len(states), cables, what, model)


def _try(part: AbstractPart, count: int, cables: int, what: str, model: str) -> None:
    """Raise ConfigError where a method of a part fails, or returns what is of another form; nothing is computed."""
    now, own, seen = jnp.zeros(()), jnp.zeros(count), Seen.example(cables)

    def tried(method: str, *given: Any) -> Any:
        try:
            return jax.eval_shape(getattr(part, method), *given)
        except Exception as error:  # whatever code of one's own does
            raise ConfigError(f"{what}: {model}.{method} fails: {failure(error)}") from error

    for method, given in (("rest", (seen,)), ("rate", (now, own, seen))):
        shape = getattr(tried(method, *given), "shape", None)
        if shape != (count,):
            raise ConfigError(f"{what}: {model}.{method} gives shape {shape}; give ({count},), one a state")
    load, told = (tried(method, now, own, seen) for method in ("wrench", "reading"))
    if load is not None and not (
        isinstance(load, Wrench) and all(jnp.shape(each) == (3,) for each in (load.force, load.moment))
    ):
        raise ConfigError(f"{what}: {model}.wrench gives no Wrench of three and three components; give ts.Wrench(f, m)")
    if told is not None and getattr(told, "shape", None) != ():
        raise ConfigError(f"{what}: {model}.reading gives shape {getattr(told, 'shape', None)}; give one number, ()")


def as_entry(name: str, part: AbstractPart) -> dict[str, Any]:
    """Return a part that is given in Python as a file would name it: its class, and its fields as numbers.

    Raises
    ------
    ConfigError
        It is no part, its class stands inside a function, or a field is no number or list of numbers.
    """
    kind = type(part)
    if not isinstance(part, AbstractPart):
        raise ConfigError(f"part {name!r}: {kind.__name__} is no part; make it a subclass of tethership.AbstractPart")
    if "." in kind.__qualname__:
        raise ConfigError(
            f"part {name!r}: {kind.__qualname__} stands inside something else; define it at the top of its module"
        )
    numbers = {}
    for field in dataclasses.fields(part):
        value = getattr(part, field.name)
        try:
            array = np.asarray(value, dtype=float)
        except (TypeError, ValueError):
            array = np.zeros((0, 0))
        if array.ndim > 1 or array.dtype.kind != "f" or not np.isfinite(array).all() or isinstance(value, str | bool):
            raise ConfigError(
                f"part {name!r}: its field {field.name!r} is no finite number or list of numbers; give one"
            )
        numbers[field.name] = array.tolist()
    model = f"{kind.__module__}:{kind.__qualname__}"
    _GIVEN[model] = kind
    return {"name": name, "model": model, "numbers": numbers}


def _made(config: OwnCode, what: str, base: type[Own], base_name: str) -> Own:
    """Return code of one's own with its numbers.

    Raises
    ------
    ConfigError
        Its class cannot be imported, is of another kind, or does not take these numbers.
    """
    return _with_numbers(_kind(config, what, base, base_name), config.numbers, config, what)


def _with_numbers(kind: Any, numbers: dict[str, Any], config: OwnCode, what: str) -> Any:
    """Return an object of a class with its numbers as arrays."""
    fields = {field.name: field for field in dataclasses.fields(kind)}
    needed = [name for name, field in fields.items() if _needed(field) and name not in numbers]
    unknown = [name for name in numbers if name not in fields]
    if needed or unknown:
        said = f"it lacks {', '.join(needed)}"
        if not needed:
            said = f"it has no {unknown[0]!r}{suggestion(unknown[0], fields)}".rstrip(".")
        there = f"its fields: {', '.join(fields) or 'none'}"
        raise ConfigError(f"{what}: {config.model} does not take these numbers: {said}; {there}")
    try:
        return kind(**{name: jnp.asarray(value) for name, value in numbers.items()})
    except Exception as error:  # whatever a check of its own says
        raise ConfigError(f"{what}: {config.model} does not take these numbers: {failure(error)}") from error


def _needed(field: Any) -> bool:
    """Return whether a field has no default."""
    return field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING


def _kind(config: OwnCode, what: str, base: type, base_name: str) -> Any:
    """Return the class that an entry names."""
    kind = _GIVEN.get(config.model) or _imported(config.model, what)
    if not (isinstance(kind, type) and issubclass(kind, base)):
        raise ConfigError(f"{what}: {config.model} is no {what.split()[0]}; make it a subclass of {base_name}")
    return kind


def _imported(model: str, what: str) -> Any:
    """Return what a `module:Class` names."""
    module, _, name = model.partition(":")
    try:
        found = importlib.import_module(module)
    except Exception as error:
        lost = isinstance(error, ModuleNotFoundError) and module.startswith(error.name or module)
        cure = "it must lie beside the scenario's file or on Python's path" if lost else "mend it"
        raise ConfigError(f"{what}: {module} cannot be imported ({failure(error)}); {cure}") from error
    if not hasattr(found, name):
        raise ConfigError(f"{what}: {module} has no {name!r}{suggestion(name, dir(found))}")
    return getattr(found, name)


def find_beside(file: str) -> None:
    """Let modules beside a scenario's file be imported; beside a packaged one those of the working folder."""
    folder = str(Path(file).resolve().parent if file.endswith(".toml") else Path.cwd())
    if folder not in sys.path:
        sys.path.append(folder)
