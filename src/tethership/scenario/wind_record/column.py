"""One column of a measured wind's file, and how large a file may be. Depends on: errors."""

import stat
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tethership.errors import ConfigError

LARGEST_FILE = 32_000_000
"""Bytes that are read of a file."""

MOST_VALUES = 4_000_000
"""Numbers that are read of one netCDF variable: what it declares can be far beyond what its file holds."""

MOST_LINES, LONGEST_LINE = 1_000_000, 10_000
"""Lines of a text, and characters of one, that are read."""

MOST_SAMPLES = 200_000
"""Samples of a record: 5.5 hours at 10 Hz."""

WANTED = "time with north, east (and down or up) in m/s, or time with speed in m/s and direction in deg"
"""What a file must have."""


class Column(NamedTuple):
    """A column of a table, or a netCDF variable over time.

    Attributes
    ----------
    name : str
        As the file has it.
    values : np.ndarray
        Numbers, or texts where the file has texts, shape (n,); shape (1,) for one that holds for all samples.
    unit : str
        As the file has it, "" where it has none.
    meaning : str
        CF standard name, "" where there is none.
    height : float, optional
        Of the measurement [m].
    """

    name: str
    values: np.ndarray
    unit: str = ""
    meaning: str = ""
    height: float | None = None


def check_file(path: Path) -> None:
    """Raise ConfigError unless a path is a regular file of a size that is read; nothing is opened."""
    try:
        found = path.stat()
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        reason = (error.strerror if isinstance(error, OSError) else None) or str(error)
        raise ConfigError(f"cannot read the wind of {str(path)!r}: {reason}") from error
    if not stat.S_ISREG(found.st_mode):
        raise ConfigError(f"cannot read the wind of {path}: it is no regular file")
    if found.st_size > LARGEST_FILE:
        raise ConfigError(
            f"cannot read the wind of {path}: it has {found.st_size / 1e6:.0f} MB, at most {LARGEST_FILE / 1e6:.0f} MB "
            "are read; cut out the time to be flown"
        )
