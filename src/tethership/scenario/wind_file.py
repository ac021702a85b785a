"""Reading a measured wind history from a CSV or netCDF file. Depends on: pandas, xarray, errors.

Columns (or variables) are `time` [s] and either `north`, `east` and, if measured, `down` [m/s], the velocity of the
air, or `speed` [m/s] and `direction` [deg], that from which it comes, clockwise from north, as stations give it.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from tethership.errors import ConfigError
from tethership.scenario.changes import Document

COLUMNS = "time with north, east (and down) in m/s, or time with speed in m/s and direction in deg"
"""What a file must have."""


def expand_wind_file(document: Document, base: Path | None, origin: str) -> None:
    """Replace `wind.file` of a scenario's document by the samples in it and their mean, in place.

    Parameters
    ----------
    document : dict
        Of a scenario.
    base : Path, optional
        Folder from which the file's path is counted.
    origin : str
        For messages.

    Raises
    ------
    ConfigError
        The file cannot be read, lacks a column, or has a number that is none.
    """
    wind = document.get("wind")
    if not isinstance(wind, dict) or wind.get("model") != "measured" or "file" not in wind:
        return
    extra = sorted(set(wind) - {"model", "file"})
    if extra:
        raise ConfigError(f"{origin}: wind.{extra[0]} is read from wind.file; take it out")
    given = Path(str(wind["file"]))
    path = given if base is None or given.is_absolute() else base / given
    times, velocities = read_wind(path)
    north, east, _ = velocities.mean(axis=0)
    document["wind"] = {
        "model": "measured",
        "speed": {"value": float(np.hypot(north, east)), "unit": "m/s"},
        "from_direction": {"value": float(np.arctan2(-east, -north)), "unit": "rad"},
        "times": {"value": times.tolist(), "unit": "s"},
        "velocities": {"value": velocities.tolist(), "unit": "m/s"},
    }


def take_wind_file(document: Document, changes: Document) -> Document:
    """Put a change of `wind.file` into a document, its path counted from here; returns the other changes.

    Parameters
    ----------
    document : dict
        Of a scenario, changed in place: its wind becomes the measured one.
    changes : dict
        Dotted name → value.
    """
    if "wind.file" not in changes:
        return changes
    document["wind"] = {"model": "measured", "file": str(Path(str(changes["wind.file"])).absolute())}
    return {name: value for name, value in changes.items() if name not in ("wind.file", "wind.model")}


def record_warning(wind: Any, duration: float) -> str | None:
    """Return what is to be said of a measured wind that ends before a flight does, None where all is well.

    Parameters
    ----------
    wind : WindConfig
        Of a scenario.
    duration : float
        Of the flight [s].
    """
    if wind.model != "measured" or duration <= float(wind.times[-1]):
        return None
    return (
        f"the measured wind ends at {float(wind.times[-1]):g} s and the flight at {duration:.4g} s: its last value was "
        "held from there on; give a longer record"
    )


def read_wind(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Return times from the first sample on [s] and wind velocities [m/s], ground axes, shape (n, 3)."""
    columns = _columns(path)
    lower = {name.strip().lower(): values for name, values in columns.items()}
    if "time" in lower and {"north", "east"} <= set(lower):
        parts = [lower["north"], lower["east"], lower.get("down", np.zeros(len(lower["north"])))]
    elif {"time", "speed", "direction"} <= set(lower):
        angle = np.radians(lower["direction"])
        parts = [-lower["speed"] * np.cos(angle), -lower["speed"] * np.sin(angle), np.zeros(len(angle))]
    else:
        raise ConfigError(f"{path} has {', '.join(columns) or 'nothing'}; wanted: {COLUMNS}")
    velocities = np.stack(parts, axis=-1)
    whole = np.isfinite(lower["time"]) & np.all(np.isfinite(velocities), axis=1)
    if not np.all(whole):
        raise ConfigError(f"{path}: sample {int(np.argmin(whole)) + 1} has a number missing; fill the gap")
    return lower["time"] - lower["time"][0], velocities


def _columns(path: Path) -> dict[str, np.ndarray]:
    """Return the columns of a file by name."""
    try:
        if path.suffix == ".csv":
            frame = pd.read_csv(path, comment="#")
            return {str(name): np.asarray(pd.to_numeric(frame[name], errors="coerce"), float) for name in frame}
        if path.suffix in (".nc", ".nc4", ".h5"):
            with xr.open_dataset(path, engine="h5netcdf", decode_times=False) as data:
                return {str(name): np.asarray(data[name], float) for name in data.variables if data[name].ndim == 1}
    except (OSError, ValueError) as error:
        raise ConfigError(f"cannot read the wind of {path}: {error}") from error
    raise ConfigError(f"{path}: a measured wind is a .csv or .nc file with {COLUMNS}")
