"""A report: one self-contained page that reads like a paper's results and opens without a network.

Depends on: plotly, view.report.content, view.report.parts.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from plotly.offline import get_plotlyjs

from tethership._version import __version__
from tethership.view.report.content import VERDICTS, Cell, Figure, Section, Table
from tethership.view.report.page_file import page_text, write_page_text
from tethership.view.report.parts import Placed, every_section, labelled, number_sections, section_html
from tethership.view.report.text import Places, escaped, marked, plain

__all__ = ["VERDICTS", "Cell", "Figure", "Section", "Table", "write_report"]

POLICY = (
    "default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval'; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; worker-src blob:"
)
"""What the page may load: nothing that is not in it."""


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
    page = _page(title, abstract, placed, footer)
    return write_page_text(path, page)


def _page(title: str, abstract: Sequence[str], placed: list[Placed], footer: Mapping[str, Any]) -> str:
    """Return the page."""
    places = labelled(placed)
    body = "\n".join(section_html(part, places) for part in placed)
    explored = any(figure.interactive is not None for part in every_section(placed) for _, figure in part.figures)
    library = f'<script type="text/plain" id="plotly">{get_plotlyjs()}</script>\n' if explored else ""
    summary = "\n".join(f"<p>{marked(text, places)}</p>" for text in abstract)
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta name="generator" content="tethership {__version__}">\n<title>{plain(title)}</title>\n'
        f"<script>{_packaged('watch.js')}</script>\n<style>\n{_packaged('palette.css')}{_packaged('report.css')}</style>\n</head>\n<body>\n"
        f"<header>\n<h1>{marked(title)}</h1>\n{_abstract(summary)}</header>\n"
        f"{_contents(placed, places)}\n<main>\n{body}\n</main>\n{_footer(footer)}\n"
        f"{library}<script>\n{_packaged('explore.js')}</script>\n</body>\n</html>\n"
    )


def _packaged(name: str) -> str:
    """Return the text of a packaged style or script."""
    return page_text("report", name)


def _abstract(summary: str) -> str:
    """Return the abstract, nothing if it is empty."""
    return f'<div class="abstract" role="doc-abstract">\n{summary}\n</div>\n' if summary else ""


def _contents(placed: list[Placed], places: Places) -> str:
    """Return the table of contents: sections, and in them their tables and figures."""
    if not placed:
        return ""
    return (
        '<nav aria-label="Contents">\n<details class="contents" open>\n<summary>Contents</summary>\n'
        f"{_entries(placed, places)}\n</details>\n</nav>"
    )


def _entries(placed: list[Placed], places: Places) -> str:
    """Return the entries of some sections."""
    entries = []
    for part in placed:
        inner = [_entry(f"table-{n}", f"Table {n}", table.caption) for n, table in part.tables]
        inner += [_entry(f"figure-{n}", f"Figure {n}", figure.caption) for n, figure in part.figures]
        below = f'\n<ul class="items">\n{"".join(inner)}</ul>' if inner else ""
        deeper = f"\n{_entries(part.sections, places)}" if part.sections else ""
        entries.append(
            f'<li><a href="#{part.anchor}"><span class="number">{part.number}</span> {plain(part.section.title)}</a>'
            f"{below}{deeper}</li>\n"
        )
    return f"<ol>\n{''.join(entries)}</ol>"


def _entry(anchor: str, name: str, caption: str) -> str:
    """Return the entry of a table or figure: its name and the first sentence of its caption."""
    first = plain(caption).split(". ")[0].rstrip(".")
    return f'<li><a href="#{anchor}">{name}</a> {first}</li>\n'


def _footer(footer: Mapping[str, Any]) -> str:
    """Return the footer."""
    entries = "\n".join(
        f"<div><dt>{escaped(name)}</dt><dd>{marked(str(value))}</dd></div>"
        for name, value in footer.items()
        if value is not None
    )
    if not entries:
        return ""
    return (
        f'<footer aria-labelledby="provenance">\n<h2 id="provenance">Provenance</h2>\n<dl>\n{entries}\n</dl>\n</footer>'
    )
