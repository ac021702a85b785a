"""Tables 3–6 of the paper: published beside computed, with ratio and verdict.

Depends on: fit.targets, simulation, flights_read. A verdict is *agrees* within 20 % (times of docking
within 2 %), *near* within a factor 1.5 (4 %), else *differs*. The rows at 9 m/s were held out of the fit: their
computed numbers are predictions, and are counted apart.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from tethership.simulation import Flight
from tethership.studies.docking_paper.fit.targets import TABLES, Row, published_rows
from tethership.studies.docking_paper.flights_read import FlightKey

AGREES, NEAR = 1.2, 1.5
"""Largest factor of a number that agrees, or is near."""

TIME_AGREES, TIME_NEAR = 1.02, 1.04
"""The same of a docking time."""

NOTHING = 0.05
"""A time over a threshold below this is none [s]."""

PAPER_TABLES = {
    "table3": ("rewind",),
    "table4": ("heading",),
    "table5": ("navigation",),
    "table6": tuple(TABLES),
}
"""Flights of each table of the paper."""

THRESHOLDS = ("144.3 N", "481 N", "2354 N", "3040 N")
"""The four tensions whose exceedance is timed."""

OF_TABLE_6 = ("ADC", "E", "theta_rms")
"""Metrics of Table 6; the others are of Tables 3–5."""


def verdict(metric: str, published: float, computed: float | None) -> str:
    """Return *agrees*, *near* or *differs* for a metric by its name.

    Parameters
    ----------
    metric : str
        As in `results.docking_metrics`; times over a threshold begin with `seconds_above`.
    published, computed : float
        The same unit, a tension [N], a time [s] and so on; None where the flight gave no such number.
    """
    if computed is None:
        return "differs"
    if metric.startswith("seconds_above") and min(published, computed) < NOTHING:
        return "agrees" if max(published, computed) < 2.0 * NOTHING else "differs"
    if published <= 0.0 or computed <= 0.0:
        return "agrees" if published == computed else "differs"
    factor = max(published / computed, computed / published)
    agrees, near = (TIME_AGREES, TIME_NEAR) if metric == "docking_time" else (AGREES, NEAR)
    return "agrees" if factor <= agrees else "near" if factor <= near else "differs"


def computed_numbers(flight: Flight) -> dict[str, float | None]:
    """Return the numbers of a flight by the names of the tables' columns.

    They are in SI, tensions [N], rates [m/s], times [s], ADC [1/s], E [-], but θ_rms in degrees [deg].

    Notes
    -----
    A flight that did not dock has no docking time; its other numbers are those up to its end, which its outcome tells.
    """
    metrics = flight.metrics
    names = ("tension_max", "tension_mean", "rewind_rate_min")
    times = {f"seconds_above {limit}": metrics["seconds_above"][i] for i, limit in enumerate(THRESHOLDS)}
    return {
        **{name: metrics[name] for name in names},
        **times,
        "docking_time": flight.docking_time,
        **{name: metrics[name] for name in OF_TABLE_6},
    }


def published_numbers() -> dict[FlightKey, dict[str, float]]:
    """Return the published numbers of each flight, by table and wind [m/s], in the units of `computed_numbers`."""
    return {(row.table, row.wind): _named(row) for row in published_rows()}


def held_out() -> frozenset[FlightKey]:
    """Return the flights, by table and wind [m/s], whose published numbers were not fitted."""
    return frozenset((row.table, row.wind) for row in published_rows() if row.held_out)


def _named(row: Row) -> dict[str, float]:
    """Return a row's numbers by the names of the tables' columns."""
    values: dict[str, float] = {name: value for name, value in row.values.items() if not isinstance(value, list)}
    times = row.values["seconds_above"]
    assert isinstance(times, list)
    return values | {f"seconds_above {limit}": value for limit, value in zip(THRESHOLDS, times, strict=True)}


def compare(flights: Mapping[FlightKey, Flight]) -> dict[str, list[dict[str, Any]]]:
    """Return the rows of every flight by its table's key.

    A row has layers, wind [m/s], metric, published and computed (in the metric's unit), ratio [-], verdict, held_out
    and outcome.

    Parameters
    ----------
    flights : mapping
        By table and wind [m/s], of those in the paper's tables.
    """
    published, apart = published_numbers(), held_out()
    rows: dict[str, list[dict[str, Any]]] = {table: [] for table in TABLES}
    for key, flight in flights.items():
        table, wind = key
        for metric, computed in computed_numbers(flight).items():
            given = published[key][metric]
            rows[table].append(
                {
                    "layers": table,
                    "wind": wind,
                    "metric": metric,
                    "published": given,
                    "computed": computed,
                    "ratio": computed / given if given and computed is not None else None,
                    "verdict": verdict(metric, given, computed),
                    "held_out": key in apart,
                    "outcome": flight.outcome.name,
                }
            )
    return rows


def paper_tables(rows: Mapping[str, Sequence[dict[str, Any]]]) -> dict[str, list[dict[str, Any]]]:
    """Return the rows by the paper's tables, `table3` to `table6`."""
    found = {}
    for name, keys in PAPER_TABLES.items():
        sixth = name == "table6"
        found[name] = [row for key in keys for row in rows[key] if (row["metric"] in OF_TABLE_6) == sixth]
    return found


def counts(rows: Sequence[Mapping[str, Any]]) -> dict[str, Any]:
    """Return how many numbers agree, are near and differ: of the fitted rows, and under `held_out` of the others.

    `prediction` is how many the others are.
    """

    def verdicts(held: bool) -> dict[str, int]:
        mine = [row["verdict"] for row in rows if row["held_out"] == held]
        return {word: mine.count(word) for word in ("agrees", "near", "differs")}

    predicted = verdicts(True)
    return {**verdicts(False), "prediction": sum(predicted.values()), "held_out": predicted}
