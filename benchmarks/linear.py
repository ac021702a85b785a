"""Linear models: one exact A, U; trimmed, linearised and tracked points per second; beside JSBSim's linearisation.

Claims: one A, U in at most 0.2 ms after compiling; at least 5 000 points per second in a sweep of 1 000 with trim,
eigenvectors and tracks. Accuracy: exact derivatives; the largest difference of two routes is printed.
Run: python benchmarks/linear.py
"""

import statistics
import time

import jax
import jax.numpy as jnp
import jsbsim
import numpy as np
from jax.flatten_util import ravel_pytree

import tethership as ts
from tethership.analysis import linearize
from tethership.analysis.linear.linearize import Matrices, differentiate
from tethership.analysis.linear.right_side import input_vector

REPEATS = 7


def timed(work, repeats=REPEATS):
    """Return the median time [s] of several calls."""
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def one_model(scenario, point):
    """Return times [s] of one exact A, U: a compiled call, inside the compiled program, and `linearize` itself."""
    flat, rebuild = ravel_pytree(scenario.system)
    state, inputs = point.state.as_vector(), input_vector(scenario.system, point.command)

    @jax.jit
    def repeated(numbers, vector, others, count):
        zero = Matrices(jnp.zeros((12, 12)), jnp.zeros((12, len(others))))

        def again(_, before):  # depends on the last one, so that it cannot be hoisted out of the loop
            return differentiate(rebuild(numbers), vector + 0.0 * before.state[0], others)

        return jax.lax.fori_loop(0, count, again, zero)

    def call(count):
        jax.block_until_ready(repeated(flat, state, inputs, count))

    call(1)
    single = timed(lambda: call(1), 200)
    inside = (timed(lambda: call(201)) - timed(lambda: call(1))) / 200.0
    linearize(scenario, point)
    return single, inside, timed(lambda: linearize(scenario, point), 50)


def points_per_second(scenario, values):
    """Return points per second of a sweep over the wind, everything included."""
    ts.sweep(scenario, {"wind.speed": values})
    return len(values) / timed(lambda: ts.sweep(scenario, {"wind.speed": values}))


def with_jsbsim(name="c172x"):
    """Return the times [s] of JSBSim's trim and linearisation of one of its own aircraft."""
    fdm = jsbsim.FGFDMExec(jsbsim.get_default_root_dir())
    fdm.set_debug_level(0)
    fdm.load_model(name)
    fdm["ic/h-sl-ft"], fdm["ic/vc-kts"] = 3000.0, 90.0
    fdm["propulsion/set-running"] = -1
    fdm.run_ic()
    start = time.perf_counter()
    fdm["simulation/do_simple_trim"] = 1
    trimmed = time.perf_counter() - start
    return trimmed, timed(lambda: jsbsim.FGLinearization(fdm), 3)


def main():
    """Print one row per claim."""
    trimmed, linearised = with_jsbsim()
    print(f"JSBSim {jsbsim.__version__} c172x: trim {trimmed * 1e3:.0f} ms, linearisation {linearised * 1e3:.0f} ms")
    for formulation in ("consistent", "published"):
        scenario = ts.load_scenario("docking", {"formulation": formulation})
        point = ts.trim(scenario)
        single, inside, whole = one_model(scenario, point)
        exact, paper = linearize(scenario, point), linearize(scenario, point, "semi_analytic")
        rate = points_per_second(scenario, np.linspace(6.0, 12.0, 1000))
        print(
            f"{formulation}: one A, U {single * 1e3:.3f} ms a call, {inside * 1e6:.0f} µs inside the program, "
            f"linearize() {whole * 1e3:.2f} ms; JSBSim / call = {linearised / single:.0f}; "
            f"sweep of 1 000: {rate:.0f} points/s; routes differ by {np.abs(exact.A - paper.A).max():.1e}"
        )


if __name__ == "__main__":
    main()
