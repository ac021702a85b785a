"""A spherical aerostat: the wind does not know where its nose is.

Truth: the symmetry of a sphere, and the definition of a drag coefficient. If this fails, a balloon is lifted or pulled
aside by the air because of axes that somebody drew on it.
"""

import json
import math
import sys

import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership.cli import main
from tethership.errors import TethershipWarning
from tethership.scenario.load import packaged_text

DIAMETER, COEFFICIENT, DENSITY = 5.0, 0.4, 1.2


def quantity(value, unit):
    return {"value": value, "unit": unit, "source": "a test"}


def vehicle(length=DIAMETER, **drag):
    """Return the document of a balloon with centre B at the origin, mass 20 kg and no fins."""
    drag = drag or {"drag_coefficient": COEFFICIENT}
    return {
        "name": "ball",
        "description": "a ball",
        "body": {
            "mass": quantity(20.0, "kg"),
            "centre_of_gravity": quantity([0.0, 0.0, 0.5], "m"),
            "inertia": quantity([[80.0, 0, 0], [0, 80.0, 0], [0, 0, 80.0]], "kg m^2"),
        },
        "hull": {"profile": "ellipsoid", "length": quantity(length, "m"), "diameter": quantity(DIAMETER, "m")},
        "buoyancy": {
            "volume": quantity(math.pi / 6.0 * DIAMETER**2 * length, "m^3"),
            "centre": quantity([0.0, 0.0, 0.0], "m"),
        },
        "apparent_mass": {"model": "lamb"},
        "envelope": {
            **{key: quantity(value, "1") for key, value in drag.items()},
            "slice_efficiency": quantity(1.0, "1"),
            "potential_length": quantity(0.8 * length, "m"),
        },
    }


def scenario(form="consistent", **options):
    return ts.load_scenario("hover", {"vehicle": vehicle(**options), "formulation": form, "control": {"sas": False}})


def force(ship, velocity, rates=(0.0, 0.0, 0.0)):
    """Return force and moment of envelope and apparent mass in steady straight motion, body axes."""
    velocity, rates, still = jnp.array(velocity), jnp.array(rates), jnp.zeros(3)
    hull = ship.envelope.wrench(jnp.asarray(DENSITY), velocity, rates)
    inertia = ship.apparent_mass.wrench(jnp.asarray(DENSITY), velocity, rates, still, still, still)
    return np.asarray(hull.force + inertia.force), np.asarray(hull.moment + inertia.moment)


def directions(count=200):
    vectors = np.random.default_rng(2).normal(size=(count, 3))
    return [*(vectors / np.linalg.norm(vectors, axis=1)[:, None]), *np.eye(3), *-np.eye(3)]


@pytest.mark.parametrize("form", ["consistent", "published"])
def test_drag_is_along_the_airspeed_and_the_same_from_everywhere(form):
    ship = scenario(form).system.ship
    for speed in (0.3, 12.0):
        drag = 0.5 * DENSITY * speed**2 * math.pi / 4.0 * DIAMETER**2 * COEFFICIENT
        for direction in directions():
            found, moment = force(ship, speed * direction)
            np.testing.assert_allclose(found, -drag * direction, atol=1e-9 * drag)  # no lift, no side force
            np.testing.assert_allclose(moment, np.zeros(3), atol=1e-9 * drag * DIAMETER)


def test_nothing_in_still_air():
    found, moment = force(scenario().system.ship, (0.0, 0.0, 0.0))
    assert not found.any()
    assert not moment.any()


def test_an_airship_keeps_its_two_coefficients():
    envelope = ts.load_scenario("docking").system.ship.envelope
    assert envelope.isotropic_drag_area is None
    assert envelope.axial_drag_area > 0.0


SPLIT = {"axial_drag_coefficient": 0.2, "cross_flow_drag_coefficient": 0.4}


def test_split_drag_of_a_sphere_is_told():
    with pytest.warns(TethershipWarning, match=r"ball: the hull is only 1 times as long as wide, .*lift; give"):
        split = scenario(**SPLIT)
    oblique, _ = force(split.system.ship, (8.0, 0.0, 8.0))
    assert abs(oblique[0] - oblique[2]) > 0.1 * np.linalg.norm(oblique)  # what it tells of is true


def test_a_slender_hull_is_not_told(recwarn):
    scenario(length=1.5 * DIAMETER, **SPLIT)
    assert not [warning for warning in recwarn if issubclass(warning.category, TethershipWarning)]


def test_one_coefficient_is_for_a_sphere():
    with pytest.raises(
        ts.ConfigError, match=r"drag_coefficient is for a hull that is nearly a sphere, and this one is 3"
    ):
        scenario(length=3.0 * DIAMETER, drag_coefficient=0.4)


@pytest.mark.parametrize("drag", [{"axial_drag_coefficient": 0.2}, {**SPLIT, "drag_coefficient": 0.4}])
def test_half_a_drag_or_two_are_refused(drag):
    with pytest.raises(
        ts.ConfigError, match=r"give axial_drag_coefficient and cross_flow_drag_coefficient, or for a hull"
    ):
        scenario(**drag)


def test_the_command_warns_in_one_line(tmp_path, monkeypatch, capsys):
    tables = (f"{key} = {json.dumps(value).replace(': ', ' = ')}" for key, value in vehicle(**SPLIT).items())
    (tmp_path / "ball.toml").write_text("\n".join(tables))
    own = tmp_path / "own.toml"
    own.write_text(packaged_text("scenarios", "hover").replace('vehicle = "lotte"', 'vehicle = "ball.toml"'))
    monkeypatch.setattr(sys, "argv", ["tethership", "validate", str(own)])
    with pytest.raises(SystemExit) as stop:
        main()
    error = capsys.readouterr().err
    assert stop.value.code == 0, error
    assert error.startswith("tethership: warning: ball: the hull is only 1 times")
    assert error.count("\n") == 1
