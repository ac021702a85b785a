"""A trim as a picture: the ship on its cables from the east and from above, and what its thrusters give.

Depends on: plotly, view, plant.
"""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
import plotly.graph_objects as go
from jaxtyping import Array, Float
from plotly.subplots import make_subplots

from tethership.analysis import TrimPoint
from tethership.explorer.plain import plain_figure
from tethership.plant import State, TetheredAirship
from tethership.scenario import Scenario, ground_level
from tethership.spatial import rotation_matrix
from tethership.view import style
from tethership.view.flight import FROM_EAST, FROM_TOP, View, listed, ship_outlines, ship_shape

CURVE_POINTS = 25

HEIGHT = 330


@eqx.filter_jit
def _curves(plant: TetheredAirship, state: State) -> Float[Array, "cables 25 3"]:
    """Return the cables at a state, anchor first [m]."""
    plant = plant.at_mean()
    lengths = plant.initial_lengths()
    states = plant.cable_states(jnp.zeros(()), state, lengths)
    rows = []
    for index, (cable, now) in enumerate(zip(plant.cables, states, strict=True)):
        arc = jnp.linspace(0.0, 1.0, CURVE_POINTS) * lengths[index]
        rows.append(now.place + cable.law.shape(now.span, lengths[index], now.load, arc))
    return jnp.stack(rows) if rows else jnp.zeros((0, CURVE_POINTS, 3))


def trim_figure(scenario: Scenario, point: TrimPoint) -> dict[str, Any]:
    """Return the figure as plotly's JSON: the ship from the east and from above [m], and its throttles [-].

    Parameters
    ----------
    scenario : Scenario
        What was trimmed.
    point : TrimPoint
        From `trim`.
    """
    figure = make_subplots(
        rows=1,
        cols=3,
        subplot_titles=("from the east", "from above", "throttle"),
        column_widths=[0.38, 0.36, 0.26],
        horizontal_spacing=0.1,
    )
    curves = np.asarray(_curves(scenario.system, point.state))
    for column, view in ((1, FROM_EAST), (2, FROM_TOP)):
        _seen(figure, column, view, scenario, point, curves)
    _throttles(figure, scenario, point)
    figure.update_layout(
        template="plotly_white",
        height=HEIGHT,
        showlegend=False,
        margin={"l": 55, "r": 15, "t": 30, "b": 45},
        font={"color": style.INK, "size": 12},
    )
    return plain_figure(figure)


def _seen(figure: go.Figure, column: int, view: View, scenario: Scenario, point: TrimPoint, curves: np.ndarray) -> None:
    """Draw ship, cables and ground from one side, with equal scales."""
    position, rotation = np.asarray(point.state.position), np.asarray(rotation_matrix(point.state.attitude))
    for outline in ship_outlines(ship_shape(scenario.config.vehicle), position, rotation, view):
        _line(figure, column, np.concatenate([outline, outline[:1]]), style.INK, 1.0, fill="#DCDCDC")
    for index, curve in enumerate(curves):
        flat = view.project(curve)
        _line(figure, column, flat, style.cable_colour(index), 2.0)
        _mark(figure, column, flat[0])
    if view.shows_altitude:
        figure.add_hline(y=-float(ground_level(scenario.config)), line_color=style.BETWEEN, **_at(column))
    figure.update_xaxes(title_text=view.labels[0], zeroline=False, row=1, col=column)
    scale = {"scaleanchor": f"x{'' if column == 1 else column}", "scaleratio": 1}
    figure.update_yaxes(title_text=view.labels[1], zeroline=False, **scale, row=1, col=column)


def _line(figure: go.Figure, column: int, points: np.ndarray, colour: str, width: float, fill: str = "") -> None:
    """Draw a line, filled where a colour is given."""
    filled = {"fill": "toself", "fillcolor": fill} if fill else {}
    trace = go.Scatter(
        x=listed(points[:, 0]),
        y=listed(points[:, 1]),
        mode="lines",
        line={"color": colour, "width": width},
        hoverinfo="skip",
        **filled,
    )
    figure.add_trace(trace, row=1, col=column)


def _mark(figure: go.Figure, column: int, point: np.ndarray) -> None:
    """Draw an anchor."""
    marker = {"symbol": "diamond", "size": 8, "color": style.INK}
    trace = go.Scatter(x=[float(point[0])], y=[float(point[1])], mode="markers", marker=marker, name="anchor")
    figure.add_trace(trace, row=1, col=column)


def _throttles(figure: go.Figure, scenario: Scenario, point: TrimPoint) -> None:
    """Draw the throttles between their limits."""
    names = [thruster.name for thruster in scenario.config.vehicle.thrusters]
    values = np.asarray(point.command.throttle)
    lacking = [name in point.saturated for name in names]
    looks = {
        "color": [style.LACKING if lacks else style.SERIES[0] for lacks in lacking],
        "pattern": {"shape": ["/" if lacks else "" for lacks in lacking], "fgcolor": "#FFFFFF"},
    }
    bars = go.Bar(
        x=values.tolist(),
        y=[name.replace("_", "<br>") for name in names],
        orientation="h",
        marker=looks,
        text=["more than there is" if lacks else "" for lacks in lacking],
        textposition="auto",
        name="throttle",
        hovertemplate="%{y}: %{x:.4f} of nominal<extra></extra>",
    )
    figure.add_trace(bars, row=1, col=3)
    reach = max(1.1, 1.1 * float(np.abs(values).max(initial=0.0)))
    figure.update_xaxes(range=[-reach, reach], title_text="of nominal thrust [-]", row=1, col=3)
    figure.update_yaxes(autorange="reversed", row=1, col=3)
    for limit in (-1.0, 1.0):
        figure.add_vline(x=limit, line_color=style.INK, line_dash="dash", line_width=1, **_at(3))


def _at(column: int) -> dict[str, Any]:
    """Return the place of a panel as plotly's shapes take it."""
    return {"row": 1, "col": column}
