"""Batches: the same flights as one by one, whatever else flies beside them."""

import numpy as np
import pytest

import tethership as ts
from tethership.campaign import Cases, fly_cases, layer_switches, perturbed
from tethership.campaign.flights import SWITCHES, Flyer
from tethership.simulation.batch import CODES, WIDE

LAYERS = (("rewind",), ("rewind", "heading", "navigation"))


@pytest.fixture(scope="module")
def flown(docking):
    """Two sets of layers at two winds, in one batch."""
    rows = []
    names = ()
    for wind in (6.0, 12.0):
        for layers in LAYERS:
            switches = layer_switches(docking, layers)
            names = ("wind.speed", *switches)
            rows.append([wind, *switches.values()])
    return fly_cases(docking, Cases(names, np.array(rows)))


@pytest.mark.parametrize("place", range(4))
def test_batch_is_loop(flown, place):
    """Fixed steps of 25 ms against adaptive ones of 1e-6: 1 % of each metric, ADC apart (χ jumps, decision 2)."""
    wind, layers = (6.0, 12.0)[place // 2], LAYERS[place % 2]
    scenario = ts.load_scenario("docking", {"wind.speed": wind})
    flight = ts.dock(scenario, ts.trim(scenario), layers)
    assert CODES[flown["outcome"][place]] is flight.outcome
    for name in ("tension_max", "tension_mean", "E", "theta_rms", "rewind_rate_min", "tension_largest"):
        assert flown[name][place] == pytest.approx(flight.metrics[name], rel=0.01), name
    assert flown["docking_time"][place] == pytest.approx(flight.docking_time, rel=1e-3)
    assert flown["clearance_min"][place] == pytest.approx(flight.metrics["clearance_min"], abs=0.02)
    assert flown["seconds_above"][place] == pytest.approx(flight.metrics["seconds_above"], abs=0.05)
    if layers == ("rewind",):
        assert flown["ADC"][place] == pytest.approx(flight.metrics["ADC"], rel=0.01)
        assert flown["misalignment_jumps"][place] == flight.metrics["misalignment_jumps"]


def test_neighbours_change_nothing(docking, flown):
    """A flight alone is the flight in company, bit for bit but for the vector length of the compiled loop."""
    switches = layer_switches(docking, LAYERS[0])
    alone = fly_cases(docking, Cases(("wind.speed", *switches), np.array([[6.0, *switches.values()]])))
    for name, value in alone.items():
        np.testing.assert_allclose(value[0], flown[name][0], rtol=1e-9)


@pytest.mark.slow
def test_stragglers_of_a_wide_batch_fly_on_alone(docking):
    """Winches from fast to slow, some too slow for the time limit: the last quarter ends as in a small batch."""
    switches = layer_switches(docking, LAYERS[0])
    names = (*switches, "cables.nose.winch.rewind_rate")
    rates = np.linspace(0.5, 0.33, WIDE) - np.where(np.arange(WIDE) % 7 == 0, 0.1, 0.0)
    values = np.column_stack([np.tile(list(switches.values()), (WIDE, 1)), rates])
    short = docking.changed({"stop.time_limit": 60.0})
    wide = Flyer(short, names, values[0], WIDE).fly(values)
    narrow = Flyer(short, names, values[0], 24)
    parts = [narrow.fly(values[first : first + 24]) for first in range(0, WIDE, 24)]
    assert {CODES[code] for code in wide["outcome"]} == {ts.Outcome.docked, ts.Outcome.time_limit}
    assert np.ptp(wide["flight_time"]) > 20.0
    for name, array in wide.items():
        np.testing.assert_allclose(
            array, np.concatenate([part[name] for part in parts]), rtol=1e-7, atol=1e-9, err_msg=name
        )


def test_zero_gains_are_no_layer(docking):
    """Gains of a layer switched off are zero, of one that acts the scenario's own."""
    off = layer_switches(docking, ())
    assert set(off) == {name for names in SWITCHES.values() for name in names}
    assert not any(off.values())
    assert layer_switches(docking, ("heading",))["control.heading.gain"] == docking.config.control.heading.gain


def test_broken_cable_ends_a_flight_unless_told_otherwise(docking):
    """A cable of 50 N breaks; an unbreakable one docks."""
    weak = docking.changed({"cables.nose.breaking_force": 50.0})
    cases = Cases(("wind.speed",), np.array([[12.0]]))
    assert CODES[fly_cases(weak, cases)["outcome"][0]] is ts.Outcome.cable_broken
    assert CODES[fly_cases(weak, cases, unbreakable=True)["outcome"][0]] is ts.Outcome.docked


def test_time_limit_and_divergence_are_told(docking):
    """A short limit is `time_limit`; gains that blow up end as a numbered outcome, and no NaN is in the tension."""
    short = docking.changed({"stop.time_limit": 5.0})
    assert CODES[fly_cases(short, Cases(("wind.speed",), np.array([[6.0]])))["outcome"][0]] is ts.Outcome.time_limit
    wild = fly_cases(short, Cases(("control.attitude.pitch_rate_gain",), np.array([[-500.0]])))
    assert CODES[wild["outcome"][0]] is not ts.Outcome.docked
    assert np.isfinite(wild["tension_max"]).all()


def test_wrong_names_are_refused(docking):
    """A parameter that does not exist, and the same number twice."""
    with pytest.raises(ts.ConfigError, match=r"has no number 'wind\.sped'"):
        fly_cases(docking, Cases(("wind.sped",), np.array([[6.0]])))
    with pytest.raises(ts.ConfigError, match="same number"):
        fly_cases(docking, Cases(("wind.speed", "wind"), np.array([[6.0, 7.0]])))


def test_columns_are_replaced():
    """`with_columns` keeps the others and replaces a name that is there."""
    cases = Cases(("a", "b"), np.array([[1.0, 2.0], [3.0, 4.0]])).with_columns({"b": np.array([5.0, 6.0]), "c": 7.0})
    assert cases.names == ("a", "b", "c")
    np.testing.assert_array_equal(cases.values, [[1.0, 5.0, 7.0], [3.0, 6.0, 7.0]])


def test_perturbations_are_centred_bounded_and_repeatable(docking):
    """Uniform within ±2°, ±1 s, ±3 % about the scenario's own values; the same seed gives the same."""
    columns = perturbed(docking, 200, seed=3)
    assert perturbed(docking, 200, seed=3)["wind.speed"].tolist() == columns["wind.speed"].tolist()
    angle = np.degrees(columns["start.attitude_offset.1"])
    assert angle.min() >= 8.0
    assert angle.max() <= 12.0
    assert np.mean(angle) == pytest.approx(10.0, abs=0.05)
    assert np.std(columns["gusts.0.start"]) == pytest.approx(1 / np.sqrt(3), rel=0.05)
    assert np.ptp(columns["wind.speed"]) == pytest.approx(0.36, rel=0.05)
    with pytest.raises(ts.ConfigError, match="no gust"):
        perturbed(docking.changed({"gusts": []}), 8, seed=1)
