"""Exact derivatives: the Jacobian by JAX against central differences, batches against loops, and no NaN anywhere.

Truth: the definition of a derivative. If this failed, linear models, trims and fits would rest on wrong slopes
(a `where` that hides a NaN, a root differentiated wrongly), or a batch would fly another ship than a single flight.
"""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import tethership as ts
from tethership.plant import Command, State
from tethership.plant.loop import ClosedLoop
from tethership.spatial import rotation_matrix

BOTH = ("consistent", "published")
TENSIONS = {"slack": (0.0, 100.0), "pulling": (155.0, 190.0), "taut": (230.0, 3000.0)}
"""Tension of the cases [N]: hanging; between 144 and 202 N, where the rewind law slows the winch; beyond that."""
SCALES = np.array([3.0, 1.0, 1.0, 0.15, 0.15, 0.15, 0.3, 0.3, 1.5, 0.0, 0.0, 0.0])
CASES = 12
TIME = 21.3  # within the side gust


@pytest.fixture(scope="module")
def scenarios():
    return {form: ts.load_scenario("docking", {"formulation": form}) for form in BOTH}


@pytest.fixture(scope="module")
def loops(scenarios):
    """Return the closed loop with every layer, around a throttle of its own."""
    command = Command(jnp.array([0.1, -0.05, 0.1, 0.12, 0.08, 0.1]), 0.02 * jnp.ones(4))
    return {form: ClosedLoop(scenario.system, scenario.law(), command) for form, scenario in scenarios.items()}


def candidates(elongations, seed, count):
    """Return random integrator's vectors (12 states and the cable's length) with the tether point at given e."""
    rng = np.random.default_rng(seed)
    vectors = np.zeros((count, 13))
    vectors[:, :12] = rng.uniform(-1.0, 1.0, (count, 12)) * SCALES
    vectors[:, 12] = rng.uniform(5.0, 20.0, count)
    reach = rng.uniform(*elongations, count) * vectors[:, 12]
    elevation, bearing = rng.uniform(0.2, 1.3, count), rng.uniform(2.0, 4.3, count)
    level = np.cos(elevation)
    tip = reach * np.array([level * np.cos(bearing), level * np.sin(bearing), -np.sin(elevation)])
    nose = np.asarray(jax.vmap(rotation_matrix)(vectors[:, 6:9]))[:, :, 0]
    vectors[:, 9:12] = tip.T - 6.97 * nose
    return vectors


@eqx.filter_jit
def tensions(plant, vectors):
    """Return the tension of the cable of a batch [N]."""

    def tension(y):
        cable = plant.cable_states(jnp.asarray(TIME), State.from_vector(y[:12]), y[12:13])[0]
        return jnp.linalg.norm(cable.ship)

    return jax.vmap(tension)(vectors)


def states(plant, regime, seed, count=CASES):
    """Return random vectors whose cable pulls as hard as a regime says."""
    low, high = TENSIONS[regime]
    drawn = candidates((0.3, 0.97) if regime == "slack" else (0.985, 1.03), seed, 4000)
    force = np.asarray(tensions(plant, drawn))
    chosen = drawn[(low <= force) & (force <= high)][:count]
    assert len(chosen) == count
    return chosen


@eqx.filter_jit
def closed(loop, vectors):
    """Return the vector field of a batch."""
    return jax.vmap(lambda y: loop.vector_field(jnp.asarray(TIME), y))(vectors)


@eqx.filter_jit
def closed_slopes(loop, vectors):
    """Return the exact Jacobian of a batch."""
    return jax.vmap(jax.jacfwd(lambda y: loop.vector_field(jnp.asarray(TIME), y)))(vectors)


def open_rate(plant, vector):
    """Return the plant's derivative for one vector of 12 states, cable length, 6 throttles, 4 deflections."""
    command = Command(vector[13:19], vector[19:23])
    return plant.derivative(jnp.asarray(TIME), State.from_vector(vector[:12]), command, vector[12:13]).as_vector()


@eqx.filter_jit
def plant_rates(plant, vectors):
    return jax.vmap(lambda y: open_rate(plant, y))(vectors)


@eqx.filter_jit
def plant_slopes(plant, vectors):
    return jax.vmap(jax.jacfwd(lambda y: open_rate(plant, y)))(vectors)


@eqx.filter_jit
def plant_gradients(plant, vectors, weights):
    """Return the gradient of a weighted sum of the rates, by reverse mode."""
    return jax.vmap(jax.grad(lambda y: weights @ open_rate(plant, y)))(vectors)


def differences(function, vectors, step):
    """Return central differences of fourth order, all columns of all cases in one batch."""
    count, size = vectors.shape
    moves = np.concatenate([factor * step * np.eye(size) for factor in (-2, -1, 1, 2)])
    batch = (vectors[:, None, :] + moves[None]).reshape(-1, size)
    values = np.asarray(function(batch)).reshape(count, 4, size, -1)
    slopes = (values[:, 0] - 8 * values[:, 1] + 8 * values[:, 2] - values[:, 3]) / (12 * step)
    return slopes.transpose(0, 2, 1)


def mismatch(exact, difference):
    """Return the largest difference of each case, relative to the largest entry of its row."""
    size = np.abs(exact).max(axis=2, keepdims=True) + 1e-3
    return (np.abs(exact - difference) / size).max(axis=(1, 2))


# Fourth-order differences with a step of 3e-5 (m, m/s, rad): truncation step⁴ f⁽⁵⁾/30, which near e = 1 is felt
# (the cable's stiffness grows a hundredfold within 1e-2 of e), and rounding 1e-13/3e-5 = 3e-9 of a row.
STEP = 3e-5


@pytest.mark.parametrize("form", BOTH)
def test_closed_loop_jacobian(loops, form):
    """With respect to the twelve states and the cable's length, hanging, pulling and taut."""
    loop = loops[form]
    for regime in TENSIONS:  # not parametrised: one compiled program serves all three
        vectors = states(loop.plant, regime, seed=11)
        exact = np.asarray(closed_slopes(loop, vectors))
        error = mismatch(exact, differences(lambda y: closed(loop, y), vectors, STEP))
        assert np.isfinite(exact).all(), regime
        # Measured 5e-9 at most. The laws clip (throttles, set-points, winch), and a case whose stencil steps over a
        # corner would have no derivative: with this seed none does.
        assert error.max() < 1e-7, regime
        slowing = np.abs(exact[:, 12]).max(axis=1) > 0.0  # the winch answers the tension
        assert slowing.all() if regime == "pulling" else not slowing.any(), regime


@pytest.mark.parametrize("form", BOTH)
def test_plant_jacobian(scenarios, form):
    """With respect to states, cable length, throttles and deflections: A and U of the linear model."""
    plant = scenarios[form].system
    rng = np.random.default_rng(5)
    inputs = np.hstack([rng.uniform(-1, 1, (CASES, 6)), rng.uniform(-0.3, 0.3, (CASES, 4))])
    for regime in TENSIONS:
        vectors = np.hstack([states(plant, regime, seed=12), inputs])
        exact = np.asarray(plant_slopes(plant, vectors))
        error = mismatch(exact, differences(lambda y: plant_rates(plant, y), vectors, STEP))
        assert np.isfinite(exact).all(), regime
        assert error.max() < 1e-7, regime  # measured 6e-10 at most
        # The cable's pull is there: its length matters, much more when taut.
        pull = np.abs(exact[:, :3, 12]).max(axis=1)
        assert (pull > (1e-4 if regime == "slack" else 1.0)).all(), regime


@settings(deadline=None, derandomize=True, max_examples=25)
@given(unit=arrays(np.float64, 12, elements=st.floats(-1.0, 1.0)), elongation=st.floats(0.1, 1.04))
def test_slopes_are_finite_at_any_state(scenarios, unit, elongation):
    """Zeroes, denormals and all: hypothesis likes the corners that random numbers never meet."""
    vector = np.concatenate([np.array([3.0, 1, 1, 0.15, 0.15, 0.15, 0.3, 0.3, 1.5, 0, 0, 0]) * unit, np.zeros(11)])
    vector[9:12] = 20.0 * elongation * unit[9:] / max(np.linalg.norm(unit[9:]), 1e-3)
    vector[12] = 20.0
    batch = np.repeat(vector[None], CASES, axis=0)  # the size that is compiled already
    for form in BOTH:
        assert np.isfinite(np.asarray(plant_slopes(scenarios[form].system, batch))).all(), form


# --- batch and loop -----------------------------------------------------------------------------------------------


@eqx.filter_jit
def closed_once(loop, vector):
    """Return the vector field of one vector."""
    return loop.vector_field(jnp.asarray(TIME), vector)


@pytest.fixture(scope="module")
def looped(loops):
    """Return vectors, slack and taut, and their rates one by one."""
    vectors = {
        form: np.concatenate([states(loop.plant, "slack", 21, 6), states(loop.plant, "taut", 22, 6)])
        for form, loop in loops.items()
    }
    rates = {form: np.stack([np.asarray(closed_once(loops[form], v)) for v in vectors[form]]) for form in BOTH}
    return vectors, rates


def assert_same(found, expected):
    """Hold rows to 1e-11 of their largest entry.

    A vectorised sine or exponential may differ in its last bit; near e = 1 the cable makes 1e-13 of that.
    """
    size = np.abs(expected).max(axis=1, keepdims=True)
    np.testing.assert_allclose(found / size, expected / size, rtol=0, atol=1e-11)


@pytest.mark.parametrize("form", BOTH)
def test_batch_is_the_loop(loops, looped, form):
    vectors, rates = looped
    rows = CASES * 4 * 13  # as many as the differences take: compiled already
    found = np.asarray(closed(loops[form], np.resize(vectors[form], (rows, 13))))
    assert_same(found, np.resize(rates[form], (rows, 13)))


def test_batch_along_the_last_axis_is_the_loop(loops, looped):
    vectors, rates = looped
    field = jax.vmap(loops["consistent"].vector_field, in_axes=(None, -1), out_axes=-1)
    columns = np.asarray(jax.jit(field)(jnp.asarray(TIME), vectors["consistent"].T))
    assert_same(columns.T, rates["consistent"])


def test_ships_can_be_batched_too(scenarios):
    """A batch over parameters: eight winds at once are eight plants in a loop."""
    plant = scenarios["consistent"].system
    winds = np.linspace(0.0, 14.0, 8)[:, None] * np.array([-1.0, 0.2, 0.0])
    vector = np.concatenate([states(plant, "slack", 31, 1)[0], 0.1 * np.ones(6), np.zeros(4)])

    def rate(wind):
        windy = eqx.tree_at(lambda p: p.environment.wind.value, plant, wind)
        return open_rate(windy, jnp.asarray(vector))

    together = np.asarray(jax.jit(jax.vmap(rate))(winds))
    alone = jax.jit(rate)
    for wind, row in zip(winds, together, strict=True):
        np.testing.assert_allclose(row, np.asarray(alone(wind)), rtol=0, atol=1e-11 * np.abs(row).max())


# --- places where a careless formula divides by zero ----------------------------------------------------------------


@pytest.fixture(scope="module")
def corners(scenarios):
    """Return named plant vectors: rest, still air, a plumb cable, ends that coincide; and still plants."""
    rest = np.zeros(23)
    rest[12] = 20.0
    rest[9:12] = 16.0 * np.array([-np.sqrt(0.5), 0.0, -np.sqrt(0.5)]) - [6.97, 0.0, 0.0]
    plumb, hung, together = rest.copy(), rest.copy(), rest.copy()
    plumb[9:12] = [-6.97, 0.0, -15.0]
    hung[9:12] = [-6.97, 0.0, 15.0]
    together[9:12] = [-6.97, 0.0, 0.0]
    named = {"rest": rest, "plumb": plumb, "hung": hung, "together": together}
    still = {
        form: eqx.tree_at(
            lambda p: (p.environment.wind.value, p.environment.gusts[0].amplitude),
            scenario.system,
            replace_fn=jnp.zeros_like,
        )
        for form, scenario in scenarios.items()
    }
    return named, still


@pytest.mark.parametrize("form", BOTH)
def test_slopes_are_finite_where_norms_vanish(scenarios, corners, form):
    """In wind and at zero airspeed; tether point exactly above, below and at the anchor; forward and reverse."""
    named, still = corners
    batch = np.resize(np.stack(list(named.values())), (CASES, 23))
    weights = np.linspace(-1.0, 1.0, 12)
    for air, plant in (("wind", scenarios[form].system), ("still", still[form])):
        forward = np.asarray(plant_slopes(plant, batch))[: len(named)]
        for name, slope in zip(named, forward, strict=True):
            assert np.isfinite(slope).all(), (air, name)
        backward = np.asarray(plant_gradients(plant, batch, weights))[: len(named)]
        # The same derivative by the transposed program: rounding, on entries up to 1e3 where the ends coincide.
        expected = np.einsum("i,aij->aj", weights, forward)
        np.testing.assert_allclose(backward, expected, rtol=1e-8, atol=1e-8, err_msg=air)


@pytest.mark.parametrize("form", BOTH)
def test_slopes_in_still_air_are_right(corners, form):
    """At rest in still air all loads on the ship are quadratic in speed: only weight, lift and cable remain."""
    named, still = corners
    batch = np.resize(named["rest"], (CASES, 23))
    slope = np.asarray(plant_slopes(still[form], batch))[0]
    difference = differences(lambda y: plant_rates(still[form], y), batch, STEP)[0]
    # |v|v has a jump of its second derivative at rest, so differences are off by the step 1e-4 times some tenths:
    # measured 3e-5 in the fins' |v_n|v_n.
    np.testing.assert_allclose(slope, difference, rtol=0, atol=1e-4)
    np.testing.assert_allclose(slope[:6, :6], 0.0, atol=1e-9)


@pytest.mark.parametrize("form", BOTH)
def test_slopes_at_trim(scenarios, loops, form):
    """The closed loop at the docking's trim point: finite, and the linear model that differences give."""
    scenario = scenarios[form]
    point = ts.trim(scenario)
    loop = eqx.tree_at(lambda own: own.trimmed, loops[form], point.command)
    vector = np.asarray(loop.initial(point.state))
    batch = np.repeat(vector[None], CASES, axis=0)
    slope = np.asarray(closed_slopes(loop, batch))
    assert np.isfinite(slope).all()
    error = mismatch(slope, differences(lambda y: closed(loop, y), batch, STEP))
    # Hover has no cross-flow: the jump of the second derivative of |v|v again, measured 1.6e-5.
    assert error.max() < 1e-4


@pytest.mark.parametrize("form", BOTH)
def test_plumb_cable_pulls_straight(corners, form):
    """Its force there is the limit ½(L + y₃)l of the notes section 7, without a sideways part (no wind)."""
    named, still = corners
    plant = still[form]
    states_of = eqx.filter_jit(
        lambda own, y: own.cable_states(jnp.asarray(TIME), State.from_vector(y[:12]), y[12:13])[0].ship
    )
    weight = 0.080 * 9.80665
    stretch = weight * 20.0 / 69_760.0 if form == "consistent" else 0.0  # wL/EA; `published` is inextensible
    for name, height in (("plumb", 15.0), ("hung", -15.0)):
        pull = np.asarray(states_of(plant, named[name]))
        np.testing.assert_allclose(pull[:2], 0.0, atol=1e-12)
        # Both branches of the hanging cable stretch: y₃ = (2/w + L/EA)(V − wL/2). Floors: 1e-9 N, 1e-6 m.
        expected = 0.5 * (20.0 + height / (1.0 + 0.5 * stretch)) * weight
        assert pull[2] == pytest.approx(expected, rel=1e-8), name
