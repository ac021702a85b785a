"""The paper's published numbers, as rows of its Tables 3–6. Depends on nothing.

The rows at 9 m/s are not in the package: they are predicted, never fitted to.
"""

import functools
import tomllib
from importlib import resources
from typing import NamedTuple

TABLES = {"rewind": ("rewind",), "heading": ("rewind", "heading"), "navigation": ("rewind", "heading", "navigation")}
"""Layers of each table, by the name of the layer that it adds: Tables 3, 4 and 5."""

WINDS = (6.0, 12.0)
"""Winds of the published rows [m/s]."""


class Row(NamedTuple):
    """One flight of the paper.

    Attributes
    ----------
    table : str
        Key of `TABLES`.
    wind : float
        [m/s].
    values : dict
        Metrics by the names of `results.docking_metrics`, `docking_time` [s] included; SI, θ_rms in degrees.
    """

    table: str
    wind: float
    values: dict[str, float | list[float]]

    @property
    def layers(self) -> tuple[str, ...]:
        """Control layers in force."""
        return TABLES[self.table]


@functools.cache
def published_rows() -> tuple[Row, ...]:
    """Return the published rows: Tables 3–5 with their part of Table 6."""
    text = resources.files("tethership").joinpath("data/paper/published.toml").read_text(encoding="utf-8")
    document = tomllib.loads(text)
    rows = []
    for table in TABLES:
        for entry in document[table]:
            values = {key: value for key, value in entry.items() if key != "wind"}
            rows.append(Row(table, float(entry["wind"]), values))
    return tuple(rows)
