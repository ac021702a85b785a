"""The interactive root locus with the chosen scenario's own modes marked and named. Depends on: plotly, view."""

from typing import Any

import numpy as np
import plotly.graph_objects as go

from tethership.analysis import Modes, Sweep
from tethership.explorer.plain import plain_figure
from tethership.view import style
from tethership.view.linear import ANNOTATION, REFERENCE, SLOWEST, interactive_root_locus, mode_names

HOVER = "<b>%{text}</b><br>chosen scenario<br>λ = %{x:.5f} %{y:+.5f}i 1/s<extra></extra>"

HEIGHT = 520


def locus_figure(found: Sweep, own: Modes | None) -> dict[str, Any]:
    """Return the figure as plotly's JSON: all modes left, slow ones right, stars where the chosen scenario is.

    Re λ [1/s] is across, Im λ [rad/s] up; slow is |λ| below `SLOWEST` [1/s].

    Parameters
    ----------
    found : Sweep
        Along one parameter.
    own : Modes, optional
        Of the chosen scenario, which need not lie on the sweep; none without equilibrium.
    """
    figure = interactive_root_locus(found, "")
    figure.data = [trace for trace in list[Any](figure.data) if trace.name != REFERENCE]
    if own is not None:
        figure.layout.annotations = [one for one in list[Any](figure.layout.annotations) if one.name != ANNOTATION]
        for axis in ("", "2"):
            figure.add_trace(_stars(own, axis))
            _names(figure, found, own, axis)
    figure.update_layout(
        title=None,
        showlegend=False,
        height=HEIGHT,
        margin={"l": 60, "r": 20, "t": 36, "b": 50},
        uirevision=f"{found.scenario.name} {', '.join(found.values)}",
        font={"color": style.INK},
    )
    return plain_figure(figure)


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


def _names(figure: go.Figure, found: Sweep, own: Modes, axis: str) -> None:
    """Write the modes' names beside their stars, once: the slow ones in the right panel, the others in the left."""
    slow = axis == "2"
    drawn = np.concatenate([found.eigenvalues[found.trimmed].ravel(), own.eigenvalues])
    drawn = drawn[np.abs(drawn) < SLOWEST] if slow else drawn
    modes = [(mode.name, mode.eigenvalue) for mode in own.modes if (abs(mode.eigenvalue) < SLOWEST) == slow]
    for name in mode_names(modes, drawn, axis):
        figure.add_annotation(name)
