"""The free rigid body in a vacuum: Euler's top and the intermediate-axis flip, in closed form.

Source: Landau & Lifshitz, *Mechanics*, 3rd ed., sections 33 and 37 (Jacobi's elliptic functions). The whole plant
is flown, with the density of the air and gravity set to zero. If this failed, the gyroscopic terms, the offset
between P and G, or Euler's kinematics would be wrong, and no flight could be right.

Verifies: rigid-body terms, Euler angles, P ≠ G.  Air: none.  Vehicle: a top, and Lotte's mass and inertia.
"""

import diffrax
import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.special import ellipj, ellipk

import tethership as ts
from tethership.physics.atmosphere import ConstantAtmosphere
from tethership.physics.gravity import Gravity
from tethership.physics.rigid_body import RigidBody
from tethership.plant import Command, State, TetheredAirship
from tethership.spatial import skew

TOLERANCE = 1e-11
"""Relative tolerance of the integrator (Dopri8); errors of the flights below stay under 1e-8."""


@pytest.fixture(scope="module")
def vacuum():
    """Return Lotte without cable, air and weight."""
    plant = ts.load_scenario("hover").system
    places = (lambda p: p.environment.gravity, lambda p: p.environment.atmosphere)
    plant = eqx.tree_at(places[0], plant, jnp.zeros(3))
    return eqx.tree_at(places[1], plant, ConstantAtmosphere(jnp.zeros(())))


def with_body(plant, mass, centre, inertia) -> TetheredAirship:
    body = RigidBody(jnp.asarray(mass, float), jnp.asarray(centre, float), jnp.asarray(inertia, float))
    places = (lambda p: p.ship.body, lambda p: p.ship.gravity)
    plant = eqx.tree_at(places[0], plant, body)
    return eqx.tree_at(places[1], plant, Gravity(body.mass, body.centre))


def command_of(plant):
    """Return full throttle and some deflection: without air they must do nothing."""
    return Command(jnp.ones(plant.ship.thrusters.count), 0.3 * jnp.ones(plant.ship.fins.count))


def integrated(field, start, times):
    return diffrax.diffeqsolve(
        diffrax.ODETerm(field),
        diffrax.Dopri8(),
        times[0],
        times[-1],
        0.01,
        start,
        saveat=diffrax.SaveAt(ts=times),
        stepsize_controller=diffrax.PIDController(rtol=TOLERANCE, atol=TOLERANCE),
        max_steps=20_000,
        adjoint=diffrax.ForwardMode(),
    ).ys


@eqx.filter_jit
def flown(plant, start, times):
    """Return the twelve states of a flight with Euler angles at the given times."""

    def field(time, vector, _):
        rate = plant.derivative(time, State.from_vector(vector), command_of(plant), jnp.zeros(0))
        return rate.as_vector()

    return integrated(field, start, times)


@eqx.filter_jit
def tumbled(plant, velocity, rates, times):
    """Return v, ω, R and x of a body that may tumble through θ = 90°.

    Ṙ = R ω× takes the place of Euler's angles, which the loads do not see in a vacuum.
    """

    def field(time, y, _):
        v, w, rotation, _ = y
        still = State(v, w, jnp.zeros(3), jnp.zeros(3))
        rate = plant.derivative(time, still, command_of(plant), jnp.zeros(0))
        return rate.velocity, rate.rates, rotation @ skew(w), rotation @ v

    return integrated(field, (velocity, rates, jnp.eye(3), jnp.zeros(3)), times)


def test_symmetric_top_precesses_in_closed_form(vacuum):
    """Steady precession about the vertical, H along the down axis.

    θ is constant, ψ̇ = H/I_t, φ̇ = p(1 − I_a/I_t) with the spin p = −(H/I_a) sin θ.
    """
    axial, transverse, height = 200.0, 3000.0, 0.6
    top = with_body(vacuum, 140.0, [0.0, 0.0, 0.0], np.diag([axial, transverse, transverse]))
    momentum = 900.0  # H along the down axis [N m s]
    roll, heading = 0.4, -1.0
    # H in body axes is Rᵀ(0, 0, H): −sin θ, sin φ cos θ, cos φ cos θ.
    direction = np.array([-np.sin(height), np.sin(roll) * np.cos(height), np.cos(roll) * np.cos(height)])
    rates = momentum * direction / np.array([axial, transverse, transverse])
    start = np.concatenate([np.zeros(3), rates, [roll, height, heading], np.zeros(3)])
    times = np.linspace(0.0, 40.0, 81)
    path = np.asarray(flown(top, start, times))
    precession = momentum / transverse
    spin = rates[0] * (1.0 - axial / transverse)
    # Errors of a step at 1e-11 add up over 40 s (about two turns of precession, six of spin).
    np.testing.assert_allclose(path[:, 7], height, atol=1e-8)
    np.testing.assert_allclose(path[:, 8], heading + precession * times, atol=1e-8)
    np.testing.assert_allclose(path[:, 6], roll + spin * times, atol=1e-8)
    assert precession * 40.0 > 2 * np.pi  # it did go round
    np.testing.assert_allclose(path[:, :3], 0.0, atol=1e-12)  # G stays where it was
    np.testing.assert_allclose(path[:, 9:], 0.0, atol=1e-12)


def elliptic_rates(moments, rates, times):
    """Return ω of the free asymmetric body in principal axes (I₁ < I₂ < I₃, H² > 2TI₂), from ω₂ = 0, ω₁, ω₃ > 0."""
    i1, i2, i3 = moments
    twice_energy = moments @ rates**2
    square = np.sum((moments * rates) ** 2)
    assert square > twice_energy * i2
    tau = times * np.sqrt((i3 - i2) * (square - twice_energy * i1) / (i1 * i2 * i3))
    modulus = (i2 - i1) * (twice_energy * i3 - square) / ((i3 - i2) * (square - twice_energy * i1))
    sn, cn, dn, _ = ellipj(tau, modulus)
    period = 4.0 * ellipk(modulus) * times[-1] / tau[-1]
    return (
        np.stack(
            [
                np.sqrt((twice_energy * i3 - square) / (i1 * (i3 - i1))) * cn,
                np.sqrt((twice_energy * i3 - square) / (i2 * (i3 - i2))) * sn,
                np.sqrt((square - twice_energy * i1) / (i3 * (i3 - i1))) * dn,
            ],
            axis=1,
        ),
        period,
    )


@pytest.fixture(scope="module")
def flipping(vacuum):
    """Return moments, times and the flight of a body set spinning about its intermediate axis."""
    moments = np.array([1000.0, 2000.0, 3000.0])
    body = with_body(vacuum, 140.0, [0.0, 0.0, 0.0], np.diag(moments))
    rates = np.array([0.9, 0.0, 0.55])  # H² just above 2TI₂: close to the separatrix, long stays, quick flips
    times = np.linspace(0.0, 60.0, 1201)
    return moments, rates, times, tumbled(body, jnp.zeros(3), jnp.asarray(rates), times)


def test_intermediate_axis_flip_follows_jacobi(flipping):
    moments, rates, times, path = flipping
    expected, _ = elliptic_rates(moments, rates, times)
    # The flip multiplies a step's error by e^(λt) between stays: 1e-11 of the step grows to 1e-8 here.
    np.testing.assert_allclose(np.asarray(path[1]), expected, atol=1e-7)
    # It does flip: ω₂ stays near ± its largest value.
    second = np.asarray(path[1])[:, 1]
    assert second.max() > 0.7
    assert second.min() < -0.7


def test_flip_period(flipping):
    """Between two upward passages of ω₂ through zero lies 4K(k²) of Jacobi's time."""
    moments, rates, times, path = flipping
    _, period = elliptic_rates(moments, rates, times)
    second = np.asarray(path[1])[:, 1]
    upward = np.flatnonzero((second[:-1] < 0) & (second[1:] >= 0))
    # Cubic interpolation of a passage sampled every 0.05 s: error (0.05/0.5)⁴ of the step.
    crossings = [np.roots(np.polyfit(times[i - 1 : i + 3] - times[i], second[i - 1 : i + 3], 3)) for i in upward]
    passages = times[upward] + [
        min(r.real for r in c if abs(r.imag) < 1e-9 and -1e-6 < r.real < 0.0501) for c in crossings
    ]
    assert len(passages) >= 2
    np.testing.assert_allclose(np.diff([0.0, *passages]), period, rtol=1e-5)


def test_tumbling_keeps_energy_and_momentum(flipping):
    moments, rates, _, path = flipping
    spin, rotation = np.asarray(path[1]), np.asarray(path[2])
    energy = 0.5 * (spin**2) @ moments
    momentum = np.einsum("tij,tj->ti", rotation, spin * moments)
    np.testing.assert_allclose(energy, energy[0], rtol=1e-8)  # 1e-11 a step, some hundred steps
    expected = np.broadcast_to(moments * rates, momentum.shape)
    np.testing.assert_allclose(momentum, expected, atol=1e-8 * np.linalg.norm(moments * rates))


def test_lotte_in_a_vacuum_tumbles_about_its_centre_of_gravity(vacuum):
    """Lotte's own inertia, P = B away from G: ω is that of a free body about G, and G flies straight."""
    body = vacuum.ship.body
    mass, centre = float(body.mass), np.asarray(body.centre)
    about_g = np.asarray(body.inertia) - mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
    moments, axes = np.linalg.eigh(about_g)
    axes[:, 2] = np.cross(axes[:, 0], axes[:, 1])
    principal = np.array([0.05, 0.0, 0.3])
    rates, velocity = axes @ principal, np.array([1.0, -0.5, 0.3])
    times = np.linspace(0.0, 60.0, 121)
    v, w, rotation, position = map(np.asarray, tumbled(vacuum, jnp.asarray(velocity), jnp.asarray(rates), times))
    expected, _ = elliptic_rates(moments, principal, times)
    np.testing.assert_allclose(w @ axes, expected, atol=1e-9)  # rates of 0.3 rad/s, 1e-11 per step
    assert np.ptp(expected[:, 1]) > 0.02  # the motion is not a mere steady spin
    at_g = position + rotation @ centre
    straight = centre + np.outer(times, velocity + np.cross(rates, centre))
    np.testing.assert_allclose(at_g, straight, atol=1e-7)  # 70 m of way
    impulse = np.einsum("tij,tj->ti", rotation, v + np.cross(w, centre))
    np.testing.assert_allclose(impulse, np.broadcast_to(impulse[0], impulse.shape), atol=1e-9)


def test_falling_and_turning_body(vacuum):
    """With weight alone G falls on a parabola while the ship turns as if it were not falling."""
    weighty = eqx.tree_at(lambda p: p.environment.gravity, vacuum, jnp.array([0.0, 0.0, 9.80665]))
    centre = np.asarray(vacuum.ship.body.centre)
    start = np.zeros(12)
    start[:6] = [5.0, 1.0, -2.0, 0.3, 0.05, -0.1]
    times = np.linspace(0.0, 4.0, 21)
    falling, floating = (np.asarray(flown(plant, start, times)) for plant in (weighty, vacuum))
    np.testing.assert_allclose(falling[:, 3:9], floating[:, 3:9], atol=1e-9)  # same rates and attitude
    drop = falling[:, 9:] - floating[:, 9:]
    expected = np.outer(0.5 * 9.80665 * times**2, [0.0, 0.0, 1.0])
    np.testing.assert_allclose(drop, expected, atol=1e-7)  # 78 m of fall at 1e-11
    assert np.abs(centre).max() > 0.1  # with G away from P


def test_air_is_really_gone(vacuum):
    """Full throttle, deflected fins, 40 m/s: no load but the named zeroes."""
    state = State(40.0 * jnp.ones(3), jnp.ones(3), 0.3 * jnp.ones(3), jnp.zeros(3))
    loads = jax.jit(lambda: vacuum.wrenches(jnp.zeros(()), state, command_of(vacuum), ()))()
    assert set(loads) == {"gravity", "buoyancy", "apparent_mass", "envelope", "fins", "thrust"}
    for name, load in loads.items():
        np.testing.assert_array_equal(np.asarray(load.as_vector()), np.zeros(6), err_msg=name)
