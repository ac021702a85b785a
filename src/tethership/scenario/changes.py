"""Changing single values of a document by their dotted names. Depends on: scenario.quantity, errors."""

from typing import Any

from tethership.errors import ConfigError
from tethership.scenario.quantity import SI_UNIT

Document = dict[str, Any]
"""A TOML file as read."""


def change(document: Document, dotted: str, value: Any, origin: str) -> None:
    """Set one value of a document in place, by its dotted name."""
    *path, last = dotted.split(".")
    place: Any = document
    for step in path:
        place = _enter(place, step, dotted, origin)
    if isinstance(place, list):
        place, last = _enter(place, last, dotted, origin), ""
    if not isinstance(place, dict):
        raise ConfigError(f"{origin}: {dotted!r} is no value that can be changed")
    if _is_number(value) and not any(step.endswith("share") for step in path):
        value = {"value": list(value) if isinstance(value, tuple) else value, "unit": SI_UNIT}
    elif dotted.startswith("vehicle.") and isinstance(value, dict) and value.keys() == {"value", "unit"}:
        value = {**value, "source": "a change"}  # vehicles ask for a source; a change is one
    place[last] = value


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
        if step.isdigit() and int(step) < len(place):
            return place[int(step)]
        names = [str(item["name"]) for item in place if isinstance(item, dict) and "name" in item]
        there = f"; there are {', '.join(names)}" if names else ""
        raise ConfigError(f"{origin}: {dotted!r}: no item {step!r} in a list of {len(place)}{there}")
    if isinstance(place, dict):
        return place.setdefault(step, {})
    raise ConfigError(f"{origin}: {dotted!r}: {step!r} is inside a value, not a table")
