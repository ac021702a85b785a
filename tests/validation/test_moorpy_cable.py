"""Both catenaries against an independent code.

Verifies: end forces of `elastic_catenary` and `published` (its catenary).
Source: MoorPy 1.3 (NREL), `moorpy.Catenary.catenary`, Newton on the two forces of the classical pair; nothing
shared with ours, which solves one equation for one dimensionless root.
Notes: MoorPy puts the ends in a vertical plane, z up, and returns the pull of the line on its ends A (anchor)
and B. A negative CB is the depth of the seabed below A: 1 000 m here, so that no line touches it.
If this fails, one of two codes written from one textbook is wrong, and the closed forms tell which.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from moorpy.Catenary import catenary

from tethership.physics.cable import ElasticCatenary, PublishedTension

STIFFNESS, LENGTH, WEIGHT = 69_760.0, 20.0, 0.08 * 9.80665
ELEVATIONS = (-80.0, -45.0, -5.0, 0.0, 5.0, 30.0, 45.0, 75.0, 85.0)

elastic = jax.jit(lambda d, load: ElasticCatenary(jnp.asarray(STIFFNESS)).force(d, jnp.asarray(LENGTH), load))
published = jax.jit(
    lambda d, load: PublishedTension(jnp.asarray(STIFFNESS), jnp.asarray(0.99), jnp.asarray(1.05)).force(
        d, jnp.asarray(LENGTH), load
    )
)


def _moorpy(across, along, weight, stiffness):
    """Return the pull on the anchor and on the ship, each across the load and along it [N]."""
    # Tol is the distance [m] by which MoorPy may miss the end
    *pull, info = catenary(across, along, LENGTH, stiffness, weight, CB=-1000.0, Tol=1e-9, MaxIter=200)
    assert info["ProfileType"] == 1  # a line in mid-air, solved; not one of the fallbacks
    (a_x, a_z, b_x, b_z) = pull
    return np.array([a_x, -a_z]), np.array([b_x, -b_z])


def _ours(force, across, down):
    """Return the same components of a solution of ours."""
    axes = np.stack([across, down])
    return axes @ np.asarray(force.anchor), axes @ np.asarray(force.ship)


def _disagreement(force, across, down, expected):
    found = _ours(force, across, down)
    largest = max(np.linalg.norm(end) for end in expected)
    return max(np.linalg.norm(f - e) for f, e in zip(found, expected, strict=True)) / largest


NORTH, DOWN = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("elongation", [0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999, 1.0, 1.001, 1.01, 1.05])
def test_elastic_catenary_under_its_weight(elongation):
    for elevation in np.radians(ELEVATIONS):
        x, z = elongation * LENGTH * np.cos(elevation), elongation * LENGTH * np.sin(elevation)
        expected = _moorpy(x, z, WEIGHT, STIFFNESS)
        force = elastic(jnp.array([x, 0.0, -z]), jnp.array([0.0, 0.0, WEIGHT]))
        # MoorPy's 1e-9 m times EA/L is 3.5e-6 N of tensions of 40 N and more where the line comes taut
        assert _disagreement(force, NORTH, DOWN, expected) < 1e-7


@pytest.mark.parametrize("elongation", [0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98])
def test_published_catenary_under_its_weight(elongation):
    for elevation in np.radians(ELEVATIONS):
        x, z = elongation * LENGTH * np.cos(elevation), elongation * LENGTH * np.sin(elevation)
        expected = _moorpy(x, z, WEIGHT, 1e9)  # strains of 1e-7 and less: as good as inextensible
        force = published(jnp.array([x, 0.0, -z]), jnp.array([0.0, 0.0, WEIGHT]))
        # a strain of 1e-7 changes 1 - e, the sag, by 1e-7/0.02
        assert _disagreement(force, NORTH, DOWN, expected) < 1e-5


def test_elastic_catenary_under_loads_from_any_side():
    # Weight and wind are one uniform load: MoorPy's plane is then that of the chord and the load.
    rng = np.random.default_rng(41)
    for _ in range(100):
        load = np.array([*rng.normal(0.0, 1.0, 2), WEIGHT])
        weight = np.linalg.norm(load)
        down = load / weight
        chord = rng.normal(size=3)
        span = rng.uniform(0.2, 1.05) * LENGTH * chord / np.linalg.norm(chord)
        along = -span @ down
        across = span + along * down
        x = np.linalg.norm(across)
        if x < 0.02 * LENGTH:  # MoorPy has a special case near plumb
            continue
        expected = _moorpy(x, along, weight, STIFFNESS)
        assert _disagreement(elastic(jnp.array(span), jnp.array(load)), across / x, down, expected) < 1e-7
