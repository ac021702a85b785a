"""Colours and sizes of the figures and pages, readable in print. Depends on nothing.

Colours that stand together differ by at least 12 (CIEDE2000) for normal eyes and for protanopes, deuteranopes and
tritanopes (Machado, Oliveira & Fernandes, 2009), and no colour is the only sign of what it means.
"""

INK = "#222222"
"""Text and axes."""

GUIDE = "#DDDDDD"
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

SERIES = ("#0072B2", "#CC7A00", "#000000", "#802800", "#888888", "#101090")
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

FONT = 9.0
"""Text [pt]."""

SMALL = 8.0
"""Labels inside the axes and of ticks [pt]."""


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
