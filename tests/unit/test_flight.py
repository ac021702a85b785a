"""Outcomes of a flight are data, and nothing flown is lost.

If these failed, a flight that breaks its cable, diverges or is cut off would end in an exception or in silence, or a
file would not fly again to the same numbers.
"""

import signal

import h5py
import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership.results import VARIABLES
from tethership.scenario import read_solver


def test_docked(flight):
    assert flight.outcome is ts.Outcome.docked
    # The event is located by bisection to 1e-10 of the length.
    assert float(flight.data["cable_length"][-1, 0]) == pytest.approx(1.5, abs=1e-8)
    assert flight.docking_time == float(flight.data["time"][-1])
    # D11: never faster than 18.5 m at 0.3 m/s.
    assert flight.docking_time >= 18.5 / 0.3 - 1e-9


def test_every_output_is_labelled(flight):
    assert set(flight.data.data_vars) == set(VARIABLES)
    for name, variable in flight.data.data_vars.items():
        assert variable.attrs["units"] == VARIABLES[name].unit
        assert np.isfinite(variable).all(), name
    assert np.all(np.diff(flight.data["time"]) > 0)


def test_the_winch_takes_in_what_is_missing(flight):
    """∫Ψ dt is the cable that is gone; trapezoids over 0.0125 s leave 1e-3 m where Ψ has corners."""
    taken = np.trapezoid(flight.data["rewind_rate"][:, 0], flight.data["time"])
    assert taken == pytest.approx(20.0 - 1.5, abs=2e-3)


def test_stored_loads_are_what_they_are_called(flight):
    """The stored loads are what they are called: the weight is the weight, the cable's load its tension."""
    loads = flight.data["load_force"].sel(load="gravity")
    weight = np.linalg.norm(loads, axis=1)
    np.testing.assert_allclose(weight, 136.8 * 9.80665, rtol=1e-12)
    cable = flight.data["load_force"].sel(load="cable_1")
    tension = flight.data["tension"][:, 0]
    np.testing.assert_allclose(np.linalg.norm(cable, axis=1), tension, rtol=1e-9)


def test_cable_curve_ends_at_ship_and_anchor(flight):
    curve = flight.data["cable_curve"][:, 0]
    np.testing.assert_allclose(curve[:, 0], 0.0, atol=1e-12)
    np.testing.assert_allclose(curve[:, -1], flight.data["tether_offset"][:, 0], atol=20e-9)


def test_cable_broken(docking, point):
    weak = docking.changed({"cables.nose.breaking_force": 100.0})
    flight = ts.dock(weak, point)
    assert flight.outcome is ts.Outcome.cable_broken
    # Bisection stops at 1e-10 s; the tension rises by 1e4 N/s at a snap.
    assert float(flight.data["tension_largest"][-1, 0]) == pytest.approx(100.0, abs=1e-3)
    assert flight.docking_time is None


def test_time_limit(docking, point):
    flight = ts.dock(docking.changed({"stop.time_limit": 3.3}), point)
    assert flight.outcome is ts.Outcome.time_limit
    assert float(flight.data["time"][-1]) == pytest.approx(3.3, abs=1e-9)


def test_ground_contact(docking):
    mast = docking.changed({"ground.anchor_height": 0.1})
    flight = ts.dock(mast, ts.trim(mast))
    assert flight.outcome is ts.Outcome.ground_contact
    assert float(flight.data["clearance"][-1]) == pytest.approx(0.0, abs=1e-6)


def test_without_a_mast_the_ground_is_only_recorded(flight):
    """The paper's anchor is at ground level, where a level hull of 2 m radius must dip below it."""
    assert flight.outcome is ts.Outcome.docked
    assert flight.metrics["clearance_min"] < 0.0


def test_pitch_limit(docking, point):
    flight = ts.dock(docking.changed({"stop.largest_pitch": np.deg2rad(11.0)}), point, layers=(), sas=False)
    assert flight.outcome is ts.Outcome.attitude_singular
    assert abs(float(flight.data["attitude"][-1, 1])) == pytest.approx(np.deg2rad(11.0), abs=1e-9)


class Poison(ts.AbstractLaw):
    """A law that returns no number after two seconds."""

    def __call__(self, time, measurement, memory):
        return ts.Correction(throttle=jnp.where(time > 2.0, jnp.nan, 0.0)), memory


def test_diverged_keeps_what_was_flown(docking, point):
    flight = ts.dock(docking, point, own_laws={"poison": Poison()})
    assert flight.outcome is ts.Outcome.diverged
    # The last step that starts before 2 s is kept; the largest step is 0.25 s.
    assert 1.7 < float(flight.data["time"][-1]) <= 2.26
    assert all(np.isfinite(variable).all() for variable in flight.data.data_vars.values())
    with pytest.raises(ts.SolveError, match="A number stopped being finite"):
        ts.dock(docking, point, own_laws={"poison": Poison()}, throw=True)


def test_step_limit(docking, point):
    few = read_solver().model_copy(update={"most_steps": 5})
    flight = ts.dock(docking, point, solver=few)
    assert flight.outcome is ts.Outcome.step_limit
    assert flight.data.sizes["time"] > 1


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_keeps_what_was_flown(docking, point, number):
    """A signal in the middle of a flight: the segment that runs is finished and kept."""
    flown = []

    def progress(reached):
        flown.append(reached)
        if len(flown) == 2:
            signal.raise_signal(number)

    before = signal.getsignal(number)
    flight = ts.dock(docking, point, progress=progress)
    assert flight.outcome is ts.Outcome.interrupted
    assert 19.0 < float(flight.data["time"][-1]) < 60.0
    assert not flight.outcome.is_answer
    assert signal.getsignal(number) is before


def test_file_and_back(flight, tmp_path):
    path = tmp_path / "a" / "flight.nc"
    flight.save(path)
    back = ts.Flight.load(path)
    assert back.outcome is flight.outcome
    assert back.metrics == flight.metrics
    assert back.data.equals(flight.data)


def test_flies_again_to_the_same_numbers(docking, tmp_path):
    """Also where values were changed, in units that are no SI unit."""
    changed = docking.changed({"stop.time_limit": 8.0, "wind.speed": 7.3, "cables.nose.diameter": 0.0123})
    flight = ts.dock(changed, ts.trim(changed), layers=["rewind"], solver="fixed")
    flight.save(tmp_path / "flight.nc")
    scenario, again = ts.fly_again(tmp_path / "flight.nc")
    assert scenario.config.wind.speed == 7.3
    assert again.data.equals(flight.data)
    assert again.metrics == flight.metrics
    assert again.attributes["layers"] == ["rewind"]


def test_same_input_same_answer(docking, point, flight):
    assert ts.dock(docking, point).data.equals(flight.data)


def test_files_that_are_no_flights(flight, tmp_path):
    missing = tmp_path / "missing.nc"
    with pytest.raises(ts.ConfigError, match="no such file"):
        ts.Flight.load(missing)
    path = tmp_path / "flight.nc"
    flight.save(path)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(ts.ConfigError, match="not a readable netCDF file"):
        ts.Flight.load(path)
    path.write_bytes(whole)
    with h5py.File(path, "r+") as opened:
        opened.attrs["format"] = 99
    with pytest.raises(ts.ConfigError, match=r"has layout 99 of tethership .*fly it again with the version that wrote"):
        ts.Flight.load(path)
    with h5py.File(path, "r+") as opened:
        opened.attrs["kind"] = "weather"
    with pytest.raises(ts.ConfigError, match="no flight of tethership"):
        ts.Flight.load(path)


def test_a_folder_that_cannot_be_written(flight, tmp_path):
    (tmp_path / "file").write_text("here is a file, not a folder")
    with pytest.raises(ts.ConfigError, match=r"cannot write .*; choose another folder with --out"):
        flight.save(tmp_path / "file" / "flight.nc")


def test_own_law_with_memory_is_stored_but_not_flown_again(docking, point, tmp_path):
    class Integrator(ts.AbstractLaw):
        def initial_memory(self, measurement):
            return jnp.zeros(())

        def __call__(self, time, measurement, memory):
            return ts.Correction(rewind_rate=0.01 * memory * jnp.ones(1)), jnp.asarray(1.0)

    flight = ts.dock(docking.changed({"stop.time_limit": 4.0}), point, layers=(), own_laws={"ramp": Integrator()})
    # Ψ = 0.3 + 0.01 t, so L = 20 − 0.3 t − 0.005 t².
    np.testing.assert_allclose(flight.data["rewind_rate"][:, 0], 0.3 + 0.01 * flight.data["time"], atol=1e-9)
    assert float(flight.data["cable_length"][-1, 0]) == pytest.approx(20 - 1.2 - 0.08, abs=1e-7)
    flight.save(tmp_path / "own.nc")
    with pytest.raises(ts.ConfigError, match="law of one's own"):
        ts.fly_again(tmp_path / "own.nc")


def test_several_cables(docking):
    """Two cables side by side pull alike on a symmetric ship and dock together."""
    document = {**docking.document}
    nose = document["cables"][0]
    place = {"value": [3.77, -1.5977, 0.0], "unit": "m"}
    other = {"value": [3.77, 1.5977, 0.0], "unit": "m"}
    document["cables"] = [
        {**nose, "name": "port", "tether_point": place, "anchor": {"value": [0.0, -1.5977, 0.0], "unit": "m"}},
        {**nose, "name": "starboard", "tether_point": other, "anchor": {"value": [0.0, 1.5977, 0.0], "unit": "m"}},
    ]
    from tethership.scenario.load import from_document

    two = from_document(document, "two", {"start.attitude_offset": [0.0, 0.1, 0.0], "gusts.0.fraction": 0.0})
    flight = ts.dock(two, ts.trim(two), layers=["rewind"])
    assert flight.data.sizes["cable"] == 2
    assert flight.outcome is ts.Outcome.docked
    tension = flight.data["tension"].to_numpy()
    # Mirror images: rounding grows with the unstable lateral motion, but stays far below a newton.
    np.testing.assert_allclose(tension[:, 0], tension[:, 1], rtol=1e-3, atol=1e-3)


def test_a_ship_without_a_cable_flies():
    hover = ts.load_scenario("hover", {"stop.time_limit": 2.0})
    flight = ts.dock(hover, ts.trim(hover), layers=(), sas=False)
    assert flight.outcome is ts.Outcome.time_limit
    # Trimmed: it stays.
    assert float(abs(flight.data["position"][-1] - flight.data["position"][0]).max()) < 1e-9
