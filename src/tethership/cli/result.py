"""What a command found, and the one way in which it is told. Depends on: cli.common, cli.tables, typer."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import typer

from tethership.cli.common import NO_ANSWER, json_text
from tethership.cli.tables import Table, print_table, write_rows


@dataclass(frozen=True)
class Result:
    """What a command found.

    Attributes
    ----------
    document : dict
        For scripts: what `--json` prints, SI unless its keys say otherwise.
    title : str
        First line for people.
    tables : sequence of Table
        For people; those with the columns of the first are also what `--csv` writes.
    data : Table, optional
        What `--csv` writes where that is not what people are shown.
    lines : sequence of str
        Said after the tables.
    files : sequence of str, optional
        Written files, told as `files` in the document too; None where the document does not name them.
    warnings : sequence of str
        What must be known before the result is used; the document has them under a key of its own.
    answered : bool
        Where not, the command ends with `NO_ANSWER`, else with 0.
    reason : str
        Why there is no answer, one line; said only where there is none.
    """

    document: dict[str, Any]
    title: str = ""
    tables: Sequence[Table] = ()
    data: Table | None = None
    lines: Sequence[str] = ()
    files: Sequence[str] | None = None
    warnings: Sequence[str] = ()
    answered: bool = True
    reason: str = ""


def show(result: Result, as_json: bool, csv: Path | None = None) -> None:
    """Tell a result as one JSON object or for people, write its table, and exit where there is no answer.

    Raises
    ------
    ConfigError
        The table cannot be written.
    """
    written = _write_csv(csv, result)
    files = None if result.files is None else [*result.files, *written]
    if as_json:
        typer.echo(json_text(result.document if files is None else result.document | {"files": files}))
    else:
        if result.title:
            typer.echo(result.title)
        for table in result.tables:
            print_table(*table)
        for line in (*result.lines, *(f"wrote {file}" for file in files or ())):
            typer.echo(line)
        for line in result.warnings:
            typer.echo(f"tethership: warning: {line}", err=True)
    if not result.answered:
        if result.reason:
            typer.echo(f"tethership: {result.reason}", err=True)
        raise typer.Exit(NO_ANSWER)


def _write_csv(path: Path | None, result: Result) -> list[str]:
    """Write the numbers of a result as CSV; returns the file, nothing where there is no path."""
    if path is None:
        return []
    tables = result.tables if result.data is None else [result.data]
    columns = tables[0].columns
    return write_rows(path, [row for table in tables if table.columns == columns for row in table.rows], columns)
