"""Steady wind: uniform, and the power law of IEC 61400-1.

Truth: the law worked by hand (a 1/7 profile gains 2^(1/7) - 1 = 10.41 % per doubling of height) and its slope
dV/dh = alpha V/h. If this fails, the wind at the ship is not the wind asked for, or the shear has the wrong
sign because down is positive.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership.physics.wind import PowerLawWind, UniformWind

NORTHERLY = jnp.array([-6.0, 0.0, 0.0])


def _profile(**changes):
    values = {
        "value": jnp.array([-6.0, 2.0, 0.0]),
        "reference_height": jnp.asarray(10.0),
        "exponent": jnp.asarray(1.0 / 7.0),
        "lowest_height": jnp.asarray(0.5),
        "ground": jnp.asarray(0.0),
    }
    return PowerLawWind(**(values | changes))


def _at(height):
    return jnp.array([30.0, -20.0, -height])


def test_uniform_wind_is_the_same_everywhere():
    wind = UniformWind(NORTHERLY)
    np.testing.assert_array_equal(wind.velocity(_at(123.0)), NORTHERLY)
    np.testing.assert_array_equal(jax.jacfwd(wind.velocity)(_at(5.0)), np.zeros((3, 3)))


@pytest.mark.parametrize(("height", "factor"), [(10.0, 1.0), (20.0, 1.1041), (80.0, 1.3459), (5.0, 0.9057)])
def test_power_law_by_hand(height, factor):
    # 2^(1/7) = 1.1041, 8^(1/7) = 1.3459, (1/2)^(1/7) = 0.9057: four decimals by hand
    wind = _profile()
    np.testing.assert_allclose(wind.velocity(_at(height)), factor * wind.value, rtol=5e-5)


def test_shear_is_exponent_times_speed_over_height():
    wind = _profile()
    gradient = np.asarray(jax.jacfwd(wind.velocity)(_at(16.0)))
    np.testing.assert_array_equal(gradient[:, :2], 0.0)  # nothing changes along the ground
    # with down positive, dV/dD = -alpha V/h
    np.testing.assert_allclose(gradient[:, 2], -wind.velocity(_at(16.0)) / 7.0 / 16.0, rtol=1e-14)


@pytest.mark.parametrize("height", [0.4, 0.0, -3.0])
def test_below_the_lowest_height_the_profile_is_constant(height):
    wind = _profile()
    expected = np.asarray(wind.value) * (0.5 / 10.0) ** (1.0 / 7.0)
    np.testing.assert_allclose(wind.velocity(_at(height)), expected, rtol=1e-14)
    np.testing.assert_array_equal(jax.jacfwd(wind.velocity)(_at(height)), np.zeros((3, 3)))


def test_height_counts_from_the_ground_not_from_the_anchor():
    # The anchor, origin of the frame, on a mast of 5 m: the ground is at D = +5.
    mast = _profile(ground=jnp.asarray(5.0))
    np.testing.assert_allclose(mast.velocity(_at(15.0)), _profile().velocity(_at(20.0)), rtol=1e-15)


def test_exponent_zero_is_uniform():
    wind = _profile(exponent=jnp.asarray(0.0))
    np.testing.assert_array_equal(wind.velocity(_at(77.0)), wind.value)
