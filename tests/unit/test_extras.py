"""Without what is optional the docking is flown and drawn, and whatever needs more says in one line what to install.

If one of these failed, a bare installation would end in a traceback, or would bring what nobody asked for.
"""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from tethership._extras import EXTRAS, needs
from tethership.analysis import LinearModel
from tethership.campaign import open_results
from tethership.campaign.execute import on_cluster
from tethership.errors import ConfigError
from tethership.studies.docking_paper.moordyn_line import load_moordyn
from tethership.view.report.report import _plotly

PROJECT = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text(encoding="utf-8"))["project"]

OPTIONAL = ("control", "dash", "distributed", "moordyn", "plotly", "pyarrow", "zarr")
"""What may be missing."""

COMMANDS = {
    "dock": ["dock", "--json", "--set", "stop.time_limit=0.5", "--out", "out"],
    "view": ["view", "out/flight.nc", "--no-open", "--json"],
    "export": ["export", "out/flight.nc", "--to", "parquet"],
    "sweep": ["sweep", "--over", "wind=6:7:2", "--out", "out"],
    "figure": ["sweep", "--figure", "7", "--out", "out"],
    "explore": ["explore", "--no-open"],
    "campaign": ["campaign", "gusts", "--samples", "1", "--out", "odds"],
    "reproduce": ["reproduce", "--only", "table3"],
}

BARE = """
import contextlib, io, json, sys
for name in {optional!r}:
    sys.modules[name] = None
from tethership.cli import main
found = {{}}
for name, words in {commands!r}.items():
    out, err, code, sys.argv = io.StringIO(), io.StringIO(), 0, ["tethership", *words]
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        try:
            main()
        except SystemExit as end:
            code = end.code
    found[name] = [code, out.getvalue(), err.getvalue()]
print(json.dumps(found))
"""
"""Every command in one process that can import nothing that is optional."""


@pytest.fixture(scope="module")
def bare(tmp_path_factory):
    """Return the folder of a bare installation's commands, and exit code, standard output and error of each."""
    folder = tmp_path_factory.mktemp("bare")
    script = BARE.format(optional=OPTIONAL, commands=COMMANDS)
    ended = subprocess.run([sys.executable, "-c", script], cwd=folder, capture_output=True, text=True, timeout=300)
    assert ended.returncode == 0, ended.stderr
    return folder, json.loads(ended.stdout)


def test_a_docking_needs_nothing_optional(bare, is_whole):
    folder, found = bare
    code, out, _ = found["dock"]
    assert (code, json.loads(out)["outcome"]) == (0, "time_limit")
    for name in ("flight.nc", "docking.png", "replay.html"):
        assert is_whole(folder / "out" / name)
    assert found["view"][0] == 0


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("export", "parquet needs pyarrow, which is not installed: pip install 'tethership[parquet]'"),
        ("sweep", "a plot to be explored needs plotly, which is not installed: pip install 'tethership[plots]'"),
        ("figure", "a plot to be explored needs plotly, which is not installed: pip install 'tethership[plots]'"),
        ("explore", "the explorer needs dash, which is not installed: pip install 'tethership[explore]'"),
        ("campaign", "a campaign needs zarr, which is not installed: pip install 'tethership[campaign]'"),
        ("reproduce", "a plot to be explored needs plotly, which is not installed: pip install 'tethership[plots]'"),
    ],
)
def test_a_command_says_in_one_line_what_it_needs(bare, command, said):
    assert bare[1][command] == [2, "", f"tethership: {said}\n"]


def test_what_lacks_something_leaves_nothing_behind(bare):
    assert sorted(path.name for path in bare[0].iterdir()) == ["out"]


def flown_on_a_cluster():
    """Ask for a cluster."""
    with on_cluster("tcp://127.0.0.1:1"):
        pass


@pytest.mark.parametrize(
    ("package", "extra", "ask"),
    [
        ("control", "control", lambda: LinearModel.to_control(None)),
        ("distributed", "cluster", flown_on_a_cluster),
        ("moordyn", "reproduce", load_moordyn),
        ("plotly", "plots", _plotly),
    ],
)
def test_the_library_says_what_it_needs(package, extra, ask, monkeypatch):
    for name in [package, *(known for known in sys.modules if known.startswith(f"{package}."))]:
        monkeypatch.setitem(sys.modules, name, None)
    said = f"{EXTRAS[extra]} needs {package}, which is not installed: pip install 'tethership[{extra}]'"
    with pytest.raises(ConfigError, match=f"^{re.escape(said)}$"):
        ask()


def test_results_without_zarr_are_not_called_damaged(monkeypatch, tmp_path):
    monkeypatch.setattr("tethership.campaign.store.read_manifest", lambda folder: type("Any", (), {"unsealed": False}))
    monkeypatch.setitem(sys.modules, "zarr", None)
    with pytest.raises(ConfigError, match="a campaign needs zarr"):
        open_results(tmp_path)


def test_our_own_mistakes_are_not_laid_to_an_extra():
    with pytest.raises(ImportError, match="no_such_name"), needs("plots"):
        from tethership.errors import no_such_name  # noqa: F401


def test_extras_bring_what_they_say():
    """What is optional is asked for by its extra alone; `all` has every part, and the developers' has `all`."""
    extras = PROJECT["optional-dependencies"]
    required = {re.split(r"[<>=\[]", line)[0] for line in PROJECT["dependencies"]}
    assert not required & set(OPTIONAL)
    for extra in EXTRAS:
        assert any(name in line for line in extras[extra] for name in (*OPTIONAL, "tethership[plots]")), extra
    assert set(re.findall(r"\w+", extras["all"][0])[1:]) == set(EXTRAS) - {"reproduce"}
    assert "all" in re.findall(r"\w+", extras["dev"][0])
