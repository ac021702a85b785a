"""A flight to be explored in a browser: the ship in space with a time slider. Depends on: plotly, view."""

from typing import Any

import jax
import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray

from tethership.simulation import Flight
from tethership.spatial import rotation_matrix
from tethership.view import style
from tethership.view.flight.hull_mesh import ship_mesh
from tethership.view.flight.interactive_histories import interactive_histories
from tethership.view.flight.snapshots import Snapshots, take_snapshots
from tethership.view.flight.thinning import evenly, listed

__all__ = ["interactive_flight", "interactive_histories"]

Array = NDArray[np.float64]

PATH_INTERVAL = 0.2
"""Time between points of the path [s]; doubled until there are at most 500."""

FRAME_INTERVAL = 1.0
"""Time between positions of the slider [s]; doubled until there are at most 90."""

LIGHT = {"ambient": 0.6, "diffuse": 0.6, "specular": 0.1, "roughness": 0.8}
"""How the hull is lit."""

LAMP = {"x": 1e5, "y": 5e4, "z": 1e5}
"""Where the light stands."""

HULL = "#DCDCDC"
"""The ship that moves: light grey."""

EYE = {"x": 1.5, "y": 1.0, "z": 0.65}
"""Whence the scene is seen at first: from east-northeast, above."""


def interactive_flight(flight: Flight, title: str | None = None) -> go.Figure:
    """Return a flight in space as a plotly figure, with a time slider.

    The ship and its cables move with the slider, every 1 s (flights longer than 1.5 min: 2 s, 4 s, …). What stays: the
    path of the centre of buoyancy B in crimson, whose points tell time, place and tension; the ship at the start, dark
    green, and at the end, crimson; the cables at the snapshots of `plot_docking`, thin; anchors; ground. East, north
    and altitude [m] with equal scales. Numbers have four significant digits.

    Parameters
    ----------
    flight : Flight
        From `dock` or `Flight.load`; any number of cables.
    title : str, optional
        Above the scene, instead of the scenario's own title.

    Raises
    ------
    ConfigError
        The scenario that the flight carries cannot be read by this version.
    SolveError
        It diverged before its first sample.
    """
    snapshots = take_snapshots(flight)
    shown = evenly(snapshots.time, FRAME_INTERVAL, 90)
    ship = _Ship(snapshots, shown)
    ends = [ship.at(0, style.START, 0.3, "start"), ship.at(-1, style.END, 0.3, "end")]
    still = [_path(snapshots), *ends, *_ghosts(snapshots), *_anchors(snapshots), _ground(snapshots)]
    moving = [ship.at(0, HULL, 1.0, "ship"), *_cables(snapshots, int(shown[0]))]
    figure = go.Figure([*moving, *still])
    figure.frames = [
        go.Frame(
            name=str(index),
            data=[ship.corners(place), *({"type": "scatter3d", **_space(curve)} for curve in snapshots.curves[index])],
            traces=list(range(len(moving))),
            layout={"annotations": [_readout(snapshots, int(index))]},
        )
        for place, index in enumerate(shown)
    ]
    _dress(figure, snapshots, snapshots.config.title if title is None else title, shown)
    return figure


def _space(points: Array) -> dict[str, list[float | None]]:
    """Return points in ground axes [m], shape (n, 3), as east, north and altitude; a row of NaN is a gap."""
    north, east, down = points.T
    return {"x": listed(east), "y": listed(north), "z": listed(-down)}


class _Ship:
    """The ship as a mesh, at the samples shown."""

    def __init__(self, snapshots: Snapshots, shown: NDArray[np.intp]) -> None:
        self.mesh = ship_mesh(snapshots.shape)
        self.positions = snapshots.values("position")[shown]
        self.rotations = np.asarray(_rotations(snapshots.values("attitude")[shown]))

    def corners(self, place: int) -> dict[str, Any]:
        """Return its corners at one of the samples."""
        return {"type": "mesh3d", **_space(self.mesh.placed(self.positions[place], self.rotations[place]))}

    def at(self, place: int, colour: str, opacity: float, name: str) -> go.Mesh3d:
        """Return it at one of the samples."""
        i, j, k = self.mesh.faces.T.tolist()
        looks = {"color": colour, "opacity": opacity, "flatshading": False, "lighting": LIGHT, "lightposition": LAMP}
        return go.Mesh3d(self.corners(place) | looks, i=i, j=j, k=k, name=name, showlegend=True, hoverinfo="skip")


def _cables(snapshots: Snapshots, index: int) -> list[go.Scatter3d]:
    """Return the cables at a sample."""
    return [
        go.Scatter3d(
            _space(snapshots.curves[index, cable]),
            mode="lines",
            line={"color": style.cable_colour(cable), "width": 5},
            name=f"cable {name}",
            hoverinfo="skip",
        )
        for cable, name in enumerate(snapshots.cables)
    ]


def _path(snapshots: Snapshots) -> go.Scatter3d:
    """Return the path of B; hovering tells time and tensions."""
    chosen = evenly(snapshots.time, PATH_INTERVAL, 500)
    columns = [snapshots.time[chosen], *snapshots.values("tension")[chosen].T]
    data = list(zip(*(listed(column) for column in columns), strict=True))
    hover = "<b>t = %{customdata[0]} s</b><br>east %{x} m, north %{y} m, altitude %{z} m"
    for cable, name in enumerate(snapshots.cables, start=1):
        hover += f"<br>tension of {name} %{{customdata[{cable}]}} N"
    return go.Scatter3d(
        _space(snapshots.path[chosen]),
        mode="lines",
        line={"color": style.END, "width": 4},
        customdata=data,
        hovertemplate=hover + "<extra></extra>",
        name="centre of buoyancy B",
    )


def _ghosts(snapshots: Snapshots) -> list[go.Scatter3d]:
    """Return the cables at the snapshots, each cable's as one line with gaps."""
    gap = np.full((1, 3), np.nan)
    ghosts = []
    for cable in range(len(snapshots.cables)):
        pieces = [part for index in snapshots.indices for part in (snapshots.curves[index, cable], gap)]
        ghosts.append(
            go.Scatter3d(
                _space(np.concatenate(pieces)),
                mode="lines",
                line={"color": style.cable_colour(cable), "width": 1},
                opacity=0.6,
                name=f"every {snapshots.interval:g} s",
                hoverinfo="skip",
            )
        )
    return ghosts


def _anchors(snapshots: Snapshots) -> list[go.Scatter3d]:
    """Return the anchors."""
    if not snapshots.cables:
        return []
    marker = {"symbol": "diamond", "size": 5, "color": style.INK}
    return [go.Scatter3d(_space(snapshots.curves[0, :, 0]), mode="markers", marker=marker, name="anchor")]


def _ground(snapshots: Snapshots) -> go.Mesh3d:
    """Return the ground below the flight."""
    reach = 0.6 * float(np.ptp(snapshots.shape.station))
    low, high = snapshots.path.min(axis=0) - reach, snapshots.path.max(axis=0) + reach
    down = -snapshots.ground
    corners = [[n, e, down] for n, e in ((low[0], low[1]), (high[0], low[1]), (high[0], high[1]), (low[0], high[1]))]
    return go.Mesh3d(
        _space(np.array(corners)), i=[0, 0], j=[1, 2], k=[2, 3], color=style.GROUND, opacity=0.7, hoverinfo="skip"
    )


def _readout(snapshots: Snapshots, index: int) -> dict[str, Any]:
    """Return the numbers of a sample, written in the corner of the scene."""
    lines = [f"<b>t = {snapshots.time[index]:.1f} s</b>", f"altitude of B {-snapshots.path[index, 2] + 0.0:.1f} m"]
    tension, length = snapshots.values("tension")[index], snapshots.values("cable_length")[index]
    for cable, name in enumerate(snapshots.cables):
        lines.append(f"{name}: {tension[cable]:.3g} N, {length[cable]:.1f} m of cable")
    corner = {"x": 0.01, "y": 0.99, "xref": "paper", "yref": "paper", "xanchor": "left", "yanchor": "top"}
    return {
        "text": "<br>".join(lines),
        "showarrow": False,
        "align": "left",
        "bgcolor": "rgba(255,255,255,0.8)",
        **corner,
    }


def _dress(figure: go.Figure, snapshots: Snapshots, title: str, shown: NDArray[np.intp]) -> None:
    """Set scene, title, legend, slider and buttons."""
    times = listed(snapshots.time[shown])
    at_once = {"mode": "immediate", "frame": {"duration": 0, "redraw": True}, "transition": {"duration": 0}}
    play = {**at_once, "frame": {"duration": 120, "redraw": True}, "fromcurrent": True}
    axis = {"gridcolor": style.GUIDE, "showbackground": False, "zeroline": False}
    figure.update_layout(
        title={"text": title, "font": {"size": 15}},
        template="plotly_white",
        height=640,
        margin={"l": 10, "r": 10, "t": 50, "b": 10},
        legend={"x": 1.0, "y": 1.0, "xanchor": "right", "font": {"size": 11}, "bgcolor": "rgba(255,255,255,0.8)"},
        annotations=[_readout(snapshots, int(shown[0]))],
        scene={
            "aspectmode": "data",
            "camera": {"eye": EYE, "center": {"x": 0.0, "y": 0.0, "z": -0.08}},
            "xaxis": {"title": "east [m]", **axis},
            "yaxis": {"title": "north [m]", **axis},
            "zaxis": {"title": "altitude [m]", **axis},
        },
        sliders=[
            {
                "steps": [
                    {"label": f"{time:g}", "method": "animate", "args": [[str(index)], at_once]}
                    for time, index in zip(times, shown, strict=True)
                ],
                "currentvalue": {"prefix": "time ", "suffix": " s", "xanchor": "right"},
                "x": 0.02,
                "len": 0.96,
                "y": 0.0,
                "pad": {"t": 25},
            }
        ],
        updatemenus=[
            {
                "type": "buttons",
                "direction": "left",
                "showactive": False,
                "x": 0.0,
                "xanchor": "left",
                "y": 0.0,
                "yanchor": "top",
                "pad": {"t": 5},
                "buttons": [
                    {"label": "Play", "method": "animate", "args": [None, play]},
                    {"label": "Pause", "method": "animate", "args": [[None], at_once]},
                ],
            }
        ],
    )


_rotations = jax.jit(jax.vmap(rotation_matrix))
