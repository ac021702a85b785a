"""The paper's published numbers, as rows of its Tables 3–6. Depends on: errors.

The rows at 9 m/s are held out: they judge what a fit predicts. Whatever fits takes its rows through `fitted_rows`,
which has none of them and refuses them where they are given.
"""

import functools
import tomllib
from collections.abc import Sequence
from importlib import resources
from typing import NamedTuple

from tethership.errors import ConfigError

TABLES = {"rewind": ("rewind",), "heading": ("rewind", "heading"), "navigation": ("rewind", "heading", "navigation")}
"""Layers of each table, by the name of the layer that it adds: Tables 3, 4 and 5."""


class Row(NamedTuple):
    """One flight of the paper.

    Attributes
    ----------
    table : str
        Key of `TABLES`.
    wind : float
        [m/s].
    values : dict
        Metrics by the names of `results.docking_metrics`, `docking_time` [s] included; SI, θ_rms in degrees [deg].
    held_out : bool
        Whether it judges predictions and is not to be fitted.
    """

    table: str
    wind: float
    values: dict[str, float | list[float]]
    held_out: bool

    @property
    def layers(self) -> tuple[str, ...]:
        """Control layers in force."""
        return TABLES[self.table]


@functools.cache
def published_rows() -> tuple[Row, ...]:
    """Return all published rows, Tables 3–5 with their part of Table 6: for comparison, never for a fit.

    Their metrics are in the units of print: tensions [N], rates [m/s], times [s], ADC [1/s], E [-], θ_rms [deg].
    """
    text = resources.files("tethership").joinpath("data/paper/published.toml").read_text(encoding="utf-8")
    document = tomllib.loads(text)
    rows = []
    for table in TABLES:
        for entry in document[table]:
            values = {key: value for key, value in entry.items() if key not in ("wind", "held_out")}
            rows.append(Row(table, float(entry["wind"]), values, entry.get("held_out", False)))
    return tuple(rows)


def fitted_rows(rows: Sequence[Row] | None = None) -> tuple[Row, ...]:
    """Return rows that may be fitted: those given, by default all that are not held out.

    Raises
    ------
    ConfigError
        One that is given is held out.
    """
    if rows is None:
        return tuple(row for row in published_rows() if not row.held_out)
    held = [f"{row.table} at {row.wind:g} m/s" for row in rows if row.held_out]
    if held:
        raise ConfigError(
            f"held out, not to be fitted: {', '.join(held)}; these rows judge a fit's predictions: leave them out"
        )
    return tuple(rows)
