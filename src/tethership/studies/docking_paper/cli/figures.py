"""`tethership sweep --figure N`: Figures 6–11 of the paper, computed and drawn."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

from tethership.cli.progress import stage
from tethership.cli.sweep import summary
from tethership.results import write_together
from tethership.studies.docking_paper import linear_figure

if TYPE_CHECKING:
    from tethership.analysis import Sweep


def figures(
    number: int, formulation: str | None, changes: dict[str, Any], out: Path
) -> tuple[dict[str, Any], list["Sweep"]]:
    """Return one figure of the paper in one formulation or both; writes figure_NN_FORMULATION.png and .html."""
    from tethership.studies.docking_paper.view.linear_figures import interactive_linear_figure, plot_linear_figure
    from tethership.view import png
    from tethership.view.linear import page

    files, shown, sweeps = [], {}, []
    chosen = formulation or changes.get("formulation")
    for name in ("consistent", "published") if chosen is None else (chosen,):
        with stage(f"figure {number}, {name}"):
            drawn = linear_figure(number, name, changes)
        with stage("draw"):
            stem = f"figure_{number:02d}_{name}"
            picture, explored = png(plot_linear_figure(drawn), 120), page(interactive_linear_figure(drawn))
        files += map(str, write_together({out / f"{stem}.png": picture, out / f"{stem}.html": explored}))
        sweeps += [panel.sweep for panel in drawn.panels]
        shown[name] = [{"title": panel.title, **summary(panel.sweep)} for panel in drawn.panels]
    first = next(iter(shown))
    top = {key: value for key, value in shown[first][0].items() if key != "title"}
    return {"figure": number, "formulation": first, **top, "formulations": shown, "files": files}, sweeps
