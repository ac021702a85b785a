"""Cables whose forces a textbook gives in closed form.

Verifies: both tension laws in their limits: level span, coincident ends, plumb, taut, shallow.
Source: the catenary y = c cosh(x/c), with two worked problems and their printed answers (lecture notes in
statics, "6.7 Cables: Catenaries", example 1, scribd 325770776; "Catenary problems", number 1, scribd
447009656); the bar hanging under its own weight; the parabola of a shallow elastic cable (Irvine, *Cable
Structures*, 1981).
If this fails, the general solution is wrong in the very cases that can be checked with pencil and paper.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership.physics.cable import ElasticCatenary, PublishedTension
from tethership.physics.cable.law import LOAD_FLOOR


def _elastic(stiffness, span, length, load):
    return ElasticCatenary(stiffness).force(span, length, load)


def _published(stiffness, span, length, load):
    return PublishedTension(stiffness, jnp.asarray(0.99), jnp.asarray(1.05)).force(span, length, load)


LAWS = {"elastic_catenary": jax.jit(_elastic), "published": jax.jit(_published)}
elastic = LAWS["elastic_catenary"]
RIGID = 1e13
"""EA [N] of a cable that all but does not stretch: strains of 1e-9 under the kilonewtons here."""

shape = jax.jit(lambda stiffness, d, length, load, arc: ElasticCatenary(stiffness).shape(d, length, load, arc))
STIFFNESS, LENGTH, WEIGHT = 69_760.0, 20.0, 0.08 * 9.80665


def down(weight):
    return np.array([0.0, 0.0, weight])


# ------------------------------------------------------------------------------------------------- level span


@pytest.mark.parametrize("name", LAWS)
def test_power_line_of_140_m(name):
    # Example 1: 140 m of 3 kg/m between towers 120 m apart; c = 61.45 m, sag 31.70 m, T = w (c + sag). Two
    # decimals are printed.
    w = 3.0 * 9.81
    force = LAWS[name](RIGID, np.array([120.0, 0.0, 0.0]), 140.0, down(w))
    assert -float(force.ship[0]) / w == pytest.approx(61.45, abs=5e-3)
    assert np.linalg.norm(force.ship) / w == pytest.approx(61.45 + 31.70, abs=1e-2)
    lowest = shape(RIGID, np.array([120.0, 0.0, 0.0]), 140.0, down(w), np.array([70.0]))
    assert float(lowest[0, 2]) == pytest.approx(31.70, abs=5e-3)


@pytest.mark.parametrize("name", LAWS)
def test_wire_of_625_ft(name):
    # Number 1: 625 ft of 2 lb/ft with 25 ft of sag: c = 15525/8 = 1940.625 ft, span 622.33 ft (printed to two
    # decimals; the sag is too sensitive to it, so it is computed), ends at 3931.25 lb. e = 0.9957 is in the
    # joint of the published law, so a joint that begins later is used for it.
    c = 15525.0 / 8.0
    span = 2.0 * c * np.arcsinh(312.5 / c)
    assert span == pytest.approx(622.33, abs=5e-3)
    if name == "published":
        late = PublishedTension(jnp.asarray(RIGID), jnp.asarray(0.9999), jnp.asarray(1.05))
        force = late.force(jnp.array([span, 0.0, 0.0]), jnp.asarray(625.0), jnp.array(down(2.0)))
    else:
        force = elastic(RIGID, np.array([span, 0.0, 0.0]), 625.0, down(2.0))
    # strain 4e-10 over a slack of 1 - e = 4e-3
    assert -float(force.ship[0]) == pytest.approx(2.0 * c, rel=1e-6)
    assert np.linalg.norm(force.ship) == pytest.approx(3931.25, rel=1e-6)  # 2 (c + 25), exact
    lowest = shape(RIGID, np.array([span, 0.0, 0.0]), 625.0, down(2.0), np.array([312.5]))
    assert float(lowest[0, 2]) == pytest.approx(25.0, rel=1e-6)


@pytest.mark.parametrize("name", LAWS)
@pytest.mark.parametrize("sag", [0.08, 0.2, 0.35, 0.45, 0.49])
def test_level_span_from_its_sag(name, sag):
    # H = w (L^2 - 4 f^2)/(8 f), half the weight at each end, T = H + w f.
    length, w = 30.0, 4.0
    f = sag * length
    h = w * (length**2 - 4.0 * f**2) / (8.0 * f)
    span = np.array([0.0, 2.0 * h / w * np.arcsinh(w * length / 2.0 / h), 0.0])
    force = LAWS[name](RIGID, span, length, down(w))
    # a strain T/EA of 1e-11, and LOAD_FLOOR, 1e-10 of 4 N/m
    np.testing.assert_allclose(force.ship, [0.0, -h, w * length / 2.0], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(force.anchor, [0.0, h, w * length / 2.0], rtol=1e-9, atol=1e-9)
    assert np.linalg.norm(force.ship) == pytest.approx(h + w * f, rel=1e-9)
    lowest = shape(RIGID, span, length, down(w), np.array([length / 2.0]))[0]
    np.testing.assert_allclose(lowest, [0.0, span[1] / 2.0, f], rtol=1e-9, atol=1e-9 * length)


# ------------------------------------------------------------------------------------------------------ plumb


@pytest.mark.parametrize("name", LAWS)
def test_loop_from_one_point_weighs_half_on_each_end(name):
    force = LAWS[name](STIFFNESS, np.zeros(3), LENGTH, down(WEIGHT))
    # LOAD_FLOOR is 1e-10 of 0.8 N/m; SPAN_FLOOR leaves no horizontal part here at all
    np.testing.assert_allclose(force.ship, down(WEIGHT * LENGTH / 2.0), rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(force.anchor, down(WEIGHT * LENGTH / 2.0), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("height", [-0.9, -0.3, 0.4, 0.97])
def test_bight_below_two_points_one_above_the_other(height):
    # Two straight legs of unstretched lengths a (ship) and b: a + b = L, and the legs' difference, stretched
    # by their own weight, is the height: (a - b) + (w/2EA)(a^2 - b^2) = h, so a - b = h/(1 + wL/2EA). Each
    # end carries its leg.
    span = np.array([0.0, 0.0, -height * LENGTH])
    leg = 0.5 * (LENGTH + height * LENGTH / (1.0 + WEIGHT * LENGTH / 2.0 / STIFFNESS))
    soft = elastic(STIFFNESS, span, LENGTH, down(WEIGHT))
    np.testing.assert_allclose(soft.ship, down(WEIGHT * leg), rtol=1e-9, atol=1e-12)  # LOAD_FLOOR
    rigid = LAWS["published"](STIFFNESS, span, LENGTH, down(WEIGHT))
    np.testing.assert_allclose(rigid.ship, down(WEIGHT * 0.5 * (1.0 + height) * LENGTH), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("height", [1.001, 1.01, 1.05, -1.02])
def test_taut_line_straight_up_under_its_own_weight(height):
    # A hanging bar: mean strain (V_mean)/EA = |h|/L - 1, and V falls by wL from the upper end to the lower.
    span = np.array([0.0, 0.0, -height * LENGTH])
    mean = STIFFNESS * (abs(height) - 1.0)
    force = elastic(STIFFNESS, span, LENGTH, down(WEIGHT))
    upper, lower = (force.ship, force.anchor) if height > 0 else (force.anchor, force.ship)
    # rounding of the strain, 2e-16, times EA; LOAD_FLOOR
    np.testing.assert_allclose(upper, down(mean + WEIGHT * LENGTH / 2.0), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(lower, -down(mean - WEIGHT * LENGTH / 2.0), rtol=1e-9, atol=1e-9)


def test_bar_that_hangs_from_the_ship_with_its_lower_end_free():
    # Its own weight stretches it by wL^2/2EA; held at exactly that height its lower end carries nothing.
    height = LENGTH * (1.0 + WEIGHT * LENGTH / 2.0 / STIFFNESS)
    force = elastic(STIFFNESS, np.array([0.0, 0.0, -height]), LENGTH, down(WEIGHT))
    np.testing.assert_allclose(force.ship, down(WEIGHT * LENGTH), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(force.anchor, np.zeros(3), atol=1e-6 * WEIGHT * LENGTH)


# ------------------------------------------------------------------------------------------ straight, shallow


@pytest.mark.parametrize("elongation", [1.001, 1.01, 1.05, 1.5])
@pytest.mark.parametrize("chord", [(1.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.36, -0.48, 0.8)])
def test_massless_line_is_a_spring(chord, elongation):
    force = elastic(STIFFNESS, elongation * LENGTH * np.array(chord), LENGTH, np.zeros(3))
    pull = STIFFNESS * (elongation - 1.0) * np.array(chord)
    # LOAD_FLOOR weighs 2e-9 N; rounding of the strain times EA is 2e-11 N
    np.testing.assert_allclose(force.ship, -pull, atol=1e-8)
    np.testing.assert_allclose(force.anchor, pull, atol=1e-8)


def test_level_cable_as_long_as_its_span_pulls_with_the_cube_root():
    # Parabola of a shallow cable: its length exceeds the span by theta^2/24, theta = wL/H, which is the
    # strain H/EA; so H = (EA (wL)^2/24)^(1/3) at e = 1. The next term of (2/theta) asinh(theta/2), 3
    # theta^4/640, lowers H by 3/80 theta^2.
    for w in (1e-3, 1e-6):
        force = elastic(STIFFNESS, np.array([LENGTH, 0.0, 0.0]), LENGTH, down(w - LOAD_FLOOR))
        parabola = np.cbrt(STIFFNESS * (w * LENGTH) ** 2 / 24.0)
        missing = 1.0 + float(force.ship[0]) / parabola
        # theta^2 is 4e-4 and 4e-6; rounding of e, 1e-16 EA, is 1e-9 of H
        assert missing == pytest.approx(3.0 / 80.0 * (w * LENGTH / parabola) ** 2, rel=5e-3)
