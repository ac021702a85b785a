"""The record in a measured wind's file. Depends on: wind_record, errors.

The file has `time` and either the velocity of the air (`north`, `east` and, if measured, `down` or `up`; or `u`, `v`,
`w`) or `speed` and `direction`, that from which it comes, clockwise from north, as stations give it.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tethership.errors import ConfigError
from tethership.scenario.reading import check_file_to_read
from tethership.scenario.wind_record.column import LARGEST_FILE, WANTED, Column
from tethership.scenario.wind_record.heights import LEVEL, at_height
from tethership.scenario.wind_record.names import measures, rank_of, role_of
from tethership.scenario.wind_record.netcdf_file import read_netcdf
from tethership.scenario.wind_record.samples import read_numbers, without_gaps
from tethership.scenario.wind_record.text_file import read_text
from tethership.scenario.wind_record.times import read_times

READERS = {".csv": read_text, ".txt": read_text, ".dat": read_text} | dict.fromkeys((".nc", ".nc4", ".h5"), read_netcdf)
"""Who reads a file, by its ending."""

CALM = 0.1
"""Speed [m/s] below which an instrument gives no direction."""

Chosen = dict[str, Column]
"""Columns that are used, by quantity."""


class Record(NamedTuple):
    """A measured wind.

    Attributes
    ----------
    times : np.ndarray
        From the first sample on [s], shape (n,).
    velocities : np.ndarray
        Velocity of the air, north, east, down [m/s], shape (n, 3).
    height : float or None
        Height of the measurement [m]; None where the file does not tell.
    remarks : tuple of str
        What was left out, bridged or guessed, a line each.
    """

    times: np.ndarray
    velocities: np.ndarray
    height: float | None
    remarks: tuple[str, ...]

    @property
    def mean(self) -> np.ndarray:
        """Mean over time (trapezoids), north, east, down [m/s], shape (3,)."""
        return np.trapezoid(self.velocities, self.times, axis=0) / self.times[-1]


def read_record(path: Path, height: float | None = None) -> Record:
    """Return the record of a file.

    Parameters
    ----------
    path : Path
        `.csv`, `.txt`, `.dat` or `.nc`.
    height : float, optional
        Which one to take [m], where the file has several.

    Raises
    ------
    ConfigError
        The file cannot be read, lacks a column, has a unit or number that is none, or a gap too long to be bridged.
    """
    check_file_to_read(path, LARGEST_FILE, "the wind")
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise ConfigError(f"{path}: a measured wind is a .csv, .txt, .dat or .nc file with {WANTED}")
    columns = reader(path)
    columns, height = at_height(columns, height, path)
    chosen = _chosen(columns, path)
    times, guessed = read_times(chosen["time"], chosen.get("date"), path)
    velocities = _velocities(chosen, path)
    if len(velocities) != len(times):
        raise ConfigError(f"{path}: {len(times)} times and {len(velocities)} samples of the wind; give a time to each")
    times, velocities, bridged = without_gaps(times, velocities, path)
    remarks = (*_left_out(columns, chosen), *_axes(chosen), *guessed, *bridged)
    return Record(times, velocities, height, tuple(f"{path.name}: {remark}" for remark in remarks))


def _chosen(columns: Iterable[Column], path: Path) -> Chosen:
    """Return the columns to be used, each under its quantity."""
    by_role: dict[str, list[Column]] = {}
    for column in columns:
        role = role_of(column.name, column.meaning)
        if role is not None:
            by_role.setdefault(role, []).append(column)
    if "time" not in by_role and "date" in by_role:
        by_role["time"] = by_role.pop("date")
    pair = next((pair for pair in LEVEL if set(pair) <= set(by_role)), None)
    if pair is None or "time" not in by_role:
        names = ", ".join(column.name for column in columns if column.name)
        raise ConfigError(f"{path} has {names[:200] or 'no column with a name'}; wanted: {WANTED}")
    chosen = {}
    vertical = [role for role in ("down", "up") if any(measures(column, role) for column in by_role.get(role, ()))]
    for role in ("time", *pair, *vertical[:1], *(["date"] if "date" in by_role else [])):
        ranked = sorted(by_role[role], key=rank_of)
        if len(ranked) > 1 and rank_of(ranked[0]) == rank_of(ranked[1]):
            raise ConfigError(f"{path}: {ranked[0].name} and {ranked[1].name} could both be the {role}; leave one out")
        chosen[role] = ranked[0]
    return chosen


def _velocities(chosen: Chosen, path: Path) -> np.ndarray:
    """Return the velocity of the air, north, east, down [m/s], shape (n, 3), NaN where nothing was measured."""
    of = {role: read_numbers(column, role, path) for role, column in chosen.items() if role not in ("time", "date")}
    if "speed" in of:
        speed, angle = of["speed"], of["direction"] if "direction" in of else of["toward"] + np.pi
        angle = np.where(np.isnan(angle) & (speed < CALM), 0.0, angle)  # calm air comes from nowhere
        of |= {"north": -speed * np.cos(angle), "east": -speed * np.sin(angle)}
    down = of["down"] if "down" in of else -of["up"] if "up" in of else np.zeros(len(of["north"]))
    return np.stack([of["north"], of["east"], down], axis=-1)


def _left_out(columns: Iterable[Column], chosen: Chosen) -> list[str]:
    """Return a remark that names the columns that are not used, if there are any."""
    used = {column.name for column in chosen.values()}
    names = [c.name for c in columns if c.name and c.name not in used and role_of(c.name, c.meaning) != "height"]
    more = f" and {len(names) - 8} more" if len(names) > 8 else ""
    return [f"not used: {', '.join(names[:8])}{more}"] if names else []


def _axes(chosen: Chosen) -> list[str]:
    """Return a remark on the axes of u, v and w, unless the file itself tells them."""
    plain = [c.name for c in chosen.values() if c.name.lower() in ("u", "v", "w") and not c.meaning]
    told = {"u": "eastward", "v": "northward", "w": "upward"}
    read = ", ".join(f"{name} as {told[name.lower()]}" for name in plain)
    return [f"read {read}; an anemometer's own axes must be turned to these first"] if plain else []
