"""How far flights are from the paper's tables, as residuals of each number.

Depends on: campaign, simulation, scenario, fit.targets. For each published number the residual is
ln(computed/published)/tolerance, so that a factor counts the same up and down; the misfit (`search.misfit`) is the mean
of 2(√(1 + r²) − 1), which is r² near agreement and grows linearly far from it: one hopeless number does not rule the
fit. Times over a threshold, which may be zero, are compared as ln((t + ½ s)/…).
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

from tethership.campaign import Cases, fly_blocks, layer_switches
from tethership.scenario import Scenario
from tethership.simulation import CODES, Outcome
from tethership.studies.docking_paper.fit.space import named_values
from tethership.studies.docking_paper.fit.targets import Row, fitted_rows

TOLERANCES = {
    "tension_max": 0.18,
    "tension_mean": 0.18,
    "E": 0.18,
    "ADC": 0.18,
    "theta_rms": 0.18,
    "seconds_above": 0.5,
}
"""Tolerance of each metric's logarithm [-]: 0.18 is 20 %, within which a verdict is *agrees*; a time over a threshold
hangs on few snaps of the cable and is given 65 %."""

SECONDS = 0.5
"""Time added to times over a threshold before their ratio is taken [s]."""

TIMED = 2
"""Thresholds whose times are fitted: 144.3 N and 481 N; above the others the paper has 0.03 s at most."""

FAILED = 15.0
"""Residual of every number of a flight that did not go on to its end, in tolerances: as far off as a peak 15 times the
published one, so that to fail is never better than to fit badly."""

TIME_LIMIT = 75.0
"""Longest flight of a fit [s]: the paper's take 61.67 to 66.07 s, and a batch goes on until its last flight ends."""

WHOLE = (CODES.index(Outcome.docked), CODES.index(Outcome.time_limit))
"""Outcomes of flights whose numbers are compared."""


class Item(NamedTuple):
    """One number that is fitted.

    Attributes
    ----------
    table : str
    wind : float
        [m/s].
    metric : str
        With the threshold's place for times, `seconds_above.0`.
    published : float
        In the metric's unit: a tension [N], ADC [1/s], E [-], θ_rms [deg], a time [s].
    tolerance : float
        Of the logarithm [-].
    """

    table: str
    wind: float
    metric: str
    published: float
    tolerance: float


def items(rows: Sequence[Row] | None = None) -> tuple[Item, ...]:
    """Return all numbers that are fitted, row by row, with their tolerances [-].

    Raises
    ------
    ConfigError
        A row is held out.
    """
    found = []
    for row in fitted_rows(rows):
        for metric, tolerance in TOLERANCES.items():
            value = row.values[metric]
            if isinstance(value, list):
                found += [Item(row.table, row.wind, f"{metric}.{i}", float(value[i]), tolerance) for i in range(TIMED)]
            else:
                found.append(Item(row.table, row.wind, metric, float(value), tolerance))
    return tuple(found)


def fly_rows(
    scenario: Scenario,
    values: np.ndarray,
    rows: Sequence[Row],
    more: Mapping[str, np.ndarray] | None = None,
) -> list[dict[str, np.ndarray]]:
    """Return the metrics of every row's flight for every vector of unknowns.

    Parameters
    ----------
    scenario : Scenario
        Docking; its gains are the paper's.
    values : ndarray
        Unknowns in SI [m², m, -, N], shape (vectors, unknowns).
    rows : sequence of Row
        Winds and layers to be flown.
    more : mapping, optional
        Further columns, by dotted name [SI].

    Notes
    -----
    Cables do not break in a fit and flights are cut off at `TIME_LIMIT`, so that a bad vector still says how bad.

    Returns
    -------
    list of dict
        One per row, arrays with the vector first: tensions [N], times [s], angles [deg], ADC [1/s], E [-].

    Raises
    ------
    ConfigError
        A row is held out.
    """
    columns = {**named_values(values), **(more or {})}
    blocks = [
        Cases.of({**columns, "wind.speed": row.wind, **layer_switches(scenario, row.layers)}, len(values))
        for row in fitted_rows(rows)
    ]
    return fly_blocks(scenario.changed({"stop.time_limit": TIME_LIMIT}), blocks, unbreakable=True)


def residuals(flown: Sequence[dict[str, np.ndarray]], rows: Sequence[Row], what: Sequence[Item]) -> np.ndarray:
    """Return residuals ln(computed/published)/tolerance [-], shape (vectors, items).

    Parameters
    ----------
    flown : sequence of dict
        From `fly_rows`.
    rows : sequence of Row
        The same rows.
    what : sequence of Item
        What is fitted.

    Notes
    -----
    To a time over a threshold, and to its published value, `SECONDS` [s] are added. A flight that did not go on to its
    end has `FAILED`.
    """
    place = {(row.table, row.wind): i for i, row in enumerate(rows)}
    columns = []
    for item in what:
        metrics = flown[place[item.table, item.wind]]
        name, _, which = item.metric.partition(".")
        value = metrics[name][:, int(which)] if which else metrics[name]
        offset = SECONDS if which else 1e-9
        ratio = (np.maximum(value, 0.0) + offset) / (item.published + offset)
        residual = np.log(ratio) / item.tolerance
        whole = np.isin(metrics["outcome"], WHOLE) & np.isfinite(residual)
        columns.append(np.where(whole, residual, FAILED))
    return np.stack(columns, axis=-1)
