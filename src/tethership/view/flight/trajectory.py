"""One view of a flight: snapshots of ship and cables, path of B, anchors, ground. Depends on: matplotlib, snapshots."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import to_rgba
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from tethership.view import style
from tethership.view.flight.projection import View
from tethership.view.flight.ship import ship_outlines
from tethership.view.flight.snapshots import Snapshots

Array = NDArray[np.float64]

MARGIN = 0.06
"""Space around what is drawn, over its size [-]."""


def draw_view(axes: Axes, snapshots: Snapshots, view: View) -> None:
    """Draw a flight as it is seen from one side, equal scales, paper coordinates [m].

    Parameters
    ----------
    axes : Axes
        Where it is drawn.
    snapshots : Snapshots
        From `take_snapshots`.
    view : View
        Where it is seen from.
    """
    path = view.project(snapshots.path)
    drawn = [path, _draw_ships(axes, snapshots, view), *_draw_cables(axes, snapshots, view)]
    axes.plot(
        path[:, 0],
        path[:, 1],
        color=style.END,
        marker="o",
        markersize=2.6,
        markevery=snapshots.indices.tolist(),
        zorder=5,
        gid="path",
    )
    points = np.concatenate(drawn)
    points = points[np.isfinite(points).all(axis=1)]
    _fit(axes, points)
    _dress(axes, view)
    if view.shows_altitude:
        _draw_ground(axes, snapshots.ground)
    _draw_wind(axes, snapshots.values("wind")[0], view, points)


def _order(count: int) -> list[int]:
    """Return in which order snapshots are painted: those between, then the start, then the end."""
    return [*range(1, count - 1), *range(min(count, 1)), *range(max(count - 1, 1), count)]


def _draw_ships(axes: Axes, snapshots: Snapshots, view: View) -> Array:
    """Draw the ship at all snapshots; return the points of its outlines [m], shape (n, 2)."""
    count = len(snapshots.indices)
    position = snapshots.values("position")
    polygons: list[Array] = []
    edges, faces, widths, lines = [], [], [], []
    for i in _order(count):
        colour, fill, width = style.BETWEEN, 0.08, style.HAIR
        if i in (0, count - 1):
            colour, fill, width = (style.START if i == 0 else style.END), 0.22, style.SHEET["patch.linewidth"]
        outlines = ship_outlines(snapshots.shape, position[snapshots.indices[i]], snapshots.rotations[i], view)
        polygons += outlines
        edges += [to_rgba(colour)] * len(outlines)
        faces += [to_rgba(colour, fill)] * len(outlines)
        widths += [width] * len(outlines)
        lines += [style.START_LINE if i == 0 else "-"] * len(outlines)
    ships = PolyCollection(
        polygons, edgecolors=edges, facecolors=faces, linewidths=widths, linestyles=lines, zorder=3, gid="ships"
    )
    axes.add_collection(ships, autolim=False)
    return np.concatenate(polygons)


def _draw_cables(axes: Axes, snapshots: Snapshots, view: View) -> list[Array]:
    """Draw all cables at all snapshots, and their anchors; return their points [m], each of shape (n, 2)."""
    drawn = []
    ground = snapshots.ground
    for cable in range(len(snapshots.cables)):
        curves = view.project(snapshots.curves[snapshots.indices, cable])
        colour = style.cable_colour(cable)
        lines = LineCollection(
            list(curves),
            colors=colour,
            linewidths=style.THIN,
            linestyles=style.cable_line(cable),
            zorder=4,
            gid=f"cable {cable}",
        )
        axes.add_collection(lines, autolim=False)
        anchor = curves[0, 0]
        axes.plot(*anchor, marker="^", markersize=7, color=style.INK, zorder=6, linestyle="none", gid="anchor")
        if view.shows_altitude and anchor[1] > ground:
            axes.plot([anchor[0]] * 2, [ground, anchor[1]], color=style.INK, zorder=2)
        drawn.append(curves.reshape(-1, 2))
    return drawn


def _fit(axes: Axes, points: Array) -> None:
    """Set the limits around points [m], with equal scales that fill the axes."""
    low, high = points.min(axis=0), points.max(axis=0)
    middle, size = 0.5 * (low + high), (1.0 + 2.0 * MARGIN) * (high - low)
    box = axes.get_window_extent()
    paper = np.array([box.width, box.height])
    half = 0.5 * paper * np.max(size / paper)
    axes.set_xlim(middle[0] - half[0], middle[0] + half[0])
    axes.set_ylim(middle[1] - half[1], middle[1] + half[1])
    axes.set_aspect("equal", adjustable="box")


def _draw_ground(axes: Axes, altitude: float) -> None:
    """Fill what is below the ground's altitude [m]."""
    axes.axhspan(altitude - 1e4, altitude, facecolor=style.GROUND, edgecolor="none", zorder=0, gid="soil")
    axes.axhline(altitude, color=style.INK, linewidth=style.THIN, zorder=1, gid="ground")


def _draw_wind(axes: Axes, wind: Array, view: View, points: Array) -> None:
    """Draw an arrow along a wind in the emptier upper corner, unless it blows along the line of sight.

    Parameters
    ----------
    axes : Axes
        A view with its limits set.
    wind : Array
        Ground axes [m/s], shape (3,).
    view : View
        Where it is seen from.
    points : Array
        What is drawn, paper coordinates [m], shape (n, 2).
    """
    speed = float(np.linalg.norm(wind))
    seen = view.project(wind / speed) if speed > 0 else np.zeros(2)
    share = float(np.linalg.norm(seen))
    if share < 0.3:
        return
    seen = seen / share * np.array([-1.0 if view.leftward else 1.0, 1.0])
    axes.annotate(
        "wind",
        xy=tuple(_free_corner(axes, points) + 0.06 * seen),
        xycoords="axes fraction",
        xytext=tuple(-34.0 * seen),
        textcoords="offset points",
        fontsize=style.SMALL,
        ha="center",
        va="center",
        arrowprops={"arrowstyle": "-|>", "color": style.INK, "linewidth": style.THIN},
        gid="wind",
    )


def _free_corner(axes: Axes, points: Array) -> Array:
    """Return the upper corner with fewer points [m] around, right if it is all the same, over the axes' size [-]."""
    place = axes.transAxes.inverted().transform(axes.transData.transform(points))
    corners = np.array([[0.91, 0.88], [0.09, 0.88]])
    crowd = [int(np.sum(np.all(np.abs(place - corner) < (0.09, 0.12), axis=1))) for corner in corners]
    return corners[int(np.argmin(crowd))]


def _dress(axes: Axes, view: View) -> None:
    """Label the axes."""
    axes.set_title(view.title)
    axes.set_xlabel(view.labels[0])
    axes.set_ylabel(view.labels[1])
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_locator(MaxNLocator(nbins=8, steps=[1, 2, 5, 10]))
    if view.leftward:
        axes.invert_xaxis()
