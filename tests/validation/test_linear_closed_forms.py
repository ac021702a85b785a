"""Modes with a closed form: pendulums, springs and drag.

Verifies: apparent mass, metacentric height, drag and line stiffness in A, with signs. Air: constant density. Source:
textbook mechanics, written out beside each case. If one failed, a root locus would be of something else than a ship.
"""

import numpy as np
import pytest

import tethership as ts
from tethership.analysis import linearize

RHO, VOLUME, G = 1.225, 110.3, 9.80665
AIR = {"atmosphere": {"model": "constant", "density": {"value": RHO, "unit": "kg/m^3"}}}
K1, K2, K_ROT, GYRATION = 0.08, 0.86, 0.69, 13.6
BOTH = ("consistent", "published")


def frequencies(scenario):
    """Return the natural frequencies [rad/s] of a scenario's trim, fastest first, one of each pair."""
    point = ts.trim(scenario, throw=True)
    values = linearize(scenario, point).modes().eigenvalues
    return np.sort(values[values.imag > 1e-9].imag)[::-1], values


def aerostat(form, **more):
    """Return a buoyant body on one taut, all but massless line fixed at B = G = P, in still air."""
    changes = {
        "formulation": form,
        "wind.speed": 0.0,
        "vehicle.body.mass": 100.0,
        "vehicle.body.centre_of_gravity": [0.0, 0.0, 0.0],
        "cables.nose.tether_point": [0.0, 0.0, 0.0],
        "cables.nose.linear_density": 1e-9,
        "cables.nose.length": 30.0,
        "trim.position": [0.0, 0.0, -30.0],
        "trim.unknowns": ["down"],
        **AIR,
        **more,
    }
    return ts.load_scenario("aerostat", changes)


@pytest.mark.parametrize("form", BOTH)
def test_aerostat_on_a_taut_line_is_an_inverted_pendulum(form):
    """(m + kρ𝒱) ẍ = −(F/L') x: period 2π√((m + kρ𝒱) L'/F), F the free lift, along and across the hull."""
    scenario = aerostat(form)
    point = ts.trim(scenario, throw=True)
    lift = (RHO * VOLUME - 100.0) * G
    height = -float(point.state.position[2])
    assert float(point.tension[0]) == pytest.approx(lift, rel=1e-6)
    found, _ = frequencies(scenario)
    displaced = RHO * VOLUME
    across = np.sqrt(lift / height / (100.0 + K2 * displaced))
    along = np.sqrt(lift / height / (100.0 + K1 * displaced))
    # Down: an axial spring. elastic_catenary EA/L; `published` in its joint has (K0(e_e−e_c)/(e_e−e_c))/L = K0/L too.
    axial = np.sqrt(69_760.0 / 30.0 / (100.0 + K2 * displaced))
    np.testing.assert_allclose(found, [axial, along, across], rtol=1e-6)
    assert found[2] < 0.8 * np.sqrt(lift / height / 100.0)  # without apparent mass it would swing so fast


@pytest.mark.parametrize("form", BOTH)
def test_buoyant_ship_swings_about_its_metacentre(form):
    """Neutral ship in still air, G a metre h below B; P = B.

    Sway and roll: [[m + k₂ρ𝒱, −mh], [−mh, J]] (ÿ, φ̈) = (0, −mgh φ), so ω² = mgh/(J − (mh)²/(m + k₂ρ𝒱)); surge and pitch
    likewise with k₁ and J + k'ρ𝒱·J₂.
    """
    mass, drop = RHO * VOLUME, 0.455
    changes = {
        "formulation": form,
        "wind.speed": 0.0,
        "vehicle.body.mass": mass,
        "vehicle.body.centre_of_gravity": [0.0, 0.0, drop],
        "vehicle.body.inertia": [[214.0, 0.0, 0.0], [0.0, 3310.0, 0.0], [0.0, 0.0, 3211.0]],
        **AIR,
    }
    found, values = frequencies(ts.load_scenario("hover", changes))
    restoring, coupling = mass * G * drop, (mass * drop) ** 2
    roll = np.sqrt(restoring / (214.0 - coupling / (mass * (1.0 + K2))))
    pitch = np.sqrt(restoring / (3310.0 + K_ROT * mass * GYRATION - coupling / (mass * (1.0 + K1))))
    np.testing.assert_allclose(found, [roll, pitch], rtol=1e-9)
    # No wind, no damping; the other eight are zero. Zeros in Jordan blocks of two split by the root of rounding.
    assert np.abs(values.real).max() < 1e-6
    assert np.sum(np.abs(values) < 1e-6) == 8


@pytest.mark.parametrize("form", BOTH)
@pytest.mark.parametrize("speed", [3.0, 6.0, 12.0])
def test_surge_decays_with_the_drag_derivative(form, speed):
    """λ = −ρ V (S_h C_Dh0 + Σ S C_D0)/(m + k₁ρ𝒱): the derivative of ½ρSV² over mass and apparent mass.

    Throttle is held, G at B and the ship neutral, so that nothing else takes part.
    """
    mass = RHO * VOLUME
    changes = {
        "formulation": form,
        "wind.speed": speed,
        "vehicle.body.mass": mass,
        "vehicle.body.centre_of_gravity": [0.0, 0.0, 0.0],
        **AIR,
    }
    scenario = ts.load_scenario("hover", changes)
    surge = linearize(scenario, ts.trim(scenario, throw=True)).modes().find("surge")
    area = 0.025 * VOLUME ** (2.0 / 3.0) + 4.0 * 2.88 * 0.006
    expected = -RHO * speed * area / (mass * (1.0 + K1))
    assert surge.eigenvalue.real == pytest.approx(expected, rel=1e-9)
    assert surge.half_or_double_time == pytest.approx(np.log(2.0) / -expected, rel=1e-9)


def line(name, side):
    """Return one of two lines that spread to port and starboard, massless and stiff."""
    quantities = {
        "tether_point": ([0.0, 0.0, 0.0], "m"),
        "anchor": ([0.0, side * 15.0, 0.0], "m"),
        "length": (25.0, "m"),
        "diameter": (0.0, "m"),
        "linear_density": (1e-9, "kg/m"),
        "stiffness": (5e4, "N"),
        "breaking_force": (3040.0, "N"),
        "joint_start": (0.99, "1"),
        "joint_end": (1.05, "1"),
        "cross_flow_drag_coefficient": (1.1, "1"),
        "longitudinal_drag_coefficient": (0.02, "1"),
    }
    winch = {"rewind_rate": {"value": 0.0, "unit": "m/s"}, "fastest_rate": {"value": 0.5, "unit": "m/s"}}
    return {"name": name, "winch": winch} | {key: {"value": v, "unit": u} for key, (v, u) in quantities.items()}


def test_ship_on_two_symmetric_lines():
    """K = Σ [EA/L n nᵀ + (T/d)(I − n nᵀ)] with n along each line, T its tension, d its stretched length.

    Lift stretches both lines; across them the ship is held by their stiffness, along the hull only by their tension.
    """
    scenario = aerostat("consistent", cables=[line("port", -1.0), line("starboard", 1.0)])
    scenario = scenario.changed({"trim.position": [0.0, 0.0, -20.0]})
    point = ts.trim(scenario, throw=True)
    found, _ = frequencies(scenario)
    height = -float(point.state.position[2])
    reach, lift = np.hypot(15.0, height), (RHO * VOLUME - 100.0) * G
    tension = 0.5 * lift * reach / height
    np.testing.assert_allclose(np.asarray(point.tension), tension, rtol=1e-6)
    stiffness = np.zeros((3, 3))
    for side in (-1.0, 1.0):
        unit = np.array([0.0, -side * 15.0, -height]) / reach
        along = np.outer(unit, unit)
        stiffness += 5e4 / 25.0 * along + tension / reach * (np.eye(3) - along)
    mass = 100.0 + RHO * VOLUME * np.array([K1, K2, K2])
    expected = np.sort(np.sqrt(np.diag(stiffness) / mass))[::-1]
    np.testing.assert_allclose(found, expected, rtol=1e-6)
    # The lateral stiffness is that of the lines, eighty times the tension's along the hull.
    assert stiffness[1, 1] > 50.0 * stiffness[0, 0]
