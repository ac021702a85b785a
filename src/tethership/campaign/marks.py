"""Marks of finished batches: one file each, with a checksum of the batch's numbers. Depends on: results, numpy.

A mark is written when a batch's numbers are. What the store gives for the batch later is held against it: a chunk that
is lost or changed is then no result, but a batch that is flown again.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tethership.results import is_whole, sealed, table_digest, write_atomically

MARKS = "finished"


class Form(NamedTuple):
    """What one output of one flight is.

    Attributes
    ----------
    dtype : str
        As numpy writes it, e.g. <f8.
    shape : tuple of int
        Of one flight's value.
    """

    dtype: str
    shape: tuple[int, ...]

    @classmethod
    def of(cls, values: np.ndarray) -> "Form":
        """Return the form of a batch's values, the flight first."""
        return cls(values.dtype.newbyteorder("<").str, values.shape[1:])


class Mark(NamedTuple):
    """What is known of a finished batch.

    Attributes
    ----------
    campaign : str
        Digest of the campaign.
    values : str
        Checksum of the batch's numbers.
    forms : dict
        Form of each output.
    """

    campaign: str
    values: str
    forms: dict[str, Form]


def write_mark(folder: Path, number: int, campaign: str, found: Mapping[str, np.ndarray], cure: str) -> None:
    """Mark a batch of a campaign's folder as finished with these numbers."""
    mark = {
        "campaign": campaign,
        "values": table_digest(found),
        "forms": {name: Form.of(values) for name, values in found.items()},
    }
    write_atomically(folder / MARKS / f"{number:06d}", json.dumps(sealed(mark)), cure)


def read_marks(folder: Path, batches: int) -> dict[int, Mark | None]:
    """Return the mark of each batch that ended; None where it is empty (version 0.1) or not as it was written."""
    paths = (folder / MARKS).glob("[0-9]*") if (folder / MARKS).is_dir() else ()
    numbered = {int(path.name): path for path in paths if path.name.isdecimal()}
    return {number: _read(path) for number, path in sorted(numbered.items()) if number < batches}


def _read(path: Path) -> Mark | None:
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        if not is_whole(document):
            return None
        forms = {name: Form(dtype, tuple(shape)) for name, (dtype, shape) in document["forms"].items()}
        return Mark(document["campaign"], document["values"], forms)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None
