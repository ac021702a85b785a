"""Facts read off docking flights: peaks of tension, throws sideways, and what becomes of flights that did not dock.

Depends on: simulation, fit.targets, numpy. A claim looks only at flights that docked; of the others it tells the
outcome, so no number of a flight cut short is ever compared.
"""

from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple, TypeVar

import numpy as np

from tethership.simulation import Flight, Outcome
from tethership.studies.docking_paper.fit.targets import TABLES

T = TypeVar("T")

FlightKey = tuple[str, float]
"""Table (key of `TABLES`) and wind [m/s]."""

Flights = Mapping[FlightKey, Flight]
"""Flights by table and wind."""

WINDS = (6.0, 9.0, 12.0)
"""Winds of section 4 [m/s]."""

KEYS: tuple[FlightKey, ...] = tuple((table, wind) for wind in WINDS for table in TABLES)
"""The nine flights of section 4."""

CONTROL_THRESHOLD = 144.3
"""Tension above which the winch is slowed, F' of Table A.2 [N]: a maximum above it is called a peak."""

TAUT = 0.99
"""Elongation e_c at which the paper's joint begins [-]: below it a cable carries nothing but a catenary's tension."""

SAGGING = 0.97
"""Elongation below which a cable is called sagging [-].

A shallow arc of length L hangs √(3/8 (1 − e)) L below its chord: at 0.97 a tenth of the cable's length, which is
plain to see in a drawing.
"""

LOOK_BACK = 5.0
"""Time before the cable becomes taut in which it must have sagged [s].

The period of the gust, and longer than the winch alone takes from 0.97 to 0.99 with the whole cable out (0.4 m at
0.3 m/s). Several bounces that follow one sag within it all count as coming from that sag.
"""

GUST_START = 20.0
"""Begin of the side gust [s]: what happens before it is the work of the initial attitude."""


class Peak(NamedTuple):
    """One peak of tension.

    Attributes
    ----------
    time : float
        [s].
    tension : float
        [N], as sampled.
    elongation : float
        e at the peak [-].
    lowest : float or None
        Lowest e in the `LOOK_BACK` before the cable became taut [-]; None if it was taut from the start.
    """

    time: float
    tension: float
    elongation: float
    lowest: float | None

    @property
    def from_sagging(self) -> bool:
        """Whether e [-] came up to 1 from a sagging cable."""
        return self.elongation >= TAUT and self.lowest is not None and self.lowest < SAGGING


def peaks(flight: Flight) -> list[Peak]:
    """Return the peaks of tension above `CONTROL_THRESHOLD` [N] of the first cable, in order of time [s].

    Notes
    -----
    Samples above the threshold belong to one peak as long as the cable stays taut between them; its top is the
    highest sample.
    """
    time = flight.data["time"].to_numpy()
    tension = flight.data["tension"].to_numpy()[:, 0]
    elongation = flight.data["elongation"].to_numpy()[:, 0]
    over = np.flatnonzero(tension > CONTROL_THRESHOLD)
    if not len(over):
        return []
    slackenings = np.cumsum((elongation < TAUT) & (tension <= CONTROL_THRESHOLD))
    groups = np.split(over, np.flatnonzero(np.diff(slackenings[over])) + 1)
    found = []
    for group in groups:
        top = int(group[np.argmax(tension[group])])
        slack = np.flatnonzero(elongation[:top] < TAUT)
        lowest = None
        if len(slack):
            last = int(slack[-1])
            lowest = float(elongation[: last + 1][time[: last + 1] >= time[last] - LOOK_BACK].min())
        found.append(Peak(float(time[top]), float(tension[top]), float(elongation[top]), lowest))
    return found


class Throw(NamedTuple):
    """How far a ship is thrown sideways.

    Attributes
    ----------
    by_attitude : float
        Largest |east| before the gust [m]: by the initial attitude.
    by_gust : float
        How much further east the ship comes than it was when the gust began, within as much time again [m].
    largest : float
        Largest |east| of the flight [m].
    """

    by_attitude: float
    by_gust: float
    largest: float


def throw(flight: Flight) -> Throw:
    """Return how far a ship is thrown sideways [m].

    Notes
    -----
    East is that of P, which in Lotte's file is B; wind and trimmed ship lie in the plane east = 0. The gust blows to
    the east and finds the ship wherever the initial attitude has sent it, so its share is the way gone from there.
    """
    time = flight.data["time"].to_numpy()
    east = flight.data["position"].sel(ground_axis="east").to_numpy()
    after = (time >= GUST_START) & (time <= 2.0 * GUST_START)
    return Throw(
        by_attitude=float(np.abs(east[time < GUST_START]).max()),
        by_gust=float((east[after] - np.interp(GUST_START, time, east)).max(initial=0.0)),
        largest=float(np.abs(east).max()),
    )


def metric(name: str) -> Callable[[Flight], float]:
    """Return what reads a metric of `results.docking_metrics` off a flight, in its unit: [N], [s], [m/s], [deg]."""
    return lambda flight: float(flight.metrics[name])


def read(flights: Flights, reading: Callable[[Flight], T], keys: Iterable[FlightKey] = KEYS) -> dict[FlightKey, T]:
    """Return a fact of each flight that docked; the others have no entry."""
    return {key: reading(flights[key]) for key in keys if key in flights and flights[key].outcome is Outcome.docked}


def holds(found: Mapping[FlightKey, T], keys: Iterable[FlightKey], test: Callable[..., bool]) -> bool:
    """Return whether every one of these flights docked and their facts, in this order, pass a test."""
    wanted = list(keys)
    return bool(wanted) and all(key in found for key in wanted) and bool(test(*(found[key] for key in wanted)))


def tell(flights: Flights, found: Mapping[FlightKey, Any], keys: Iterable[FlightKey] = KEYS) -> dict[str, Any]:
    """Return facts by the flight's name; for a flight that did not dock its outcome, or *not flown*."""
    return {
        name_of(key): found[key] if key in found else flights[key].outcome.name if key in flights else "not flown"
        for key in keys
    }


def name_of(key: FlightKey) -> str:
    """Return a flight's name, of its table and wind [m/s]: `heading, 12 m/s`."""
    return f"{key[0]}, {key[1]:g} m/s"
