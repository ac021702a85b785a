"""Equilibria: the problem, its solution and what is to be known of it."""

from tethership.analysis.trim.outcome import TrimOutcome
from tethership.analysis.trim.trim import TrimPoint, trim

__all__ = ["TrimOutcome", "TrimPoint", "trim"]
