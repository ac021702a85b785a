"""How far each table cell moves over perturbed flights with the identified set sampled. Depends on: campaign, fitting.

200 flights per row: initial attitude ±2°, gust ±1 s, wind ±3 %, and the ship one of those that fit nearly as well.
"""

from typing import Any

import numpy as np

from tethership.campaign import Cases, fly_blocks, layer_switches, perturbed
from tethership.scenario import Scenario
from tethership.simulation import CODES, Outcome
from tethership.studies.docking_paper.fit.space import named_values
from tethership.studies.docking_paper.fit.targets import TABLES
from tethership.studies.docking_paper.tables import THRESHOLDS, held_out, published_numbers

LOW, HIGH = 5.0, 95.0
"""Percentiles of the interval."""


def uncertainty(
    scenario: Scenario,
    members: np.ndarray,
    winds: tuple[float, ...],
    flights: int,
    seed: int,
    perturb: bool = True,
) -> list[dict[str, Any]]:
    """Return the interval of each table cell.

    Parameters
    ----------
    scenario : Scenario
        The paper's docking.
    members : ndarray
        Identified set [SI], shape (members, unknowns).
    winds : tuple of float
        [m/s].
    flights : int
        Per row.
    seed : int
        Of perturbations and of the draw from the set.
    perturb : bool
        False to sample the identified set alone, as the interval of a prediction.

    Returns
    -------
    list of dict
        layers, wind, metric, low, median, high, published, inside (None without a flight that has such a number),
        held_out, broken (share of flights that broke the cable).
    """
    drawn = members[np.random.default_rng(seed).integers(0, len(members), flights)]
    keys = [(table, wind) for table in TABLES for wind in winds]
    blocks = []
    for table, wind in keys:
        columns: dict[str, Any] = {**named_values(drawn), "wind.speed": wind}
        if perturb:
            columns |= perturbed(scenario.changed({"wind.speed": wind}), flights, seed)
        blocks.append(Cases.of({**columns, **layer_switches(scenario, TABLES[table])}, flights))
    flown = fly_blocks(scenario, blocks)
    return [cell for key, part in zip(keys, flown, strict=True) for cell in _cells(*key, part)]


def _cells(table: str, wind: float, flown: dict[str, np.ndarray]) -> list[dict[str, Any]]:
    """Return the cells of one row."""
    published, apart = published_numbers()[table, wind], (table, wind) in held_out()
    names = ("tension_max", "tension_mean", "rewind_rate_min", "docking_time", "ADC", "E", "theta_rms")
    values = {name: flown[name] for name in names}
    values |= {f"seconds_above {limit}": flown["seconds_above"][:, i] for i, limit in enumerate(THRESHOLDS)}
    broken = float(np.mean(flown["outcome"] == CODES.index(Outcome.cable_broken)))
    rows = []
    for name, value in values.items():
        finite = value[np.isfinite(value)]
        given = published[name]
        low, middle, high = map(float, np.percentile(finite, [LOW, 50.0, HIGH])) if len(finite) else (np.nan,) * 3
        rounding = 0.005  # the tables print two decimals, tensions none
        slack = 100.0 * rounding if name.startswith("tension") else rounding
        inside = None if not len(finite) else bool(low - slack <= given <= high + slack)
        rows.append(
            {
                "layers": table,
                "wind": wind,
                "metric": name,
                "low": low,
                "median": middle,
                "high": high,
                "published": given,
                "inside": inside,
                "held_out": apart,
                "broken": broken,
            }
        )
    return rows
