"""The stiffness of a line that hangs or pulls almost plumb: symmetric, and that of the closed form to many digits.

Truth: a line at rest under a fixed load stores energy, so its stiffness is symmetric whatever its pose; and the
classical pair of the extensible catenary (Irvine, *Cable Structures*, 1981, section 1.3), differentiated by hand for
chosen end forces in sixty digits, so that no root and no difference is between it and the truth. If this fails, the
linear model of a ship above its mast (its modes, its damping) is noise.
"""

from decimal import Decimal, localcontext

import jax
import numpy as np
import pytest

from tethership.physics.cable.catenary import end_forces
from tethership.physics.cable.law import SPAN_FLOOR

COUNT = 100_000


@jax.jit
@jax.vmap
def stiffness(span, length, load, compliance):
    """Return dF_TP/dd [N/m]."""
    return jax.jacfwd(lambda d: end_forces(d, length, load, compliance).ship)(span)


def lines(offset, upright=True):
    """Return COUNT lines, a third slack, a third taut, a third all but straight, with given offsets over length."""
    random = np.random.default_rng(5)
    length = 10.0 ** random.uniform(0.0, 3.0, COUNT)
    weight = 10.0 ** random.uniform(-2.0, 1.0, COUNT)
    stretch = 10.0 ** random.uniform(-7.0, -1.0, COUNT)
    elongation = np.concatenate(
        [
            random.uniform(0.1, 0.98, COUNT // 3),
            1.0 + 10.0 ** random.uniform(-4.0, -1.0, COUNT // 3),
            1.0 + stretch[2 * (COUNT // 3) :] * random.uniform(0.0, 1.5, COUNT - 2 * (COUNT // 3)),
        ]
    )
    sideways = random.uniform(0.0, 2.0 * np.pi, COUNT)
    off = offset(random)
    height = np.sqrt(elongation**2 - off**2) * random.choice([-1.0, 1.0], COUNT)
    span = (length * np.stack([off * np.cos(sideways), off * np.sin(sideways), -height])).T
    load = weight[:, None] * np.array([0.0, 0.0, 1.0])
    if not upright:  # wind: the load is oblique, and the line with it
        turn = np.linalg.qr(random.normal(size=(3, 3)))[0]
        span, load = span @ turn.T, load @ turn.T
    return span, length, load, stretch / (weight * length)


def skewness(offset, upright=True):
    """Return the largest difference of a mixed pair of slopes over the whole stiffness, and over the softest."""
    slopes = np.asarray(stiffness(*lines(offset, upright)))
    skewed = np.abs(slopes - slopes.transpose(0, 2, 1)).max(axis=(1, 2))
    size = np.linalg.svd(slopes, compute_uv=False)
    return (skewed / size[:, 0]).max(), (skewed / size[:, 2]).max()


def almost_plumb(random):
    return 10.0 ** random.uniform(-13.0, -8.0, COUNT)


def test_almost_plumb():
    # version 0.1: 4e-4 of the whole, more than the line's whole stiffness across; the direction across rounds by
    # 1e-16/1e-13 and less
    whole, softest = skewness(almost_plumb)
    assert whole < 1e-6
    assert softest < 1e-4


def test_almost_along_an_oblique_load():
    # in turned axes every entry rounds by 1e-16 of the stiffness along, and d_perp, 1e-13 L, by 1e-16 L
    whole, _ = skewness(almost_plumb, upright=False)
    assert whole < 1e-4


def test_ordinary():
    whole, _ = skewness(lambda random: 0.09 * 10.0 ** random.uniform(-7.0, 0.0, COUNT))
    assert whole < 1e-9  # version 0.1: 1e-7


LENGTH, WEIGHT = 20.0, 0.75


def closed_form(pull, lower, stretch):
    """Return a, b and the slopes dH/da, dH/db, dV/da, dV/db over wL, for end forces H and V, ε.

    Parameters
    ----------
    pull, lower : Decimal
        H and V − wL, horizontal force and vertical force at the lower end, over wL.
    stretch : Decimal
        ε = wL/EA.
    """
    upper = lower + 1
    top, bottom = (pull**2 + upper**2).sqrt(), (pull**2 + lower**2).sqrt()
    # asinh(V/H) − asinh((V − wL)/H); sixty digits make the cancelling sums harmless
    angle = ((upper + top) / (lower + bottom)).ln()
    a = pull * (stretch + angle)
    b = stretch * (upper + lower) / 2 + top - bottom
    a_pull = stretch + angle - upper / top + lower / bottom
    a_lift = pull / top - pull / bottom  # = ∂b/∂H: symmetry, in the reference too
    b_lift = stretch + upper / top - lower / bottom
    determinant = a_pull * b_lift - a_lift**2
    return a, b, b_lift / determinant, -a_lift / determinant, a_pull / determinant


@pytest.mark.parametrize("distance", ["1e-12", "1e-10", "1e-8", "1e-6", "1e-2"])
@pytest.mark.parametrize("stretch", ["1e-5", "1e-2"])
@pytest.mark.parametrize("lower", ["-0.7", "-0.1", "0.001", "0.5", "40", "900"])
def test_closed_form(lower, stretch, distance):
    # V at the lower end: a bight, a line whose lower end is all but free, taut ones
    with localcontext() as context:
        context.prec = 60
        lower, stretch, floor = Decimal(lower), Decimal(stretch), Decimal(SPAN_FLOOR)
        pull = Decimal(distance)
        for _ in range(60):  # H for about this distance: a/H hardly depends on H
            pull = Decimal(distance) * pull / closed_form(pull, lower, stretch)[0]
        apart, b, pull_a, pull_b, lift_b = closed_form(pull, lower, stretch)
        a = (apart**2 - floor**2).sqrt() if apart > floor else Decimal(0)
        share = a / apart  # the law takes √(a² + SPAN_FLOOR²) for a
        across = pull_a * share**2 + pull / apart * (1 - share**2)
        expected = -np.array([float(x) for x in (across, pull_b * share, pull_b * share, lift_b)]) * WEIGHT
        geometry = np.array([float(a), 0.0, -float(b)]) * LENGTH
    line = (geometry, LENGTH, np.array([0.0, 0.0, WEIGHT]), float(stretch) / (WEIGHT * LENGTH))
    slopes = np.asarray(stiffness(*(np.asarray(part)[None] for part in line)))[0]
    found = slopes[np.ix_([0, 2], [0, 2])].ravel() * np.array([1.0, -1.0, -1.0, 1.0])
    # b rounds by 1e-16, 1e-11 of a strain of 1e-5; mixed slopes of the smallest a are below a rounding of the others
    np.testing.assert_allclose(found, expected, rtol=1e-7, atol=1e-13 * abs(expected[-1]))
