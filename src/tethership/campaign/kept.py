"""The flights of a campaign that are kept with their histories: the worst, and some drawn at random.

Depends on: campaign, simulation. Flown again adaptively after the campaign, from the stored inputs.
"""

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from tethership.campaign.answers import failed
from tethership.campaign.plan import Plan
from tethership.campaign.work import fly_one
from tethership.errors import ConfigError
from tethership.simulation import Flight

FOLDER = "flights"


def keep_flights(plan: Plan, data: xr.Dataset, folder: Path) -> list[dict[str, Any]]:
    """Fly the kept cases again, write each as netCDF, and return what they are; files that are there and whole stand.

    Parameters
    ----------
    plan : Plan
        The campaign.
    data : xr.Dataset
        Its results.
    folder : Path
        Of the campaign.
    """
    (folder / FOLDER).mkdir(exist_ok=True)
    found = []
    for law in range(len(plan.laws)):
        for why, case in _chosen(plan, data, law):
            name = f"{plan.laws[law].name}_{case}.nc"
            entry = {"law": plan.laws[law].name, "case": case, "why": why, "file": str(Path(FOLDER) / name)}
            if not _stands(folder / FOLDER / name):
                try:
                    fly_one(plan.scenario, plan.names, plan.values[law, case]).save(folder / FOLDER / name)
                except ConfigError as error:
                    entry |= {"file": None, "error": str(error)}
            found.append(entry)
    return found


def _stands(path: Path) -> bool:
    """Return whether a flight is there and as it was written."""
    try:
        Flight.load(path)
    except ConfigError:
        return False
    return True


def _chosen(plan: Plan, data: xr.Dataset, law: int) -> list[tuple[str, int]]:
    """Return why and which cases are kept: those with the highest peaks, then others at random."""
    peaks = np.where(failed(data)[law], np.inf, data["tension_max"].values[law])
    order = np.argsort(-peaks, kind="stable")
    worst = [int(case) for case in order[: plan.config.worst]]
    others = np.random.default_rng([plan.config.seed, 1]).permutation(plan.cases)
    drawn = [int(case) for case in others if case not in worst][: plan.config.random]
    return [("worst", case) for case in worst] + [("random", case) for case in drawn]
