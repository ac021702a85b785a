"""The interactive root locus with the chosen scenario's own modes marked and named. Depends on: plotly, view."""

import json
from typing import Any

import plotly.graph_objects as go

from tethership.analysis import Modes, Sweep
from tethership.view import style
from tethership.view.interactive import interactive_root_locus
from tethership.view.root_locus import SLOWEST

HOVER = "<b>%{text}</b><br>chosen scenario<br>λ = %{x:.5f} %{y:+.5f}i 1/s<extra></extra>"

HEIGHT = 520


def locus_figure(found: Sweep, own: Modes | None) -> dict[str, Any]:
    """Return the figure as plotly's JSON: all modes left, slow ones right, stars where the chosen scenario is.

    Parameters
    ----------
    found : Sweep
        Along one parameter.
    own : Modes, optional
        Of the chosen scenario, which need not lie on the sweep; none without equilibrium.
    """
    figure = interactive_root_locus(found, "")
    figure.data = [trace for trace in figure.data if trace.name != "reference"]
    for axis in ("", "2") if own is not None else ():
        figure.add_trace(_stars(own, axis))
        for mode in own.modes:
            _name(figure, mode.name, mode.eigenvalue, axis)
    figure.update_layout(
        title=None,
        height=HEIGHT,
        margin={"l": 60, "r": 20, "t": 36, "b": 50},
        uirevision=f"{found.scenario.name} {', '.join(found.values)}",
        font={"color": style.INK},
    )
    return json.loads(figure.to_json())


def _stars(own: Modes, axis: str) -> go.Scatter:
    """Return the eigenvalues of the chosen scenario."""
    roots = own.eigenvalues
    names = {place: mode.name for mode in own.modes for place in mode.places}
    return go.Scatter(
        x=roots.real.tolist(),
        y=roots.imag.tolist(),
        text=[names.get(i, "") for i in range(len(roots))],
        mode="markers",
        marker={"symbol": "star", "size": 12, "color": style.END, "line": {"color": "#ffffff", "width": 0.8}},
        name="chosen scenario",
        hovertemplate=HOVER,
        xaxis=f"x{axis}",
        yaxis=f"y{axis}",
    )


def _name(figure: go.Figure, name: str, root: complex, axis: str) -> None:
    """Write a mode's name beside its star, once: the slow ones in the right panel, the fast ones in the left."""
    slow = abs(root) < SLOWEST
    if slow == (axis == "2"):
        figure.add_annotation(
            x=root.real,
            y=root.imag,
            text=name,
            xref=f"x{axis}",
            yref=f"y{axis}",
            showarrow=False,
            yshift=14,
            font={"size": 11},
        )
