"""Air density against the printed tables of the standard atmosphere.

Truth: ISO 2533:1975, table of density against geopotential altitude (the same figures as the US Standard
Atmosphere 1976), and hydrostatic balance of the column. If this fails, buoyancy (135 kg of air) and every
aerodynamic load carry a wrong density, and the slow vertical mode, which density with altitude causes, is
wrong.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership.physics.atmosphere import ConstantAtmosphere, StandardAtmosphere
from tethership.spatial import SEA_LEVEL_DENSITY, STANDARD_GRAVITY

STANDARD = StandardAtmosphere(jnp.asarray(0.0), jnp.asarray(0.0))


@pytest.mark.parametrize(
    ("altitude", "density", "half_digit"),
    [
        (0.0, 1.2250, 5e-5),
        (1000.0, 1.11164, 5e-6),
        (5000.0, 0.736116, 5e-7),
        (11000.0, 0.363918, 5e-7),
    ],
)
def test_printed_densities(altitude, density, half_digit):
    # within half a unit of the last printed digit, the most that a table can say
    assert float(STANDARD.density(jnp.asarray(altitude))) == pytest.approx(density, abs=half_digit)


def test_sea_level_density_is_the_constant():
    np.testing.assert_allclose(STANDARD.density(jnp.asarray(0.0)), SEA_LEVEL_DENSITY, rtol=1e-15)


def test_column_is_in_hydrostatic_balance():
    # dp/dh = -rho g with p = rho R T and ISO 2533's own T(h) = 288.15 - 0.0065 h, R = 287.05287 J/(kg K).
    def pressure(altitude):
        return STANDARD.density(altitude) * 287.05287 * (288.15 - 0.0065 * altitude)

    altitudes = jnp.linspace(-500.0, 11000.0, 47)
    weight = -STANDARD_GRAVITY * jax.vmap(STANDARD.density)(altitudes)
    np.testing.assert_allclose(jax.vmap(jax.grad(pressure))(altitudes), weight, rtol=1e-13)  # exact but for rounding


def test_ground_altitude_shifts_the_table():
    plateau = StandardAtmosphere(jnp.asarray(900.0), jnp.asarray(0.0))
    assert float(plateau.density(jnp.asarray(100.0))) == pytest.approx(1.11164, abs=5e-6)


def test_a_warm_day_keeps_the_pressure():
    # rho = p/(R T): at ISA + 15 K the density falls as T/(T + 15), T = 281.65 K at 1 000 m.
    warm = StandardAtmosphere(jnp.asarray(0.0), jnp.asarray(15.0))
    altitude = jnp.asarray(1000.0)
    np.testing.assert_allclose(warm.density(altitude) / STANDARD.density(altitude), 281.65 / 296.65, rtol=1e-14)


def test_constant_atmosphere_has_no_gradient():
    air = ConstantAtmosphere(jnp.asarray(1.1))
    value, slope = jax.value_and_grad(air.density)(jnp.asarray(345.0))
    assert float(value) == 1.1
    assert float(slope) == 0.0
