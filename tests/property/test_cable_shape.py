"""The cable's curve: where it starts and ends, equilibrium, Hooke's law and its length.

Truth: at every point T dx/ds = (1 + T/EA) t, with t the load carried to there, and the two ends; together
these are the whole boundary-value problem, so nothing about the curve is left to chance. If this fails, the
drawn cable, its lowest point and the clearance to the ground belong to another cable than the force does.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership.physics.cable import ElasticCatenary, PublishedTension

COUNT = 3000
JOINT_START, JOINT_END = 0.99, 1.05


def _elastic(stiffness):
    return ElasticCatenary(stiffness)


def _published(stiffness):
    return PublishedTension(stiffness, jnp.asarray(JOINT_START), jnp.asarray(JOINT_END))


LAWS = {"elastic_catenary": _elastic, "published": _published}


def _curve(law):
    def curve(stiffness, span, length, load, fraction):
        """Return the anchor's force, the points at the fractions of length, and dx/ds there."""

        def place(arc):
            return law(stiffness).shape(span, length, load, arc)

        arc = fraction * length
        points, slope = jax.jvp(place, (arc,), (jnp.ones_like(arc),))
        return law(stiffness).force(span, length, load).anchor, points, slope

    return jax.jit(jax.vmap(curve))


CURVE = {name: _curve(law) for name, law in LAWS.items()}
ANCHOR = jax.jit(jax.vmap(lambda ea, d, length, load: _elastic(ea).force(d, length, load).anchor))
POINTS = jax.jit(jax.vmap(lambda ea, d, length, load, part: _elastic(ea).shape(d, length, load, part * length)))


def norm(vectors):
    return np.linalg.norm(vectors, axis=-1)


def traced(name, cases, fraction):
    return map(np.asarray, CURVE[name](*cases.arguments, fraction))


def tension_vector(cases, anchor, fraction):
    """Return t(s) = F_AP - l s: the pull at the anchor, less the load carried since."""
    return anchor[:, None, :] - (fraction * cases.length[:, None])[..., None] * cases.full_load[:, None, :]


def _random_fractions(count, seed):
    """Return sorted fractions of the length, 0 and 1 among them."""
    fraction = np.sort(np.random.default_rng(seed).random((count, 24)), axis=1)
    fraction[:, 0], fraction[:, -1] = 0.0, 1.0
    return fraction


@pytest.mark.parametrize("name", LAWS)
def test_curve_starts_at_the_anchor_and_ends_at_the_ship(name, cables, cable_kind):
    cases = cables(cable_kind, COUNT, seed=21)
    _, points, _ = traced(name, cases, _random_fractions(COUNT, 21))
    assert (points[:, 0] == 0.0).all()
    # the figure that benchmarks/README.md claims
    assert (norm(points[:, -1] - cases.span) <= 1e-9 * cases.length).all()


def test_curve_of_a_slack_cable_all_but_plumb_meets_the_ship():
    # 2e-12 L measured; SPAN_FLOOR alone moves a plumb end by 1e-12 L.
    rng = np.random.default_rng(22)
    across, along = 10.0 ** rng.uniform(-13.0, -4.0, COUNT), rng.uniform(-0.95, 0.95, COUNT)
    span = 20.0 * np.stack([across, np.zeros(COUNT), -along], axis=1)
    same = [np.full(COUNT, 69_760.0), span, np.full(COUNT, 20.0), np.tile([0, 0, 0.784532], (COUNT, 1))]
    _, points, _ = CURVE["elastic_catenary"](*same, np.ones((COUNT, 24)))
    assert (norm(points[:, -1] - span) <= 1e-11 * 20.0).all()


def test_elastic_curve_is_in_equilibrium_and_stretched_by_its_tension(cables, cable_kind):
    cases = cables(cable_kind, COUNT, seed=23)
    fraction = _random_fractions(COUNT, 23)
    anchor, _, slope = traced("elastic_catenary", cases, fraction)
    pull = tension_vector(cases, anchor, fraction)
    tension = norm(pull)[..., None]
    strain = tension / cases.stiffness[:, None, None]
    # near plumb, exp(2z) of the geometry multiplies rounding: |d_perp| = 3e-5 L leaves 2e-10
    assert norm(slope - (1.0 + strain) * pull / tension).max() < 1e-9
    assert np.abs(norm(slope) - (1.0 + strain[..., 0])).max() < 2e-11


@pytest.mark.parametrize("kind", ["slack", "near_plumb", "near_coincident"])
def test_published_curve_is_an_inextensible_catenary_where_it_hangs(kind, cables):
    cases = cables(kind, COUNT, seed=24)
    fraction = _random_fractions(COUNT, 24)
    anchor, _, slope = traced("published", cases, fraction)
    pull = tension_vector(cases, anchor, fraction)
    assert norm(slope - pull / norm(pull)[..., None]).max() < 1e-9  # as above
    assert np.abs(norm(slope) - 1.0).max() < 1e-10


def _slope_range(cases, anchor):
    """Return H [N], and asinh of the slope V/H at the anchor and at the ship."""
    upward = -cases.full_load / cases.weight[:, None]
    rise = (anchor * upward).sum(1)
    level = norm(anchor - rise[:, None] * upward)
    return level, rise, np.arcsinh(rise / level), np.arcsinh((rise + cases.weight * cases.length) / level)


def test_elastic_curve_has_the_stretched_length(cables, cable_kind):
    # Chords of the drawn curve, summed, against L + (1/EA) times the integral of T ds; no derivative of
    # either.
    cases = cables(cable_kind, 200, seed=25, stretch=(1e-6, 1.0))
    anchor = np.asarray(ANCHOR(*cases.arguments))
    level, rise, first, last = _slope_range(cases, anchor)
    # stations that are dense where the cable bends: equal steps of asinh(V/H)
    steps = np.linspace(0.0, 1.0, 2001)
    station = level[:, None] * np.sinh(first[:, None] + (last - first)[:, None] * steps) - rise[:, None]
    fraction = np.clip(station / (cases.weight * cases.length)[:, None], 0.0, 1.0)
    fraction[:, 0], fraction[:, -1] = 0.0, 1.0
    points = np.asarray(POINTS(*cases.arguments, fraction))
    fine, coarse = (norm(np.diff(points[:, ::k], axis=1)).sum(axis=1) for k in (1, 2))
    by_chords = fine + (fine - coarse) / 3.0  # Richardson: the error of chords is of second order
    # with V = H sinh(u): integral of T ds = (H^2/w) integral of cosh^2(u) du, by Gauss-Legendre
    nodes, weights = np.polynomial.legendre.leggauss(40)
    half = 0.5 * (last - first)
    u = (first + half)[:, None] + half[:, None] * nodes
    strain = level**2 / cases.weight * half * (np.cosh(u) ** 2 @ weights) / cases.stiffness
    # u runs over up to 25, steps of 0.0125: after Richardson 1e-2^4 and less
    np.testing.assert_allclose(by_chords, cases.length + strain, rtol=1e-9)


@pytest.mark.parametrize("elongation", [JOINT_END, 1.2])
def test_published_curve_is_the_chord_when_taut(elongation, cables):
    cases = cables("taut", COUNT, seed=26)
    span = (elongation / cases.elongation)[:, None] * cases.span
    fraction = _random_fractions(COUNT, 26)
    _, points, _ = traced("published", cases._replace(span=span), fraction)
    # e_e itself rounds: 1e-16/0.06 of the catenary may be left
    off = norm(points - fraction[..., None] * span[:, None]).max(axis=1)
    assert (off <= 1e-13 * cases.length).all()
