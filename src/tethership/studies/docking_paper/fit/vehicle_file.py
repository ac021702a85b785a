"""A vehicle file with identified numbers: the literature's file, these lines replaced. Depends on: fit.space.

The text is edited, not written anew, so that comments, order and the sources of everything else stay.
"""

import re
from collections.abc import Mapping

import numpy as np

from tethership.errors import ConfigError
from tethership.studies.docking_paper.fit.space import UNKNOWNS, Unknown

_HEADER = re.compile(r"^\[\[?(?P<section>[\w.]+)\]\]?")
_ENTRY = re.compile(r"^(?P<key>\w+)\s*=\s*(?P<value>.*)$")


def vehicle_text(template: str, values: np.ndarray, name: str, description: str, source: str) -> str:
    """Return a vehicle file's text.

    Parameters
    ----------
    template : str
        Text of the vehicle whose other numbers stay.
    values : ndarray
        Of `UNKNOWNS` [SI].
    name, description : str
        Of the new vehicle.
    source : str
        Of the identified numbers.

    Raises
    ------
    ConfigError
        The template has no line for one of the numbers.
    """
    wanted = {
        key: (unknown, float(value))
        for unknown, value in zip(UNKNOWNS, values, strict=True)
        for key in unknown.parameters
    }
    words = {"name": f'"{name}"', "description": f'"{description}"'}
    section, item, met, lines = "", "", set[str](), []
    for line in template.splitlines():
        header, entry = _HEADER.match(line), _ENTRY.match(line)
        if header:
            section, item = header["section"], ""
        elif entry and section == "" and entry["key"] in words:
            line = f"{entry['key']} = {words[entry['key']]}"
        elif entry and entry["key"] == "name":
            item = entry["value"].strip('"')
        elif entry:
            key = _found(wanted, section, item, entry["key"])
            if key is not None:
                met.add(key)
                line = f"{entry['key']} = {_quantity(*wanted[key], source)}"
        lines.append(line)
    missing = sorted(set(wanted) - met)
    if missing:
        raise ConfigError(f"the vehicle template has no line for {', '.join(missing)}; start from a copy of lotte.toml")
    return "\n".join(lines) + "\n"


def _found(wanted: Mapping[str, object], section: str, item: str, key: str) -> str | None:
    """Return the dotted name that a line of a section and named item stands for, if it is wanted."""
    full = f"vehicle.{section}.{item}.{key}" if item else f"vehicle.{section}.{key}"
    starred = f"vehicle.{section}.*.{key}"
    return next((name for name in (full, starred) if name in wanted), None)


def _quantity(unknown: Unknown, value: float, source: str) -> str:
    """Return the inline table of a number."""
    return f'{{ value = {value:.6g}, unit = "{unknown.unit}", source = "{source}" }}'
