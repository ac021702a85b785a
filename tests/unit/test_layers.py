"""Layers: any laws in any combination, their corrections added, their memories integrated with the plant.

Truth: addition, and kinematics (the integral of the climb rate is the height gained). If this failed, a layer would
switch another off, a law of one's own would be forgotten, or an integral action would start from the wrong place.
"""

import itertools
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Float

import tethership as ts
from tethership.control import AbstractLaw, Correction, LayeredLaw, Measurement
from tethership.plant import Command, State
from tethership.plant.loop import ClosedLoop
from tethership.spatial import rotation_matrix

LAYERS = ("rewind", "heading", "navigation")
SUBSETS = [subset for n in range(4) for subset in itertools.combinations(LAYERS, n)]
CABLES, FINS, THRUSTERS = 1, 4, 6


class Surveyor(AbstractLaw):
    """Remembers how far it climbed and flew, and answers with throttle, fins and winch in proportion.

    Attributes
    ----------
    gain : float
        Throttle of all thrusters per metre climbed [1/m].
    """

    gain: Float[Array, ""]

    def __call__(self, time, measurement, memory):
        rate = {
            "climbed": measurement.rate_of_climb,
            "flown": rotation_matrix(measurement.attitude) @ measurement.velocity,
        }
        correction = Correction(
            throttle=-self.gain * memory["climbed"] * jnp.ones(THRUSTERS),
            deflection=0.01 * memory["climbed"] * jnp.ones(FINS),
            rewind_rate=0.001 * memory["flown"][:1],
        )
        return correction, rate

    def initial_memory(self, measurement: Measurement) -> Any:
        return {"climbed": jnp.zeros(()), "flown": measurement.offset[0]}


class Clock(AbstractLaw):
    """Remembers one number whose rate is the time; corrects nothing."""

    def __call__(self, time, measurement, memory):
        del measurement, memory
        return Correction(), time

    def initial_memory(self, measurement):
        del measurement
        return jnp.asarray(0.25)


@pytest.fixture(scope="module")
def scenario():
    return ts.load_scenario("docking")


@pytest.fixture(scope="module")
def measurement():
    """Return a state in which every law has something to say, and none is at a bound."""
    return Measurement(
        velocity=jnp.array([0.4, 0.1, -0.2]),
        rates=jnp.array([0.02, -0.03, 0.04]),
        attitude=jnp.array([0.1, -0.05, 0.3]),
        rate_of_climb=jnp.asarray(0.25),
        offset=jnp.array([[-3.0, 1.0, -2.0]]),
        tension=jnp.array([160.0]),
        length=jnp.array([15.0]),
        rewind_rate=jnp.array([0.3]),
    )


def answer(law, measurement):
    """Return one vector of all corrections."""
    correction, _ = law(jnp.asarray(1.5), measurement, law.initial_memory(measurement))
    parts = [
        jnp.broadcast_to(jnp.asarray(part, dtype=float), (size,))
        for part, size in zip(correction, (THRUSTERS, FINS, CABLES), strict=True)
    ]
    return np.asarray(jnp.concatenate(parts))


@pytest.mark.parametrize("sas", [True, False])
@pytest.mark.parametrize("layers", SUBSETS, ids="+".join)
def test_every_combination_is_the_sum_of_its_layers(scenario, measurement, layers, sas):
    law = scenario.law(layers=layers, sas=sas)
    assert law.names == (("attitude",) if sas else ()) + layers
    alone = [answer(scenario.law(layers=(name,), sas=False), measurement) for name in layers]
    if sas:
        alone.append(answer(scenario.law(layers=(), sas=True), measurement))
    total = np.sum(alone, axis=0) if alone else np.zeros(THRUSTERS + FINS + CABLES)
    # The same sum in another order, numbers up to 2.
    np.testing.assert_allclose(answer(law, measurement), total, rtol=0, atol=1e-15)
    assert all(np.abs(part).max() > 1e-3 for part in alone)  # each of them does say something


def test_order_does_not_matter(scenario, measurement):
    expected = answer(scenario.law(layers=LAYERS), measurement)
    for order in itertools.permutations(LAYERS):
        np.testing.assert_allclose(answer(scenario.law(layers=order), measurement), expected, rtol=0, atol=1e-15)


def test_nothing_at_all_corrects_nothing(measurement):
    law = LayeredLaw((), ())
    correction, memory = law(jnp.zeros(()), measurement, ())
    assert correction == Correction(0.0, 0.0, 0.0)
    assert memory == ()


def test_own_laws_join_the_layers_and_keep_their_memory_apart(scenario, measurement):
    law = scenario.law(layers=("heading",)).joined({"clock": Clock(), "survey": Surveyor(jnp.asarray(0.1))})
    assert law.names == ("attitude", "heading", "clock", "survey")
    memory = law.initial_memory(measurement)
    assert [type(part) for part in memory[:2]] == [tuple, tuple]
    assert float(memory[2]) == 0.25
    np.testing.assert_array_equal(memory[3]["flown"], measurement.offset[0])
    _, rate = law(jnp.asarray(7.0), measurement, memory)
    assert jax.tree.structure(rate) == jax.tree.structure(memory)
    assert float(rate[2]) == 7.0
    assert float(rate[3]["climbed"]) == 0.25


def test_memory_that_is_forgotten_is_an_error(scenario, measurement):
    """A memory for two laws handed to three is a programming error, not silence."""
    law = scenario.law(layers=("heading",)).joined({"clock": Clock()})
    with pytest.raises(ValueError, match=r"shorter|longer|argument 2"):
        law(jnp.zeros(()), measurement, ((), ()))


@pytest.fixture(scope="module")
def loop(scenario):
    law = scenario.law(layers=LAYERS).joined({"survey": Surveyor(jnp.asarray(0.02)), "clock": Clock()})
    return ClosedLoop(scenario.system, law, Command(0.1 * jnp.ones(THRUSTERS), jnp.zeros(FINS)))


@pytest.fixture(scope="module")
def start():
    return State(
        jnp.array([0.5, 0.2, -0.3]),
        jnp.array([0.02, 0.05, -0.04]),
        jnp.array([0.1, 0.1, 0.2]),
        jnp.array([-18.0, 0.5, -11.0]),
    )


@jax.jit
def flown(loop, vector):
    """Return the vectors of 200 classical Runge–Kutta steps of 0.01 s."""
    step = 0.01
    # Each stage starts from the slope of the last at 0, ½, ½, 1 of the step: one loop compiles the field once.
    stages = jnp.array([0.0, 0.5, 0.5, 1.0]), jnp.array([1.0, 2.0, 2.0, 1.0]) / 6.0

    def advance(y, i):
        def stage(carry, table):
            slope, total = carry
            fraction, share = table
            slope = loop.vector_field((i + fraction) * step, y + fraction * step * slope)
            return (slope, total + share * slope), None

        (_, total), _ = jax.lax.scan(stage, (jnp.zeros_like(y), jnp.zeros_like(y)), stages)
        return y + step * total, y + step * total

    return jax.lax.scan(advance, vector, jnp.arange(200.0))[1]


def test_memory_is_integrated_with_the_plant(loop, start):
    """After two seconds: metres climbed are B's loss of D, metres flown are P's way, the clock is t²/2."""
    vector = loop.initial(start)
    assert vector.shape == (12 + CABLES + 4 + 1,)
    path = np.asarray(flown(loop, vector))
    reached = loop.unpack(jnp.asarray(path[-1]))
    state, memory = reached.ship, ravel_pytree(reached.law)[0]
    # Flattened dictionaries go by key: climbed, flown; then the clock.
    np.testing.assert_array_equal(np.asarray(vector[13:14]), 0.0)
    np.testing.assert_allclose(np.asarray(memory[4]), 0.25 + 2.0**2 / 2, rtol=1e-13)  # exact for Runge–Kutta
    # Both sides by the same method of fourth order, on rates that change over 0.5 s: (0.01/0.5)⁴ = 2e-7.
    climbed = float(start.position[2] - state.position[2])
    assert abs(climbed) > 0.1
    assert float(memory[0]) == pytest.approx(climbed, abs=1e-7)
    offset = start.position + rotation_matrix(start.attitude) @ loop.plant.cables[0].tether_point
    way = np.asarray(memory[1:4]) - np.asarray(offset)  # it starts at the tether point's offset, anchor at 0
    np.testing.assert_allclose(way, np.asarray(state.position - start.position), atol=1e-7)


def test_memory_acts_on_throttle_fins_and_winch(loop, start):
    """Ten metres climbed and a hundred flown, written into the memory, reach all three effectors."""
    vector = np.array(loop.initial(start))
    before = loop.instant(jnp.zeros(()), jnp.asarray(vector))
    vector[13] += 2.0
    vector[14] += -100.0
    after = loop.instant(jnp.zeros(()), jnp.asarray(vector))
    free = ~(np.asarray(before.saturated) | np.asarray(after.saturated))
    change = np.asarray(after.command.throttle - before.command.throttle)
    assert free.sum() >= 3
    np.testing.assert_allclose(change[free], -0.04, rtol=1e-12)  # 0.02 per metre, two metres
    np.testing.assert_allclose(np.asarray(after.command.deflection - before.command.deflection), 0.02)
    assert float(after.rewind_rate[0] - before.rewind_rate[0]) == pytest.approx(-0.1, rel=1e-12)


def test_commands_are_clipped_to_what_ship_and_winch_can_do(loop, start):
    vector = np.array(loop.initial(start))
    vector[13], vector[14] = -1e3, 1e4  # +20 of throttle, +10 m/s of winch
    now = loop.instant(jnp.zeros(()), jnp.asarray(vector))
    np.testing.assert_array_equal(np.asarray(now.command.throttle), np.ones(THRUSTERS))
    assert np.asarray(now.saturated).all()
    assert float(now.rewind_rate[0]) == 0.5  # 30 m/min
    assert float(loop.vector_field(jnp.zeros(()), jnp.asarray(vector))[12]) == -0.5


def test_measurement_is_what_the_ship_does(loop, start):
    """Climb rate of B, offset of the tether point from its anchor, tension at the ship's end."""
    lengths = loop.plant.initial_lengths()
    cables = loop.plant.cable_states(jnp.zeros(()), start, lengths)
    seen = loop.measure(start, lengths, cables)
    rotation = np.asarray(rotation_matrix(start.attitude))
    # One matrix product each.
    assert float(seen.rate_of_climb) == pytest.approx(-(rotation @ np.asarray(start.velocity))[2], rel=1e-14)
    tip = np.asarray(start.position) + rotation @ np.array([6.97, 0.0, 0.0])
    np.testing.assert_allclose(np.asarray(seen.offset[0]), tip, rtol=1e-14)
    assert float(seen.tension[0]) == pytest.approx(np.linalg.norm(cables[0].ship), rel=1e-14)
    assert float(seen.rewind_rate[0]) == 0.3
