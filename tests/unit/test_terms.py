"""The load breakdown balances, and a term that is switched off is gone from the plant that flies.

If these failed, a table of what matters would be about other loads than those that moved the ship.
"""

import json
from fnmatch import fnmatchcase

import jax.numpy as jnp
import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import tethership as ts
from tethership.control import Measurement
from tethership.plant import Command, State
from tethership.plant.ship import mass_matrix
from tethership.scenario import list_parameters
from tethership.scenario.load import from_document
from tethership.spatial import STANDARD_GRAVITY
from tethership.studies.docking_paper.terms import (
    NUDGES,
    PARTS,
    TERMS,
    load_breakdown,
    switch_off,
    switched_off,
    weighted,
)
from tethership.studies.docking_paper.view.breakdown import load_sizes, plot_breakdown
from tethership.view import style

pytestmark = pytest.mark.slow

WIND = 12.0
RNG = np.random.default_rng(5)
DENSITY = jnp.asarray(1.2)
SPEED, RATES = jnp.array([9.0, -2.0, 1.5]), jnp.array([0.1, -0.2, 0.3])
WIND_B, RATE_SHIP, RATE_FLUID = (jnp.asarray(RNG.normal(size=3)) for _ in range(3))
STILL = jnp.zeros(3)


@pytest.fixture(scope="module")
def both():
    """Both formulations, by name, without a part of the plant weighted yet."""
    changes = {"wind.speed": WIND}
    return {name: ts.load_scenario("docking", {**changes, "formulation": name}) for name in ("consistent", "published")}


@pytest.fixture(scope="module")
def windy(both):
    """A flight whose loads are large: at 12 m/s, to just after the gust."""
    scenario = both["consistent"].changed({"stop.time_limit": 26.0})
    return scenario, ts.dock(scenario, ts.trim(scenario))


@pytest.fixture(scope="module")
def free():
    """A flight without a cable."""
    hover = ts.load_scenario("hover", {"stop.time_limit": 0.5})
    return ts.dock(hover, ts.trim(hover), layers=(), sas=False)


def load(scenario, name, speed=SPEED, rates=RATES, air=(STILL, STILL, STILL)):
    """Return the load of apparent mass or envelope of a plant as a vector of six."""
    ship = scenario.system.ship
    if name == "envelope":
        return np.asarray(ship.envelope.wrench(DENSITY, speed, rates).as_vector())
    return np.asarray(ship.apparent_mass.wrench(DENSITY, speed, rates, *air).as_vector())


def drag(scenario, rates=RATES):
    """Return the viscous load of a plant's envelope alone, about P."""
    envelope = scenario.system.ship.envelope
    return np.asarray(DENSITY * envelope.viscous(SPEED, rates).moved(envelope.centre).as_vector())


def test_loads_balance_the_motion(windy):
    """Σ loads = (Mⁱ + Mᵃ) ẇ + w × Mⁱ w, ẇ from the recorded velocities by central differences.

    Over 0.0125 s these are in error by h²/6 of the third derivative: 3e-6 of the largest sum in the median, 4e-3 where
    the cable snaps. A load left out moves the median by 1 % and more.
    """
    scenario, flight = windy
    time = flight.data["time"].to_numpy()[:-1]
    motion = np.hstack([flight.data[name].to_numpy()[:-1] for name in ("velocity", "rates")])
    slope = (motion[2:] - motion[:-2]) / (time[2:] - time[:-2])[:, None]
    kinds = [flight.data[f"load_{kind}"].to_numpy()[1:-2:7] for kind in ("force", "moment")]
    loads = np.concatenate(kinds, axis=2)
    plant = scenario.system
    position = flight.data["position"].to_numpy()
    needed = []
    for i in range(0, len(slope), 7):
        state = State(motion[i + 1, :3], motion[i + 1, 3:], flight.data["attitude"].to_numpy()[i + 1], position[i + 1])
        gyroscopic = plant.ship.body.gyroscopic(state.velocity, state.rates).as_vector()
        needed.append(mass_matrix(state, plant.ship, plant.environment) @ slope[i] + gyroscopic)
    summed = loads.sum(axis=1)
    scale = np.abs(summed).max(axis=0)
    left = np.abs(np.array(needed) - summed)
    assert np.all(left.max(axis=0) < 5e-3 * scale)
    assert np.all(np.median(left, axis=0) < 2e-5 * scale)
    for i in range(loads.shape[1]):
        without = np.abs(np.array(needed) - summed + loads[:, i])
        assert (np.median(without, axis=0) / scale).max() > 1e-2


def test_breakdown_of_what_is_known(windy):
    """Weight is m g, buoyancy ρ𝒱g, and they stand together in the sum, which the shares divide."""
    _, flight = windy
    found = load_breakdown(flight)
    force, moment = found["force"], found["moment"]
    assert force["gravity"]["rms"] == pytest.approx(136.8 * STANDARD_GRAVITY, rel=1e-12)
    assert force["gravity"]["peak"] == pytest.approx(136.8 * STANDARD_GRAVITY, rel=1e-12)
    density = flight.data["density"].to_numpy()
    assert density.min() * 110.3 * STANDARD_GRAVITY <= force["buoyancy"]["rms"] <= force["buoyancy"]["peak"]
    assert force["buoyancy"]["peak"] == pytest.approx(density.max() * 110.3 * STANDARD_GRAVITY, rel=1e-12)
    assert 14.0 < force["net_weight"]["rms"] < 19.0  # section 5: about 17 N heavy
    assert moment["buoyancy"]["peak"] == 0.0  # P is B
    for kind in (force, moment):
        assert sum(row["share"] for row in kind.values() if row["share"] is not None) == pytest.approx(1.0)
        assert [name for name, row in kind.items() if row["share"] is None] == ["gravity", "buoyancy"]
        assert all(row["rms"] <= row["peak"] for row in kind.values() if row["peak"])
    assert json.loads(json.dumps(found)) == found


def test_breakdown_at_the_largest_tension(windy):
    _, flight = windy
    found = load_breakdown(flight)
    tension = flight.data["tension"][:, 0]
    at = flight.data.sel(time=found["time_of_peak"])
    assert found["peak_tension"] == float(tension.max()) == float(at["tension"][0])
    # The parabola or cubic of the metrics rises above the samples by less than 1 % (results.metrics).
    assert found["peak_tension"] == pytest.approx(flight.metrics["tension_max"], rel=0.01)
    for kind in ("force", "moment"):
        for name in flight.data["load"].values:
            assert found[kind][name]["at_peak_tension"] == at[f"load_{kind}"].sel(load=name).values.tolist()
    pull = found["force"]["cable_1"]["at_peak_tension"]
    assert np.linalg.norm(pull) == pytest.approx(found["peak_tension"], rel=1e-9)


def test_breakdown_of_other_flights(windy, free):
    """A ship without a cable has no tension; a flight without a sample nothing."""
    found = load_breakdown(free)
    assert found["peak_tension"] == 0.0
    assert "cable_1" not in found["force"]
    _, flight = windy
    with pytest.raises(ts.SolveError, match="no sample to break down"):
        load_breakdown(ts.Flight(flight.data.isel(time=slice(0, 0)), flight.outcome))


@pytest.mark.parametrize("name", ["consistent", "published"])
def test_nothing_taken_out_is_the_plant_itself(both, name):
    """To rounding: the parts are taken off with weight zero."""
    scenario = both[name]
    state = State(*(jnp.asarray(RNG.normal(size=3) * s) for s in (5.0, 0.3, 0.2, 8.0)))
    command = Command(jnp.asarray(RNG.uniform(-1, 1, 6)), jnp.zeros(4))
    arguments = jnp.asarray(22.0), state, command, jnp.array([20.0])
    expected = np.asarray(scenario.system.derivative(*arguments).as_vector())
    found = np.asarray(weighted(scenario).system.derivative(*arguments).as_vector())
    assert found == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("name", ["consistent", "published"])
def test_parts_are_all_there_is(both, name):
    """Without any part nothing is left of apparent mass and envelope but drag, and density is the same everywhere."""
    bare = weighted(both[name], PARTS)
    assert load(bare, "apparent_mass", air=(WIND_B, RATE_SHIP, RATE_FLUID)) == pytest.approx(np.zeros(6), abs=1e-9)
    assert load(bare, "envelope") == pytest.approx(drag(both[name]), rel=1e-12)
    assert np.all(bare.system.ship.apparent_mass.matrix() == 0.0)
    assert float(bare.system.environment.density_at(jnp.array([0.0, 0.0, -3000.0]))) == pytest.approx(1.225, abs=1e-4)


def test_inertia_goes_with_the_winds_part(both):
    """In `consistent` Mᵃ multiplies the rate of the air-relative velocity: what the wind adds goes too, and only it."""
    scenario, off = both["consistent"], switched_off(both["consistent"], "apparent_mass_inertia")
    assert np.all(off.system.ship.apparent_mass.matrix() == 0.0)
    quadratic = load(scenario, "apparent_mass")
    assert load(off, "apparent_mass", air=(WIND_B, RATE_SHIP, STILL)) == pytest.approx(quadratic, rel=1e-12)
    assert load(off, "envelope") == pytest.approx(load(scenario, "envelope"), rel=1e-12)


def test_quadratic_loads_and_pressure_of_the_air(both):
    scenario, air = both["consistent"], (WIND_B, RATE_SHIP, RATE_FLUID)
    off = switched_off(scenario, "apparent_mass_quadratic")
    assert load(off, "apparent_mass") == pytest.approx(np.zeros(6), abs=1e-9)
    kept = load(scenario, "apparent_mass", air=air) - load(scenario, "apparent_mass")
    assert load(off, "apparent_mass", air=air) == pytest.approx(kept, rel=1e-9, abs=1e-9)
    still = switched_off(scenario, "air_pressure_gradient")
    change = load(scenario, "apparent_mass", air=air) - load(still, "apparent_mass", air=air)
    assert change == pytest.approx(np.append(DENSITY * 110.3 * RATE_FLUID, np.zeros(3)), rel=1e-12, abs=1e-9)


@pytest.mark.parametrize("name", ["consistent", "published"])
def test_potential_loads(both, name):
    """Off, nothing of ideal flow is left; Munk's part and that of rotation are together the whole, also for P ≠ B."""
    scenario = both[name].changed({"vehicle.buoyancy.centre": [0.4, 0.0, -0.2]})

    def ideal(of):
        return load(of, "apparent_mass") + load(of, "envelope") - drag(scenario)

    none, turning, straight = (
        ideal(switched_off(scenario, term))
        for term in ("hull_potential", "hull_munk_moment", "hull_potential_rotation")
    )
    assert none == pytest.approx(np.zeros(6), abs=1e-9)
    assert turning + straight == pytest.approx(ideal(scenario), rel=1e-9, abs=1e-9)
    at_rest = load(scenario, "apparent_mass", rates=STILL) + load(scenario, "envelope", rates=STILL)
    assert straight == pytest.approx(at_rest - drag(scenario, STILL), rel=1e-9, abs=1e-9)


def test_munks_load_is_the_same_in_both_formulations(both):
    """With η_k = 1 the slices ahead of l_h are Kirchhoff's whole hull less those behind: only rotation differs.

    𝒱 is 110.3 m³ and the profile's integral 110.29 (section 3), and the axial part is k₁, not none.
    """
    consistent, published = (
        load(scenario, "apparent_mass", rates=STILL) + load(scenario, "envelope", rates=STILL)
        for scenario in both.values()
    )
    assert np.abs(published[4:]).min() > 500.0
    assert consistent == pytest.approx(published, rel=2e-3, abs=1e-6)


NUMBERS = [term for term, patterns in TERMS.items() if not patterns[0].startswith("parts.") and term != "net_weight"]


@pytest.mark.parametrize("term", NUMBERS)
def test_numbers_are_zero(both, term):
    """The parameters that a term names exist, were not zero, and are; no other number of the scenario moves."""
    scenario = both["consistent"]
    before = {name: row.value for name, row in list_parameters(scenario.config).items() if "*" not in name}
    after = list_parameters(switched_off(scenario, term).config)
    changed = {name for name, value in before.items() if after[name].value != value}
    assert changed
    assert all(after[name].value == 0.0 for name in changed)
    assert changed == {name for name in before if any(fnmatchcase(name, p) for p in TERMS[term])}


def test_plants_without_a_number(both):
    """The loads that the numbers stand for are gone."""
    off = {term: switched_off(both["consistent"], term).system for term in NUMBERS}
    fins = {name: off[name].ship.fins for name in ("fin_lift", "fin_cross_flow_drag", "fin_friction")}
    assert np.all(fins["fin_lift"].lift_area == 0.0)
    assert np.all(fins["fin_cross_flow_drag"].cross_flow_area == 0.0)
    assert np.all(fins["fin_friction"].friction_area == 0.0)
    assert off["hull_cross_flow_drag"].ship.envelope.base.cross_flow_drag_coefficient == 0.0
    assert off["hull_axial_drag"].ship.envelope.base.axial_drag_area == 0.0
    state = State.at_rest(jnp.array([-15.0, 0.0, -9.0]))
    cable = {
        name: off[name].cable_states(jnp.zeros(()), state, jnp.array([20.0]))[0]
        for name in ("cable_drag", "cable_weight")
    }
    assert cable["cable_drag"].load.tolist() == [0.0, 0.0, 0.08 * STANDARD_GRAVITY]
    assert cable["cable_weight"].load[0] < -0.3  # 12 m/s from the north pull it south
    in_gust = off["gust"].environment.wind_at(STILL, jnp.asarray(22.5))
    assert in_gust == pytest.approx([-WIND, 0.0, 0.0], abs=1e-12)


def test_no_sas(both):
    """A ship that turns is not answered."""
    law = switched_off(both["consistent"], "sas").law(())
    turning = Measurement(SPEED, RATES, RATES, jnp.zeros(()), jnp.ones((1, 3)), *(jnp.ones(1) for _ in range(3)))
    assert np.abs(both["consistent"].law(())(0.0, turning, law.initial_memory(turning))[0].throttle).max() > 0.5
    assert np.all(law(0.0, turning, law.initial_memory(turning))[0].throttle == 0.0)


def test_floating(both):
    """At the height of the anchor the ship weighs what the air does."""
    plant = switched_off(both["published"], "net_weight").system
    density = plant.environment.density_at(STILL)
    assert plant.ship.gravity.mass == pytest.approx(float(density) * 110.3, rel=1e-12)
    assert plant.ship.gravity.mass == pytest.approx(135.1, abs=0.05)  # section 5


@pytest.mark.parametrize("name", ["consistent", "published"])
def test_cable_of_weight_alone(both, name):
    """At e = 0.8 the tether pulls with 18.06 N at 12 m/s and with 13.01 N by its weight alone (section 7)."""
    assert float(ts.trim(both[name]).tension[0]) == pytest.approx(18.06, abs=0.005)
    assert float(ts.trim(switched_off(both[name], "cable_drag")).tension[0]) == pytest.approx(13.01, abs=0.005)


def test_rows(windy):
    """One row each, the full flight first as `dock` flies it, the floor last; a table goes to JSON."""
    scenario, flight = windy
    rows = switch_off(scenario, ("rewind", "heading", "navigation"), ("gust", "cable_drag", "hull_potential"))
    terms = [row["term"] for row in rows]
    assert terms == ["full", "gust", "cable_drag", "hull_potential", *(f"chaos floor {name}" for name in NUDGES)]
    assert json.loads(json.dumps(rows)) == rows
    full, gust, cable, potential, *floor = rows
    assert full["ratio"] == 1.0
    # The same flight by another program: rounding, grown by the motion's own instability over 26 s.
    assert full["peak_tension"] == pytest.approx(flight.metrics["tension_max"], rel=1e-4)
    assert full["theta_rms"] == pytest.approx(flight.metrics["theta_rms"], rel=1e-4)
    assert cable["trim_tension"] == pytest.approx(13.01, abs=0.005)
    for row in rows:
        assert row["outcome"] == "time_limit"
        assert row["docking_time"] is None
        assert row["ratio"] == pytest.approx(row["peak_tension"] / full["peak_tension"])
    for row in floor:
        assert row["trim_tension"] == full["trim_tension"]
        assert 0.0 < abs(row["ratio"] - 1.0) < abs(potential["ratio"] - 1.0)
    assert gust["peak_tension"] <= full["peak_tension"]


def test_layers_act_as_dock_has_them(windy):
    """Layers are switched by their gains; the flight is the one with those layers alone."""
    scenario, _ = windy
    full = switch_off(scenario, ("rewind",), ())[0]
    flight = ts.dock(scenario, ts.trim(scenario), layers=("rewind",))
    assert full["peak_tension"] == pytest.approx(flight.metrics["tension_max"], rel=1e-4)


def test_rows_without_numbers(windy, both):
    """What is absent, cannot be trimmed, or is over before it begins is a row that says so, not an exception."""
    calm = from_document(windy[0].document, "calm", {"gusts.0.fraction": 0.0, "cables.nose.breaking_force": 5.0})
    rows = switch_off(calm, (), ("gust", "cable_weight"))
    assert [row["outcome"] for row in rows] == ["no_start", "absent", "no_start", "no_start", "no_start"]
    assert all(row["peak_tension"] is row["ratio"] is row["docking_time"] is row["theta_rms"] is None for row in rows)
    assert rows[0]["trim_tension"] == pytest.approx(18.06, abs=0.005)
    weak = calm.changed({f"vehicle.thrusters.{i}.nominal_thrust": 1.0 for i in range(6)})
    rows = switch_off(weak, (), ())
    assert {row["outcome"] for row in rows} == {"saturated"}
    assert all(value is None for row in rows for name, value in row.items() if name not in ("term", "outcome"))
    for term in ("apparent_mass_quadratic", "air_pressure_gradient"):
        assert switched_off(both["published"], term) is None


def test_a_cable_that_breaks_or_not(windy):
    scenario, _ = windy
    weak = scenario.changed({"cables.nose.breaking_force": 100.0})
    broken = switch_off(weak, (), ())[0]
    assert broken["outcome"] == "cable_broken"
    assert broken["peak_tension"] == pytest.approx(100.0, rel=0.02)
    held = switch_off(weak, (), (), unbreakable=True)[0]
    assert held["outcome"] == "time_limit"
    assert held["peak_tension"] > 500.0


def test_wrong_names(both):
    with pytest.raises(ts.ConfigError, match=r"no term 'fin_lif'; did you mean 'fin_lift'\? Known: apparent_mass_iner"):
        switched_off(both["consistent"], "fin_lif")


def test_figure_shows_the_flights_numbers(windy):
    """Two columns of one panel per load, each with its own line, the numbers of the breakdown and one scale."""
    _, flight = windy
    figure = plot_breakdown(flight)
    FigureCanvasAgg(figure).draw()
    names = ["net_weight", "apparent_mass", "envelope", "fins", "thrust", "cable_1"]
    assert len(figure.axes) == 2 * len(names)
    found = load_breakdown(flight)
    for column, kind in enumerate(("force", "moment")):
        sizes = load_sizes(flight, kind)
        assert list(sizes) == names
        panels = figure.axes[column * len(names) : (column + 1) * len(names)]
        assert len({axes.get_ylim() for axes in panels}) == 1
        for name, axes in zip(names, panels, strict=True):
            (line,) = [line for line in axes.lines if line.get_gid() == name]
            np.testing.assert_array_equal(line.get_ydata(), sizes[name])
            assert sizes[name].max() == pytest.approx(found[kind][name]["peak"], rel=1e-12)
            assert axes.get_ylim()[0] < sizes[name].max() < axes.get_ylim()[1]
            (peak,) = [line for line in axes.lines if line.get_gid() == "peak"]
            assert peak.get_xdata()[0] == found["time_of_peak"]
    assert line.get_color() == style.cable_colour(0)
    text = " ".join(text.get_text() for text in figure.texts)
    assert "wind 12 m/s" in text
    assert "consistent formulation" in text


def test_figure_without_a_cable_or_a_load(free):
    """Also where a load is zero throughout, as apparent mass is in `published`."""
    zero = xr.where(free.data["load"] == "apparent_mass", 0.0, free.data["load_force"]).transpose("time", ...)
    data = free.data.assign(load_force=zero).assign_attrs(free.data.attrs)
    figure = plot_breakdown(ts.Flight(data, free.outcome), figure=Figure(figsize=(8, 7)))
    FigureCanvasAgg(figure).draw()
    assert len(figure.axes) == 10
    words = [[text.get_text() for text in axes.texts] for axes in figure.axes]
    assert "zero" in words[1]
    assert "zero" not in words[0] + words[4]
    assert not [line for axes in figure.axes for line in axes.lines if line.get_gid() == "peak"]
