"""Rotations, wrenches and constants: the ground that everything else stands on."""

from tethership.spatial.constants import SEA_LEVEL_DENSITY, STANDARD_GRAVITY
from tethership.spatial.linear import solve_symmetric
from tethership.spatial.rotations import (
    body_rates,
    euler_rate_matrix,
    euler_rates,
    horizontal_unit,
    rotation_matrix,
    safe_norm,
    skew,
)
from tethership.spatial.wrench import Wrench

__all__ = [
    "SEA_LEVEL_DENSITY",
    "STANDARD_GRAVITY",
    "Wrench",
    "body_rates",
    "euler_rate_matrix",
    "euler_rates",
    "horizontal_unit",
    "rotation_matrix",
    "safe_norm",
    "skew",
    "solve_symmetric",
]
