"""The commands `modes` and `sweep`: keys, exit codes, one clear line, nothing but JSON on standard output.

Truth: the library's own results, and the contract of the keys.
If this fails, scripts that read these commands break, or a wrong input ends in a traceback or in a result of another
question than was asked.
"""

import json
import math
import sys

import numpy as np
import pytest

import tethership as ts
from tethership.cli import main
from tethership.cli.sweep import _axis
from tethership.plant.state import STATE_NAMES

MODE_KEYS = {"name", "eigenvalue", "frequency", "damping", "half_or_double_time"}
SWEEP_KEYS = {"parameter", "tracks", "events", "parameters", "units", "shape", "outcome", "throttle", "files"}


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


def test_help_has_an_example(run):
    for command in ("modes", "sweep"):
        code, out, _ = run(command, "--help")
        assert code == 0
        assert f"Example: tethership {command}" in out


def test_modes_json(run, docking, point):
    code, out, err = run("modes", "--json")
    assert (code, err) == (0, "")
    result = json.loads(out)
    model = ts.linearize(docking, point)
    assert np.shape(result["A"]) == (12, 12)
    np.testing.assert_array_equal(result["A"], model.A)
    np.testing.assert_array_equal(result["U"], model.U)
    assert result["states"] == list(STATE_NAMES)
    assert (result["outcome"], result["wind"], result["formulation"]) == ("converged", 6.0, "consistent")
    assert len(result["eigenvalues"]) == 12
    for shown, mode in zip(result["modes"], model.modes().modes, strict=True):
        assert set(shown) >= MODE_KEYS
        assert shown["name"] == mode.name
        assert shown["eigenvalue"] == [mode.eigenvalue.real, mode.eigenvalue.imag]
        assert shown["frequency"] == mode.frequency
        assert shown["damping"] == mode.damping
        assert shown["half_or_double_time"] == mode.half_or_double_time
    every = [complex(*pair) for pair in result["eigenvalues"]]
    assert sum(every) == pytest.approx(np.trace(model.A), abs=1e-9)  # whatever their order


def test_modes_of_a_free_ship(run):
    code, out, err = run("modes", "hover", "--json")
    assert (code, err) == (0, "")
    null = [mode for mode in json.loads(out)["modes"] if mode["null"]]
    assert {mode["name"] for mode in null} == {"heading", "north", "east"}
    assert {(mode["multiplicity"], mode["defective"]) for mode in null} == {(3, True)}
    assert {mode["half_or_double_time"] for mode in null} == {None}


def test_modes_table(run):
    code, out, err = run("modes", "hover")
    assert (code, err) == (0, "")
    assert "Hover in wind: wind 6 m/s, consistent" in out
    lines = {line[:24].strip(): line for line in out.splitlines()}
    assert "null, 3 coincide, defective" in lines["heading"]
    assert "±" in lines["pendulum"]
    assert "doubles" in lines["vertical"]
    assert "doubles" not in lines["pendulum"]


@pytest.mark.parametrize(("part", "count"), [("nine", 9), ("longitudinal", 6), ("lateral", 6)])
def test_modes_of_a_part(run, part, count):
    code, out, _ = run("modes", "--part", part, "--json")
    result = json.loads(out)
    assert code == 0
    assert np.shape(result["A"]) == (count, count)
    assert len(result["states"]) == len(result["eigenvalues"]) == count
    names = {mode["name"] for mode in result["modes"]}
    expected = {"nine": {"surge", "heading"}, "longitudinal": {"pendulum", "vertical"}, "lateral": {"heading–east"}}
    assert expected[part] <= names


def test_modes_writes_files(run, tmp_path):
    code, out, _ = run("modes", "--part", "longitudinal", "--json", "--out", tmp_path)
    assert code == 0
    assert json.loads((tmp_path / "modes.json").read_text()) == json.loads(out)
    model = ts.LinearModel.load(tmp_path / "model.nc")
    np.testing.assert_array_equal(model.A, json.loads(out)["A"])
    assert model.states == ("u", "w", "q", "theta", "north", "down")


def test_modes_without_a_trim(run, tmp_path):
    code, out, err = run("modes", "--set", 'trim.unknowns=["psi"]', "--json", "--out", tmp_path)
    assert code == 3
    assert json.loads(out)["outcome"] == "no_equilibrium"
    assert err.count("\n") == 1
    assert "No equilibrium with these unknowns" in err
    assert not (tmp_path / "model.nc").exists()
    code, out, err = run("modes", "--wind", 40, "--json")
    assert code == 3
    result = json.loads(out)
    assert result["outcome"] == "saturated"
    assert len(result["modes"]) > 5  # they are told all the same
    assert "more thrust than there is" in err
    assert "tail_forward" in err


def test_sweep_json(run, tmp_path):
    code, out, err = run("sweep", "--over", "wind=6:12:13", "--json", "--out", tmp_path)
    assert (code, err) == (0, "")
    result = json.loads(out)
    assert set(result) >= SWEEP_KEYS
    np.testing.assert_array_equal(result["parameter"], np.linspace(6.0, 12.0, 13))
    assert result["parameters"] == {"wind.speed": result["parameter"]}
    assert (result["units"], result["shape"]) == ({"wind.speed": "m/s"}, [13])
    assert len(result["tracks"]) == 12
    assert {"pendulum", "heading", "north", "vertical"} <= set(result["tracks"])
    for values in result["tracks"].values():
        assert len(values) == 13
        assert all(len(pair) == 2 for pair in values)
    assert set(result["names"]) == set(result["tracks"])
    assert result["outcome"] == ["converged"] * 13
    assert isinstance(result["events"], list)
    assert result["files"] == [str(tmp_path / "root_locus.png"), str(tmp_path / "root_locus.html")]
    assert (tmp_path / "root_locus.png").read_bytes().startswith(b"\x89PNG")
    assert "<html" in (tmp_path / "root_locus.html").read_text(encoding="utf-8")[:200].lower()


def test_sweep_with_points_beyond_the_thrust(run, tmp_path):
    code, out, err = run("sweep", "--over", "wind=[6,6,6],elongation=[0.8,0.95,1.02]", "--json", "--out", tmp_path)
    assert (code, err) == (0, "")
    result = json.loads(out)
    assert result["outcome"] == ["converged", "converged", "saturated"]
    assert result["parameters"] == {"wind.speed": [6.0] * 3, "trim.elongation": [0.8, 0.95, 1.02]}
    for values in result["tracks"].values():
        assert values[2] is None
        assert values[0] is not None
    assert max(map(abs, result["throttle"][2])) > 1.0
    kinds = {event["kind"] for event in result["events"]}
    assert kinds <= {"coalesce", "split", "cross"}
    cross = next(event for event in result["events"] if event["kind"] == "cross")
    assert set(cross["modes"]) == {"side-slip", "vertical"}
    assert 0.95 < cross["at"]["trim.elongation"] < 1.02
    assert cross["value"] == cross["at"]["wind.speed"] == 6.0  # of the first parameter
    assert {event["kind"] for event in result["stability"]} <= {"stable", "unstable"}


def test_sweep_table(run, tmp_path):
    code, out, _ = run("sweep", "--over", "wind=[6,6,6],elongation=[0.8,0.95,1.02]", "--out", tmp_path)
    assert code == 0
    assert "wind.speed 6 to 6 m/s, trim.elongation 0.8 to 1.02 1: 2 of 3 points in trim" in out
    assert "saturated: largest |throttle| 6." in out
    assert "side-slip and vertical cross at" in out
    assert "root_locus.html" in out


def test_sweep_without_any_trim_exits_with_3(run, tmp_path):
    code, out, _ = run("sweep", "--over", "wind=[6],elongation=[1.02]", "--json", "--out", tmp_path)
    assert code == 3
    assert json.loads(out)["outcome"] == ["saturated"]
    assert (tmp_path / "root_locus.png").exists()


def test_sweep_of_a_grid(run, tmp_path):
    code, out, _ = run("sweep", "--over", "wind=6:8:2", "--over", "elongation=[0.7,0.8]", "--json", "--out", tmp_path)
    assert code == 0
    result = json.loads(out)
    assert result["shape"] == [2, 2]
    assert result["parameters"] == {"wind.speed": [6.0, 6.0, 8.0, 8.0], "trim.elongation": [0.7, 0.8, 0.7, 0.8]}
    assert all(len(values) == 4 for values in result["tracks"].values())


def test_sweep_names_what_is_unstable_at_every_point(run, tmp_path):
    """No event tells of a mode that is unstable from end to end: it is said by itself, in text and JSON."""
    over = ("sweep", "--over", "wind=6:9:2", "--out", tmp_path)
    found = json.loads(run(*over, "--json")[1])
    always = found["unstable_throughout"]
    assert always
    assert all((name in always) == all(root[0] > 1e-6 for root in roots) for name, roots in found["tracks"].items())
    said = run(*over)[1]
    for name in always:
        low, high = sorted(root[0] for root in found["tracks"][name])
        assert f"{name} unstable at every point (Re λ {low:.3g} … {high:.3g} 1/s)" in said


def test_sweep_with_changes(run, tmp_path):
    # the flags change what is swept: a point of the sweep at 9 m/s is the trim of `modes --wind 9`
    code, out, _ = run("sweep", "--over", "wind=[9]", "--wind", 7, "--json", "--out", tmp_path)
    swept = json.loads(out)
    assert code == 0
    assert (swept["wind"], swept["parameter"]) == (7.0, [9.0])
    modes = json.loads(run("modes", "--wind", 9, "--json")[1])
    pendulum = next(mode for mode in modes["modes"] if mode["name"] == "pendulum")
    # two trims that stop at 1e-6 of the weight
    assert swept["tracks"]["pendulum"][0] == pytest.approx(pendulum["eigenvalue"], abs=1e-6)


def test_figure_in_both_formulations(run, tmp_path):
    code, out, err = run("sweep", "--figure", 6, "--json", "--out", tmp_path)
    assert (code, err) == (0, "")
    result = json.loads(out)
    assert set(result) >= {"figure", "parameter", "tracks", "events", "formulations", "files"}
    assert result["figure"] == 6
    assert set(result["formulations"]) == {"consistent", "published"}
    for name in ("consistent", "published"):
        assert (tmp_path / f"figure_06_{name}.png").read_bytes().startswith(b"\x89PNG")
        assert "<html" in (tmp_path / f"figure_06_{name}.html").read_text(encoding="utf-8")[:200].lower()
        (panel,) = result["formulations"][name]
        assert panel["title"] == "untethered"
        assert panel["tracks"]["north"] == [[0.0, 0.0]]
    assert len(result["files"]) == 4
    one, other = (result["formulations"][name][0]["tracks"]["pendulum"] for name in ("consistent", "published"))
    assert one != other  # the hull's laws differ


RANGES = {
    "wind=6:12:3": {"wind": [6.0, 9.0, 12.0]},
    "wind=6:12:1": {"wind": [6.0]},
    "wind=6:6:1": {"wind": [6.0]},
    "wind=36km/hour:12 m/s:2": {"wind": [10.0, 12.0]},
    "trim.elevation=30deg:60deg:3": {"trim.elevation": [math.pi / 6, math.pi / 4, math.pi / 3]},
    "trim.elevation=0.5:60deg:2": {"trim.elevation": [0.5, math.pi / 3]},
    "cables.nose.diameter=2mm:4mm:2": {"cables.nose.diameter": [0.002, 0.004]},
    "wind.from_direction=-10deg:10deg:2": {"wind.from_direction": [-math.pi / 18, math.pi / 18]},
    "wind=[6,9.5,12]": {"wind": [6.0, 9.5, 12.0]},
    "wind=6:8:2,elongation=0.7:0.8:2": {"wind": [6.0, 8.0], "elongation": [0.7, 0.8]},
    "wind=[6,8],elongation=0.7:0.8:2": {"wind": [6.0, 8.0], "elongation": [0.7, 0.8]},
}


@pytest.mark.parametrize("text", RANGES)
def test_ranges(docking, text):
    found = _axis(docking, text)
    assert list(found) == list(RANGES[text])
    for name, values in RANGES[text].items():
        np.testing.assert_allclose(found[name], values, rtol=1e-14)  # rounding of a conversion


def test_a_range_without_a_number_of_points(docking):
    values = _axis(docking, "wind=6:12")["wind"]
    assert (len(values), values[0], values[-1]) == (25, 6.0, 12.0)


WRONG = {
    ("modes", "--part", "nines"): "--part 'nines' is no part; did you mean 'nine'? Allowed: full, nine, longitudinal",
    ("modes", "--sensitivity", "pendlum"): "there is no mode 'pendlum' here; did you mean 'pendulum'?",
    ("modes", "--wind", "-1"): "wind.speed: it is -1 m/s; it must be at least 0",
    ("modes", "dokking"): "no scenario 'dokking'; did you mean 'docking'?",
    ("modes", "--out", "/dev/null/x"): "choose another folder with --out",
    ("sweep",): "name what to vary, --over wind=6:12:13, or a figure of the paper, --figure 7 (not both)",
    ("sweep", "--over", "wind=6:12:3", "--figure", "6"): "(not both)",
    ("sweep", "--over", "wind=12:6:3"): "the range is reversed; give the lower end first, wind=6:12",
    ("sweep", "--over", "wind=6:6:3"): "the range is empty; give two different ends",
    ("sweep", "--over", "wind=6:12:0"): "the range is empty",
    ("sweep", "--over", "wind=6:12:-2"): "the range is empty",
    ("sweep", "--over", "wind=6:12:2.5"): "'2.5' is no number of points",
    ("sweep", "--over", "wind=6"): "write from:to:points, e.g. wind=6:12:13",
    ("sweep", "--over", "wind=1:2:3:4"): "write from:to:points, e.g. wind=6:12:13",
    ("sweep", "--over", "wnd.speed=6:12:3"): "has no number 'wnd.speed'; nearest: wind.speed",
    ("sweep", "--over", "wnd.speed=[6,12]"): "has no number 'wnd.speed'; nearest: wind.speed",
    ("sweep", "hover", "--over", "cables.nose.length=10:20:3"): "scenario hover has no number 'cables.nose.length'",
    ("sweep", "--over", "wind"): "--over 'wind' is no range; write --over name=from:to:points",
    ("sweep", "--over", "wind="): "--over 'wind=' is no range",
    ("sweep", "--over", "=6:12:3"): "--over '=6:12:3' is no range",
    ("sweep", "--over", "wind=a:12:3"): "--over wind: 'a' is no number for an end",
    ("sweep", "--over", "wind=nan:12:3"): "--over wind: the end 'nan' is not a finite number",
    ("sweep", "--over", "wind=6kg:12:3"): "the unit is 'kg', which is no 'm/s'",
    ("sweep", "--over", "wind=[6,"): "is no list of numbers; write e.g. wind=[6,9,12]",
    ("sweep", "--over", "wind=[six]"): "is no list of numbers; write e.g. wind=[6,9,12]",
    ("sweep", "--over", "wind=[]"): "the range of wind is empty",
    ("sweep", "--over", "wind=[6,NaN]"): "the range of wind has values that are not finite numbers",
    ("sweep", "--over", "wind=6:8:2,elongation=[0.8]"): "need as many values each",
    ("sweep", "--over", "wind=6:8:2", "--over", "wind.speed=6:8:2"): "wind.speed is named twice",
    ("sweep", "--over", "wind=-1:8:2"): "wind.speed: it is -1 m/s; it must be at least 0",
    ("sweep", "--over", "wind=6:8:2", "--wind", "-3"): "wind.speed: it is -3 m/s",
    ("sweep", "--figure", "12"): "the paper has no root locus in figure 12; give one of 6, 7, 8, 9, 10, 11",
    ("sweep", "--figure", "six"): "Invalid value for '--figure'",
    ("sweep", "hover", "--figure", "6"): "--figure has its own scenarios; leave out 'hover'",
    ("sweep", "--over", "wind=6:8:2", "--out", "/dev/null/x"): "choose another folder with --out",
}


def refused(run, words, message):
    """Check that a command ends with exit code 2, one line that says why, and nothing on standard output."""
    code, out, err = run(*words)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert message in err


@pytest.mark.parametrize("words", WRONG, ids=" ".join)
def test_wrong_input_is_one_line_and_exit_2(words, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    refused(run, words, WRONG[words])


ONCE_PASSED = {
    ("modes", "--sensitivity", ""): "there is no mode ''",
    ("sweep", "--over", "wind=[6,-1,8]"): "wind.speed: it is -1 m/s; it must be at least 0",
    ("sweep", "--over", "wind=[[6,7],[8,9]]"): "wind",
    ("sweep", "--over", "wind=6:8:2,wind=7:9:2"): "named twice",
}


@pytest.mark.parametrize("words", ONCE_PASSED, ids=" ".join)
def test_wrong_input_that_once_passed(words, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    refused(run, words, ONCE_PASSED[words])


def test_ctrl_c_is_told(run, monkeypatch):
    """Interrupted: exit code 3 and one line, as the README says."""

    def interrupted(*_, **__):
        raise KeyboardInterrupt

    monkeypatch.setattr("tethership.cli.modes.chosen_scenario", interrupted)
    code, out, err = run("modes")
    assert (code, out) == (3, "")
    assert "interrupted" in err


def test_angles_of_a_sweep_are_degrees(run, tmp_path):
    code, out, _ = run("sweep", "--over", "wind.from_direction=[0]", "--json", "--out", tmp_path)
    result = json.loads(out)
    assert code == 0
    assert result["units"] == {"wind.from_direction": "deg"}


def test_still_air_is_undamped_not_unstable(run):
    """Re λ = 2e-16 is rounding: such a mode neither doubles nor is it stable."""
    code, out, _ = run("modes", "--wind", 0, "--json")
    modes = {mode["name"]: mode for mode in json.loads(out)["modes"]}
    assert code == 0
    for name in ("roll oscillation", "pendulum"):
        assert modes[name]["half_or_double_time"] is None
        assert modes[name]["stable"] is False
    assert "doubles" not in run("modes", "--wind", 0)[1]
