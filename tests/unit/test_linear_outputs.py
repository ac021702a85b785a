"""What is measured of a linear model, and which of its inputs somebody commands.

Truth: central differences of plant and geometry worked anew here, a spring's own law, and python-control's design of a
regulator. If this fails, an observer is designed for another sensor, or a regulator commands the wind.
"""

import control
import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership.plant import State
from tethership.plant.state import STATE_NAMES
from tethership.results import netcdf
from tethership.results.schema import LINEAR_MODEL
from tethership.spatial import rotation_matrix

OUTPUTS = ("tension_nose", "airspeed", "angle_of_attack", "sideslip", "rate_of_climb", "clearance")


@pytest.fixture(scope="module")
def model(docking, point):
    return ts.linearize(docking, point)


@pytest.fixture(scope="module")
def moving(docking, point):
    """A state with every motion, so that no slope is zero by symmetry, and its model."""
    change = np.array([1.0, 0.7, -0.4, 0.05, 0.04, -0.03, 0.1, 0.15, 0.2, 1.0, -2.0, 0.5])
    state = State.from_vector(point.state.as_vector() + change)
    return state, ts.linearize(docking, (state, point.command), require_equilibrium=False)


def measured(plant, vector, wind=(0.0, 0.0, 0.0), length=20.0):
    """Return the outputs for a state vector, a change of the wind [m/s] and a length [m]; worked anew."""
    state = State.from_vector(jnp.asarray(vector))
    rotation = np.asarray(rotation_matrix(state.attitude))
    at_b = np.asarray(state.velocity) + np.cross(state.rates, plant.ship.buoyancy.centre)
    centre = jnp.asarray(state.position + rotation @ plant.ship.buoyancy.centre)
    air = plant.environment.wind_at(centre, jnp.zeros(())) + np.array(wind)
    u, v, w = at_b - rotation.T @ air
    cable = plant.cables[0]
    span = np.asarray(state.position + rotation @ cable.tether_point - cable.anchor)
    end = rotation @ (np.asarray(state.velocity) + np.cross(state.rates, cable.tether_point))
    felt = plant.environment.wind_at(cable.anchor + 0.5 * span, jnp.zeros(())) + np.array(wind)
    force = cable.between(jnp.asarray(span), jnp.asarray(end), jnp.asarray(length), felt, plant.environment).ship
    outline = plant.ship.outline
    along_nose = np.asarray(outline.station)
    reach = np.asarray(outline.radius) * np.hypot(
        rotation[2, 1], rotation[2, 2]
    )  # a ring's lowest point below its centre
    lowest = float(state.position[2]) + (rotation[2] @ plant.ship.nose - along_nose * rotation[2, 0] + reach).max()
    return np.array(
        [
            np.linalg.norm(force),
            np.sqrt(u**2 + v**2 + w**2),
            np.arctan2(w, u),
            np.arcsin(v / np.sqrt(u**2 + v**2 + w**2)),
            -(rotation @ at_b)[2],
            float(plant.environment.ground) - lowest,
        ]
    )


def test_values_and_slopes(docking, moving):
    state, model = moving
    vector, plant, step = np.asarray(state.as_vector()), docking.system, 1e-5
    assert model.outputs == OUTPUTS
    assert model.output_units == ("N", "m/s", "rad", "rad", "m/s", "m")
    np.testing.assert_allclose(model.output_values, measured(plant, vector), rtol=1e-12, atol=1e-12)

    def slope(change):
        return (measured(plant, **change(step)) - measured(plant, **change(-step))) / (2.0 * step)

    for column, unit in enumerate(np.eye(12)):
        found = slope(lambda h, unit=unit: {"vector": vector + h * unit})
        # rounding of 20 N over a step of 1e-5, and truncation
        np.testing.assert_allclose(model.C[:, column], found, rtol=1e-7, atol=1e-8, err_msg=STATE_NAMES[column])
    for axis, unit in zip(("north", "east", "down"), np.eye(3), strict=True):
        found = slope(lambda h, unit=unit: {"vector": vector, "wind": h * unit})
        column = model.inputs.index(f"wind_{axis}")
        np.testing.assert_allclose(model.D[:, column], found, rtol=1e-7, atol=1e-8)
    found = slope(lambda h: {"vector": vector, "length": 20.0 + h})
    np.testing.assert_allclose(model.D[:, model.inputs.index("length_nose")], found, rtol=1e-7, atol=1e-8)
    assert not model.D[:, : len(model.controls)].any()  # no throttle is felt before the ship moves


def test_taut_line_is_a_spring():
    # A massless line without drag: T = EA (d/L − 1), so ∂T/∂x = EA/L n, ∂T/∂L = −EA d/L², and no damping.
    thin = {"cables.nose.linear_density": 1e-9, "cables.nose.diameter": 0.0}
    scenario = ts.load_scenario("aerostat", thin)
    point = ts.trim(scenario, throw=True)
    model = ts.linearize(scenario, point)
    cable = scenario.system.cables[0]
    rotation = np.asarray(rotation_matrix(point.state.attitude))
    span = np.asarray(point.state.position + rotation @ cable.tether_point - cable.anchor)
    reach, stiffness, length = np.linalg.norm(span), 69_760.0, 50.0
    assert model.outputs[0] == "tension_nose"
    assert model.output_values[0] == pytest.approx(stiffness * (reach / length - 1.0), rel=1e-6)
    unit = span / reach
    # its weight, 5e-7 N of some 150 N
    np.testing.assert_allclose(model.C[0, 9:], stiffness / length * unit, rtol=1e-6, atol=1e-3)
    np.testing.assert_allclose(model.C[0, :6], np.zeros(6), atol=1e-6)
    arm = np.cross(cable.tether_point, rotation.T @ unit)  # about P, body axes: at φ = 0 q turns with θ
    assert model.C[0, 7] == pytest.approx(stiffness / length * arm[1], rel=1e-5)
    assert model.D[0, -1] == pytest.approx(-stiffness * reach / length**2, rel=1e-6)


def test_in_still_air_there_is_no_direction_of_it():
    still = ts.load_scenario("hover", {"wind.speed": 0.0})
    model = ts.linearize(still, ts.trim(still))
    assert model.outputs == ("rate_of_climb", "clearance")
    for matrix in (model.C, model.D, model.output_values):
        assert np.isfinite(matrix).all()


def test_controls_and_disturbances(model, docking, point):
    assert model.controls == model.inputs[:10]
    assert model.disturbances == model.inputs[10:]
    longer = ts.linearize(docking, point, length_states=True)
    assert longer.controls == (*model.controls, "rewind_rate_nose")
    assert longer.disturbances == model.disturbances[:-1]
    row = longer.outputs.index("tension_nose")
    assert longer.C[row, 12] == model.D[row, -1] != 0.0  # a cable's length is a state now
    assert not longer.D[:, -1].any()


def test_a_regulator_commands_no_wind(model):
    # the ship at rest on its cable, all of it: Q and R of one, as a first try has them
    part = model.longitudinal()
    plant = part.to_control(inputs=[name for name in part.controls if part.U[:, part.inputs.index(name)].any()])
    gain, _, poles = control.lqr(plant, np.eye(plant.nstates), np.eye(plant.ninputs))
    assert gain.shape == (plant.ninputs, 6)
    assert (poles.real < 0.0).all()
    assert tuple(part.to_control().input_labels) == part.controls
    whole = model.to_control()
    assert control.lqr(whole, np.eye(12), np.eye(10))[0].shape == (10, 12)


def test_outputs_of_choice(model):
    plant = model.to_control(model.disturbances, ["tension_nose", "theta", "airspeed"])
    assert tuple(plant.input_labels) == model.disturbances
    assert plant.output_labels == ["tension_nose", "theta", "airspeed"]
    rows = [model.outputs.index("tension_nose"), model.outputs.index("airspeed")]
    np.testing.assert_array_equal(plant.C[[0, 2]], model.C[rows])
    np.testing.assert_array_equal(plant.C[1], np.eye(12)[7])
    np.testing.assert_array_equal(plant.D[[0, 2]], model.D[rows][:, 10:])
    with pytest.raises(
        ts.ConfigError, match=r"the model has no output 'airsped'; did you mean 'airspeed'\? It has: u, v"
    ):
        model.to_control(outputs=["airsped"])
    with pytest.raises(ts.ConfigError, match=r"the model has no input 'wind'"):
        model.to_control(inputs=["wind"])
    with pytest.raises(ts.ConfigError, match=r"to_control: there is no input to choose; name some of wind_north, "):
        model.select(inputs=model.disturbances).to_control()


def test_a_file_keeps_them(model, tmp_path):
    model.save(tmp_path / "model.nc")
    again = ts.LinearModel.load(tmp_path / "model.nc")
    for name in ("controls", "outputs", "output_units"):
        assert getattr(again, name) == getattr(model, name)
    for name in ("C", "D", "output_values"):
        np.testing.assert_array_equal(getattr(again, name), getattr(model, name))


def test_a_file_of_version_0_1_is_read(model, tmp_path):
    new = ["C", "D", "output_value", "output", "output_unit", "input_is_control"]
    netcdf.write(model.to_dataset().drop_vars(new), tmp_path / "old.nc", LINEAR_MODEL)
    old = ts.LinearModel.load(tmp_path / "old.nc")
    assert old.controls == model.controls
    assert old.outputs == ()
    assert old.to_control().C.shape == (12, 12)
    netcdf.write(model.to_dataset().drop_vars("D"), tmp_path / "half.nc", LINEAR_MODEL)
    with pytest.raises(ts.ConfigError, match=r"half\.nc is no whole linear model: D is missing"):
        ts.LinearModel.load(tmp_path / "half.nc")
