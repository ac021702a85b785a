"""Root loci and sensitivities: how trim and modes move with the numbers of a scenario."""

from tethership.analysis.loci.sensitivity import Sensitivities, Sensitivity, sensitivities
from tethership.analysis.loci.sweep import Happening, Sweep, sweep

__all__ = ["Happening", "Sensitivities", "Sensitivity", "Sweep", "sensitivities", "sweep"]
