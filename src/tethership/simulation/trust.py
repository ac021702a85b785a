"""What a flight's result may be used for: limits passed, ground, saturation, the range of its models; in one verdict.

Depends on: simulation.quasi_static, results, scenario. Command, picture, replay and explorer all say these words.
"""

from typing import Protocol

import numpy as np
import xarray as xr

from tethership.results import HARMFUL, refined, saturated_seconds, seconds_above
from tethership.scenario import ScenarioConfig, record_warning
from tethership.simulation.outcome import Outcome
from tethership.simulation.quasi_static import quasi_static_warning

WORDS = {
    "envelope_tear": "the envelope's tear limit",
    "envelope_tensile": "the envelope's tensile limit",
    "cable_break": "the cable's breaking force",
}
"""What the limits are called in a sentence."""

DIP = 0.01
"""How far below the ground is told [m]."""

SATURATED = 0.01
"""Share of a flight with a command beyond its limits from which it is told [-]."""


class Flown(Protocol):
    """What is needed of a flight."""

    @property
    def data(self) -> xr.Dataset:
        """Its outputs."""
        ...

    @property
    def config(self) -> ScenarioConfig:
        """Its scenario."""
        ...

    @property
    def outcome(self) -> Outcome:
        """How it ended."""
        ...


def seconds_passed(flight: Flown) -> dict[str, float]:
    """Return for how long [s] every watched limit was passed, only those that were; by the names of `results.limits`.

    Tension is that at the tether point; a cable breaks where its largest tension reaches its own breaking force.
    """
    if not flight.config.cables or "tension" not in flight.data or "tension_largest" not in flight.data:
        return {}
    time = flight.data["time"].to_numpy()
    pull = refined(time, flight.data["tension"].to_numpy().max(axis=1))
    passed = {name: seconds_above(*pull, limit) for name, limit in flight.config.watched_limits().items()}
    strength = np.array([cable.breaking_force for cable in flight.config.cables])
    strained = (flight.data["tension_largest"].to_numpy() / strength).max(axis=1)
    passed["cable_break"] = seconds_above(time, strained, 1.0)
    broken = flight.outcome is Outcome.cable_broken or strained.max(initial=0.0) >= 1.0  # it ends there, after 0 s
    return {name: over for name, over in passed.items() if over > 0.0 or (name == "cable_break" and broken)}


def reservations(flight: Flown) -> list[str]:
    """Return what a bare outcome would hide, a clause each: limits passed, hull below the ground, saturation.

    The hull is told from `DIP` [m] below the ground on, saturation from a share of `SATURATED` [-] of the time on.
    """
    found = [
        f"{WORDS[name]} was passed for {over:.2f} s"
        for name, over in seconds_passed(flight).items()
        if name in HARMFUL and not (name == "cable_break" and flight.outcome is Outcome.cable_broken)
    ]
    time = flight.data["time"].to_numpy()
    clearance = flight.data["clearance"].to_numpy() if "clearance" in flight.data else np.zeros(0)
    if flight.config.has_ground() and clearance.min(initial=0.0) < -DIP:
        below = seconds_above(time, -clearance, 0.0)
        found.append(f"the hull was below the ground for {below:.1f} s (by up to {-clearance.min():.2f} m)")
    saturated = saturated_seconds(flight.data)
    if len(time) and saturated > SATURATED * time[-1]:
        found.append(f"commands were saturated for {saturated:.1f} s of {time[-1]:.1f} s")
    return found


def verdict(flight: Flown, digits: int = 1) -> str:
    """Return how a flight ended and what must be said with it, without a full stop; seconds with so many digits."""
    time = flight.data["time"].to_numpy()
    after = f" after {time[-1]:.{digits}f} s" if len(time) else " at the start"
    words = f"{flight.outcome.name.replace('_', ' ')}{after}"
    reserved = reservations(flight)
    if not reserved:
        return words
    joined = f"{', '.join(reserved[:-1])}{' and ' if reserved[:-1] else ''}{reserved[-1]}"
    return f"{words}{', but ' if flight.outcome is Outcome.docked else '; before that '}{joined}"


def warnings(flight: Flown) -> list[str]:
    """Return what must be known besides the verdict: the record of the wind, cable below the ground, model ranges.

    A cable is told from `DIP` [m] below the ground on.
    """
    time = flight.data["time"].to_numpy()
    dips = flight.data["cable_clearance"].to_numpy() if "cable_clearance" in flight.data else np.zeros(0)
    said = [quasi_static_warning(flight), record_warning(flight.config.wind, float(time[-1]) if len(time) else 0.0)]
    if dips.size and dips.min() < -DIP:
        below = seconds_above(time, -dips.min(axis=1), 0.0)
        said.insert(
            0,
            f"a cable dips below the ground for {below:.1f} s, by up to {-dips.min():.2f} m; contact is not modelled",
        )
    return [*getattr(flight.config.wind, "remarks", ()), *(line for line in said if line)]
