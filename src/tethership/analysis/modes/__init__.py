"""Modes: eigenvalues by name."""

from tethership.analysis.modes.modes import Mode, Modes

__all__ = ["Mode", "Modes"]
