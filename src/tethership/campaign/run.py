"""A campaign from its name to its answers, in one call. Depends on: campaign."""

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, NamedTuple

import xarray as xr

from tethership.campaign.answers import answer
from tethership.campaign.arrays import zarr_library
from tethership.campaign.execute import Hands, Progress, fly_campaign, in_processes, in_this_process, on_cluster
from tethership.campaign.kept import keep_flights
from tethership.campaign.plan import Plan, make_plan
from tethership.campaign.store import CampaignStore, owner, whole_results
from tethership.errors import ConfigError
from tethership.results import held


class Campaign(NamedTuple):
    """A campaign that was flown.

    Attributes
    ----------
    plan : Plan
        What was flown.
    data : xr.Dataset
        Every metric over law and case, with its unit: tensions [N], times [s], angles [deg] (`campaign.store.UNITS`).
    answers : dict
        What the flights say, law by law.
    flown : int
        Flights of this call; the others stood already.
    """

    plan: Plan
    data: xr.Dataset
    answers: dict[str, Any]
    flown: int


def run_campaign(
    name: str,
    folder: str | Path,
    changes: Mapping[str, Any] | None = None,
    scenario_changes: Mapping[str, Any] | None = None,
    workers: int | None = None,
    scheduler: str | None = None,
    confidence: float = 0.95,
    progress: Progress | None = None,
    trust: bool = False,
) -> Campaign:
    """Fly a campaign, or go on with it, and say what its flights say.

    Parameters
    ----------
    name : str
        Packaged campaign, or a path that ends in `.toml`.
    folder : str or Path
        Where its results are kept, batch by batch.
    changes : mapping, optional
        Of the campaign's own keys: samples, seed, sampling, …
    scenario_changes : mapping, optional
        Of its scenario, by dotted name, as in `load_scenario`.
    workers : int, optional
        Processes of this machine; without it this one flies.
    scheduler : str, optional
        Address of a Dask scheduler.
    confidence : float
        Of the intervals [-].
    progress : callable, optional
        Called with the flights that are done and their total.
    trust : bool
        Let laws of one's own that the scenario names be run.

    Raises
    ------
    ConfigError
        Anything in the file that cannot be; a folder that holds another campaign, or in which one runs; a scheduler
        that does not answer.
    SolveError
        A worker process died.
    """
    if workers is not None and scheduler is not None:
        raise ConfigError("workers and scheduler exclude each other; give one")
    zarr_library()  # before anything is written
    plan = make_plan(name, dict(changes or {}), dict(scenario_changes or {}), trust)
    plan.scenario.check_trust()
    owner(Path(folder), plan)
    with held(Path(folder)):
        store = CampaignStore(Path(folder), plan)
        with _hands(workers, scheduler)() as hands:
            flown = fly_campaign(plan, store, hands, progress)
        data = whole_results(folder)
        answers = answer(plan, data, confidence)
        answers["kept"] = keep_flights(plan, data, Path(folder))
    return Campaign(plan, data, answers, flown)


def _hands(workers: int | None, scheduler: str | None) -> Callable[[], AbstractContextManager[Hands]]:
    """Return what makes whatever flies the batches."""
    if scheduler is not None:
        return lambda: on_cluster(scheduler)
    return in_this_process if workers is None else lambda: in_processes(workers)
