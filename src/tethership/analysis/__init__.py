"""Trim, the linear model, its modes, root loci and sensitivities."""

from tethership.analysis.linear.linearize import linearize
from tethership.analysis.linear.model import LinearModel
from tethership.analysis.linear.semi_analytic import SemiAnalytic, semi_analytic
from tethership.analysis.loci.sensitivity import Sensitivities, Sensitivity, sensitivities
from tethership.analysis.loci.sweep import Happening, Sweep, sweep
from tethership.analysis.modes.modes import Mode, Modes
from tethership.analysis.trim.trim import TrimOutcome, TrimPoint, trim

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
