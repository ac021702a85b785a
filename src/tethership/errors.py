"""Errors a user can meet. Wrong input is a `ConfigError`; a computation without an answer a `SolveError`.

What a user gave is echoed cut to a length: `shown` for one value, and every message as a whole.
"""

import difflib
from collections.abc import Iterable
from typing import Any

MOST_LETTERS = 120
"""Letters of one echoed value."""

MOST_OF_MESSAGE = 4000
"""Letters of a message; lists of what is allowed fit."""


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return "; did you mean 'x'?" for the nearest known name, or a full stop."""
    near = difflib.get_close_matches(name, list(known), n=1) if len(name) <= MOST_LETTERS else []
    return f"; did you mean {near[0]!r}?" if near else "."


def shown(value: Any) -> str:
    """Return a value as messages echo it: as Python writes it, cut to `MOST_LETTERS`."""
    try:
        text = repr(value[: 2 * MOST_LETTERS] if isinstance(value, str | bytes | list | tuple) else value)
    except (ValueError, RecursionError):  # whole numbers of thousands of digits, brackets in brackets
        return f"a {type(value).__name__} that is too large to be shown"
    return f"{text[:MOST_LETTERS]} … (cut)" if len(text) > MOST_LETTERS else text


def one_line(message: str) -> str:
    """Return a message as one line of letters that a terminal shows, its middle left out where it is very long."""
    half = MOST_OF_MESSAGE // 2
    whole = message if len(message) <= MOST_OF_MESSAGE else f"{message[:half]} … (cut) … {message[-half:]}"
    return "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in " ".join(whole.split()))


def failure(error: Exception) -> str:
    """Return in one line what code of one's own did, with the cure where the mistake is a common one."""
    said = str(error).strip().splitlines() or ["no more is known"]
    what = f"{type(error).__name__}: {said[0]}"
    if "TracerBool" in what or "ConcretizationTypeError" in what:
        return f"{what} – choose with jnp.where in place of `if`: its numbers are known only in flight"
    return what


class TethershipError(Exception):
    """Base of all errors that this package raises on purpose; its message is one line."""

    def __init__(self, message: str = "") -> None:
        super().__init__(one_line(message))


class ConfigError(TethershipError):
    """Wrong input: the message says what came, what is allowed and what to do."""


class SolveError(TethershipError):
    """A computation has no answer (no equilibrium, diverged flight) and the caller asked for an exception."""


class TethershipWarning(UserWarning):
    """Input that can be computed with, but hardly means what it says; the command prints it as one line."""
