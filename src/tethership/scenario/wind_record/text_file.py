"""Columns of a text file: CSV with comma, semicolon or tab, or a Campbell logger's TOA5. Depends on: errors."""

import csv
import re
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from tethership.errors import ConfigError
from tethership.scenario.wind_record.column import LONGEST_LINE, MOST_LINES, WANTED, Column
from tethership.scenario.wind_record.names import is_unit

IN_BRACKETS = re.compile(r"^(?P<before>[^\[(]*)[\[(](?P<unit>[^\])]*)[\])](?P<after>.*)$")
"""A head that bears its unit: `speed [kn]`, `Horizontal Wind Speed (m/s) at 40m`."""


def read_text(path: Path) -> list[Column]:
    """Return the columns of a text file, as texts.

    Raises
    ------
    ConfigError
        It is no text, has no head or no sample, or a row is longer or shorter than the head.
    """
    lines = _lines(path)
    separator = max(",;\t", key=lines[0].count) if lines else ","  # what the first line has most of
    try:
        rows = list(csv.reader(lines, delimiter=separator, skipinitialspace=True))
    except csv.Error as error:
        raise ConfigError(f"cannot read the wind of {path}: {error}") from error
    heads, units, samples = _parts(rows)
    if not samples:
        raise ConfigError(f"{path} has {'a head' if heads else 'nothing'} and no sample; wanted: {WANTED}")
    for number, row in enumerate(samples, 1):
        if len(row) != len(heads):
            raise ConfigError(f"{path}: sample {number} has {len(row)} cells, the head {len(heads)}; mend that line")
    columns = zip(*samples, strict=True)
    return [_column(head, unit, texts) for head, unit, texts in zip(heads, units, columns, strict=True)]


def _lines(path: Path) -> list[str]:
    """Return the lines that hold something, without comments: UTF-8, or Latin-1 (a degree sign of old software)."""
    content = path.read_bytes()
    if b"\0" in content:
        raise ConfigError(f"cannot read the wind of {path}: it is not a text file")
    try:
        lines = content.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        lines = content.decode("latin-1").splitlines()
    longest = max(map(len, lines), default=0)
    for found, most, what in ((len(lines), MOST_LINES, "lines"), (longest, LONGEST_LINE, "characters")):
        if found > most:
            has = f"{found} lines" if what == "lines" else f"a line of {found} characters"
            raise ConfigError(f"{path} has {has}, at most {most} are read; cut out the time to be flown")
    return [cut for line in lines if (cut := line.partition("#")[0]).strip()]


def _parts(rows: list[list[str]]) -> tuple[list[str], list[str], list[list[str]]]:
    """Return heads, units (a row of their own, where there is one) and samples."""
    if rows and rows[0][0] == "TOA5":
        heads, units, samples = (*rows[1:3], rows[4:]) if len(rows) > 2 else ([], [], [])
    elif len(rows) > 1 and any(map(is_unit, rows[1])) and not any(map(_is_datum, rows[1])):
        heads, units, samples = rows[0], rows[1], rows[2:]
    else:
        heads, units, samples = rows[0] if rows else [], [], rows[1:]
    return heads, (units + [""] * len(heads))[: len(heads)], samples


def _is_datum(cell: str) -> bool:
    """Return whether a cell is a number or a time stamp."""
    if cell.strip()[:1].isdigit():
        return True
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _column(head: str, unit: str, texts: Sequence[str]) -> Column:
    """Return a column, its unit from its head where it stands there."""
    found = IN_BRACKETS.match(head)
    values = np.array(texts, dtype=object)
    if found is None:
        return Column(head.strip(), values, unit.strip())
    return Column(f"{found['before'].strip()} {found['after'].strip()}".strip(), values, found["unit"].strip())
