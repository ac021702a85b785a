"""One compiled program flies every set of layers, with SAS or without, gusts or none: switches are arrays.

If this fails, a user waits for seconds at every other set, and a campaign compiles anew.
"""

from contextlib import contextmanager

import jax
import numpy as np
import pytest

import tethership as ts
from tethership.physics.gust import CosineGust

COMPILED = "/jax/core/compile/backend_compile_duration"


@contextmanager
def counted():
    """Count the programs that are compiled, or fetched from the cache of compiled ones, in between."""
    seen = []

    def listener(event, duration, **_):
        if event == COMPILED:
            seen.append(duration)

    jax.monitoring.register_event_duration_secs_listener(listener)
    yield seen
    jax.monitoring.unregister_event_duration_listener(listener)


def test_a_program_is_counted():
    with counted() as seen:
        jax.jit(lambda x: x * 1.25 + 0.75)(np.ones(3))
    assert len(seen) == 1


def test_layers_sas_and_gusts_are_switches():
    with_gust = ts.load_scenario("docking")
    without = with_gust.changed({"gusts": []})
    turned = with_gust.changed({"gusts.0.turn": 1.0, "gusts.0.start": 3.0})
    points = [ts.trim(scenario) for scenario in (with_gust, without, turned)]
    ts.fly(with_gust, points[0], stop=1.0, layers=())
    CosineGust.silent()  # its arrays are placed by programs of a line, not by that of a flight
    sets = [(with_gust, points[0], ("rewind", "heading"), True), (turned, points[2], ("navigation",), False)]
    sets += [(without, points[1], (), False), (without, points[1], ("rewind", "heading", "navigation"), True)]
    with counted() as more:
        for scenario, point, layers, sas in sets:
            ts.fly(scenario, point, stop=1.0, layers=layers, sas=sas)
    assert more == []


def test_a_silent_gust_is_no_gust():
    plain = ts.load_scenario("docking", {"gusts": []}).system.environment
    switched = plain.with_a_gust()
    assert len(switched.gusts) == 1
    position, velocity, axis = np.array([1.0, 2.0, -9.0]), np.array([0.3, 0.0, 0.1]), np.array([1.0, 0.0, 0.0])
    for time in (0.0, 20.0, 1e5):
        one, other = (air.air(position, velocity, axis, jax.numpy.asarray(time)) for air in (plain, switched))
        assert all(np.array_equal(a, b) for a, b in zip(jax.tree.leaves(one), jax.tree.leaves(other), strict=True))


def test_a_silent_gust_has_finite_slopes():
    gust = CosineGust.silent()
    slopes = jax.jacfwd(lambda g, t: g.velocity(t), argnums=(0, 1))(gust, jax.numpy.asarray(3.0))
    assert all(np.isfinite(leaf).all() for leaf in jax.tree.leaves(slopes))


@pytest.mark.parametrize("count", [1, 2])
def test_gusts_that_are_there_stay_as_they_are(count):
    scenario = ts.load_scenario("docking")
    gusts = scenario.document["gusts"] * count
    environment = scenario.changed({"gusts": gusts}).system.environment
    assert environment.with_a_gust() is environment
