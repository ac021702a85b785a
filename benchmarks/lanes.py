"""Lanes beside XLA and scipy: one batch, one run, CPU seconds; what making a program takes; growth with the plant.

Depends on: tethership, scipy. CPU seconds of the process, for the machine is shared: × real time of one core. See
README.md for the claims.
"""

import json
import resource
import sys
import time
from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import scipy.integrate

import tethership as ts
from tethership.campaign.engine import Terms, by_lanes, by_xla, compile_flights
from tethership.campaign.flights import Flyer
from tethership.campaign.plan import make_plan
from tethership.lanes.compiler import widest
from tethership.simulation import differing, metrics_of

FLIGHTS = 168
STEP = 0.05
SCENARIOS = ("docking", "docking_paper", "docking_retuned", "hover", "cruise", "side_cables", "three_lines", "aerostat")
METRICS = ("tension_max", "tension_mean", "E", "theta_rms", "flight_time")


class Ready:
    """Flights of one scenario, trimmed and ready to be flown by any engine."""

    def __init__(self, scenario: ts.Scenario, names: tuple[str, ...], values: np.ndarray) -> None:
        self.flyer = Flyer(scenario, names, values[0], len(values), STEP)
        self.terms: Terms = self.flyer.terms
        self.loops, self.vectors, _ = self.flyer.prepare(values)

    @classmethod
    def campaign(cls, name: str) -> "Ready":
        """Return the first flights of a packaged campaign."""
        plan = make_plan(name)
        return cls(plan.scenario, plan.names, plan.values[0, :FLIGHTS])

    @classmethod
    def packaged(cls, name: str, **changes: Any) -> "Ready":
        """Return flights of a packaged scenario whose starts and winds differ a little."""
        scenario = ts.load_scenario(name, {"stop.time_limit": 60.0, **changes})
        names = ("start.attitude_offset.0", "start.attitude_offset.1", "wind.speed")
        spread = np.random.default_rng(0).uniform(-1.0, 1.0, (FLIGHTS, 3)) * [0.03, 0.03, 0.02]
        return cls(scenario, names, spread + np.array([0.0, 0.0, scenario.config.wind.speed]))


def flown(engine: Any, ready: Ready, threads: int = 1) -> tuple[float, dict[str, np.ndarray]]:
    """Return × real time by CPU seconds (best of three), and the metrics."""
    spent, found = np.inf, {}
    for _ in range(3):
        begun = time.process_time()
        result = jax.block_until_ready(engine(ready.loops, ready.vectors, threads))
        spent = min(spent, time.process_time() - begun)
        found = metrics_of(result)
    return float(found["flight_time"].sum()) / spent, found


def made(ready: Ready, width: int) -> tuple[Any, dict[str, float]]:
    """Return a program of a width, made without what was kept, and what making it took."""
    begun, before = time.process_time(), resource.getrusage(resource.RUSAGE_CHILDREN)
    program = compile_flights(ready.loops, ready.vectors, ready.terms, width)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    compiler = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return program, {
        "statements": program.recipe.statements,
        "trace_and_write_s": time.process_time() - begun,
        "compiler_s": compiler,
    }


def apart(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> dict[str, list[float]]:
    """Return the median and the largest relative difference of each metric."""
    found = {}
    for name in METRICS:
        difference = np.abs(one[name] - other[name]) / np.maximum(np.abs(other[name]), 1e-12)
        found[name] = [float(np.median(difference)), float(np.max(difference))]
    return found


def scipy_rate(ready: Ready) -> float:
    """Return × real time of scipy's LSODA on the same compiled right-hand side, one flight."""
    loop = jax.tree.map(lambda leaf: leaf[..., 0] if eqx.is_array(leaf) else leaf, ready.loops)
    field = eqx.filter_jit(lambda t, y: loop.vector_field(t, y))
    slope = lambda t, y: np.asarray(field(jnp.asarray(t), jnp.asarray(y)))  # noqa: E731
    start = np.asarray(ready.vectors[:, 0])
    slope(0.0, start)
    begun = time.process_time()
    found = scipy.integrate.solve_ivp(slope, (0.0, 30.0), start, "LSODA", rtol=1e-6, atol=1e-8)
    return float(found.t[-1]) / (time.process_time() - begun)


def campaign(name: str) -> dict[str, Any]:
    """Return the figures of one packaged campaign's flights."""
    ready = Ready.campaign(name)
    begun = time.process_time()
    xla_engine = by_xla(differing(ready.loops), ready.terms)
    jax.block_until_ready(xla_engine(ready.loops, ready.vectors, 1))
    first = time.process_time() - begun
    xla, reference = flown(xla_engine, ready)
    result: dict[str, Any] = {
        "xla": {"x_real_time": xla, "first_call_s": first},
        "scipy_x_real_time": scipy_rate(ready),
    }
    for width in sorted({4, widest()}):
        program, cost = made(ready, width)
        rate, found = flown(by_lanes(program, ready.terms), ready)
        result[f"lanes of {width}"] = {
            "x_real_time": rate,
            "over_xla": rate / xla,
            **cost,
            "apart": apart(found, reference),
        }
    return result


def growth() -> list[dict[str, Any]]:
    """Return statements, speed and time to make of every packaged scenario: cables, thrusters and parts differ."""
    rows = []
    for name in SCENARIOS:
        ready = Ready.packaged(name)
        program, cost = made(ready, widest())
        rate, _ = flown(by_lanes(program, ready.terms), ready)
        plant = ready.loops.plant
        rows.append(
            {"scenario": name, "cables": len(plant.cables), "states": len(ready.vectors), "x_real_time": rate, **cost}
        )
    return rows


def main() -> None:
    """Print the figures; with --json as one object."""
    result = {"gusts": campaign("gusts"), "growth": growth()}
    print(json.dumps(result) if "--json" in sys.argv else json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
