"""What is drawn in the pictures of a flight, explained in a legend. Depends on: matplotlib, view."""

from collections.abc import Sequence

from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.typing import LineStyleType

from tethership.view import style


def ship_keys(interval: float) -> list[Patch]:
    """Return the entries of a legend, with the time between two ships [s]."""
    looks: tuple[tuple[str, LineStyleType, float | None, str], ...] = (
        (style.START, style.START_LINE, None, "start"),
        (style.BETWEEN, "-", style.HAIR, f"every {interval:g} s"),
        (style.END, "-", None, "end"),
    )
    return [
        Patch(facecolor=(colour, 0.22), edgecolor=colour, linestyle=line, linewidth=width, label=label)
        for colour, line, width, label in looks
    ]


def key_row(figure: Figure, handles: Sequence[Line2D | Patch], left: float, middle: float) -> None:
    """Explain a figure in one row, from a place of it on [-]."""
    figure.legend(
        handles=handles,
        loc="center left",
        bbox_to_anchor=(left, middle),
        ncols=len(handles),
        fontsize="medium",
        borderaxespad=0.0,
        columnspacing=1.8,
    )
