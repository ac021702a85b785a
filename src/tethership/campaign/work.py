"""Flying one batch of a campaign, in this process or another. Depends on: campaign, simulation, analysis, scenario."""

import functools
import json

import numpy as np
import xarray as xr

from tethership.analysis import trim
from tethership.campaign.engine import engine_name
from tethership.campaign.flights import Flyer
from tethership.campaign.plan import Batch, Work
from tethership.errors import ConfigError
from tethership.scenario import LAYERS, Scenario, find_beside, from_document, scenario_at
from tethership.simulation import Flight, dock

COMPARED = ("docking_time", "tension_max", "tension_mean", "ADC", "E", "theta_rms")
"""Metrics in which two laws are compared, and fixed steps are held against a tight adaptive flight."""


@functools.lru_cache(maxsize=2)
def _scenario(work: Work) -> Scenario:
    if work.trusted:
        find_beside(work.scenario_name)
    return from_document(json.loads(work.scenario), work.scenario_name, trusted=work.trusted)


@functools.lru_cache(maxsize=2)
def _flyer(work: Work) -> Flyer:
    if work.engine not in ("", engine_name()):
        raise ConfigError(
            f"a worker would fly by {engine_name()}, the campaign is flown by {work.engine}, and the last digits "
            "differ: take workers of one kind, or set TETHERSHIP_ENGINE=xla for all"
        )
    return Flyer(_scenario(work), work.names, np.array(work.example), work.lanes, work.step)


def make_ready(work: Work) -> None:
    """Make what all batches have in common, once, and load all that it takes."""
    xr.Dataset({"value": ("time", [0.0])}, {"time": [0.0], "name": ["text"]}).mean()  # looks for Dask and pint, once
    _flyer(work)


def fly_batch(work: Work, batch: Batch) -> dict[str, np.ndarray]:
    """Return the metrics of a batch's flights, and the error of those flown again.

    Returns
    -------
    dict[str, ndarray]
        As `fly_cases` (tensions [N], times [s], angles [deg]), and `error_NAME` [-] for each of `COMPARED`:
        |fixed/tight − 1|, NaN where it was not flown again. Tight is a flight by lanes with steps of h/8; by XLA it
        is an adaptive one.
    """
    found, finer = _flyer(work).fly_verified(batch.values, batch.verified)
    errors = {name: np.full(len(batch.values), np.nan) for name in COMPARED}
    for number, place in enumerate(batch.verified):
        if finer is not None:
            exact = {name: float(finer[name][number]) for name in COMPARED}
        else:
            exact = _tight(work, batch.values[place])
        for name, value in exact.items():
            errors[name][place] = _apart(found[name][place], value)
    return {**found, **{f"error_{name}": error for name, error in errors.items()}}


def _apart(fixed: float, tight: float | None) -> float:
    """Return |fixed/tight − 1|, NaN where either has no such number."""
    return abs(fixed / tight - 1.0) if tight else np.nan


def _tight(work: Work, values: np.ndarray) -> dict[str, float | None]:
    """Return the metrics of a case flown adaptively to tight tolerance, none where it cannot begin."""
    try:
        flight = fly_one(_scenario(work), work.names, values, "tight")
    except ConfigError:
        return {}
    return {name: flight.docking_time if name == "docking_time" else flight.metrics[name] for name in COMPARED}


def fly_one(scenario: Scenario, names: tuple[str, ...], values: np.ndarray, solver: str = "adaptive") -> Flight:
    """Fly one case with histories.

    Parameters
    ----------
    scenario : Scenario
        What all cases have in common.
    names : tuple of str
        Dotted names.
    values : ndarray
        In SI, e.g. `wind.speed` [m/s], shape (names,).
    solver : str
        As in `dock`.

    Raises
    ------
    ConfigError
        It has no equilibrium, or is over before it begins.
    """
    here = scenario_at(scenario, dict(zip(names, map(float, values), strict=True)))
    point = trim(here)
    if not point.outcome.is_start:
        raise ConfigError(f"{scenario.name}: this case cannot begin. {point.message}")
    return dock(here, point, LAYERS, solver=solver)
