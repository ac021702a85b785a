"""Time histories of a docking: cable length and distance, tension, rewind rate. Depends on: matplotlib, snapshots."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from matplotlib.typing import LineStyleType
from numpy.typing import NDArray

from tethership.view import style
from tethership.view.flight.snapshots import Snapshots

Array = NDArray[np.float64]

DISTANCE: LineStyleType = (0.0, (3.0, 1.5))
"""Dashes of distances."""

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
    for axis, label in zip(axes, ("length\n[m]", "tension\n[N]", "rewind rate\n[m/s]"), strict=True):
        _dress(axis, snapshots)
        axis.set_ylabel(label)
        axis.yaxis.set_label_coords(-0.11, 0.5)
    lengths.set_title("Time histories")
    rates.set_xlabel("time [s]")
    for axis in (lengths, tensions):
        axis.tick_params(labelbottom=False)
    if not snapshots.cables:
        for axis in axes:
            axis.set_yticks([])
            axis.text(0.5, 0.5, "no cable", transform=axis.transAxes, ha="center", va="center")
        return
    _draw_lengths(lengths, snapshots)
    _draw_tensions(tensions, snapshots)
    _draw_rates(rates, snapshots)


def _draw_each(axes: Axes, snapshots: Snapshots, name: str, linestyle: LineStyleType = "-", dots: bool = True) -> None:
    """Draw an output of every cable in its unit, with dots at the snapshots."""
    values = snapshots.values(name)
    for cable, label in enumerate(snapshots.cables):
        axes.plot(
            snapshots.time,
            values[:, cable],
            color=style.cable_colour(cable),
            linestyle=linestyle,
            marker=style.mark(cable) if dots else "",
            markersize=3.2,
            markevery=snapshots.indices.tolist(),
            label=label,
            zorder=3,
            gid=f"{name} {cable}",
        )


def _draw_lengths(axes: Axes, snapshots: Snapshots) -> None:
    """Draw cable lengths and distances of tether points from anchors [m]."""
    _draw_each(axes, snapshots, "cable_length")
    _draw_each(axes, snapshots, "distance", linestyle=DISTANCE, dots=False)
    axes.set_ylim(0.0, 1.55 * axes.get_ylim()[1])
    axes.yaxis.set_major_locator(MaxNLocator(nbins=4, steps=[1, 2, 5, 10]))
    handles = [
        Line2D([], [], color=style.INK, marker="o", markersize=3.2, label="cable length"),
        Line2D([], [], color=style.INK, linestyle=DISTANCE, label="anchor to tether point"),
    ]
    axes.legend(handles=handles, loc="upper right", ncols=2)


def _draw_tensions(axes: Axes, snapshots: Snapshots) -> None:
    """Draw tensions at the tether points [N], logarithmic, with the limits watched."""
    _draw_each(axes, snapshots, "tension")
    tension = snapshots.values("tension")
    limits = snapshots.flight.attributes["limits"]
    low = float(np.min(tension, where=tension > 0.1, initial=100.0))
    high = max(*limits, float(tension.max()))
    axes.set_yscale("log", nonpositive="clip")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set_ylim(10.0 ** np.floor(np.log10(low)), 1.5 * high)
    _draw_limits(axes, [name for name, _ in snapshots.config.limits], limits)


def _draw_rates(axes: Axes, snapshots: Snapshots) -> None:
    """Draw the rates at which the winches take cable in [m/s]."""
    _draw_each(axes, snapshots, "rewind_rate")
    rates = snapshots.values("rewind_rate")
    low, high = min(0.0, float(rates.min())), max(0.1, float(rates.max()))
    axes.set_ylim(low - 0.05 * (high - low), high + 0.15 * (high - low))


def _draw_limits(axes: Axes, names: list[str], limits: list[float]) -> None:
    """Draw watched tensions [N] as lines with their names on the right."""
    bottom, top = np.log(axes.get_ylim())
    places = spread((np.log(limits) - bottom) / (top - bottom), LABEL_GAP)
    for i, (name, limit, place) in enumerate(zip(names, limits, places, strict=True)):
        colour = style.LIMITS[i % len(style.LIMITS)]
        axes.axhline(limit, color=colour, linewidth=style.THIN, linestyle=(0, (6, 2)), zorder=2, gid=name)
        axes.text(
            1.015,
            place,
            f"{name.replace('_', ' ')} {limit:g}",
            transform=axes.transAxes,
            fontsize=style.SMALL,
            color=colour,
            va="center",
        )


def spread(places: Array, gap: float) -> Array:
    """Return rising places moved apart as little as needed for a least gap, in the same unit.

    Parameters
    ----------
    places : Array
        Any unit; labels have theirs over the axis' height [-]. Shape (n,).
    gap : float
        Least distance of neighbours, in that unit.
    """
    moved = np.array(places, dtype=float)
    for _ in range(100):
        lack = np.clip(gap - np.diff(moved), 0.0, None)
        moved[:-1] -= 0.5 * lack
        moved[1:] += 0.5 * lack
    return moved


def _dress(axes: Axes, snapshots: Snapshots) -> None:
    """Set the time axis and the gusts' shades."""
    start, end = float(snapshots.time[0]), float(snapshots.time[-1])
    axes.set_xlim(start, max(end, start + 1e-3))
    for gust in snapshots.config.gusts:
        axes.axvspan(gust.start, gust.start + gust.period, facecolor=style.GUST, edgecolor="none", zorder=0, gid="gust")
