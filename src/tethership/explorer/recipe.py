"""The command and the file that give the numbers of a view. Depends on: explorer.choice.

Both are the scenario and its changes as `load_scenario` takes them, written for a shell and as TOML.
"""

import json
import re
import shlex
import tomllib
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from tethership.errors import ConfigError
from tethership.explorer.choice import Choice
from tethership.scenario import Scenario
from tethership.scenario.parameters import list_parameters

HEADING = re.compile(r"^\[changes\][^\n]*$", re.MULTILINE)

FIRST_TABLE = re.compile(r"^\[", re.MULTILINE)
"""Where the first table begins: the changes are put before it, where they are seen."""


class Span(NamedTuple):
    """What a root locus runs over: a parameter between two typed numbers.

    Attributes
    ----------
    name : str
        Dotted name.
    low, high : tuple of float and str
        Ends, each a number with its unit.
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
    units = {leaf.key: leaf.unit for parameter in list_parameters(base.config).values() for leaf in parameter.leaves}
    lines = [f'"{key}" = {_entry(key, value, units.get(key))}' for key, value in choice.values.items()]
    if not lines:
        return text
    former = tomllib.loads(text)
    wanted = {**former, "changes": {**former.get("changes", {}), **_parsed(lines)}}
    for whole in _ways(text, choice.values, "\n".join(lines)):
        try:
            if tomllib.loads(whole) == wanted:
                return whole
        except tomllib.TOMLDecodeError:
            continue
    raise ConfigError(f"{base.name} has changes of its own that are no table; write them under [changes], one a line")


def _parsed(lines: Iterable[str]) -> dict[str, Any]:
    return tomllib.loads("\n".join(lines))


def _ways(text: str, keys: Iterable[str], added: str) -> Iterator[str]:
    """Yield the text with lines in its table `[changes]`, or in a new one: before the first table, or at the end."""
    heading = HEADING.search(text)
    if heading is not None:
        after = FIRST_TABLE.search(text, heading.end())
        end = len(text) if after is None else after.start()
        kept = text[heading.end() + 1 : end]
        for key in keys:
            kept = re.sub(rf'^"{re.escape(key)}"\s*=[^\n]*\n?', "", kept, flags=re.MULTILINE)
        yield f"{text[: heading.end()]}\n{added}\n{kept}{text[end:]}"
        return
    table = f"[changes] # made in tethership explore; they win over what stands elsewhere in this file\n{added}\n"
    first = FIRST_TABLE.search(text)
    if first is not None:
        yield f"{text[: first.start()]}{table}\n{text[first.start() :]}"
    yield f"{text.rstrip()}\n\n{table}"


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


def _entry(key: str, value: Any, unit: str | None) -> str:
    """Return a value as the table `[changes]` holds it."""
    if isinstance(value, dict):
        return f'{{ value = {json.dumps(value["value"])}, unit = "{value["unit"]}" }}'
    if isinstance(value, str | bool) or unit is None or not _is_numeric(value):
        return json.dumps(value)
    if key.startswith("vehicle.") or key.split(".")[-2].endswith("share"):
        return json.dumps(value) + ("" if unit == "1" else f" # {unit}")
    return f'{{ value = {json.dumps(value)}, unit = "{unit}" }}'


def _is_numeric(value: Any) -> bool:
    """Return whether a value is a number or nested lists of them."""
    return all(map(_is_numeric, value)) if isinstance(value, list) else isinstance(value, int | float)
