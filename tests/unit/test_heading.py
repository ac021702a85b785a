"""Heading law: the angle χ by hand on the compass, Eq. 42's signs, and the fade.

Truth: plane geometry. χ is positive with the anchor to port, and then #5 (port) goes astern, #6 (starboard) ahead:
the nose turns to port. If this failed, the ship would turn its back on the anchor.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import tethership as ts
from tethership.control import Measurement, misalignment
from tethership.spatial import rotation_matrix

GAIN = 5.0  # κ_χ, Table A.3
YAW_ARMS = np.array([0.0, 0.0, 0.0, 0.0, 1.9905, -1.9905])

angle_of = jax.jit(misalignment)


def chi(heading, offset, pitch=0.0, roll=0.0):
    return float(angle_of(np.array([roll, pitch, heading]), np.asarray(offset, dtype=float)))


@pytest.fixture(scope="module")
def law():
    return ts.load_scenario("docking").law(layers=("heading",), sas=False).laws[0]


@jax.jit
def throttle_of(law, attitude, offset):
    measurement = Measurement(
        velocity=jnp.zeros(3),
        rates=jnp.zeros(3),
        attitude=attitude,
        rate_of_climb=jnp.zeros(()),
        offset=offset[None],
        tension=jnp.zeros(1),
        length=jnp.ones(1),
        rewind_rate=jnp.ones(1),
    )
    correction, memory = law(jnp.zeros(()), measurement, ())
    assert memory == ()
    assert correction.rewind_rate == 0.0
    return correction.throttle


@pytest.mark.parametrize(
    ("heading", "offset", "expected"),
    [
        # Ship south of the anchor (ε = −10 north), so the anchor is due north of it.
        (0.0, [-10.0, 0.0, -5.0], 0.0),  # nose north: dead ahead
        (np.pi / 2, [-10.0, 0.0, -5.0], np.pi / 2),  # nose east: anchor abeam to port
        (-np.pi / 2, [-10.0, 0.0, -5.0], -np.pi / 2),  # nose west: to starboard
        (0.1, [-10.0, 0.0, 0.0], 0.1),  # nose ten centirad east of it: a little to port
        # Ship east of the anchor: the anchor is to the west, port of a nose pointing north.
        (0.0, [0.0, 10.0, -5.0], np.pi / 2),
        (0.0, [-10.0, 10.0, 3.0], np.pi / 4),
        (0.0, [-10.0, -10.0, 3.0], -np.pi / 4),
        (0.0, [10.0, 1.0, 0.0], np.pi - np.arctan(0.1)),  # overshot: astern, to port
    ],
)
def test_angle_on_the_compass(heading, offset, expected):
    assert chi(heading, offset) == pytest.approx(expected, abs=1e-14)  # one arctangent


@settings(deadline=None, derandomize=True, max_examples=60)
@given(
    heading=st.floats(-3.1, 3.1),
    bearing=st.floats(-3.1, 3.1),
    distance=st.floats(0.1, 30.0),
    height=st.floats(-20.0, 20.0),
    pitch=st.floats(-1.2, 1.2),
    roll=st.floats(-1.2, 1.2),
)
def test_angle_is_heading_less_bearing(heading, bearing, distance, height, pitch, roll):
    """Height, roll and pitch do not matter; χ = ψ − (bearing of the anchor), wrapped to ±π."""
    offset = [-distance * np.cos(bearing), -distance * np.sin(bearing), height]
    expected = np.angle(np.exp(1j * (heading - bearing)))
    difference = np.angle(np.exp(1j * (chi(heading, offset, pitch, roll) - expected)))
    assert abs(difference) < 1e-13  # angles of unit vectors, rounding only


@settings(deadline=None, derandomize=True, max_examples=40)
@given(heading=st.floats(-3.0, 3.0), bearing=st.floats(-3.0, 3.0))
def test_law_is_equation_42(law, heading, bearing):
    offset = np.array([-8.0 * np.cos(bearing), -8.0 * np.sin(bearing), -6.0])
    angle = chi(heading, offset)
    found = np.asarray(throttle_of(law, np.array([0.0, 0.0, heading]), offset))
    by_hand = [0.0, 0.0, 0.0, 0.0, -GAIN * angle, GAIN * angle]
    np.testing.assert_allclose(found, by_hand, rtol=1e-14, atol=1e-14)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_nose_turns_to_the_side_of_the_anchor(law, side):
    """Anchor to port (ship east of it): the moment of the thrusters is to port, negative about the down axis."""
    throttle = np.asarray(throttle_of(law, np.zeros(3), np.array([-10.0, 3.0 * side, -10.0])))
    assert (throttle @ YAW_ARMS) * side < 0
    assert throttle.sum() == 0.0  # no thrust ahead


def test_plumb_over_the_anchor_the_angle_is_taken_as_zero():
    """χ is undefined there; it and its slope must not be NaN."""
    for attitude in (jnp.zeros(3), jnp.array([0.1, -0.2, 1.0])):
        assert float(misalignment(attitude, jnp.array([0.0, 0.0, -10.0]))) == 0.0
        slope = jax.jacfwd(misalignment, argnums=(0, 1))(attitude, jnp.array([0.0, 0.0, -10.0]))
        assert all(bool(jnp.isfinite(part).all()) for part in slope)


def test_nose_straight_up_gives_a_number():
    """At 90° of pitch cos θ is 6e-17 in floating point, and what is left of the nose must not become a NaN."""
    upright = jnp.array([0.0, jnp.pi / 2, 0.0])
    assert abs(float(rotation_matrix(upright)[0, 0])) < 1e-16
    assert np.isfinite(chi(0.0, [-10.0, 1.0, 0.0], pitch=np.pi / 2))


@pytest.mark.parametrize(("distance", "weight"), [(8.0, 1.0), (4.0, 1.0), (3.0, 0.75), (1.0, 0.25), (0.01, 0.0025)])
def test_fade_is_linear_within_its_radius(law, distance, weight):
    fading = ts.load_scenario("docking", {"control.heading.fade_radius": 4.0})
    faded = fading.law(layers=("heading",), sas=False).laws[0]
    # The horizontal distance counts, not the height.
    offset = np.array([-0.6 * distance, 0.8 * distance, -9.0])
    full = np.asarray(throttle_of(law, np.zeros(3), offset))
    assert abs(full[5]) > 1.0
    np.testing.assert_allclose(np.asarray(throttle_of(faded, np.zeros(3), offset)), weight * full, rtol=1e-13)


def test_fade_takes_the_jump_out_of_the_law():
    """Passing 1 µm either side over the anchor, the unfaded command jumps by 5·π; the faded one does not."""
    fading = ts.load_scenario("docking", {"control.heading.fade_radius": 2.0})
    faded = fading.law(layers=("heading",), sas=False).laws[0]
    sharp = ts.load_scenario("docking").law(layers=("heading",), sas=False).laws[0]
    before, after = np.array([-1e-6, 1e-9, -1.0]), np.array([1e-6, 1e-9, -1.0])

    def jump(law):
        ends = [np.asarray(throttle_of(law, np.zeros(3), offset))[5] for offset in (before, after)]
        return abs(ends[1] - ends[0])

    assert jump(sharp) > 15.0  # ≈ 5π = 15.7
    assert jump(faded) < 1e-4  # 15.7 · 1e-6/2
