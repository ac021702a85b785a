"""Lamb's inertia factors of a spheroid, held against Lamb's own integrals and the printed table.

Sources: H. Lamb, *Hydrodynamics*, 6th ed. (1932), art. 114–115 (the integrals); H. Lamb, *The inertia-coefficients
of an ellipsoid moving in fluid*, R&M 623 (1918) (the table, copied by Munk in NACA TR-184); Table 2 of Riboldi et al.
If this failed, every user who asks for `model = "lamb"` would get a wrong apparent mass, and the reading of the
paper's Table 2 (factors, not densities) would be baseless.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import scipy.integrate

import tethership as ts
from tethership.physics.apparent_mass import lamb1932


def factors(fineness):
    found = lamb1932(jnp.asarray(fineness))
    return np.array([float(found.axial), float(found.lateral), float(found.rotational)])


def lamb_integral(semi_axes, axis):
    """Return abc ∫₀^∞ dλ / ((a_i² + λ) √((a² + λ)(b² + λ)(c² + λ))), by adaptive quadrature."""
    squares = np.square(semi_axes)

    def integrand(t):  # λ = t/(1 − t)
        level = t / (1.0 - t)
        return 1.0 / ((squares[axis] + level) * np.sqrt(np.prod(squares + level)) * (1.0 - t) ** 2)

    value, _ = scipy.integrate.quad(integrand, 0.0, 1.0, epsabs=1e-13, epsrel=1e-12, limit=400)
    return np.prod(semi_axes) * value


@pytest.mark.parametrize(
    "fineness", [0.2, 0.5, 0.9, 0.92, 1.05, 1.117, 1.119, 1.5, 2.0, 3.0, 4.02, 4.87, 6.0, 10.0, 25.0]
)
def test_factors_are_lambs_integrals(fineness):
    a, b = fineness, 1.0
    alpha, beta = (lamb_integral((a, b, b), axis) for axis in (0, 1))
    # Art. 115 (5)–(7), before anything is put in terms of the eccentricity; k′ per (a² + b²)/5 of the displaced mass.
    difference = a**2 - b**2
    turning = difference**2 * (beta - alpha) / (2.0 * difference + (a**2 + b**2) * (alpha - beta))
    expected = [alpha / (2.0 - alpha), beta / (2.0 - beta), turning / (a**2 + b**2)]
    # Quadrature to 1e-12; near the sphere β₀ − α₀ is a difference of nearly equal numbers (1e-16/e² ≈ 1e-14).
    np.testing.assert_allclose(factors(fineness), expected, rtol=1e-9)
    assert alpha + 2.0 * beta == pytest.approx(2.0, abs=1e-11)  # Laplace's equation: the three add up to 2


def test_a_sphere_has_one_half_and_resists_no_turning():
    """Lamb, art. 92: half the displaced mass in any direction; nothing of it is NaN or infinite, nor its slope."""
    np.testing.assert_allclose(factors(1.0), [0.5, 0.5, 0.0], atol=1e-15)
    slope = jax.jacfwd(lamb1932)(jnp.asarray(1.0))
    step = 1e-5
    expected = (factors(1.0 + step) - factors(1.0 - step)) / (2.0 * step)
    np.testing.assert_allclose([slope.axial, slope.lateral, slope.rotational], expected, atol=1e-8)


# Lamb (1918), R&M 623, table for the prolate ellipsoid: a/b, k₁, k₂, k′.
TABLE = [
    (1.50, 0.305, 0.621, 0.094),
    (2.00, 0.209, 0.702, 0.240),
    (2.51, 0.156, 0.763, 0.367),
    (2.99, 0.122, 0.803, 0.465),
    (3.99, 0.082, 0.860, 0.608),
    (4.99, 0.059, 0.895, 0.701),
    (6.01, 0.045, 0.918, 0.764),
    (6.97, 0.036, 0.933, 0.805),
    (8.01, 0.029, 0.945, 0.840),
    (9.02, 0.024, 0.954, 0.865),
    (9.97, 0.021, 0.960, 0.883),
]


@pytest.mark.parametrize("row", TABLE, ids=lambda row: str(row[0]))
def test_printed_table(row):
    # Reckoned by hand from hyperbolic tables: three digits, a/b rounded to a hundredth (1e-3 of k near 2), and a
    # last digit that is off by up to two (2.00: k₂ printed 0.702, by the integrals above 0.7042).
    np.testing.assert_allclose(factors(row[0]), row[1:], atol=2.5e-3)


def test_paper_table_2():
    """At the envelope's 16.0/3.98 = 4.02 the first two are the paper's; its k′ = 0.69 belongs to 4.87."""
    # the notes section 2 prints four digits.
    np.testing.assert_allclose(factors(4.02), [0.0810, 0.8606, 0.6102], atol=5e-5)
    np.testing.assert_allclose(factors(4.02)[:2], [0.08, 0.86], atol=5e-3)
    assert factors(4.87)[2] == pytest.approx(0.69, abs=5e-4)
    # The squared radius of gyration of the full ellipsoid: 13.6 m² in Table 2.
    gyration = (16.0**2 + 3.98**2) / 20.0
    assert gyration == pytest.approx(13.6, abs=0.05)


def test_sphere_limit():
    """A sphere moves half its displaced mass along any axis and, without friction, none when it turns."""
    # At fineness 1 + ε the factors differ from ½ by (3/5)·ε·… < ε.
    np.testing.assert_allclose(factors(1.0001)[:2], 0.5, atol=1e-4)
    assert 0.0 <= factors(1.0001)[2] < 1e-7  # ∼ e⁴


def test_needle_limit():
    """A long spheroid: nothing along the axis, a cylinder's full displaced mass across it."""
    found = factors(1000.0)
    # k₁ ≈ (ln 2f − 1)/f² = 7e-6.
    np.testing.assert_allclose(found, [0.0, 1.0, 1.0], atol=5e-5)
    assert found[0] == pytest.approx((np.log(2000.0) - 1.0) / 1e6, rel=1e-4)


def test_factors_change_smoothly_with_fineness():
    """Derivatives by JAX agree with central differences: a sweep over fineness may be differentiated."""
    for fineness in (1.2, 4.02, 9.0):
        exact = jax.jacfwd(lamb1932)(jnp.asarray(fineness))
        step = 1e-5
        difference = (factors(fineness + step) - factors(fineness - step)) / (2 * step)
        found = [float(exact.axial), float(exact.lateral), float(exact.rotational)]
        np.testing.assert_allclose(found, difference, rtol=1e-6, atol=1e-9)  # step²f‴/6 and rounding 1e-15/1e-5


def test_scenario_offers_lamb_instead_of_the_table():
    ship = ts.load_scenario("hover", {"vehicle.apparent_mass": {"model": "lamb"}}).system.ship
    volume = 110.3
    length, diameter = 16.0, 3.98432
    expected = factors(length / diameter)
    np.testing.assert_allclose(np.asarray(ship.apparent_mass.translational), volume * expected[[0, 1, 1]], rtol=1e-13)
    gyration = (length**2 + diameter**2) / 20.0
    turning = volume * expected[2] * gyration
    np.testing.assert_allclose(np.asarray(ship.apparent_mass.rotational), [0.0, turning, turning], rtol=1e-13)
    assert float(ship.envelope.munk_factor) == pytest.approx(expected[1] - expected[0], rel=1e-13)
