"""A flight as a table: every number of it, under a name that says what and in which unit.

Truth: the labelled dataset, component by component; what the formats give back. If this fails, a colleague plots the
ship's east as its north, or a script's million rows fill the memory.
"""

import json
import sys

import numpy as np
import pandas as pd
import pytest
import scipy.io
import xarray as xr

import tethership as ts
from tethership.cli import main
from tethership.results.columns import _valid_name, to_frame


@pytest.fixture(scope="module")
def stored(flight, tmp_path_factory):
    path = tmp_path_factory.mktemp("flown") / "flight.nc"
    flight.save(path)
    return path


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


def test_a_row_an_instant_and_every_component(flight):
    frame, data = flight.to_frame(), flight.data
    assert frame.index.name == "time [s]"
    np.testing.assert_array_equal(frame.index, data["time"])
    assert frame.shape[1] == sum(variable[0].size for variable in data.data_vars.values())
    assert frame.memory_usage().sum() < 2 * data.nbytes  # the dataset's own to_dataframe() asks for gigabytes
    named = {
        "velocity_forward [m/s]": data["velocity"].sel(body_axis="forward"),
        "attitude_pitch [rad]": data["attitude"].sel(angle="pitch"),
        "tension_nose [N]": data["tension"].sel(cable="nose"),
        "load_moment_fins_starboard [N m]": data["load_moment"].sel(load="fins", body_axis="starboard"),
        "cable_curve_nose_16_down [m]": data["cable_curve"].sel(cable="nose", ground_axis="down")[:, 16],
        "clearance [m]": data["clearance"],
    }
    for column, expected in named.items():
        np.testing.assert_array_equal(frame[column], expected)


def test_names_that_would_be_the_same_stay_apart():
    values = np.arange(2.0)[:, None]
    units = {"units": "N"}
    both = xr.Dataset(
        {
            "tension": (("time", "cable"), np.hstack([values, values + 1.0]), units),
            "tension_largest": (("time", "cable"), np.hstack([values + 2.0, values + 3.0]), units),
        },
        {"time": [0.0, 1.0], "cable": ["largest_x", "x"]},
    )
    frame = to_frame(both)
    assert len(set(frame.columns)) == 4
    assert frame["tension_largest_x [N]"][0] == 0.0
    assert frame["tension_largest.x [N]"][0] == 3.0


def test_csv_has_every_digit(run, stored, tmp_path, flight):
    code, out, err = run("export", stored, "--out", tmp_path, "--json")
    assert (code, err) == (0, "")
    assert json.loads(out) == {"files": [str(tmp_path / "flight.csv")]}
    again = pd.read_csv(tmp_path / "flight.csv", index_col=0, float_precision="round_trip")
    pd.testing.assert_frame_equal(again, flight.to_frame(), check_exact=True)


def test_mat(run, stored, tmp_path, flight):
    code, out, _ = run("export", stored, "--to", "mat", "--out", tmp_path / "deep" / "own.mat")
    assert (code, out) == (0, f"wrote {tmp_path / 'deep' / 'own.mat'}\n")
    read = scipy.io.loadmat(tmp_path / "deep" / "own.mat", simplify_cells=True)
    np.testing.assert_array_equal(read["time"], flight.data["time"])
    np.testing.assert_array_equal(read["tension_nose"], flight.to_frame()["tension_nose [N]"])
    assert read["units"]["load_moment_fins_starboard"] == "N m"
    assert set(read["units"]) == {name for name in read if not name.startswith("__")} - {"units"}


def test_names_for_matlab():
    assert _valid_name("tension_nose-left é", {}) == "tension_nose_left__"
    assert _valid_name("a" * 70, {"a" * 63: None}) == "a" * 61 + "_2"
    assert _valid_name("tension_a-b", {"tension_a_b": None, "tension_a_b_2": None}) == "tension_a_b_3"


def test_parquet(run, stored, tmp_path, flight):
    pytest.importorskip("pyarrow")
    assert run("export", stored, "--to", "parquet", "--out", tmp_path)[0] == 0
    pd.testing.assert_frame_equal(pd.read_parquet(tmp_path / "flight.parquet"), flight.to_frame(), check_exact=True)


def test_parquet_without_pyarrow_says_what_to_install(run, stored, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    code, out, err = run("export", stored, "--to", "parquet", "--out", tmp_path)
    assert (code, out) == (2, "")
    assert err == "tethership: parquet needs pyarrow, which is not installed: pip install 'tethership[parquet]'\n"
    assert list(tmp_path.iterdir()) == []


def test_wrong_input_is_one_line(run, stored, tmp_path, docking, point):
    (tmp_path / "there.csv").write_text("mine")
    ts.linearize(docking, point).save(tmp_path / "model.nc")
    for words, said in (
        ([tmp_path / "no.nc"], "no.nc: no such file"),
        ([tmp_path], "is a folder, not a flight; name a flight.nc"),
        ([tmp_path / "model.nc"], "is a netCDF file but no flight of tethership"),
        ([stored, "--out", tmp_path / "there.csv"], "there.csv exists already; nothing is overwritten"),
        ([stored, "--out", tmp_path / "own.mat"], "is no name for --to csv: give one that ends in .csv"),
        ([stored, "--out", tmp_path / "there.csv" / "deeper.csv"], "cannot write"),
        ([stored, "--to", "xls"], "'xls' is not one of 'csv', 'parquet', 'mat'"),
    ):
        code, out, err = run("export", *words)
        assert (code, out) == (2, ""), words
        assert said in err
        assert err.count("\n") == 1
    assert (tmp_path / "there.csv").read_text() == "mine"
