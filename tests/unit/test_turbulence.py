"""Turbulence: spectra against their definitions, records against their spectra, smoothness, hull gradients."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import scipy.integrate

from tethership.physics.turbulence import (
    INTERVAL,
    SAMPLES,
    SPECTRA,
    Scales,
    low_altitude_scales,
    make_turbulence,
)

WIND = jnp.array([-8.0, 6.0, 0.0])
SCALES = Scales(jnp.array([80.0, 80.0, 20.0]), jnp.array([1.5, 1.2, 0.8]))
NONE = jnp.zeros(())


def record(name, seed=1.0, scales=SCALES, wind=WIND, hull=NONE, gradients=False):
    return make_turbulence(SPECTRA[name], scales, wind, jnp.asarray(seed), hull, gradients)


def samples(turbulence, times=None):
    """Velocities along the wind, across and down at times, shape (n, 3)."""
    times = np.arange(SAMPLES) * INTERVAL if times is None else times
    velocity = np.asarray(jax.vmap(turbulence.velocity)(jnp.asarray(times)))
    return velocity @ np.array([[-0.8, 0.6, 0.0], [-0.6, -0.8, 0.0], [0.0, 0.0, 1.0]]).T


@pytest.mark.parametrize("name", SPECTRA)
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_one_sided_spectrum_integrates_to_the_variance(name, axis):
    density = lambda x: float(SPECTRA[name](jnp.array([[np.exp(x)]]), SCALES)[0, axis]) * np.exp(x)  # noqa: E731
    variance, _ = scipy.integrate.quad(density, np.log(1e-6), np.log(1e5), limit=300)
    # von Kármán's 1.339 is rounded and its tail falls as Ω^(−5/3): 0.1 % is what both leave
    assert variance == pytest.approx(float(SCALES.deviation[axis]) ** 2, rel=1e-3)


@pytest.mark.parametrize("name", SPECTRA)
def test_transverse_follows_from_longitudinal_in_isotropic_turbulence(name):
    # Φ_v = ½(Φ_u − Ω dΦ_u/dΩ) for equal L and σ (Batchelor 1953, eq. 3.4.7)
    equal = Scales(jnp.full(3, 50.0), jnp.full(3, 1.0))
    along = lambda x: SPECTRA[name](jnp.array([[x]]), equal)[0, 0]  # noqa: E731
    for wavenumber in (1e-3, 0.02, 0.5):
        expected = 0.5 * (along(wavenumber) - wavenumber * jax.grad(along)(wavenumber))
        # the exponents 11/6 of the print follow exactly; 1e-9 is rounding
        assert float(SPECTRA[name](jnp.array([[wavenumber]]), equal)[0, 1]) == pytest.approx(float(expected), rel=1e-9)


@pytest.mark.parametrize("name", SPECTRA)
def test_periodogram_of_many_records_is_the_spectrum(name):
    speed, count = 10.0, 200
    power = np.zeros((SAMPLES // 2 + 1, 3))
    for seed in range(count):
        power += np.abs(np.fft.rfft(samples(record(name, float(seed))), axis=0)) ** 2
    step = 2 * np.pi / (SAMPLES * INTERVAL) / speed
    measured = 2.0 * power / count / SAMPLES**2 / step
    for low, high in ((1, 4), (4, 16), (16, 64), (64, 256), (256, 1024)):
        band = np.arange(low, high)
        wanted = np.asarray(SPECTRA[name](jnp.asarray(band[:, None] * step), SCALES))
        ratio = (measured[band] / wanted).mean(axis=0)
        # each bin is χ² with 2·200 degrees of freedom: standard deviation 1/√200 of a bin, /√bins of a band; 4.5 σ
        assert np.all(np.abs(ratio - 1.0) < 4.5 / np.sqrt(count * len(band)))


def test_components_are_independent():
    many = np.concatenate([samples(record("dryden", float(seed))) for seed in range(100)])
    correlation = np.corrcoef(many, rowvar=False)
    # 100 records of some 50 integral scales each: standard deviation about 1/√5000
    assert np.max(np.abs(correlation - np.eye(3))) < 0.06


def test_low_altitude_scales_are_those_of_the_standard():
    # MIL-F-8785C figures at 100 ft and W20 = 15 kt (7.717 m/s): L_u = 100/(0.177+0.0823)^1.2 ft, σ_w = 1.5 kt
    scales = low_altitude_scales(jnp.asarray(30.48), jnp.asarray(7.7167))
    assert np.allclose(np.asarray(scales.length) / 0.3048, [505.2, 505.2, 100.0], rtol=1e-3)
    assert np.allclose(np.asarray(scales.deviation), 0.77167 * np.array([1.7161, 1.7161, 1.0]), rtol=1e-3)


def test_scales_meet_the_model_of_greater_heights_at_1000_ft():
    scales = low_altitude_scales(jnp.asarray(304.8), jnp.asarray(10.0))
    assert np.allclose(np.asarray(scales.length), 304.8, rtol=1e-3)
    assert np.allclose(np.asarray(scales.deviation), 1.0, rtol=1e-3)


def test_same_seed_same_record_and_another_seed_another():
    first, again, other = record("dryden", 7.0), record("dryden", 7.0), record("dryden", 8.0)
    assert np.array_equal(first.coefficients, again.coefficients)
    assert abs(np.corrcoef(samples(first)[:, 2], samples(other)[:, 2])[0, 1]) < 0.3


def test_record_is_smooth_across_samples_and_repeats_itself():
    turbulence = record("von_karman")
    rate = jax.grad(lambda t: turbulence.velocity(t)[0])
    for time in (3 * INTERVAL, 12.3, SAMPLES * INTERVAL):
        assert float(rate(time - 1e-9)) == pytest.approx(float(rate(time + 1e-9)), abs=1e-6)
    assert np.allclose(turbulence.velocity(1.234), turbulence.velocity(1.234 + SAMPLES * INTERVAL), atol=1e-9)
    assert np.isfinite(float(jax.grad(rate)(0.0)))


def test_averaging_over_the_hull_takes_out_short_waves_only():
    point, hull = samples(record("dryden")), samples(record("dryden", hull=jnp.asarray(16.0)))
    ratio = np.abs(np.fft.rfft(hull, axis=0)) / np.abs(np.fft.rfft(point, axis=0))
    wavelength = 10.0 * SAMPLES * INTERVAL / np.arange(1, SAMPLES // 2)
    assert np.allclose(ratio[1 : SAMPLES // 2][wavelength > 400.0], 1.0, atol=3e-3)
    half = np.argmin(np.abs(wavelength - 32.0))  # a hull of half a wavelength: sin(π/2)/(π/2)
    assert np.allclose(ratio[1 + half], 2 / np.pi, atol=0.01)


def test_no_wind_has_no_turbulence_and_a_finite_gradient():
    def energy(speed):
        wind = speed * jnp.array([-1.0, 0.0, 0.0])
        scales = low_altitude_scales(jnp.asarray(10.0), speed)
        return jnp.sum(record("dryden", scales=scales, wind=wind).velocity(jnp.asarray(3.0)))

    assert float(energy(jnp.zeros(()))) == 0.0
    assert np.isfinite(float(jax.grad(energy)(jnp.asarray(1e-3))))


def test_hull_s_gradient_is_nose_less_tail_over_its_length():
    # a hull along the wind, nose upwind: the nose meets now what B meets ½ℓ/U later
    point, hull = (record("dryden", hull=jnp.asarray(h), gradients=h > 0) for h in (0.0, 16.0))
    axis, shift, length = jnp.array([0.8, -0.6, 0.0]), 0.8, 16.0
    times = jnp.arange(SAMPLES) * INTERVAL
    ahead = jax.vmap(lambda t: point.velocity(t + shift) - point.velocity(t - shift))(times) / length
    across = ahead - (ahead @ axis)[:, None] * axis
    turning = jax.vmap(lambda t: hull.rotation(t, axis))(times)
    found, wanted = (np.fft.rfft(np.asarray(of), axis=0)[1:410] for of in (jnp.cross(turning, axis), across))
    # below 1 Hz, where the slope of a cubic spline through samples 0.1 s apart is exact to 1e-3
    assert np.max(np.abs(found - wanted)) < 1e-3 * np.max(np.abs(wanted))
    assert np.allclose(turning @ axis, 0.0, atol=1e-12)
    assert point.rotation(times[0], axis) is None
