"""The ground seen from above at an angle, with its grid and scales. Depends on: matplotlib, view."""

from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Polygon
from numpy.typing import NDArray

from tethership.view import style
from tethership.view.flight import View

Array = NDArray[np.float64]

STEP = 5.0
"""Between grid lines [m]; doubled until there are few enough."""

MOST_LINES = 9
"""Most grid lines along a side."""

ROOM = 0.13
"""Room for labels beside the grid, over its larger side [-]."""


class GroundBox(NamedTuple):
    """A rectangle of ground and what stands on it.

    Attributes
    ----------
    low, high : Array
        Its southern western and its northern eastern corner [m], shape (2,).
    ground, top : float
        Altitudes of the ground and of the highest mark [m].
    step : float
        Between grid lines [m].
    """

    low: Array
    high: Array
    ground: float
    top: float
    step: float

    def place(self, north: float, east: float, altitude: float | None = None) -> Array:
        """Return a point in ground axes [m], on the ground unless an altitude is given [m]."""
        return np.array([north, east, -(self.ground if altitude is None else altitude)])

    def near(self, view: View) -> Array:
        """Return the corner nearest to the viewer, north and east [m]."""
        return np.where(view.toward[:2] > 0.0, self.high, self.low)

    def far(self, view: View) -> Array:
        """Return the corner farthest from the viewer, north and east [m]."""
        return np.where(view.toward[:2] > 0.0, self.low, self.high)

    def post(self, view: View) -> Array:
        """Return the corner at which altitudes are written: the leftmost one, north and east [m]."""
        corners = np.array([[n, e] for n in (self.low[0], self.high[0]) for e in (self.low[1], self.high[1])])
        return corners[int(np.argmin(corners @ view.plane[0, :2]))]

    def outline(self, view: View) -> Array:
        """Return points that hold the box and its labels, ground axes [m], shape (n, 3)."""
        room = ROOM * float(np.max(self.high - self.low))
        wide = np.stack([self.far(view), self.near(view) + room * np.sign(self.near(view) - self.far(view))])
        corners = [self.place(north, east) for north in wide[:, 0] for east in wide[:, 1]]
        north, east = self.post(view) - 0.5 * room * view.plane[0, :2]
        return np.stack([*corners, self.place(north, east, self.top + 0.5 * room)])


def box_around(points: Array, ground: float) -> GroundBox:
    """Return the box around points.

    Parameters
    ----------
    points : Array
        Ground axes [m], shape (n, 3).
    ground : float
        Altitude of the ground [m].
    """
    low, high = points.min(axis=0), points.max(axis=0)
    step = STEP
    while np.max(high - low) / step > MOST_LINES:
        step *= 2.0
    top = step * np.ceil((max(-low[2], ground + step)) / step)
    return GroundBox(step * np.floor(low[:2] / step), step * np.ceil(high[:2] / step), ground, float(top), step)


def marking(value: float) -> str:
    """Return what is written at a mark [m]: with a true minus sign, and none before zero."""
    return f"{value + 0.0:g}".replace("-", "−")


def draw_box(axes: Axes, box: GroundBox, view: View) -> None:
    """Draw the ground with its grid, north and east along the nearer edges, altitudes at the leftmost corner [m]."""
    (south, west), (north, east) = box.low, box.high
    corners = np.stack([box.place(n, e) for n, e in ((south, west), (north, west), (north, east), (south, east))])
    soil = Polygon(
        view.project(corners), facecolor=style.GROUND, edgecolor=style.BETWEEN, linewidth=style.THIN, zorder=0
    )
    soil.set_gid("soil")
    axes.add_patch(soil)
    norths = np.arange(south, north + 0.5 * box.step, box.step)
    easts = np.arange(west, east + 0.5 * box.step, box.step)
    lines = [np.stack([box.place(value, west), box.place(value, east)]) for value in norths]
    lines += [np.stack([box.place(south, value), box.place(north, value)]) for value in easts]
    grid = LineCollection(
        list(view.project(np.stack(lines))), colors="white", linewidths=style.HAIR, zorder=1, gid="grid"
    )
    axes.add_collection(grid, autolim=False)
    near_north, near_east = box.near(view)
    away = np.sign(box.near(view) - box.far(view))
    post_north, post_east = box.post(view)
    for value in norths:
        if value % (2.0 * box.step) == 0.0 and value != post_north:
            _write(axes, view, box.place(value, near_east), np.array([0.0, away[1], 0.0]), marking(value))
    for value in easts:
        if value % (2.0 * box.step) == 0.0 and value != post_east:
            _write(axes, view, box.place(near_north, value), np.array([away[0], 0.0, 0.0]), marking(value))
    middle = 0.5 * (box.low + box.high)
    _write(axes, view, box.place(middle[0], near_east), np.array([0.0, away[1], 0.0]), "north [m]", 30.0)
    _write(axes, view, box.place(near_north, middle[1]), np.array([away[0], 0.0, 0.0]), "east [m]", 30.0)
    _draw_post(axes, box, view)


def _draw_post(axes: Axes, box: GroundBox, view: View) -> None:
    """Draw the scale of altitudes [m]."""
    north, east = box.post(view)
    ends = view.project(np.stack([box.place(north, east), box.place(north, east, box.top)]))
    axes.plot(*ends.T, color=style.BETWEEN, linewidth=style.THIN, zorder=1, gid="post")
    left = np.array([*(-view.plane[0, :2]), 0.0])
    for value in np.arange(box.step * np.ceil(box.ground / box.step), box.top + 0.5 * box.step, box.step):
        point = box.place(north, east, float(value))
        axes.plot(*view.project(point), marker="_", markersize=4, color=style.BETWEEN, zorder=1)
        _write(axes, view, point, left, marking(value), 9.0)
    axes.annotate(
        "altitude [m]",
        tuple(ends[1]),
        xytext=(-12, 9),
        textcoords="offset points",
        fontsize=style.SMALL,
        ha="left",
    )


def _write(axes: Axes, view: View, point: Array, away: Array, text: str, gap: float = 8.0) -> None:
    """Write a text beside a point [m], in a direction (ground axes), at a distance [pt]."""
    aside = view.project(away)
    aside = gap * aside / max(float(np.linalg.norm(aside)), 1e-9)
    axes.annotate(
        text,
        tuple(view.project(point)),
        xytext=tuple(aside),
        textcoords="offset points",
        fontsize=style.SMALL,
        ha="center",
        va="center",
    )
