"""The load breakdown: how large each load is over a flight. Depends on: matplotlib, studies.docking_paper, view."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import LogLocator, NullFormatter
from numpy.typing import NDArray

from tethership.simulation import Flight
from tethership.studies.docking_paper.terms import load_breakdown
from tethership.view import style
from tethership.view.flight import DECADES, KINDS, Snapshots, key_row, load_vectors, take_snapshots

Array = NDArray[np.float64]

WORDS = {"net_weight": "weight and buoyancy together", "apparent_mass": "apparent mass, besides −Mᵃ ẇ"}
"""Names of loads that say more than their labels."""

LEFT, TOP, BOTTOM, PANEL = 0.075, 1.3, 0.5, 1.35
"""Left margin over the figure's width [-]; upper and lower margin and height of a panel with its gap [inch]."""


@style.styled
def plot_breakdown(flight: Flight, figure: Figure | None = None) -> Figure:
    """Draw the size of each load over time [s]: forces [N] on the left, moments [N m] on the right, one row per load.

    All axes of a column have one logarithmic scale, and each shows the other loads in grey. Weight and buoyancy nearly
    cancel and are drawn as one load. A vertical line marks the largest tension; gusts are shaded.

    Parameters
    ----------
    flight : Flight
        From `dock` or `Flight.load`; any number of cables.
    figure : Figure, optional
        Draw into this figure, which is cleared, instead of into a new one.

    Returns
    -------
    Figure
        Not shown and not saved: ``plot_breakdown(flight).savefig("breakdown.png", dpi=150)``.

    Raises
    ------
    ConfigError
        The scenario that the flight carries cannot be read by this version.
    SolveError
        The flight has no sample.
    """
    snapshots = take_snapshots(flight)
    numbers = load_breakdown(flight)
    count = len(load_sizes(flight, "force"))
    figure = Figure(figsize=(10.8, TOP + BOTTOM + PANEL * count)) if figure is None else figure
    figure.clear()
    height = figure.get_figheight()
    low, high = BOTTOM / height, 1.0 - TOP / height
    grid = figure.add_gridspec(count, 2, left=LEFT, right=0.985, bottom=low, top=high, hspace=0.32, wspace=0.13)
    for column, (kind, title) in enumerate(KINDS.items()):
        loads = load_sizes(flight, kind)
        for row, name in enumerate(loads):
            axes = figure.add_subplot(grid[row, column])
            _dress(axes, snapshots, _limits(loads))
            _draw(axes, snapshots.time, loads, name)
            _label(axes, name, numbers[kind][name])
            if snapshots.cables:
                axes.axvline(
                    numbers["time_of_peak"], color=style.END, linewidth=style.THIN, linestyle=(0, (4, 2)), gid="peak"
                )
            if row == 0:
                axes.set_title(title, loc="center", weight="bold", pad=18)
            axes.tick_params(labelbottom=row == count - 1)
            axes.set_xlabel("time [s]" if row == count - 1 else "")
    _title(figure, snapshots, numbers)
    return figure


def load_sizes(flight: Flight, kind: str) -> dict[str, Array]:
    """Return the magnitude of each load over time by its label, `net_weight` for weight and buoyancy together.

    Parameters
    ----------
    flight : Flight
        Flown or loaded.
    kind : str
        `force` [N] or `moment` [N m].
    """
    return {name: np.linalg.norm(load, axis=1) for name, load in load_vectors(flight, kind).items()}


def _limits(loads: dict[str, Array]) -> tuple[float, float]:
    """Return lower and upper end of a logarithmic axis for all loads of a column, their unit."""
    top = max(float(value.max()) for value in loads.values())
    if top <= 0.0:
        return 0.1, 1.0
    seen = [float(np.quantile(value, 0.05)) for value in loads.values() if value.max() > 0.0]
    return max(min(seen), 10.0**-DECADES * top), 2.0 * top


def _dress(axes: Axes, snapshots: Snapshots, limits: tuple[float, float]) -> None:
    """Set both axes and the gusts' shades."""
    time = snapshots.time
    axes.set_xlim(float(time[0]), max(float(time[-1]), float(time[0]) + 1e-3))
    axes.set_yscale("log", nonpositive="clip")
    axes.set_ylim(*limits)
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter(NullFormatter())
    for gust in snapshots.config.gusts:
        axes.axvspan(gust.start, gust.start + gust.period, facecolor=style.GUST, edgecolor="none", zorder=0, gid="gust")


def _draw(axes: Axes, time: Array, loads: dict[str, Array], name: str) -> None:
    """Draw one load over time [s], the others behind it."""
    for other, value in loads.items():
        chosen = other == name
        axes.plot(
            time,
            value,
            color=_colour(name) if chosen else style.GUIDE,
            linewidth=None if chosen else style.HAIR,
            zorder=3 if chosen else 1,
            gid=name if chosen else "other",
        )


def _label(axes: Axes, name: str, numbers: dict[str, Any]) -> None:
    """Write the load's name above its axes on the left, rms and peak on the right."""
    words = f"rms {_rounded(numbers['rms'])}, peak {_rounded(numbers['peak'])}" if numbers["peak"] > 0.0 else "zero"
    label = WORDS.get(name, name.replace("_", " "))
    axes.text(0.0, 1.04, label, transform=axes.transAxes, color=_colour(name), weight="bold")
    axes.text(1.0, 1.04, words, transform=axes.transAxes, fontsize=style.SMALL, ha="right")


def _rounded(value: float) -> str:
    """Return a number with three digits, without an exponent where it is ordinary."""
    return f"{float(f'{value:.3g}'):.10g}"


def _colour(name: str) -> str:
    """Return the colour of a load: that of its cable, else ink."""
    return style.cable_colour(int(name.split("_")[-1]) - 1) if name.startswith("cable") else style.INK


def _title(figure: Figure, snapshots: Snapshots, numbers: dict[str, Any]) -> None:
    """Write what was flown, and explain line and shade."""
    attributes, height = snapshots.flight.attributes, figure.get_figheight()
    parts = [
        f"wind {snapshots.config.wind.speed:.3g} m/s",
        f"layers: {', '.join(attributes['layers']) or 'none'}" + ("" if attributes["sas"] else " (no SAS)"),
        f"{attributes['formulation']} formulation",
        f"{attributes['outcome'].replace('_', ' ')} after {snapshots.time[-1]:.1f} s",
    ]
    title = f"Loads: {snapshots.config.title}"
    figure.text(LEFT, 1.0 - 0.2 / height, title, fontsize=style.LARGE, weight="bold", va="center")
    figure.text(LEFT, 1.0 - 0.44 / height, "  ·  ".join(parts), va="center")
    handles: list[Line2D | Patch] = [Line2D([], [], color=style.GUIDE, label="other loads")]
    if snapshots.cables:
        peak = f"largest tension, {_rounded(numbers['peak_tension'])} N at {numbers['time_of_peak']:.1f} s"
        handles.append(Line2D([], [], color=style.END, linewidth=style.THIN, linestyle=(0, (4, 2)), label=peak))
    if snapshots.config.gusts:
        handles.append(Patch(facecolor=style.GUST, label="gust"))
    key_row(figure, handles, LEFT - 0.005, 1.0 - 0.66 / height)
