"""The quasi-static cable of a flight beside a dynamic line moved in the same way: peaks, snaps, differences.

Depends on: dynamic_cable (MoorDyn), simulation. The motion is that of the recorded flight, so the line
shows what tension that motion asks of it, not how a flight with it would have gone on.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tethership.simulation import Flight, outside
from tethership.studies.docking_paper.dynamic_cable import dynamic_line
from tethership.studies.docking_paper.flights_read import CONTROL_THRESHOLD

Array = NDArray[np.float64]

SEGMENTS = 10
"""Segments of the line: 20 give the same peaks within 1 % at four times the cost (tests)."""

BEGUN = 2.0
"""Time left out at the start [s]: the winch's sudden start jolts a line that hung at rest, for a second and a half."""

APART = 0.3
"""Snaps nearer than this are one [s]."""

MATCHED = 0.25
"""Largest time between a snap of one and its like of the other [s]."""

FLOOR = 20.0
"""Tension below which a difference counts as if it were of this [N]."""

KEPT = 8
"""Every so many samples are kept for a picture, besides those near the peak."""


def snaps(time: Array, tension: Array) -> list[float]:
    """Return the times [s] at which the tension rises through the control threshold."""
    over = tension > CONTROL_THRESHOLD
    rising = time[1:][over[1:] & ~over[:-1]]
    kept: list[float] = []
    for moment in rising:
        if not kept or moment - kept[-1] > APART:
            kept.append(float(moment))
    return kept


def _matched(first: list[float], second: list[float]) -> list[float]:
    """Return the delays [s] of the second's snaps after the first's, where there is one near enough."""
    delays = [min((other - moment for other in second), key=abs, default=np.inf) for moment in first]
    return [delay for delay in delays if abs(delay) <= MATCHED]


def compare_line(flight: Flight, title: str, segments: int = SEGMENTS) -> dict[str, Any]:
    """Return the comparison of a flight's first cable with a dynamic line, as plain data.

    Parameters
    ----------
    flight : Flight
        Recorded.
    title : str
        In words.
    segments : int
        Of the line.

    Returns
    -------
    dict
        Peaks and differences of tension [N], their ratio and correlation [-], `time` and `peak_time` [s]; `snap_delay`
        is in [ms], `outside` a share of the time [-].

    Notes
    -----
    `trusted` and `untrusted` have the median and the 90th percentile of the relative difference [-], over the larger
    tension (at least 20 N), inside and outside the range of `quasi_static`; `worst_trusted` is the largest difference
    inside [N].

    Raises
    ------
    ConfigError, SolveError
        As `dynamic_line`.
    """
    line = dynamic_line(flight, segments=segments)
    time = flight.data["time"].to_numpy()
    static, dynamic = flight.data["tension"].to_numpy()[:, 0], line["tension"].to_numpy()
    use, away = time >= BEGUN, outside(flight)
    difference = np.abs(static - dynamic) / np.maximum(np.maximum(static, dynamic), FLOOR)
    own, lines = snaps(time[use], static[use]), snaps(time[use], dynamic[use])
    delays = _matched(own, lines)
    peak = int(np.argmax(np.where(use, static, 0.0)))
    near = np.abs(time - time[peak]) < 1.5
    shown = near | (np.arange(len(time)) % KEPT == 0)
    return {
        "title": title,
        "peak_quasi_static": float(static[use].max()),
        "peak_dynamic": float(dynamic[use].max()),
        "peak_ratio": float(static[use].max() / dynamic[use].max()),
        "peak_time": float(time[peak]),
        "rms_difference": float(np.sqrt(np.mean((static - dynamic)[use] ** 2))),
        "correlation": float(np.corrcoef(static[use], dynamic[use])[0, 1]),
        "snaps_quasi_static": len(own),
        "snaps_dynamic": len(lines),
        "snaps_matched": len(delays),
        "snap_delay": 1000.0 * float(np.median(delays)) if delays else None,
        "outside": float(away[use].mean()),
        "trusted": _told(difference[use], ~away[use]),
        "untrusted": _told(difference[use], away[use]),
        "worst_trusted": float(np.abs(static - dynamic)[use & ~away].max(initial=0.0)),
        "time": time[shown].round(4).tolist(),
        "quasi_static": static[shown].round(2).tolist(),
        "dynamic": dynamic[shown].round(2).tolist(),
    }


def _told(difference: Array, some: NDArray[np.bool_]) -> dict[str, float | None]:
    """Return median and 90th percentile of the relative differences of some instants; None where there is none."""
    chosen = difference[some]
    if not len(chosen):
        return {"median": None, "high": None}
    return {"median": float(np.median(chosen)), "high": float(np.percentile(chosen, 90.0))}
