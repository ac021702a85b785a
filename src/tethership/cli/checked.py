"""What every argument and option of every command must be, whatever it means. Depends on: scenario.reading."""

import contextlib
import functools
import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tethership.errors import ConfigError, shown
from tethership.scenario import LARGEST_WHOLE, check_path


def checked(command: Callable[..., None]) -> Callable[..., None]:
    """Return a command whose numbers are finite, whose texts are UTF-8 and whose paths can be paths.

    Where it fails, folders and files that were not there before and are empty go again.
    """

    @functools.wraps(command)
    def run(**given: Any) -> None:
        for name, value in given.items():
            _check(value, name.strip("_"))
        paths = [path for value in given.values() if isinstance(value, Path) for path in (value, *value.parents)]
        absent = [path for path in paths if not os.path.lexists(path)]
        try:
            command(**given)
        except BaseException:
            for path in absent:
                _remove_empty(path)
            raise

    return run


def _remove_empty(place: Path) -> None:
    """Remove an empty folder or file; whatever else it is stays."""
    with contextlib.suppress(OSError):
        if place.is_dir():
            place.rmdir()
        elif place.stat().st_size == 0:
            place.unlink()


def _check(value: Any, label: str) -> None:
    """Raise ConfigError where a value, or one in it, cannot be meant."""
    match value:
        case list() | tuple():
            for item in value:
                _check(item, label)
        case float() if not math.isfinite(value):
            raise ConfigError(f"{label}: {value} is not a finite number; give one")
        case int() if abs(value) > LARGEST_WHOLE:
            raise ConfigError(f"{label}: the number is too large (beyond 2^63); give a smaller one")
        case Path():
            check_path(value)
        case str() if not value.isascii():
            _check_utf8(value, label)


def _check_utf8(text: str, label: str) -> None:
    """Raise ConfigError where a text holds bytes that are no letters."""
    try:
        text.encode()
    except UnicodeEncodeError:
        raise ConfigError(f"{label}: {shown(text)} is not UTF-8; type it again, or rename the file") from None
