"""Input that nobody means well is refused like any other: one line, exit 2, no hang, nothing left behind.

If one of these failed, a file from the net, a typing error or a cat on the keyboard would end in a traceback, freeze
the explorer for everybody, write outside the folder that was named, or be taken for something else.
"""

import os
import re
import subprocess
import sys
import time
from concurrent.futures import Future

import pytest

import tethership as ts
from tethership.campaign.execute import _result
from tethership.cli import app
from tethership.cli.checked import checked
from tethership.errors import ConfigError, SolveError
from tethership.scenario.load import packaged_text
from tethership.scenario.names import check_title, check_word
from tethership.scenario.quantity import converted

DOCKING = packaged_text("scenarios", "docking")
LOTTE = packaged_text("vehicles", "lotte")
LAYERS = packaged_text("campaigns", "layers")

DEEP = "[" * 600 + "]" * 600


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ("wind.speed=" + "9" * 400, r"whole number is too large \(beyond 2\^63\); write it as 1e9"),
        ("wind.speed=" + "9" * 5000, r"whole number has thousands of digits"),
        ("wind.speed=" + DEEP, r"nested"),
        ("wind.speed=1 m/s*9**9**9", r"the unit is 'm/s\*9\*\*9\*\*9', which is no unit"),
        ("wind.speed=1e308", r"numbers go up to 1e\+18"),
        ("wind.speed=1e300km/s", r"numbers go up to 1e\+18"),
        ("cables.nose.length=1e-300", r"must be at least 1e-18"),
        ("wind.speed=NaN", r"not a finite number"),
        ("control.attitude.roll_share.port_up=NaN", r"roll_share.port_up: it is nan; input should be a finite number"),
        ("control.attitude.roll_share.port_up=Infinity", r"should be a finite number"),
        ("cables.².length=3", r"no item '²' in a list of 1; there are nose"),
        ("a" * 300 + "=3", r"unknown key 'a+ … \(cut\)"),
        (".".join("a" * 2000) + "=3", r"2000 steps; no value lies that deep"),
        ("formulation=" + "x" * 100_000, r"formulation: it is 'x+ … \(cut\); input should be"),
        ("control.sas=yes", r"control.sas: it is 'yes'; input should be a valid boolean"),
        ("control.sas=1", r"control.sas: it is .*; input should be a valid boolean"),
        ('vehicle="a\\u0000.toml"', r"the name 'a\\x00.toml' has a NUL"),
        ("changes=3", r"unknown key 'changes'"),
    ],
)
def test_change(refusal, change, message):
    assert re.search(message, refusal("trim", "--set", change, "--out", "new/folder"))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("trim", "--wind", "nan"), "wind: nan is not a finite number"),
        (("campaign", "gusts", "--confidence", "nan"), "confidence"),
        (("tension", "--end", "nan", "0", "0"), "end: nan is not a finite number"),
        (("tension", "--end", "-11", "0", "-11", "--wind-vector", "0", "inf", "0"), "wind_vector: inf is not a finite"),
        (("tune", "--wind", "inf"), "wind: inf is not a finite number"),
        (("sweep", "--over", "wind=6:12:99999999999999999999"), "too many"),
        (("sweep", "--over", "wind=6:12:1000000000"), "1000000000 points are too many"),
        (("sweep", "--over", "wind=6:inf:3"), "not a finite number"),
        (("sweep", "--over", f"wind={DEEP}"), "nested"),
        (("campaign", "gusts", "--seed", "9" * 30), "the number is too large"),
        (("list", "nosuch", "--csv", "new/table.csv"), "there is no list 'nosuch'"),
        (("dock", "--solver", "nosuch", "--out", "new"), "no solver 'nosuch'"),
        (("dock", "--from", "nowhere.nc", "--out", "new"), "nowhere.nc"),
        (("modes", "nosuch", "--csv", "new/a.csv", "--out", "new"), "no scenario 'nosuch'"),
        (("trim", "--unknowns", "thota", "--out", "new"), "unknown quantity 'thota'"),
        (("dock", "a" * 300 + ".toml"), "has a part of 305 bytes"),
        (("trim", "--csv", "a" * 300 + ".csv"), "has a part of 304 bytes"),
        (("campaign", "a" * 300), "is no plain word"),
        (("dock", "\udcff.toml"), "is not UTF-8"),
        (("trim", "--out", "\udcff"), "is not UTF-8"),
        (("new", 'a"b'), "is no plain word"),
        (("new", ".."), "is no plain word"),
        (("new", ""), "is no plain word"),
        (("explore", "--port", "99999999"), "port"),
    ],
)
def test_words(refusal, words, message):
    assert message in refusal(*words)


def replaced(text, old, new):
    """Return a text with something replaced that is in it."""
    assert old in text
    return text.replace(old, new)


SCENARIOS = {
    "changes no table": ("changes = 3\n" + DOCKING, "changes is 3; give a table"),
    "huge number": (f"a = {'9' * 400}\n" + DOCKING, "a whole number is too large"),
    "huger number": (f"a = {'9' * 5000}\n" + DOCKING, "a whole number has thousands of digits"),
    "hexadecimal number": (f"a = 0x{'f' * 5000}\n" + DOCKING, "a whole number is too large"),
    "brackets": (f"a = {DEEP}\n" + DOCKING, "nested"),
    "huge key": ("x" * 3_000_000 + " = 3\n" + DOCKING, r"unknown key 'xxx"),
    "huge title": (replaced(DOCKING, 'title = "', f'title = "{"x" * 3_000_000}'), "title"),
    "nul": (replaced(DOCKING, 'vehicle = "lotte"', 'vehicle = "a\\u0000.toml"'), "has a NUL"),
    "share": (replaced(DOCKING, "port_forward = -1.0", "port_forward = nan"), "port_forward: it is nan"),
    "true for a number": (replaced(DOCKING, "port_forward = -1.0", "port_forward = true"), "valid number"),
    "cable": (replaced(DOCKING, 'name = "nose"', 'name = "a.b"'), "the name 'a.b' is no plain word; give a letter"),
    "cable by number": (replaced(DOCKING, 'name = "nose"', 'name = "1"'), "is no plain word"),
    "cable and fin": (
        replaced(DOCKING, 'name = "nose"', 'name = "fin_top"'),
        "two cables, fins or thrusters",
    ),
    "text for a unit": (replaced(DOCKING, 'unit = "s"', "unit = 3"), "unit is 3, not a text"),
}


@pytest.mark.parametrize("case", SCENARIOS)
def test_scenario(refusal, tmp_path, case):
    text, message = SCENARIOS[case]
    (tmp_path / "case.toml").write_text(text)
    assert message in refusal("validate", "case.toml")


@pytest.mark.parametrize("name", ["p", "u", "theta", "north", "velocity_down", "wind_rate_east", "length_nose"])
def test_thruster_named_like_a_quantity(refusal, tmp_path, name):
    """`trim.unknowns = ["p"]` would look for the roll rate and not for the thruster."""
    (tmp_path / "ship.toml").write_text(replaced(LOTTE, '"tail_down"', f'"{name}"'))
    assert f"thrusters.{name}.name: the name '{name}' is that of a state" in refusal("validate", "ship.toml")


@pytest.mark.parametrize("name", ["throttle", "deflection", "rewind_rate_nose", "phi"])
def test_fin_named_like_a_quantity(refusal, tmp_path, name):
    (tmp_path / "ship.toml").write_text(replaced(LOTTE, '"fin_top"', f'"{name}"'))
    assert f"fins.{name}.name: the name '{name}' is that of a state" in refusal("validate", "ship.toml")


CAMPAIGNS = {
    "law outside": ('name = "rewind"', 'name = "../../../escaped"', "'../../../escaped' is no plain word"),
    "law without a name": ('name = "rewind"', 'name = ""', "'' is no plain word"),
    "law twice": ('name = "rewind"', 'name = "Heading"', "two laws are named"),
    "text for a count": ("samples = 1000", 'samples = "10"', "samples: it is '10'; input should be a valid integer"),
    "infinite deviation": ("deviation = 0.3", "deviation = inf", "deviation: it is inf; input should be a finite"),
    "confidence": ("confidence = 0.95", "confidence = nan", "confidence: it is nan; input should be a finite number"),
    "vary no table": (LAYERS[LAYERS.index("[vary") :], "[vary]", "nothing varies"),
    "vary a number": (LAYERS[LAYERS.index("[vary") :], "vary = 3", "vary"),
}


@pytest.mark.parametrize("case", CAMPAIGNS)
def test_campaign(refusal, tmp_path, case):
    old, new, message = CAMPAIGNS[case]
    (tmp_path / "case.toml").write_text(replaced(LAYERS, old, new))
    assert message in refusal("campaign", "case.toml", "--out", "new")


@pytest.mark.parametrize("text", ["relative_tolerance = inf", "absolute_tolerance = nan", 'most_steps = "10"'])
def test_solver(refusal, tmp_path, text):
    (tmp_path / "solver.toml").write_text(f'method = "tsit5"\n{text}\n')
    assert "input should be a" in refusal("validate", "solver.toml")


def test_pipe_device_and_large_file(refusal, tmp_path):
    """A pipe that nobody writes to and a device that never ends would be read for ever."""
    os.mkfifo(tmp_path / "pipe.toml")
    assert "it is no regular file" in refusal("validate", "pipe.toml")
    (tmp_path / "zero.toml").symlink_to("/dev/zero")
    assert "it is no regular file" in refusal("validate", "zero.toml")
    with (tmp_path / "large.toml").open("wb") as file:
        file.truncate(50_000_000)
    assert "it has 50 MB; at most 10 MB are read" in refusal("validate", "large.toml")


def test_manifest_that_is_none(refusal, tmp_path):
    (tmp_path / "old").mkdir()
    (tmp_path / "old" / "campaign.json").write_text("[]")
    assert "campaign.json" in refusal("campaign", "gusts", "--samples", "20", "--out", "old")


def test_lost_cluster():
    """Its futures are cancelled when the scheduler dies."""
    future = Future()
    future.cancel()
    with pytest.raises(SolveError, match="the cluster was lost"):
        _result(future)


def test_byte_order_mark_is_read(command, tmp_path):
    """Editors of Windows write it."""
    (tmp_path / "case.toml").write_text("\ufeff" + DOCKING, encoding="utf-8")
    assert command("validate", "case.toml")[0] == 0


def test_sensible_names_pass(tmp_path):
    """Letters of any script; a cable named like a layer, a load or a ground axis is nobody else."""
    for name in ("Bug", "Ölleine", "линь", "ropé-2", "rewind", "gravity", "north"):
        assert check_word(name) == name
    assert [check_title(name) for name in ("2nd try", "v1.2", "Bug")] == ["2nd try", "v1.2", "Bug"]
    (tmp_path / "case.toml").write_text(replaced(DOCKING, 'name = "nose"', 'name = "share"'))
    scenario = ts.load_scenario(str(tmp_path / "case.toml"), {"cables.share.length": 21.0})
    assert scenario.config.cables[0].length == 21.0


@pytest.mark.parametrize("unit", ["m", "km/h", "kg m^2", "m**2", "m²", "1/s", "kg/(m s^2)", "µm", "°", "degC", "%"])
def test_units_that_pass(unit):
    """Only the alphabet is looked at: each of these gets as far as pint, which knows it."""
    with pytest.raises(ValueError, match="which is no 'A'"):
        converted(1.0, unit, "A")


@pytest.mark.parametrize("unit", ["m*9**9**9", "m**99", "m**(9**9)", "__import__('os')", "m;s", "m" * 50, "9**9", "²"])
def test_units_that_are_sums(unit):
    start = time.monotonic()
    with pytest.raises(ValueError, match="which is no unit"):
        converted(1.0, unit, "m")
    assert time.monotonic() - start < 1.0


def test_very_long_line_has_no_equilibrium(command):
    """The ship would hang 70 km up, where the standard air has no density: an answer, not a traceback of scipy."""
    code, out, err = command("trim", "--set", "cables.nose.length=100000")
    assert (code, err) == (3, "")
    assert out.startswith("no_equilibrium: ")


def test_output_that_cannot_be_written(command, monkeypatch):
    """A full disk or a closed output is told, and the command does not end as if all were well."""
    with open("/dev/full", "w") as full:
        monkeypatch.setattr(sys, "stdout", full)
        code, _, err = command("list")
        assert (code, err) == (2, "tethership: cannot write or read standard output: No space left on device\n")
    monkeypatch.setattr(sys, "stdout", None)
    code, _, err = command("list")
    assert code == 2
    assert err.startswith("tethership: standard output is closed")


INTERRUPTED = """
import os, signal, sys
sys.argv = ["tethership"]
class Interrupt:
    def find_spec(self, name, *_):
        if name == "jax":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Interrupt())
import tethership
"""


def test_interrupt_while_loading():
    done = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr == "tethership: interrupted while it was being loaded\n"


def test_every_command_checks_its_options():
    for registered in app.registered_commands:
        assert registered.callback.__code__ is checked(len).__code__, registered.name


def test_one_line_of_any_length():
    message = str(ConfigError("a\nb\x1b[31m" + "x" * 10_000_000 + " do this"))
    assert len(message) < 5000
    assert message.startswith("a b\\x1b[31mxxx")
    assert message.endswith(" do this")
