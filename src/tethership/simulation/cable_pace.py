"""The pace of a cable's tension against the cable's own motion: limits and the one formula. Depends on nothing.

What they are and what they were held against is told in `simulation.quasi_static`, which reads them off a flight; a
batch (`simulation.tally`) sums the same up while it flies.
"""

import math
from typing import Any

TRUSTED = 0.3
"""Largest pace κ at which the quasi-static tension may be trusted [-]."""

MEMORY = 3.0
"""Time for which a hurried cable swings on [s]: air damps it at ½ ρ D C_dc |v|/m, 0.5 1/s in 6 m/s."""

SLACK = 0.99
"""Elongation below which a cable was slack before a snap [-]."""

LEAST_TENSION = 5.0
"""Tension below which a change counts as if it were of this [N]: a slack cable's newtons move nothing."""

LEAST_MASS = 1e-6
"""Linear density that takes the place of none [kg/m]."""


def first_mode(tension: Any, length: Any, linear_density: Any) -> Any:
    """Return ω₁ = (π/L)√(T/m) [1/s], the first transverse mode of a taut string.

    Parameters
    ----------
    tension, length, linear_density : array or float
        T above zero [N], L [m], m above zero [kg/m]; of NumPy or JAX.
    """
    return math.pi / length * (tension / linear_density) ** 0.5
