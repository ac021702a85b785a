"""Linear models: exact derivatives of the motion about a point."""

from tethership.analysis.linear.linearize import linearize
from tethership.analysis.linear.model import LinearModel
from tethership.analysis.linear.semi_analytic import SemiAnalytic, semi_analytic

__all__ = ["LinearModel", "SemiAnalytic", "linearize", "semi_analytic"]
