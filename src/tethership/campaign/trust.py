"""How far a campaign's tensions may be trusted: flights outside the quasi-static cable's range, and the snap's wave.

Depends on: campaign.store's names. A batch sums up both while it flies (`simulation.tally`); why they matter is in
`simulation.quasi_static`. The wave v√(EA m) of a flight's hardest snap is added to its peaks whole, wherever in the
flight they were: what comes of it is an upper bound.
"""

from typing import Any

import numpy as np
import xarray as xr

ON_TENSION = ("control_threshold", "envelope_tear", "envelope_tensile", "cable_break", "winch_pull")
"""Limits whose verdict hangs on a peak of tension."""

PEAKS = ("tension_max", "tension_largest", "tension_anchor")
"""Peaks of a flight to which the wave is added."""


def with_snap(data: xr.Dataset) -> xr.Dataset:
    """Return results whose peaks [N] have the wave of the flight's hardest snap added."""
    return data.assign({name: data[name] + data["snap_impulse"] for name in PEAKS})


def share_outside(data: xr.Dataset, law: int, counted: np.ndarray) -> dict[str, Any]:
    """Return how long the cable was outside its range under one law, over the flights that count; None without any.

    Parameters
    ----------
    data : xr.Dataset
        From `open_results`.
    law : int
        Its place.
    counted : ndarray of bool
        Flights that have a result, shape (cases,).

    Returns
    -------
    dict
        `median` and `largest` share of the flight [-], `impulse`, the largest wave of a snap [N].
    """
    shares = data["quasi_static_outside"].values[law][counted]
    if not len(shares):
        return {"median": None, "largest": None, "impulse": None}
    return {
        "median": float(np.median(shares)),
        "largest": float(np.max(shares)),
        "impulse": float(np.max(data["snap_impulse"].values[law][counted])),
    }
