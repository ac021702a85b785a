"""Sections, tables and figures of a report, numbered and checked, for its templates. Depends on: view.report."""

import base64
import json
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from tethership.errors import ConfigError
from tethership.view.report.content import VERDICTS, Cell, Figure, Section, Table
from tethership.view.report.text import Place, is_number

PROSE = 30
"""Characters from which a cell is prose, whose column is not made too narrow."""

SIGNATURE = b"\x89PNG\r\n\x1a\n"
"""How a PNG file begins."""


class Picture(NamedTuple):
    """A picture in the page: its size [pixels] and its content in base 64."""

    width: int
    height: int
    source: str


class Drawn(NamedTuple):
    """A figure with what it shows read: its picture, its plot as plotly's data."""

    caption: str
    alt: str
    label: str
    picture: Picture | None
    plot: dict[str, Any] | None


class Placed(NamedTuple):
    """A section with its number, and the numbers of what is in it.

    Attributes
    ----------
    number : str
        1, 1.1, …
    section : Section
    tables : list of (int, Table)
    figures : list of (int, Drawn)
    sections : list of Placed
        Sub-sections.
    """

    number: str
    section: Section
    tables: list[tuple[int, Table]]
    figures: list[tuple[int, Drawn]]
    sections: list["Placed"]

    @property
    def anchor(self) -> str:
        """Identifier of its element."""
        return "section-" + self.number.replace(".", "-")


def number_sections(sections: Sequence[Section]) -> list[Placed]:
    """Return sections numbered 1, 1.1, …, their tables and figures numbered through the report.

    Raises
    ------
    ConfigError
        A table is not rectangular or has no such column of verdicts, or a figure shows nothing or cannot be read.
    """
    tables, figures = iter(range(1, 10**6)), iter(range(1, 10**6))

    def place(section: Section, name: str) -> Placed:
        own_tables = [(n := next(tables), _checked(n, table)) for table in section.tables]
        own_figures = [(n := next(figures), _drawn(n, figure)) for figure in section.figures]
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


def _checked(index: int, table: Table) -> Table:
    """Return a table that is rectangular and has its column of verdicts; raises ConfigError for another."""
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
    return table


def looks(table: Table) -> list[str]:
    """Return the class of each column: n if most of what it holds are numbers, prose if it holds long texts."""
    return [_look([row[i] for row in table.rows]) for i in range(len(table.columns))]


def judged(cell: Cell) -> str:
    """Return how a cell's verdict is meant, nothing where it holds none."""
    return VERDICTS.get(cell, "") if isinstance(cell, str) else ""


def _look(cells: Sequence[Cell]) -> str:
    """Return the class of a column of these cells."""
    filled = [cell for cell in cells if cell is not None and cell != ""]
    if 2 * sum(is_number(cell) for cell in filled) > len(filled):
        return "n"
    return "prose" if any(isinstance(cell, str) and len(cell) > PROSE for cell in filled) else ""


def _drawn(index: int, figure: Figure) -> Drawn:
    """Return a figure with its files read; raises ConfigError if it shows nothing or a file is no good."""
    if figure.png is None and figure.interactive is None:
        raise ConfigError(f"figure {index} ({figure.caption!r}) shows nothing; give it a png or an interactive plot")
    return Drawn(figure.caption, figure.alt, figure.label, _picture(index, figure), _plot(index, figure))


def _picture(index: int, figure: Figure) -> Picture | None:
    """Return a figure's picture, None where it has none."""
    if figure.png is None:
        return None
    data = _png(index, figure)
    width, height = struct.unpack(">II", data[16:24])
    return Picture(width, height, base64.b64encode(data).decode("ascii"))


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


def _plot(index: int, figure: Figure) -> dict[str, Any] | None:
    """Return the data of a figure's plot, None where it has none."""
    plot = figure.interactive
    if plot is None:
        return None
    if not isinstance(plot, Path):
        return json.loads(str(plot.to_json()))
    try:
        data = json.loads(_read(index, figure, plot), parse_constant=lambda name: None)
    except ValueError:
        data = None
    if not (isinstance(data, dict) and {"data", "layout"} <= data.keys()):
        raise ConfigError(f"figure {index} ({figure.caption!r}): {plot} is no plot; write it with Figure.write_json")
    return data
