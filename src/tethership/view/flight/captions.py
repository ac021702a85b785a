"""Words that several figures and tables say of a scenario or of odds. Depends on: scenario."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tethership.scenario import GustConfig, ScenarioConfig

POINTS = ("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW")
"""Points of the compass."""


def compass(azimuth: float) -> str:
    """Return the point of the compass of an azimuth [rad], clockwise from north."""
    return POINTS[round(float(np.degrees(azimuth)) / 22.5) % 16]


def percent(share: float | None) -> str:
    """Return a share [-] for people: in percent, to three digits of it or of what it lacks to the whole.

    Examples
    --------
    >>> percent(0.0471), percent(0.99958), percent(1.0), percent(None)
    ('4.71 %', '99.9580 %', '100 %', '–')
    """
    if share is None or not math.isfinite(share):
        return "–"
    rest = 100.0 * min(abs(share), abs(1.0 - share))
    places = 0 if rest < 1e-9 else min(max(2 - math.floor(math.log10(rest)), 0), 6)
    return f"{100.0 * share:.{places}f} %"


def percents(row: Mapping[str, Any]) -> str:
    """Return the interval of a share, `low` and `high` [-] of a row, in percent."""
    if row["low"] is None or row["high"] is None:
        return "no interval"
    return f"{percent(row['low'])} … {percent(row['high'])}"


def trust(outside: Mapping[str, Any]) -> str:
    """Return how far tensions are to be trusted, from shares [-]: `quasi_static_outside` of a campaign's answers."""
    return (
        f"the quasi-static cable is outside its trusted range in {percent(outside['median'])} of the flight in the "
        f"middle (at most {percent(outside['largest'])})"
    )


def flown_words(config: ScenarioConfig, attributes: Mapping[str, Any]) -> list[str]:
    """Return how a flight was flown, in a few parts; `attributes` are its own.

    Wind [m/s] and the point of the compass it comes from, gusts with their start [s], layers, formulation.
    """
    wind = config.wind
    layers = ", ".join(attributes["layers"]) or "none"
    return [
        f"wind {wind.speed:.3g} m/s from {compass(wind.from_direction)}" if wind.speed > 0 else "no wind",
        *_gusts(config.gusts),
        f"layers: {layers}" + ("" if attributes["sas"] else " (no SAS)"),
        f"{attributes['formulation']} formulation",
    ]


def _gusts(gusts: Sequence[GustConfig]) -> list[str]:
    """Return what is said of the gusts."""
    if len(gusts) > 1:
        return [f"{len(gusts)} gusts"]
    return [f"gust from {compass(gust.from_direction)} at {gust.start:g} s" for gust in gusts]
