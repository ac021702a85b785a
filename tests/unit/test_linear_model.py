"""The linear model as an object: labels, parts, files, python-control.

Truth: the matrices it was made of, python-control's own poles, and the plant's right-hand side for the length states.
If this fails, a matrix goes into a controller's design with its rows under other names, or a file gives back another
ship than was written.
"""

import control
import numpy as np
import pytest
import xarray as xr

import tethership as ts
from tethership.plant import State
from tethership.plant.state import STATE_NAMES, STATE_UNITS
from tethership.results import netcdf
from tethership.results.schema import FLIGHT, LINEAR_MODEL

LONGITUDINAL = ("u", "w", "q", "theta", "north", "down")
LATERAL = ("v", "p", "r", "phi", "psi", "east")
ARRAYS = ("A", "U", "state_values", "input_values", "comparable")


@pytest.fixture(scope="module")
def model(docking, point):
    return ts.linearize(docking, point)


@pytest.fixture(scope="module")
def longer(docking, point):
    return ts.linearize(docking, point, length_states=True)


def asymmetric(point):
    """Return the trimmed state rolled by 0.2 rad and moving to starboard with 1 m/s."""
    return State.from_vector(point.state.as_vector().at[1].set(1.0).at[6].set(0.2))


def nearest(one, other):
    """Return how far the eigenvalues of two lists are apart, each to its nearest."""
    apart = np.abs(np.asarray(one)[:, None] - np.asarray(other)[None, :])
    return max(apart.min(axis=0).max(), apart.min(axis=1).max())


def test_labels_and_units(model, docking, point):
    assert (model.states, model.state_units) == (STATE_NAMES, STATE_UNITS)
    vehicle = docking.config.vehicle
    assert model.inputs[:6] == tuple(thruster.name for thruster in vehicle.thrusters)
    assert model.inputs[6:10] == tuple(fin.name for fin in vehicle.fins)
    assert model.inputs[10:13] == ("wind_north", "wind_east", "wind_down")
    assert model.inputs[13:] == ("wind_rate_north", "wind_rate_east", "wind_rate_down", "length_nose")
    assert model.input_units == ("1",) * 6 + ("rad",) * 4 + ("m/s",) * 3 + ("m/s^2",) * 3 + ("m",)
    assert model.A.shape == (12, 12)
    assert model.U.shape == (12, 17)
    np.testing.assert_array_equal(model.state_values, point.state.as_vector())
    np.testing.assert_array_equal(model.input_values[:6], point.command.throttle)
    assert model.input_values[-1] == 20.0
    assert model.attributes["formulation"] == "consistent"
    assert model.attributes["outcome"] == "converged"
    assert model.attributes["scenario"] == docking.document


def test_a_bare_plant_has_numbers_for_names(model, docking, point):
    bare = ts.linearize(docking.system, point)
    assert bare.inputs[:2] == ("thruster_1", "thruster_2")
    assert bare.inputs[6] == "fin_1"
    assert bare.inputs[-1] == "length_cable_1"
    np.testing.assert_array_equal(bare.A, model.A)


def test_file_gives_the_same_model(model, tmp_path):
    model.save(tmp_path / "deep" / "model.nc")
    again = ts.LinearModel.load(tmp_path / "deep" / "model.nc")
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(again, name), getattr(model, name))  # not a bit less
    for name in ("states", "inputs", "state_units", "input_units", "attributes"):
        assert getattr(again, name) == getattr(model, name)


def test_file_of_a_part(model, tmp_path):
    part = model.select(["theta", "u"], [])
    part.save(tmp_path / "part.nc")
    again = ts.LinearModel.load(tmp_path / "part.nc")
    assert (again.states, again.inputs) == (("theta", "u"), ())
    np.testing.assert_array_equal(again.A, part.A)


def test_other_files_are_refused(model, tmp_path):
    flight = xr.Dataset(attrs={"kind": FLIGHT.name, "format": 1, "tethership_version": "0"})
    netcdf.write(flight, tmp_path / "flight.nc", FLIGHT)
    with pytest.raises(ts.ConfigError, match=r"flight\.nc is a netCDF file but no linear model of tethership"):
        ts.LinearModel.load(tmp_path / "flight.nc")
    model.save(tmp_path / "model.nc")
    with pytest.raises(ts.ConfigError, match=r"model\.nc is a netCDF file but no flight of tethership"):
        ts.Flight.load(tmp_path / "model.nc")
    (tmp_path / "noise.nc").write_bytes(bytes(range(256)))
    with pytest.raises(ts.ConfigError, match=r"noise\.nc is not a readable netCDF file"):
        ts.LinearModel.load(tmp_path / "noise.nc")
    with pytest.raises(ts.ConfigError, match=r"cannot read .*nothing\.nc: no such file"):
        ts.LinearModel.load(tmp_path / "nothing.nc")
    newer = model.to_dataset()
    newer.attrs["format"] = 99
    netcdf.write(newer, tmp_path / "newer.nc", LINEAR_MODEL)
    with pytest.raises(ts.ConfigError, match=r"has layout 99 .* make it again"):
        ts.LinearModel.load(tmp_path / "newer.nc")


def test_file_that_cannot_be_written(model, tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(ts.ConfigError, match=r"cannot write .*; choose another folder"):
        model.save(tmp_path / "file" / "model.nc")


def test_select_keeps_rows_with_their_names(model):
    part = model.select(["theta", "q", "u"], ["length_nose", "tail_down"])
    assert (part.states, part.state_units) == (("theta", "q", "u"), ("rad", "rad/s", "m/s"))
    assert (part.inputs, part.input_units) == (("length_nose", "tail_down"), ("m", "1"))
    for i, row in enumerate(part.states):
        for j, column in enumerate(part.states):
            assert part.A[i, j] == model.A[STATE_NAMES.index(row), STATE_NAMES.index(column)]
        for j, column in enumerate(part.inputs):
            assert part.U[i, j] == model.U[STATE_NAMES.index(row), model.inputs.index(column)]
    assert part.A[0, 1] == pytest.approx(1.0, rel=1e-12)  # dθ/dt = q of a level ship, to rounding
    np.testing.assert_array_equal(part.state_values, model.state_values[[7, 4, 0]])
    np.testing.assert_array_equal(part.input_values, model.input_values[[16, 1]])


def test_parts(model):
    assert model.without_position().states == STATE_NAMES[:9]
    assert set(model.longitudinal().states) == set(LONGITUDINAL)
    assert set(model.lateral().states) == set(LATERAL)
    assert model.without_position().longitudinal().states == ("u", "w", "q", "theta")
    assert model.longitudinal().inputs == model.inputs
    halves = [np.linalg.eigvals(part.A) for part in (model.longitudinal(), model.lateral())]
    # the halves are decoupled to rounding, and no eigenvalue is repeated
    assert nearest(np.concatenate(halves), np.linalg.eigvals(model.A)) < 1e-9
    assert model.coupling(LONGITUDINAL) < 1e-12  # symmetry makes these entries zero
    assert model.coupling(("u", "v", "w")) > 1e-3


def test_unknown_names_offer_the_nearest(model):
    with pytest.raises(ts.ConfigError, match=r"the model has no state 'teta'; did you mean 'theta'\? It has: u, v, w"):
        model.select(["teta"])
    with pytest.raises(ts.ConfigError, match=r"the model has no input 'lenght_nose'; did you mean 'length_nose'\?"):
        model.select(inputs=["lenght_nose"])
    with pytest.raises(ts.ConfigError, match=r"the model has no state 'down'. It has: u, v"):
        model.select(["u", "v"]).select(["down"])


@pytest.mark.parametrize("part", ["longitudinal", "lateral"])
def test_an_asymmetric_point_has_no_halves(docking, point, part):
    rolled = ts.linearize(docking, (asymmetric(point), point.command), require_equilibrium=False)
    with pytest.raises(ts.ConfigError, match=r"the point is not symmetric: .* are coupled .*; use the whole model"):
        getattr(rolled, part)()
    assert rolled.without_position().states == STATE_NAMES[:9]  # this part asks for no symmetry


def test_a_point_that_is_no_equilibrium_is_refused(docking, point):
    with pytest.raises(ts.ConfigError, match=r"not in equilibrium: [\d.]+ N and [\d.]+ N m are left over \(at most"):
        ts.linearize(docking, (asymmetric(point), point.command))


def test_a_state_that_is_not_finite_is_told(docking, point):
    lost = State.from_vector(point.state.as_vector() * np.nan)
    with pytest.raises(ts.ConfigError, match="not finite; check its state"):
        ts.linearize(docking, (lost, point.command))


def test_unknown_route(docking, point):
    with pytest.raises(ts.ConfigError, match=r"unknown route 'exxact'; did you mean 'exact'\? Allowed: exact, semi"):
        ts.linearize(docking, point, route="exxact")


def test_python_control(model):
    system = model.to_control(model.inputs)
    assert isinstance(system, control.StateSpace)
    np.testing.assert_array_equal(system.A, model.A)
    np.testing.assert_array_equal(system.B, model.U)
    np.testing.assert_array_equal(system.C, np.eye(12))
    np.testing.assert_array_equal(system.D, np.zeros((12, 17)))
    assert tuple(system.state_labels) == tuple(system.output_labels) == model.states
    assert tuple(system.input_labels) == model.inputs
    # the same LAPACK routine in other scalings
    assert nearest(system.poles(), model.modes().eigenvalues) < 1e-9


def test_python_control_of_a_part(model):
    part = model.longitudinal().select(inputs=["tail_down", "length_nose"])
    system = part.to_control(part.inputs)
    assert tuple(system.state_labels) == part.states
    # D = 0 and all states are outputs: the response at one frequency is (iω − A)⁻¹U
    frequency = 0.3
    expected = np.linalg.solve(1j * frequency * np.eye(6) - part.A, part.U)
    np.testing.assert_allclose(system(1j * frequency), expected, rtol=1e-9)  # two linear solves


def test_lengths_as_states(model, longer):
    assert longer.states == (*STATE_NAMES, "length_nose")
    assert longer.inputs == (*model.inputs[:-1], "rewind_rate_nose")
    assert (longer.state_units[-1], longer.input_units[-1]) == ("m", "m/s")
    assert (longer.state_values[-1], longer.input_values[-1]) == (20.0, 0.0)
    np.testing.assert_array_equal(longer.A[12], np.zeros(13))  # dL/dt = −Ψ and nothing else
    np.testing.assert_array_equal(longer.A[:12, :12], model.A)
    np.testing.assert_array_equal(longer.A[:12, 12], model.U[:, -1])
    np.testing.assert_array_equal(longer.U[:12, :-1], model.U[:, :-1])
    np.testing.assert_array_equal(longer.U[:12, -1], np.zeros(12))
    np.testing.assert_array_equal(longer.U[12], [*np.zeros(16), -1.0])


def test_a_longer_cable_is_felt(model, longer):
    # guards the test above against a column of zeros; a longer cable is slacker and heavier: the ship is pulled less
    assert np.abs(longer.A[:6, 12]).max() > 1e-4
    added = [mode for mode in longer.modes().modes if mode.name not in model.modes().names]
    assert [(mode.name, mode.null) for mode in added] == [("length nose", True)]


def test_a_symmetric_point_with_length_states_has_halves(longer):
    assert set(longer.longitudinal().states) >= set(LONGITUDINAL)


def test_without_cables_there_are_no_length_states():
    hover = ts.load_scenario("hover")
    assert ts.linearize(hover, ts.trim(hover), length_states=True).states == STATE_NAMES
