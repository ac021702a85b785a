"""The explorer without a browser: the command and the file give the numbers shown, input is checked, work is bounded.

If one of these failed, a page would show numbers that nobody can repeat, or would reach files that are not its own.
"""

import json
import shlex
import socket
import sys
import threading
import time
import tomllib

import numpy as np
import pytest

import tethership as ts
from tethership.cli import main
from tethership.errors import ConfigError, SolveError
from tethership.explorer.choice import Choice, Form
from tethership.explorer.fields import groups, typed
from tethership.explorer.folder import Folder
from tethership.explorer.queue import Desk
from tethership.explorer.recipe import file_text
from tethership.explorer.requests import Understanding
from tethership.explorer.tasks import compute
from tethership.explorer.worker import Stopped
from tethership.scenario.load import packaged_text

OVER = ("wind.speed", "6", "8", "3")

CHANGED = {
    "wind.speed": "9",
    "wind.from_direction": "10",
    "cables.nose.diameter": "12 mm",
    "cables.nose.tether_point.0": "6.5",
    "start.attitude_offset.1": "5",
    "vehicle.body.mass": "135",
    "vehicle.fins.*.area": "3",
    "vehicle.fins.fin_top.roll": "271",
    "atmosphere.temperature_offset": "5",
    "control.attitude.pitch_share.port_up": "-2",
    "control.heading.gain": "4",
}
"""One of every kind: SI and not, entries of vectors, several at once, with and without a source, nested shares."""


@pytest.fixture
def known(tmp_path):
    return Understanding(Folder(tmp_path))


@pytest.fixture
def shell(monkeypatch, capsys, tmp_path):
    """Run a command as it is shown; return what it says as JSON."""

    def call(command):
        words = shlex.split(command)
        assert words[0] == "tethership"
        extra = [] if words[1] == "modes" else ["--out", str(tmp_path / "out")]
        monkeypatch.setattr(sys, "argv", [*words, "--json", *extra])
        with pytest.raises(SystemExit):
            main()
        return json.loads(capsys.readouterr().out)

    return call


def computed(request):
    """Return what the computing process would."""
    return compute(*request.job(), lambda text, share: None)


@pytest.mark.parametrize(
    ("name", "form"),
    [
        ("docking", Form("docking", CHANGED, ["rewind"], False, "published")),
        ("docking", Form("docking", {"wind.speed": "18 km/h"})),
        ("aerostat", Form("aerostat", {"vehicle.body.mass": "118", "trim.position.2": "-40"})),
        ("hover", Form("hover", {"vehicle.thrusters.*.nominal_thrust": "150"})),
    ],
)
def test_command_and_file_are_the_same_scenario(known, tmp_path, name, form):
    """Number by number, bit for bit: what is computed, what --set says, what the file says."""
    from tethership.cli.common import parsed_changes

    request = known.request("trim", form, OVER)
    shown = ts.load_scenario(*request.job()[1:3]).config
    words = shlex.split(known.commands(request)[0])
    flags = [words[i + 1] for i, word in enumerate(words) if word == "--set"]
    assert ts.load_scenario(name, parsed_changes(flags)).config == shown
    (tmp_path / "again.toml").write_text(known.file_text(request), encoding="utf-8")
    assert ts.load_scenario(str(tmp_path / "again.toml")).config == shown
    assert shown != ts.load_scenario(name).config


def test_trim_shown_is_that_of_the_command_and_of_the_file(known, shell, tmp_path, monkeypatch):
    request = known.request("trim", Form("docking", {"wind.speed": "9", "wind.from_direction": "10"}), OVER)
    shown = computed(request)
    known.folder.save("docking_explored.toml", known.file_text(request))
    monkeypatch.chdir(tmp_path)
    for command in (*known.commands(request), *known.commands_on_file(request, "docking_explored.toml")):
        said = shell(command)
        assert said["throttle"] == list(shown["throttle"].values())
        assert said["tension"] == list(shown["tension"].values())
        assert said["residual"] == shown["residual"]
        assert said["state"]["theta"] == shown["state"]["theta"]


def test_locus_shown_is_that_of_the_commands(known, shell):
    request = known.request("locus", Form("docking", {"cables.nose.length": "22"}), OVER)
    sweep, modes = map(shell, known.commands(request))
    shown = computed(request)
    drawn = {trace["name"]: trace for trace in shown["figure"]["data"]}
    assert len(sweep["tracks"]) == 12
    for name, roots in sweep["tracks"].items():
        assert np.allclose(numbers(drawn[name]["x"]), [root[0] for root in roots], rtol=0, atol=1e-15)
        assert np.allclose(numbers(drawn[name]["y"]), [root[1] for root in roots], rtol=0, atol=1e-15)
    assert [mode["eigenvalue"] for mode in shown["modes"]] == [mode["eigenvalue"] for mode in modes["modes"]]
    stars = drawn["chosen scenario"]
    assert sorted(zip(stars["x"], stars["y"], strict=True)) == sorted(map(tuple, modes["eigenvalues"]))


def numbers(entry):
    """Return a plotly array, which may be packed."""
    import base64

    if isinstance(entry, dict):
        return np.frombuffer(base64.b64decode(entry["bdata"]), dtype=entry["dtype"])
    return np.array(entry)


def test_flight_shown_is_that_of_the_command(known, shell):
    request = known.request("flight", Form("docking", {"stop.time_limit": "2"}, ["rewind"]), OVER)
    shown, said = computed(request), shell(known.commands(request)[0])
    assert said["outcome"] == shown["outcome"] == "time_limit"
    assert said["layers"] == shown["layers"] == ["rewind"]
    for key in ("tension_max", "tension_mean", "E", "ADC", "theta_rms", "seconds_above"):
        assert said[key] == shown["metrics"][key]


@pytest.mark.parametrize(
    ("texts", "message"),
    [
        ({"wind.speed": "fast"}, "wind.speed: 'fast' is no number; write a number in m/s"),
        ({"wind.speed": "-3"}, "wind.speed: it is -3 m/s; it must be at least 0"),
        ({"wind.speed": "9 kg"}, "'kg', which is no 'm/s'"),
        ({"wind.speed": "9,5"}, "'9,5' is no number"),
        ({"wind.speed": "1 m/s*9**9**9"}, "is no unit"),
        ({"wind.speed": "nan"}, "not a finite number"),
        ({"wind.from_direction": "10 m"}, "which is no 'rad'; give deg or rad"),
        ({"cables.nose.length": "0"}, "it must be above 0"),
        ({"cables.nose.winch.rewind_rate": "9"}, "beyond fastest_rate"),
        ({"vehicle.body.mass": "-1"}, "it must be above 0"),
        ({"vehicle": "../ship.toml"}, "has no number 'vehicle'"),
        ({"wind.file": "/etc/passwd"}, "has no number 'wind.file'"),
        ({"wind.sped": "3"}, "has no number 'wind.sped'"),
    ],
)
def test_wrong_numbers_have_one_clear_line(known, texts, message):
    with pytest.raises(ConfigError) as caught:
        known.request("trim", Form("docking", texts), OVER)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("over", "message"),
    [
        (("wind.speed", "8", "6", "3"), "from must be below to"),
        (("wind.speed", "6", "8", "many"), "'many' is no whole number"),
        (("wind.speed", "6", "8", "100000"), "is not between 2 and 400"),
        (("wind.spede", "6", "8", "3"), "nearest: wind.speed"),
        (("wind.speed", "six", "8", "3"), "from: 'six' is no number"),
    ],
)
def test_wrong_loci_have_one_clear_line(known, over, message):
    with pytest.raises(ConfigError, match=message):
        known.request("locus", Form("docking", {}), over)


def test_layers_without_a_cable_are_refused(known):
    with pytest.raises(ConfigError, match="need a cable"):
        known.request("flight", Form("hover", {}, ["rewind"]), OVER)


def test_an_exponent_is_no_unit():
    parameter = ts.list_parameters(ts.load_scenario("docking").config)["stop.time_limit"]
    assert typed(parameter, "1e5") == (1e5, "s")


def test_fields_show_the_scenarios_own_numbers():
    """Every number that a scenario has is in its group, in degrees and millimetres where people think in them."""
    found = groups(ts.load_scenario("docking").config)
    entries = {field.name: field for rows in found.values() for field in rows}
    assert entries["trim.elevation"].text == "45"
    assert entries["trim.elevation"].unit == "deg"
    assert entries["cables.nose.diameter"].text == "10"
    assert entries["control.heading.gain"].text == "5"
    free = groups(ts.load_scenario("hover").config)
    assert "Trim" in free
    assert not any(title.startswith("Cable") for title in free)


@pytest.mark.parametrize(
    "name",
    ["../outside.toml", "/etc/passwd.toml", "sub/x.toml", "..", ".hidden.toml", "x.TOML", "a\\b.toml", "link.toml"],
)
def test_nothing_outside_the_folder_is_read_or_written(tmp_path, name):
    inside = tmp_path / "inside"
    inside.mkdir()
    outside = tmp_path / "outside.toml"
    outside.write_text(packaged_text("scenarios", "docking"))
    (inside / "link.toml").symlink_to(outside)
    folder = Folder(inside)
    with pytest.raises(ConfigError):
        folder.load(name)
    with pytest.raises(ConfigError):
        folder.save(name, "x = 1")
    assert outside.read_text() == packaged_text("scenarios", "docking")
    assert sorted(path.name for path in inside.iterdir()) == ["link.toml"]
    assert "link.toml" not in folder.scenarios()


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('vehicle = "lotte"', 'vehicle = "../ship.toml"'),
        ('speed = { value = 6.0, unit = "m/s"', 'file = "../mast.csv"\nspeed = { value = 6.0, unit = "m/s"'),
    ],
)
def test_a_file_that_names_files_outside_is_refused(tmp_path, old, new):
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "ship.toml").write_text(packaged_text("vehicles", "lotte"))
    (inside / "mine.toml").write_text(packaged_text("scenarios", "docking").replace(old, new))
    with pytest.raises(ConfigError, match="outside"):
        Folder(inside).load("mine.toml")


def test_nothing_is_overwritten_and_edits_are_seen(tmp_path):
    known = Understanding(Folder(tmp_path))
    known.folder.save("mine.toml", packaged_text("scenarios", "docking"))
    with pytest.raises(ConfigError, match="nothing is overwritten"):
        known.folder.save("mine.toml", "")
    first = known.request("trim", Form("mine.toml", {}), OVER)
    (tmp_path / "mine.toml").write_text(packaged_text("scenarios", "docking").replace("value = 6.0", "value = 7.0"))
    second = known.request("trim", Form("mine.toml", {}), OVER)
    assert first != second
    assert known.base("mine.toml").config.wind.speed == 7.0


class Hand:
    """A stand-in for the computing process: works until it is let go or told to stop."""

    def __init__(self):
        self.free = threading.Event()
        self.deaf = threading.Event()
        self.jobs = []

    def run(self, job, progress, should_stop):
        self.jobs.append(job)
        progress("working", 0.5)
        while not self.free.wait(0.005):
            if should_stop() and not self.deaf.is_set():
                raise Stopped("stopped")
        if job[2].get("wind.speed") == 13.0:
            raise SolveError("no equilibrium")
        return job

    def close(self):
        self.free.set()
        self.deaf.clear()


def until(condition):
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.005)


@pytest.fixture
def desk():
    desk = Desk(Hand())
    yield desk
    desk.close()


def test_newer_requests_replace_older_ones(known, desk):
    ask = [known.request("trim", Form("docking", {"wind.speed": str(speed)}), OVER) for speed in (7, 8, 9)]
    desk.ask("me", ask[0])
    until(lambda: desk.ask("me", ask[0]).text == "working")
    desk.ask("me", ask[1])
    desk.ask("me", ask[2])
    desk.worker.free.set()
    until(lambda: desk.ask("me", ask[2]).status == "done")
    assert desk.ask("me", ask[2]).result[2] == {"wind.speed": 9.0}
    assert {"wind.speed": 8.0} not in [job[2] for job in desk.worker.jobs]


def test_two_pages_do_not_take_each_others_work(known, desk):
    mine, other = (known.request("trim", Form("docking", {"wind.speed": str(speed)}), OVER) for speed in (7, 8))
    desk.ask("me", mine)
    desk.ask("other", other)
    desk.worker.free.set()
    until(lambda: desk.ask("me", mine).status == desk.ask("other", other).status == "done")


def test_work_of_a_page_that_was_closed_makes_room(known, desk, monkeypatch):
    monkeypatch.setattr("tethership.explorer.queue.GONE", 0.05)
    closed, other = (known.request("trim", Form("docking", {"wind.speed": str(speed)}), OVER) for speed in (7, 8))
    desk.ask("closed", closed)
    until(lambda: desk.find(lambda one: one == closed) and desk.worker.jobs)
    until(lambda: desk.ask("me", other).text == "working")
    assert desk.find(lambda one: one == closed) is None


def test_cancelled_and_failed_work_stays_so_until_it_is_asked_again(known, desk):
    request = known.request("flight", Form("docking", {}), OVER)
    desk.ask("me", request)
    until(lambda: desk.ask("me", request).text == "working")
    desk.cancel("me")
    assert desk.ask("me", request).status == "cancelled"
    desk.forget(request)
    desk.worker.free.set()
    until(lambda: desk.ask("me", request).status == "done")
    bad = known.request("trim", Form("docking", {"wind.speed": "13"}), OVER)
    until(lambda: desk.ask("me", bad).status == "failed")
    assert desk.ask("me", bad).text == "no equilibrium"


def test_the_end_of_a_cancelled_run_does_not_cancel_the_next_asking(known, desk):
    request = known.request("flight", Form("docking", {}), OVER)
    desk.ask("me", request)
    until(lambda: desk.ask("me", request).text == "working")
    desk.worker.deaf.set()
    desk.cancel("me")
    desk.forget(request)
    assert desk.ask("me", request).status == "waiting"
    desk.worker.deaf.clear()
    until(lambda: len(desk.worker.jobs) == 2)
    desk.worker.free.set()
    until(lambda: desk.ask("me", request).status == "done")


def test_a_slider_moved_there_and_back_computes_what_it_shows(known, desk):
    there, back = (known.request("trim", Form("docking", {"wind.speed": str(speed)}), OVER) for speed in (8, 7))
    desk.ask("me", back)
    until(lambda: desk.ask("me", back).text == "working")
    desk.worker.deaf.set()
    desk.ask("me", there)
    assert desk.ask("me", back).status == "waiting"
    desk.worker.deaf.clear()
    until(lambda: len(desk.worker.jobs) == 2)
    desk.worker.free.set()
    until(lambda: desk.ask("me", back).status == "done")


@pytest.fixture
def refusal(monkeypatch, capsys, tmp_path):
    """Return the one line with which the command refuses."""
    monkeypatch.chdir(tmp_path)

    def call(*flags):
        monkeypatch.setattr(sys, "argv", ["tethership", "explore", "--no-open", *flags])
        with pytest.raises(SystemExit) as stop:
            main()
        out, err = capsys.readouterr()
        assert stop.value.code == 2
        assert out == ""
        assert err.count("\n") == 1
        return err

    return call


def test_a_port_in_use_is_said(refusal):
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        port = str(other.getsockname()[1])
        assert f"port {port} is in use; choose another with --port, or --port 0" in refusal("--port", port)


@pytest.mark.parametrize(
    ("flags", "message"),
    [
        (("--host", "0.0.0.0"), "to this machine alone"),
        (("--folder", "nowhere"), "is no folder"),
        (("../mine.toml", "--folder", "."), "is not in --folder"),
        (("dock",), "no scenario 'dock'; packaged: aerostat"),
        (("gone.toml",), "cannot read gone.toml"),
        (("--port", "70000"), "--port 70000 is no port"),
        (("--port", "x"), "--port"),
    ],
)
def test_wrong_flags_are_said(refusal, flags, message):
    assert message in refusal(*flags)


@pytest.mark.parametrize(
    "text",
    [
        '# top\ntitle = "x"\n\n[wind] # kept\nx = 1 # kept\n\n[a]\nb = 2\n\n[wind.low]\nc = 3\n',
        '[changes]\n# kept\n"wind.speed" = 3 # kept\n\n[wind]\nx = 1\n',
        'changes = { "wind.speed" = 3 }\n[wind]\nx = 1 # kept\n',
        'changes."wind.speed" = 3\n\n[wind]\nx = 1 # kept\n',
    ],
)
def test_file_keeps_comments_and_order_however_its_changes_are_written(docking, text):
    """What stands in the file and is not changed stays, and the changes are read back."""
    choice = Choice("mine.toml", 0, json.dumps({"wind.speed": {"value": 9.0, "unit": "km/h"}, "stop.x": True}), ())
    whole = file_text(docking, text, choice)
    former, now = tomllib.loads(text), tomllib.loads(whole)
    assert now.pop("changes") == {"wind.speed": {"value": 9.0, "unit": "km/h"}, "stop.x": True}
    former.pop("changes", None)
    assert now == former
    assert whole.count("# kept") == text.count("# kept")
