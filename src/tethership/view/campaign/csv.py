"""A campaign's tables as CSV: probabilities, and every flight. Depends on: campaign (its data)."""

import csv
import io
import itertools
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from tethership.campaign import COMPARED, CURE, Plan, failed, outcomes
from tethership.results import write_atomically

KEPT = (*COMPARED, "quasi_static_outside", "snap_impulse")
"""Metrics of every flight."""

OUTSIDE = ("median", "largest")
"""Shares of a law's flights outside the quasi-static cable's trusted range."""


def write_exceedance(folder: Path, answers: dict[str, Any]) -> Path:
    """Write the probability [-] of passing each limit, which has its unit beside it, under each law; returns where."""
    keys = (
        "value",
        "unit",
        "exceeding",
        "undetermined",
        "flights",
        "probability",
        "low",
        "high",
        "confidence",
        "method",
        "probability_with_snap",
        "high_with_snap",
    )
    rows = (
        [law, limit, *(row.get(key) for key in keys), *(of["quasi_static_outside"][end] for end in OUTSIDE)]
        for law, of in answers["laws"].items()
        for limit, row in of["exceedance"].items()
    )
    return _written(folder / "exceedance.csv", ["law", "limit", *keys, *(f"outside_{end}" for end in OUTSIDE)], rows)


def write_flights(folder: Path, plan: Plan, data: xr.Dataset, flags: dict[str, np.ndarray]) -> Path:
    """Write every flight, a row each: what was drawn, how it ended, its metrics, limits passed (0 or 1); returns where.

    What was drawn is in SI; metrics are in the units of `campaign.store.UNITS`: tensions [N], times [s], θ_rms [deg].
    """
    head = ["law", "case", *plan.sample.names, "outcome", "failed", *KEPT, *flags]
    return _written(folder / "flights.csv", head, _flights(plan, data, flags))


def _flights(plan: Plan, data: xr.Dataset, flags: dict[str, np.ndarray]) -> Iterator[tuple[Any, ...]]:
    """Yield a row for each flight, law by law; plain numbers, which are written several times as fast as numpy's."""
    ended, lost = outcomes(data), failed(data)
    for law, chosen in enumerate(plan.laws):
        measured = [data[name].values[law] for name in KEPT]
        passed = [of[law].astype(int) for of in flags.values()]
        columns = [*plan.sample.values.T, ended[law], lost[law].astype(int), *measured, *passed]
        yield from zip(itertools.repeat(chosen.name), range(plan.cases), *(column.tolist() for column in columns))


def _written(path: Path, head: list[str], rows: Iterable[Sequence[Any]]) -> Path:
    """Write a table as CSV; returns where."""
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(head)
    writer.writerows(rows)
    return write_atomically(path, text.getvalue(), CURE)
