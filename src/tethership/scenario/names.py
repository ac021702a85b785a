"""What the parts, laws and files of a user may be called. Depends on: plant.names, errors.

A name becomes part of a dotted name (`cables.nose.length`), of a file (`rewind_17.nc`) or of a label.
"""

import unicodedata
from collections.abc import Iterable
from typing import Annotated

from pydantic import AfterValidator

from tethership.errors import shown
from tethership.plant import taken

LONGEST = 60
"""Letters of a name."""


def check_word(name: str) -> str:
    """Return a name if it is a letter, of any script, then letters, digits, `_` or `-`, or raise ValueError."""
    return _checked(name, "L", "_-", "a letter, then letters, digits, _ or -")


def check_title(name: str) -> str:
    """Return a name of a file or law, which is no step of a dotted name: a digit may begin, blanks and dots be inside.

    Raises ValueError where it is none.
    """
    return _checked(name, "LN", "_- .", "a letter or digit, then letters, digits, _, -, and inside . or blanks")


def _checked(name: str, first: str, signs: str, allowed: str) -> str:
    """Return a name whose letters are allowed, or raise ValueError."""
    ends = bool(name) and _is(name[0], first) and _is(name[-1], "LMN", "_-")
    if not ends or len(name) > LONGEST or not all(_is(letter, "LMN", signs) for letter in name):
        raise ValueError(f"the name {shown(name)} is no plain word; give {allowed} (at most {LONGEST} of them)")
    return name


def check_part(name: str) -> str:
    """Return the name of a thruster or fin, or raise ValueError where it means something else already."""
    if taken(check_word(name)):
        raise ValueError(
            f"the name {shown(name)} is that of a state, of an unknown of the trim or of an input of the linear model; "
            f"choose another, e.g. {shown('my_' + name)}"
        )
    return name


def check_apart(names: Iterable[str], what: str) -> None:
    """Raise ValueError where two names are the same, capitals or not: so are they as names of files."""
    seen: set[str] = set()
    for name in names:
        key = unicodedata.normalize("NFKC", name).casefold()
        if key in seen:
            raise ValueError(f"two {what} are named {name!r}; every name must be its own, not in capitals alone")
        seen.add(key)


def _is(letter: str, kinds: str, signs: str = "") -> bool:
    """Return whether a letter is one of some signs, or of some kinds: L letters, M their marks, N numbers."""
    return letter in signs or unicodedata.category(letter)[0] in kinds


Word = Annotated[str, AfterValidator(check_word)]
"""Name of a cable."""

Part = Annotated[str, AfterValidator(check_part)]
"""Name of a thruster or fin."""

Title = Annotated[str, AfterValidator(check_title)]
"""Name of a law."""
