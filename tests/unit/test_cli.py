"""The command contract that scripts rely on: keys, exit codes, one clear line, nothing but JSON on standard output."""

import json
import os
import subprocess
import sys

import pytest
from PIL import Image

import tethership as ts
from tethership.cli import main

DOCK_KEYS = {
    "outcome",
    "docking_time",
    "tension_max",
    "tension_mean",
    "rewind_rate_min",
    "seconds_above",
    "ADC",
    "E",
    "theta_rms",
    "clearance_min",
    "wind",
    "layers",
    "formulation",
}


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


def test_version(run):
    assert run("--version") == (0, f"{ts.__version__}\n", "")


def test_help_has_an_example(run):
    for command in ("dock", "trim", "tension", "list", "validate", "new"):
        code, out, _ = run(command, "--help")
        assert code == 0
        assert f"Example: tethership {command}" in out


def test_bare_command_shows_what_there_is(run):
    code, out, _ = run()
    assert code == 0
    assert "dock" in out


def test_dock_json_and_again(run, tmp_path):
    code, out, err = run("dock", "--wind", 12, "--layers", "rewind", "--json", "--out", tmp_path / "a")
    assert (code, err) == (0, "")
    result = json.loads(out)
    assert set(result) >= DOCK_KEYS
    assert result["wind"] == 12.0
    assert result["layers"] == ["rewind"]
    assert result["formulation"] == "consistent"
    assert "quasi-static" in result["cable_warning"]
    assert len(result["seconds_above"]) == 4
    assert sorted(result["seconds_above"], reverse=True) == result["seconds_above"]
    assert (tmp_path / "a" / "docking.png").read_bytes().startswith(b"\x89PNG")
    assert [file.rpartition("/")[2] for file in result["files"]] == ["flight.nc", "docking.png", "replay.html"]
    assert (tmp_path / "a" / "replay.html").read_bytes().startswith(b"<!DOCTYPE html>")
    code, out, _ = run("dock", "--from", tmp_path / "a" / "flight.nc", "--json", "--out", tmp_path / "b")
    assert code == 0
    again = json.loads(out)
    for key in DOCK_KEYS:
        assert again[key] == result[key]


def test_dock_prints_a_table(run, tmp_path):
    code, out, _ = run("dock", "--set", "stop.time_limit=2", "--layers", "none", "--no-sas", "--out", tmp_path)
    assert code == 0
    assert "wind 6 m/s, constant rewind, formulation consistent" in out
    assert "largest tension" in out
    assert "docking.png" in out


def test_set_takes_units_shares_and_empty_lists(run, tmp_path):
    words = ["dock", "--set", "stop.time_limit=1", "--set", "wind.from_direction=5deg", "--set", "gusts=[]", "--json"]
    words += ["--set", 'trim.unknowns=["throttle","psi"]', "--set", "control.heading.share.port_forward=0.5"]
    code, _, err = run(*words, "--out", tmp_path)
    assert (code, err) == (0, "")
    stored = ts.Flight.load(tmp_path / "flight.nc").attributes["scenario"]
    assert stored["wind"]["from_direction"] == {"unit": "deg", "value": 5.0}
    assert stored["gusts"] == []
    assert stored["control"]["heading"]["share"]["port_forward"] == 0.5
    code, _, err = run("dock", "--from", tmp_path / "flight.nc", "--out", tmp_path)
    assert code == 2
    assert "would be overwritten; choose another folder with --out" in err


@pytest.mark.parametrize(("text", "speed"), [("1.2e1", 12.0), ("12", 12.0), ("12 m/s", 12.0), ("36km/hour", 10.0)])
def test_set_reads_numbers_with_and_without_units(run, text, speed):
    code, out, _ = run("trim", "--set", f"wind.speed={text}", "--json")
    assert code == 0
    assert json.loads(out)["wind"] == pytest.approx(speed, rel=1e-15)


def test_new_in_a_folder_can_be_flown(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run("new", "sub/mine.toml")[0] == 0
    assert ts.load_scenario("sub/mine.toml").config == ts.load_scenario("docking").config


def test_from_takes_no_other_input(run, tmp_path):
    code, out, err = run("dock", "--from", tmp_path / "x.nc", "--wind", 3)
    assert (code, out) == (2, "")
    assert "--from flies the stored input as it is" in err


def test_trim_json(run):
    code, out, _ = run("trim", "--json")
    result = json.loads(out)
    assert code == 0
    assert set(result) >= {"throttle", "tension", "residual", "saturated", "state"}
    assert len(result["residual"]) == 6
    assert result["tension"][0] == pytest.approx(14.174, abs=1e-3)
    assert result["state"]["down"] == pytest.approx(-0.8 * 20 * 0.5**0.5, abs=1e-9)


def test_trim_without_an_answer_exits_with_3(run):
    code, out, _ = run("trim", "--wind", 40, "--json")
    assert code == 3
    assert json.loads(out)["saturated"] == ["tail_forward", "port_forward", "starboard_forward"]
    code, out, _ = run("trim", "--unknowns", "psi", "--json")
    assert code == 3
    assert json.loads(out)["outcome"] == "no_equilibrium"
    code, out, err = run("dock", "--set", 'trim.unknowns=["psi"]', "--json")
    assert code == 3
    assert json.loads(out)["outcome"] == "no_equilibrium"
    assert "No equilibrium with these unknowns" in err


def test_tension_of_the_paper(run, tmp_path):
    words = [
        "tension",
        "--end",
        "-11.3137",
        "0",
        "-11.3137",
        "--length",
        "20",
        "--wind-vector",
        "-6",
        "0",
        "0",
        "--json",
    ]
    code, out, err = run(*words, "--out", tmp_path)
    assert (code, err) == (0, "")
    result = json.loads(out)
    assert set(result) >= {"force", "tension", "regime", "elongation", "anchor_force", "lowest_point"}
    assert result["tension"] == pytest.approx(14.18, abs=0.03)
    assert result["regime"] == "slack"
    assert json.loads((tmp_path / "tension.json").read_text()) == result


def test_tension_table_and_options(run):
    code, out, _ = run("tension", "--end", 0, 0, -19, "--velocity", 0, 0, -1, "--formulation", "published")
    assert code == 0
    assert "tension at the ship" in out
    assert "formulation published" in out
    code, _, err = run("tension", "hover", "--end", 0, 0, -19)
    assert code == 2
    assert "scenario hover has no cable" in err
    code, _, err = run("tension", "--end", 0, 0, -19, "--cable", "tail")
    assert code == 2
    assert "--cable 'tail' is not in scenario docking; it has nose" in err
    code, _, err = run("tension", "--end", 0, 0, -19, "--length", 0)
    assert code == 2
    assert "--length is 0; it must be above 0 m" in err


def test_list_new_validate(run, tmp_path):
    code, out, _ = run("list", "--json")
    assert code == 0
    assert set(json.loads(out)["scenarios"]) >= {"docking", "hover", "cruise", "aerostat"}
    assert "lotte" in run("list")[1]
    code, out, _ = run("new", "mine", "--out", tmp_path, "--json")
    assert code == 0
    scenario, vehicle = json.loads(out)["files"]
    for path, kind in ((scenario, "scenario"), (vehicle, "vehicle")):
        code, out, _ = run("validate", path, "--json")
        assert code == 0
        assert json.loads(out)["kind"] == kind
    # The copy is the same flight.
    assert ts.load_scenario(scenario).config == ts.load_scenario("docking").config
    code, _, err = run("new", "mine", "--out", tmp_path)
    assert code == 2
    assert "exists already; nothing is overwritten" in err


def test_validate_tells_one_clear_line(run, tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text("wind = 3")
    code, out, err = run("validate", bad)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert "bad.toml" in err


WRONG = {
    ("dock", "--wind", "fast"): "Invalid value for '--wind'",
    ("dock", "--wind", "-1"): "wind.speed: it is -1 m/s; it must be at least 0",
    ("dock", "--wnd", "3"): "No such option: --wnd",
    ("dck",): "Did you mean 'dock'",
    ("dock", "--layers", "rewnd"): "unknown layer 'rewnd'; did you mean 'rewind'?",
    ("dock", "--formulation", "best"): "formulation: it is 'best'",
    ("dock", "--set", "wind.speed"): "--set 'wind.speed' is no change; write --set key=value",
    ("dock", "--set", "wind.speed=1.2.3deg"): "wind.speed: it is '1.2.3deg'; a number needs its unit",
    ("dock", "--set", "wind.spd=3"): "unknown key 'spd'; did you mean 'speed'?",
    ("dock", "--out", "/dev/null/x"): "choose another folder with --out",
    ("dock", "--solver", "fast"): "no solver 'fast'",
    ("dock", "--from", "/nowhere.nc"): "cannot read /nowhere.nc: no such file",
    ("tension",): "Missing option '--end'",
    ("tension", "--end", "1", "2"): "'--end' requires 3 arguments",
    ("trim", "docking.tml"): "no scenario 'docking.tml'; did you mean 'docking'?",
    ("trim", "--unknowns", "throtle"): "did you mean 'throttle'?",
    ("validate", "nothing.toml"): "cannot read nothing.toml",
}


@pytest.mark.parametrize("words", WRONG, ids=" ".join)
def test_wrong_input_is_one_line_and_exit_2(words, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*words)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert WRONG[words] in err


COUNT = """
import jax, sys
hits = []
jax.monitoring.register_event_listener(lambda name, **_: hits.append(name))
sys.argv = ["tethership", "dock", "--set", "stop.time_limit=1", "--out", sys.argv[1], "--json"]
from tethership.cli import main
try:
    main()
except SystemExit:
    pass
kinds = [name.rsplit("/", 1)[-1] for name in hits if "compilation_cache" in name]
print(kinds.count("cache_hits"), kinds.count("cache_misses"))
"""


@pytest.mark.slow
def test_a_second_process_does_not_compile_again(tmp_path):
    """JAX's persistent cache: the first process misses, the second hits for every program, the integrator's included,
    and misses none. It needs a few less: what tracing computes on the way is traced once.
    """
    counts = []
    for _ in range(2):
        environment = {**os.environ, "XDG_CACHE_HOME": str(tmp_path)}
        environment.pop("JAX_COMPILATION_CACHE_DIR", None)
        done = subprocess.run(
            [sys.executable, "-c", COUNT, str(tmp_path / "out")],
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
        counts.append([int(word) for word in done.stdout.splitlines()[-1].split()])
    (_, first_misses), (second_hits, second_misses) = counts
    assert first_misses > 0
    assert first_misses - 8 <= second_hits
    assert second_misses == 0


def test_flight_picture_and_replay_are_of_one_run(run, tmp_path):
    code, _, err = run("dock", "--set", "stop.time_limit=1", "--out", tmp_path)
    assert code == 0, err
    one = ts.Flight.load(tmp_path / "flight.nc").run
    with Image.open(tmp_path / "docking.png") as picture:
        assert picture.info["run"] == one
    assert f'<meta name="tethership-run" content="{one}">' in (tmp_path / "replay.html").read_text(encoding="utf-8")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["docking.png", "flight.nc", "replay.html"]


def test_what_cannot_be_drawn_costs_no_flight_and_leaves_no_older_picture(run, tmp_path, monkeypatch):
    for name in ("docking.png", "replay.html"):
        (tmp_path / name).write_text("of an earlier run")

    def failing(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr("tethership.view.replay.replay_text", failing)
    code, _, _ = run("dock", "--set", "stop.time_limit=1", "--out", tmp_path)
    assert code == 3
    assert [path.name for path in tmp_path.iterdir()] == ["flight.nc"]
    assert float(ts.Flight.load(tmp_path / "flight.nc").data["time"][-1]) == 1.0


def test_a_file_without_checksum_is_told_in_one_line(run, tmp_path, flight):
    flight.data.assign_attrs(format=1).to_netcdf(tmp_path / "old.nc", engine="h5netcdf")
    code, out, err = run("view", tmp_path / "old.nc", "--no-open", "--json")
    assert (code, err.count("\n")) == (0, 1)
    assert err.startswith("tethership: warning: ")
    assert "without a checksum" in err
    assert json.loads(out)["file"] == str(tmp_path / "old_replay.html")
