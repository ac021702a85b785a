"""A vehicle file with identified numbers: the literature's file with these replaced. Depends on: tomlkit, fit.space.

The text is edited, not written anew, so that comments, order and the sources of everything else stay.
"""

from typing import Any

import numpy as np
import tomlkit

from tethership.errors import ConfigError
from tethership.studies.docking_paper.fit.space import UNKNOWNS
from tethership.tuning import set_quantity


def vehicle_text(template: str, values: np.ndarray, name: str, description: str, source: str) -> str:
    """Return a vehicle file's text.

    Parameters
    ----------
    template : str
        Text of the vehicle whose other numbers stay.
    values : ndarray
        Of `UNKNOWNS`, in the SI unit that each has [m², m, -, N], shape (unknowns,).
    name, description : str
        Of the new vehicle.
    source : str
        Of the identified numbers.

    Raises
    ------
    ConfigError
        The template has no line for one of the numbers.
    """
    document = tomlkit.parse(template)
    document.update({"name": name, "description": description})
    missing = []
    for unknown, value in zip(UNKNOWNS, values, strict=True):
        for key in unknown.parameters:
            _, section, *item, number = key.split(".")
            tables = _tables(document.get(section, []), *item)
            if not tables or any(number not in table for table in tables):
                missing.append(key)
            for table in tables:
                if number in table:
                    table[number]["unit"] = unknown.unit
                    set_quantity(table[number], float(value), source)
    if missing:
        raise ConfigError(f"the vehicle template has no line for {', '.join(missing)}; start from a copy of lotte.toml")
    return tomlkit.dumps(document)


def _tables(section: Any, item: str | None = None) -> list[Any]:
    """Return a section, or of a list the table that is named as an item, all of them for a star."""
    return [section] if item is None else [table for table in section if item in ("*", table["name"])]
