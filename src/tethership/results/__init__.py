"""Names, units and files of outputs; metrics on arrays."""

from tethership.results.metrics import docking_metrics
from tethership.results.schema import VARIABLES, Variable

__all__ = ["VARIABLES", "Variable", "docking_metrics"]
