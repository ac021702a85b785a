"""The pace of the tension: κ = |dT/dt|/(T ω₁) on made-up tensions, and the warning on real flights."""

import dataclasses

import numpy as np

import tethership as ts
from tethership.simulation.quasi_static import TRUSTED, outside, quasi_static_warning, share_outside, tension_pace


def swinging(flight: ts.Flight, rate: float) -> ts.Flight:
    """Return a flight whose tension is 100 e^{0.5 sin(rate t)} N on a cable of 10 m."""
    time = flight.data["time"].to_numpy()
    data = flight.data.copy()
    data["tension"] = flight.data["tension"].dims, 100.0 * np.exp(0.5 * np.sin(rate * time))[:, None]
    data["cable_length"] = flight.data["cable_length"].dims, np.full((len(time), 1), 10.0)
    return dataclasses.replace(flight, data=data)


def test_closed_form(flight):
    """d ln T/dt = ½ Ω cos Ωt against ω₁ = (π/L)√(T/m), m = 80 g/m; 1 % from finite differences."""
    swung = swinging(flight, 2.0)
    time, tension = swung.data["time"].to_numpy(), swung.data["tension"].to_numpy()[:, 0]
    expected = np.abs(np.cos(2.0 * time)) / (np.pi / 10.0 * np.sqrt(tension / 0.08))
    np.testing.assert_allclose(tension_pace(swung)[2:-2, 0], expected[2:-2], atol=0.01 * expected.max())


def test_slow_is_trusted_and_fast_is_not(flight):
    """ω₁ is about 11 1/s: a tension at 0.2 1/s is trusted throughout, one at 20 1/s hardly ever."""
    assert share_outside(swinging(flight, 0.2)) == 0.0
    assert quasi_static_warning(swinging(flight, 0.2)) is None
    assert share_outside(swinging(flight, 20.0)) > 0.8
    said = quasi_static_warning(swinging(flight, 20.0))
    assert said is not None
    assert "quasi-static cable is not to be trusted" in said
    assert f"{TRUSTED:g}" in said


def test_a_peak_is_not_trusted(flight):
    """At a peak dT/dt is zero: the cable was hurried just before, and swings on for three seconds."""
    calm = swinging(flight, 0.2)
    time = calm.data["time"].to_numpy()
    tension = 20.0 + 1000.0 * np.exp(-(((time - 30.0) / 0.2) ** 2))
    data = calm.data.copy()
    data["tension"] = calm.data["tension"].dims, tension[:, None]
    snapped = dataclasses.replace(calm, data=data)
    peak = int(np.argmax(tension))
    assert tension_pace(snapped)[peak, 0] < TRUSTED
    away = outside(snapped)
    assert away[peak]
    assert away[np.searchsorted(time, 32.0)]
    assert not away[time < 29.0].any()
    assert not away[time > 34.5].any()


def test_a_snapping_flight_says_so():
    """12 m/s with rewind alone leaves the range; a ship without cables never does."""
    scenario = ts.load_scenario("docking", {"wind.speed": 12.0})
    flight = ts.dock(scenario, ts.trim(scenario), ("rewind",))
    assert 0.2 < share_outside(flight) < 0.8
    assert quasi_static_warning(flight) is not None
    hover = ts.load_scenario("hover", {"stop.time_limit": 2.0})
    assert quasi_static_warning(ts.dock(hover, ts.trim(hover), ())) is None
