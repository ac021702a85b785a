"""The docking figure: a flight from three sides and its time histories. Depends on: matplotlib, view."""

import textwrap

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from tethership.simulation import Flight
from tethership.view import style
from tethership.view.flight.captions import flown_words
from tethership.view.flight.histories import draw_histories
from tethership.view.flight.projection import FROM_EAST, FROM_NORTH, FROM_TOP
from tethership.view.flight.ship_key import key_row, ship_keys
from tethership.view.flight.snapshots import Snapshots, take_snapshots
from tethership.view.flight.trajectory import draw_view

SIZE = (10.8, 8.6)
"""Width and height of the figure [inch]."""

LEFT = 0.075
"""Left margin, over the figure's width [-]."""

VERDICT_ROOM = 150
"""Letters of a line of the verdict."""

LEGEND_ROOM = 34
"""Letters of cables' names, two more each for the line, that the legend's row holds beside the rest."""


@style.styled
def plot_docking(flight: Flight, figure: Figure | None = None, title: str | None = None) -> Figure:
    """Draw a docking flight as the four panels of Fig. 12 of Riboldi et al.

    Seen from north (top left; east is on the left), from east (top right; north is on the right) and from the top
    (bottom right), all with equal scales in metres: the ship every 4 s (longer flights: 8 s, 16 s, …), dark green and
    dashed at the start, crimson at the end, cables dashed, the path of the centre of buoyancy B crimson. Bottom left,
    against time [s]: cable length and distance of tether point and anchor [m], tension at the tether point [N] with the
    limits watched, rewind rate [m/s]; dots are the snapshots, gusts are shaded.

    Parameters
    ----------
    flight : Flight
        From `dock` or `Flight.load`; any number of cables.
    figure : Figure, optional
        Draw into this figure, which is cleared, instead of into a new one of 10.8 by 8.6 inches.
    title : str, optional
        Above the panels, instead of the scenario's own title.

    Returns
    -------
    Figure
        Not shown and not saved: ``plot_docking(flight).savefig("docking.png", dpi=150)``.

    Raises
    ------
    ConfigError
        The scenario that the flight carries cannot be read by this version.
    """
    snapshots = take_snapshots(flight)
    figure = Figure(figsize=SIZE) if figure is None else figure
    figure.clear()
    north, east, top, histories = _layout(figure)
    draw_view(north, snapshots, FROM_NORTH)
    draw_view(east, snapshots, FROM_EAST)
    draw_view(top, snapshots, FROM_TOP)
    draw_histories(histories, snapshots)
    _title(figure, snapshots, title)
    _legend(figure, snapshots)
    return figure


def _layout(figure: Figure) -> tuple[Axes, Axes, Axes, tuple[Axes, Axes, Axes]]:
    """Return the axes of the views from north, east and top, and of the histories."""
    left, right, low, high, gap = LEFT, 0.985, 0.06, 0.848, 0.075
    middle = 0.5 * (low + high)
    upper = figure.add_gridspec(1, 2, left=left, right=right, bottom=middle + 0.5 * gap, top=high, wspace=0.16)
    lower = figure.add_gridspec(1, 2, left=left, right=right, bottom=low, top=middle - 0.5 * gap, wspace=0.16)
    north, east = (figure.add_subplot(cell) for cell in upper)
    cell = lower[0].get_position(figure)
    stack = figure.add_gridspec(
        3, 1, left=cell.x0, right=cell.x1 - 0.125, bottom=low, top=cell.y1, hspace=0.12, height_ratios=[1.0, 1.7, 0.8]
    )
    top = figure.add_subplot(lower[1])
    lengths = figure.add_subplot(stack[0])
    tensions = figure.add_subplot(stack[1], sharex=lengths)
    rates = figure.add_subplot(stack[2], sharex=lengths)
    return north, east, top, (lengths, tensions, rates)


def _title(figure: Figure, snapshots: Snapshots, title: str | None) -> None:
    """Write the title, the scenario's if none is given, and, below it, how it was flown and how it ended."""
    config, flight = snapshots.config, snapshots.flight
    words = config.title if title is None else title
    flown = "  ·  ".join(flown_words(config, flight.attributes))
    ended = "\n".join(textwrap.wrap(flight.verdict, VERDICT_ROOM))
    figure.text(LEFT, 0.978, words, fontsize=style.LARGE, weight="bold", va="center")
    figure.text(LEFT, 0.954, flown, va="center")
    figure.text(LEFT, 0.944, ended, va="top", linespacing=1.15)


def _legend(figure: Figure, snapshots: Snapshots) -> None:
    """Explain the views in one row below the title."""
    handles: list[Patch | Line2D] = [
        *ship_keys(snapshots.interval),
        Line2D([], [], color=style.END, label="centre of buoyancy B"),
    ]
    handles += [
        Line2D([], [], color=style.cable_colour(i), linewidth=style.THIN, linestyle=style.cable_line(i), label=label)
        for i, label in enumerate(_cable_labels(snapshots.cables))
    ]
    if snapshots.cables:
        handles.append(Line2D([], [], color=style.INK, marker="^", linestyle="none", label="anchor"))
    if snapshots.config.gusts:
        handles.append(Patch(facecolor=style.GUST, label="gust"))
    key_row(figure, handles, LEFT - 0.005, 0.893)


def _cable_labels(names: list[str]) -> list[str]:
    """Return the cables' labels, as long as the row has room for."""
    if len(names) > 1:
        for labels in ([f"cable {name}" for name in names], names):
            if sum(len(label) + 2 for label in labels) <= LEGEND_ROOM:
                return labels
    return ["cable" if len(names) == 1 else "cables"][: len(names)]
