"""One cable of a scenario between two points: what is computed of it. Depends on: plant, scenario.

Apart from its command (`tension`), which is told of without what computes.
"""

from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np

from tethership.errors import SolveError
from tethership.plant import cable_along, cable_between
from tethership.results import REGIMES, ratios_passed
from tethership.scenario import Scenario

FINE = 513
"""Points of the curve from which the sag is read off: 1e-5 of it for a parabola."""


class Line(NamedTuple):
    """One cable of a scenario with its ends put somewhere; positions in ground axes [m], length unstretched [m]."""

    scenario: Scenario
    place: int
    end: np.ndarray
    anchor: np.ndarray
    length: float
    moved: bool

    @property
    def ground(self) -> float:
        """Down coordinate of the ground [m]: the scenario's, or the level of an anchor that was put elsewhere."""
        given = self.scenario.config.ground.anchor_height is not None
        return float(self.anchor[2] if self.moved and not given else self.scenario.system.environment.ground)

    def limits_passed(self, tension: float, largest: float) -> dict[str, float]:
        """Return tension over limit [-] of every watched limit that is passed; a cable breaks at its own force."""
        limits = self.scenario.config.watched_limits()
        limits["cable_break"] = self.scenario.config.cables[self.place].breaking_force
        return ratios_passed(limits, dict.fromkeys(limits, tension) | {"cable_break": largest})

    def warnings(self, passed: dict[str, float], largest: float, clearance: float) -> list[str]:
        """Return what must be known of the result before it is used."""
        name, said = self.scenario.config.cables[self.place].name, []
        if "cable_break" in passed:
            said.append(
                f"the cable {name} would break: {largest:.4g} N are {passed['cable_break']:.3g} times its breaking "
                "force"
            )
        if clearance < -1e-3:
            said.append(
                f"the cable {name} hangs {-clearance:.2f} m below the ground, on which it would lie; contact is not "
                "modelled"
            )
        return said


def check_finite(line: Line, tension: float) -> None:
    """Raise SolveError where the tension [N] between two ends is not finite."""
    if not np.isfinite(tension):
        apart = float(np.linalg.norm(line.end - line.anchor))
        raise SolveError(
            f"the tension between these ends is not finite: {line.length:g} m of cable over {apart:.3g} m are beyond "
            "what can be computed; check --end, --anchor and --length"
        )


def computed(
    line: Line,
    velocity: np.ndarray,
    wind_vector: tuple[float, float, float] | None,
    points: int | None,
) -> dict[str, Any]:
    """Return forces, shape, and what must be known of them; positions and vectors in ground axes, SI, angles in deg."""
    scenario = line.scenario
    cable, environment = scenario.system.cables[line.place], scenario.system.environment
    given = None if wind_vector is None else jnp.array(wind_vector)
    ends = jnp.asarray(line.end), jnp.asarray(line.anchor)
    found = cable_between(cable, environment, *ends, jnp.asarray(line.length), jnp.asarray(velocity), given)
    fine, _ = cable_along(cable, found, *ends, jnp.linspace(0.0, line.length, FINE))
    tension, largest = (float(np.linalg.norm(found.ship)), float(np.linalg.norm(found.anchor)))
    largest = max(tension, largest)
    clearance = line.ground - float(found.lowest[2])
    passed = line.limits_passed(tension, largest)
    result = {
        "force": found.ship,
        "tension": tension,
        "regime": REGIMES[int(found.regime)],
        "elongation": float(np.linalg.norm(line.end - line.anchor) / line.length),
        "anchor_force": found.anchor,
        "lowest_point": found.lowest,
        "load": found.load,
        "formulation": scenario.formulation,
        "line": scenario.config.line_models(),
        "angles": {"anchor": _elevation(found.anchor), "ship": _elevation(-np.asarray(found.ship))},
        "sag": _sag(np.asarray(fine)),
        "limits_passed": passed,
        "clearance_hull": None,
        "clearance_cable": clearance,
        "warnings": line.warnings(passed, largest, clearance),
    }
    if points is None:
        return result
    arc = jnp.linspace(0.0, line.length, points)
    curve, along = cable_along(cable, found, *ends, arc)
    return result | {"arc": arc, "points": curve, "tension_along": along}


def _elevation(direction: Any) -> float | None:
    """Return the angle above the horizontal of a direction from the anchor's side to the ship's [deg], None at rest."""
    vector = np.asarray(direction)
    length = float(np.linalg.norm(vector))
    return float(np.degrees(np.arcsin(-vector[2] / length))) if length > 0 else None


def _sag(curve: np.ndarray) -> float:
    """Return the largest distance of a curve from its chord [m]."""
    span, offset = curve[-1] - curve[0], curve - curve[0]
    share = np.clip(offset @ span / max(float(span @ span), 1e-300), 0.0, 1.0)
    return float(np.linalg.norm(offset - share[:, None] * span, axis=1).max())
