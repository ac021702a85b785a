"""The curve through a measured wind: through its samples, without overshoot, smooth, differentiable, close to truth."""

import diffrax
import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership.physics.turbulence import MeasuredHistory


def flown(times, velocities, at):
    history = MeasuredHistory.through(jnp.asarray(times, float), jnp.asarray(velocities, float))
    return jax.vmap(lambda t: jax.jvp(history.velocity, (t,), (jnp.ones_like(t),)))(jnp.asarray(at, float))


def test_a_step_is_not_overshot():
    """Version 0.1 flew 11.48 m/s after a step from 0 to 10 m/s."""
    times = np.arange(11.0)
    step = np.where(times < 5, 0.0, 10.0)
    values, _ = flown(times, np.stack([step, -step, 0.5 * step], axis=1), np.linspace(0.0, 10.0, 2001))
    assert float(values[:, 0].max()) <= 10.0 + 1e-12
    assert float(values[:, 0].min()) >= -1e-12
    assert np.allclose(values[:, 1], -values[:, 0])


def test_noise_stays_between_its_samples_and_rising_stays_rising():
    random = np.random.default_rng(3)
    times = np.cumsum(random.uniform(0.05, 3.0, 60))
    samples = np.concatenate([random.normal(size=(60, 2)), np.sort(random.normal(size=(60, 1)), axis=0)], axis=1)
    values, slopes = flown(times, samples, np.linspace(times[:-1], times[1:], 33, axis=1).ravel())
    low, high = np.minimum(samples[:-1], samples[1:]), np.maximum(samples[:-1], samples[1:])
    inside = np.asarray(values).reshape(59, 33, 3)
    assert np.all(inside >= low[:, None] - 1e-12)
    assert np.all(inside <= high[:, None] + 1e-12)
    assert np.all(slopes[:, 2] >= -1e-12)
    assert np.allclose(inside[:, 0], samples[:-1], atol=1e-12)


def test_its_slope_is_continuous_and_that_of_its_ends_whole():
    random = np.random.default_rng(4)
    times = np.cumsum(random.uniform(0.5, 2.0, 20))
    samples = random.normal(size=(20, 3))
    _, before = flown(times, samples, times[1:-1] - 1e-7)
    _, after = flown(times, samples, times[1:-1] + 1e-7)
    assert np.allclose(before, after, atol=1e-5)
    _, at_start = flown(times, samples, times[:1])
    _, just_after = flown(times, samples, times[:1] + 1e-7)
    assert np.allclose(at_start, just_after, atol=1e-5)
    held, still = flown(times, samples, [times[-1] + 1.0, times[0] - 1.0])
    assert np.allclose(held, samples[[-1, 0]])
    assert np.array_equal(still, np.zeros((2, 3)))


@pytest.mark.parametrize("step", [0.5, 0.25, 0.125])
def test_a_smooth_wind_is_met_better_than_by_backward_differences(step):
    """Measured, root mean squares over those of version 0.1: 0.2–0.4 of values, 0.2–0.3 of slopes."""
    times = np.arange(0.0, 20.0 + step / 2, step)
    times[1:-1] += np.random.default_rng(1).uniform(-0.3, 0.3, times.size - 2) * step
    wind = lambda t: 8.0 + 1.5 * np.sin(t) + 0.3 * np.cos(2.3 * t)  # noqa: E731
    rate = lambda t: 1.5 * np.cos(t) - 0.69 * np.sin(2.3 * t)  # noqa: E731
    at = np.linspace(0.0, 20.0, 4001)
    samples = jnp.asarray(wind(times))[:, None] * jnp.ones(3)
    old = diffrax.CubicInterpolation(
        jnp.asarray(times), diffrax.backward_hermite_coefficients(jnp.asarray(times), samples)
    )
    values, slopes = flown(times, samples, at)
    rms = lambda difference: float(np.sqrt(np.mean(np.square(difference))))  # noqa: E731
    old_values, old_slopes = (jax.vmap(of)(jnp.asarray(at))[:, 0] for of in (old.evaluate, old.derivative))
    assert rms(values[:, 0] - wind(at)) < 0.5 * rms(old_values - wind(at))
    assert rms(slopes[:, 0] - rate(at)) < 0.4 * rms(old_slopes - rate(at))


def test_it_has_finite_derivatives_by_its_samples_even_where_they_are_equal():
    times, samples = jnp.arange(6.0), jnp.zeros((6, 3)).at[3].set(1.0)
    by_samples = jax.jacfwd(lambda v: MeasuredHistory.through(times, v).velocity(jnp.asarray(2.5)))(samples)
    assert bool(jnp.all(jnp.isfinite(by_samples)))
    assert float(by_samples[0].sum()) == pytest.approx(1.0)
