"""What must hold of both tension laws for any cable: balance, frames, units, continuity, and their root.

Truth: invariances that no geometry may break, and the classical pair of equations of the extensible catenary
(Irvine, *Cable Structures*, 1981, section 1.3) written out again here in extended precision. If this fails,
the ship feels a force that the anchor does not give back, the cable knows where north is, or tension jumps
while the cable comes taut, which is when it peaks.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tethership.physics.cable import ElasticCatenary, PublishedTension
from tethership.physics.cable.catenary import root
from tethership.physics.cable.law import LOAD_FLOOR

COUNT = 5000
JOINT_START, JOINT_END = 0.99, 1.05
FLOOR = np.array([0.0, 0.0, LOAD_FLOOR])
STIFFNESS, LENGTH, WEIGHT = 69_760.0, 20.0, 0.08 * 9.80665  # Lotte's nose cable
SETTINGS = settings(deadline=None, derandomize=True, max_examples=300)


def elastic(stiffness):
    return ElasticCatenary(jnp.asarray(stiffness))


def published(stiffness):
    return PublishedTension(jnp.asarray(stiffness), jnp.asarray(JOINT_START), jnp.asarray(JOINT_END))


LAWS = {"elastic_catenary": elastic, "published": published}
SINGLE = {
    name: jax.jit(lambda ea, d, length, load, law=law: law(ea).force(d, length, load)) for name, law in LAWS.items()
}
BATCH = {
    name: jax.jit(jax.vmap(lambda ea, d, length, load, law=law: law(ea).force(d, length, load)))
    for name, law in LAWS.items()
}


def norm(vectors):
    return np.linalg.norm(vectors, axis=-1)


def forces(name, cases):
    force = BATCH[name](*cases.arguments)
    return np.asarray(force.ship), np.asarray(force.anchor)


def rounding(cases, ship):
    """Return the change of force [N] by which a relative error of 3e-14 in geometry or arithmetic shows.

    Some three hundred roundings of 1.1e-16. A cable that comes taut multiplies errors of position by EA/L, so
    that EA counts there beside weight and force.
    """
    amplified = cases.stiffness * (cases.elongation > 0.9)
    return 3e-14 * (cases.weight * cases.length + norm(ship) + amplified)


# ----------------------------------------------------------------------------------------- balance and frames


@pytest.mark.parametrize("name", LAWS)
def test_both_ends_together_carry_the_load(name, cables, cable_kind):
    cases = cables(cable_kind, COUNT, seed=1)
    ship, anchor = forces(name, cases)
    hanging = np.ones(COUNT) if name == "elastic_catenary" else 1.0 - _joint_share(cases.elongation)
    # the published law's joint fades the load out: what is left beyond e_c is (1 - share) L l, nothing when
    # taut
    expected = (hanging * cases.length)[:, None] * cases.full_load
    assert (norm(ship + anchor - expected) <= rounding(cases, ship)).all()


@pytest.mark.parametrize("name", LAWS)
def test_swapped_ends_feel_swapped_forces(name, cables, cable_kind):
    # The anchor's force is computed from the ship's; solving the same cable from its other end is a second
    # opinion.
    cases = cables(cable_kind, COUNT, seed=2)
    ship, anchor = forces(name, cases)
    other_ship, other_anchor = forces(name, cases._replace(span=-cases.span))
    assert (norm(anchor - other_ship) <= rounding(cases, ship)).all()
    assert (norm(ship - other_anchor) <= rounding(cases, ship)).all()


@pytest.mark.parametrize("name", LAWS)
def test_turning_span_and_load_turns_the_force(name, cables, cable_kind):
    cases = cables(cable_kind, COUNT, seed=3)
    turn = Rotation.random(COUNT, random_state=3).as_matrix()

    def turned(vectors):
        return np.einsum("nij,nj->ni", turn, vectors)

    ship, anchor = forces(name, cases)
    after = forces(name, cases._replace(span=turned(cases.span), load=turned(cases.full_load) - FLOOR))
    limit = 3.0 * rounding(cases, ship)  # the turning itself rounds
    assert (norm(after[0] - turned(ship)) <= limit).all()
    assert (norm(after[1] - turned(anchor)) <= limit).all()


@pytest.mark.parametrize("name", LAWS)
def test_a_longer_cable_of_the_same_proportions_pulls_in_proportion(name, cables, cable_kind):
    # Dimensional analysis: lengths times 3, load times 7, stiffness times 21 give 21 times the force.
    cases = cables(cable_kind, COUNT, seed=4)
    ship, _ = forces(name, cases)
    larger, _ = forces(
        name,
        cases._replace(
            stiffness=21.0 * cases.stiffness,
            span=3.0 * cases.span,
            length=3.0 * cases.length,
            load=7.0 * cases.full_load - FLOOR,
        ),
    )
    assert (norm(larger / 21.0 - ship) <= 3.0 * rounding(cases, ship)).all()


@pytest.mark.parametrize("name", LAWS)
def test_batch_is_the_loop(name, cables, cable_kind):
    cases = cables(cable_kind, 40, seed=5)
    ship, anchor = forces(name, cases)
    for i in range(40):
        single = SINGLE[name](*(argument[i] for argument in cases.arguments))
        limit = rounding(cases, ship)[i]  # vectorised exp and log may round otherwise
        assert norm(single.ship - ship[i]) <= limit
        assert norm(single.anchor - anchor[i]) <= limit


def test_stiff_elastic_cable_is_the_published_catenary_where_it_hangs(cables):
    # Below e = 0.97 the strain, at most a few wL/EA, changes the shape's proportions by as much.
    cases = cables("slack", COUNT, seed=6, stretch=(1e-12, 1e-11))
    soft, _ = forces("elastic_catenary", cases)
    rigid, _ = forces("published", cases)
    assert (norm(soft - rigid) / norm(rigid)).max() < 1e-9


@pytest.mark.parametrize("name", LAWS)
def test_a_cable_without_weight_and_wind_pulls_only_when_taut(name):
    chord = np.array([0.6, 0.0, -0.8])
    slack = SINGLE[name](STIFFNESS, 0.7 * LENGTH * chord, LENGTH, np.zeros(3))
    assert norm(slack.ship) < 3e-9  # LOAD_FLOOR times 20 m is 2e-9 N
    assert np.isfinite(slack.anchor).all()
    coincident = SINGLE[name](STIFFNESS, np.zeros(3), LENGTH, np.zeros(3))
    assert norm(coincident.ship) < 3e-9
    taut = SINGLE[name](STIFFNESS, 1.06 * LENGTH * chord, LENGTH, np.zeros(3))
    strain = 0.06 if name == "elastic_catenary" else 1.06 - JOINT_START
    # rounding of the strain, 2e-16 of 1.06, times EA; a share of the LOAD_FLOOR
    np.testing.assert_allclose(taut.ship, -STIFFNESS * strain * chord, atol=1e-8)


# ---------------------------------------------------------------------------------------- regimes, continuity


def _joint_share(elongation):
    return np.clip((elongation - JOINT_START) / (JOINT_END - JOINT_START), 0.0, 1.0)


def test_regimes_are_named_by_elongation():
    e = jnp.array([0.5, 0.98999, 0.99, 1.0, 1.05, 1.0501])
    np.testing.assert_array_equal(published(STIFFNESS).regime(e), [0, 0, 1, 1, 1, 2])
    np.testing.assert_array_equal(elastic(STIFFNESS).regime(e), [0, 0, 0, 2, 2, 2])


@pytest.mark.parametrize("corner", [JOINT_START, JOINT_END])
def test_published_law_is_continuous_across_the_joint(corner, cables):
    cases = cables("slack", COUNT, seed=7, stretch=(1e-6, 1e-3))
    # Straight up is left out: there the catenary at e_c is itself steep.
    chord = cases.span / norm(cases.span)[:, None]

    def at(elongation):
        return forces("published", cases._replace(span=(elongation * cases.length)[:, None] * chord))[0]

    on = at(np.full(COUNT, corner))
    for gap in (1e-6, 1e-9):
        for side in (-1.0, 1.0):
            near = at(np.full(COUNT, corner + side * gap))
            # The steepest slope is the joint's, about K0, and the catenary's below e_c, under 100 wL.
            slope = 2.0 * cases.stiffness + 100.0 * cases.weight * cases.length
            assert (norm(near - on) <= slope * gap + 1e-13 * cases.stiffness).all()


def test_published_law_meets_its_two_neighbours():
    chord = np.array([-np.sqrt(0.5), 0.0, -np.sqrt(0.5)])
    load = np.array([0.0, 0.0, WEIGHT])
    end = SINGLE["published"](STIFFNESS, JOINT_END * LENGTH * chord, LENGTH, load)
    # K0 (e_e - e_c), rounding of e times K0
    np.testing.assert_allclose(end.ship, -STIFFNESS * (JOINT_END - JOINT_START) * chord, rtol=1e-12)
    np.testing.assert_allclose(end.anchor, -end.ship, rtol=1e-12)
    middle = SINGLE["published"](STIFFNESS, 1.02 * LENGTH * chord, LENGTH, load)
    start = SINGLE["published"](STIFFNESS, JOINT_START * LENGTH * chord, LENGTH, load)
    np.testing.assert_allclose(middle.ship, 0.5 * (start.ship + end.ship), rtol=1e-12)  # 1.02 is half-way


def test_published_law_has_a_corner_where_the_joint_begins():
    # The reason why eigenvalues jump at e_c: the slope of tension grows there by more than ten times.
    def tension(e):
        chord = jnp.array([-np.sqrt(0.5), 0.0, -np.sqrt(0.5)])
        force = published(STIFFNESS).force(e * LENGTH * chord, jnp.asarray(LENGTH), jnp.array([0.0, 0.0, WEIGHT]))
        return jnp.linalg.norm(force.ship)

    below, above = (float(jax.grad(tension)(JOINT_START + side)) for side in (-1e-6, 1e-6))
    assert above > 10.0 * below > 0.0


@jax.jit
@jax.vmap
def _tension_and_slope(elongation, elevation, stretch):
    """Return |F_TP| of a cable of unit length and load, and its slope with e."""

    def tension(e):
        span = e * jnp.stack([jnp.cos(elevation), 0.0, -jnp.sin(elevation)])
        force = elastic(1.0 / stretch).force(span, jnp.asarray(1.0), jnp.array([0.0, 0.0, 1.0 - LOAD_FLOOR]))
        return jnp.linalg.norm(force.ship)

    return jax.value_and_grad(tension)(elongation)


@pytest.mark.parametrize("stretch", [1e-9, 2.25e-4, 0.1])
@pytest.mark.parametrize("elevation", [0.0, 45.0, -45.0, 80.0])
def test_elastic_catenary_comes_taut_without_a_corner(stretch, elevation):
    # Coming taut takes a range of e of about (wL/EA)^(2/3). Across it a corner would show as a step of the
    # slope that does not shrink with the step of e; a smooth law's halves with it.
    width = stretch ** (2.0 / 3.0)
    largest = []
    for steps in (2000, 4000):
        e = 1.0 + width * np.linspace(-6.0, 6.0, steps + 1)
        slope = np.asarray(_tension_and_slope(e, np.full_like(e, np.radians(elevation)), np.full_like(e, stretch))[1])
        largest.append(np.abs(np.diff(slope)).max() / slope.max())
    assert largest[0] < 0.04  # of the whole change of slope, from that of the slack cable to EA; 0.029 at 80 degrees
    assert largest[1] == pytest.approx(largest[0] / 2, rel=0.02)  # terms of second order in the step


@pytest.mark.parametrize("stretch", [1e-9, 2.25e-4, 0.1])
def test_elastic_catenary_has_one_slope_on_both_sides_of_one(stretch):
    width = stretch ** (2.0 / 3.0)
    gaps = []
    for h in (1e-3 * width, 1e-4 * width):
        e = np.array([1.0 - h, 1.0, 1.0 + h])
        tension, slope = map(np.asarray, _tension_and_slope(e, np.full(3, 0.6), np.full(3, stretch)))
        below, above = np.diff(tension) / h
        gaps.append(abs(above - below) / slope[1])
        assert below == pytest.approx(slope[1], rel=2e-3)  # curvature times h/2
        assert above == pytest.approx(slope[1], rel=2e-3)
    assert gaps[1] < 0.2 * gaps[0]  # proportional to h


# -------------------------------------------------------------------------------------------------- equations


def _classical_end(cases, anchor):
    """Return where the extensible catenary ends that pulls its anchor by `anchor` (Irvine, section 1.3)."""
    exact = np.longdouble
    load, pull = cases.full_load.astype(exact), anchor.astype(exact)
    length, stiffness = cases.length.astype(exact), cases.stiffness.astype(exact)
    w = np.sqrt((load**2).sum(1))
    upward = -load / w[:, None]
    v_0 = (pull * upward).sum(1)
    level = pull - v_0[:, None] * upward
    h = np.sqrt((level**2).sum(1))
    v = v_0 + w * length
    p, q = v / h, v_0 / h
    t, t_0 = np.hypot(h, v), np.hypot(h, v_0)
    # asinh p - asinh q; where both have one sign by the addition theorem, so that nothing cancels in a taut
    # cable
    same = (w * length / h) * (p + q) / (p * np.hypot(1, q) + q * np.hypot(1, p))
    bracket = np.where(p * q > 0, np.arcsinh(same), np.arcsinh(p) - np.arcsinh(q))
    across = h * length / stiffness + h / w * bracket
    along = length / stiffness * (v - w * length / 2) + length * (v + v_0) / (t + t_0)
    return (across / h)[:, None] * level + along[:, None] * upward


def test_elastic_forces_satisfy_the_classical_pair(cables, cable_kind):
    cases = cables(cable_kind, 20_000, seed=8)
    _, anchor = forces("elastic_catenary", cases)
    gap = norm((_classical_end(cases, anchor) - cases.span).astype(float)) / cases.length
    # of the length: rounding of the forces, 1e-16 of a strain of 0.1 and of a shape of 1, times a decade or
    # two
    assert gap.max() < 1e-13


def _residual(z, across, along, stretch):
    """Return the left side of equation (*) of catenary.py less its right side, 1."""
    s = 1.0 + 0.5 * stretch / np.tanh(z)
    return across * (np.sinh(z) / (z + 0.5 * stretch)) ** 2 + (along / s) ** 2 - 1.0


# z runs up to 32, and exp(2z) in the equation multiplies its rounding by some 100.
RESIDUAL = 1e-12

one_root = jax.jit(root)
roots = jax.jit(jax.vmap(root))


@SETTINGS
@given(st.floats(-12.0, 1.0), st.floats(-1.5, 1.5), st.one_of(st.just(-np.inf), st.floats(-16.0, 0.0)))
def test_root_satisfies_its_equation(log_across, along, log_stretch):
    across, stretch = 10.0 ** (2.0 * log_across), 10.0**log_stretch
    if stretch == 0.0:
        assume(across + along**2 < 0.9999)  # an inextensible cable cannot be longer than itself
    z = float(one_root(across, along, stretch))
    assert z > 0.0
    assert abs(_residual(z, across, along, stretch)) < RESIDUAL


def test_root_satisfies_its_equation_where_the_cable_comes_taut():
    rng = np.random.default_rng(9)
    count = 200_000
    stretch = 10.0 ** rng.uniform(-16.0, 0.0, count)
    elevation = np.arcsin(rng.uniform(-1.0, 1.0, count))
    e = 1.0 + rng.choice([-1, 1], count) * 10.0 ** rng.uniform(-12, -1, count)
    across, along = (e * np.cos(elevation)) ** 2, e * np.sin(elevation)
    residual = _residual(np.asarray(roots(across, along, stretch)), across, along, stretch)
    assert np.abs(residual).max() < RESIDUAL


def test_root_satisfies_its_equation_where_a_plumb_line_just_hangs_straight():
    # The hardest place: |b| = 1 + eps/2, where the lower end is just free of tension, and a << eps. Newton from
    # a start at the root of the hanging cable, ln(eps/a^2)/2, is slow: the root is at half of that.
    rng = np.random.default_rng(10)
    count = 200_000
    stretch = 10.0 ** rng.uniform(-12.0, 0.0, count)
    across = 10.0 ** rng.uniform(-24.0, -2.0, count)
    off = rng.choice([-1, 1], count) * 10.0 ** rng.uniform(-14.0, -1.0, count)
    along = rng.choice([-1, 1], count) * (1.0 + 0.5 * stretch) * (1.0 + off)
    residual = _residual(np.asarray(roots(across, along, stretch)), across, along, stretch)
    assert np.abs(residual).max() < RESIDUAL
