"""What a report is made of: sections with paragraphs, tables and figures, as plain data. Depends on: plotly (types)."""

import dataclasses
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from plotly.graph_objects import Figure as Plot

Cell = str | float | int | bool | None
"""What a table's cell may hold; None is shown as a dash."""

VERDICTS: Mapping[str, str] = {
    "agrees": "good",
    "holds": "good",
    "met": "good",
    "inside": "good",
    "near": "fair",
    "undecided": "fair",
    "no verdict": "fair",
    "differs": "bad",
    "does not hold": "bad",
    "not met": "bad",
    "broken": "bad",
    "outside": "bad",
}
"""Words that are shown as verdicts wherever a cell holds nothing else, and how each is meant."""


@dataclasses.dataclass(frozen=True)
class Table:
    """A table.

    Attributes
    ----------
    caption : str
        Stands above it; text as in `Section`.
    columns : sequence of str
        Heads of the columns, units included.
    rows : sequence of sequences
        Cells, as many in each row as there are columns; the first of a row names it.
    note : str
        Stands below it; text as in `Section`.
    verdict_column : int, optional
        The column whose verdict is that of the row, which is marked with it.
    label : str
        What paragraphs call it, in ``[[label]]``.
    """

    caption: str
    columns: Sequence[str]
    rows: Sequence[Sequence[Cell]]
    note: str = ""
    verdict_column: int | None = None
    label: str = ""


@dataclasses.dataclass(frozen=True)
class Figure:
    """A figure: a picture, a plot to be explored, or both.

    Attributes
    ----------
    caption : str
        Stands below it; text as in `Section`.
    png : Path or bytes, optional
        The picture, as a file or its content.
    interactive : plotly Figure or Path, optional
        Drawn when the reader opens it; of a file, what ``Figure.write_json`` wrote.
    alt : str
        What the picture shows, for who cannot see it; the caption if empty.
    label : str
        What paragraphs call it, in ``[[label]]``.
    """

    caption: str
    png: Path | bytes | None = None
    interactive: "Plot | Path | None" = None
    alt: str = ""
    label: str = ""


@dataclasses.dataclass(frozen=True)
class Section:
    """A section: its paragraphs, then its tables, its figures, its sub-sections.

    Attributes
    ----------
    title : str
        Heading, without number.
    paragraphs : sequence of str
        Plain text; `code` between backticks, **bold** between double asterisks, addresses become links, and
        ``[[label]]`` becomes "Table 3", "Figure 2" or "Section 1.2", linked.
    tables : sequence of Table
    figures : sequence of Figure
    sections : sequence of Section
        Sub-sections.
    label : str
        What paragraphs call it, in ``[[label]]``.
    """

    title: str
    paragraphs: Sequence[str] = ()
    tables: Sequence[Table] = ()
    figures: Sequence[Figure] = ()
    sections: Sequence["Section"] = ()
    label: str = ""
