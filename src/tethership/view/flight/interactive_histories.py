"""Time histories of a flight to be explored in a browser, on one time axis. Depends on: plotly, view."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from tethership._extras import needs
from tethership.simulation import Flight
from tethership.view import style
from tethership.view.flight.snapshots import Snapshots, take_snapshots
from tethership.view.flight.thinning import listed, with_peaks

with needs("plots"):
    import plotly.graph_objects as go
    from plotly.subplots import make_subplots

Array = NDArray[np.float64]

ROWS = ("tension [N]", "length [m]", "rewind rate [m/s]", "throttle [-]")
"""Labels of the axes, from top to bottom."""

BUCKETS = 400
"""Stretches of which the lowest and highest tension are kept."""

LOWEST = 0.1
"""Least tension shown [N]: the scale is logarithmic."""


def interactive_histories(flight: Flight, title: str | None = None) -> go.Figure:
    """Return a flight's time histories as a plotly figure of four plots that are zoomed together.

    Tension at the tether points [N] with the limits watched, on a logarithmic scale that a button makes linear; cable
    length and distance from anchor to tether point [m]; rewind rate [m/s]; throttles [-]. Gusts are shaded. Of long
    flights the samples with the lowest and highest tension of each short stretch are kept, so no peak is lost.

    Parameters
    ----------
    flight : Flight
        From `dock` or `Flight.load`; any number of cables.
    title : str, optional
        Above the plots, instead of the scenario's own title.

    Raises
    ------
    ConfigError
        The scenario that the flight carries cannot be read by this version.
    SolveError
        It diverged before its first sample.
    """
    snapshots = take_snapshots(flight)
    names = ["tension", "rewind_rate"] if snapshots.cables else ["throttle"]
    kept = with_peaks(np.concatenate([snapshots.values(name) for name in names], axis=1), BUCKETS)
    time = listed(snapshots.time[kept])
    figure = make_subplots(
        rows=4, cols=1, shared_xaxes=True, vertical_spacing=0.035, row_heights=[0.36, 0.22, 0.17, 0.25]
    )
    _add_cables(figure, snapshots, time, kept)
    for index, name in enumerate(snapshots.flight.data["thruster"].to_numpy()):
        _add(figure, 4, time, snapshots.values("throttle")[kept, index], str(name), index)
    if snapshots.cables:
        _add_limits(figure, snapshots)
    _dress(figure, snapshots, snapshots.config.title if title is None else title)
    return figure


def _add(figure: go.Figure, row: int, time: list[Any], values: Array, name: str, series: int, dash: str = "") -> None:
    """Add a history to a row."""
    dash = dash or ",".join(f"{part}px" for part in style.dash(series))
    line = {"color": style.cable_colour(series), "width": 1.4, **({"dash": dash} if dash else {})}
    trace = go.Scatter(
        x=time,
        y=listed(values),
        name=name.replace("_", " "),
        mode="lines",
        line=line,
        legend="legend" if row == 1 else f"legend{row}",
    )
    figure.add_trace(trace, row=row, col=1)


def _add_cables(figure: go.Figure, snapshots: Snapshots, time: list[Any], kept: NDArray[np.intp]) -> None:
    """Add tension, length, distance and rewind rate of every cable."""
    alone = len(snapshots.cables) == 1
    rows = (
        (1, "tension", "tension", ""),
        (2, "cable_length", "cable length", ""),
        (2, "distance", "anchor to tether point", "dot"),
        (3, "rewind_rate", "rewind rate", ""),
    )
    for row, output, words, dash in rows:
        for cable, name in enumerate(snapshots.cables):
            values = snapshots.values(output)[kept, cable]
            values = np.maximum(values, LOWEST) if output == "tension" else values
            label = words if alone else f"{words}, {name}"
            _add(figure, row, time, values, label, cable, dash)


def _add_limits(figure: go.Figure, snapshots: Snapshots) -> None:
    """Draw the tensions watched, with their names."""
    limits = snapshots.flight.attributes["limits"]
    ends = [float(snapshots.time[0]), float(snapshots.time[-1])]
    named = list(zip((name for name, _ in snapshots.config.limits), limits, strict=True))
    for index, (name, limit) in reversed(list(enumerate(named))):
        trace = go.Scatter(
            x=ends,
            y=[limit, limit],
            name=f"{name.replace('_', ' ')} {limit:g} N",
            mode="lines",
            line={"color": style.LIMITS[index % len(style.LIMITS)], "width": 1, "dash": "longdash"},
            legend="legend",
            hoverinfo="skip",
        )
        figure.add_trace(trace, row=1, col=1)


def _dress(figure: go.Figure, snapshots: Snapshots, title: str) -> None:
    """Set axes, legends, gusts, title and the buttons of the tension's scale."""
    for row, label in enumerate(ROWS, start=1):
        figure.update_yaxes(title={"text": label, "font": {"size": 12}}, row=row, col=1)
        axis: Any = figure.layout["yaxis" if row == 1 else f"yaxis{row}"]
        top = axis.domain[1]
        place: dict[str, Any] = {"x": 1.01, "y": top, "yanchor": "top", "font": {"size": 11}}
        figure.update_layout({"legend" if row == 1 else f"legend{row}": place})
    figure.update_xaxes(
        range=[float(snapshots.time[0]), max(float(snapshots.time[-1]), float(snapshots.time[0]) + 1e-3)]
    )
    figure.update_xaxes(title_text="time [s]", row=4, col=1)
    if snapshots.cables:
        figure.update_yaxes(type="log", dtick=1, row=1, col=1)
    for gust in snapshots.config.gusts:
        figure.add_vrect(
            x0=gust.start, x1=gust.start + gust.period, fillcolor=style.GUST, opacity=0.6, layer="below", line_width=0
        )
    buttons = [
        {"label": words, "method": "relayout", "args": [{"yaxis.type": kind, "yaxis.dtick": dtick}]}
        for words, kind, dtick in (("log", "log", 1), ("linear", "linear", None))
    ]
    figure.update_layout(
        title={"text": title, "font": {"size": 15}},
        template="plotly_white",
        height=780,
        hovermode="x unified",
        margin={"l": 60, "r": 10, "t": 85, "b": 40},
        updatemenus=[
            {
                "type": "buttons",
                "direction": "right",
                "buttons": buttons,
                "x": 1.0,
                "xanchor": "right",
                "y": 1.005,
                "yanchor": "bottom",
                "pad": {"t": 0, "b": 0},
            }
        ]
        if snapshots.cables
        else [],
    )
