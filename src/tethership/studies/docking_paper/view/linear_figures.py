"""Figures 6–11 of the paper, drawn: a picture and a page. Depends on: studies.docking_paper, view, plotly."""

from typing import TYPE_CHECKING

from matplotlib.figure import Figure

from tethership.studies.docking_paper.linear_figures import LinearFigure
from tethership.view.linear import plot_panels

if TYPE_CHECKING:
    import plotly.graph_objects as go


def plot_linear_figure(figure: LinearFigure) -> Figure:
    """Draw one of Figures 6–11 of the paper, Re λ [1/s] across, Im λ [rad/s] up.

    Returns a figure that is not shown and not saved.
    """
    title = f"Figure {figure.number} of the paper, computed: {figure.title}\n{figure.formulation} formulation"
    return plot_panels(figure.panels, title)


def interactive_linear_figure(figure: LinearFigure) -> "go.Figure":
    """Return one of Figures 6–11 of the paper as a plotly figure, Re λ [1/s] across, Im λ [rad/s] up."""
    from tethership.view.linear import interactive_panels

    title = f"Figure {figure.number} of the paper, computed: {figure.title} · {figure.formulation} formulation"
    return interactive_panels(figure.panels, title)
