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
    for step in path[:-1]:
        place = _enter(place, step, dotted, origin)
    if path and last.isascii() and last.isdigit() and _is_vector(place, path[-1]):
        _set_component(place[path[-1]], last, value, f"{origin}: {shown(dotted)}")
        return
    for step in path[-1:]:
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


def _is_vector(table: Any, key: str) -> bool:
    """Return whether a table's entry is a quantity that is a list of numbers."""
    entry = table.get(key) if isinstance(table, dict) else None
    return isinstance(entry, dict) and isinstance(entry.get("value"), list) and "unit" in entry


def _set_component(entry: dict[str, Any], last: str, value: Any, what: str) -> None:
    """Set one component of a vector, in the vector's own unit."""
    place, numbers = int(last), list(entry["value"])
    if len(last) > 8 or place >= len(numbers) or not all(_is_number(number) for number in numbers):
        raise ConfigError(f"{what}: there is no component {last}; they are 0 to {len(numbers) - 1}")
    if not isinstance(value, dict):
        value = {"value": value, "unit": SI_UNIT}
    if not isinstance(value.get("unit"), str):
        raise ConfigError(f"{what}: the unit is missing or no text; give a number with its unit, e.g. 1.5m")
    if not _is_number(value.get("value")) or isinstance(value["value"], list | tuple):
        raise ConfigError(f"{what}: {shown(value.get('value'))} is no number; give one, e.g. 1.5 or 1.5m")
    try:
        numbers[place] = in_unit(value["value"], value["unit"], entry["unit"])
    except ValueError as error:
        raise ConfigError(f"{what}: {error}") from error
    entry["value"] = numbers


def is_share(path: Sequence[str]) -> bool:
    """Return whether the values under a path are a law's shares: plain numbers without a unit."""
    return path[:1] == ["control"] and (path[-1].endswith("share") or path[-1] == "numbers")


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
