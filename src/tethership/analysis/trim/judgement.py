"""What is said of a trim: its outcome in a sentence with the cure, limits passed, clearances, warnings.

Depends on: analysis.trim.solve, analysis.trim.outcome, plant.balance, results.limits, scenario.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from tethership.analysis.trim.outcome import UNDER_GROUND, Points, TrimOutcome, outcomes
from tethership.analysis.trim.solve import Described
from tethership.plant import left_over
from tethership.results import HARMFUL, ratios_passed
from tethership.scenario import Scenario, ScenarioConfig

STIFF_LINK = 1e5
"""EA/L beyond which the search for a taut line's trim may be lost in the line's own stretch [N/m]. Of four starts of
the aerostat all end in trim at 1e5; two at 3.3e5 (3 m); four at 5.8e5 (10 m); one at 1.0e6, 1.9e6 and 3.3e6; none of
lines of 1 m and less at 5.8e6 and beyond."""


class Judged(NamedTuple):
    """What is said of one point.

    Attributes
    ----------
    saturated : tuple of str
        Thrusters and fins asked for more than they have.
    outcome : TrimOutcome
    message : str
        A sentence: how it ended, by how much, and the cure.
    warnings : tuple of str
        What a user must know of an equilibrium before acting on it.
    limits_passed : dict[str, float]
        Tension over limit of every watched limit that is passed [-].
    clearance_hull, clearance_cable : float or None
        Height of the lowest points of hull and cables above the ground [m]; None where there is no ground or no cable.
    """

    saturated: tuple[str, ...]
    outcome: TrimOutcome
    message: str
    warnings: tuple[str, ...]
    limits_passed: dict[str, float]
    clearance_hull: float | None
    clearance_cable: float | None


def judge(scenario: Scenario, found: Described, height_sought: bool) -> Judged:
    """Return what is said of one point of a scenario.

    Parameters
    ----------
    scenario : Scenario
        Says limits, ground, thrusters and fins.
    found : Described
        What there is at the point, as numpy arrays.
    height_sought : bool
        As in `outcomes`.
    """
    config, limit = scenario.config, float(found.limit)
    saturated = _beyond(scenario, found)
    rows = Points(*(np.asarray(part)[None] for part in (found.residual, found.drift, found.hull, found.cables)))
    [outcome] = outcomes(rows, np.array([bool(saturated)]), np.array([limit]), config.has_ground(), height_sought)
    passed = limits_passed(config, np.asarray(found.tension), np.asarray(found.largest))
    return Judged(
        tuple(saturated),
        outcome,
        _message(scenario, found, outcome, saturated, limit, height_sought, passed),
        tuple(_warnings(config, found, outcome, passed)),
        passed,
        float(found.hull) if config.has_ground() else None,
        float(np.min(found.cables)) if config.cables else None,
    )


def _beyond(scenario: Scenario, found: Described) -> dict[str, str]:
    """Return name → what would be needed of every thruster and fin asked for more than it has."""
    vehicle, command, allowed = scenario.config.vehicle, found.command, found.allowed
    needs: dict[str, str] = {}
    for thruster, asked, has in zip(vehicle.thrusters, command.throttle, allowed.throttle, strict=True):
        if asked != has:
            needs[thruster.name] = f"{thruster.name} {float(asked):.3g} of its nominal thrust"
    for fin, asked, has in zip(vehicle.fins, command.deflection, allowed.deflection, strict=True):
        if asked != has:
            needs[fin.name] = f"{fin.name} {np.degrees(float(asked)):.4g}° (it has {np.degrees(float(has)):.3g}°)"
    return needs


def limits_passed(config: ScenarioConfig, tension: np.ndarray, largest: np.ndarray) -> dict[str, float]:
    """Return tension over limit [-] of every watched limit that is passed.

    Parameters
    ----------
    config : ScenarioConfig
        Says what the limits are.
    tension, largest : ndarray
        Of each cable at its tether point, and the largest along it, which is what breaks it [N].
    """
    if not config.cables:
        return {}
    pull = float(tension.max())
    strained = max(float(most) / cable.breaking_force for most, cable in zip(largest, config.cables, strict=True))
    limits = config.watched_limits()
    reached = dict.fromkeys(limits, pull) | {"cable_break": strained * limits["cable_break"]}
    return ratios_passed(limits, reached)


def _message(
    scenario: Scenario,
    found: Described,
    outcome: TrimOutcome,
    needs: dict[str, str],
    limit: float,
    height_sought: bool,
    passed: dict[str, float],
) -> str:
    """Return the sentence for an outcome: by how much, and the cure."""
    config, drift = scenario.config, np.asarray(found.drift)
    match outcome:
        case TrimOutcome.converged:
            return "In equilibrium, but a cable would break." if "cable_break" in passed else outcome.value
        case TrimOutcome.saturated:
            left = left_over(np.asarray(found.clipped), drift, limit)
            lacking = "thrust" if any(thruster.name in needs for thruster in config.vehicle.thrusters) else "deflection"
            return (
                f"No equilibrium within limits: it would take more {lacking} than there is "
                f"({', '.join(needs.values())}); within them {left} are left over. {_cure(config, needs)}"
            )
        case TrimOutcome.hull_below_ground:
            return (
                f"The loads balance only with the hull {-float(found.hull):.1f} m below the ground. "
                f"{_raised(config, height_sought)}"
            )
        case TrimOutcome.cable_below_ground:
            lowest = int(np.argmin(found.cables))
            name, depth = config.cables[lowest].name, -float(found.cables[lowest])
            return (
                f"The cable {name} is longer than the lift can hold up: it would hang {depth:.1f} m below the "
                f"ground, and a cable that lies on it is not modelled. Shorten it (cables.{name}.length), or "
                f"{_either(_lift(config))} would hold more of it up."
            )
        case _:
            return _unbalanced(config, found, limit)


def _unbalanced(config: ScenarioConfig, found: Described, limit: float) -> str:
    """Return what is left over where nothing balances, with the cure."""
    drift, residual = np.asarray(found.drift), np.asarray(found.residual)
    if np.abs(residual).max() <= limit:
        return (
            f"No equilibrium: the loads balance at one instant, with {left_over(residual, drift, limit)}. Leave the "
            "rates at zero, and on a cable the velocity too: steady turns are no trims yet."
        )
    return (
        f"No equilibrium with these unknowns: {left_over(residual, drift, limit)} left over. "
        f"{''.join(_stiff_links(config))}"
        "Free more quantities (trim.unknowns) or start the search elsewhere (trim.position)."
    )


def _stiff_links(config: ScenarioConfig) -> Iterable[str]:
    """Yield a sentence for every cable whose stiffness makes the search fail."""
    for cable in config.cables:
        rate = cable.stiffness / cable.length
        if rate > STIFF_LINK:
            yield (
                f"The cable {cable.name} is a link of {rate:.2g} N/m (EA/L), too stiff for this search, which is sure "
                f"of taut lines up to {STIFF_LINK:.0e} N/m: lower cables.{cable.name}.stiffness. "
            )


def _warnings(
    config: ScenarioConfig, found: Described, outcome: TrimOutcome, passed: dict[str, float]
) -> Iterable[str]:
    """Yield what a user must know of a point: how the wind was read, limits passed, a cable below the ground."""
    yield from getattr(config.wind, "remarks", ())
    if outcome is TrimOutcome.no_equilibrium:
        return
    for cable, most in zip(config.cables, found.largest, strict=True):
        if most >= cable.breaking_force:
            yield (
                f"the cable {cable.name} would break: {float(most):.4g} N are {float(most) / cable.breaking_force:.3g} "
                f"times its breaking force"
            )
    for name in HARMFUL[:-1]:
        if name in passed:
            limit = config.watched_limits()[name]
            yield f"the tension passes {name}: {passed[name] * limit:.4g} N, {passed[name]:.3g} times {limit:g} N"
    if outcome.is_start and config.has_ground():
        for cable, height in zip(config.cables, found.cables, strict=True):
            if height < -UNDER_GROUND:
                yield f"the cable {cable.name} dips {-float(height):.2f} m below the ground; contact is not modelled"


def _cure(config: ScenarioConfig, needs: dict[str, str]) -> str:
    """Return what would bring the commands within their limits, of what the scenario has."""
    cures = ["less wind"] if config.wind.speed > 0 else ["another speed"]
    if config.cables:
        cures.append("a slacker cable")
    if any(thruster.name in needs for thruster in config.vehicle.thrusters):
        cures.append("more nominal thrust")
    if any(fin.name in needs for fin in config.vehicle.fins):
        cures.append("larger fins")
    if not config.cables:
        cures.append("a mass nearer to the lift")
    return f"{_either(cures).capitalize()} would do."


def _raised(config: ScenarioConfig, height_sought: bool) -> str:
    """Return what would bring a hull out of the ground."""
    if not height_sought:
        return (
            "It is put there: raise trim.elevation, trim.elongation, trim.position or the mast (ground.anchor_height)."
        )
    cause = "blown down or too heavy" if config.wind.speed > 0 else "too heavy"
    return (
        f"The ship is {cause}: {_either(_lift(config))} would raise it; there may be another equilibrium from another "
        "start of the search (trim.position, trim.attitude)."
    )


def _lift(config: ScenarioConfig) -> list[str]:
    """Return what leaves more lift for the cable."""
    return ["less wind", "more free lift"] if config.wind.speed > 0 else ["more free lift"]


def _either(words: list[str]) -> str:
    """Return words as a choice: a, b or c."""
    return " or ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)
