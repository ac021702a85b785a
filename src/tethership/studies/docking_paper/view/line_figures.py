"""Tension of the quasi-static cable beside that of a dynamic line. Depends on: matplotlib."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from tethership.view import style

WINDOW = 1.5
"""Half width of the window about the largest peak [s]."""


@style.styled
def plot_line_comparison(case: Mapping[str, Any]) -> Figure:
    """Draw both tensions over the flight, and about the largest peak.

    Parameters
    ----------
    case : mapping
        `title`, `time` [s], `quasi_static` and `dynamic` [N], `peak_time` [s].
    """
    time, static, dynamic = (np.array(case[key], dtype=float) for key in ("time", "quasi_static", "dynamic"))
    drawn = Figure(figsize=(9.0, 3.0), layout="constrained")
    whole, near = drawn.subplots(1, 2, width_ratios=(2.0, 1.0))
    for axes in (whole, near):
        axes.plot(time, dynamic, color=style.SERIES[1], linewidth=style.THIN, label="dynamic line (MoorDyn)")
        axes.plot(time, static, color=style.SERIES[0], linewidth=style.THIN, label="quasi-static, as flown")
        axes.set_xlabel("time [s]")
    whole.set_ylabel("tension at the tether point [N]")
    whole.set_yscale("symlog", linthresh=20.0)
    whole.set_ylim(0.0, None)
    whole.legend()
    near.set_xlim(case["peak_time"] - WINDOW, case["peak_time"] + WINDOW)
    inside = np.abs(time - case["peak_time"]) < WINDOW
    near.set_ylim(0.0, 1.1 * max(static[inside].max(initial=1.0), dynamic[inside].max(initial=1.0)))
    near.set_title("about the largest peak")
    drawn.suptitle(case["title"])
    return drawn
