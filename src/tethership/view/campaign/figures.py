"""Pictures of a campaign: limits, peaks, times, convergence, tail, importance. Depends on: matplotlib, campaign's data.

Each takes the axes to draw into, makes new ones if none are given, and returns them.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import scipy.stats
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import PercentFormatter

from tethership.view import style

COLOURS = style.SERIES
"""One colour a law."""

WIDTH = 7.6
"""Width of a new figure [inch]."""


def new_axes(axes: Axes | None, height: float) -> Axes:
    """Return the axes that are given, or new ones of a height [inch]."""
    return Figure(figsize=(WIDTH, height), layout="constrained").subplots() if axes is None else axes


@style.styled
def plot_limits(found: Mapping[str, Mapping[str, Mapping[str, Any]]], confidence: float, axes: Axes | None) -> Axes:
    """Draw the probability of exceeding each limit with its interval.

    Parameters
    ----------
    found : mapping
        Law → limit → `probability`, `low`, `high` [-], as in `answers["laws"][law]["exceedance"]`.
    confidence : float
        Of the intervals [-].
    axes : Axes or None
        Where to draw.
    """
    limits = list(next(iter(found.values())))
    axes = new_axes(axes, 0.32 * len(limits) * max(1.0, 0.6 * len(found)) + 1.2)
    step = 0.6 / len(found)
    for i, (law, rows) in enumerate(found.items()):
        place = np.arange(len(limits)) + step * (i - 0.5 * (len(found) - 1))
        middle = np.array([rows[limit]["probability"] for limit in limits], float)
        low, high = (
            np.array([rows[limit][end] for limit in limits], dtype=float) for end in ("low", "high")
        )  # None, where there is no interval, becomes NaN and is not drawn
        reach = np.stack([middle - low, high - middle]).clip(0.0)
        axes.errorbar(middle, place, xerr=reach, fmt="o", markersize=4, capsize=2.5, color=COLOURS[i % len(COLOURS)])
        axes.plot([], [], "o", color=COLOURS[i % len(COLOURS)], markersize=4, label=law)
    axes.set_yticks(np.arange(len(limits)), [limit.replace("_", " ") for limit in limits])
    axes.invert_yaxis()
    axes.set_xlim(-0.02, 1.02)
    axes.xaxis.set_major_formatter(PercentFormatter(1.0))
    axes.set_xlabel(f"probability of exceeding the limit, {100 * confidence:g} % interval")
    axes.grid(False, axis="y")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return axes


@style.styled
def plot_peaks(peaks: Mapping[str, np.ndarray], limits: Mapping[str, float], axes: Axes | None = None) -> Axes:
    """Draw which share of flights has a peak tension above a level.

    Parameters
    ----------
    peaks : mapping
        Law → peak of each flight [N].
    limits : mapping
        Name → tension [N].
    axes : Axes, optional
        Where to draw.
    """
    axes = new_axes(axes, 4.4)
    for i, (law, values) in enumerate(peaks.items()):
        ordered = np.sort(values[np.isfinite(values)])
        share = 1.0 - (np.arange(len(ordered)) + 0.5) / max(len(ordered), 1)
        axes.semilogy(ordered, share, color=COLOURS[i % len(COLOURS)], label=law)
    reached = max((float(np.nanmax(values)) for values in peaks.values() if np.isfinite(values).any()), default=0.0)
    for name, level in limits.items():
        if level < 1.6 * reached:
            axes.axvline(level, color="0.5", linewidth=style.THIN, linestyle="--")
            axes.text(
                level, 1.0, f" {name.replace('_', ' ')}", rotation=90, va="top", fontsize=style.SMALL, color="0.35"
            )
    axes.set_xlabel("largest tension at the tether point [N]")
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))
    axes.set_ylabel("share of flights above it")
    axes.legend()
    return axes


@style.styled
def plot_times(times: Mapping[str, np.ndarray], limit: float | None, axes: Axes | None = None) -> Axes:
    """Draw how long docking takes: law → time of each flight that docked [s]; the limit [s] where there is one."""
    axes = new_axes(axes, 3.6)
    finite = {law: values[np.isfinite(values)] for law, values in times.items()}
    everything = np.concatenate(list(finite.values()))
    if len(everything):
        edges = np.histogram_bin_edges(everything, bins=40).tolist()
        for i, (law, values) in enumerate(finite.items()):
            axes.hist(values, edges, histtype="step", color=COLOURS[i % len(COLOURS)], label=law)
        axes.legend()
    if limit is not None:
        axes.axvline(limit, color="0.5", linewidth=style.THIN, linestyle="--")
    axes.set_xlabel("time to dock [s]")
    axes.set_ylabel("flights")
    return axes


@style.styled
def plot_convergence(
    settling: Mapping[str, Mapping[str, np.ndarray]], confidence: float, axes: Axes | None = None
) -> Axes:
    """Draw how probabilities [-] settle: limit → `probability.running`; `confidence` is of the intervals [-]."""
    axes = new_axes(axes, 4.0)
    for i, (name, path) in enumerate(settling.items()):
        colour = COLOURS[i % len(COLOURS)]
        axes.fill_between(path["flights"], path["low"], path["high"], color=colour, alpha=0.12, linewidth=0)
        dash = "-" if i < len(COLOURS) else "--"
        axes.semilogx(path["flights"], path["probability"], dash, color=colour, label=name.replace("_", " "))
    axes.set_xlabel("flights")
    axes.yaxis.set_major_formatter(PercentFormatter(1.0))
    axes.set_ylabel(f"probability, {100 * confidence:g} % interval")
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return axes


@style.styled
def plot_importance(entries: Sequence[Mapping[str, Any]], axes: Axes | None = None) -> Axes:
    """Draw rank correlations [-], and Sobol's indices [-] where the design gave them; entries from `Importance`."""
    sobol = entries[0]["total"] is not None
    axes = new_axes(axes, 0.34 * len(entries) + 1.2)
    rows = np.arange(len(entries))
    if sobol:
        total = np.array([entry["total"] for entry in entries])
        ends = np.array([[entry["total_low"], entry["total_high"]] for entry in entries]).T
        reach = np.maximum(np.abs(ends - total), 0.0)
        axes.barh(rows - 0.18, total, 0.34, color=COLOURS[0], xerr=reach, label="Sobol total")
        axes.barh(rows + 0.18, [entry["first"] for entry in entries], 0.34, color=COLOURS[1], label="Sobol first order")
        axes.legend()
        axes.set_xlabel("share of the variance of the peak tension [-]")
    else:
        axes.barh(rows, [entry["rank_correlation"] for entry in entries], 0.6, color=COLOURS[0])
        axes.axvline(0.0, color="0.4", linewidth=style.THIN)
        axes.set_xlabel("rank correlation with the peak tension [-]")
    axes.grid(False, axis="y")
    axes.set_yticks(rows, [entry["name"] for entry in entries])
    axes.invert_yaxis()
    return axes


@style.styled
def plot_tail(peaks: np.ndarray, tail: Mapping[str, Any]) -> Figure:
    """Draw fitted beside empirical quantiles of the excess, and the return levels with their intervals.

    Parameters
    ----------
    peaks : ndarray
        Peak of each flight [N].
    tail : mapping
        From `answers.tail_data`, its tensions [N].
    """
    drawn = Figure(figsize=(9.0, 3.9), layout="constrained")
    left, right = drawn.subplots(1, 2)
    excess = np.sort(peaks[np.isfinite(peaks) & (peaks > tail["threshold"])])[: tail["excesses"]] - tail["threshold"]
    rank = (np.arange(len(excess)) + 0.5) / (tail["excesses"] + tail["censored"])
    fitted = scipy.stats.genpareto.ppf(rank, tail["shape"], 0.0, tail["scale"])
    left.plot(fitted, excess, ".", color=COLOURS[0], markersize=4)
    top = max(fitted[-1], excess[-1])
    left.plot([0, top], [0, top], color="0.6", linewidth=style.THIN)
    left.set_xlabel(f"fitted excess over {tail['threshold']:.0f} N [N]")
    left.set_ylabel("excess flown [N]")
    place = [entry["probability"] for entry in tail["levels"]]
    level = np.array([entry["level"] for entry in tail["levels"]])
    ends = np.array([[entry["low"], entry["high"]] for entry in tail["levels"]]).T
    right.errorbar(place, level, np.abs(ends - level), fmt="o", color=COLOURS[0], capsize=3)
    right.set_xscale("log")
    right.set_yscale("log")
    right.invert_xaxis()
    right.xaxis.set_major_formatter(PercentFormatter(1.0))
    right.set_xlabel("probability per flight")
    right.set_ylabel("tension exceeded with it [N]")
    return drawn
