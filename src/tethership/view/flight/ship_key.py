"""What a ship's outlines mean in the pictures of a flight: start, in between, end. Depends on: matplotlib, view."""

from matplotlib.patches import Patch
from matplotlib.typing import LineStyleType

from tethership.view import style


def ship_keys(interval: float) -> list[Patch]:
    """Return the entries of a legend, with the time between two ships [s]."""
    looks: tuple[tuple[str, LineStyleType, float, str], ...] = (
        (style.START, style.START_LINE, 1.2, "start"),
        (style.BETWEEN, "-", 0.6, f"every {interval:g} s"),
        (style.END, "-", 1.2, "end"),
    )
    return [
        Patch(facecolor=(colour, 0.22), edgecolor=colour, linestyle=line, linewidth=width, label=label)
        for colour, line, width, label in looks
    ]
