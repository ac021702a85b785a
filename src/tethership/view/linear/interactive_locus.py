"""Root loci to be explored in a browser: one self-contained page, hover tells parameter, eigenvalue and mode.

Depends on: plotly, view.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from tethership._extras import needs
from tethership.analysis.loci import Sweep
from tethership.analysis.modes import Complex
from tethership.view import style
from tethership.view.linear.mode_names import mode_names
from tethership.view.linear.panel import Panel
from tethership.view.linear.root_locus import PANELS, SLOWEST, colour_parameter, display, own_point
from tethership.view.report.page_file import write_page_text

with needs("plots"):
    import plotly.graph_objects as go
    from plotly.subplots import make_subplots

SPACING = 0.2
"""Room between two panels, for a colour bar and labels [share of the page]."""

REFERENCE, UNTETHERED = "reference", "untethered"

MARKS = (REFERENCE, UNTETHERED)
"""Traces that the legend explains; modes are named beside their tracks."""

HOVER = "<b>%{customdata[0]}</b><br>%{customdata[1]}<br>λ = %{customdata[2]} 1/s<extra>%{customdata[3]}</extra>"


def interactive_root_locus(found: Sweep, title: str = "Root locus", parameter: str | None = None) -> go.Figure:
    """Return a sweep as a plotly figure.

    Parameters
    ----------
    found : Sweep
        From `sweep`.
    title : str
        Above the plot.
    parameter : str, optional
        Which parameter colours the dots; the first if not given.

    Returns
    -------
    Figure
        Re λ [1/s] across, Im λ [rad/s] up, all modes and beside them the slow ones; hovering tells parameter, λ and
        mode.
    """
    name = colour_parameter(found, parameter)
    star = own_point(found)
    return _assembled([Panel(words, found, name, star, None, slow) for words, slow in PANELS], title)


def interactive_panels(panels: Sequence[Panel], title: str) -> go.Figure:
    """Return root loci beside each other as a plotly figure, Re λ [1/s] across, Im λ [rad/s] up."""
    return _assembled(list(panels), title)


def write_page(figure: go.Figure, path: Path) -> None:
    """Write a page that works from disk without a network; raises ConfigError where that cannot be."""
    write_page_text(path, page(figure))


def page(figure: go.Figure) -> str:
    """Return a page that works from disk without a network."""
    return figure.to_html(include_plotlyjs=True, full_html=True)


def _assembled(panels: list[Panel], title: str) -> go.Figure:
    count = len(panels)
    drawn = make_subplots(
        rows=1, cols=count, subplot_titles=[panel.title for panel in panels], horizontal_spacing=SPACING
    )
    for column, panel in enumerate(panels, start=1):
        for trace in _traces(panel, (1.0 - SPACING * (count - 1)) / count * column + SPACING * (column - 1)):
            drawn.add_trace(trace.update(showlegend=trace.name in MARKS and column == 1), row=1, col=column)
        drawn.update_xaxes(title_text="Re λ [1/s]", zeroline=True, zerolinecolor=style.INK, row=1, col=column)
        drawn.update_yaxes(title_text="Im λ [rad/s]", zeroline=True, zerolinecolor=style.INK, row=1, col=column)
        for name in _named(panel, panels, "" if column == 1 else str(column)):
            drawn.add_annotation(name)
        if panel.slow:
            limits = _slow_limits(panel)
            drawn.update_xaxes(range=limits[0], row=1, col=column)
            drawn.update_yaxes(range=limits[1], row=1, col=column)
    legend = {"orientation": "h", "x": 1.0, "xanchor": "right", "y": 1.06, "yanchor": "bottom"}
    drawn.update_layout(title=title, template="plotly_white", legend=legend, hovermode="closest")
    return drawn


def _slow_limits(panel: Panel) -> tuple[list[float], list[float]]:
    roots = np.concatenate([panel.sweep.track(track)[panel.sweep.trimmed] for track in panel.sweep.tracks])
    roots = roots[np.abs(roots) < SLOWEST]
    low, high = roots.real.min(initial=-0.01), roots.real.max(initial=0.01)
    reach = np.abs(roots.imag).max(initial=0.01)
    return [1.2 * low - 0.01, 1.2 * high + 0.01], [-1.15 * reach, 1.15 * reach]


def _traces(panel: Panel, right: float) -> list[go.Scatter]:
    """Return a panel's tracks and marks; its colour bar stands right of its right edge [share of the page]."""
    found = panel.sweep
    points = np.flatnonzero(found.trimmed)
    label, unit, factor = display(panel.parameter, found.units[panel.parameter])
    value = found.values[panel.parameter] * factor
    names = [found.names_at(int(point)) for point in points]
    traces = []
    for index, track in enumerate(found.tracks):
        roots = found.track(track)[points]
        notes = [_note(found, int(point)) for point in points]
        texts = [f"{root.real:.5f} {root.imag:+.5f}i" for root in roots]
        data = list(zip([row[index] for row in names], notes, texts, [track] * len(points), strict=True))
        marker: dict[str, Any] = {"size": 7, "color": value[points], "colorscale": "Viridis"}
        if index == 0 and len(value) > 1:
            marker |= {
                "showscale": True,
                "colorbar": {
                    "title": {"text": f"{label} [{unit}]" if unit else label, "side": "right"},
                    "x": right + 0.01,
                    "thickness": 14,
                    "len": 0.9,
                },
            }
        traces.append(
            go.Scatter(
                x=roots.real,
                y=roots.imag,
                mode="markers",
                marker=marker,
                customdata=data,
                hovertemplate=HOVER,
                name=track,
            )
        )
    return traces + _marks(panel)


def _named(panel: Panel, panels: list[Panel], axis: str) -> list[dict[str, Any]]:
    """Return the names of a panel's modes at the middle of the sweep; of a pair once, at the upper member.

    Modes that a panel of the slow ones shows larger are named there alone.
    """
    found = panel.sweep
    points = np.flatnonzero(found.trimmed)
    if not len(points):
        return []
    middle = int(points[len(points) // 2])
    larger = any(other.slow and other.sweep is found for other in panels)
    roots = found.eigenvalues[found.trimmed].ravel()
    modes = []
    for name, track in zip(found.names_at(middle), found.tracks, strict=True):
        root = complex(found.track(track)[middle])
        if root.imag >= 0.0 and ((abs(root) < SLOWEST) == panel.slow or not (panel.slow or larger)):
            modes.append((name, root))
    return mode_names(modes, roots[np.abs(roots) < SLOWEST] if panel.slow else roots, axis)


def _note(found: Sweep, point: int) -> str:
    """Return the parameters of a point in words."""
    parts = []
    for name, values in found.values.items():
        label, unit, factor = display(name, found.units[name])
        parts.append(f"{label} = {values[point] * factor:.5g} {unit}".rstrip())
    return "<br>".join(parts)


def _marks(panel: Panel) -> list[go.Scatter]:
    """Return the stars of the reference and the circles of the untethered ship."""
    found, marks = panel.sweep, []
    if panel.star is not None and found.trimmed[panel.star] and len(found.outcomes) > 1:
        roots: Complex = np.array([found.track(track)[panel.star] for track in found.tracks], dtype=np.complex128)
        marker = {"symbol": "star", "size": 13, "color": style.END}
        marks.append(
            go.Scatter(x=roots.real, y=roots.imag, mode="markers", marker=marker, hoverinfo="skip", name=REFERENCE)
        )
    if panel.free is not None:
        modes = panel.free.modes
        free: Complex = np.array([v for m in modes for v in (m.eigenvalue, m.eigenvalue.conjugate())], np.complex128)
        names = [mode.name for mode in modes for _ in range(2)]
        marker = {"symbol": "circle-open", "size": 12, "color": style.INK}
        marks.append(
            go.Scatter(
                x=free.real,
                y=free.imag,
                mode="markers",
                marker=marker,
                text=names,
                name=UNTETHERED,
                hovertemplate="<b>%{text}</b><br>untethered<br>λ = %{x:.5f} %{y:+.5f}i 1/s<extra></extra>",
            )
        )
    return marks
