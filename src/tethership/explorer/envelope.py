"""The form of a callback's request: only what this app's own page says gets to Dash and to the callbacks.

Dash trusts its own page; a body of another form ends in an error of the server there. Depends on: errors.
"""

import json
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from tethership.errors import ConfigError

LONGEST_TEXT = 400
"""Characters of one text that was typed or chosen."""

MOST = 2000
"""Fields of a page at most."""

WILDCARDS = (["ALL"], ["MATCH"])
"""Parts of an id that stand for any word."""


def check_envelope(body: Any, callbacks: Mapping[str, Mapping[str, Any]]) -> None:
    """Check that a body asks for a callback of the app, as the app's page asks.

    Parameters
    ----------
    body : Any
        As read from JSON.
    callbacks : mapping
        By their outputs, as Dash keeps them.

    Raises
    ------
    ConfigError
        It does not; says which part.
    """
    _need(isinstance(body, dict), "a callback's request is an object")
    output = body.get("output")
    callback = callbacks.get(output) if isinstance(output, str) else None
    if callback is None or callback.get("inputs_state_indices") is None:
        raise ConfigError("there is no such callback; reload the page")
    said: set[str] = set()
    for part in ("inputs", "state"):
        said |= set(_places(part, body.get(part, []), callback[part]))
    _check_outputs(body.get("outputs"), callback["output"])
    changed = body.get("changedPropIds", [])
    _need(isinstance(changed, list) and len(changed) <= MOST, "changedPropIds is a list")
    _need(all(isinstance(one, str) and one in said for one in changed), "changedPropIds are inputs of the callback")


def _places(part: str, entries: Any, declared: list[dict[str, Any]]) -> Iterator[str]:
    """Check inputs or state against the callback's; yield their names as `changedPropIds` has them."""
    _need(isinstance(entries, list) and len(entries) == len(declared), f"{part} are those of the callback")
    for entry, wanted in zip(entries, declared, strict=True):
        name, form = wanted["property"], _id(wanted["id"])
        many = isinstance(form, dict) and ["ALL"] in form.values()
        _need(isinstance(entry, list) == many, f"{part} are those of the callback")
        found = entry if many else [entry]
        _need(len(found) <= MOST, f"there are more than {MOST} {part}")
        for one in found:
            _place(part, one, form)
            _need(one["property"] == name, f"{part} are those of the callback")
            fits = one.get("value") == one["id"] if name == "id" else _kind(form, name)(one.get("value"))
            _need(fits, f"the {name} of {wanted['id']} is of another kind")
            yield f"{_id_text(one['id'])}.{name}"


def _check_outputs(outputs: Any, declared: Any) -> None:
    """Check outputs against the callback's: one, or a list of them."""
    several = isinstance(declared, list)
    given, wanted = (outputs, declared) if several else ([outputs], [declared])
    _need(isinstance(given, list) and len(given) == len(wanted), "outputs are those of the callback")
    for one, place in zip(given, (place.to_dict() for place in wanted), strict=True):
        _place("outputs", one, _id(place["id"]))
        _need(one["property"].split("@")[0] == place["property"], "outputs are those of the callback")


def _place(part: str, entry: Any, form: Any) -> None:
    """Check that an entry names a place of the page, its id of a form."""
    _need(isinstance(entry, dict) and isinstance(entry.get("property"), str), f"{part} have id and property")
    given = entry.get("id")
    same = given == form
    if isinstance(form, dict) and isinstance(given, dict) and given.keys() == form.keys():
        same = all(_is_word(given[key]) if word in WILDCARDS else given[key] == word for key, word in form.items())
    _need(same, f"{part} are those of the callback")


def _id(written: str) -> Any:
    """Return an id as Dash declares it: a word, or a dictionary written as JSON."""
    return json.loads(written) if written.startswith("{") else written


def _id_text(given: Any) -> str:
    """Return an id as `changedPropIds` has it."""
    return given if isinstance(given, str) else json.dumps(given, sort_keys=True, separators=(",", ":"))


def _kind(form: Any, name: str) -> Callable[[Any], bool]:
    """Return what the value of a place must be."""
    by_place = {("layers", "value"): _are_texts, ("sas", "value"): _are_texts, ("shown", "data"): _is_mapping}
    by_name = {"n_clicks": _is_count, "n_intervals": _is_count}
    return by_place.get((form, name) if isinstance(form, str) else ("", name)) or by_name.get(name, _is_text)


def _is_count(value: Any) -> bool:
    return value is None or (isinstance(value, int) and not isinstance(value, bool))


def _is_text(value: Any) -> bool:
    """Return whether a value is nothing, or a text of people: not endless, no half of a character."""
    if value is None or not isinstance(value, str):
        return value is None
    return len(value) <= LONGEST_TEXT and not any("\ud800" <= character <= "\udfff" for character in value)


def _are_texts(value: Any) -> bool:
    return value is None or (isinstance(value, list) and len(value) <= MOST and all(map(_is_word, value)))


def _is_mapping(value: Any) -> bool:
    return value is None or (isinstance(value, dict) and all(map(_is_word, [*value, *value.values()])))


def _is_word(value: Any) -> bool:
    return value is not None and _is_text(value)


def _need(holds: bool, words: str) -> None:
    if not holds:
        raise ConfigError(f"{words}; reload the page")
