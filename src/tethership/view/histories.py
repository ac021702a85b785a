"""Time histories of a docking: cable length and distance, tension, rewind rate. Depends on: matplotlib, snapshots."""

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from tethership.view import style
from tethership.view.snapshots import Snapshots

Array = NDArray[np.float64]

LABEL_GAP = 0.085
"""Least distance of two labels beside an axis, over its height [-]."""


def draw_histories(axes: tuple[Axes, Axes, Axes], snapshots: Snapshots) -> None:
    """Draw three histories under each other, against one time axis [s].

    Parameters
    ----------
    axes : tuple of Axes
        For lengths [m], tensions [N] and rewind rates [m/s], from top to bottom, sharing their time axis.
    snapshots : Snapshots
        From `take_snapshots`; its instants are marked by dots.
    """
    lengths, tensions, rates = axes
    for axis in axes:
        _dress(axis, snapshots)
    _draw_lengths(lengths, snapshots)
    _draw_tensions(tensions, snapshots)
    _draw_each(rates, snapshots, "rewind_rate")
    rates.set_ylabel("rewind rate\n[m/s]", fontsize=style.FONT)
    rates.set_xlabel("time [s]", fontsize=style.FONT)
    rates.set_ylim(bottom=min(0.0, rates.get_ylim()[0]))
    lengths.set_title("Time histories", fontsize=style.FONT, color=style.INK, loc="left")
    for axis in (lengths, tensions):
        axis.tick_params(labelbottom=False)
    if not snapshots.cables:
        tensions.text(0.5, 0.5, "no cable", transform=tensions.transAxes, ha="center", fontsize=style.FONT)


def _draw_each(axes: Axes, snapshots: Snapshots, name: str, linestyle: str = "-", dots: bool = True) -> None:
    """Draw an output of every cable in its unit, with dots at the snapshots."""
    values = snapshots.values(name)
    for cable, label in enumerate(snapshots.cables):
        axes.plot(
            snapshots.time,
            values[:, cable],
            color=style.cable_colour(cable),
            linestyle=linestyle,
            linewidth=1.2,
            marker="o" if dots else "",
            markersize=3.2,
            markevery=snapshots.indices.tolist(),
            label=label,
            zorder=3,
            gid=f"{name} {cable}",
        )


def _draw_lengths(axes: Axes, snapshots: Snapshots) -> None:
    """Draw cable lengths and distances of tether points from anchors [m]."""
    _draw_each(axes, snapshots, "cable_length")
    _draw_each(axes, snapshots, "distance", linestyle=(0, (3, 1.5)), dots=False)
    axes.set_ylabel("length\n[m]", fontsize=style.FONT)
    axes.set_ylim(0.0, 1.3 * axes.get_ylim()[1])
    if not snapshots.cables:
        return
    several = len(snapshots.cables) > 1
    handles = [line for line in axes.get_lines() if several or line.get_gid() in ("cable_length 0", "distance 0")]
    ends = {"cable_length": "cable length", "distance": "anchor to tether point"}
    names = [
        f"{line.get_label()}: {ends[str(line.get_gid()).split()[0]]}"
        if several
        else ends[str(line.get_gid()).split()[0]]
        for line in handles
    ]
    axes.legend(handles, names, fontsize=style.SMALL, frameon=False, loc="upper right", ncols=2)


def _draw_tensions(axes: Axes, snapshots: Snapshots) -> None:
    """Draw tensions at the tether points [N], logarithmic, with the limits watched."""
    _draw_each(axes, snapshots, "tension")
    tension = snapshots.values("tension")
    limits = dict(snapshots.config.limits)
    positive = tension[tension > 0]
    low = float(positive.min()) if positive.size else 10.0
    high = max([*limits.values(), float(tension.max(initial=0.0))])
    axes.set_yscale("log", nonpositive="clip")
    axes.set_ylim(10.0 ** np.floor(np.log10(max(low, 0.1))), 1.5 * high)
    axes.set_ylabel("tension\n[N]", fontsize=style.FONT)
    _draw_limits(axes, list(limits), list(snapshots.flight.attributes["limits"]))


def _draw_limits(axes: Axes, names: list[str], limits: list[float]) -> None:
    """Draw watched tensions [N] as lines with their names on the right."""
    bottom, top = np.log(axes.get_ylim())
    places = spread((np.log(limits) - bottom) / (top - bottom), LABEL_GAP)
    for i, (name, limit, place) in enumerate(zip(names, limits, places, strict=True)):
        colour = style.LIMITS[i % len(style.LIMITS)]
        axes.axhline(limit, color=colour, linewidth=0.9, linestyle=(0, (6, 2)), zorder=2, gid=name)
        axes.text(
            1.015,
            place,
            f"{name.replace('_', ' ')} {limit:g} N",
            transform=axes.transAxes,
            fontsize=style.SMALL,
            color=colour,
            va="center",
        )


def spread(places: Array, gap: float) -> Array:
    """Return rising places moved apart as little as needed for a least gap, in the same unit."""
    moved = np.array(places, dtype=float)
    for _ in range(100):
        lack = np.clip(gap - np.diff(moved), 0.0, None)
        moved[:-1] -= 0.5 * lack
        moved[1:] += 0.5 * lack
    return moved


def _dress(axes: Axes, snapshots: Snapshots) -> None:
    """Set the time axis, the grid and the gusts' shades."""
    start, end = float(snapshots.time[0]), float(snapshots.time[-1])
    axes.set_xlim(start, max(end, start + 1e-3))
    axes.tick_params(labelsize=style.SMALL)
    axes.grid(color=style.GUIDE, linewidth=0.5)
    axes.set_axisbelow(True)
    for gust in snapshots.config.gusts:
        axes.axvspan(gust.start, gust.start + gust.period, facecolor=style.GUST, edgecolor="none", zorder=0, gid="gust")
