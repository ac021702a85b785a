"""Claims D1-D11: each is fed flights for which it holds and flights for which it must say that it does not.

Truth: flights made by hand, of which every fact is known: a peak at a chosen time, height and elongation; a throttle
of chosen travel; an east coordinate of chosen reach. If this failed, the validation page would report as found in the
paper's flights what is not there.
"""

import json

import numpy as np
import pytest

import tethership as ts
from tethership.results import store
from tethership.studies.docking_paper.docking_claims import (
    FAR,
    SHORTEST_TIME,
    check_docking_claims,
    claim_5,
    claim_6,
    claim_7,
    claim_8,
    claim_9,
    claim_10,
    claim_11,
)
from tethership.studies.docking_paper.fit.targets import TABLES, published_rows
from tethership.studies.docking_paper.flights_read import KEYS, peaks, throw
from tethership.studies.docking_paper.table_claims import claim_1, claim_2, claim_3, claim_4

LIMITS = [144.3, 481.0, 2354.0, 3040.0]


def bump(time, centre, width):
    """Return a smooth hump of height 1, zero beyond ± width."""
    away = np.clip(np.abs(time - centre) / width, 0.0, 1.0)
    return 0.5 * (1.0 + np.cos(np.pi * away))


def make_flight(
    tops=((30.0, 100.0),),
    *,
    peak_elongation=1.0,
    sag=0.90,
    rate=0.3,
    docking_time=SHORTEST_TIME,
    travel=10.0,
    throttle=0.1,
    pitch=3.0,
    east=0.0,
    upward=0.0,
    saturated=0.0,
    outcome=ts.Outcome.docked,
):
    """Return a flight of known facts.

    tops: (time [s], tension [N]) of each peak, on 10 N; e is `sag`, and `peak_elongation` at peaks. travel: total
    variation of the one throttle [-] about `throttle`; pitch: constant [deg]; east: constant or function of time [m].
    """
    time = np.append(np.arange(0.0, docking_time, 0.05), docking_time)
    count = len(time)
    share = np.sum([bump(time, centre, 0.5) for centre, _ in tops], axis=0) if tops else np.zeros(count)
    tension = 10.0 + np.sum([(top - 10.0) * bump(time, centre, 0.5) for centre, top in tops], axis=0)
    position = np.zeros((count, 3))
    position[:, 1] = east(time) if callable(east) else east
    wind = np.tile([-6.0, 0.0, 0.0], (count, 1))
    wind[1:-1, 2] = -upward
    angles = np.zeros((count, 3))
    angles[:, 1] = np.radians(pitch)
    shaking = travel / (count - 1) * (np.arange(count) % 2)
    rates = np.full(count, 0.3)
    rates[count // 2] = rate
    arrays = {
        "time": time,
        "tension": np.broadcast_to(tension, count)[:, None],
        "tension_largest": np.broadcast_to(tension, count)[:, None],
        "elongation": (sag + (peak_elongation - sag) * share)[:, None],
        "rewind_rate": rates[:, None],
        "throttle": (throttle + shaking)[:, None],
        "saturated": np.where(np.arange(count) == 100, saturated, 0.0)[:, None],
        "attitude": angles,
        "position": position,
        "wind": wind,
        "misalignment": np.zeros((count, 1)),
        "cable_clearance": np.ones((count, 1)),
        "clearance": np.ones(count),
    }
    names = {"thruster": ["only"], "cable": ["nose"]}
    attributes = {"limits": LIMITS, "outcome": outcome.name}
    return ts.Flight(store.to_dataset(arrays, names, attributes), outcome)


def nine(default=None, **other):
    """Return nine flights: keyword `heading_12` changes that one, `navigation` or `at_12` all of a table or wind."""
    found = {}
    for table, wind in KEYS:
        facts = dict(default or {})
        for name in (table, f"at_{wind:g}", f"{table}_{wind:g}"):
            facts |= other.get(name, {})
        found[table, wind] = make_flight(**facts)
    return found


def verdicts_like(word="agrees", **other):
    """Return rows of every published number, all of one verdict; keyword `rewind_6_tension_max` gives another."""
    rows = {table: [row for row in published_rows() if row.table == table] for table in TABLES}
    return {
        table: [verdict_row(row, metric, word, other) for row in rows[table] for metric in row.values]
        for table in TABLES
    }


def verdict_row(row, metric, word, other):
    verdict = other.get(f"{row.table}_{row.wind:g}_{metric}", word)
    value = row.values[metric]
    return {
        "wind": row.wind,
        "metric": metric,
        "published": value,
        "computed": value,
        "ratio": np.float64(1.0),
        "verdict": verdict,
    }


PRINTED = {(row.table, row.wind): row.values for row in published_rows()}


def as_printed(**other):
    """Return flights with the printed peaks, times, rewind rates, θ_rms, E and ADC."""
    found = {}
    for table, wind in KEYS:
        value = PRINTED[table, wind]
        time = value["docking_time"]
        facts = {
            "tops": ((30.0, value["tension_max"]),),
            "docking_time": time,
            "pitch": value["theta_rms"],
            "throttle": value["E"] - 0.5 * value["ADC"] * 0.05,  # shaking adds half its step to the mean
            "travel": value["ADC"] * time,
            "rate": value["rewind_rate_min"],
        }
        found[table, wind] = make_flight(**(facts | other.get(table, {}) | other.get(f"{table}_{wind:g}", {})))
    return found


def failing(claim):
    """Return the parts that do not hold."""
    return [name for name, kept in claim.parts.items() if not kept]


def test_the_flights_made_by_hand_have_the_facts_asked_for():
    metrics = make_flight(((30.0, 500.0),), travel=20.0, throttle=0.2, pitch=4.0, rate=0.1).metrics
    assert metrics["tension_max"] == pytest.approx(500.0, abs=0.1)
    assert metrics["ADC"] == pytest.approx(20.0 / SHORTEST_TIME, rel=1e-9)
    assert metrics["theta_rms"] == pytest.approx(4.0, rel=1e-9)
    assert metrics["rewind_rate_min"] == 0.1
    assert metrics["saturated_seconds"] == 0.0


@pytest.mark.parametrize(
    ("claim", "table"), [(claim_1, "rewind"), (claim_2, "heading"), (claim_3, "navigation")], ids=["D1", "D2", "D3"]
)
def test_tables_3_to_5(claim, table):
    assert claim(as_printed(), verdicts_like()).holds
    assert claim(as_printed(), verdicts_like("near")).holds
    spoiled = claim(as_printed(), verdicts_like(**{f"{table}_6_seconds_above": "differs"}))
    assert failing(spoiled) == ["every number agrees or is near at 6 m/s"]
    spoiled = claim(as_printed(), verdicts_like(**{f"{table}_12_tension_mean": "differs"}))
    assert failing(spoiled) == ["mean tension agrees or is near at 12 m/s", "every number agrees or is near at 12 m/s"]
    # What was held out of the fit is judged like the rest.
    spoiled = claim(as_printed(), verdicts_like(**{f"{table}_9_tension_max": "differs"}))
    assert failing(spoiled) == ["peak tension agrees or is near at 9 m/s", "every number agrees or is near at 9 m/s"]
    # A verdict of Table 6 is none of Tables 3-5.
    assert claim(as_printed(), verdicts_like(**{f"{table}_12_ADC": "differs"})).holds
    # Without any row nothing is met.
    assert {"peak tension agrees or is near at 6 m/s", "every number agrees or is near at 12 m/s"} <= set(
        failing(claim(as_printed(), {}))
    )


def test_table_3_text():
    slow = {"rewind_12": {"tops": ((30.0, 2357.0),), "docking_time": 63.0}}
    assert failing(claim_1(as_printed(**slow), verdicts_like())) == ["docking time within 2 % at 12 m/s"]
    weak, strong = {"tops": ((30.0, 400.0),)}, {"tops": ((30.0, 500.0),)}
    found = failing(claim_1(as_printed(rewind_6=strong), verdicts_like()))
    assert found == ["peak tension is below the tear force at 6 m/s"]
    found = failing(claim_1(as_printed(rewind_12=weak | {"docking_time": 66.07}), verdicts_like()))
    assert found == ["peak tension is above the tear force at 12 m/s"]


def test_table_4_text():
    worse = as_printed(heading_9={"tops": ((30.0, 1600.0),)})  # rewind: 1555 N
    found = failing(claim_2(worse, verdicts_like()))
    assert found == ["every index is better than with rewind alone, or as good, at 9 m/s"]
    found = failing(claim_2(as_printed(heading_12={"tops": ((30.0, 400.0),)}), verdicts_like()))
    assert found == ["peak tension is still above the tear force at 12 m/s"]


def test_table_5_text():
    found = failing(claim_3(as_printed(navigation_6={"tops": ((30.0, 150.0),)}), verdicts_like()))
    assert found == ["tension stays below 144.3 N at 6 m/s"]


def test_table_6_holds_as_printed():
    claim = claim_4(as_printed(), verdicts_like())
    assert failing(claim) == []
    assert claim.numbers["E"]["navigation, 12 m/s"] == pytest.approx(1.51, rel=2e-3)
    assert claim.numbers["ADC [1/s]"]["rewind, 6 m/s"] == pytest.approx(0.11, rel=1e-6)


@pytest.mark.parametrize(
    ("change", "part"),
    [
        ({"heading_9": {"travel": 0.1}}, "ADC rises from rewind to heading at 9 m/s"),
        ({"navigation_9": {"travel": 100.0}}, "ADC is lower with navigation than with heading alone at 9 m/s"),
        ({"navigation_12": {"travel": 0.7}}, "ADC is highest with navigation at 12 m/s"),
        ({"navigation_6": {"throttle": 0.5}}, "E is lower with navigation than with rewind at 6 m/s"),
        ({"navigation_12": {"throttle": 0.5}}, "E is higher with navigation than with rewind at 12 m/s"),
        ({"navigation_6": {"pitch": 4.95}}, "θ_rms is lowest with navigation at 6 m/s"),
        ({"navigation_12": {"pitch": 3.0}}, "θ_rms is highest with navigation at 12 m/s"),
        ({"rewind_9": {"pitch": 9.0}}, "θ_rms with navigation at 12 m/s is the highest of all nine flights"),
        (
            {"navigation_6": {"pitch": 8.0}, "heading_6": {"pitch": 1.0}},
            "θ_rms has no clear trend: the layers rank otherwise at 6 than at 12 m/s",
        ),
    ],
)
def test_table_6_trends_can_fail(change, part):
    claim = claim_4(as_printed(**change), verdicts_like())
    assert part in failing(claim)
    assert not claim.holds


def test_table_6_numbers_can_fail():
    claim = claim_4(as_printed(), verdicts_like(heading_6_E="differs"))
    assert failing(claim) == ["every number agrees or is near at 6 m/s"]
    assert failing(claim_4(as_printed(), verdicts_like(heading_6_tension_max="differs"))) == []


PEAKS = {"tops": ((10.0, 300.0), (40.0, 200.0))}


def test_peaks_from_a_sagging_cable():
    claim = claim_5(nine(PEAKS))
    assert claim.holds
    assert claim.numbers["all together"] == [18, 18]
    # One flight whose cable never sags, one whose peaks come from a cable that is still slack.
    for wrong in ({"sag": 0.98}, {"peak_elongation": 0.985}):
        claim = claim_5(nine(PEAKS, heading_9=wrong))
        assert failing(claim) == [
            "heading: the highest peak of each flight comes as e rises to 1 from a sagging cable",
            "heading: every peak above 144.3 N does",
        ]
        assert claim.numbers["all together"] == [16, 18]
        assert claim.numbers["peaks from a sagging cable, of all"]["heading, 9 m/s"] == [0, 2]
        assert len(claim.numbers["others: time [s], tension [N], e, lowest e before"]["heading, 9 m/s"]) == 2
    # Taut from the start is not coming up from anything.
    assert not claim_5(nine(PEAKS, rewind_6={"sag": 1.0})).holds
    # Without any peak there is nothing of which the claim could hold.
    assert failing(claim_5(nine())) == ["there are peaks to look at"]


def test_peaks_are_told_apart_by_slack():
    def top_times(flight):
        return [round(peak.time, 2) for peak in peaks(flight)]

    assert top_times(make_flight(((10.0, 300.0), (12.0, 200.0)))) == [10.0, 12.0]
    # Two humps, the cable taut between them: one peak, the higher.
    assert top_times(make_flight(((10.0, 300.0), (12.0, 200.0)), sag=0.995)) == [10.0]
    assert top_times(make_flight(((10.0, 144.0),))) == []


def test_sag_long_before_does_not_count():
    """The cable sags at 10 s and is nearly straight from then on; its peak at 40 s comes from no sag."""
    flight = make_flight(((40.0, 300.0),), sag=0.98)
    early = flight.data["time"] < 10.0
    flight.data["elongation"][:] = np.where(early.to_numpy()[:, None], 0.8, flight.data["elongation"])
    assert not peaks(flight)[0].from_sagging
    assert peaks(flight)[0].lowest == pytest.approx(0.98)


def test_each_layer_lowers_the_peak():
    good = {
        "rewind": {"tops": ((30.0, 900.0),)},
        "heading": {"tops": ((30.0, 500.0),)},
        "navigation": {"tops": ((30.0, 100.0),)},
    }
    assert claim_6(nine(**good)).holds
    claim = claim_6(nine(**good, navigation_9={"tops": ((30.0, 501.0),)}))
    assert failing(claim) == ["navigation < heading < rewind at 9 m/s"]
    claim = claim_6(nine(**good, heading_12={"tops": ((30.0, 901.0),)}))
    assert failing(claim) == ["navigation < heading < rewind at 12 m/s"]


def test_ground_effect():
    base = {"tops": ((30.0, 1000.0),)}
    felt = {"tops": ((30.0, 991.0),), "upward": 0.1}
    assert claim_7(nine(base), nine(felt)).holds
    strong = {"at_9": {"tops": ((30.0, 1011.0),)}, "at_12": {"tops": ((30.0, 919.0),)}}
    claim = claim_7(nine(base), nine(felt, **strong))
    assert failing(claim) == [
        "it changes the peak tension with rewind control by less than 1% at 9 m/s",
        "it changes the peak tension with rewind control by less than 8% at 12 m/s",
    ]
    assert claim.numbers["change of peak tension"]["rewind, 12 m/s"] == pytest.approx(-0.081, abs=1e-4)
    # The same flights again, without any ground effect, show nothing.
    assert failing(claim_7(nine(base), nine(base))) == [f"there is a ground effect at {w} m/s" for w in (6, 9, 12)]


def test_saturation():
    assert claim_8(nine()).holds
    claim = claim_8(nine(heading_12={"saturated": 1.0}))
    assert failing(claim) == ["no throttle saturates with heading at 12 m/s"]
    assert claim.numbers["seconds with a throttle clipped [s]"]["heading, 12 m/s"] == pytest.approx(0.05)


def test_what_navigation_reaches():
    assert claim_9(nine(navigation_12={"tops": ((30.0, 422.0),), "rate": 0.01})).holds
    assert failing(claim_9(nine(navigation_9={"rate": 0.299}))) == ["Ψ is never reduced at 9 m/s"]
    claim = claim_9(nine(navigation_12={"tops": ((30.0, 482.0),)}))
    assert failing(claim) == ["tension stays below the tear force at 12 m/s"]


def thrown_by(attitude, gust):
    """Return an east coordinate: a throw before 20 s, and another with the gust."""
    return lambda time: attitude * bump(time, 10.0, 8.0) + gust * bump(time, 25.0, 4.0)


SIDEWAYS = {
    "rewind_12": {"east": thrown_by(12.0, 3.0)},
    "heading_12": {"east": thrown_by(2.0, 3.0), "tops": ((22.0, 200.0), (50.0, 900.0), (55.0, 600.0))},
}


def test_thrown_sideways():
    assert throw(make_flight(east=thrown_by(12.0, 3.0))) == pytest.approx((12.0, 3.0, 12.0), abs=1e-2)
    # Towards the west it is a throw as well, and being far east when the gust begins is not its doing.
    assert throw(make_flight(east=thrown_by(-12.0, 0.0))).by_attitude == pytest.approx(12.0, abs=1e-2)
    assert throw(make_flight(east=9.0)) == pytest.approx((9.0, 0.0, 9.0))
    # A swing much later is none of the gust's.
    assert throw(make_flight(east=lambda time: 8.0 * bump(time, 50.0, 8.0))) == pytest.approx((0.0, 0.0, 8.0), abs=1e-2)
    claim = claim_10(nine(**SIDEWAYS))
    assert claim.holds
    assert claim.numbers["peaks above 144.3 N in each third"]["heading, 12 m/s"] == [0, 1, 2]


@pytest.mark.parametrize(
    ("change", "parts"),
    [
        ({"rewind_12": {"east": thrown_by(FAR - 0.1, 3.0)}}, ["rewind: thrown far sideways"]),
        (
            {"rewind_12": {"east": thrown_by(8.0, 9.0)}},
            ["rewind: more by the initial attitude than by the gust"],
        ),
        (
            {"heading_12": SIDEWAYS["heading_12"] | {"east": thrown_by(7.0, 0.0)}},
            ["heading takes most of that away"],
        ),
        (
            {"heading_12": SIDEWAYS["heading_12"] | {"tops": ((22.0, 999.0), (50.0, 900.0), (55.0, 600.0))}},
            ["heading: its highest peak comes in the last third"],
        ),
        (
            {"heading_12": SIDEWAYS["heading_12"] | {"tops": ((22.0, 200.0), (30.0, 200.0), (50.0, 900.0))}},
            ["heading: more peaks in the last third than in either third before"],
        ),
        (
            {"heading_12": {"east": thrown_by(2.0, 3.0)}},
            [
                "heading: its highest peak comes in the last third",
                "heading: more peaks in the last third than in either third before",
            ],
        ),
    ],
)
def test_thrown_sideways_can_fail(change, parts):
    assert failing(claim_10(nine(**(SIDEWAYS | change)))) == parts


def test_the_shortest_time():
    slowed = {"rewind": {"rate": 0.01, "docking_time": 63.0}}
    assert claim_11(nine(**slowed)).holds
    sooner, exactly = claim_11(nine()).parts
    assert failing(claim_11(nine(**slowed, rewind_9={"docking_time": 61.6}))) == [sooner]
    assert failing(claim_11(nine(**slowed, heading_6={"docking_time": 61.7}))) == [exactly]
    # A flight that did not dock breaks both, and is no example of a short one.
    cut = {"docking_time": 40.0, "outcome": ts.Outcome.ground_contact}
    assert failing(claim_11(nine(**slowed, rewind_6=cut))) == [sooner, exactly]
    # With every winch slowed there is nothing that could dock exactly then.
    assert failing(claim_11(nine({"rate": 0.01, "docking_time": 63.0}))) == [exactly]


@pytest.mark.parametrize("outcome", ["cable_broken", "ground_contact", "time_limit", "diverged"])
def test_flights_that_did_not_dock(outcome):
    """Whatever a claim looks at: no part of it holds where no flight docked, and the outcome stands in its place."""
    good = nine(**SIDEWAYS)
    cut = {key: ts.Flight(flight.data.isel(time=slice(0, 0)), ts.Outcome[outcome]) for key, flight in good.items()}
    claims = check_docking_claims(cut, cut, verdicts_like())
    assert [claim.name for claim in claims] == [f"D{i}" for i in range(1, 12)]
    for claim in claims:
        assert not any(claim.parts.values()), claim.name
        assert outcome in json.dumps(claim.numbers, allow_nan=False)


def test_one_flight_that_did_not_dock_spoils_its_parts_only():
    flights = nine(**{name: {"tops": ((30.0, top),)} for name, top in (("rewind", 900.0), ("heading", 500.0))})
    assert claim_6(flights).holds
    broken = flights | {("rewind", 12.0): make_flight(((30.0, 3040.0),), outcome=ts.Outcome.cable_broken)}
    claim = claim_6(broken)
    assert failing(claim) == ["navigation < heading < rewind at 12 m/s"]
    assert claim.numbers["peak tension [N]"]["rewind, 12 m/s"] == "cable_broken"
    del broken["rewind", 12.0]
    assert claim_6(broken).numbers["peak tension [N]"]["rewind, 12 m/s"] == "not flown"


@pytest.mark.slow
def test_real_flights():
    """All claims of the packaged scenario, with ground effect for rewind control, as plain numbers."""
    effect = {"ground.effect_coefficient": {"value": 0.01, "unit": "1/m"}}
    flights, grounded = {}, {}
    for wind in (6.0, 9.0, 12.0):
        scenario = ts.load_scenario("docking", {"wind.speed": wind})
        point = ts.trim(scenario)
        for table, layers in TABLES.items():
            flights[table, wind] = ts.dock(scenario, point, layers)
        grounded["rewind", wind] = ts.dock(scenario.changed(effect), point, ("rewind",))
    claims = check_docking_claims(flights, grounded, verdicts_like())
    assert [claim.name for claim in claims] == [f"D{i}" for i in range(1, 12)]
    for claim in claims:
        assert claim.parts
        assert all(isinstance(kept, bool) for kept in claim.parts.values()), claim.name
        assert json.loads(json.dumps(claim.numbers, allow_nan=False)) == claim.numbers
    found = {claim.name: claim for claim in claims}
    # Physics demands it: the winch cannot take in 18.5 m sooner.
    assert found["D11"].parts["no flight docks sooner than 18.5 m / 0.3 m/s"]
    # The fins and thrusts of the literature do not keep navigation's winch from being slowed.
    assert not found["D9"].parts["Ψ is never reduced at 6 m/s"]
    assert found["D7"].numbers["peak tension with [N]"]["heading, 6 m/s"] == "not flown"
