"""Tables of the command line: printed for people, written as CSV in full precision. Depends on: rich, typer."""

import csv
import errno
import io
import os
import sys
from collections.abc import Iterable, Sequence
from itertools import zip_longest
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import typer

from tethership.errors import ConfigError
from tethership.results import check_writable, write_atomically

CsvOption = Annotated[
    Path | None, typer.Option("--csv", metavar="FILE", help="Also write the table as CSV, every digit of it.")
]

QUANTITIES = ("quantity", "value", "unit")
"""Columns of a table of rows."""

NAME_WIDTH = 22
"""Least width of the first column [letters]: tables below one another have their numbers below one another."""

NOTE_WIDTH = 20
"""Width that is left to words in the last column of a narrow terminal [letters]."""


class Row(NamedTuple):
    """One quantity of a table.

    Attributes
    ----------
    name : str
        What it is.
    value : float, int or str
        Its value.
    unit : str
        Its unit, or nothing.
    spec : str
        How a number is shown, as in `format`.
    note : str
        Said after the unit, not written to CSV.
    """

    name: str
    value: float | int | str
    unit: str = ""
    spec: str = ""
    note: str = ""


class Cell(NamedTuple):
    """A value that is written to CSV in full, and the text that people are shown in its place."""

    value: Any
    text: str


class Table(NamedTuple):
    """A table for people and for CSV.

    Attributes
    ----------
    rows : sequence
        Of `Row`, or of as many values (a `Cell` where they are shown otherwise) as there are columns; what a row has
        beyond them is shown and not written.
    title : str
        A line before it.
    columns : tuple of str
        Heads in CSV.
    heads : tuple of str
        Heads for people; none are shown where there are none.
    """

    rows: Sequence[Sequence[Any]]
    title: str = ""
    columns: tuple[str, ...] = QUANTITIES
    heads: tuple[str, ...] = ()


def _cells(row: Sequence[Any]) -> list[Cell]:
    """Return the cells of a row."""
    if isinstance(row, Row):
        row = (row.name, Cell(row.value, format(row.value, row.spec)), row.unit, row.note.strip())
    return [value if isinstance(value, Cell) else Cell(value, "" if value is None else str(value)) for value in row]


def print_table(
    rows: Sequence[Sequence[Any]], title: str = "", columns: Sequence[str] = QUANTITIES, heads: Sequence[str] = ()
) -> None:
    """Print a table (see `Table`) on standard output; a column in which nothing is said is left out.

    A number is never broken or cut: on a terminal too narrow for it a line goes on in the next. Words in the last
    column are wrapped on a terminal and nowhere else.
    """
    from rich.cells import cell_len
    from rich.console import Console
    from rich.table import Table as Grid

    on_terminal, width = sys.stdout.isatty(), 0
    console = Console(force_terminal=on_terminal, markup=False, emoji=False, highlight=False)
    grid = Grid(box=None, pad_edge=False, padding=(0, 2, 0, 0), show_header=bool(heads))
    of_rows = zip(*map(_cells, rows), strict=True)
    told = [column for column in zip_longest(columns, heads, of_rows) if any(cell.text for cell in column[2] or ())]
    for place, (name, head, cells) in enumerate(told):
        number = name == "value" or any(isinstance(cell.value, int | float) for cell in cells)
        own = max(cell_len(text) for text in (head or "", *(cell.text for cell in cells)))
        own = own if place or number else max(own, NAME_WIDTH)
        if on_terminal and not number and place == len(told) - 1:
            own = min(own, max(NOTE_WIDTH, console.width - width - 2))
        grid.add_column(head or "", justify="right" if number else "left", width=own, overflow="fold")
        width += own + 2
    for line in zip(*(cells for _, _, cells in told), strict=True):
        grid.add_row(*(cell.text for cell in line))
    console.width = width
    with console.capture() as drawn:
        console.print(grid)
    typer.echo("\n".join([title] * bool(title) + [f"  {line}".rstrip() for line in drawn.get().splitlines()]))


def check_csv(path: Path) -> None:
    """Raise ConfigError if no CSV file can be written there; a file that is there is not touched."""
    if path.is_dir():
        raise ConfigError(f"--csv {path} is a folder; name a file, e.g. --csv {path / 'table.csv'}")
    if path.suffix.lower() not in (".csv", ".txt"):
        raise ConfigError(f"--csv {path}: a table goes into a file that ends in .csv; name one, nothing is overwritten")
    try:
        check_writable(path.parent)
        if path.exists() and not os.access(path, os.W_OK):
            raise PermissionError(errno.EACCES, "it is there and may not be changed")
    except OSError as error:
        raise ConfigError(f"cannot write --csv {path}: {error.strerror or error}; name another file") from error


def write_rows(path: Path | None, rows: Iterable[Sequence[Any]], columns: Sequence[str] = QUANTITIES) -> list[str]:
    """Write rows (see `Table`) as CSV, every digit; returns the file, nothing where there is no path.

    Raises
    ------
    ConfigError
        It cannot be written.
    """
    if path is None:
        return []
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(columns)
    writer.writerows([cell.value for cell in _cells(row)[: len(columns)]] for row in rows)
    return [str(write_atomically(path, text.getvalue(), "name another file with --csv"))]
