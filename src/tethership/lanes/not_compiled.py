"""Why a function is not compiled over lanes. Depends on: errors."""

from tethership.errors import TethershipError


class NotCompiled(TethershipError):
    """A function cannot be compiled over lanes here; the message says why. XLA can compute it instead."""
