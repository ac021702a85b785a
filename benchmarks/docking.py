"""One docking flight: × real time, compile and run apart, at a stated accuracy. See README.md for the claim.

Every flight is held against the same flight at 1e-10 (Dopri8, samples every 5 ms); beside it, in the same run, scipy's
LSODA on the same compiled right-hand side. Depends on: tethership, scipy.
"""

import json
import sys
import time

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import scipy.integrate

import tethership as ts
import tethership.simulation.flight as module
from tethership.plant.loop import ClosedLoop
from tethership.scenario import read_solver
from tethership.simulation.docking import start_state

LAYERS = {"rewind": ["rewind"], "heading": ["rewind", "heading"], "navigation": ["rewind", "heading", "navigation"]}
SCALARS = ("tension_max", "tension_mean", "rewind_rate_min", "ADC", "E", "theta_rms")
FLOORS = np.array([1.0, 1.0, 0.01, 0.01, 0.01, 0.1, 1.0, 1.0, 1.0, 1.0, 1.0])
"""Values below these are compared as if they were these: 1 % of 0.1 s above a limit means nothing."""


def metrics(flight: ts.Flight) -> np.ndarray:
    """Return all metrics of Tables 3–6 as one vector."""
    found = flight.metrics
    time_flown = float(flight.data["time"][-1])
    return np.array([*(found[name] for name in SCALARS), time_flown, *found["seconds_above"]])


def best_of(count: int, function):
    """Return the least wall time [s] of several runs, and the last result."""
    best, result = np.inf, None
    for _ in range(count):
        start = time.perf_counter()
        result = function()
        best = min(best, time.perf_counter() - start)
    return best, result


class Compiled:
    """Counts the time spent in the compiled program of a flight: integration, stop conditions, outputs."""

    def __init__(self) -> None:
        self.inner, self.spent = module.fly_segment, 0.0

    def __call__(self, *arguments):
        start = time.perf_counter()
        result = jax.block_until_ready(self.inner(*arguments))
        self.spent += time.perf_counter() - start
        return result

    def best(self, count: int, function) -> float:
        """Return the least time [s] of several runs."""
        least = np.inf
        for _ in range(count):
            self.spent = 0.0
            function()
            least = min(least, self.spent)
        return least


def lsoda(scenario: ts.Scenario, point: ts.TrimPoint, layers: list[str], end: float) -> float:
    """Return the wall time [s] of scipy's LSODA over the same flight, the right-hand side compiled."""
    loop = ClosedLoop(scenario.system, scenario.law(layers), point.command)
    leaves, structure = jax.tree.flatten(eqx.filter(loop, eqx.is_array))
    static = eqx.filter(loop, eqx.is_array, inverse=True)

    @jax.jit
    def field(t, y, leaves):
        return eqx.combine(jax.tree.unflatten(structure, leaves), static).vector_field(t, y)

    start = np.asarray(loop.initial(start_state(scenario, point.state)))
    call = lambda t, y: np.asarray(field(t, y, leaves))  # noqa: E731
    call(0.0, start)
    spent, _ = best_of(
        1,
        lambda: scipy.integrate.solve_ivp(call, (0.0, end), start, method="LSODA", rtol=1e-6, atol=1e-6, max_step=0.25),
    )
    return spent


def case(wind: float, name: str) -> dict:
    """Return the figures of one flight."""
    scenario = ts.load_scenario("docking", {"wind.speed": wind})
    point = ts.trim(scenario)
    settings = read_solver("adaptive")
    fly = lambda: ts.dock(scenario, point, LAYERS[name], solver=settings)  # noqa: E731
    first, _ = best_of(1, fly)
    spent, flight = best_of(15, fly)
    module.fly_segment = compiled = Compiled()
    inside = compiled.best(15, fly)
    module.fly_segment = compiled.inner
    reference = metrics(ts.dock(scenario, point, LAYERS[name], solver="tight"))
    error = np.abs(metrics(flight) - reference) / np.maximum(np.abs(reference), FLOORS)
    flown = float(flight.data["time"][-1])
    return {
        "wind": wind,
        "layers": name,
        "first_call_s": first,
        "run_ms": spent * 1e3,
        "times_real_time": flown / spent,
        "compiled_times_real_time": flown / inside,
        "worst_metric_error_percent": float(error.max() * 100.0),
        "worst_without_ADC_percent": float(np.delete(error, 3).max() * 100.0),
        "misalignment_jumps": flight.metrics["misalignment_jumps"],
        "steps": flight.attributes["steps"],
        "lsoda_times_real_time": flown / lsoda(scenario, point, LAYERS[name], flown),
    }


def main() -> None:
    """Print a line per flight; with --json a list of objects."""
    jnp.zeros(1).block_until_ready()
    rows = [case(wind, name) for wind in (6.0, 12.0) for name in LAYERS]
    if "--json" in sys.argv:
        print(json.dumps(rows))
        return
    print(" ".join(f"{key:>26}" for key in rows[0]))
    for row in rows:
        print(" ".join(f"{value:>26.5g}" if isinstance(value, float) else f"{value:>26}" for value in row.values()))


if __name__ == "__main__":
    main()
