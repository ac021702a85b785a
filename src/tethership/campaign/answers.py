"""What a campaign's flights say: exceedance, times, tails, importance, pairs, compliance. Returns plain data.

Depends on: campaign. A flight that failed (diverged, or without an equilibrium) counts as exceeding every limit: to
leave it out would call the worst cases safe.
"""

import itertools
from typing import Any

import numpy as np
import xarray as xr

from tethership.campaign.compliance import judge
from tethership.campaign.extremes import Tail, fit_tail
from tethership.campaign.importance import rank_importance, sobol_importance
from tethership.campaign.paired import paired_limit, paired_metric
from tethership.campaign.plan import Plan
from tethership.campaign.probability import estimate
from tethership.campaign.schema import Requirement
from tethership.campaign.trust import ON_TENSION, share_outside, with_snap
from tethership.campaign.work import COMPARED
from tethership.scenario import record_warning
from tethership.simulation import CODES, Outcome

UNBALANCED = 1e-3
"""What a trim may leave in the units of its balance, beyond which a case has no equilibrium [-].

They are 1e-3 of the weight for forces and, times 1 m, for moments, and 1e-3 rad/s and m/s for what must stand still.
"""

NO_START = "no_equilibrium"
"""How a flight ended whose trim was none."""

LEVELS = (1e-2, 1e-3, 1e-4)
"""Probabilities per flight whose peak tension is extrapolated."""

Flags = dict[str, np.ndarray]
"""Limit → which flights exceed it, shape (laws, cases)."""

BOUNDED = ("probability", "high", "verdict")
"""What is told of a requirement with the wave of the snap added."""

PERCENTILES = (5.0, 25.0, 50.0, 75.0, 95.0)
"""Of the time to dock."""


def failed(data: xr.Dataset) -> np.ndarray:
    """Return which flights have no result, shape (laws, cases).

    Those that diverged, and those whose trim left `UNBALANCED` or more: a millionth of the weight [N, N m], 1e-6
    [rad/s, m/s] of what must stand still.
    """
    diverged = data["outcome"].values == CODES.index(Outcome.diverged)
    return diverged | ~(data["unbalanced"].values < UNBALANCED)


def outcomes(data: xr.Dataset) -> np.ndarray:
    """Return how each flight ended, by name, `no_equilibrium` where it had no start; shape (laws, cases)."""
    names = np.array([code.name for code in CODES])[data["outcome"].values]
    return np.where(data["unbalanced"].values < UNBALANCED, names, NO_START)


def undetermined(data: xr.Dataset, flags: Flags) -> Flags:
    """Return for each limit which flights ended before they docked and had not exceeded it by then.

    What they would have done later nobody saw. Time is never undetermined: such a flight has not docked in time.
    """
    early = data["outcome"].values != CODES.index(Outcome.docked)
    return {name: early & ~of & (name != "time") for name, of in flags.items()}


def limit_values(plan: Plan) -> dict[str, tuple[float, str]]:
    """Return the number and unit of each limit: tensions [N], attitude [deg], clearance [m], time [s]."""
    control, tear, tensile, weakest = map(float, plan.scenario.config.watched_tensions())
    limits = plan.config.limits
    found = {
        "control_threshold": (control, "N"),
        "envelope_tear": (tear, "N"),
        "envelope_tensile": (tensile, "N"),
        "cable_break": (weakest, "N"),
        "ground_contact": (0.0, "m of clearance"),
    }
    if limits.winch_pull is not None:
        found["winch_pull"] = (float(limits.winch_pull), "N")
    if limits.attitude is not None:
        found["attitude"] = (float(np.degrees(limits.attitude)), "deg")
    if limits.time is not None:
        found["time"] = (float(limits.time), "s")
    return found


def exceeded(plan: Plan, data: xr.Dataset) -> Flags:
    """Return for each limit that has a number which flights exceed it, shape (laws, cases).

    Peaks of tension are held against limits [N], the larger of |φ| and |θ| against an angle ([rad] in the campaign,
    [deg] in the results), the hull's least clearance against 0 [m], the time to dock [s] against that allowed. A flight
    without a result exceeds all.
    """
    peak, outcome, broken = data["tension_max"].values, data["outcome"].values, failed(data)
    control, tear, tensile, weakest = plan.scenario.config.watched_tensions()
    limits = plan.config.limits
    found = {
        "control_threshold": peak > control,
        "envelope_tear": peak > tear,
        "envelope_tensile": peak > tensile,
        "cable_break": (data["tension_largest"].values > weakest) | (outcome == CODES.index(Outcome.cable_broken)),
    }
    if limits.winch_pull is not None:
        found["winch_pull"] = data["tension_anchor"].values > limits.winch_pull
    if limits.attitude is not None:
        largest = np.maximum(data["roll_max"].values, data["pitch_max"].values)
        found["attitude"] = largest > np.degrees(limits.attitude)
    found["ground_contact"] = data["clearance_min"].values < 0.0
    if limits.time is not None:
        found["time"] = ~(data["docking_time"].values <= limits.time)
    return {name: flags | broken for name, flags in found.items()}


def answer(plan: Plan, data: xr.Dataset, confidence: float = 0.95) -> dict[str, Any]:
    """Return everything that a campaign says, law by law.

    Parameters
    ----------
    plan : Plan
        The campaign.
    data : xr.Dataset
        From `open_results`, complete.
    confidence : float
        Of all intervals [-].

    Returns
    -------
    dict
        Of each law probabilities [-] with their intervals, percentiles of the time to dock [s] and of the peak tension
        [N], its tail [N] and what it hangs on [-]; pairs of laws; compliance; `step_error` [-].
    """
    flags, snapped = exceeded(plan, data), exceeded(plan, with_snap(data))
    names = [law.name for law in plan.laws]
    return {
        "runs": int(data["outcome"].size),
        "cases": plan.cases,
        "failed": int(failed(data).sum()),
        "confidence": confidence,
        "sampling": plan.config.sampling,
        "laws": {name: _of_law(plan, data, flags, snapped, i, confidence) for i, name in enumerate(names)},
        "pairs": [_pair(plan, data, flags, a, b) for a, b in itertools.combinations(range(len(names)), 2)],
        "compliance": [
            _complied(plan, data, flags, snapped, r, i) for r in plan.config.requirements for i in _laws_of(plan, r)
        ],
        "step_error": step_error(data),
        "wind_warning": record_warning(plan.scenario.config.wind, float(np.nanmax(data["flight_time"].values))),
    }


def _of_law(plan: Plan, data: xr.Dataset, flags: Flags, snapped: Flags, law: int, confidence: float) -> dict[str, Any]:
    """Return the answers of one law; `snapped` are its flags with the wave of the snap added to the peaks."""
    sampling, replicate = plan.config.sampling, plan.sample.replicate
    rows = _estimated_rows(plan)
    left, values = undetermined(data, flags), limit_values(plan)
    probabilities = {
        name: estimate(of[law][rows], sampling, replicate[rows], confidence)._asdict()
        | {"undetermined": int(left[name][law][rows].sum()), "value": values[name][0], "unit": values[name][1]}
        for name, of in flags.items()
    }
    for name in set(ON_TENSION) & set(flags):
        bound = estimate(snapped[name][law][rows], sampling, replicate[rows], confidence)
        probabilities[name] |= {"probability_with_snap": bound.probability, "high_with_snap": bound.high}
    codes, ended = data["outcome"].values[law], outcomes(data)[law]
    return {
        "exceedance": probabilities,
        "quasi_static_outside": share_outside(data, law, ~failed(data)[law]),
        "failed": int(failed(data)[law].sum()),
        "outcomes": {str(name): int(np.sum(ended == name)) for name in np.unique(ended)},
        "docking_time": _percentiles(data["docking_time"].values[law][rows]),
        "tension_max": _percentiles(data["tension_max"].values[law][rows]),
        "tail": _tail(plan, data["tension_max"].values[law], codes == CODES.index(Outcome.cable_broken), confidence),
        "importance": [entry._asdict() for entry in _importance(plan, data["tension_max"].values[law])],
    }


def _estimated_rows(plan: Plan) -> slice:
    """Return the cases of which shares are taken: of a Saltelli design its first two blocks, which fill the box."""
    if plan.config.sampling != "saltelli":
        return slice(None)
    return slice(2 * plan.cases // (len(plan.config.vary) + 2))


def _percentiles(values: np.ndarray) -> dict[str, Any]:
    """Return percentiles of what is finite, and how many there are."""
    finite = values[np.isfinite(values)]
    if not len(finite):
        return {"count": 0}
    found = np.percentile(finite, PERCENTILES)
    named = {f"p{place:g}": float(value) for place, value in zip(PERCENTILES, found, strict=True)}
    return {"count": len(finite), **named}


def _tail(plan: Plan, peaks: np.ndarray, broken: np.ndarray, confidence: float) -> dict[str, Any] | None:
    """Return the fitted tail of the peak tension, None where there are too few flights or they are not independent."""
    fitted = fit_tail(peaks, broken, plan.config.seed) if plan.config.sampling == "random" else None
    return None if fitted is None else tail_data(fitted, confidence)


def tail_data(tail: Tail, confidence: float) -> dict[str, Any]:
    """Return a tail as plain data, with its return levels.

    Parameters
    ----------
    tail : Tail
        Of the peak tensions of one law.
    confidence : float
        Of the levels' intervals [-].

    Returns
    -------
    dict
        u, σ, the end and the levels with their intervals [N]; ζ_u, ξ, distance and the levels' probabilities [-].
    """
    levels = [
        dict(zip(("level", "low", "high"), tail.level(p, confidence), strict=True)) | {"probability": p} for p in LEVELS
    ]
    return {
        "threshold": tail.threshold,
        "share": tail.share,
        "shape": tail.shape,
        "scale": tail.scale,
        "end": tail.end,
        "excesses": tail.excesses,
        "censored": tail.censored,
        "distance": tail.distance,
        "adequate": tail.adequate,
        "levels": levels,
    }


def _importance(plan: Plan, peaks: np.ndarray) -> list[Any]:
    """Return what the peak tension hangs on."""
    names, values = plan.sample.names, plan.sample.values
    moved = tuple(i for i, name in enumerate(names) if not name.endswith(".seed"))  # a seed is a name, no quantity
    if plan.config.sampling == "saltelli":
        return sobol_importance(names, values, peaks, plan.config.seed)
    return list(rank_importance(tuple(names[i] for i in moved), values[:, moved], peaks))


def _pair(plan: Plan, data: xr.Dataset, flags: Flags, first: int, second: int) -> dict[str, Any]:
    """Return two laws on the same cases."""
    independent = plan.config.sampling == "random"
    untested: dict[str, Any] = {} if independent else {"p_value": None, "low": None, "high": None}
    metrics = [paired_metric(name, data[name].values[first], data[name].values[second]) for name in COMPARED]
    return {
        "first": plan.laws[first].name,
        "second": plan.laws[second].name,
        "metrics": [metric._asdict() | untested for metric in metrics if metric is not None],
        "limits": [paired_limit(name, of[first], of[second])._asdict() | untested for name, of in flags.items()],
    }


def _laws_of(plan: Plan, requirement: Requirement) -> list[int]:
    """Return the places of the laws a requirement is of."""
    return [i for i, law in enumerate(plan.laws) if requirement.law in (None, law.name)]


def _complied(
    plan: Plan, data: xr.Dataset, flags: Flags, snapped: Flags, requirement: Requirement, law: int
) -> dict[str, Any]:
    """Return a requirement under one law, judged; one on tension also with the wave of the snap added."""
    rows, limit = _estimated_rows(plan), requirement.limit
    lost, replicate = failed(data)[law][rows], plan.sample.replicate[rows]

    def judged(of: Flags) -> dict[str, Any]:
        left = undetermined(data, of)[limit][law][rows]
        return judge(requirement, of[limit][law][rows], left, lost, plan.config.sampling, replicate)

    found = {"law": plan.laws[law].name, **judged(flags), "value": limit_values(plan).get(limit)}
    if limit not in ON_TENSION:
        return found
    bound = {f"{key}_with_snap": value for key, value in judged(snapped).items() if key in BOUNDED}
    return {**found, **bound, "quasi_static_outside": share_outside(data, law, ~failed(data)[law])}


def step_error(data: xr.Dataset) -> dict[str, Any]:
    """Return what the fixed steps cost: |fixed/tight − 1| [-] of flights flown again, median and largest by metric."""
    found: dict[str, Any] = {"flights": 0}
    for name in COMPARED:
        errors = data[f"error_{name}"].values if f"error_{name}" in data else np.array([])
        finite = errors[np.isfinite(errors)]
        found["flights"] = max(found["flights"], len(finite))
        if len(finite):
            found[name] = {"median": float(np.median(finite)), "largest": float(np.max(finite))}
    return found
