"""Flights side by side in three-quarter views, on one scale: Fig. 15 of Riboldi et al. Depends on: matplotlib, view."""

import dataclasses
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import NDArray

from tethership.errors import ConfigError
from tethership.results import HARMFUL
from tethership.simulation import Flight
from tethership.studies.docking_paper.view.ground_box import GroundBox, box_around, draw_box
from tethership.view import style
from tethership.view.flight import Snapshots, View, key_row, ship_keys, ship_outlines, snapshot_indices, take_snapshots

Array = NDArray[np.float64]

AZIMUTH, ELEVATION = np.radians(60.0), np.radians(25.0)
"""Whence the views are, clockwise from north and above the horizon [rad]: north is to the right, east to the left."""

WIDTHS = (8.4, 5.4, 4.7)
"""Width of a view [inch] where there is one in a row, or two, or three, which is the most."""

HEAD, FOOT = 0.72, 0.12
"""Height of the title with the legend, and below the views [inch]."""

CAPTION = 0.5
"""Height of the words above a view [inch]."""

MARGIN = 0.03
"""Space around what is drawn, over its size [-]."""

SHADOW = "#5C4A32"
"""The shadow of B on the ground: dark brown."""


@style.styled
def plot_comparison(flights: Mapping[str, Flight], title: str = "Trajectories compared") -> Figure:
    """Draw flights side by side, in parallel three-quarter views of one scale, as Fig. 15 of Riboldi et al.

    In each view the ship and its cables every 4 s (if a flight is longer than 2 min: 8 s, 16 s, …), the first dark
    green and dashed, the last crimson, cables dashed blue; the path of the centre of buoyancy B in crimson, and its
    shadow on the ground brown.

    Parameters
    ----------
    flights : mapping of str to Flight
        Flights by the words that stand above them, from left to right; three in a row.
    title : str
        Above all of them.

    Returns
    -------
    Figure
        All views on one scale of east, north and altitude [m]; not shown and not saved:
        ``plot_comparison(flights).savefig("comparison.png", dpi=150)``.

    Raises
    ------
    ConfigError
        No flight is given, or one carries a scenario that this version cannot read.
    SolveError
        A flight diverged before its first sample.
    """
    if not flights:
        raise ConfigError("no flights to compare; give at least one, by the words that are to stand above it")
    taken = _alike([take_snapshots(flight) for flight in flights.values()])
    view = three_quarter(AZIMUTH, ELEVATION)
    box = box_around(np.concatenate([_extent(snapshots) for snapshots in taken]), taken[0].ground)
    columns = min(len(taken), len(WIDTHS))
    wide = WIDTHS[columns - 1]
    rows = -(-len(taken) // columns)
    low, high = _limits(taken, box, view)
    tall = wide * (high[1] - low[1]) / (high[0] - low[0])
    height = HEAD + rows * (tall + CAPTION) + FOOT
    figure = Figure(figsize=(wide * columns, height))
    for i, (name, snapshots) in enumerate(zip(flights, taken, strict=True)):
        row, column = divmod(i, columns)
        bottom = (FOOT + (rows - 1 - row) * (tall + CAPTION)) / height
        axes = figure.add_axes((column / columns, bottom, 1.0 / columns, tall / height))
        axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
        axes.set_axis_off()
        draw_box(axes, box, view)
        _draw_flight(axes, snapshots, view)
        _caption(axes, name, snapshots)
    _head(figure, title, taken[0])
    return figure


def three_quarter(azimuth: float, elevation: float) -> View:
    """Return the parallel view from a direction.

    Parameters
    ----------
    azimuth : float
        Direction to the viewer, clockwise from north [rad].
    elevation : float
        Height of the viewer above the horizon [rad], below a right angle.
    """
    toward = np.array([np.cos(azimuth) * np.cos(elevation), np.sin(azimuth) * np.cos(elevation), -np.sin(elevation)])
    right = np.array([np.sin(azimuth), -np.cos(azimuth), 0.0])
    return View("Three-quarter view", ("", ""), np.stack([right, np.cross(toward, right)]), toward)


def _alike(taken: list[Snapshots]) -> list[Snapshots]:
    """Return all snapshots with the longest of their intervals, which are multiples of each other."""
    interval = max(snapshots.interval for snapshots in taken)
    alike = []
    for snapshots in taken:
        kept = np.isin(snapshots.indices, snapshot_indices(snapshots.time, interval))
        indices, rotations = snapshots.indices[kept], snapshots.rotations[kept]
        alike.append(dataclasses.replace(snapshots, interval=interval, indices=indices, rotations=rotations))
    return alike


def _extent(snapshots: Snapshots) -> Array:
    """Return points that hold all that is drawn of a flight, ground axes [m], shape (n, 3)."""
    shape = snapshots.shape
    hull = shape.axis + shape.station[[0, -1], None] * np.array([1.0, 0.0, 0.0])
    body = np.concatenate([hull, shape.fins.reshape(-1, 3)])
    ships = snapshots.values("position")[snapshots.indices, None] + body @ np.swapaxes(snapshots.rotations, 1, 2)
    curves = snapshots.curves[snapshots.indices].reshape(-1, 3)
    points = np.concatenate([snapshots.path, ships.reshape(-1, 3), curves])
    return points[np.isfinite(points).all(axis=1)]


def _limits(taken: list[Snapshots], box: GroundBox, view: View) -> tuple[Array, Array]:
    """Return the lower left and upper right corner of what all views show, paper coordinates [m]."""
    points = [view.project(box.outline(view))]
    for snapshots in taken:
        points.append(view.project(_extent(snapshots)))
        points += [np.concatenate(outlines) for outlines in _outlines(snapshots, view)]
    paper = np.concatenate(points)
    low, high = paper.min(axis=0), paper.max(axis=0)
    margin = MARGIN * (high - low)
    return low - margin, high + margin


def _outlines(snapshots: Snapshots, view: View) -> list[list[Array]]:
    """Return the ship's polygons at each snapshot, paper coordinates [m]."""
    positions = snapshots.values("position")[snapshots.indices]
    return [
        ship_outlines(snapshots.shape, position, rotation, view)
        for position, rotation in zip(positions, snapshots.rotations, strict=True)
    ]


def _draw_flight(axes: Axes, snapshots: Snapshots, view: View) -> None:
    """Draw a flight: shadow, ships, cables, anchors and path."""
    path, ground = snapshots.path, snapshots.ground
    below = path * np.array([1.0, 1.0, 0.0]) - np.array([0.0, 0.0, ground])
    shadow, drawn = view.project(below), view.project(path)
    axes.plot(*shadow.T, color=SHADOW, linewidth=style.THIN, zorder=1.5, gid="shadow")
    ends = [0, len(path) - 1]
    for end, colour in zip(ends, (style.START, style.END), strict=True):
        axes.plot(*np.stack([drawn[end], shadow[end]]).T, color=colour, linewidth=style.THIN, linestyle=":", zorder=1.6)
    _draw_ships(axes, snapshots, view)
    for cable in range(len(snapshots.cables)):
        _draw_cable(axes, snapshots, cable, view)
    axes.plot(*drawn.T, color=style.END, zorder=5, gid="path")
    axes.plot(*drawn[snapshots.indices].T, "o", color=style.END, markersize=2.6, zorder=5, gid="dots")


def _draw_ships(axes: Axes, snapshots: Snapshots, view: View) -> None:
    """Draw the ship at its snapshots: those between, then the start, then the end."""
    outlines = _outlines(snapshots, view)
    last = len(outlines) - 1
    for gid, colour, fill, width, chosen in (
        ("ships", style.BETWEEN, 0.08, style.HAIR, range(1, last)),
        ("start", style.START, 0.25, None, range(min(last, 1))),
        ("end", style.END, 0.25, None, range(last, last + 1)),
    ):
        polygons = [polygon for i in chosen for polygon in outlines[i]]
        ships = PolyCollection(
            polygons,
            edgecolors=colour,
            facecolors=to_rgba(colour, fill),
            linewidths=width,
            linestyles=style.START_LINE if gid == "start" else "-",
            zorder=3,
            gid=gid,
        )
        axes.add_collection(ships, autolim=False)


def _draw_cable(axes: Axes, snapshots: Snapshots, cable: int, view: View) -> None:
    """Draw a cable at the snapshots, its anchor and what holds the anchor above the ground."""
    curves = snapshots.curves[snapshots.indices, cable]
    colour, anchor = style.cable_colour(cable), curves[0, 0]
    lines = LineCollection(
        list(view.project(curves)),
        colors=colour,
        linewidths=style.THIN,
        linestyles=style.cable_line(cable),
        zorder=4,
        gid=f"cable {cable}",
    )
    axes.add_collection(lines, autolim=False)
    foot = np.array([anchor[0], anchor[1], -snapshots.ground])
    axes.plot(*view.project(np.stack([anchor, foot])).T, color=style.INK, zorder=2)
    axes.plot(*view.project(anchor), "^", color=style.INK, markersize=6, zorder=6, gid="anchor")


def _caption(axes: Axes, name: str, snapshots: Snapshots) -> None:
    """Write above a view what it is and how it ended."""
    flight = snapshots.flight
    words = f"{flight.outcome.name.replace('_', ' ')} after {snapshots.time[-1]:.1f} s"
    if snapshots.cables:
        words += f"  ·  largest tension {flight.metrics['tension_max']:.0f} N"
    passed = [name.removeprefix("envelope_").replace("_", " ") for name in HARMFUL if name in flight.limits_passed]
    where = {
        "xycoords": "axes fraction",
        "textcoords": "offset points",
        "xy": (0.19 / (axes.bbox.width / axes.figure.dpi), 1.0),
    }
    axes.annotate(name, xytext=(0, 15), weight="bold", **where)
    axes.annotate(words, xytext=(0, 3), **where)
    if passed:
        limits = f"beyond limits: {', '.join(passed)}"
        axes.annotate(limits, xytext=(0, -4), va="top", zorder=8, **where)


def _head(figure: Figure, title: str, snapshots: Snapshots) -> None:
    """Write the title and explain the views in one row below it."""
    width, height = figure.get_size_inches()
    left = 0.19 / width
    figure.text(left, 1.0 - 0.24 / height, title, fontsize=style.LARGE, weight="bold", va="center")

    handles: list[Patch | Line2D] = [
        *ship_keys(snapshots.interval),
        Line2D([], [], color=style.END, label="centre of buoyancy B"),
        Line2D([], [], color=SHADOW, linewidth=style.THIN, label="its shadow"),
    ]
    if snapshots.cables:
        dashes = style.cable_line(0)
        handles.append(
            Line2D([], [], color=style.cable_colour(0), linewidth=style.THIN, linestyle=dashes, label="cable")
        )
        handles.append(Line2D([], [], color=style.INK, marker="^", linestyle="none", label="anchor"))
    key_row(figure, handles, left - 0.04 / width, 1.0 - 0.52 / height)
