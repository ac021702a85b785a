"""Words that several figures say of a scenario. Depends on: scenario."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tethership.scenario import ScenarioConfig
from tethership.scenario.wind_schema import GustConfig

POINTS = ("N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE", "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW")
"""Points of the compass."""


def compass(azimuth: float) -> str:
    """Return the point of the compass of an azimuth [rad], clockwise from north."""
    return POINTS[round(float(np.degrees(azimuth)) / 22.5) % 16]


def flown_words(config: ScenarioConfig, attributes: Mapping[str, Any]) -> list[str]:
    """Return how a flight was flown, in a few parts: wind, gusts, layers, formulation; `attributes` are its own."""
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
