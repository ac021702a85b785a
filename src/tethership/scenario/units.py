"""Units that files usually have: most scenarios are read without pint, which is long in loading. Depends on: nothing.

Every factor is pint's own, to the last bit: a test holds them equal.
"""

import math

PLAIN = ("1", "K", "N", "Pa", "kg", "kg/m", "m", "m/s", "m^2", "m^3", "rad", "rad/s", "s")
"""SI units of which one is one of the base units' product."""

USUAL = {
    "deg": ("rad", math.pi / 180),
    "deg/s": ("rad/s", math.pi / 180),
    "mm": ("m", 0.001),
    "cm": ("m", 0.01),
    "km": ("m", 1000.0),
    "in": ("m", 0.0254),
    "ft": ("m", 0.30479999999999996),
    "ft^3": ("m^3", 0.028316846591999994),
    "m/min": ("m/s", 1 / 60),
    "km/h": ("m/s", 0.2777777777777778),
    "min": ("s", 60.0),
    "g": ("kg", 0.001),
    "g/m": ("kg/m", 0.001),
    "kN": ("N", 1000.0),
    "kPa": ("Pa", 1000.0),
}
"""The SI unit of a unit, and how many of it one is."""


def factor(unit: str, si_unit: str) -> float | None:
    """Return how many of an SI unit one of a unit is, None where only pint knows."""
    known, times = USUAL.get(unit, (None, 0.0))
    return times if known == si_unit else None


def to_base(unit: str) -> float | None:
    """Return how many of its base units one of a unit is, None where only pint knows."""
    return 1.0 if unit in PLAIN else USUAL[unit][1] if unit in USUAL else None
