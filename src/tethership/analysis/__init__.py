"""Trim (and, later, the linear model, its modes and sweeps)."""

from tethership.analysis.trim import TrimOutcome, TrimPoint, trim

__all__ = ["TrimOutcome", "TrimPoint", "trim"]
