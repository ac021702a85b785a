"""Steady turns and pull-ups: kinematics, the momentum that a turn swings round, and a flight that keeps its radius."""

import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership.plant.ship import mass_matrix
from tethership.spatial import body_rates, euler_rates, rotation_matrix

SPEED, TURN = 10.0, np.radians(3.0)
UNKNOWNS = ("throttle", "theta", "phi", "velocity_east")


@pytest.fixture(scope="module")
def turn():
    scenario = ts.load_scenario("cruise", {"trim.turn_rate": TURN})
    return scenario, ts.trim(scenario, unknowns=UNKNOWNS)


def test_body_rates_are_euler_rates_the_other_way():
    attitude, rates = jnp.array([0.3, -0.4, 1.0]), jnp.array([0.1, -0.2, 0.3])
    assert np.allclose(euler_rates(attitude, body_rates(attitude, rates)), rates, atol=1e-14)


def test_the_rates_of_a_turn(turn):
    """p = −Ω sin θ, q = Ω sin φ cos θ, r = Ω cos φ cos θ."""
    _, point = turn
    assert point.outcome is ts.TrimOutcome.converged
    phi, theta, _ = np.asarray(point.state.attitude)
    wanted = [-TURN * np.sin(theta), TURN * np.sin(phi) * np.cos(theta), TURN * np.cos(phi) * np.cos(theta)]
    assert np.allclose(point.state.rates, wanted, atol=1e-14)


@pytest.mark.parametrize("manoeuvre", [{"trim.turn_rate": TURN}, {"trim.pull_up_rate": np.radians(2.0)}])
def test_what_acts_from_outside_swings_the_momentum_round(manoeuvre):
    """Constant motion in body axes: F = ω × P, with P the momentum of ship and air, (Mⁱ + Mᵃ) w.

    So a turn to starboard needs the force of (m + apparent mass) V Ω to starboard.
    """
    scenario = ts.load_scenario("cruise", manoeuvre)
    point = ts.trim(scenario, unknowns=UNKNOWNS)
    assert point.outcome is ts.TrimOutcome.converged
    plant, state = scenario.system, point.state
    loads = plant.wrenches(jnp.zeros(()), state, point.command, ())
    outside = sum(load.force for name, load in loads.items() if name != "apparent_mass")
    motion = np.concatenate([state.velocity, state.rates])
    momentum = (np.asarray(mass_matrix(state, plant.ship, plant.environment)) @ motion)[:3]
    assert np.allclose(outside, np.cross(state.rates, momentum), atol=1e-5)
    if "trim.turn_rate" in manoeuvre:
        assert float(outside[1]) == pytest.approx(momentum[0] * TURN, rel=0.05)  # (m + apparent mass) V Ω


def test_a_flight_from_the_trim_keeps_radius_height_and_turn(turn):
    scenario, point = turn
    flight = ts.fly(scenario, point, layers=(), sas=False, stop=4.0, solver="tight")
    place, time = flight.data["position"].values, flight.data["time"].values
    start = flight.data["velocity"].values[0]
    ground = np.asarray(rotation_matrix(point.state.attitude)) @ start
    speed = np.linalg.norm(ground[:2])
    radius = speed / TURN
    across = np.array([-ground[1], ground[0], 0.0]) / speed
    centre = place[0] + radius * across
    assert np.abs(np.linalg.norm((place - centre)[:, :2], axis=1) - radius).max() < 1e-3
    assert np.abs(place[:, 2] - place[0, 2]).max() < 1e-3
    turned = flight.data["attitude"].values[:, 2] - flight.data["attitude"].values[0, 2]
    assert np.allclose(turned, TURN * time, atol=1e-5)


def test_the_linear_model_of_a_turn_has_nine_states(turn):
    _, point = turn
    model = ts.linearize(point)
    assert model.states == ("u", "v", "w", "p", "q", "r", "phi", "theta", "psi")
    assert ts.linearize(point, loop="closed").states == model.states
    assert np.abs(model.A[:, 8]).max() < 1e-9  # heading is of no account in calm air


@pytest.mark.parametrize(
    ("name", "changes", "said"),
    [
        ("docking", {"trim.turn_rate": TURN}, "only a free ship without a cable turns steadily"),
        ("cruise", {"trim.turn_rate": TURN, "wind.speed": 3.0}, "only a free ship in calm air"),
        ("cruise", {"trim.turn_rate": 3.0}, "at most 1"),
    ],
)
def test_turns_that_are_none(name, changes, said):
    with pytest.raises(ts.ConfigError, match=said):
        ts.load_scenario(name, changes)


def test_a_turn_says_what_its_rates_are(turn):
    with pytest.raises(ts.ConfigError, match="say what p, q and r are; take out q"):
        ts.trim(turn[0], fixed={"q": 0.1})
