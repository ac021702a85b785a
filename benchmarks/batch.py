"""Batches of docking flights: × real time beside single flights in the same run, and how near their metrics come.

Depends on: tethership. Layers and winds of Tables 3–5 at 6 and 12 m/s, perturbed as in the study (attitude ±2°, gust
±1 s, wind ±3 %). See README.md for the claim.
"""

import json
import sys
import time

import numpy as np

import tethership as ts
from tethership.campaign import Cases, fly_cases, layer_switches, perturbed
from tethership.campaign.flights import BATCH
from tethership.studies.docking_paper.fit.targets import TABLES

EACH = BATCH
"""Flights of each row: whole batches, so that no lane flies twice."""

METRICS = ("tension_max", "tension_mean", "E", "theta_rms", "ADC")


def cases(scenario: ts.Scenario) -> Cases:
    """Return all flights, row by row."""
    rows = [
        {**perturbed(scenario.changed({"wind.speed": wind}), EACH, seed=1), **layer_switches(scenario, layers)}
        for layers in TABLES.values()
        for wind in (6.0, 12.0)
    ]
    blocks = [Cases.of(row, EACH) for row in rows]
    return Cases(blocks[0].names, np.concatenate([block.values for block in blocks]))


def main() -> None:
    """Print the figures; with --json as one object."""
    scenario = ts.load_scenario("docking_paper")
    everything = cases(scenario)
    begun = time.perf_counter()
    fly_cases(scenario, everything)
    first = time.perf_counter() - begun
    spent = np.inf
    for _ in range(3):
        begun = time.perf_counter()
        flown = fly_cases(scenario, everything)
        spent = min(spent, time.perf_counter() - begun)
    errors = []
    single = 0.0
    for place in range(0, len(everything.values), 48):
        values = dict(zip(everything.names, everything.values[place], strict=True))
        here = ts.scenario_at(scenario, values)
        point = ts.trim(here)
        ts.dock(here, point)
        begun = time.perf_counter()
        ts.dock(here, point)
        single += float(flown["flight_time"][place]) / (time.perf_counter() - begun)
        reference = ts.dock(here, point, solver="tight").metrics
        errors.append([abs(flown[name][place] / reference[name] - 1.0) for name in METRICS])
    seconds = float(flown["flight_time"].sum())
    result = {
        "flights": len(everything.values),
        "first_call_s": first,
        "run_s": spent,
        "flights_per_s": len(everything.values) / spent,
        "times_real_time": seconds / spent,
        "single_times_real_time": single / len(errors),
        "median_error_percent": dict(zip(METRICS, (100.0 * np.median(errors, axis=0)).round(3).tolist(), strict=True)),
        "largest_error_percent": dict(zip(METRICS, (100.0 * np.max(errors, axis=0)).round(3).tolist(), strict=True)),
    }
    print(json.dumps(result) if "--json" in sys.argv else "\n".join(f"{k:>26} {v}" for k, v in result.items()))


if __name__ == "__main__":
    main()
