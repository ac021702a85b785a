"""How a trim ended: one rule for a single point and for the thousands of a sweep. Depends on: plant.balance."""

import enum
from typing import NamedTuple

import numpy as np

from tethership.plant import DRIFT_LIMIT

UNDER_GROUND = 1e-3
"""How far below the ground counts as below it [m]: less is the rounding of a search."""


class TrimOutcome(enum.Enum):
    """How a trim ended; the value is a sentence with the cure where one is needed."""

    converged = "In equilibrium."
    saturated = (
        "In equilibrium only beyond the limits of the named thrusters or fins; the residual is what is left over "
        "within them."
    )
    no_equilibrium = (
        "No equilibrium with these unknowns; the residual is what is left. "
        "Free more quantities (trim.unknowns) or start the search elsewhere (trim.position)."
    )
    hull_below_ground = (
        "The loads balance only with the hull below the ground: less wind, more free lift or another place."
    )
    cable_below_ground = (
        "The cable is longer than the lift can hold up: it would hang below the ground. Shorten it, or more free lift."
    )

    @property
    def is_balanced(self) -> bool:
        """Whether loads and motion balance with the commands found, be they within their limits or not."""
        return self is not TrimOutcome.no_equilibrium

    @property
    def is_start(self) -> bool:
        """Whether a ship can be flown from there: in equilibrium above ground, if only beyond a thruster's limit."""
        return self in (TrimOutcome.converged, TrimOutcome.saturated)


class Points(NamedTuple):
    """What is judged of many points, the points first.

    Attributes
    ----------
    residual : ndarray
        Force and moment left over with the commands found [N, N m], shape (points, 6).
    drift : ndarray
        Rates of what must stand still [rad/s, m/s], shape (points, motions).
    hull, cables : ndarray
        Height of the lowest point of the hull, and of each cable, above the ground [m], shapes (points,) and
        (points, cables).
    """

    residual: np.ndarray
    drift: np.ndarray
    hull: np.ndarray
    cables: np.ndarray


def outcomes(
    found: Points, over: np.ndarray, limit: np.ndarray, grounded: bool, height_sought: bool
) -> list[TrimOutcome]:
    """Return how each of many points ended; arrays have the points first.

    Parameters
    ----------
    found : Points
        Residuals, rates and clearances.
    over : ndarray of bool
        Whether a command is beyond its limits, shape (points,).
    limit : ndarray
        Largest residual of an equilibrium [N, N m], shape (points,).
    grounded : bool
        Whether it is known where the ground is.
    height_sought : bool
        Whether the ship's height was looked for. A cable below the ground is then an answer of its own: its pull could
        not be held up. Where the height is held, by thrust or by hand, it is only told.
    """
    left = np.abs(found.residual).max(axis=1)
    moving = np.abs(found.drift).max(axis=1)
    balanced = (left <= limit) & (moving <= DRIFT_LIMIT)
    hull = grounded & (found.hull < -UNDER_GROUND)
    cable = grounded & height_sought & (found.cables.min(axis=1, initial=0.0) < -UNDER_GROUND)
    ends = (
        (~balanced, TrimOutcome.no_equilibrium),
        (hull, TrimOutcome.hull_below_ground),
        (cable, TrimOutcome.cable_below_ground),
        (over, TrimOutcome.saturated),
        (np.ones_like(balanced), TrimOutcome.converged),
    )
    return [next(outcome for flags, outcome in ends if flags[point]) for point in range(len(balanced))]
