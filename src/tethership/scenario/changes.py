"""Changing single values of a document by their dotted names. Depends on: scenario.quantity, scenario.reading."""

from collections.abc import Sequence
from typing import Any

from tethership.errors import ConfigError, shown
from tethership.scenario.quantity import SI_UNIT
from tethership.scenario.reading import check_plain

Document = dict[str, Any]
"""A TOML file as read."""

MOST_STEPS = 12
"""Steps of a dotted name before its last."""


def change(document: Document, dotted: str, value: Any, origin: str) -> None:
    """Set one value of a document in place, by its dotted name; raises ConfigError where there is no such place."""
    *path, last = dotted.split(".")
    if len(path) > MOST_STEPS:
        raise ConfigError(f"{origin}: {shown(dotted)} has {len(path) + 1} steps; no value lies that deep")
    check_plain(value, f"{origin}: {shown(dotted)}")
    place: Any = document
    for step in path:
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


def is_share(path: Sequence[str]) -> bool:
    """Return whether the values under a path are a law's shares: plain numbers without a unit."""
    return path[:1] == ["control"] and path[-1].endswith("share")


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
