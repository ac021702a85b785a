"""Fly the regression flights and compare with flights.json; `--write` replaces it. Dry by default.

A change of a number is entered in CHANGELOG.md under *Numbers that changed*, with its reason.
"""

import json
import sys
from pathlib import Path

import tethership as ts

REFERENCE = Path(__file__).parent / "flights.json"

FIRST_GUESS_FINS = {f"vehicle.fins.{i}.efficiency": 12.0 / (2.88 * 5.73) for i in range(4)}
"""S C_Nα η_f = 12 m² per fin: the first guess for `published` (the paper leaves the fins open)."""

CASES = {
    "consistent 6 rewind": ({"wind.speed": 6.0}, ("rewind",)),
    "consistent 12 rewind heading": ({"wind.speed": 12.0}, ("rewind", "heading")),
    "published 12 rewind": ({"wind.speed": 12.0, "formulation": "published", **FIRST_GUESS_FINS}, ("rewind",)),
}

KEYS = ("tension_max", "tension_mean", "rewind_rate_min", "ADC", "E", "theta_rms", "clearance_min")


def flown(name: str) -> dict[str, float | str]:
    """Return outcome and metrics of one case."""
    changes, layers = CASES[name]
    scenario = ts.load_scenario("docking", changes)
    flight = ts.dock(scenario, ts.trim(scenario), layers)
    numbers = {key: flight.metrics[key] for key in KEYS}
    return {"outcome": flight.outcome.name, "flight_time": float(flight.data["time"][-1]), **numbers}


def differences(found: dict, reference: dict) -> list[str]:
    """Return what differs by more than 0.5 %: the accuracy to which flights are computed (benchmarks/README.md)."""
    wrong = []
    for key, value in reference.items():
        same = (
            found[key] == value if isinstance(value, str) else abs(found[key] - value) <= 5e-3 * max(abs(value), 0.01)
        )
        if not same:
            wrong.append(f"{key}: {found[key]} instead of {value}")
    return wrong


if __name__ == "__main__":
    reference = json.loads(REFERENCE.read_text()) if REFERENCE.exists() else {}
    found = {name: flown(name) for name in CASES}
    for name, numbers in found.items():
        print(name, differences(numbers, reference.get(name, {})) or "same", numbers)
    if "--write" in sys.argv:
        REFERENCE.write_text(json.dumps(found, indent=1) + "\n")
