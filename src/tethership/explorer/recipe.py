"""The command and the file that give the numbers of a view. Depends on: explorer.choice.

Both are the scenario and its changes as `load_scenario` takes them, written for a shell and as TOML.
"""

import contextlib
import json
import shlex
import tomllib
from collections.abc import Mapping
from typing import Any, NamedTuple

import tomlkit
from tomlkit import TOMLDocument
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import AoT, Table

from tethership.errors import ConfigError
from tethership.explorer.choice import Choice
from tethership.scenario import Scenario, list_parameters

REMARK = "made in tethership explore; they win over what stands elsewhere in this file"


class Span(NamedTuple):
    """What a root locus runs over: a parameter between two typed numbers.

    Attributes
    ----------
    name : str
        Dotted name.
    low, high : tuple of float and str
        Ends, each a number with its unit as typed, e.g. 6 and m/s for a wind [m/s].
    points : int
    si_unit : str
        Unit in which a bare number is taken.
    """

    name: str
    low: tuple[float, str]
    high: tuple[float, str]
    points: int
    si_unit: str

    @property
    def text(self) -> str:
        """As `--over` takes it."""
        low, high = (_number(value, unit, self.si_unit) for value, unit in (self.low, self.high))
        return f"{self.name}={low}:{high}:{self.points}"


def command(verb: str, scenario: str, choice: Choice, span: Span | None = None) -> str:
    """Return the command that gives a view's numbers.

    Parameters
    ----------
    verb : str
        trim, sweep, modes or dock.
    scenario : str
        Packaged name or path, as the command takes it.
    choice : Choice
        What was changed.
    span : Span, optional
        Of a sweep.
    """
    words = ["tethership", verb, scenario]
    if span is not None:
        words += ["--over", span.text]
    for key, value in choice.values.items():
        words += ["--set", f"{key}={_flag(value)}"]
    return " ".join(shlex.quote(word) for word in words)


def file_text(base: Scenario, text: str, choice: Choice) -> str:
    """Return a scenario file with what was changed in its table `[changes]`.

    Parameters
    ----------
    base : Scenario
        The scenario without changes.
    text : str
        Its file.
    choice : Choice
        What was changed.

    Raises
    ------
    ConfigError
        The file's own changes are not written as a table.
    """
    if not choice.values:
        return text
    units = {leaf.key: leaf.unit for parameter in list_parameters(base.config).values() for leaf in parameter.leaves}
    added = {key: _entry(key, value, units.get(key)) for key, value in choice.values.items()}
    former = tomllib.loads(text)
    wanted = {**former, "changes": {**former.get("changes", {}), **{key: one.unwrap() for key, one in added.items()}}}
    with contextlib.suppress(TOMLKitError, tomllib.TOMLDecodeError):
        whole = tomlkit.dumps(_changed(tomlkit.parse(text), added))
        if tomllib.loads(whole) == wanted:
            return whole
    raise ConfigError(f"{base.name} has changes of its own that are no table; write them under [changes], one a line")


def _changed(document: TOMLDocument, added: Mapping[str, Any]) -> TOMLDocument:
    """Return a document with entries in its table `[changes]`, or in a new one before the first table."""
    if "changes" in document:
        changes: Any = document["changes"]
        changes.update(added)
        return document
    table = tomlkit.table()
    table.comment(REMARK)
    table.update(added)
    table.add(tomlkit.nl())
    return _first(document, table)


def _first(document: TOMLDocument, changes: Table) -> TOMLDocument:
    """Return a document with changes before its first table, where they are seen."""
    found, waiting = TOMLDocument(), True
    for key, value in document.body:
        if waiting and isinstance(value, Table | AoT):
            found.add("changes", changes)
            waiting = False
        found.append(key, value)
    if waiting:
        found.add("changes", changes)
    return found


def _number(value: float, unit: str, si_unit: str) -> str:
    """Return a number as a flag takes it, bare in SI."""
    return _plain(value) if unit == si_unit else f"{_plain(value)}{unit}"


def _plain(value: float) -> str:
    """Return a number as short as it can be read back."""
    return repr(float(value)).removesuffix(".0")


def _flag(value: Any) -> str:
    """Return a value as --set takes it."""
    if isinstance(value, str):
        return value
    if isinstance(value, dict) and isinstance(value["value"], float):
        return f"{_plain(value['value'])}{value['unit']}"
    return _plain(value) if isinstance(value, float) else json.dumps(value)


def _entry(key: str, value: Any, unit: str | None) -> Any:
    """Return a value as the table `[changes]` holds it."""
    if isinstance(value, str | bool | dict) or unit is None or not _is_numeric(value):
        return _inline(value) if isinstance(value, dict) else tomlkit.item(value)
    if key.startswith("vehicle.") or key.split(".")[-2].endswith("share"):
        return tomlkit.item(value) if unit == "1" else tomlkit.item(value).comment(unit)
    return _inline({"value": value, "unit": unit})


def _inline(value: dict[str, Any]) -> Any:
    found = tomlkit.inline_table()
    found.update(value)
    return found


def _is_numeric(value: Any) -> bool:
    """Return whether a value is a number or nested lists of them."""
    return all(map(_is_numeric, value)) if isinstance(value, list) else isinstance(value, int | float)
