"""Which of several heights of a measured wind is flown. Depends on: errors."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tethership.errors import ConfigError
from tethership.scenario.wind_record.column import Column
from tethership.scenario.wind_record.names import factor_to_si, height_of, measures, role_of
from tethership.scenario.wind_record.samples import as_numbers

LEVEL = (("north", "east"), ("speed", "direction"), ("speed", "toward"))
"""Pairs that give the level wind, the first one first."""


def at_height(columns: Sequence[Column], wanted: float | None, path: Path) -> tuple[list[Column], float | None]:
    """Return the columns of one height, and that height [m], None where the file does not tell.

    Heights stand in a column of their own, along a dimension, or in names (`ws40m`, `u10`).

    Parameters
    ----------
    columns : sequence of Column
        Of a file.
    wanted : float, optional
        The height to take [m].
    path : Path
        For messages.

    Raises
    ------
    ConfigError
        There are several and none is chosen, or the chosen one is not there.
    """
    own = next((c for c in columns if role_of(c.name, c.meaning) == "height" and measures(c, "height")), None)
    known = _complete_heights(columns)
    if own is None or known:
        height = _one_of(known, wanted, path)
        return [c for c in columns if height_of(c) in (None, height) or not known], height
    heights = as_numbers(own, path) * factor_to_si(own, "height", path)
    height = _one_of(sorted({float(h) for h in heights if np.isfinite(h)}), wanted, path)
    here = np.isclose(heights, height) if height is not None and len(heights) > 1 else slice(None)
    return [c._replace(values=c.values[here]) if len(c.values) == len(heights) else c for c in columns], height


def _complete_heights(columns: Sequence[Column]) -> list[float]:
    """Return the heights at which the columns give a wind, by their names or dimension."""
    roles: dict[float | None, set[str | None]] = {None: set()}
    for column in columns:
        roles.setdefault(height_of(column), set()).add(role_of(column.name, column.meaning))
    return sorted(
        height
        for height, here in roles.items()
        if height is not None and any(set(pair) & here and set(pair) <= here | roles[None] for pair in LEVEL)
    )


def _one_of(heights: list[float], wanted: float | None, path: Path) -> float | None:
    """Return the height that is flown [m], among those that there are."""
    if not heights:
        return wanted
    near = [height for height in heights if wanted is not None and np.isclose(height, wanted)]
    if near or (wanted is None and len(heights) == 1):
        return near[0] if near else heights[0]
    named = ", ".join(f"{height:g}" for height in heights[:8]) + (", …" if len(heights) > 8 else "")
    asked = "several heights" if wanted is None else f"no height of {wanted:g} m, but"
    raise ConfigError(
        f"{path} has {asked} ({named} m); say which is flown beside wind.file: "
        f'height = {{ value = {heights[0]:g}, unit = "m" }}'
    )
