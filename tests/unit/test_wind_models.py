"""Profiles, turning gusts, measured histories and turbulence in a scenario, up to a flight."""

import jax.numpy as jnp
import numpy as np
import pytest

import tethership as ts
from tethership.errors import ConfigError
from tethership.physics.gust import CosineGust
from tethership.physics.wind import LogarithmicWind
from tethership.plant.loop import ClosedLoop
from tethership.plant.ship import wrenches
from tethership.scenario.wind_file import record_warning

LOGARITHMIC = {
    "wind": {
        "model": "logarithmic",
        "speed": {"value": 6.0, "unit": "m/s"},
        "reference_height": {"value": 10.0, "unit": "m"},
        "roughness": {"value": 0.03, "unit": "m"},
    }
}


def test_logarithmic_profile_is_the_reference_at_its_height_and_nothing_at_the_roughness():
    wind = LogarithmicWind(jnp.array([-6.0, 0.0, 0.0]), *map(jnp.asarray, (10.0, 0.03, 0.0)))
    at = lambda height: float(wind.velocity(jnp.array([0.0, 0.0, -height]))[0])  # noqa: E731
    assert at(10.0) == pytest.approx(-6.0)
    assert at(0.03) == 0.0
    assert at(-1.0) == 0.0
    assert at(0.3) == pytest.approx(-6.0 * np.log(10.0) / np.log(10.0 / 0.03))


def test_turning_gust_keeps_its_size_and_turns_clockwise_seen_from_above():
    gust = CosineGust(jnp.array([-2.0, 0.0, 0.5]), *map(jnp.asarray, (1.0, 4.0, np.pi / 2)))
    straight = CosineGust(jnp.array([-2.0, 0.0, 0.5]), *map(jnp.asarray, (1.0, 4.0)))
    for time in (1.5, 3.0, 4.5):
        turned, plain = gust.velocity(jnp.asarray(time)), straight.velocity(jnp.asarray(time))
        assert np.linalg.norm(turned) == pytest.approx(float(np.linalg.norm(plain)))
        assert float(turned[2]) == float(plain[2])
    # from the north at first, it comes from the north-east half way, and from the east at the end
    middle = gust.velocity(jnp.asarray(3.0))
    assert float(middle[0]) == pytest.approx(float(middle[1]))
    assert float(middle[0]) < 0
    assert np.array_equal(CosineGust(gust.amplitude, gust.start, gust.period).velocity(2.0), straight.velocity(2.0))


def test_a_trim_takes_the_mean_wind_and_the_flight_the_turbulence():
    calm = ts.load_scenario("docking")
    rough = ts.load_scenario("docking", {"turbulence.spectrum": "von_karman", "turbulence.seed": 3.0})
    point, other = ts.trim(calm), ts.trim(rough)
    assert np.array_equal(point.command.throttle, other.command.throttle)
    assert np.array_equal(ts.linearize(calm, point).A, ts.linearize(rough, other).A)
    first, second = ts.dock(calm, point), ts.dock(rough, other)
    assert second.outcome.is_answer
    assert second.metrics["theta_rms"] != first.metrics["theta_rms"]
    again = ts.dock(rough, other)
    assert np.array_equal(second.data["tension"], again.data["tension"])


def test_gradients_change_hull_fins_and_thrust_only():
    changes = {"turbulence.spectrum": "dryden", "turbulence.intensity": 2.0}
    plain = ts.load_scenario("docking", changes)
    felt = ts.load_scenario("docking", {**changes, "turbulence.gradients": True})
    point = ts.trim(plain)
    loads = [
        wrenches(jnp.asarray(7.0), point.state, point.command, scenario.system.ship, scenario.system.environment)
        for scenario in (plain, felt)
    ]
    for name in ("gravity", "buoyancy", "apparent_mass"):
        assert np.array_equal(loads[0][name].moment, loads[1][name].moment)
    for name in ("envelope", "fins"):
        assert not np.allclose(loads[0][name].moment, loads[1][name].moment)


def test_air_that_turns_is_a_ship_that_turns_the_other_way():
    scenario = ts.load_scenario("docking", {"turbulence.spectrum": "dryden", "turbulence.gradients": True})
    ship, environment = scenario.system.ship, scenario.system.environment
    state = ts.trim(scenario).state
    time = jnp.asarray(4.0)
    axis = jnp.array([1.0, 0.0, 0.0])
    turning = environment.rotation_at(time, axis)
    air = environment.air(state.position + ship.buoyancy.centre, state.velocity, axis, time)
    load = wrenches(time, state, ts.trim(scenario).command, ship, environment)["envelope"]
    expected = ship.envelope.wrench(air.density, state.velocity - air.wind, -turning)
    assert np.allclose(load.moment, expected.moment)
    assert np.allclose(load.force, expected.force)


@pytest.fixture
def measured(tmp_path):
    """A function that writes a scenario with a measured wind of some content."""

    def make(content, name="mast.csv"):
        (tmp_path / name).write_text(content, encoding="utf-8")
        text = ts.scenario.load.packaged_text("scenarios", "docking")
        start, end = text.index("[wind]"), text.index("[[gusts]]")
        own = text[:start] + f'[wind]\nmodel = "measured"\nfile = "{name}"\n\n' + text[end:]
        (tmp_path / "own.toml").write_text(own, encoding="utf-8")
        return str(tmp_path / "own.toml")

    return make


def test_a_steady_measured_wind_flies_as_the_uniform_one(measured):
    rows = "\n".join(f"{time},9.0,0.0" for time in range(0, 100, 5))
    scenario = ts.load_scenario(measured(f"time,speed,direction\n{rows}\n"))
    uniform = ts.load_scenario("docking", {"wind.speed": 9.0})
    first, second = (ts.dock(s, ts.trim(s), layers=("rewind",)) for s in (scenario, uniform))
    assert first.metrics["tension_max"] == pytest.approx(second.metrics["tension_max"], rel=1e-4)


def test_a_measured_wind_is_met_at_its_samples(measured):
    times = np.arange(0.0, 60.0, 2.0)
    north, east = -6.0 + np.sin(times), 0.5 * np.cos(times)
    rows = "\n".join(f"{t},{n},{e}" for t, n, e in zip(times + 100.0, north, east, strict=True))
    scenario = ts.load_scenario(measured(f"# mast A\ntime,north,east\n{rows}\n"), {"gusts": []})
    wind = [scenario.system.environment.wind_at(jnp.zeros(3), jnp.asarray(t)) for t in times]
    assert np.allclose(np.array(wind)[:, :2], np.stack([north, east], axis=1), atol=1e-12)
    late = scenario.system.environment.wind_at(jnp.zeros(3), jnp.asarray(500.0))
    assert np.allclose(late, wind[-1])
    over_time = [np.trapezoid(component, times) / times[-1] for component in (north, east)]
    assert scenario.config.wind.speed == pytest.approx(np.hypot(*over_time))


def test_a_measured_wind_from_netcdf(measured, tmp_path):
    import xarray as xr

    path = measured("", "mast.nc")
    times = np.arange(0.0, 20.0)
    data = xr.Dataset({"speed": ("time", np.full(20, 7.0)), "direction": ("time", np.full(20, 30.0))}, {"time": times})
    data.to_netcdf(tmp_path / "mast.nc", engine="h5netcdf")
    scenario = ts.load_scenario(path)
    assert scenario.config.wind.speed == pytest.approx(7.0)
    assert np.degrees(scenario.config.wind.from_direction) == pytest.approx(30.0)


def test_a_flight_in_a_measured_wind_can_be_flown_again_without_the_file(measured, tmp_path):
    path = measured("time,north,east\n" + "\n".join(f"{t},{-6 - np.sin(t)},0" for t in range(80)))
    scenario = ts.load_scenario(path)
    flight = ts.dock(scenario, ts.trim(scenario), layers=())
    flight.save(tmp_path / "flight.nc")
    (tmp_path / "mast.csv").unlink()
    _, again = ts.fly_again(tmp_path / "flight.nc")
    assert np.array_equal(again.data["tension"], flight.data["tension"])


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("time,speed\n0,1\n1,2\n", "wanted: time with north, east"),
        ("time,north,east\n0,1,1\n1,,2\n2,1,1\n3,1,1\n", "3 samples beside 1 that are missing"),
        ("time,north,east\n0,1,1\n2,1,2\n1,1,1\n3,1,1\n", "times must rise"),
        ("time,north,east\n0,1,1\n2,1,2\n", "at least 4"),
    ],
)
def test_a_measured_wind_that_is_none_is_refused(measured, content, said):
    with pytest.raises(ConfigError, match=said):
        ts.load_scenario(measured(content))


def test_a_file_that_is_not_there_is_said_so(measured, tmp_path):
    path = measured("x")
    (tmp_path / "mast.csv").unlink()
    with pytest.raises(ConfigError, match=r"cannot read the wind of .*mast\.csv"):
        ts.load_scenario(path)


def test_logarithmic_wind_in_a_scenario_trims_and_docks():
    scenario = ts.load_scenario("docking").changed(LOGARITHMIC)
    flight = ts.dock(scenario, ts.trim(scenario), layers=("rewind",))
    assert flight.outcome is ts.Outcome.docked


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"turbulence.spectrum": "kaimal"}, "turbulence.spectrum"),
        ({"turbulence.seed": 1.5}, "whole number"),
        ({"turbulence.intensity": -1.0}, "at least 0"),
        ({"turbulence.averaged": False, "turbulence.gradients": True}, "leave averaged = true"),
        ({"turbulence.lengths": [10.0, 10.0, 5.0]}, "lengths and deviations together"),
        ({"gusts.0.turn": 1.0, "gusts.0.shape": "cosine"}, "cannot turn"),
    ],
)
def test_wind_that_cannot_be_is_refused(changes, said):
    with pytest.raises(ConfigError, match=said):
        ts.load_scenario("docking", changes)


def test_turbulence_has_finite_exact_derivatives():
    import jax

    scenario = ts.load_scenario("docking", {"turbulence.spectrum": "dryden", "turbulence.gradients": True})
    point = ts.trim(scenario)
    loop = ClosedLoop(scenario.system, scenario.law(), point.command)
    vector = loop.initial(point.state)
    slopes = jax.jacfwd(loop.vector_field, argnums=(0, 1))(jnp.asarray(3.0), vector)
    assert all(bool(jnp.all(jnp.isfinite(slope))) for slope in slopes)


def test_a_wind_file_may_be_a_change_and_its_end_is_told(tmp_path, monkeypatch):
    (tmp_path / "mast.csv").write_text("time,north,east\n" + "\n".join(f"{t},-{6 + t},0" for t in range(5)))
    monkeypatch.chdir(tmp_path)
    scenario = ts.load_scenario("docking", {"wind.file": "mast.csv", "wind.model": "measured"})
    assert scenario.config.wind.speed == pytest.approx(8.0)
    assert record_warning(scenario.config.wind, 4.0) is None
    assert "ends at 4 s and the flight at 60 s" in record_warning(scenario.config.wind, 60.0)
    assert record_warning(ts.load_scenario("docking").config.wind, 60.0) is None


def test_remarks_and_height_travel_with_the_scenario_and_its_flight(measured, tmp_path):
    path = measured("time,ws12m,wd12m,battery\n" + "\n".join(f"{t},{6 if t % 9 else -999},0,12" for t in range(1, 90)))
    scenario = ts.load_scenario(path)
    assert scenario.remarks == (
        "mast.csv: not used: battery",
        "mast.csv: 9 of 89 samples are missing, sample 9 the first",
        "mast.csv: 9 gaps of up to 2 s bridged; a usual step is 1 s",
    )
    assert scenario.config.wind.height == 12.0
    flight = ts.dock(scenario, ts.trim(scenario), layers=())
    flight.save(tmp_path / "flight.nc")
    again, _ = ts.fly_again(tmp_path / "flight.nc")
    assert again.remarks == scenario.remarks
    assert ts.load_scenario("docking").remarks == ()


def test_a_height_is_chosen_beside_the_file_or_by_a_change(measured, tmp_path):
    path = measured("time,ws10m,wd10m,ws40m,wd40m\n" + "\n".join(f"{t},6,0,9,0" for t in range(80)))
    with pytest.raises(ConfigError, match=r"several heights \(10, 40 m\)"):
        ts.load_scenario(path)
    assert ts.load_scenario(path, {"wind.height": 40.0}).config.wind.speed == pytest.approx(9.0)
    text = (tmp_path / "own.toml").read_text()
    beside = text.replace('"mast.csv"', '"mast.csv"\nheight = { value = 10.0, unit = "m" }')
    (tmp_path / "own.toml").write_text(beside)
    assert ts.load_scenario(path).config.wind.speed == pytest.approx(6.0)
    (tmp_path / "own.toml").write_text(beside.replace('"m" }\n\n[[gusts', '"kg" }\n\n[[gusts'))
    with pytest.raises(ConfigError, match=r"own.toml: wind.height: .*'kg'"):
        ts.load_scenario(path)
    changes = {"wind.file": str(tmp_path / "mast.csv"), "wind.height": {"value": 4000.0, "unit": "cm"}}
    assert ts.load_scenario("docking", changes).config.wind.height == pytest.approx(40.0)


def test_the_mean_of_a_record_cannot_be_set(measured):
    scenario = ts.load_scenario(measured("time,north,east\n" + "\n".join(f"{t},-6,0" for t in range(5))))
    with pytest.raises(ConfigError, match="12 m/s from 0 deg is not the measured mean, 6 m/s from 0 deg; leave it out"):
        scenario.changed({"wind.speed": 12.0})


@pytest.mark.parametrize("name", ["17", "[1]", "true"])
def test_a_wind_file_has_a_name(measured, tmp_path, name):
    path = measured("time,north,east\n0,1,1\n")
    text = (tmp_path / "own.toml").read_text()
    (tmp_path / "own.toml").write_text(text.replace('file = "mast.csv"', f"file = {name}"))
    with pytest.raises(ConfigError, match=r"wind\.file is .*; give the name of a file in quotes"):
        ts.load_scenario(path)
