"""What must be known of the trims of a sweep before they are used. Depends on: analysis.loci.sweep, results.limits."""

import numpy as np

from tethership.analysis.loci.sweep import Sweep
from tethership.analysis.trim.outcome import UNDER_GROUND
from tethership.results import HARMFUL


def sweep_warnings(found: Sweep) -> list[str]:
    """Return limits passed and cables below the ground among the points in trim, a sentence for each kind.

    Each says how many points, and the worst: its tension over the limit [-], or how far a cable is below the ground
    [m].
    """
    points, count = np.flatnonzero(found.trimmed), len(found.outcomes)
    passed = {int(point): found.limits_passed(int(point)) for point in points}
    warnings = []
    for name in HARMFUL:
        over = {point: of[name] for point, of in passed.items() if name in of}
        if over:
            worst = max(over, key=lambda point: over[point])
            warnings.append(
                f"{len(over)} of {count} points pass {name}, by {over[worst]:.3g} times at {_at(found, worst)}"
            )
    dips = -found.clearance_cable[points]
    if (dips > UNDER_GROUND).any():
        worst = int(points[np.nanargmax(dips)])
        warnings.append(
            f"in {int((dips > UNDER_GROUND).sum())} of {count} points a cable dips below the ground, by "
            f"{np.nanmax(dips):.2f} m at {_at(found, worst)}; contact with the ground is not modelled"
        )
    return warnings


def _at(found: Sweep, point: int) -> str:
    """Return where a point is, in words."""
    return ", ".join(f"{name} = {values[point]:.4g}" for name, values in found.values.items())
