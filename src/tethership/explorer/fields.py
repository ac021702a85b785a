"""The numbers that the page offers, in groups, with units, defaults and ranges from the scenario and its models.

Depends on: scenario.
"""

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple

from tethership.errors import ConfigError
from tethership.errors import shown as shown_text
from tethership.scenario import Parameter, ScenarioConfig, converted, list_parameters, number_with_unit

SHOWN_UNITS = {"rad": "deg"}
"""Units in which numbers are shown and typed, where that is not the SI unit."""

DEGREE = math.pi / 180.0


class Field(NamedTuple):
    """One number of the page.

    Attributes
    ----------
    name : str
        Dotted name of the parameter.
    label : str
        Words beside it.
    unit : str
        Unit in which it is shown and typed: degrees for angles, millimetres for cables' diameters, else the SI unit.
    text : str
        The scenario's own value, as shown.
    span : tuple of float, optional
        Ends of its slider, in the shown unit ([deg] of an angle, else SI); none without a slider.
    """

    name: str
    label: str
    unit: str
    text: str
    span: tuple[float, float] | None = None


AIR = (("wind.speed", "wind speed"), ("wind.from_direction", "wind from"))
TRIM = (
    ("trim.elongation", "elongation"),
    ("trim.elevation", "elevation"),
    ("trim.bearing", "bearing"),
)
POSITION = (("trim.position.0", "north"), ("trim.position.1", "east"), ("trim.position.2", "down"))
SHIP = (
    ("vehicle.body.mass", "mass"),
    ("vehicle.buoyancy.volume", "displaced volume"),
    ("vehicle.thrusters.*.nominal_thrust", "nominal thrust"),
)
CABLE = (
    ("length", "length"),
    ("stiffness", "stiffness EA"),
    ("linear_density", "linear density"),
    ("diameter", "diameter"),
    ("breaking_force", "breaking force"),
    ("tether_point.0", "tether pt. forward"),
    ("tether_point.1", "tether pt. starboard"),
    ("tether_point.2", "tether pt. down"),
    ("winch.rewind_rate", "rewind rate"),
)
START = (
    ("start.attitude_offset.0", "roll off trim"),
    ("start.attitude_offset.1", "pitch off trim"),
    ("start.attitude_offset.2", "yaw off trim"),
    ("stop.cable_length", "docked at cable of"),
    ("stop.time_limit", "time limit"),
)
GUST = (("fraction", "share of the wind"), ("speed", "speed"), ("from_direction", "from"), ("start", "start"))
GAINS = (
    ("attitude.roll_rate_gain", "SAS, roll rate"),
    ("attitude.pitch_rate_gain", "SAS, pitch rate"),
    ("attitude.yaw_rate_gain", "SAS, yaw rate"),
    ("attitude.roll_gain", "attitude, roll"),
    ("attitude.pitch_gain", "attitude, pitch"),
    ("rewind.gain", "rewind"),
    ("rewind.threshold", "rewind, threshold"),
    ("heading.gain", "heading"),
    ("navigation.position_gain", "navigation, position"),
    ("navigation.vertical_gain", "navigation, height"),
    ("navigation.speed_gain", "navigation, speed"),
    ("navigation.climb_gain", "navigation, climb"),
)

SPANS = {
    "wind.speed": (0.0, 16.0),
    "wind.from_direction": (0.0, 360.0),
    "trim.elongation": (0.1, 1.02),
    "trim.elevation": (0.0, 90.0),
    "trim.bearing": (0.0, 360.0),
}
"""Ends of sliders, in shown units; a cable's length has a quarter to two and a half of its own."""


def shown_unit(parameter: Parameter) -> str:
    """Return the unit in which a parameter is shown and typed: for [rad] deg, for a cable's diameter mm, else SI."""
    if parameter.name.startswith("cables.") and parameter.name.endswith(".diameter"):
        return "mm"
    return SHOWN_UNITS.get(parameter.unit, parameter.unit)


def shown(parameter: Parameter, value: float | None = None) -> str:
    """Return a value in SI, or the parameter's own, as text in its shown unit, seven digits.

    From [rad] to [deg] it is divided by π/180, from [m] to [mm] multiplied by 1000.
    """
    factor = {"deg": 1.0 / DEGREE, "mm": 1e3}.get(shown_unit(parameter), 1.0)
    return f"{(parameter.value if value is None else value) * factor:.7g}"


def groups(config: ScenarioConfig) -> dict[str, list[Field]]:
    """Return the fields of a scenario by group; only numbers that it has."""
    known = list_parameters(config)
    measured = config.wind.model == "measured"
    cables = [(c.name, f"Cable {c.name}" if len(config.cables) > 1 else "Cable") for c in config.cables]
    held = TRIM if config.trim.hold == "tether_point" and config.cables else POSITION
    wanted: dict[str, Iterator[tuple[str, str]] | tuple[tuple[str, str], ...]] = {
        "Air": () if measured else AIR,
        "Trim": held,
        **{title: _prefixed(f"cables.{name}", CABLE) for name, title in cables},
        "Ship": SHIP,
        "Gains": _prefixed("control", GAINS),
        "Start and end": START,
        **{
            f"Gust {i + 1}" if len(config.gusts) > 1 else "Gust": _prefixed(f"gusts.{i}", GUST)
            for i in range(len(config.gusts))
        },
    }
    found = {title: [_field(known[n], words) for n, words in rows if n in known] for title, rows in wanted.items()}
    return {title: rows for title, rows in found.items() if rows}


def extra_field(parameter: Parameter) -> Field:
    """Return the field of any other number of the files."""
    return _field(parameter, parameter.name)


def _prefixed(prefix: str, rows: tuple[tuple[str, str], ...]) -> Iterator[tuple[str, str]]:
    return ((f"{prefix}.{name}", words) for name, words in rows)


def _field(parameter: Parameter, words: str) -> Field:
    span = SPANS.get(parameter.name)
    if parameter.name.startswith("cables.") and parameter.name.endswith(".length"):
        span = (round(0.25 * parameter.value, 1), round(2.5 * parameter.value, 1))
    own = float(shown(parameter))
    if span is not None and not span[0] <= own <= span[1]:
        span = (min(span[0], own), max(span[1], 1.5 * own))
    return Field(parameter.name, words, shown_unit(parameter), shown(parameter), span)


def typed(parameter: Parameter, text: str, words: str | None = None) -> tuple[float, str]:
    """Return the number and unit that were typed, in the shown unit where none was, e.g. 30 and deg for [rad].

    Raises
    ------
    ConfigError
        It is no number, or its unit does not fit.
    """
    unit, words = shown_unit(parameter), words or parameter.name
    with_unit = number_with_unit(text)
    try:
        if with_unit is not None:
            converted(*with_unit, parameter.unit)
            return with_unit
        value = float(text)
    except ValueError as error:
        reason = str(error) if with_unit is not None else f"{shown_text(text)} is no number"
        raise ConfigError(f"{words}: {reason}; write a number in {unit}, or with its unit") from error
    if not math.isfinite(value):
        raise ConfigError(f"{words}: {shown_text(text)} is not a finite number; write a number in {unit}")
    return value, unit


def in_si(parameter: Parameter, number: tuple[float, str]) -> float:
    """Return a typed number in SI, the parameter's unit: 30 and deg as 0.5236 [rad]."""
    return converted(*number, parameter.unit)


def known_parameters(config: ScenarioConfig) -> Mapping[str, Parameter]:
    """Return every number that may be changed; those of a measured wind follow from its file."""
    measured = config.wind.model == "measured"
    return {n: p for n, p in list_parameters(config).items() if not (measured and n.startswith("wind."))}
