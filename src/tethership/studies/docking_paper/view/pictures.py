"""Pictures of the paper's study: each job draws PNG files and plots to be explored, from what was computed.

Depends on: studies.docking_paper, view, matplotlib, plotly.
"""

from pathlib import Path
from typing import Any

import matplotlib.figure

from tethership._extras import needs
from tethership.results import write_atomically, write_together
from tethership.simulation import Flight
from tethership.studies.docking_paper import FIGURES, linear_figure
from tethership.studies.docking_paper.fit.fit_file import stored_fit
from tethership.studies.docking_paper.fit.targets import TABLES
from tethership.studies.docking_paper.jobs import Settings, load_part
from tethership.studies.docking_paper.study import flight_file, vehicle_name
from tethership.studies.docking_paper.view.breakdown import plot_breakdown
from tethership.studies.docking_paper.view.comparison import plot_comparison
from tethership.studies.docking_paper.view.fit_figures import plot_correlation, plot_marginals, plot_residuals
from tethership.studies.docking_paper.view.line_figures import plot_line_comparison
from tethership.studies.docking_paper.view.linear_figures import interactive_linear_figure, plot_linear_figure
from tethership.view import png
from tethership.view.flight import interactive_histories, plot_docking
from tethership.view.replay import write_replay

with needs("plots"):
    import plotly.graph_objects as go
    from plotly.offline import get_plotlyjs

DPI = 110
"""Of pictures."""

DOCKING_FIGURES = {12: "rewind", 13: "heading", 14: "navigation"}
"""Flights of Figures 12–14, at 12 m/s."""

WIND = 12.0
"""Their wind [m/s]."""

LAYER_WORDS = {
    "rewind": "rewind control",
    "heading": "rewind and heading control",
    "navigation": "rewind, heading and navigation control",
}
"""Layers in words."""


class _Pictures:
    """Collects the files that a job writes, relative to the study's folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.files: list[str] = []

    def png(self, name: str, drawn: matplotlib.figure.Figure) -> None:
        """Write a picture."""
        write_atomically(self.folder / "figures" / f"{name}.png", png(drawn, DPI))
        self.files.append(f"figures/{name}.png")

    def plot(self, name: str, drawn: go.Figure) -> None:
        """Write a plot to be explored: as a page of its own, and as data for the report."""
        figures = self.folder / "figures"
        page = drawn.to_html(include_plotlyjs="directory", full_html=True)
        write_together({figures / f"{name}.html": page, figures / f"{name}.json": str(drawn.to_json())})
        write_atomically(figures / "plotly.min.js", get_plotlyjs())  # what all pages of the folder share
        self.files += [f"figures/{name}.json", f"figures/{name}.html"]

    def replay(self, name: str, flights: dict[str, Flight]) -> None:
        """Write a flight, by the name shown, as a page of its own, to be played in space."""
        write_replay(flights, self.folder / "figures" / f"{name}.html")
        self.files.append(f"figures/{name}.html")

    def result(self) -> dict[str, Any]:
        """Return what the job gives."""
        return {"files": self.files}


def linear_pictures(folder: Path, settings: Settings) -> dict[str, Any]:
    """Draw Figures 6–11 with the identified ship."""
    pictures = _Pictures(folder)
    changes = {"vehicle": vehicle_name(settings.formulation)}
    for number in FIGURES:
        drawn = linear_figure(number, settings.formulation, changes)
        pictures.png(f"figure_{number:02d}", plot_linear_figure(drawn))
        pictures.plot(f"figure_{number:02d}", interactive_linear_figure(drawn))
    return pictures.result()


def docking_pictures(folder: Path, settings: Settings) -> dict[str, Any]:
    """Draw Figures 12–15 and the loads of the flights at 12 m/s."""
    pictures = _Pictures(folder)
    flights = {
        table: Flight.load(flight_file(folder, (table, WIND)))
        for table in TABLES
        if flight_file(folder, (table, WIND)).exists()
    }
    for number, table in DOCKING_FIGURES.items():
        if table not in flights:
            continue
        title = f"Figure {number} of the paper, computed: {LAYER_WORDS[table]}, 12 m/s"
        pictures.png(f"figure_{number}", plot_docking(flights[table], title=title))
        pictures.replay(f"figure_{number}", {LAYER_WORDS[table]: flights[table]})
        pictures.plot(f"figure_{number}_histories", interactive_histories(flights[table]))
        pictures.png(f"loads_{table}", plot_breakdown(flights[table]))
    if flights:
        pictures.png("figure_15", plot_comparison({LAYER_WORDS[table]: flight for table, flight in flights.items()}))
    return pictures.result()


def fit_pictures(folder: Path, settings: Settings) -> dict[str, Any]:
    """Draw the identified set: marginal ranges, correlations, and how far each number is off."""
    pictures = _Pictures(folder)
    fit = stored_fit(settings.formulation)
    pictures.png("fit_marginals", plot_marginals(fit))
    pictures.png("fit_correlation", plot_correlation(fit))
    pictures.png("fit_residuals", plot_residuals(fit))
    return pictures.result()


def line_pictures(folder: Path, settings: Settings) -> dict[str, Any]:
    """Draw the tension of the quasi-static cable beside that of the dynamic line."""
    pictures = _Pictures(folder)
    for name, case in load_part(folder, "cable")["cases"].items():
        pictures.png(f"line_{name}", plot_line_comparison(case))
    return pictures.result()
