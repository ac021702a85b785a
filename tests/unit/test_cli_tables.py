"""Tables as CSV: the numbers of the JSON, every digit; refused before any work where they cannot be written."""

import csv
import json
import os
import subprocess
import sys

import pytest
from matplotlib import image

from tethership.cli.tables import Row, print_table, write_rows
from tethership.scenario.load import packaged_text
from tethership.scenario.quantity import NUMBER_WITH_UNIT

COMMAND = [sys.executable, "-m", "tethership"]


def run(*arguments):
    return subprocess.run([*COMMAND, *map(str, arguments)], capture_output=True, text=True)


def read(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_full_precision_and_words(tmp_path, capsys):
    rows = [Row("thrust, port", 1.0 / 3.0, "N", ".2f", "  at a bound"), Row("regime", "slack")]
    assert write_rows(tmp_path / "a.csv", rows) == [str(tmp_path / "a.csv")]
    found = read(tmp_path / "a.csv")
    assert float(found[0]["value"]) == 1.0 / 3.0
    assert [row["quantity"] for row in found] == ["thrust, port", "regime"]
    print_table(rows, "title")
    shown = capsys.readouterr().out
    assert "0.33  N  at a bound" in shown
    assert shown.startswith("title\n")
    assert write_rows(None, rows) == []


def test_trim(tmp_path):
    path = tmp_path / "new" / "trim.csv"
    done = run("trim", "--csv", path, "--json")
    told = json.loads(done.stdout)
    found = {row["quantity"]: row for row in read(path)}
    assert float(found["tension nose"]["value"]) == told["tension"][0]
    assert found["theta"]["unit"] == "deg"


def test_modes(tmp_path):
    done = run("modes", "--csv", tmp_path / "m.csv", "--out", tmp_path, "--json")
    told = json.loads(done.stdout)["modes"]
    found = read(tmp_path / "m.csv")
    assert [row["name"] for row in found] == [mode["name"] for mode in told]
    assert [float(row["real"]) for row in found] == [mode["eigenvalue"][0] for mode in told]
    assert (tmp_path / "modes.png").read_bytes().startswith(b"\x89PNG")
    assert image.imread(tmp_path / "modes.png").std() > 0.05  # a blank page has 0


def test_sweep(tmp_path):
    done = run("sweep", "--over", "wind=6:7:2", "--csv", tmp_path / "s.csv", "--out", tmp_path, "--json")
    told = json.loads(done.stdout)
    rows = [row for row in read(tmp_path / "s.csv") if row["track"] == "pendulum"]
    assert [[float(row["real"]), float(row["imaginary"])] for row in rows] == told["tracks"]["pendulum"]
    assert [float(row["wind.speed"]) for row in rows] == [6.0, 7.0]


def test_list(tmp_path):
    assert run("list", "--csv", tmp_path / "l.csv").returncode == 0
    assert {"kind": "vehicles", "name": "lotte"}.items() <= next(
        row for row in read(tmp_path / "l.csv") if row["name"] == "lotte"
    ).items()


@pytest.mark.parametrize("command", [["trim"], ["list"], ["tension", "--end", "-11", "0", "-11"]])
def test_a_folder_is_refused(tmp_path, command):
    done = run(*command, "--csv", tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == f"tethership: --csv {tmp_path} is a folder; name a file, e.g. --csv {tmp_path}/table.csv\n"


def test_a_place_that_cannot_be_is_refused():
    done = run("dock", "--csv", "/proc/none.csv")
    assert (done.returncode, done.stdout) == (2, "")
    assert "cannot write --csv /proc/none.csv" in done.stderr


@pytest.mark.slow
def test_lists(tmp_path):
    told = json.loads(run("list", "parameters", "--scenario", "docking_paper", "--json").stdout)["parameters"]
    assert told["wind.speed"]["unit"] == "m/s"
    assert json.loads(run("list", "parameters", "docking_paper", "--json").stdout)["parameters"] == told
    (tmp_path / "mine.toml").write_text(packaged_text("scenarios", "hover"), encoding="utf-8")
    mine = json.loads(run("list", "parameters", tmp_path / "mine.toml", "--json").stdout)["parameters"]
    assert "vehicle.body.mass" in mine
    assert not any(name.startswith("cables") for name in mine)
    for given, message in (
        (("scenarios", "hover"), "only parameters are a scenario's; write tethership list parameters hover"),
        (("parameters", "hover", "--scenario", "docking"), "two scenarios are named, hover and --scenario docking"),
        (("parameters", "hovr"), "did you mean 'hover'?"),
    ):
        refused = run("list", *given)
        assert (refused.returncode, refused.stdout) == (2, "")
        assert message in refused.stderr
    assert run("list", "outputs", "--csv", tmp_path / "o.csv").returncode == 0
    (tension,) = [row for row in read(tmp_path / "o.csv") if row["name"] == "tension"]
    assert (tension["unit"], tension["dims"]) == ("N", "time × cable")
    wrong = run("list", "output")
    assert (wrong.returncode, wrong.stdout) == (2, "")
    assert "did you mean 'outputs'?" in wrong.stderr


@pytest.mark.parametrize(
    ("typed", "offered"),
    [
        ("tethership tri", ["trim"]),
        ("tethership dock docking_", ["docking_paper", "docking_retuned"]),
        ("tethership dock --layers rewind,n", ["rewind,navigation"]),
        ("tethership dock --set wind.s", ["wind.speed="]),
        ("tethership campaign r", ["retuned"]),
        ("tethership list outp", ["outputs"]),
    ],
)
def test_the_shell_completes(typed, offered):
    words = typed.split()
    asked = {"_TETHERSHIP_COMPLETE": "complete_bash", "COMP_WORDS": typed, "COMP_CWORD": str(len(words) - 1)}
    script = "from tethership.cli import app; app(prog_name='tethership')"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, env=os.environ | asked)
    assert done.stdout.split() == offered


@pytest.mark.parametrize(
    ("text", "found"),
    [("270deg", ("270", "deg")), ("12 m/s", ("12", "m/s")), ("1e-3 m", ("1e-3", "m")), ("2.5e-3", None), ("9", None)],
)
def test_an_exponent_is_no_unit(text, found):
    match = NUMBER_WITH_UNIT.fullmatch(text)
    assert (match and (match["number"], match["unit"])) == found


def test_no_other_file_is_overwritten(tmp_path):
    flight = tmp_path / "flight.nc"
    flight.write_bytes(b"a flight")
    done = run("list", "--csv", flight)
    assert (done.returncode, done.stdout) == (2, "")
    assert "ends in .csv" in done.stderr
    assert flight.read_bytes() == b"a flight"
