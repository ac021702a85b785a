"""Files that were damaged, changed or forged: refused in one line, or what they give is what was written.

Truth: the flight, model, fit and campaign that were written. If this fails, a flipped bit becomes a number.
"""

import json
import random
import warnings

import h5py
import numpy as np
import pytest
import xarray as xr

import tethership as ts
from tethership.errors import ConfigError, TethershipWarning
from tethership.results import VARIABLES, netcdf, store
from tethership.results.schema import ATTRIBUTES, FLIGHT
from tethership.simulation.header import FlightHeader, stored_solver
from tethership.studies.docking_paper.fit.fit_file import fit_text, read_fit

COUNT = 60
SIZES = {
    "body_axis": 3,
    "ground_axis": 3,
    "angle": 3,
    "thruster": 2,
    "fin": 1,
    "load": 7,
    "cable": 1,
    "cable_point": 17,
}
LABELS = {"thruster": ["left", "right"], "fin": ["only"], "cable": ["nose"], "load": [f"load {i}" for i in range(7)]}
HEADER = {
    "outcome": "docked",
    "steps": 12,
    "layers": ["rewind"],
    "own_laws": [],
    "sas": True,
    "formulation": "consistent",
    "limits": [144.3, 481.0, 2354.0, 3040.0],
    "scenario_name": "docking",
    "scenario": {"title": "a flight"},
    "solver": {"largest_step": 0.25},
    "trim": {"state": [0.0] * 12, "throttle": [0.1, 0.2], "deflection": [0.0]},
    "versions": {"tethership": "0"},
}


@pytest.fixture(scope="module")
def flown():
    """A small flight with every output: numbers at random, some of them in packed variables."""
    numbers = np.random.default_rng(1)
    arrays = {
        name: numbers.normal(size=(COUNT, *(SIZES[dim] for dim in entry.dims))) for name, entry in VARIABLES.items()
    }
    arrays["time"] = np.linspace(0.0, 3.0, COUNT)
    arrays["cable_curve"][3] = np.nan
    return ts.Flight(store.to_dataset(arrays, LABELS, HEADER), ts.Outcome.docked)


@pytest.fixture
def saved(flown, tmp_path):
    flown.save(tmp_path / "flight.nc")
    return tmp_path / "flight.nc"


def same(one, other):
    return one.data.equals(other.data) and one.attributes == other.attributes and one.metrics == other.metrics


@pytest.fixture(autouse=True)
def _no_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("error", TethershipWarning)
        yield


def test_file_and_back_has_the_same_run(flown, saved):
    back = ts.Flight.load(saved)
    assert same(back, flown)
    assert back.data.identical(flown.data)
    assert back.run == flown.run
    with h5py.File(saved) as file:
        assert file.attrs["run"] == flown.run
    changed = ts.Flight(flown.data.assign(tension=flown.data["tension"] + 1e-9), flown.outcome)
    assert changed.run != flown.run


@pytest.mark.slow
def test_any_flipped_bit_is_refused_or_harmless(flown, saved):
    whole = saved.read_bytes()
    choose, told = random.Random(1), []
    for _ in range(120):
        place = choose.randrange(8 * len(whole))
        damaged = bytearray(whole)
        damaged[place // 8] ^= 1 << place % 8
        saved.write_bytes(damaged)
        try:
            assert same(ts.Flight.load(saved), flown), place
        except ConfigError as error:
            told.append(str(error))
    assert len(told) > 60
    assert all("\n" not in line and len(line) < 300 for line in told)


def test_what_others_add_is_left_alone(flown, saved):
    """As NCO, CDO and xarray do: attributes, another packing, another variable, another order."""
    with h5py.File(saved, "r+") as file:
        file.attrs["history"] = "Fri Nov 27: ncatted -a title,global,o,c,mine flight.nc"
        file["tension"].attrs["comment"] = "mine"
    assert same(ts.Flight.load(saved), flown)
    with xr.open_dataset(saved, engine="h5netcdf") as opened:
        data = opened.load()
    data["doubled"] = 2.0 * data["tension"]
    data = data.assign_coords(minute=("time", data["time"].values / 60.0))
    packing = {name: {"zlib": True, "complevel": 9, "chunksizes": None} for name in VARIABLES}
    data[sorted(data.data_vars)].to_netcdf(saved.with_name("again.nc"), engine="h5netcdf", encoding=packing)
    back = ts.Flight.load(saved.with_name("again.nc"))
    assert back.metrics == flown.metrics
    assert back.attributes == flown.attributes
    assert "doubled" in back.data
    assert back.data.attrs["history"].startswith("Fri Nov 27")


@pytest.mark.parametrize("name", ["tension", "time", "throttle", "cable_curve"])
def test_a_number_changed_by_hand_is_told(saved, name):
    with h5py.File(saved, "r+") as file:
        file[name][7] = file[name][7] + 1e-9
    with pytest.raises(ConfigError, match=rf"flight\.nc is damaged or was changed \(not as written: {name}\)"):
        ts.Flight.load(saved)


@pytest.mark.parametrize(
    ("attribute", "value"),
    [("outcome", '"cable_broken"'), ("limits", "[1,2,3,4]"), ("scenario", "{}"), ("tethership_version", "9")],
)
def test_an_attribute_changed_by_hand_is_told(saved, attribute, value):
    with h5py.File(saved, "r+") as file:
        file.attrs[attribute] = value
    with pytest.raises(ConfigError, match=r"not as written: header"):
        ts.Flight.load(saved)


def test_checksums_and_units_cannot_be_left_out(saved):
    whole = saved.read_bytes()
    for change, message in (
        (lambda file: file.attrs.__delitem__("checksums"), "no checksums can be read"),
        (lambda file: file.attrs.__setitem__("run", "0" * 16), "not as written: the checksums"),
        (lambda file: file.__delitem__("tension"), "without tension"),
        (lambda file: file["tension"].attrs.__setitem__("units", "kN"), "not as written: tension"),
    ):
        saved.write_bytes(whole)
        with h5py.File(saved, "r+") as file:
            change(file)
        with pytest.raises(ConfigError, match=message):
            ts.Flight.load(saved)


def forged(flown, path, variables=None, drop=None, **attributes):
    """Write a flight with other attributes or variables, and the right checksums."""
    given = {key: json.dumps(value) for key, value in attributes.items()}
    data = flown.data.assign(variables or {}).assign_attrs(given)
    netcdf.write(data.drop_vars(drop) if drop else data, path, FLIGHT)
    return path


@pytest.mark.parametrize(
    ("attributes", "message"),
    [
        ({"outcome": "landed"}, r"outcome: unknown outcome 'landed'.*Known: docked"),
        ({"outcome": 3}, "outcome: input should be a valid string"),
        ({"limits": [1.0, 2.0]}, "limits: list should have at least 4 items"),
        ({"limits": [1.0, 2.0, 3.0, float("inf")]}, r"limits\.3: input should be a finite number"),
        ({"layers": "rewind"}, "layers: input should be a valid list"),
        ({"trim": {"state": [1.0], "throttle": [], "deflection": []}}, r"trim\.state: list should have at least 12"),
        ({"scenario": []}, "scenario: input should be a valid dictionary"),
        ({"formulation": "other"}, "formulation: input should be 'consistent' or 'published'"),
        ({"steps": -1}, "steps: input should be greater than or equal to 0"),
    ],
)
def test_a_forged_header_is_one_line(flown, tmp_path, attributes, message):
    with pytest.raises(ConfigError, match=message) as caught:
        ts.Flight.load(forged(flown, tmp_path / "forged.nc", **attributes))
    assert "\n" not in str(caught.value)


def test_forged_outputs_are_one_line(flown, tmp_path):
    bent, time = flown.data["tension"].copy(), flown.data["time"]
    bent[3] = np.nan
    for variables, drop, message in (
        ({"tension": bent}, None, "tension has numbers that are not finite"),
        ({"tension": ("time", np.zeros(COUNT), {"units": "N"})}, None, "tension has dimensions time of float64"),
        ({"density": ("time", np.zeros(COUNT, int), {"units": "kg/m3"})}, None, "density has dimensions time of int64"),
        ({"clearance": ("time", np.zeros(COUNT), {"units": "ft"})}, None, "clearance is in 'ft', not in 'm'"),
        ({}, "wind", "wind is missing"),
        ({"time": ("time", -time.values, time.attrs)}, None, "its time runs backwards"),
    ):
        with pytest.raises(ConfigError, match=f"no whole flight: .*{message}"):
            ts.Flight.load(forged(flown, tmp_path / "forged.nc", variables, drop))


def test_what_is_declared_is_checked_before_it_is_read(tmp_path):
    with h5py.File(tmp_path / "huge.nc", "w") as file:
        file.create_dataset("time", shape=(40_000_000_000,), dtype="f8")
    with pytest.raises(ConfigError, match=r"declares 298 GiB of numbers; at most 4 GiB are read"):
        ts.Flight.load(tmp_path / "huge.nc")


def test_numbers_of_another_file_are_not_read(tmp_path, saved):
    (tmp_path / "theirs").write_bytes(bytes(800))
    with h5py.File(tmp_path / "link.nc", "w") as file:
        file["time"] = h5py.ExternalLink(str(saved), "time")
    with h5py.File(tmp_path / "raw.nc", "w") as file:
        file.create_dataset("time", (100,), "f8", external=[(str(tmp_path / "theirs"), 0, 800)])
    for name in ("link.nc", "raw.nc"):
        with pytest.raises(ConfigError, match="takes time from another file"):
            ts.Flight.load(tmp_path / name)


def test_files_of_version_0_1_load_with_a_warning(flown, tmp_path):
    flown.data.assign_attrs(format=1).to_netcdf(tmp_path / "old.nc", engine="h5netcdf")
    with pytest.warns(TethershipWarning, match=r"old\.nc: written by tethership 0\.1, without a checksum"):
        old = ts.Flight.load(tmp_path / "old.nc")
    assert same(old, flown)
    old.save(tmp_path / "new.nc")  # now it has one
    assert ts.Flight.load(tmp_path / "new.nc").run == flown.run


def test_the_header_is_that_of_the_schema(flight):
    """What `dock` writes is what is checked, and every attribute has a meaning."""
    assert set(FlightHeader.model_fields) == set(ATTRIBUTES) == set(flight.attributes)
    FlightHeader.model_validate(flight.attributes)
    assert stored_solver(flight.attributes["solver"], "x").model_dump(mode="json") == flight.attributes["solver"]


@pytest.fixture
def model():
    """A model of two states and one input."""
    one = np.array([[-1.0, 2.0], [0.0, -3.0]])
    words = ("u", "w"), ("throttle",), ("m/s", "m/s"), ("1",)
    return ts.LinearModel(one, one[:, :1], *words, one[0], one[1, :1], np.eye(2), {"formulation": "consistent"})


def test_a_changed_linear_model_is_told(model, tmp_path):
    path = tmp_path / "model.nc"
    model.save(path)
    np.testing.assert_array_equal(ts.LinearModel.load(path).A, model.A)
    with h5py.File(path, "r+") as file:
        file.attrs["history"] = "mine"
    assert ts.LinearModel.load(path).run == model.run
    with h5py.File(path, "r+") as file:
        file["A"][0, 0] = -1.001
    with pytest.raises(ConfigError, match=r"model\.nc is damaged or was changed \(not as written: A\)"):
        ts.LinearModel.load(path)
    bent = ts.LinearModel(**{**vars(model), "A": np.array([[np.nan, 1.0], [0.0, 1.0]])})
    bent.save(path)
    with pytest.raises(ConfigError, match="A is not finite numbers over state, of_state"):
        ts.LinearModel.load(path)


FIT = {
    "formulation": "published",
    "misfit": 1.0,
    "parameters": {"a": 1.0},
    "units": {"a": "m"},
    "bounds": {"a": [0.0, 2.0]},
    "members": [[1.0], [1.1]],
}


def test_a_changed_fit_is_told(tmp_path):
    path = tmp_path / "fit.json"
    path.write_text(fit_text(FIT), encoding="utf-8")
    assert read_fit(path) == FIT
    path.write_text(fit_text(FIT).replace("1.1", "1.2"), encoding="utf-8")
    with pytest.raises(ConfigError, match=r"fit\.json is damaged or was changed"):
        read_fit(path)
    path.write_text(json.dumps(FIT), encoding="utf-8")
    with pytest.warns(TethershipWarning, match="without a checksum"):
        assert read_fit(path) == FIT
    path.write_text(json.dumps(FIT | {"members": [[1.0, 2.0]]}), encoding="utf-8")
    with pytest.raises(ConfigError, match="not of the same parameters"):
        read_fit(path)
