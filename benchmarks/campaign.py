"""Campaigns: × real time and what the steps cost, evenness of batches, scaling, and a loop over scipy beside it.

Depends on: tethership, scipy. The packaged campaign `gusts`, whose distributions hold hard cases: snapping cables,
broken ones, flights that end at the time limit. See README.md for the claims.
"""

import json
import shutil
import sys
import tempfile
import time
from pathlib import Path

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import scipy.integrate

import tethership as ts
from tethership.campaign.answers import exceeded, step_error
from tethership.campaign.execute import fly_campaign, in_processes, in_this_process
from tethership.campaign.flights import BATCH, Flyer
from tethership.campaign.plan import Plan, make_plan
from tethership.campaign.store import CampaignStore, open_results
from tethership.plant.loop import ClosedLoop
from tethership.scenario.laws import build_law
from tethership.simulation.docking import start_state

SAMPLES = 1000
LOOPED = 6
"""Cases that the loop over scipy flies."""

STEPS = (0.05, 0.0625, 0.07)
"""Steps [s] whose speed is set beside their error; the first is the default."""

FINE = 0.0125
"""Step [s] against whose flights those are counted that come to lie on the other side of a limit."""


def flown(plan: Plan, hands: object) -> tuple[float, Path]:
    """Return wall seconds of a campaign and its folder."""
    folder = Path(tempfile.mkdtemp())
    store = CampaignStore(folder, plan)
    with hands as ready:
        begun = time.perf_counter()
        fly_campaign(plan, store, ready)
        return time.perf_counter() - begun, folder


def batch_times(plan: Plan) -> list[float]:
    """Return wall seconds of each whole batch, one after the other."""
    flyer = Flyer(plan.scenario, plan.names, plan.values[0, 0], plan.lanes, plan.config.step)
    spent = []
    for number in range(plan.batches):
        values = plan.batch(number).values
        if len(values) == plan.lanes:
            begun = time.perf_counter()
            flyer.fly(values)
            spent.append(time.perf_counter() - begun)
    return spent


def stepped(samples: int, step: float, **changes: float) -> tuple[float, dict[str, np.ndarray], dict[str, object]]:
    """Return × real time with a step, which flights exceed each limit, and errors beside adaptive flights."""
    plan = make_plan("gusts", {"samples": samples, "step": {"value": step, "unit": "s"}, "verified": 0.0, **changes})
    seconds, folder = flown(plan, in_this_process())
    data = open_results(folder)
    shutil.rmtree(folder)
    return float(np.nansum(data["flight_time"])) / seconds, exceeded(plan, data), step_error(data)


def by_step(samples: int) -> dict[float, dict[str, object]]:
    """Return for each step its speed (best of three), worst median error, and flights on another side of a limit."""
    _, fine, _ = stepped(samples, FINE)
    found = {}
    for step in STEPS:
        runs = [stepped(samples, step) for _ in range(3)]
        errors = stepped(samples, step, verified=0.1)[2]
        found[step] = {
            "x_real_time": max(run[0] for run in runs),
            "slowest_x_real_time": min(run[0] for run in runs),
            "worst_median_error": max(e["median"] for e in errors.values() if isinstance(e, dict)),
            "crossed": {name: int(np.sum(runs[0][1][name] != fine[name])) for name in fine},
        }
    return found


def scipy_rate(plan: Plan) -> float:
    """Return × real time of a loop over scipy's LSODA on the same compiled right-hand side."""
    simulated = spent = 0.0
    for case in range(LOOPED):
        here = ts.scenario_at(plan.scenario, dict(zip(plan.names, map(float, plan.values[0, case]), strict=True)))
        point = ts.trim(here)
        loop = ClosedLoop(here.system, build_law(here.config), point.command)
        field = eqx.filter_jit(lambda t, y, loop=loop: loop.vector_field(t, y))
        start = np.asarray(loop.initial(start_state(here, point.state)))
        slope = lambda t, y, field=field: np.asarray(field(jnp.asarray(t), jnp.asarray(y)))  # noqa: E731
        docked = lambda t, y: y[12] - 1.5  # noqa: E731
        docked.terminal = True
        slope(0.0, start)
        begun = time.perf_counter()
        found = scipy.integrate.solve_ivp(slope, (0.0, 75.0), start, "LSODA", rtol=1e-6, atol=1e-8, events=docked)
        spent += time.perf_counter() - begun
        simulated += float(found.t[-1])
    return simulated / spent


def flop_bound(plan: Plan) -> tuple[float, float]:
    """Return floating-point operations of a flight's second, and operations a second that this machine multiplies."""
    here = plan.scenario
    point = ts.trim(here)
    loop = ClosedLoop(here.system, build_law(here.config), point.command)
    start = loop.initial(start_state(here, point.state))
    lowered = jax.jit(lambda t, y: loop.vector_field(t, y)).lower(jnp.zeros(()), start).compile()
    each = float(lowered.cost_analysis()["flops"])
    size = 1500
    matrix = np.random.default_rng(0).random((size, size))
    best = np.inf
    for _ in range(5):
        begun = time.perf_counter()
        matrix @ matrix
        best = min(best, time.perf_counter() - begun)
    return each * 4.0 / plan.config.step, 2.0 * size**3 / best


def main() -> None:
    """Print the figures; with --json as one object."""
    samples = int(sys.argv[sys.argv.index("--samples") + 1]) if "--samples" in sys.argv else SAMPLES
    bare = {"verified": 0.0}
    flown(make_plan("gusts", {"samples": 2 * BATCH, **bare}), in_this_process())
    result: dict[str, object] = {"cases": {}, "workers": {}}
    for count in (samples // 4, samples // 2, samples, 2 * samples):
        plan = make_plan("gusts", {"samples": count, **bare})
        seconds, folder = flown(plan, in_this_process())
        simulated = float(np.nansum(open_results(folder)["flight_time"]))
        shutil.rmtree(folder)
        result["cases"][count] = {
            "seconds": seconds,
            "x_real_time": simulated / seconds,
            "flights_per_s": count / seconds,
        }
    plan = make_plan("gusts", {"samples": samples, **bare})
    spent = batch_times(plan)
    result["worst_over_best_batch"] = max(spent) / min(spent)
    for workers in (1, 2):
        with in_processes(workers) as hands:
            warm = make_plan("gusts", {"samples": 6 * BATCH, **bare})  # so that every worker has flown one
            folder = Path(tempfile.mkdtemp())
            fly_campaign(warm, CampaignStore(folder, warm), hands)
            folder = Path(tempfile.mkdtemp())
            begun = time.perf_counter()
            fly_campaign(plan, CampaignStore(folder, plan), hands)
            result["workers"][workers] = time.perf_counter() - begun
    checked = make_plan("gusts", {"samples": samples, "verified": 0.05})
    _, folder = flown(checked, in_this_process())
    result["step_error"] = step_error(open_results(folder))
    result["steps"] = by_step(samples)
    result["scipy_x_real_time"] = scipy_rate(plan)
    needed, peak = flop_bound(plan)
    result["flops_per_flight_second"], result["machine_flops"] = needed, peak
    result["share_of_flop_bound"] = result["cases"][samples]["x_real_time"] * needed / peak
    print(json.dumps(result) if "--json" in sys.argv else json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
