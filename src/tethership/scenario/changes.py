"""Changing single values of a document by their dotted names. Depends on: scenario.quantity, scenario.reading."""

import copy
from collections.abc import Sequence
from typing import Any

from tethership.errors import ConfigError, shown
from tethership.scenario.quantity import SI_UNIT, in_unit
from tethership.scenario.reading import check_plain

Document = dict[str, Any]
"""A TOML file as read."""

EVERY = "*"
"""Step that stands for all items of a list."""

MOST_STEPS = 12
"""Steps of a dotted name before its last."""


def change(document: Document, dotted: str, value: Any, origin: str) -> None:
    """Set one value of a document in place, by its dotted name; raises ConfigError where there is no such place.

    A `*` stands for all items of a list: `vehicle.thrusters.*.lag`. A last step that is a number is a component of a
    vector: `cables.nose.anchor.2`.
    """
    path = dotted.split(".")
    if len(path) > MOST_STEPS + 1:
        raise ConfigError(f"{origin}: {shown(dotted)} has {len(path)} steps; no value lies that deep")
    check_plain(value, f"{origin}: {shown(dotted)}")
    for name in _expanded(document, path, dotted, origin):
        _change(document, name, copy.deepcopy(value), origin)  # items that share a table would move together


def _expanded(document: Document, path: list[str], dotted: str, origin: str) -> list[str]:
    """Return the dotted names that a name with `*` stands for, or the name itself."""
    if EVERY not in path:
        return [dotted]
    here = path.index(EVERY)
    place: Any = document
    for step in path[:here]:
        if isinstance(place, dict) and step not in place:
            place = None
            break
        place = _enter(place, step, dotted, origin)
    if not isinstance(place, list) or not place:
        what = f"{'.'.join(path[:here])} is {'an empty list' if isinstance(place, list) else 'no list'}"
        raise ConfigError(f"{origin}: {shown(dotted)}: {what}; * stands for the items of one")
    names = [".".join([*path[:here], str(i), *path[here + 1 :]]) for i in range(len(place))]
    return [name for first in names for name in _expanded(document, first.split("."), first, origin)]


def _change(document: Document, dotted: str, value: Any, origin: str) -> None:
    """Set one value by a name without `*`."""
    *path, last = dotted.split(".")
    place: Any = document
    for i, step in enumerate(path):
        rest = [*path[i + 1 :], last]
        if _has_components(place, step, path[:i]) and all(_is_digits(number) for number in rest):
            place[step] = _with_component(place[step], rest, value, f"{origin}: {shown(dotted)}")
            return
        place = _enter(place, step, dotted, origin)
    if isinstance(place, list):
        place, last = _enter(place, last, dotted, origin), ""
    if not isinstance(place, dict):
        raise ConfigError(f"{origin}: {shown(dotted)} is no value that can be changed")
    if _is_number(value) and not is_share(path):
        value = {"value": list(value) if isinstance(value, tuple) else value, "unit": SI_UNIT}
    elif dotted.startswith("vehicle.") and isinstance(value, dict) and value.keys() == {"value", "unit"}:
        value = {**value, "source": "a change"}  # vehicles ask for a source; a change is one
    place[last] = value


def _is_digits(step: str) -> bool:
    """Return whether a step is a place in a list."""
    return step.isascii() and step.isdigit()


def _has_components(table: Any, key: str, path: Sequence[str]) -> bool:
    """Return whether a table's entry is a list of numbers, or of lists of them: a quantity, or a number of own code."""
    entry = table.get(key) if isinstance(table, dict) else None
    if isinstance(entry, list):
        return bool(path) and is_share(path) and _is_number(entry)
    return isinstance(entry, dict) and isinstance(entry.get("value"), list) and "unit" in entry


def _with_component(entry: Any, places: Sequence[str], value: Any, what: str) -> Any:
    """Return a vector or matrix with one component set, in its own unit."""
    if isinstance(entry, list):
        return _with_number(entry, places, _component(value, SI_UNIT, what), what)
    return {**entry, "value": _with_number(entry["value"], places, _component(value, entry["unit"], what), what)}


def _component(value: Any, unit: str, what: str) -> float:
    """Return a component in a unit [that unit]; without a unit of its own it is in SI."""
    if not isinstance(value, dict):
        value = {"value": value, "unit": SI_UNIT}
    if not isinstance(value.get("unit"), str):
        raise ConfigError(f"{what}: the unit is missing or no text; give a number with its unit, e.g. 1.5m")
    if not _is_number(value.get("value")) or isinstance(value["value"], list | tuple):
        raise ConfigError(f"{what}: {shown(value.get('value'))} is no number; give one, e.g. 1.5 or 1.5m")
    try:
        return in_unit(value["value"], value["unit"], unit)
    except ValueError as error:
        raise ConfigError(f"{what}: {error}") from error


def _with_number(numbers: Any, places: Sequence[str], value: float, what: str) -> Any:
    """Return a list of numbers, or of lists of them, with one of them replaced."""
    if not places:
        if isinstance(numbers, list):
            raise ConfigError(f"{what}: it is a list; name one of its items, 0 to {len(numbers) - 1}")
        return value
    first, *rest = places
    if not isinstance(numbers, list) or len(first) > 8 or int(first) >= len(numbers) or not _is_number(numbers):
        last = f"they are 0 to {len(numbers) - 1}" if isinstance(numbers, list) else "it is a number"
        raise ConfigError(f"{what}: there is no component {first}; {last}")
    return [_with_number(number, rest, value, what) if i == int(first) else number for i, number in enumerate(numbers)]


def is_share(path: Sequence[str]) -> bool:
    """Return whether the values under a path are plain numbers without a unit: a law's shares, numbers of own code."""
    return list(path[-1:]) == ["numbers"] or (list(path[:1]) == ["control"] and path[-1].endswith("share"))


def _is_number(value: Any) -> bool:
    """Return whether a value is a number, or a list of numbers or of lists of them."""
    if isinstance(value, list | tuple):
        return len(value) > 0 and all(_is_number(item) for item in value)
    return isinstance(value, int | float) and not isinstance(value, bool)


def _enter(place: Any, step: str, dotted: str, origin: str) -> Any:
    """Return the table or list item called `step`."""
    if isinstance(place, list):
        named = [item for item in place if isinstance(item, dict) and item.get("name") == step]
        if named:
            return named[0]
        if step.isascii() and step.isdigit() and len(step) < 9 and int(step) < len(place):
            return place[int(step)]
        names = [str(item["name"]) for item in place if isinstance(item, dict) and "name" in item]
        there = f"; there are {', '.join(names)}" if names else ""
        raise ConfigError(f"{origin}: {shown(dotted)}: no item {shown(step)} in a list of {len(place)}{there}")
    if isinstance(place, dict):
        return place.setdefault(step, {})
    raise ConfigError(f"{origin}: {shown(dotted)}: {shown(step)} is inside a value, not a table")
