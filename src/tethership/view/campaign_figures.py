"""Pictures of a campaign: peaks, times, convergence, tail, importance. Depends on: matplotlib, campaign (its data)."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import scipy.stats
from matplotlib.figure import Figure

from tethership.view import style

COLOURS = style.CABLES
"""One colour a law."""


def plot_peaks(peaks: Mapping[str, np.ndarray], limits: Mapping[str, float]) -> Figure:
    """Draw which share of flights has a peak tension above a level.

    Parameters
    ----------
    peaks : mapping
        Law → peak of each flight [N].
    limits : mapping
        Name → tension [N].
    """
    drawn = Figure(figsize=(7.6, 4.4), layout="constrained")
    axes = drawn.subplots()
    for i, (law, values) in enumerate(peaks.items()):
        ordered = np.sort(values[np.isfinite(values)])
        share = 1.0 - (np.arange(len(ordered)) + 0.5) / len(ordered)
        axes.semilogy(ordered, share, color=COLOURS[i % len(COLOURS)], label=law)
    reached = max(float(np.nanmax(values)) for values in peaks.values())
    for name, level in limits.items():
        if level < 1.6 * reached:
            axes.axvline(level, color="0.5", linewidth=0.8, linestyle="--")
            axes.text(
                level, 1.0, f" {name.replace('_', ' ')}", rotation=90, va="top", fontsize=style.FONT - 1, color="0.35"
            )
    axes.set_xlabel("largest tension at the tether point [N]")
    axes.set_ylabel("share of flights above it [-]")
    axes.legend(frameon=False, fontsize=style.FONT)
    axes.grid(alpha=0.25)
    return drawn


def plot_times(times: Mapping[str, np.ndarray], limit: float | None) -> Figure:
    """Draw how long docking takes: law → time of each flight that docked [s]; the limit [s] where there is one."""
    drawn = Figure(figsize=(7.6, 3.6), layout="constrained")
    axes = drawn.subplots()
    finite = {law: values[np.isfinite(values)] for law, values in times.items()}
    everything = np.concatenate(list(finite.values()))
    if len(everything):
        edges = np.histogram_bin_edges(everything, bins=40).tolist()
        for i, (law, values) in enumerate(finite.items()):
            axes.hist(values, edges, histtype="step", linewidth=1.4, color=COLOURS[i % len(COLOURS)], label=law)
        axes.legend(frameon=False, fontsize=style.FONT)
    if limit is not None:
        axes.axvline(limit, color="0.5", linewidth=0.8, linestyle="--")
    axes.set_xlabel("time to dock [s]")
    axes.set_ylabel("flights")
    return drawn


def plot_convergence(settling: Mapping[str, Mapping[str, np.ndarray]], confidence: float) -> Figure:
    """Draw how probabilities settle: limit → `probability.running`."""
    drawn = Figure(figsize=(7.6, 4.0), layout="constrained")
    axes = drawn.subplots()
    for i, (name, path) in enumerate(settling.items()):
        colour = COLOURS[i % len(COLOURS)]
        axes.fill_between(path["flights"], path["low"], path["high"], color=colour, alpha=0.15, linewidth=0)
        dash = "-" if i < len(COLOURS) else "--"
        axes.semilogx(path["flights"], path["probability"], dash, color=colour, label=name.replace("_", " "))
    axes.set_xlabel("flights")
    axes.set_ylabel(f"probability, {100 * confidence:g} % interval [-]")
    axes.legend(frameon=False, fontsize=style.FONT)
    axes.grid(alpha=0.25)
    return drawn


def plot_tail(peaks: np.ndarray, tail: Mapping[str, Any]) -> Figure:
    """Draw fitted beside empirical quantiles of the excess, and the return levels with their intervals.

    Parameters
    ----------
    peaks : ndarray
        Peak of each flight [N].
    tail : mapping
        From `answers.tail_data`.
    """
    drawn = Figure(figsize=(9.0, 3.9), layout="constrained")
    left, right = drawn.subplots(1, 2)
    excess = np.sort(peaks[np.isfinite(peaks) & (peaks > tail["threshold"])])[: tail["excesses"]] - tail["threshold"]
    rank = (np.arange(len(excess)) + 0.5) / (tail["excesses"] + tail["censored"])
    fitted = scipy.stats.genpareto.ppf(rank, tail["shape"], 0.0, tail["scale"])
    left.plot(fitted, excess, ".", color=COLOURS[0], markersize=4)
    top = max(fitted[-1], excess[-1])
    left.plot([0, top], [0, top], color="0.6", linewidth=0.8)
    left.set_xlabel(f"fitted excess over {tail['threshold']:.0f} N [N]")
    left.set_ylabel("excess flown [N]")
    place = [entry["probability"] for entry in tail["levels"]]
    level = np.array([entry["level"] for entry in tail["levels"]])
    ends = np.array([[entry["low"], entry["high"]] for entry in tail["levels"]]).T
    right.errorbar(place, level, np.abs(ends - level), fmt="o", color=COLOURS[0], capsize=3)
    right.set_xscale("log")
    right.set_yscale("log")
    right.invert_xaxis()
    right.set_xlabel("probability per flight [-]")
    right.set_ylabel("tension exceeded with it [N]")
    right.grid(alpha=0.25)
    return drawn


def plot_importance(entries: Sequence[Mapping[str, Any]]) -> Figure:
    """Draw rank correlations, and Sobol's total indices where the design gave them; entries from `Importance`."""
    sobol = entries[0]["total"] is not None
    drawn = Figure(figsize=(7.6, 0.34 * len(entries) + 1.2), layout="constrained")
    axes = drawn.subplots()
    rows = np.arange(len(entries))
    if sobol:
        total = np.array([entry["total"] for entry in entries])
        ends = np.array([[entry["total_low"], entry["total_high"]] for entry in entries]).T
        reach = np.maximum(np.abs(ends - total), 0.0)
        axes.barh(rows - 0.18, total, 0.34, color=COLOURS[0], xerr=reach, label="Sobol total")
        axes.barh(rows + 0.18, [entry["first"] for entry in entries], 0.34, color=COLOURS[1], label="Sobol first order")
        axes.legend(frameon=False, fontsize=style.FONT)
        axes.set_xlabel("share of the variance of the peak tension [-]")
    else:
        axes.barh(rows, [entry["rank_correlation"] for entry in entries], 0.6, color=COLOURS[0])
        axes.axvline(0.0, color="0.4", linewidth=0.8)
        axes.set_xlabel("rank correlation with the peak tension [-]")
    axes.set_yticks(rows, [entry["name"] for entry in entries], fontsize=style.FONT)
    axes.invert_yaxis()
    return drawn
