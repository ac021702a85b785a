"""A measured wind of a scenario: its file becomes samples, with what is to be said of it. Depends on: wind_record."""

from pathlib import Path
from typing import Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from tethership.errors import ConfigError
from tethership.scenario.changes import Document
from tethership.scenario.messages import first_problem
from tethership.scenario.quantity import Metres


def expand_wind_file(document: Document, base: Path | None, origin: str) -> None:
    """Replace `wind.file` of a scenario's document by the samples in it and their mean, in place.

    They become `times` [s], shape (n,), `velocities` north, east, down [m/s], shape (n, 3), and of the level mean over
    time `speed` [m/s] and `from_direction`, clockwise from north [rad]; `height` [m] too where it is known.

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
        As `read_record`, or something stands beside `file` that is read from it.
    """
    wind = document.get("wind")
    if not isinstance(wind, dict) or wind.get("model") != "measured" or "file" not in wind:
        return
    extra = sorted(set(wind) - {"model", "file", "height"})
    if extra:
        raise ConfigError(f"{origin}: wind.{extra[0]} is read from wind.file; take it out")
    if not isinstance(wind["file"], str):
        raise ConfigError(f"{origin}: wind.file is {wind['file']!r}; give the name of a file in quotes")
    try:
        height = TypeAdapter(Metres).validate_python(wind["height"]) if "height" in wind else None
    except ValidationError as error:
        raise ConfigError(first_problem(error, f"{origin}: wind.height", wind["height"])) from error
    from tethership.scenario.wind_record import read_record

    given = Path(wind["file"])
    record = read_record(given if base is None or given.is_absolute() else base / given, height)
    north, east, _ = record.mean
    document["wind"] = {
        "model": "measured",
        "speed": {"value": float(np.hypot(north, east)), "unit": "m/s"},
        "from_direction": {"value": float(np.arctan2(-east, -north)), "unit": "rad"},
        "times": {"value": record.times.tolist(), "unit": "s"},
        "velocities": {"value": record.velocities.tolist(), "unit": "m/s"},
        "remarks": list(record.remarks),
    }
    if record.height is not None:
        document["wind"]["height"] = {"value": record.height, "unit": "m"}


def take_wind_file(document: Document, changes: Document) -> Document:
    """Put changes of `wind.file` and `wind.height` into a document; returns the other changes.

    Parameters
    ----------
    document : dict
        Of a scenario, changed in place: with a file, counted from here, its wind becomes the measured one.
    changes : dict
        Dotted name → value; a plain number for `wind.height` is in [m].
    """
    taken = set()
    if "wind.file" in changes:
        document["wind"] = {"model": "measured", "file": str(Path(str(changes["wind.file"])).absolute())}
        taken = {"wind.file", "wind.model"}
    wind = document.get("wind")
    if "wind.height" in changes and isinstance(wind, dict) and "file" in wind:
        height = changes["wind.height"]
        wind["height"] = {"value": height, "unit": "m"} if isinstance(height, int | float) else height
        taken |= {"wind.height"}
    return {name: value for name, value in changes.items() if name not in taken}


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
