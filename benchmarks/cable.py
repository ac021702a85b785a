"""Cable forces per second, against MoorPy in the same run. See README.md for the claim.

Depends on: tethership, moorpy (pip install "tethership[bench]").
"""

import json
import sys
import time

import jax
import jax.numpy as jnp
import moorpy.Catenary
import numpy as np

import tethership as ts

SIZE = 100_000
LENGTH = 20.0


def geometries(seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return spans [m] and winds [m/s], shape (3, SIZE): slack, plumb, near-taut and taut in equal parts, e ≤ 1.04."""
    random = np.random.default_rng(seed)
    quarter = SIZE // 4
    direction = random.normal(size=(3, SIZE))
    direction /= np.linalg.norm(direction, axis=0)
    plumb = slice(quarter, 2 * quarter)
    direction[:2, plumb] *= 10.0 ** random.uniform(-12, -2, quarter)
    direction[:, plumb] /= np.linalg.norm(direction[:, plumb], axis=0)
    elongation = np.concatenate(
        [
            random.uniform(0.0, 0.98, quarter),
            random.uniform(0.0, 1.04, quarter),
            1.0 + random.uniform(-2e-2, 2e-2, quarter),
            random.uniform(1.0, 1.04, SIZE - 3 * quarter),
        ]
    )
    winds = random.normal(size=(3, SIZE)) * 5.0
    return LENGTH * elongation * direction, winds


def ours(span: jax.Array, wind: jax.Array, scenario: ts.Scenario) -> jax.Array:
    """Return the force of one cable on the ship [N], load included."""
    cable = scenario.system.cables[0]
    load = cable.load.per_length(jnp.asarray(1.225), -wind, span)
    return cable.law.force(span, jnp.asarray(LENGTH), load).ship


def closure(span: jax.Array, wind: jax.Array, scenario: ts.Scenario) -> jax.Array:
    """Return by how much the integrated curve misses the ship's end, over L."""
    cable = scenario.system.cables[0]
    load = cable.load.per_length(jnp.asarray(1.225), -wind, span)
    length = jnp.asarray(LENGTH)
    end = cable.law.shape(span, length, load, length[None])[0]
    return jnp.linalg.norm(end - span) / LENGTH


def rate(function, *arguments) -> tuple[float, np.ndarray]:
    """Return evaluations per second, best of seven, and the values."""
    values = jax.block_until_ready(function(*arguments))
    best = np.inf
    for _ in range(7):
        start = time.perf_counter()
        jax.block_until_ready(function(*arguments))
        best = min(best, time.perf_counter() - start)
    return SIZE / best, np.asarray(values)


def moorpy_rate(span: np.ndarray, count: int = 2000) -> tuple[float, int, float]:
    """Return MoorPy's evaluations per second under weight alone, its failures, and its largest relative difference."""
    stiffness, weight = 69_760.0, 0.08 * 9.80665
    picked = span[:, :: span.shape[1] // count][:, :count]
    law = jax.jit(
        jax.vmap(
            lambda d: (
                ts.physics.cable.ElasticCatenary(jnp.asarray(stiffness))
                .force(d, jnp.asarray(LENGTH), jnp.array([0.0, 0.0, weight]))
                .ship
            ),
            in_axes=-1,
            out_axes=-1,
        )
    )
    reference = np.linalg.norm(np.asarray(law(picked)), axis=0)
    failed, worst = 0, 0.0
    start = time.perf_counter()
    found = []
    for north, east, down in picked.T:
        try:
            found.append(moorpy.Catenary.catenary(np.hypot(north, east), -down, LENGTH, stiffness, weight, CB=-1e9))
        except Exception:
            found.append(None)
    spent = time.perf_counter() - start
    for result, ours_here, vector in zip(found, reference, picked.T, strict=True):
        if result is None or not np.isfinite(result[3]):
            failed += 1
            continue
        upper = np.hypot(result[2], result[3])
        difference = abs(upper / ours_here - 1.0) if vector[2] <= 0 else 0.0
        worst = max(worst, difference)
    return count / spent, failed, worst


def main() -> None:
    """Print the figures; with --json as one object."""
    scenario = ts.load_scenario("docking")
    span, wind = geometries(0)
    compiled = jax.jit(jax.vmap(lambda d, v: ours(d, v, scenario), in_axes=-1, out_axes=-1))
    per_second, force = rate(compiled, jnp.asarray(span), jnp.asarray(wind))
    miss = jax.jit(jax.vmap(lambda d, v: closure(d, v, scenario), in_axes=-1))(span, wind)
    peer, failed, worst = moorpy_rate(span)
    result = {
        "ours_per_second": per_second,
        "ours_not_finite": int((~np.isfinite(force)).any(axis=0).sum()),
        "worst_end_miss_over_length": float(np.max(miss)),
        "moorpy_per_second": peer,
        "moorpy_failed": failed,
        "worst_difference_where_ship_is_above": worst,
        "ratio": per_second / peer,
    }
    if "--json" in sys.argv:
        print(json.dumps(result))
        return
    for name, value in result.items():
        print(f"{name:<40} {value:,.6g}")


if __name__ == "__main__":
    main()
