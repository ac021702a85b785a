"""Colours and sizes of the figures: colour-blind safe (Okabe–Ito), readable in print. Depends on nothing."""

INK = "#222222"
"""Text and axes."""

GUIDE = "#DDDDDD"
"""Grid lines."""

START = "#009E73"
"""Ship at the start: bluish green."""

END = "#C8102E"
"""Ship at the end, and the path of B: red."""

BETWEEN = "#8C8C8C"
"""Ship in between: grey."""

GROUND = "#EDE6DA"
"""Ground, filled."""

GUST = "#F6E7B0"
"""Time of a gust, shaded."""

CABLES = ("#0072B2", "#E69F00", "#CC79A7", "#56B4E9", "#000000")
"""Cables, in turn."""

LIMITS = ("#6E6E6E", "#8C510A", "#D55E00", "#000000")
"""Watched tensions, in turn."""

FONT = 9.0
"""Text [pt]."""

SMALL = 8.0
"""Labels inside the axes and of ticks [pt]."""


def cable_colour(index: int) -> str:
    """Return the colour of a cable."""
    return CABLES[index % len(CABLES)]
