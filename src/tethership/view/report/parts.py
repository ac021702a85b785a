"""Tables, figures and sections of a report as HTML, numbered. Depends on: view.report.content, view.report.text."""

import base64
import json
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tethership.errors import ConfigError
from tethership.view.report.content import VERDICTS, Cell, Figure, Section, Table
from tethership.view.report.text import NONE, Place, Places, escaped, is_number, marked, number, plain

LONG = 24
"""Rows from which a table scrolls inside its box."""

PROSE = 30
"""Characters from which a cell is prose, whose column is not made too narrow."""

SIGNS = {"good": "✓", "fair": "≈", "bad": "✗"}
"""Set before a verdict, so that it is read without colour."""

SIGNATURE = b"\x89PNG\r\n\x1a\n"
"""How a PNG file begins."""


class Placed(NamedTuple):
    """A section with its number, and the numbers of what is in it.

    Attributes
    ----------
    number : str
        1, 1.1, …
    section : Section
    tables : list of (int, Table)
    figures : list of (int, Figure)
    sections : list of Placed
        Sub-sections.
    """

    number: str
    section: Section
    tables: list[tuple[int, Table]]
    figures: list[tuple[int, Figure]]
    sections: list["Placed"]

    @property
    def anchor(self) -> str:
        """Identifier of its element."""
        return "section-" + self.number.replace(".", "-")


def number_sections(sections: Sequence[Section]) -> list[Placed]:
    """Return sections numbered 1, 1.1, …, their tables and figures numbered through the report."""
    tables, figures = iter(range(1, 10**6)), iter(range(1, 10**6))

    def place(section: Section, name: str) -> Placed:
        own_tables = [(next(tables), table) for table in section.tables]
        own_figures = [(next(figures), figure) for figure in section.figures]
        inner = [place(part, f"{name}.{index}") for index, part in enumerate(section.sections, start=1)]
        return Placed(name, section, own_tables, own_figures, inner)

    return [place(section, str(index)) for index, section in enumerate(sections, start=1)]


def every_section(placed: Sequence[Placed]) -> Iterator[Placed]:
    """Yield sections and their sub-sections, in order."""
    for part in placed:
        yield part
        yield from every_section(part.sections)


def labelled(placed: Sequence[Placed]) -> dict[str, Place]:
    """Return what the labels of a report stand for; raises ConfigError for a label given twice."""
    places: dict[str, Place] = {}
    for part in every_section(placed):
        found = [(part.section.label, Place(f"Section {part.number}", part.anchor))]
        found += [(table.label, Place(f"Table {n}", f"table-{n}")) for n, table in part.tables]
        found += [(figure.label, Place(f"Figure {n}", f"figure-{n}")) for n, figure in part.figures]
        for label, place in found:
            if label in places:
                raise ConfigError(f"{places[label].name} and {place.name} are both labelled {label!r}; rename one")
            if label:
                places[label] = place
    return places


def section_html(placed: Placed, places: Places, level: int = 2) -> str:
    """Return a section as HTML, its heading of a level, those of its sub-sections one deeper."""
    section, heading = placed.section, f"h{min(level, 6)}"
    parts = [
        f'<section id="{placed.anchor}">',
        f'<{heading}><span class="number">{placed.number}</span> {marked(section.title)}</{heading}>',
        *(f"<p>{marked(text, places)}</p>" for text in section.paragraphs),
        *(table_html(n, table, places) for n, table in placed.tables),
        *(figure_html(n, figure, places) for n, figure in placed.figures),
        *(section_html(part, places, level + 1) for part in placed.sections),
        "</section>",
    ]
    return "\n".join(parts)


def table_html(index: int, table: Table, places: Places) -> str:
    """Return a table as HTML; raises ConfigError if its rows do not fit its head."""
    _check(index, table)
    looks = [_look([row[i] for row in table.rows]) for i in range(len(table.columns))]
    head = "".join(
        f'<th scope="col"{_classes(look)}>{marked(text)}</th>' for text, look in zip(table.columns, looks, strict=True)
    )
    body = "\n".join(_row_html(row, looks, table.verdict_column) for row in table.rows)
    long = " long" if len(table.rows) > LONG else ""
    note = f'<p class="note">{marked(table.note, places)}</p>\n' if table.note else ""
    return (
        f'<figure class="table" id="table-{index}">\n'
        f'<figcaption id="table-{index}-caption"><b>Table {index}.</b> {marked(table.caption, places)}</figcaption>\n'
        f'<div class="box{long}" role="region" tabindex="0" aria-labelledby="table-{index}-caption">\n'
        f'<table aria-labelledby="table-{index}-caption">\n<thead><tr>{head}</tr></thead>\n'
        f"<tbody>\n{body}\n</tbody>\n</table>\n</div>\n{note}</figure>"
    )


def _check(index: int, table: Table) -> None:
    """Raise ConfigError if a table is not rectangular or has no column of verdicts where it says."""
    width = len(table.columns)
    for place, row in enumerate(table.rows, start=1):
        if len(row) != width:
            raise ConfigError(
                f"row {place} of table {index} ({table.caption!r}) has {len(row)} cells, but the table has {width} "
                "columns; fill with None"
            )
    if table.verdict_column is not None and not 0 <= table.verdict_column < width:
        raise ConfigError(
            f"table {index} ({table.caption!r}) has no verdict column {table.verdict_column}; give 0 to {width - 1}"
        )


def _look(cells: Sequence[Cell]) -> str:
    """Return the class of a column: n if most of what it holds are numbers, prose if it holds long texts."""
    filled = [cell for cell in cells if cell is not None and cell != ""]
    if 2 * sum(is_number(cell) for cell in filled) > len(filled):
        return "n"
    return "prose" if any(isinstance(cell, str) and len(cell) > PROSE for cell in filled) else ""


def _classes(*names: str) -> str:
    """Return the attribute of some classes, nothing if they are empty."""
    kept = " ".join(name for name in names if name)
    return f' class="{kept}"' if kept else ""


def _row_html(row: Sequence[Cell], looks: Sequence[str], verdict_column: int | None) -> str:
    """Return a row as HTML; its first cell is its head."""
    cells = []
    for i, cell in enumerate(row):
        kind = VERDICTS.get(cell, "") if isinstance(cell, str) else ""
        classes = _classes(looks[i], f"verdict {kind}" if kind else "")
        tag, scope = ("th", ' scope="row"') if i == 0 else ("td", "")
        cells.append(f"<{tag}{scope}{classes}>{_cell_html(cell, kind)}</{tag}>")
    judged = "" if verdict_column is None else VERDICTS.get(str(row[verdict_column]), "")
    return f"<tr{_classes(judged)}>{''.join(cells)}</tr>"


def _cell_html(cell: Cell, kind: str) -> str:
    """Return what a cell shows, as HTML."""
    if cell is None:
        return f'<span title="no value">{NONE}</span>'
    if kind:
        return f'<span aria-hidden="true">{SIGNS[kind]}</span> {escaped(cell)}'
    if isinstance(cell, str):
        return marked(cell)
    return ("yes" if cell else "no") if isinstance(cell, (bool, np.bool_)) else number(cell)


def figure_html(index: int, figure: Figure, places: Places) -> str:
    """Return a figure as HTML: its picture, its caption, and its plot as data to be drawn when opened.

    Raises
    ------
    ConfigError
        It shows nothing, or its picture cannot be read or is no PNG.
    """
    if figure.png is None and figure.interactive is None:
        raise ConfigError(f"figure {index} ({figure.caption!r}) shows nothing; give it a png or an interactive plot")
    parts = [f'<figure class="picture" id="figure-{index}">']
    if figure.png is not None:
        data = _png(index, figure)
        width, height = struct.unpack(">II", data[16:24])
        source = base64.b64encode(data).decode("ascii")
        parts.append(
            f'<div class="frame" role="group" tabindex="0" aria-label="Picture of figure {index}">\n'
            f'<img alt="{plain(figure.alt or figure.caption)}" width="{width}" height="{height}" '
            f'src="data:image/png;base64,{source}">\n</div>'
        )
    parts.append(f"<figcaption><b>Figure {index}.</b> {marked(figure.caption, places)}</figcaption>")
    if figure.interactive is not None:
        parts.append(_plot_html(index, figure))
    return "\n".join([*parts, "</figure>"])


def _png(index: int, figure: Figure) -> bytes:
    """Return the content of a figure's picture."""
    if isinstance(figure.png, bytes):
        data, name = figure.png, "its picture"
    else:
        data, name = _read(index, figure, Path(str(figure.png))), str(figure.png)
    if not data.startswith(SIGNATURE) or len(data) < 24:
        raise ConfigError(f"figure {index} ({figure.caption!r}): {name} is no PNG; save the picture as .png")
    return data


def _read(index: int, figure: Figure, path: Path) -> bytes:
    """Return the content of a file of a figure."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise ConfigError(
            f"figure {index} ({figure.caption!r}): cannot read {path}: {error.strerror or error}; draw it first"
        ) from error


def _plot_json(index: int, figure: Figure) -> str:
    """Return the data of a figure's plot as JSON in which nothing can be read as HTML."""
    plot = figure.interactive
    if not isinstance(plot, Path):
        return str(plot.to_json()).replace("<", "\\u003c") if plot is not None else ""
    try:
        data = json.loads(_read(index, figure, plot))
        found = isinstance(data, dict) and {"data", "layout"} <= data.keys()
    except ValueError:
        data, found = None, False
    if not found:
        raise ConfigError(f"figure {index} ({figure.caption!r}): {plot} is no plot; write it with Figure.write_json")
    return json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")


def _plot_html(index: int, figure: Figure) -> str:
    """Return the data of a plot, in a part of the page that draws it when it is opened."""
    return (
        f'<details class="plot" data-plot="{index}">\n<summary>Explore figure {index}</summary>\n'
        f'<div class="canvas" role="group" aria-label="Figure {index}, to be explored"></div>\n'
        "<noscript><p>Exploring needs JavaScript.</p></noscript>\n"
        f'<script type="application/json">{_plot_json(index, figure)}</script>\n</details>'
    )
