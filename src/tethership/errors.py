"""Errors a user can meet. Wrong input is a `ConfigError`; a computation without an answer a `SolveError`."""

import difflib
from collections.abc import Iterable


def suggestion(name: str, known: Iterable[str]) -> str:
    """Return "; did you mean 'x'?" for the nearest known name, or a full stop."""
    near = difflib.get_close_matches(name, list(known), n=1)
    return f"; did you mean {near[0]!r}?" if near else "."


class TethershipError(Exception):
    """Base of all errors that this package raises on purpose."""


class ConfigError(TethershipError):
    """Wrong input: the message says what came, what is allowed and what to do."""


class SolveError(TethershipError):
    """A computation has no answer (no equilibrium, diverged flight) and the caller asked for an exception."""


class TethershipWarning(UserWarning):
    """What a user should know of a file or result that is given all the same; the command says it in one line."""
