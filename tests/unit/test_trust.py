"""What a user is told besides a number: ground, limits, motion, whose point it is. Before, each of these was silence.

If this failed, a balloon blown under the ground, a broken cable, a turning ship or another scenario's trim would be
taken for an equilibrium.
"""

import json
import sys

import numpy as np
import pytest

import tethership as ts
from tethership.cli import main


@pytest.fixture
def run(monkeypatch, capsys):
    """Run the command in this process; return exit code, standard output and error."""

    def call(*words):
        monkeypatch.setattr(sys, "argv", ["tethership", *map(str, words)])
        with pytest.raises(SystemExit) as stop:
            main()
        out, err = capsys.readouterr()
        return stop.value.code, out, err

    return call


def aerostat(**changes):
    return ts.load_scenario("aerostat", {key.replace("__", "."): value for key, value in changes.items()})


# --- ground -------------------------------------------------------------------------------------------------------


def test_a_balloon_blown_under_the_ground_is_no_equilibrium():
    point = ts.trim(aerostat(wind__speed=20.0))
    assert point.outcome is ts.TrimOutcome.hull_below_ground
    # P is 25.2 m below the anchor; the hull's radius of 1.99 m, pitched by 3.4°, is below that.
    assert float(point.state.position[2]) == pytest.approx(25.2, abs=0.05)
    assert point.clearance_hull == pytest.approx(-27.2, abs=0.05)
    assert "27.2 m below the ground" in point.message
    assert "less wind" in point.message


def test_a_cable_longer_than_the_lift_can_hold_up():
    """300 m of rope: the lift of 141 N holds 180 m of 0.785 N/m, so it would hang 121 m below the ground."""
    scenario = aerostat(wind__speed=0.0, cables__nose__length=300.0)
    point = ts.trim(scenario)
    assert point.outcome is ts.TrimOutcome.cable_below_ground
    assert float(point.state.position[2]) == pytest.approx(-61.6, abs=0.1)
    held = float(point.tension[0]) / (0.080 * 9.80665)
    tip = 3.5 - float(point.state.position[2])  # the tether point is 3.5 m below P
    assert point.clearance_cable == pytest.approx(tip - 2 * 3.5 - held, abs=0.5)
    assert "cables.nose.length" in point.message


def test_the_papers_slack_rope_stays_a_warning():
    point = ts.trim(ts.load_scenario("docking"))
    assert point.outcome is ts.TrimOutcome.converged
    assert point.clearance_cable == pytest.approx(-1.458, abs=1e-3)
    assert "dips 1.46 m below the ground" in " ".join(point.warnings)


def test_the_ground_is_below_the_lowest_anchor_or_where_the_scenario_says():
    lower = ts.load_scenario("docking", {"cables.nose.anchor": [0.0, 0.0, 3.0]})
    assert float(lower.system.environment.ground) == 3.0
    given = ts.load_scenario("docking", {"ground.anchor_height": 5.0})
    assert float(given.system.environment.ground) == 5.0
    assert ts.trim(ts.load_scenario("hover")).clearance_hull is None  # no anchor, no height: no ground is known


def test_every_command_tells_the_ground(run):
    code, out, err = run("trim", "aerostat", "--wind", 20, "--json")
    said = json.loads(out)
    assert code == 3
    assert said["outcome"] == "hull_below_ground"
    assert said["clearance_hull"] < -27.0
    code, out, err = run("modes", "aerostat", "--wind", 20, "--json")
    assert code == 3
    assert json.loads(out)["clearance_hull"] < -27.0
    code, out, err = run("dock", "aerostat", "--wind", 20, "--set", "ground.anchor_height=0m")
    assert code == 3
    assert err.count("\n") == 1
    assert "blown down" in err
    assert "raise ground.anchor_height" not in err


def test_a_sweep_tells_ground_and_limits_point_by_point(run, tmp_path):
    code, out, _ = run("sweep", "aerostat", "--over", "wind=4:8:3", "--out", tmp_path, "--json")
    said = json.loads(out)
    assert code == 0
    assert len(said["clearance_hull"]) == len(said["clearance_cable"]) == len(said["limits_passed"]) == 3
    assert "control_threshold" in said["limits_passed"][-1]
    code, out, _ = run("sweep", "aerostat", "--over", "cables.nose.length=150:200:11", "--wind", 0, "--out", tmp_path)
    assert code == 0
    assert "3 of 11 points in trim" in out  # its tether point rests 162 m high, however long the rope is
    assert "longer than the lift can hold up" in out


# --- what must stand still ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "word"), [("p", "phi"), ("q", "theta"), ("r", "psi")])
def test_a_turning_ship_is_no_equilibrium(name, word):
    point = ts.trim(ts.load_scenario("cruise"), fixed={name: 0.1})
    assert point.outcome is ts.TrimOutcome.no_equilibrium
    assert word in point.message
    assert "5.73°/s" in ts.trim(ts.load_scenario("cruise"), fixed={"q": 0.1}).message


def test_a_ship_that_leaves_its_anchor_is_no_equilibrium():
    point = ts.trim(ts.load_scenario("docking"), fixed={"velocity_north": 0.5})
    assert point.outcome is ts.TrimOutcome.no_equilibrium
    assert "north" in point.message


def test_rates_that_are_looked_for_are_found_at_rest():
    point = ts.trim(ts.load_scenario("cruise"), unknowns=("throttle", "theta", "p", "q", "r"))
    assert point.outcome is ts.TrimOutcome.converged
    np.testing.assert_allclose(np.asarray(point.state.rates), 0.0, atol=1e-9)


def test_a_turning_point_is_not_linearised_nor_flown():
    scenario = ts.load_scenario("cruise")
    point = ts.trim(scenario, fixed={"q": 0.1})
    with pytest.raises(ts.ConfigError, match="no equilibrium"):
        ts.linearize(scenario, point)
    with pytest.raises(ts.ConfigError, match=r"not in equilibrium.*theta moving at 5.73°/s"):
        ts.linearize(scenario, (point.state, point.command))


def test_a_start_trimmed_for_another_scenario_is_refused():
    """Trimmed in 6 m/s and flown in 12 m/s, rewind: 1 342 N; from the right start 2 923 N."""
    calm = ts.load_scenario("docking", {"wind.speed": 6.0})
    windy = ts.load_scenario("docking", {"wind.speed": 12.0})
    with pytest.raises(ts.ConfigError, match=r"the point is no equilibrium of this scenario: .* N of surge force"):
        ts.dock(windy, ts.trim(calm), layers=("rewind",))


# --- limits -------------------------------------------------------------------------------------------------------


def test_a_fin_has_a_limit():
    """Without it the answer was 1 834° and nothing was said."""
    heavy = ts.load_scenario("cruise", {"vehicle.body.mass": 150.0})
    point = ts.trim(heavy, unknowns=["tail_forward", "theta", "deflection"], fixed={"velocity_north": 2.0})
    assert point.outcome is ts.TrimOutcome.saturated
    assert {"fin_starboard", "fin_port"} <= set(point.saturated)
    assert "it has 20°" in point.message

    assert float(heavy.system.ship.fins.largest_deflection[0]) == pytest.approx(np.radians(20.0))


def test_a_law_cannot_turn_a_fin_beyond_its_limit():
    class Hard(ts.AbstractLaw):
        def __call__(self, time, measurement, memory):
            return ts.Correction(deflection=1.0), memory

    scenario = ts.load_scenario("docking", {"stop.time_limit": 0.5})
    flight = ts.dock(scenario, ts.trim(scenario), layers=(), own_laws={"hard": Hard()})
    np.testing.assert_allclose(flight.data["deflection"], np.radians(20.0))
    assert float(flight.data["deflection_saturated"].min()) == 1.0
    assert flight.metrics["saturated_seconds"] == pytest.approx(0.5)


def test_trim_prints_deflections(run):
    code, out, _ = run("trim", "cruise", "--unknowns", "throttle,theta,deflection")
    assert code == 0
    assert "fin_starboard" in out


def test_a_broken_cable_is_told(run):
    code, out, _ = run("tension", "--anchor", 0, 0, 0, "--end", 0, 0, -1.5, "--length", 1.3, "--wind", 0, "--json")
    said = json.loads(out)
    assert code == 0
    assert said["tension"] == pytest.approx(10_733, abs=1.0)
    assert said["limits_passed"]["cable_break"] == pytest.approx(10_733 / 3_040, rel=1e-3)
    assert any("would break" in line for line in said["warnings"])
    code, out, err = run("trim", "aerostat", "--wind", 8, "--set", "cables.nose.breaking_force=50")
    assert "limit passed: cable_break" in out
    assert "would break" in err


@pytest.mark.parametrize(
    ("flags", "code"),
    [
        (("--end", "nan", 0, -5, "--length", 10), 2),
        (("--end", 1, 0, 0, "--length", "inf"), 2),
        (("--wind", 12, "--wind-vector", 0, 0, 0, "--end", 1, 0, -5), 2),
        (("--end", 1e200, 0, -5), 3),
        (("--end", 0, 0, -5, "--length", 1e-320), 3),
    ],
)
def test_tension_of_what_cannot_be(run, flags, code):
    given, out, err = run("tension", *flags)
    assert given == code
    assert out == ""
    assert err.count("\n") == 1


def test_the_curve_of_a_cable(run):
    """20 m of rope in 6 m/s: its ends, its tension from 5.35 N at the anchor to 14.17 N, and the angles there."""
    end = (-11.3137, 0, -11.3137)
    flags = ("--length", 20, "--wind-vector", -6, 0, 0, "--points", 21, "--json")
    _, out, _ = run("tension", "--end", *end, *flags)
    said = json.loads(out)
    curve, along = np.array(said["points"]), np.array(said["tension_along"])
    assert curve.shape == (21, 3)
    np.testing.assert_allclose(curve[[0, -1]], [(0, 0, 0), end], atol=1e-9)
    assert along[-1] == pytest.approx(said["tension"], rel=1e-12)
    assert along[0] == pytest.approx(np.linalg.norm(said["anchor_force"]), rel=1e-12)
    # The curve's first and last steps of 1 m climb as the angles say, to the bend of half a step.
    steps = np.diff(curve, axis=0)
    climb = np.degrees(np.arcsin(-steps[:, 2] / np.linalg.norm(steps, axis=1)))
    assert climb[-1] == pytest.approx(said["angles"]["ship"], abs=1.0)
    assert climb[0] == pytest.approx(said["angles"]["anchor"], abs=6.0)
    assert said["clearance_cable"] == pytest.approx(-curve[:, 2].max(), abs=0.02)
    assert 4.8 < said["sag"] < 4.95


# --- messages -----------------------------------------------------------------------------------------------------


def test_what_is_missing_is_said_with_its_amount():
    """Beside a residual of 283 N nothing is in equilibrium; a free ship in still air has no wind to be less."""
    point = ts.trim(ts.load_scenario("docking", {"wind.speed": 40.0}))
    assert point.outcome is ts.TrimOutcome.saturated
    assert "283 N of surge force" in point.message
    assert not point.message.startswith("In equilibrium")
    fast = ts.trim(ts.load_scenario("cruise", {"trim.velocity": [60.0, 0.0, 0.0]}))
    assert fast.outcome is ts.TrimOutcome.saturated
    assert "ess wind" not in fast.message
    assert "slacker" not in fast.message


def test_the_balance_that_is_not_met_is_named():
    point = ts.trim(ts.load_scenario("docking", {"wind.from_direction": 0.5}))
    assert point.outcome is ts.TrimOutcome.no_equilibrium
    assert "sway force" in point.message


@pytest.mark.parametrize("length", [0.3, 1.0, 3.0])
def test_a_stiff_link_is_told(length):
    changes = {"cables.nose.stiffness": 5.8e7, "cables.nose.length": length, "trim.position": [0.0, 0.0, -length]}
    point = ts.trim(ts.load_scenario("aerostat", {**changes, "ground.anchor_height": 20.0}))
    assert point.outcome is ts.TrimOutcome.no_equilibrium
    assert "too stiff for this search" in point.message


# --- verdicts -----------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def torn():
    scenario = ts.load_scenario("docking", {"wind.speed": 12.0})
    return ts.dock(scenario, ts.trim(scenario))


def test_docked_but(torn):
    """12 m/s: 2 759 N, tear limit passed for 2.0 s, hull 2 m under the ground, saturated for 49 of 65 s."""
    assert torn.outcome is ts.Outcome.docked
    assert torn.limits_passed["envelope_tear"] == pytest.approx(2.0, abs=0.1)
    assert "cable_break" not in torn.limits_passed
    assert "docked after 64.6 s, but the envelope's tear limit was passed for 2.01 s" in torn.verdict
    assert "(by up to 1.99 m)" in torn.verdict
    assert "saturated for 48.7 s of 64.6 s" in torn.verdict


def test_one_verdict_and_one_share_everywhere(torn, tmp_path):
    from tethership.cli.dock import summary
    from tethership.view.replay.scene import scene

    said = summary(ts.load_scenario("docking", {"wind.speed": 12.0}), torn)
    assert said["limits_passed"] == torn.limits_passed
    assert said["warnings"] == [torn.verdict, *torn.warnings]
    shown = scene(torn, "A")
    assert shown["verdict"] == torn.verdict
    assert shown["warnings"] == list(torn.warnings)
    assert said["cable_warning"] in torn.warnings
    assert said["clearance_hull"] == torn.metrics["clearance_min"]
