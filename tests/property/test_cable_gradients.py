"""Derivatives of the cable's force: finite everywhere, equal to differences, and those of a potential.

Truth: central differences of the force itself, and thermodynamics: a cable at rest under a fixed load stores
energy, so its stiffness matrix is symmetric, and negative definite because the cable's shape is stable. If
this fails, the linear model of the tethered ship (modes, root loci, the implicit integrator's Jacobian) is
wrong or NaN exactly where the flight starts or ends: plumb, coincident, taut, without wind.
"""

import itertools

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership.physics.cable import ElasticCatenary, PublishedTension

JOINT_START, JOINT_END = 0.99, 1.05
STIFFNESS, LENGTH, WEIGHT = 69_760.0, 20.0, 0.08 * 9.80665  # Lotte's nose cable


def _elastic(stiffness, x):
    return jnp.concatenate(tuple(ElasticCatenary(stiffness).force(x[:3], x[3], x[4:])))


def _published(stiffness, x):
    law = PublishedTension(stiffness, jnp.asarray(JOINT_START), jnp.asarray(JOINT_END))
    return jnp.concatenate(tuple(law.force(x[:3], x[3], x[4:])))


LAWS = {"elastic_catenary": _elastic, "published": _published}
FORCE = {name: jax.jit(jax.vmap(law)) for name, law in LAWS.items()}
FORWARD = {name: jax.jit(jax.vmap(jax.jacfwd(law, argnums=1))) for name, law in LAWS.items()}
REVERSE = {name: jax.jit(jax.vmap(jax.jacrev(law, argnums=1))) for name, law in LAWS.items()}

CHORDS = {
    "up": (0, 0, -1),
    "down": (0, 0, 1),
    "level": (1, 0, 0),
    "oblique": (-np.sqrt(0.5), 0, -np.sqrt(0.5)),
}
ELONGATIONS = (0.0, 1e-300, 1e-14, 1e-6, 0.5, JOINT_START, 1.0 - 1e-12, 1.0, 1.0 + 1e-12, JOINT_END, 1.2, 3.0)
LOADS = {
    "none": (0, 0, 0),
    "weight": (0, 0, WEIGHT),
    "weight and wind": (2.0, 0.3, WEIGHT),
    "wind along the chord": (-WEIGHT * np.sqrt(0.5), 0, -WEIGHT * np.sqrt(0.5)),
    "almost none": (0, 0, 1e-12),
}


@pytest.mark.parametrize("name", LAWS)
def test_values_and_gradients_are_finite_everywhere(name):
    # plumb, coincident ends, taut, weightless and windless, e exactly 1, e_c and e_e, and all of them
    # together
    places = list(itertools.product(CHORDS, ELONGATIONS, LOADS))
    x = np.array([[*(e * LENGTH * np.array(CHORDS[c])), LENGTH, *LOADS[l]] for c, e, l in places])
    stiffness = np.full(len(x), STIFFNESS)
    for function in (FORCE, FORWARD, REVERSE):
        values = np.asarray(function[name](stiffness, x))
        bad = ~np.isfinite(values).reshape(len(x), -1).all(axis=1)
        assert not bad.any(), [places[i] for i in np.flatnonzero(bad)]


def _inputs(cases):
    x = np.concatenate([cases.span, cases.length[:, None], cases.load], axis=1)
    unit = np.stack([*[cases.length] * 4, *[cases.weight] * 3], axis=1)
    return x, unit


def _smooth_range(name, cases):
    """Return the distance, as a fraction of L, to what is not smooth: plumb, e = 1 and the joint's ends."""
    e = cases.elongation
    coming_taut = np.maximum(np.abs(e - 1.0), cases.stretch ** (2.0 / 3.0))
    if name == "published":
        coming_taut = np.minimum(np.abs(e - JOINT_START), np.abs(e - JOINT_END)) / 4.0
    return np.minimum(np.minimum(cases.across, coming_taut), 1.0)


@pytest.mark.parametrize("name", LAWS)
def test_jacobian_equals_central_differences(name, cables, cable_kind):
    cases = cables(cable_kind, 1000, seed=11, stretch=(1e-5, 1.0))
    x, unit = _inputs(cases)
    smooth = _smooth_range(name, cases)
    exact = np.asarray(FORWARD[name](cases.stiffness, x)) * unit[:, None, :]
    force = np.asarray(FORCE[name](cases.stiffness, x))
    # Every column is the change of force by one length L or one load w; a force rounds, so it counts as well.
    scale = np.linalg.norm(exact, axis=1) + np.linalg.norm(force, axis=1)[:, None]
    best = np.full((len(x), 7), np.inf)
    for fraction in (
        1e-2,
        2e-3,
        4e-4,
    ):  # truncation, fraction^4, and rounding, 1e-16/fraction, differ by case
        for column in range(7):
            step = np.zeros_like(x)
            step[:, column] = fraction * smooth * unit[:, column]
            f = {k: np.asarray(FORCE[name](cases.stiffness, x + k * step)) for k in (-2, -1, 1, 2)}
            difference = (8 * (f[1] - f[-1]) - (f[2] - f[-2])) / (12 * fraction * smooth)[:, None]
            error = np.linalg.norm(difference - exact[:, :, column], axis=1) / scale[:, column]
            best[:, column] = np.minimum(best[:, column], error)
    # Rounding of the force, 1e-16 EA = 1e-11 wL, over steps of 1e-4 x 2e-3 leaves 5e-5 wL of slopes that are
    # some 100 wL there; away from e = 1 the difference is 1e-9 and less.
    clear = smooth > 1e-4
    assert clear.mean() > 0.8  # the comparison is of nearly all cases, not of a few
    assert best[clear].max() < 1e-6


@pytest.mark.parametrize("name", LAWS)
def test_forward_and_reverse_mode_agree(name, cables, cable_kind):
    cases = cables(cable_kind, 1000, seed=12, stretch=(1e-6, 1.0))
    x, unit = _inputs(cases)
    forward = np.asarray(FORWARD[name](cases.stiffness, x)) * unit[:, None, :]
    reverse = np.asarray(REVERSE[name](cases.stiffness, x)) * unit[:, None, :]
    error = np.linalg.norm(forward - reverse, axis=(1, 2)) / np.linalg.norm(forward, axis=(1, 2))
    assert error.max() < 1e-9  # the same sums in another order; a taut light cable cancels some six digits


HANGING = ("slack", "near_plumb", "near_coincident")


@pytest.mark.parametrize(
    (
        "name",
        "kind",
    ),  # the joint of the published law is no catenary: it has no potential under a fixed load
    [("published", k) for k in HANGING] + [("elastic_catenary", k) for k in (*HANGING, "near_taut", "taut")],
)
def test_stiffness_matrix_is_that_of_a_stable_potential(name, kind, cables):
    cases = cables(kind, 5000, seed=13)
    x, unit = _inputs(cases)
    stiffness = (np.asarray(FORWARD[name](cases.stiffness, x)) * unit[:, None, :])[:, :3, :3]
    size = np.linalg.norm(stiffness, axis=(1, 2))
    skewed = np.linalg.norm(stiffness - stiffness.transpose(0, 2, 1), axis=(1, 2))
    # near plumb the direction across the load rounds by 1e-16 L/|d_perp|, up to 1e-12
    assert (skewed / size).max() < 1e-10
    softest = np.linalg.eigvalsh(0.5 * (stiffness + stiffness.transpose(0, 2, 1)))[:, -1]
    assert (softest < 0.0).all()  # the ship is pulled back whichever way it moves
