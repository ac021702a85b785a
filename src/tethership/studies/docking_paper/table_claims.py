"""Claims D1–D4: Tables 3–6 of the paper, number by number, and the trends that its text reads from them.

Depends on: studies.docking_paper, fit.targets. One function per claim; a claim holds only if every part of it does.
Numbers at 9 m/s were not fitted: there a part judges a prediction.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tethership.simulation import Flight
from tethership.studies.docking_paper.claim import Claim
from tethership.studies.docking_paper.fit.targets import TABLES, published_rows
from tethership.studies.docking_paper.flights_read import (
    CONTROL_THRESHOLD,
    KEYS,
    WINDS,
    FlightKey,
    Flights,
    holds,
    metric,
    read,
    tell,
)

Verdicts = Mapping[str, Sequence[Mapping[str, Any]]]
"""Rows wind, metric, published, computed, ratio, verdict by table (key of `TABLES`)."""

COLUMNS = ("published", "computed", "ratio", "verdict")
"""What is told of a row."""

ACCEPTED = ("agrees", "near")
"""Verdicts with which a number counts as met."""

TABLE_6 = ("ADC", "E", "theta_rms")
"""Metrics of Table 6; all others are of Tables 3–5."""

TIME_SHARE = 0.02
"""How near a docking time must come to print [-].

The longest printed exceeds the shortest possible by 7 %; 2 % tells 66 s from 63 s and forgives a snap of the cable.
"""

TEAR_FORCE = 481.0
"""Force that tears the envelope [N], section 4."""


def claim_1(flights: Flights, verdicts: Verdicts) -> Claim:
    """D1: Table 3. Numbers are in the metrics' units: tensions [N], rates [m/s], times [s]; ratios are [-]."""
    peak = read(flights, metric("tension_max"))
    parts, numbers = _table(flights, verdicts, "rewind")
    parts["peak tension is above the tear force at 12 m/s"] = holds(
        peak, [("rewind", 12.0)], lambda force: force > TEAR_FORCE
    )
    parts["peak tension is below the tear force at 6 m/s"] = holds(
        peak, [("rewind", 6.0)], lambda force: force < TEAR_FORCE
    )
    return Claim("D1", "Table 3, rewind control: usable at the lowest wind only", parts, numbers)


def claim_2(flights: Flights, verdicts: Verdicts) -> Claim:
    """D2: Table 4. Numbers are in the metrics' units: tensions [N], rates [m/s], times [s]; ratios are [-]."""
    peak, indices = read(flights, metric("tension_max")), read(flights, _indices)
    parts, numbers = _table(flights, verdicts, "heading")
    for wind in WINDS:
        parts[f"every index is better than with rewind alone, or as good, at {wind:g} m/s"] = holds(
            indices,
            [("heading", wind), ("rewind", wind)],
            lambda mine, other: all(a <= b + 1e-6 for a, b in zip(mine, other, strict=True)),
        )
    parts["peak tension is still above the tear force at 12 m/s"] = holds(
        peak, [("heading", 12.0)], lambda force: force > TEAR_FORCE
    )
    return Claim("D2", "Table 4, heading control: tension reduced by all indices at every wind", parts, numbers)


def claim_3(flights: Flights, verdicts: Verdicts) -> Claim:
    """D3: Table 5. Numbers are in the metrics' units: tensions [N], rates [m/s], times [s]; ratios are [-]."""
    peak = read(flights, metric("tension_max"))
    parts, numbers = _table(flights, verdicts, "navigation")
    parts["tension stays below 144.3 N at 6 m/s"] = holds(
        peak, [("navigation", 6.0)], lambda force: force < CONTROL_THRESHOLD
    )
    return Claim("D3", "Table 5, navigation: the cable is kept from being drawn taut", parts, numbers)


def claim_4(flights: Flights, verdicts: Verdicts) -> Claim:
    """D4: Table 6: ADC [1/s], E [-], θ_rms [deg]."""
    duty, energy, pitch = (read(flights, metric(name)) for name in TABLE_6)
    parts: dict[str, bool] = {}
    for wind in WINDS:
        rows = [_rows(verdicts, table, wind, of_table_6=True) for table in TABLES]
        parts[f"every number agrees or is near at {wind:g} m/s"] = all(map(_met, rows)) and _docked(
            flights, [(table, wind) for table in TABLES]
        )
    for wind in WINDS:
        parts[f"ADC rises from rewind to heading at {wind:g} m/s"] = holds(duty, _at(wind), lambda r, h, n: r < h)
    for wind in WINDS[:2]:
        parts[f"ADC is lower with navigation than with heading alone at {wind:g} m/s"] = holds(
            duty, _at(wind), lambda r, h, n: n < h
        )
    parts |= {
        "ADC is highest with navigation at 12 m/s": holds(duty, _at(12.0), lambda r, h, n: n > max(r, h)),
        "E is lower with navigation than with rewind at 6 m/s": holds(energy, _at(6.0), lambda r, h, n: n < r),
        "E is higher with navigation than with rewind at 12 m/s": holds(energy, _at(12.0), lambda r, h, n: n > r),
        "θ_rms has no clear trend: the layers rank otherwise at 6 than at 12 m/s": holds(
            pitch, _at(6.0) + _at(12.0), lambda *six: _ranks(six[:3]) != _ranks(six[3:])
        ),
        "θ_rms is lowest with navigation at 6 m/s": holds(pitch, _at(6.0), lambda r, h, n: n < min(r, h)),
        "θ_rms is highest with navigation at 12 m/s": holds(pitch, _at(12.0), lambda r, h, n: n > max(r, h)),
        "θ_rms with navigation at 12 m/s is the highest of all nine flights": holds(
            pitch, [("navigation", 12.0), *KEYS], lambda worst, *every: worst == max(every)
        ),
    }
    numbers = {
        **{f"{table}: published, computed, ratio, verdict": _told(verdicts, table, True) for table in TABLES},
        **{name: tell(flights, found) for name, found in (("ADC [1/s]", duty), ("E", energy), ("θ_rms [deg]", pitch))},
    }
    return Claim("D4", "Table 6: what the layers ask of the thrusters, and the pitch they leave", parts, numbers)


def _table(flights: Flights, verdicts: Verdicts, table: str) -> tuple[dict[str, bool], dict[str, Any]]:
    """Return the parts that Tables 3, 4 and 5 have in common, and their numbers."""
    printed = {(row.table, row.wind): np.max(row.values["docking_time"]) for row in published_rows()}
    time = read(flights, lambda flight: flight.docking_time)
    parts: dict[str, bool] = {}
    for wind in WINDS:
        key, rows = (table, wind), _rows(verdicts, table, wind)
        docked = _docked(flights, [key])
        for name, words in (("tension_max", "peak"), ("tension_mean", "mean")):
            mine = [row for row in rows if row["metric"] == name]
            parts[f"{words} tension agrees or is near at {wind:g} m/s"] = docked and _met(mine)
        parts[f"docking time within 2 % at {wind:g} m/s"] = holds(
            time, [key], lambda value, key=key: abs(value / printed[key] - 1.0) <= TIME_SHARE
        )
        parts[f"every number agrees or is near at {wind:g} m/s"] = docked and _met(rows)
    numbers = {
        "published, computed, ratio, verdict": _told(verdicts, table),
        "docking time [s]": tell(flights, time, [(table, wind) for wind in WINDS]),
        "peak tension [N]": tell(flights, read(flights, metric("tension_max")), [(table, wind) for wind in WINDS]),
    }
    return parts, numbers


def _indices(flight: Flight) -> list[float]:
    """Return the columns of Tables 3–5 of a flight that docked, each the better the lower."""
    found = flight.metrics
    time = float(flight.data["time"][-1])
    return [found["tension_max"], found["tension_mean"], -found["rewind_rate_min"], *found["seconds_above"], time]


def _at(wind: float) -> list[FlightKey]:
    return [(table, wind) for table in TABLES]


def _ranks(values: Sequence[float]) -> list[int]:
    return sorted(range(len(values)), key=lambda i: values[i])


def _docked(flights: Flights, keys: Sequence[FlightKey]) -> bool:
    return len(read(flights, lambda flight: True, keys)) == len(keys)


def _rows(verdicts: Verdicts, table: str, wind: float, of_table_6: bool = False) -> list[Mapping[str, Any]]:
    """Return the rows of Table 3, 4 or 5 at a wind, or a table's part of Table 6."""
    rows = verdicts.get(table, ())
    return [row for row in rows if row["wind"] == wind and (row["metric"] in TABLE_6) == of_table_6]


def _met(rows: Sequence[Mapping[str, Any]]) -> bool:
    """Return whether there are numbers and each is met."""
    return bool(rows) and all(row["verdict"] in ACCEPTED for row in rows)


def _told(verdicts: Verdicts, table: str, of_table_6: bool = False) -> dict[str, list[Any]]:
    """Return the rows of a table in short."""
    return {
        f"{row['metric']} at {wind:g} m/s": [
            _plain(row[name]) for name in ("published", "computed", "ratio", "verdict")
        ]
        for wind in WINDS
        for row in _rows(verdicts, table, wind, of_table_6)
    }


def _plain(value: Any) -> Any:
    """Return a value as JSON has it; None for what is not finite."""
    if value is None or isinstance(value, str):
        return value
    if isinstance(value, list | tuple | np.ndarray):
        return [_plain(item) for item in value]
    return float(value) if math.isfinite(value) else None
