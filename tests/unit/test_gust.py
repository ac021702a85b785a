"""The "1 - cos" gust of section 4.1 of the paper.

Truth: the pulse's closed form: peak, half value at a quarter, smooth corners, impulse A T/2, and the paper's
numbers (2 m/s from the west between 20 and 25 s at 6 m/s of wind). If this fails, the disturbance that every
docking figure answers to is another one, or an integrator meets a kink that it is not told of.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.integrate import quad

from tethership import load_scenario
from tethership.physics.gust import CosineGust, WindChange

START, PERIOD = 20.0, 5.0
AMPLITUDE = np.array([0.3, 2.0, -0.4])
GUST = CosineGust(jnp.array(AMPLITUDE), jnp.asarray(START), jnp.asarray(PERIOD))
velocity = jax.jit(lambda time: GUST.velocity(time))
rate = jax.jit(jax.jacfwd(lambda time: GUST.velocity(time)))
curvature = jax.jit(jax.jacfwd(jax.jacfwd(lambda time: GUST.velocity(time))))


def test_peak_is_in_the_middle_and_is_the_amplitude():
    np.testing.assert_allclose(velocity(START + PERIOD / 2), AMPLITUDE, rtol=1e-15)
    np.testing.assert_allclose(rate(START + PERIOD / 2), np.zeros(3), atol=1e-15)
    times = START + PERIOD * np.linspace(0.0, 1.0, 1001)
    assert np.linalg.norm(jax.vmap(GUST.velocity)(times), axis=1).max() <= np.linalg.norm(AMPLITUDE) * (1 + 1e-15)


@pytest.mark.parametrize("part", [0.25, 0.75])
def test_half_of_the_amplitude_at_the_quarters(part):
    np.testing.assert_allclose(velocity(START + part * PERIOD), AMPLITUDE / 2, rtol=1e-15)


@pytest.mark.parametrize("time", [-1e3, 0.0, START, START + PERIOD, 26.0, 1e6])
def test_nothing_before_and_after(time):
    np.testing.assert_allclose(velocity(time), np.zeros(3), atol=1e-30)


def test_direction_never_changes():
    times = START + PERIOD * np.linspace(0.01, 0.99, 99)
    air = np.asarray(jax.vmap(GUST.velocity)(times))
    np.testing.assert_allclose(np.cross(air, AMPLITUDE), 0.0, atol=1e-15)
    assert (air @ AMPLITUDE > 0).all()


@pytest.mark.parametrize("corner", [START, START + PERIOD])
def test_once_continuously_differentiable_at_the_corners(corner):
    # On either side the slope is at most A/2 (2 pi/T)^2 h: it vanishes with h, so value and slope are
    # continuous.
    for h in (1e-3, 1e-5):
        bound = 0.5 * np.linalg.norm(AMPLITUDE) * (2 * np.pi / PERIOD) ** 2 * h
        for side in (-h, 0.0, h):
            assert np.linalg.norm(rate(corner + side)) <= bound * 1.001
            assert np.linalg.norm(velocity(corner + side)) <= bound * h


def test_corners_are_where_the_second_derivative_jumps():
    jump = 0.5 * AMPLITUDE * (2 * np.pi / PERIOD) ** 2
    np.testing.assert_array_equal(GUST.corners(), [START, START + PERIOD])
    for corner, inward in zip(np.asarray(GUST.corners()), (1.0, -1.0), strict=True):
        # cos differs from 1 by (2 pi h/T)^2/2 = 1e-10 at h = 1e-5 s
        np.testing.assert_allclose(curvature(corner + inward * 1e-5), jump, rtol=1e-8)
        np.testing.assert_array_equal(curvature(corner - inward * 1e-5), np.zeros(3))


def test_impulse_is_half_of_amplitude_times_period():
    for axis in range(3):
        total, _ = quad(lambda t, i=axis: float(velocity(t)[i]), START, START + PERIOD, epsabs=1e-12)
        assert total == pytest.approx(AMPLITUDE[axis] * PERIOD / 2, rel=1e-12)


@pytest.mark.parametrize("wind", [6.0, 12.0])
def test_the_papers_gust_is_a_third_of_the_wind_from_the_west(wind):
    environment = load_scenario("docking", {"wind.speed": wind}).system.environment
    here = jnp.zeros(3)
    before, peak = (np.asarray(environment.wind_at(here, jnp.asarray(t))) for t in (10.0, 22.5))
    np.testing.assert_allclose(before, [-wind, 0, 0], atol=1e-14)  # from the north: air moves south
    np.testing.assert_allclose(peak - before, [0, wind / 3, 0], atol=1e-14)  # from the west: air moves east


def test_wind_change_is_linear_in_time():
    """The wind as an input of a linear model: Δv_w at t = 0 and its rate, nothing to step on."""
    change = WindChange(jnp.array([1.0, -2.0, 0.5]), jnp.array([0.1, 0.0, -0.3]))
    np.testing.assert_allclose(change.velocity(jnp.asarray(0.0)), [1.0, -2.0, 0.5], rtol=0, atol=0)
    np.testing.assert_allclose(change.velocity(jnp.asarray(2.0)), [1.2, -2.0, -0.1], rtol=1e-15)
    np.testing.assert_allclose(jax.jacfwd(change.velocity)(jnp.asarray(1.0)), [0.1, 0.0, -0.3], rtol=1e-15)
    assert change.corners().shape == (0,)
