"""Colours and sizes of the figures and pages, readable in print. Depends on: matplotlib.

What matplotlib can be told in general stands in `data/tethership.mplstyle`, which `styled` applies and nothing else
does; what differs from it on purpose has a name here.

Colours that stand together differ by at least 12 (CIEDE2000) for normal eyes and for protanopes, deuteranopes and
tritanopes (Machado, Oliveira & Fernandes, 2009), and no colour is the only sign of what it means.
"""

import functools
from collections.abc import Callable
from importlib import resources
from typing import ParamSpec, TypeVar

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

with resources.as_file(resources.files("tethership") / "data" / "tethership.mplstyle") as _path:
    SHEET = matplotlib.rc_params_from_file(_path, use_default_template=False)
"""What matplotlib is told, by its own names."""

INK: str = SHEET["text.color"]
"""Text and axes."""

GUIDE: str = SHEET["grid.color"]
"""Grid lines."""

START = "#004400"
"""Ship at the start: dark green, its outline dashed."""

END = "#C4005A"
"""Ship at the end, and the path of B: crimson."""

BETWEEN = "#A6A6A6"
"""Ship in between: grey, its outline thin."""

START_LINE = (0.0, (4.0, 1.5))
"""Dashes of the ship's outline at the start: its colour is not the only sign."""

GROUND = "#EDE6DA"
"""Ground, filled."""

GUST = "#F6E7B0"
"""Time of a gust, shaded."""

SERIES: tuple[str, ...] = tuple(SHEET["axes.prop_cycle"].by_key()["color"])
"""Cables, thrusters, angles, loads, in turn."""

MARKS = ("o", "s", "^", "D", "v", "P")
"""Marks of the same, so that their colour is not the only sign."""

DASHES = ((), (7, 3), (2, 2), (8, 3, 2, 3), (12, 3), (12, 3, 2, 3, 2, 3))
"""Dashes of the same, lines and gaps in turn [px]."""

CABLE_LINES = ((4.0, 2.0), (1.0, 1.2), (8.0, 2.0), (4.0, 1.5, 1.0, 1.5), (8.0, 1.5, 1.0, 1.5), (2.0, 1.0))
"""Dashes of cables beside a ship, over the width of the line."""

FLIGHTS = SERIES[:2]
"""Two flights that are compared."""

LIMITS = ("#6E6E6E", "#5A2A00", "#BF5000", "#000000")
"""Watched tensions, in turn; dashed, and named in their colour."""

LACKING = "#D55E00"
"""A thruster that is asked for more than it has: vermilion, hatched."""

TENSION = ("#9CC9E8", "#3B8CC4", "#274B7A", "#E0A030", "#B84A00", "#4A0010")
"""Tensions of a cable in space, from none to the last limit."""

ARROWS = {"thrust": "#00876C", "wind": "#2B3A4A", "gust": "#C98A00"}
"""Arrows in space: thrust on the ship, mean wind, gust."""

SMALL: float = SHEET["xtick.labelsize"]
"""Words among what is drawn, as large as the numbers of an axis [pt]."""

LARGE = "x-large"
"""The heading of a whole picture, over its other text."""

HAIR, THIN = 0.6, 0.9
"""Widths of lines that step back: what is one of many, and what only bounds or points [pt]."""

Given = ParamSpec("Given")
Drawn = TypeVar("Drawn", Axes, Figure)


def styled(draw: Callable[Given, Drawn]) -> Callable[Given, Drawn]:
    """Return a function that draws, axes or a figure, in this style.

    Axes that it is given were made in another style, and get this one's grid and labels. Ticks are made at once:
    matplotlib makes some when the figure is saved, in whatever style holds then.
    """

    @functools.wraps(draw)
    def drawn(*args: Given.args, **kwargs: Given.kwargs) -> Drawn:
        with matplotlib.rc_context(SHEET):
            for axes in (given for given in (*args, *kwargs.values()) if isinstance(given, Axes)):
                _restyle(axes)
            found = draw(*args, **kwargs)
            for axes in () if found.figure is None else found.figure.axes:
                _ = [(axis.majorTicks, axis.minorTicks) for axis in (axes.xaxis, axes.yaxis)]
            return found

    return drawn


def _restyle(axes: Axes) -> None:
    """Give axes what matplotlib reads when it makes them."""
    axes.grid(SHEET["axes.grid"], color=GUIDE, linewidth=SHEET["grid.linewidth"])
    axes.set_axisbelow(SHEET["axes.axisbelow"])
    axes.tick_params(which="both", labelsize=SMALL)
    for axis in (axes.xaxis, axes.yaxis):
        axis.label.set(size=SHEET["axes.labelsize"], color=SHEET["axes.labelcolor"])


def cable_colour(index: int) -> str:
    """Return the colour of a cable."""
    return SERIES[index % len(SERIES)]


def cable_line(index: int) -> tuple[float, tuple[float, ...]]:
    """Return the line of a cable beside a ship, as matplotlib takes it."""
    return 0.0, CABLE_LINES[index % len(CABLE_LINES)]


def dash(index: int) -> tuple[int, ...]:
    """Return the dashes of a series: lines and gaps in turn [px], none for a solid line."""
    return DASHES[index % len(DASHES)]


def mark(index: int) -> str:
    """Return the mark of a series."""
    return MARKS[index % len(MARKS)]
