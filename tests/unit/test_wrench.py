"""Wrenches: moments about a point and how they change with it.

Truth: m = q x f by hand, the same load about another point, and power, which no choice of reference point may
change.
If this fails, a force at the nose turns the ship the wrong way, or the motion depends on where P is put.
"""

import jax
import jax.numpy as jnp
import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from tethership.spatial import Wrench

SETTINGS = settings(deadline=None, derandomize=True, max_examples=100)
vectors = st.tuples(*[st.floats(-100.0, 100.0, allow_subnormal=False)] * 3).map(jnp.array)

ATOL = 1e-9
"""Sums of products of three numbers up to 100: 1e6 times 1e-16, with a decade to spare."""


def test_a_downward_pull_at_the_nose_pitches_down():
    # Body axes nose, starboard, down: 10 N down, 2 m ahead of P, is -20 N m about starboard.
    np.testing.assert_array_equal(Wrench.at(jnp.array([2.0, 0, 0]), jnp.array([0, 0, 10.0])).moment, [0, -20, 0])


def test_as_vector_is_force_then_moment():
    load = Wrench(jnp.array([1.0, 2.0, 3.0]), jnp.array([4.0, 5.0, 6.0]))
    np.testing.assert_array_equal(load.as_vector(), [1, 2, 3, 4, 5, 6])


@SETTINGS
@given(vectors, vectors, vectors)
def test_moved_is_the_wrench_of_the_same_force_seen_from_the_new_point(point, force, offset):
    # `offset` goes from the new reference point to the old one, so the force is at offset + point from the
    # new.
    moved, direct = Wrench.at(point, force).moved(offset), Wrench.at(offset + point, force)
    np.testing.assert_allclose(moved.as_vector(), direct.as_vector(), atol=ATOL)


@SETTINGS
@given(vectors, vectors, vectors, vectors, vectors)
def test_power_does_not_depend_on_the_reference_point(force, moment, offset, velocity, rates):
    old = Wrench(force, moment)
    new = old.moved(offset)
    velocity_new = velocity - jnp.cross(rates, offset)  # new point = old point - offset, rigid body
    np.testing.assert_allclose(
        new.force @ velocity_new + new.moment @ rates,
        old.force @ velocity + old.moment @ rates,
        atol=1e-8,  # products of four numbers up to 100
    )


@SETTINGS
@given(vectors, vectors, vectors, vectors)
def test_sum_is_by_component_and_a_couple_stays(force, other, moment, offset):
    total = Wrench(force, moment) + Wrench(other, -moment)
    np.testing.assert_allclose(total.as_vector(), np.r_[force + other, np.zeros(3)], atol=ATOL)
    np.testing.assert_array_equal(Wrench(jnp.zeros(3), moment).moved(offset).moment, moment)


def test_wrench_is_a_pytree():
    doubled = jax.tree.map(lambda leaf: 2.0 * leaf, Wrench(jnp.ones(3), jnp.arange(3.0)))
    np.testing.assert_array_equal(doubled.as_vector(), [2, 2, 2, 0, 2, 4])
