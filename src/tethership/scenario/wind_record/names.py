"""What a column is by its name, and what its unit is in SI. Depends on: errors.

Stations, loggers and models call the same things differently; what is not known here is left out, and said to be.
"""

import re
from pathlib import Path

import numpy as np

from tethership.errors import ConfigError
from tethership.scenario.wind_record.column import Column

NAMES = {
    "time": "time timestamp datetime date_time valid_time valid time_utc timestamp_utc utc tmstamp epoch unix_time "
    "unixtime t",
    "date": "date",
    "north": "north northward_wind v v_wind vwnd v_component_of_wind",
    "east": "east eastward_wind u u_wind uwnd u_component_of_wind",
    "down": "down",
    "up": "up upward_air_velocity w w_wind",
    "speed": "speed wind_speed windspeed horizontal_wind_speed wspd wind_spd windspd ws wsp spd ff sknt",
    "direction": "direction wind_from_direction wind_direction winddirection wind_dir winddir wdir wd dir dd drct "
    "from_direction",
    "toward": "wind_to_direction to_direction",
    "height": "height altitude alt height_agl",
}
"""Names of a quantity, the first one first; u, v, w are those of meteorology: eastward, northward, upward."""

PLACES = {name: (role, place) for role, names in NAMES.items() for place, name in enumerate(names.split())}

KINDS = {"time": "time", "direction": "angle", "toward": "angle", "height": "length"}
"""Kind of unit of a quantity; that of all others is a speed."""

UNITS = {
    "time": {
        "s sec secs second seconds": 1.0,
        "ms msec millisecond milliseconds": 1e-3,
        "us µs μs microsecond microseconds": 1e-6,
        "ns nanosecond nanoseconds": 1e-9,
        "min mins minute minutes": 60.0,
        "h hr hrs hour hours": 3600.0,
        "d day days": 86400.0,
    },
    "speed": {
        "m/s ms-1 mps ms m/sec meters/second metres/second meter/second metre/second meterspersecond": 1.0,
        "kn kt kts knot knots": 1852.0 / 3600.0,
        "km/h kmh kmh-1 kph km/hr": 1.0 / 3.6,
        "mph mi/h miles/hour": 0.44704,
        "ft/s fts-1 fps": 0.3048,
        "cm/s cms-1": 0.01,
        "mm/s mms-1": 0.001,
    },
    "angle": {
        "deg degree degrees ° degt degtrue degreestrue degreetrue": np.pi / 180.0,
        "rad radian radians": 1.0,
    },
    "length": {"m meter meters metre metres": 1.0, "ft foot feet": 0.3048, "km": 1000.0, "cm": 0.01},
}
"""Units by kind, spelled without blanks, points, `^` and `**`: factor to SI."""

FACTORS = {kind: {word: f for words, f in of.items() for word in words.split()} for kind, of in UNITS.items()}

DEFAULTS = {"time": "s", "speed": "m/s", "angle": "deg", "length": "m"}
"""Unit of a column without one; that of `sknt` is the knot."""

STATISTICS = {"avg", "mean", "smp", "res", "inst", "at"}
"""Words of loggers after a name that leave the quantity what it is; `max` or `std` do not."""


def _plain(unit: str) -> str:
    """Return a unit in the spelling of `UNITS`."""
    return re.sub(r"[\s._^*·]", "", unit.lower()).replace("⁻¹", "-1")


def is_unit(text: str) -> bool:
    """Return whether a text is a unit of any kind, or a logger's word for a time stamp."""
    return text.strip() == "TS" or any(_plain(text) in factors for factors in FACTORS.values())


def _read_name(name: str) -> tuple[str | None, int, str, float | None]:
    """Return quantity, rank of its name, unit and height [m] that a name bears: `wind_speed_kt`, `40m wind speed`."""
    words = [word for word in re.split(r"[^a-z0-9.°]+", name.lower()) if word and word not in STATISTICS]
    height, kept = None, []
    for word in words:
        number = re.fullmatch(r"([a-z]*?)(\d+\.?\d*)m|([a-z]+)(\d\d+)", word)  # 40m, ws40m, u10
        if number is None:
            kept.append(word)
            continue
        height = float(number[2] or number[4])
        kept += [part for part in (number[1] or number[3],) if part]
    key = re.sub(r"_(s|d1)_wvt$", "", "_".join(kept))  # Campbell's mean of a wind vector
    for cut in range(len(key), 0, -1):
        known, rest = PLACES.get(key[:cut]), key[cut:]
        if known is None or (rest and rest[0] != "_"):
            continue
        unit = _plain(rest)
        if key == "t" and height is not None:  # t2m is a temperature
            continue
        if not rest or unit in FACTORS[KINDS.get(known[0], "speed")]:
            return *known, unit or ("kn" if key == "sknt" else ""), height
    return None, 0, "", None


def role_of(name: str, meaning: str = "") -> str | None:
    """Return the quantity that a column holds, a key of `NAMES`; None if it is not known."""
    return _read_name(meaning if meaning in PLACES else name)[0]


def rank_of(column: Column) -> int:
    """Return how far down its list a column's name stands: the first is taken."""
    return 0 if column.meaning in PLACES else _read_name(column.name)[1]


def height_of(column: Column) -> float | None:
    """Return the height of a column's measurement [m]: along its dimension, or from its name."""
    return column.height if column.height is not None else _read_name(column.name)[3]


def has_unit(column: Column) -> bool:
    """Return whether a column says its unit."""
    return bool(column.unit or _read_name(column.name)[2])


def measures(column: Column, role: str) -> bool:
    """Return whether a column's unit, if it has one, is of the kind of a quantity: ERA5's `w` is in Pa/s."""
    kind = KINDS.get(role, "speed")
    return not column.unit or _plain(column.unit.partition(" since ")[0]) in FACTORS[kind]


def factor_to_si(column: Column, role: str, path: Path) -> float:
    """Return the factor by which a column's numbers are multiplied to be in SI [s, m/s, rad or m].

    A column that says no unit has that of `DEFAULTS`; `role` is its quantity, a key of `NAMES`.

    Raises
    ------
    ConfigError
        Its unit is none of that kind.
    """
    kind = KINDS.get(role, "speed")
    unit = column.unit.partition(" since ")[0] or _read_name(column.name)[2] or DEFAULTS[kind]
    if _plain(unit) not in FACTORS[kind]:
        known = ", ".join(words.split()[0] for words in UNITS[kind])
        raise ConfigError(f"{path}: the unit of {column.name} is {unit!r}; give it in one of {known}")
    return FACTORS[kind][_plain(unit)]


def to_si(column: Column, role: str, path: Path) -> np.ndarray:
    """Return the numbers of a column that holds numbers, in SI [s, m/s, rad or m]; errors as `factor_to_si`."""
    return np.asarray(column.values, float) * factor_to_si(column, role, path)
