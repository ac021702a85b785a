"""Checksums over numbers, not over a file's bytes: whoever copies, compresses or annotates a file breaks none.

Depends on: errors, numpy, xarray. SHA-256 throughout, of which 128 bits are kept: a damaged disk is found, and so is a
number changed by hand; a forger who computes the checksum anew is not.
"""

import hashlib
import json
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from tethership.errors import ConfigError

LENGTH = 32
"""Digits of a checksum."""

CHECKSUM = "checksum"
"""Key of the checksum of a JSON document."""

CHECKSUMS = "checksums"
"""Attribute of a dataset: the checksum of each variable, and of the header under its own name."""

HEADER = "header"
"""What the checksum of a dataset's own attributes is called; no variable has this name."""

RUN = "run"
"""Attribute of a dataset, chunk of its picture and tag of its page: which run they are of."""

RUN_LENGTH = 16
"""Digits of a run's id."""


def array_digest(array: np.ndarray, dims: Iterable[str] = ()) -> str:
    """Return the checksum of an array: its numbers, shape and dimensions; every NaN counts as the same."""
    return _digest([_described(array, dims), _bytes(array)])


def table_digest(arrays: Mapping[str, np.ndarray]) -> str:
    """Return the checksum of named arrays, in any order."""
    parts: list[bytes] = []
    for name in sorted(arrays):
        parts += [_described(arrays[name], [name]), _bytes(arrays[name])]
    return _digest(parts)


def sealed(document: Mapping[str, Any]) -> dict[str, Any]:
    """Return a document, as JSON holds it, with its checksum."""
    plain = json.loads(json.dumps(document, default=str))
    plain.pop(CHECKSUM, None)
    return {**plain, CHECKSUM: _text_digest(plain)}


def is_whole(document: Mapping[str, Any]) -> bool | None:
    """Return whether a document has the checksum it was written with, None if it has none."""
    if CHECKSUM not in document:
        return None
    return document[CHECKSUM] == _text_digest({key: value for key, value in document.items() if key != CHECKSUM})


def run_id(dataset: xr.Dataset, own: Iterable[str]) -> str:
    """Return which run a dataset is of: a digest of its input and numbers, so that the same run has the same id."""
    return _run(_checksums(dataset, map(str, dataset.variables), own))


def sealed_dataset(dataset: xr.Dataset, own: Iterable[str]) -> xr.Dataset:
    """Return a dataset with checksums of all its variables and of its own attributes, and the run's id."""
    found = _checksums(dataset, map(str, dataset.variables), own)
    return dataset.assign_attrs({CHECKSUMS: json.dumps(found, sort_keys=True), RUN: _run(found)})


def check_dataset(dataset: xr.Dataset, own: Iterable[str], origin: str) -> xr.Dataset:
    """Return a dataset without its checksums; what was added to it since is left alone.

    Raises
    ------
    ConfigError
        It has no checksums, or does not agree with them.
    """
    try:
        known = dict(json.loads(dataset.attrs[CHECKSUMS]))
        said = str(dataset.attrs[RUN])
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise _damaged(origin, "no checksums can be read") from error
    names = [name for name in known if name != HEADER]
    missing = [name for name in names if name not in dataset.variables]
    if missing:
        raise _damaged(origin, f"without {', '.join(missing)}")
    found = _checksums(dataset, names, own)
    wrong = sorted(name for name in found if found[name] != known.get(name))
    if wrong or said != _run(known):
        raise _damaged(origin, f"not as written: {', '.join(wrong) or 'the checksums'}")
    rest = dataset.copy()
    rest.attrs = {key: value for key, value in dataset.attrs.items() if key not in (CHECKSUMS, RUN)}
    return rest


def _damaged(origin: str, what: str) -> ConfigError:
    """Return the error of a file that is not as it was written."""
    return ConfigError(f"{origin} is damaged or was changed ({what}); take a whole copy, or make the file again")


def _checksums(dataset: xr.Dataset, names: Iterable[str], own: Iterable[str]) -> dict[str, str]:
    """Return the checksums of variables of a dataset, units included, and of its own attributes."""
    found = {name: _variable_digest(dataset.variables[name]) for name in names}
    header = {key: str(dataset.attrs[key]) for key in sorted(own) if key in dataset.attrs}
    return {**found, HEADER: _text_digest(header)}


def _variable_digest(variable: xr.Variable) -> str:
    return array_digest(variable.values, [*map(str, variable.dims), str(variable.attrs.get("units", ""))])


def _run(checksums: Mapping[str, str]) -> str:
    return _text_digest(checksums)[:RUN_LENGTH]


def _text_digest(document: Any) -> str:
    return _digest([json.dumps(document, sort_keys=True).encode()])


def _digest(parts: Iterable[bytes | memoryview]) -> str:
    whole = hashlib.sha256()
    for part in parts:
        whole.update(part)
    return whole.hexdigest()[:LENGTH]


def _described(array: np.ndarray, dims: Iterable[str]) -> bytes:
    kind = "text" if array.dtype.kind in "OUS" else array.dtype.kind
    return json.dumps([kind, list(array.shape), list(dims)]).encode()


def _bytes(array: np.ndarray) -> bytes:
    """Return the content of an array, the same on every machine."""
    if array.dtype.kind in "OUS":
        words = [word.decode() if isinstance(word, bytes) else str(word) for word in array.ravel().tolist()]
        return json.dumps(words).encode()
    if array.dtype.kind == "f":
        array = np.where(np.isnan(array), np.nan, array).astype("<f8")
    elif array.dtype.kind in "iu":
        array = array.astype("<i8")
    return np.ascontiguousarray(array).tobytes()
