"""Trim, the linear model, its modes, root loci and sensitivities."""

from tethership.analysis.linear_model import LinearModel
from tethership.analysis.linearize import linearize
from tethership.analysis.modes import Mode, Modes
from tethership.analysis.semi_analytic import SemiAnalytic, semi_analytic
from tethership.analysis.sensitivity import Sensitivities, Sensitivity, sensitivities
from tethership.analysis.sweep import Happening, Sweep, sweep
from tethership.analysis.trim import TrimOutcome, TrimPoint, trim

__all__ = [
    "Happening",
    "LinearModel",
    "Mode",
    "Modes",
    "SemiAnalytic",
    "Sensitivities",
    "Sensitivity",
    "Sweep",
    "TrimOutcome",
    "TrimPoint",
    "linearize",
    "semi_analytic",
    "sensitivities",
    "sweep",
    "trim",
]
