"""The load on a cable: weight and wind, by the cross-flow principle and by the paper's Eqs. 14-18.

Truth: the paper's form, with its angle, drag and lift, written out here; Hoerner's limits of flow across and
along; and that air drag takes energy. If this fails, the cable of a ship in wind sags the wrong way, or the
linear model is NaN when the wind blows along the cable or not at all.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from tethership.physics.cable import CableLoad

CROSS, ALONG, DIAMETER, LINEAR_DENSITY = 1.1, 0.02, 0.010, 0.080
LOAD = CableLoad(*map(jnp.asarray, (DIAMETER, LINEAR_DENSITY, CROSS, ALONG)))
WEIGHT = np.array([0.0, 0.0, 0.080 * 9.80665])
COUNT = 5000


def _per_length(density, velocity, span):
    return LOAD.per_length(density, velocity, span)


per_length = jax.jit(_per_length)
batch = jax.jit(jax.vmap(_per_length))


def norm(vectors):
    return np.linalg.norm(vectors, axis=-1, keepdims=True)


def _random(seed):
    rng = np.random.default_rng(seed)
    velocity = rng.normal(size=(COUNT, 3)) * 10.0 ** rng.uniform(-3, 1.5, (COUNT, 1))
    span = rng.normal(size=(COUNT, 3)) * 10.0 ** rng.uniform(-2, 2, (COUNT, 1))
    return rng.uniform(0.8, 1.3, COUNT), velocity, span


def _riboldi(density, velocity, span):
    """Return the load of Eqs. 14-18: drag along the airspeed, lift across it, both by the angle alpha."""
    speed = norm(velocity)
    h = velocity / speed
    j = -span / norm(span)
    axial = (velocity * j).sum(1, keepdims=True)
    alpha = np.arctan2(norm(velocity - j * axial), axial)  # Eq. 16
    pressure = 0.5 * density[:, None] * DIAMETER * speed**2
    drag = -pressure * (CROSS * np.abs(np.sin(alpha) ** 3) + ALONG) * h  # Eq. 15
    j_across = j - h * (h * j).sum(1, keepdims=True)
    k = np.sign((j * h).sum(1, keepdims=True)) * j_across / norm(j_across)  # Eq. 17
    lift = pressure * CROSS * np.abs(np.sin(alpha) ** 2 * np.cos(alpha)) * k  # Eq. 18
    return WEIGHT + drag + lift


def test_equals_the_papers_drag_and_lift():
    density, velocity, span = _random(31)
    found, expected = batch(density, velocity, span), _riboldi(density, velocity, span)
    # rounding; the paper's k divides by sin(alpha), which multiplies it by up to 1/sin, some 100 in 5 000
    # draws
    np.testing.assert_array_less(norm(found - expected), 1e-13 * norm(expected) + 1e-16)


def test_without_wind_it_is_the_weight():
    _, _, span = _random(32)
    np.testing.assert_array_equal(batch(np.full(COUNT, 1.2), np.zeros((COUNT, 3)), span), np.tile(WEIGHT, (COUNT, 1)))


@pytest.mark.parametrize(
    ("velocity", "coefficient"),
    [
        (
            (0.0, 10.0, 0.0),
            CROSS + ALONG,
        ),  # straight across: Hoerner's cylinder, 1.1 on the diameter, and friction
        ((10.0, 0.0, 0.0), ALONG),  # straight along: friction only
        ((-10.0, 0.0, 0.0), ALONG),
    ],
)
def test_flow_across_and_along_by_hand(velocity, coefficient):
    # q D = 0.5 x 1.225 x 100 x 0.01 = 0.6125 N/m
    load = per_length(1.225, jnp.array(velocity), jnp.array([7.0, 0.0, 0.0]))
    np.testing.assert_allclose(load - WEIGHT, -0.06125 * coefficient * np.array(velocity), rtol=1e-14)


def test_cross_flow_principle_at_45_degrees():
    # The component across, V sin 45, counts alone: a normal load of half that of flow straight across.
    v = 10.0 * np.sqrt(0.5)
    load = per_length(1.225, jnp.array([v, v, 0.0]), jnp.array([1.0, 0.0, 0.0])) - WEIGHT
    np.testing.assert_allclose(load, [-0.6125 * ALONG * np.sqrt(0.5), -0.6125 * (CROSS / 2 + ALONG * np.sqrt(0.5)), 0])


def test_air_takes_energy_from_the_cable():
    density, velocity, span = _random(33)
    power = ((np.asarray(batch(density, velocity, span)) - WEIGHT) * velocity).sum(1)
    assert (power < 0.0).all()


def test_which_end_is_called_the_anchor_does_not_matter():
    density, velocity, span = _random(34)
    np.testing.assert_allclose(batch(density, velocity, span), batch(density, velocity, -span), rtol=1e-15, atol=1e-18)


def test_load_does_not_depend_on_the_distance_of_the_ends():
    density, velocity, span = _random(35)
    near, far = batch(density, velocity, span), batch(density, velocity, 1e3 * span)
    np.testing.assert_array_less(norm(near - far), 1e-14 * norm(near))


def test_coincident_ends_take_the_whole_wind_as_cross_flow():
    load = per_length(1.225, jnp.array([6.0, 0.0, 8.0]), jnp.zeros(3)) - WEIGHT
    np.testing.assert_allclose(load, -0.06125 * (CROSS + ALONG) * np.array([6.0, 0.0, 8.0]), rtol=1e-14)


SPAN = jnp.array([-9.0, 2.0, -11.0])


@pytest.mark.parametrize(
    ("velocity", "span"),
    [
        (jnp.zeros(3), SPAN),
        (0.7 * SPAN, SPAN),  # parallel to the cable: sqrt(1 - cos^2) would have a NaN here
        (-0.7 * SPAN, SPAN),
        (jnp.array([6.0, 0.0, 0.0]), jnp.array([-3.0, 0.0, 0.0])),  # parallel to the last bit
        (jnp.zeros(3), jnp.zeros(3)),
        (jnp.array([6.0, 0.0, 0.0]), jnp.zeros(3)),
        (jnp.array([1e-200, 0.0, 0.0]), SPAN),
    ],
)
def test_gradients_are_finite(velocity, span):
    for mode in (jax.jacfwd, jax.jacrev):
        for slope in mode(_per_length, argnums=(0, 1, 2))(jnp.asarray(1.2), velocity, span):
            assert np.isfinite(slope).all()


@pytest.mark.parametrize("velocity", [jnp.zeros(3), 0.7 * SPAN, jnp.array([6.0, -1.0, 0.5])])
def test_gradient_equals_central_differences(velocity):
    # |v| v is once differentiable at zero: differences are off by C q D h there, 1e-7 and less
    step = 1e-6
    exact = np.asarray(jax.jacfwd(_per_length, argnums=1)(jnp.asarray(1.2), velocity, SPAN))
    for i in range(3):
        change = jnp.zeros(3).at[i].set(step)
        difference = (per_length(1.2, velocity + change, SPAN) - per_length(1.2, velocity - change, SPAN)) / (2 * step)
        np.testing.assert_allclose(exact[:, i], difference, atol=1e-7)
