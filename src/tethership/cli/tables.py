"""Tables of the command line: printed for people, written as CSV in full precision. Depends on: typer."""

import csv
import errno
import io
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple

import typer

from tethership.errors import ConfigError
from tethership.results.files import check_writable, write_atomically

CsvOption = Annotated[
    Path | None, typer.Option("--csv", metavar="FILE", help="Also write the table as CSV, every digit of it.")
]

QUANTITIES = ("quantity", "value", "unit")
"""Columns of a table of rows."""


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


def print_table(rows: Sequence[Row], title: str) -> None:
    """Print a title and rows of quantity, value and unit on standard output."""
    width = max(len(row.name) for row in rows)
    typer.echo(title)
    for row in rows:
        typer.echo(f"  {row.name:<{width}}  {format(row.value, row.spec):>12}  {row.unit}{row.note}".rstrip())


def writable_csv(path: Path | None) -> Path | None:
    """Return the path if a CSV file can be written there; raises ConfigError before any work if not.

    Nothing is made yet, and a file that is there is not touched.
    """
    if path is None:
        return None
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
    return path


def write_rows(path: Path | None, rows: Iterable[Row]) -> list[str]:
    """Write rows of quantity, value and unit as CSV; returns the file, nothing where there is no path."""
    return write_csv(path, QUANTITIES, ([row.name, row.value, row.unit] for row in rows))


def write_csv(path: Path | None, heads: Sequence[str], rows: Iterable[Sequence[Any]]) -> list[str]:
    """Write a table as CSV; returns the file, nothing where there is no path.

    Raises
    ------
    ConfigError
        It cannot be written.
    """
    if path is None:
        return []
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(heads)
    writer.writerows(rows)
    return [str(write_atomically(path, text.getvalue(), "name another file with --csv"))]
