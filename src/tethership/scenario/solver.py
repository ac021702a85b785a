"""What a solver file may say. Depends on: scenario.quantity."""

from typing import Annotated, Literal

from pydantic import Field

from tethership.scenario.quantity import Quantity, Table


class SolverConfig(Table):
    """How a flight is integrated.

    Attributes
    ----------
    method : str
        diffrax solver.
    step : str
        `adaptive` or `fixed`.
    relative_tolerance, absolute_tolerance : float
        Of the adaptive step [-, SI units of each state].
    largest_step : float
        Longest adaptive step, or the fixed one [s].
    smallest_step : float
        Adaptive steps this short are taken whatever their error [s]: a command that jumps (χ when the tether point
        passes over the anchor) is stepped over instead of resolved.
    output_interval : float
        Time between saved samples [s].
    most_steps : int
        Budget of steps for one flight; beyond it the outcome is `step_limit`.
    """

    description: str = ""
    method: Literal["tsit5", "dopri5", "dopri8", "kvaerno5"] = "tsit5"
    step: Literal["adaptive", "fixed"] = "adaptive"
    relative_tolerance: float = Field(1e-6, gt=0, le=1e-2)
    absolute_tolerance: float = Field(1e-6, gt=0, le=1e-2)
    largest_step: Annotated[float, Quantity("s", positive=True)] = 0.25
    smallest_step: Annotated[float, Quantity("s", positive=True)] = 1e-3
    output_interval: Annotated[float, Quantity("s", positive=True)] = 0.0125
    most_steps: int = Field(400_000, gt=0)
