"""One column of a measured wind's file, and how large a file may be. Depends on: errors."""

from typing import NamedTuple

import numpy as np

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
