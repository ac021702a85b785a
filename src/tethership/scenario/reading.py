"""Reading what a user wrote: files and typed values, hostile until checked. Depends on: errors.

Whatever comes out is a document that is safe to walk, to copy and to show: no number too large, nothing nested deeply.
"""

import json
import stat
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tethership.errors import ConfigError, shown

MOST_BYTES = 10_000_000
"""Size of a file that is read [bytes]."""

MOST_NESTED = 20
"""Lists and tables inside each other."""

LARGEST_WHOLE = 2**63 - 1
"""Of TOML's whole numbers."""


def check_path(path: str | Path) -> None:
    """Raise ConfigError where a path cannot be the name of a file: NUL, letters that are not UTF-8, too long a name."""
    text = str(path)
    try:
        longest = max((len(part.encode()) for part in Path(text).parts), default=0)
    except UnicodeEncodeError:
        raise ConfigError(f"the name {shown(text)} is not UTF-8; rename the file or folder") from None
    if "\0" in text or longest > 255:
        what = (
            "has a NUL (null character)" if "\0" in text else f"has a part of {longest} bytes, too long (at most 255)"
        )
        raise ConfigError(f"the name {shown(text)} {what}; choose another name")


def check_file_to_read(path: Path, most_bytes: int = MOST_BYTES, what: str = "") -> None:
    """Raise ConfigError where a file (of `what`) is not there, not regular (a pipe never ends) or too large.

    Too large is one of more than `most_bytes` [bytes].
    """
    named = f"{what} of {path}" if what else f"{path}"
    check_path(path)
    try:
        found = path.stat()
    except OSError as error:
        raise ConfigError(f"cannot read {named}: {error.strerror or error}") from error
    if not stat.S_ISREG(found.st_mode):
        raise ConfigError(f"cannot read {named}: it is no regular file; name a file")
    if found.st_size > most_bytes:
        size, most = (f"{count / 1e6:.0f} MB" for count in (found.st_size, most_bytes))
        raise ConfigError(f"cannot read {named}: it has {size}; at most {most} are read")


def read_text(path: Path) -> str:
    """Return the text of a UTF-8 file, with or without a byte order mark.

    Raises
    ------
    ConfigError
        As `check_file_to_read`, or it is no text.
    """
    check_file_to_read(path)
    try:
        return path.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError as error:
        raise ConfigError(f"cannot read {path}: it is not a text file in UTF-8") from error
    except OSError as error:
        raise ConfigError(f"cannot read {path}: {error.strerror or error}") from error


def parse_toml(text: str, origin: str) -> dict[str, Any]:
    """Return a TOML text as a checked document; raises ConfigError where it is none."""
    document = _parsed(tomllib.loads, text, f"{origin} is not TOML")
    check_plain(document, origin)
    return document


def parse_json(text: str, origin: str) -> Any:
    """Return a JSON text as a checked value, the text itself where it is none; raises ConfigError as `check_plain`."""
    try:
        value = _parsed(json.loads, text, origin)
    except json.JSONDecodeError:
        return text
    check_plain(value, origin)
    return value


def _parsed(parse: Callable[[str], Any], text: str, complaint: str) -> Any:
    """Return what a parser makes of a text; a JSONDecodeError passes."""
    try:
        return parse(text)
    except json.JSONDecodeError:
        raise
    except RecursionError as error:
        raise ConfigError(f"{complaint}: brackets are nested too deeply (at most {MOST_NESTED})") from error
    except tomllib.TOMLDecodeError as error:
        raise ConfigError(f"{complaint}: {error}") from error
    except ValueError as error:
        raise ConfigError(f"{complaint}: a whole number has thousands of digits; write it as 1e9") from error


def check_plain(value: Any, origin: str) -> None:
    """Raise ConfigError where a value is nested too deeply or holds a whole number beyond 64 bits."""
    level = [value]
    for _ in range(MOST_NESTED):
        for item in level:
            if isinstance(item, int) and abs(item) > LARGEST_WHOLE:
                raise ConfigError(f"{origin}: a whole number is too large (beyond 2^63); write it as 1e9")
        level = [item for held in level if isinstance(held, dict | list | tuple) for item in _items(held)]
        if not level:
            return
    raise ConfigError(f"{origin}: lists or tables are nested more than {MOST_NESTED} deep")


def _items(held: Any) -> Any:
    """Return what a table or list holds."""
    return held.values() if isinstance(held, dict) else held
