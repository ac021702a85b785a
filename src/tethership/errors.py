"""Errors a user can meet. Wrong input is a `ConfigError`; a computation without an answer a `SolveError`."""


class TethershipError(Exception):
    """Base of all errors that this package raises on purpose."""


class ConfigError(TethershipError):
    """Wrong input: the message says what came, what is allowed and what to do."""


class SolveError(TethershipError):
    """A computation has no answer (no equilibrium, diverged flight) and the caller asked for an exception."""
