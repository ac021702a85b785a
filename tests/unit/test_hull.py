"""Hull shape: the Gertler refit of the paper's hidden radii, closed forms of an ellipsoid, and the quadrature.

Truth: the radii, volume and centre that the paper gives away, polynomials integrated exactly by numpy, and
scipy's adaptive quadrature. If this failed, displaced volume, Munk moment or cross-flow drag would belong to
another ship.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import scipy.integrate
from numpy.polynomial import Polynomial

from tethership.physics.hull import BodyOfRevolution, ellipsoid, gertler, gertler_from_shape

LENGTH, DIAMETER = 16.0, 3.98432
COEFFICIENTS = np.array([1.40192, -6.19598, 24.55536, -51.15841, 46.62503, -15.22792])
SHAPE = np.array([0.44259, 0.70096, 0.10, 0.55286])
CUT = 12.5

hull = gertler(LENGTH, DIAMETER, COEFFICIENTS)


def exact_moment(power, origin, start, end):
    """Return ∫A(origin − ξ)ⁿdξ of the paper's hull by integrating the polynomial."""
    scale = DIAMETER**2 * np.concatenate([[0.0], COEFFICIENTS]) / LENGTH ** np.arange(7)
    integral = (np.pi * Polynomial(scale) * Polynomial([origin, -1.0]) ** power).integ()
    return integral(end) - integral(start)


def test_volume_centre_and_largest_radius():
    # the notes section 3 prints 110.29 m³, 6.970 m, 1.992 m: half of each last digit.
    assert float(hull.volume()) == pytest.approx(110.29, abs=0.005)
    assert float(hull.centre()) == pytest.approx(6.970, abs=0.0005)
    radii = np.asarray(hull.radius(jnp.linspace(0.0, LENGTH, 100_001)))
    assert radii.max() == pytest.approx(1.992, abs=0.0005)
    # The paper's own data (Table 2): 110.3 m³ and B at 6.97 m.
    assert float(hull.volume()) == pytest.approx(110.3, abs=0.05)


def test_radii_hidden_in_the_paper():
    found = np.asarray(hull.radius(jnp.array([3.20, 4.97, 6.97])))
    # "Within 1.4 mm" (section 3); found +1.40, −1.09, +1.26 mm.
    np.testing.assert_allclose(found, [1.5977, 1.8634, 1.9905], atol=1.45e-3)


def test_volume_and_centre_are_those_of_the_polynomial():
    volume = exact_moment(0, 0.0, 0.0, LENGTH)
    # Closed form against closed form: rounding only, coefficients of 50 that cancel to 0.5.
    assert float(hull.volume()) == pytest.approx(volume, rel=1e-13)
    assert float(hull.centre()) == pytest.approx(-exact_moment(1, 0.0, 0.0, LENGTH) / volume, rel=1e-13)


def test_shape_parameters_give_back_the_coefficients():
    """The printed shape parameters are rounded to five digits; the difference must be that rounding and no more."""

    def coefficients(shape):
        return gertler_from_shape(LENGTH, DIAMETER, *shape).coefficients

    sensitivity = np.abs(np.asarray(jax.jacfwd(coefficients)(jnp.asarray(SHAPE))))
    # Half a unit of the last printed digit of each parameter and of the coefficients; 5 % for second order.
    allowed = 1.05 * (sensitivity @ np.full(4, 0.5e-5)) + 0.5e-5
    difference = np.abs(np.asarray(coefficients(jnp.asarray(SHAPE))) - COEFFICIENTS)
    assert (difference <= allowed).all(), (difference, allowed)
    assert allowed.max() < 2e-4 * np.abs(COEFFICIENTS).max()  # the bound means something: 6e-3 of 51


def test_shape_parameters_read_off_the_coefficients_are_inverted():
    printed = Polynomial(np.concatenate([[0.0], COEFFICIENTS]))
    roots = printed.deriv().roots()
    largest = next(root.real for root in roots if abs(root.imag) < 1e-9 and 0.3 < root.real < 0.6)
    scale = 0.25 / printed(largest)  # the printed digits miss (r/D)² = ¼ by 1e-6: moved into the diameter
    profile = scale * printed
    slope = profile.deriv()
    shape = (largest, 0.5 * slope(0.0), -0.5 * slope(1.0), 4.0 * profile.integ()(1.0))
    # Five printed digits of each; r₁ adds six coefficients with five digits, times up to 6.
    np.testing.assert_allclose(shape, SHAPE, atol=3e-5)
    found = gertler_from_shape(LENGTH, DIAMETER / np.sqrt(scale), *shape)
    stations = jnp.linspace(0.0, LENGTH, 201)
    # The same polynomial: a condition number near 1e5 times rounding of the inputs, times D² = 16.
    np.testing.assert_allclose(
        np.asarray(found.radius_squared(stations)), np.asarray(hull.radius_squared(stations)), atol=1e-9
    )


def test_shape_parameters_mean_what_they_say():
    """Radii of curvature, station of the largest section and prismatic coefficient, measured on the shape."""
    shape = gertler_from_shape(10.0, 2.0, 0.4, 0.6, 0.05, 0.62)
    near = 1e-7
    # r² ≈ 2 ρ ξ at a blunt end, ρ = r₀ D²/L; the next term is of order `near`.
    assert float(shape.radius_squared(jnp.asarray(near))) / (2 * near) == pytest.approx(0.6 * 4 / 10, rel=1e-5)
    tail = float(shape.radius_squared(jnp.asarray(10.0 - near))) / (2 * near)
    assert tail == pytest.approx(0.05 * 4 / 10, rel=1e-5)
    assert float(shape.radius(jnp.asarray(4.0))) == pytest.approx(1.0, rel=1e-12)
    assert float(jax.grad(shape.radius)(jnp.asarray(4.0))) == pytest.approx(0.0, abs=1e-12)
    assert float(shape.volume()) == pytest.approx(0.62 * np.pi / 4 * 4.0 * 10.0, rel=1e-12)


def test_ellipsoid_in_closed_form():
    shape = ellipsoid(jnp.asarray(12.0), jnp.asarray(3.0))
    half, radius = 6.0, 1.5
    volume = 4.0 / 3.0 * np.pi * half * radius**2
    # Rounding of a few products.
    assert float(shape.volume()) == pytest.approx(volume, rel=1e-14)
    assert float(shape.centre()) == pytest.approx(half, rel=1e-14)
    stations = np.linspace(0.0, 12.0, 25)
    # Square root of a difference that vanishes at the ends: 1e-8 there.
    expected = radius * np.sqrt(np.maximum(1.0 - (stations / half - 1.0) ** 2, 0.0))
    np.testing.assert_allclose(np.asarray(shape.radius(jnp.asarray(stations))), expected, atol=1e-7)
    # ∫A x² dx = 𝒱a²/5, which with b² makes Jᵃ of Table 2.
    assert float(shape.area_moment(2, half, 0.0, 12.0)) == pytest.approx(volume * half**2 / 5.0, rel=1e-13)
    assert float(shape.area_moment(1, half, 0.0, 12.0)) == pytest.approx(0.0, abs=1e-11)


@pytest.mark.parametrize("power", [0, 1, 2])
@pytest.mark.parametrize(("start", "end"), [(0.0, CUT), (CUT, LENGTH), (0.0, LENGTH), (3.0, 3.0)])
def test_area_moments_are_exact(power, start, end):
    found = float(hull.area_moment(power, 6.97, start, end))
    # A polynomial of degree 17 in s under 12 Gauss nodes: exact; sums of terms up to 1e3 m⁵.
    assert found == pytest.approx(exact_moment(power, 6.97, start, end), rel=1e-12, abs=1e-11)


def test_radius_and_its_slope_are_zero_where_there_is_no_hull():
    def radius(station):
        return hull.radius(station)

    for station in (-1.0, 0.0, LENGTH + 0.5, 30.0):
        assert float(radius(jnp.asarray(station))) == 0.0
        assert float(jax.grad(radius)(jnp.asarray(station))) == 0.0
    # At the tail Σa = 0 to rounding only: r² there is ±1e-14 D², r at most 1e-6 m, and nothing is NaN.
    assert 0.0 <= float(radius(jnp.asarray(LENGTH))) < 2e-6


def planform_integral(end, power):
    """Return ∫2r|x|ᵖdξ from the nose to `end`, adaptive, with the singular ends substituted away."""
    centre = float(hull.centre())

    def integrand(station):
        square = np.polyval(np.concatenate([COEFFICIENTS[::-1], [0.0]]), station / LENGTH)
        return 2.0 * DIAMETER * np.sqrt(max(square, 0.0)) * abs(centre - station) ** power

    def from_nose(s):  # ξ = s²
        return integrand(s * s) * 2.0 * s

    def from_tail(s):  # ξ = L − s²
        return integrand(LENGTH - s * s) * 2.0 * s

    options = {"epsabs": 1e-13, "epsrel": 1e-13, "limit": 300}
    ahead = scipy.integrate.quad(from_nose, 0.0, np.sqrt(centre), **options)[0]
    if end < LENGTH:
        return ahead + scipy.integrate.quad(from_nose, np.sqrt(centre), np.sqrt(end), **options)[0]
    return ahead + scipy.integrate.quad(from_tail, 0.0, np.sqrt(LENGTH - centre), **options)[0]


# Relative error of the strips, measured with the present nodes (Gauss–Legendre in s, ξ = L s²); bounds are twice
# that. To l_h ∫2r converges geometrically; |x|³ has a kink in its third derivative at B, and the whole hull a
# blunt tail, so those converge like a power of the number of strips.
#   strips                    8        12        16        32        64
#   ∫2r    to 12.5 m    1.1e-07   1.8e-09   5.2e-12   < 1e-14
#   ∫2r|x|³ to 12.5 m   2.8e-03   5.6e-04   3.3e-05   6.2e-06   6.7e-07
#   ∫2r    whole hull   1.0e-03   1.9e-04   8.8e-05   1.1e-05   1.4e-06
#   ∫2r|x|³ whole hull  7.5e-03   2.4e-03   9.1e-04   1.2e-04   1.4e-05
MEASURED = {
    (CUT, 0): {8: 1.1e-7, 12: 1.8e-9, 16: 5.2e-12, 32: 1e-14},
    (CUT, 3): {8: 2.8e-3, 12: 5.6e-4, 16: 3.3e-5, 32: 6.2e-6, 64: 6.7e-7},
    (LENGTH, 0): {8: 1.0e-3, 12: 1.9e-4, 16: 8.8e-5, 32: 1.1e-5, 64: 1.4e-6},
    (LENGTH, 3): {8: 7.5e-3, 12: 2.4e-3, 16: 9.1e-4, 32: 1.2e-4, 64: 1.4e-5},
}


@pytest.mark.parametrize(("end", "power"), MEASURED)
def test_strips_converge(end, power):
    reference = planform_integral(end, power)
    for count, error in MEASURED[end, power].items():
        strips = hull.strips(0.0, end, count)
        lever = jnp.abs(hull.centre() - strips.station) ** power
        found = float(jnp.sum(2.0 * strips.radius * strips.width * lever))
        assert abs(found / reference - 1.0) < 2.0 * error, (count, found / reference - 1.0)


def test_strips_lie_inside_and_their_widths_add_up():
    strips = hull.strips(2.0, 9.0, 12)
    assert float(strips.station.min()) > 2.0
    assert float(strips.station.max()) < 9.0
    assert float(strips.width.sum()) == pytest.approx(7.0, rel=1e-13)  # a linear integrand in s: exact


def test_hull_is_a_pytree_that_can_be_batched():
    """A sweep over the diameter is one vmap: r scales with D."""
    diameters = jnp.array([1.0, 2.0, 4.0])
    shapes = jax.vmap(lambda d: gertler(LENGTH, d, COEFFICIENTS))(diameters)
    assert isinstance(shapes, BodyOfRevolution)
    volumes = jax.vmap(lambda shape: shape.volume())(shapes)
    np.testing.assert_allclose(np.asarray(volumes / volumes[0]), [1.0, 4.0, 16.0], rtol=1e-14)  # 𝒱 ∼ D²


def test_strips_from_the_nose_have_finite_slopes():
    """√(ξ/L) at ξ = 0 has no slope: with respect to the hull's length nothing may become NaN, in forward or reverse."""

    def area(length):
        hull = gertler(length, jnp.asarray(4.0), jnp.array([1.0, -1.0, 0.0, 0.0, 0.0, 0.0]))
        strips = hull.strips(jnp.zeros(()), 0.75 * length, 16)
        return jnp.sum(2.0 * strips.radius * strips.width)

    length = jnp.asarray(16.0)
    # The shape scales with the length: the projected area is proportional to it.
    for slope in (jax.jacfwd(area)(length), jax.grad(area)(length)):
        np.testing.assert_allclose(slope, area(length) / length, rtol=1e-12)
