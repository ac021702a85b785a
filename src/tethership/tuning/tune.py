"""Tuning of the control laws' gains over many perturbed flights, under constraints.

Depends on: campaign, scenario, tuning.search. What is asked of a set of gains, over all perturbed flights: no throttle
saturates, the tension stays below the tear force, the ship docks within 1.1 times the shortest time. The lowest peak
tension is looked for, with a little weight on the control's travel and on pitch, and what is violated weighs heavily
beside it: an exact penalty, so that gains which cannot keep everything are still the better ones of their kind.
"""

import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tethership.campaign import Cases, fly_cases, perturbed
from tethership.errors import ConfigError
from tethership.scenario import Scenario, list_parameters
from tethership.tuning.search import Archive, evolve, sobol

GAINS = (
    "control.attitude.roll_rate_gain",
    "control.attitude.pitch_rate_gain",
    "control.attitude.yaw_rate_gain",
    "control.attitude.roll_gain",
    "control.attitude.pitch_gain",
    "control.rewind.gain",
    "control.heading.gain",
    "control.navigation.position_gain",
    "control.navigation.vertical_gain",
    "control.navigation.speed_gain",
    "control.navigation.climb_gain",
)
"""What is tuned: the gains of the four layers."""

FACTOR = 10.0
"""A gain is looked for between a tenth of its value and ten times it."""

LONGEST = 1.1
"""Longest docking time allowed, as a multiple of the shortest [-]."""

TRAVEL_WEIGHT = 0.05
"""Weight of ADC [s] beside the mean peak over the tear force."""

PITCH_WEIGHT = 0.004
"""Weight of θ_rms² [1/deg²] beside the mean peak over the tear force: 5° count as a tenth of it, 16° as all of it."""

PENALTY = 5.0
"""Weight of a violation beside the mean peak over the tear force: a fifth of a second of saturation counts as all of
it."""

Progress = Callable[[str, float, float], None]
"""Called with the stage, the share that is done and the least cost so far."""


class Judgement(NamedTuple):
    """What perturbed flights say of one set of gains.

    Attributes
    ----------
    cost : float
        To be made small [-].
    saturated, torn, late, undocked : float
        Share of the flights with a saturated throttle, a peak above the tear force, a docking time too long, or
        without docking [-].
    peak_mean, peak_high : float
        Mean and 95th percentile of the peak tension [N].
    duty, effort, pitch : float
        Means of ADC [1/s], E [-], θ_rms [deg].
    saturated_seconds : float
        Mean time with a throttle saturated [s].
    time : float
        Mean flight time [s].
    """

    cost: float
    saturated: float
    torn: float
    late: float
    undocked: float
    peak_mean: float
    peak_high: float
    duty: float
    effort: float
    pitch: float
    saturated_seconds: float
    time: float


class Tuning(NamedTuple):
    """What tuning found.

    Attributes
    ----------
    gains : dict
        Dotted name → value [SI]: of attitude [s/rad, 1/rad], rewind [m/(s N)], heading [1/rad], navigation [1/m, s/m].
    before, after : Judgement
        Of the scenario's own gains and of the tuned ones, over all perturbed flights.
    seconds : float
        Wall time [s].
    vectors : int
        Sets of gains looked at.
    """

    gains: dict[str, float]
    before: Judgement
    after: Judgement
    seconds: float
    vectors: int


def shortest_time(scenario: Scenario) -> float:
    """Return the docking time with the winch never slowed down [s] (claim D11)."""
    cable = scenario.config.cables[0]
    return (cable.length - scenario.config.stop.cable_length) / cable.winch.rewind_rate


def judge(scenario: Scenario, gains: np.ndarray, columns: dict[str, np.ndarray]) -> list[Judgement]:
    """Return the judgement of sets of gains over perturbed flights.

    Parameters
    ----------
    scenario : Scenario
        All of its layers act.
    gains : ndarray
        In the order of `GAINS`, in SI as in `Tuning` [s/rad, 1/rad, m/(s N), 1/m, s/m], shape (sets, gains).
    columns : dict
        From `perturbed`, shape (flights,): angles [rad], gust's start [s], wind [m/s].
    """
    sets, flights = len(gains), len(next(iter(columns.values())))
    cases = Cases(GAINS, np.repeat(gains, flights, axis=0))
    cases = cases.with_columns({name: np.tile(column, sets) for name, column in columns.items()})
    limited = scenario.changed({"stop.time_limit": 1.5 * shortest_time(scenario)})
    flown = fly_cases(limited, cases)
    tear = scenario.config.limits.envelope_tear
    shaped = {name: value.reshape(sets, flights, *value.shape[1:]) for name, value in flown.items()}
    return [
        _judged({name: value[i] for name, value in shaped.items()}, tear, LONGEST * shortest_time(scenario))
        for i in range(sets)
    ]


def _judged(flown: dict[str, np.ndarray], tear: float, longest: float) -> Judgement:
    """Return the judgement of one set of gains from its flights' metrics."""
    peak, span = flown["tension_max"], flown["flight_time"]
    docked = np.isfinite(flown["docking_time"])
    saturated = flown["saturated_seconds"] > 0.0
    violation = (
        np.mean(np.minimum(flown["saturated_seconds"], 10.0))
        + np.mean(np.maximum(peak / tear - 1.0, 0.0))
        + np.mean(np.maximum(span / longest - 1.0, 0.0))
        + 10.0 * np.mean(~docked)
    )
    wish = (
        np.mean(peak) / tear + TRAVEL_WEIGHT * np.mean(flown["ADC"]) + PITCH_WEIGHT * np.mean(flown["theta_rms"] ** 2)
    )
    cost = wish + PENALTY * violation if np.isfinite(violation) and np.isfinite(wish) else 1e6
    return Judgement(
        float(cost),
        float(np.mean(saturated)),
        float(np.mean(peak > tear)),
        float(np.mean(span > longest)),
        float(np.mean(~docked)),
        float(np.mean(peak)),
        float(np.percentile(peak, 95.0)),
        float(np.mean(flown["ADC"])),
        float(np.mean(flown["E"])),
        float(np.mean(flown["theta_rms"])),
        float(np.mean(flown["saturated_seconds"])),
        float(np.mean(span)),
    )


def tune(
    scenario: Scenario,
    flights: int = 200,
    searched: int = 24,
    population: int = 32,
    generations: int = 40,
    seed: int = 1,
    progress: Progress | None = None,
) -> Tuning:
    """Return gains with the lowest peak tension that keep the constraints, or violate them least.

    Parameters
    ----------
    scenario : Scenario
        Docking with all layers, at the wind to be tuned for.
    flights : int
        Perturbed flights over which the result is judged.
    searched : int
        How many of them the search looks at.
    population, generations : int
        Of the differential evolution; the scenario's own gains are in the first population.
    seed : int
        Of everything random.
    progress : callable, optional
        See `Progress`.

    Returns
    -------
    Tuning
        Gains in SI, each between a tenth and ten times the scenario's own; tensions [N], times [s], shares [-] before
        and after.

    Raises
    ------
    ConfigError
        The scenario lacks a layer, a cable or a gust, or a gain is zero.
    """
    begun = time.perf_counter()
    own = _own_gains(scenario)
    columns = perturbed(scenario, flights, seed)
    few = {name: column[:searched] for name, column in columns.items()}
    total = population * (generations + 1)

    def gains_at(places: np.ndarray) -> np.ndarray:
        return own * FACTOR ** (2.0 * places - 1.0)

    def costs(places: np.ndarray) -> np.ndarray:
        return np.array([[judgement.cost] for judgement in judge(scenario, gains_at(places), few)])

    def report(count: int, least: float) -> None:
        if progress is not None:
            progress("gains", min(count / total, 1.0), least)

    archive = Archive(costs, report, score=lambda found: found[:, 0])  # a cost is no residual
    start = sobol(len(GAINS), max(int(np.ceil(np.log2(population))), 1), seed)[:population]
    start = 0.5 + 0.6 * (start - 0.5)
    start[0] = 0.5
    evolve(archive, start, generations, seed)
    ranked = np.concatenate([gains_at(archive.best(8)), own[None]])
    judged = judge(scenario, ranked, columns)
    best = int(np.argmin([judgement.cost for judgement in judged]))
    return Tuning(
        {name: float(f"{value:.6g}") for name, value in zip(GAINS, ranked[best], strict=True)},
        judged[-1],
        judged[best],
        time.perf_counter() - begun,
        archive.count,
    )


def _own_gains(scenario: Scenario) -> np.ndarray:
    """Return the scenario's own gains [SI], or say why they cannot be tuned."""
    missing = {"rewind", "heading", "navigation"} - set(scenario.layers)
    if missing or not scenario.config.control.sas:
        raise ConfigError(
            f"tuning needs all layers; {scenario.name} lacks {', '.join(sorted(missing)) or 'SAS/attitude'}"
        )
    known = list_parameters(scenario.config)
    own = np.array([known[name].value for name in GAINS])
    if np.any(own <= 0):
        raise ConfigError(f"tuning scales gains: {GAINS[int(np.argmin(own))]} must be above 0")
    return own


def tuning_document(found: Tuning, scenario: Scenario, seed: int, flights: int) -> dict[str, Any]:
    """Return a tuning as plain data: gains and the wind [m/s] in SI, the judgements, wall time [s]."""
    known = list_parameters(scenario.config)
    return {
        "scenario": scenario.name,
        "wind": scenario.config.wind.speed,
        "formulation": scenario.formulation,
        "seed": seed,
        "flights": flights,
        "parameters": found.gains,
        "former": {name: known[name].value for name in GAINS},
        "misfit": found.after.cost,
        "before": found.before._asdict(),
        "after": found.after._asdict(),
        "vectors": found.vectors,
        "seconds": round(found.seconds, 1),
    }
