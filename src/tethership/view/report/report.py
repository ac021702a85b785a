"""A report: one self-contained page that reads like a paper's results and opens without a network.

Depends on: jinja2, plotly, view.report.
"""

import functools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from jinja2 import Environment
from markupsafe import Markup

from tethership._extras import needs
from tethership.view.report.content import VERDICTS, Cell, Figure, Section, Table
from tethership.view.report.page_file import templates, write_page_text
from tethership.view.report.parts import every_section, judged, labelled, looks, number_sections
from tethership.view.report.text import marked, number, plain

__all__ = ["VERDICTS", "Cell", "Figure", "Section", "Table", "write_report"]

LONG = 24
"""Rows from which a table scrolls inside its box."""

SIGNS = {"good": "✓", "fair": "≈", "bad": "✗"}
"""Set before a verdict, so that it is read without colour."""


def write_report(
    path: str | Path,
    title: str,
    abstract: Sequence[str],
    sections: Sequence[Section],
    footer: Mapping[str, Any],
) -> Path:
    """Write a report as one HTML file; returns where.

    Sections are numbered 1, 1.1, …; tables and figures through the report. Pictures, plots, styles and scripts are in
    the file. A plot is drawn when the reader opens it; the fragment ``#open-all`` opens all of them at once.

    Parameters
    ----------
    path : str or Path
        Where; its folder is made.
    title : str
        Heading of the page.
    abstract : sequence of str
        Paragraphs before the first section; text as in `Section`.
    sections : sequence of Section
        The report.
    footer : mapping
        Versions and provenance by name, in order; None is left out.

    Raises
    ------
    ConfigError
        The file cannot be written; a table is not rectangular; a picture cannot be read; a label is not known or
        given twice.

    Examples
    --------
    >>> import tempfile
    >>> table = Table("Largest tension.", ["wind [m/s]", "published [N]", "computed [N]"], [[6.0, 156.0, None]])
    >>> section = Section("Docking", ["Tensions stay **low**."], [table])
    >>> where = Path(tempfile.mkdtemp()) / "report.html"
    >>> write_report(where, "Docking", ["Summary."], [section], {"tethership": "0.1"}).name
    'report.html'
    """
    placed = number_sections(sections)
    explored = any(figure.plot for part in every_section(placed) for _, figure in part.figures)
    page = (
        _templates()
        .get_template("report/report.html")
        .render(
            title=title,
            abstract=abstract,
            placed=placed,
            places=labelled(placed),
            footer={name: value for name, value in footer.items() if value is not None},
            plotly=_plotly() if explored else None,
        )
    )
    return write_page_text(path, page)


def _plotly() -> Markup:
    """Return the script that draws plots."""
    with needs("plots"):
        from plotly.offline import get_plotlyjs
    return Markup(get_plotlyjs())


@functools.cache
def _templates() -> Environment:
    """Return the packaged templates with what a report's need besides."""
    found = templates()
    found.filters |= {"marked": marked, "plain": plain, "number": number, "looks": looks, "judged": judged}
    found.filters["first_sentence"] = lambda caption: plain(caption).split(". ")[0].rstrip(".")
    found.tests["truth"] = lambda cell: isinstance(cell, (bool, np.bool_))
    found.globals |= {"signs": SIGNS, "long": LONG}
    return found
