"""Tables 3–6: verdicts at their edges, rows of a flight, what is held out of the fit, the paper's own split."""

import numpy as np
import pytest

from tethership.studies.docking_paper.tables import (
    compare,
    computed_numbers,
    counts,
    held_out,
    paper_tables,
    published_numbers,
    verdict,
)


@pytest.mark.parametrize(
    ("metric", "published", "computed", "expected"),
    [
        ("tension_max", 100.0, 120.0, "agrees"),
        ("tension_max", 100.0, 120.1, "near"),
        ("tension_max", 100.0, 83.4, "agrees"),
        ("tension_max", 100.0, 66.7, "near"),
        ("tension_max", 100.0, 66.6, "differs"),
        ("docking_time", 61.67, 62.9, "agrees"),
        ("docking_time", 61.67, 64.1, "near"),
        ("docking_time", 61.67, 64.2, "differs"),
        ("docking_time", 61.67, None, "differs"),
        ("seconds_above 481 N", 0.0, 0.0, "agrees"),
        ("seconds_above 481 N", 0.0, 0.09, "agrees"),
        ("seconds_above 481 N", 0.0, 0.2, "differs"),
        ("seconds_above 2354 N", 0.03, 0.0, "agrees"),
        ("seconds_above 144.3 N", 5.18, 0.0, "differs"),
        ("ADC", 0.11, 0.0, "differs"),
    ],
)
def test_verdict(metric, published, computed, expected):
    """20 % agrees, a factor 1.5 is near; docking times 2 and 4 %; a time over a threshold below 0.05 s is none."""
    assert verdict(metric, published, computed) == expected


def test_published_numbers_are_the_papers():
    """Nine flights, those at 9 m/s held out of the fit; spot checks against Tables 3 to 6."""
    found = published_numbers()
    assert {wind for _, wind in found} == {6.0, 9.0, 12.0}
    assert held_out() == {(table, 9.0) for table in ("rewind", "heading", "navigation")}
    assert found["rewind", 9.0]["tension_max"] == 1555
    assert found["heading", 9.0]["seconds_above 144.3 N"] == 0.5
    assert found["navigation", 9.0]["theta_rms"] == 4.97
    assert found["rewind", 12.0]["tension_max"] == 2357
    assert found["rewind", 12.0]["seconds_above 2354 N"] == 0.03
    assert found["navigation", 6.0]["E"] == 0.21
    assert found["heading", 12.0]["theta_rms"] == 2.44


def test_rows_of_flights(flight):
    """Every number has a verdict; those at 9 m/s, which were not fitted, are counted apart; the split loses no row."""
    rows = compare({("navigation", 6.0): flight, ("navigation", 9.0): flight})
    numbers = computed_numbers(flight)
    assert len(rows["navigation"]) == 2 * len(numbers) == 22
    for row in rows["navigation"]:
        assert row["computed"] == numbers[row["metric"]]
        assert row["held_out"] == (row["wind"] == 9.0)
        assert row["verdict"] == verdict(row["metric"], row["published"], row["computed"])
        if row["published"]:
            assert row["ratio"] == pytest.approx(row["computed"] / row["published"])
    split = paper_tables(rows)
    assert sum(len(part) for part in split.values()) == 22
    assert {row["metric"] for row in split["table6"]} == {"ADC", "E", "theta_rms"}
    found = counts(rows["navigation"])
    assert found["prediction"] == sum(found["held_out"].values()) == 11
    assert found["agrees"] + found["near"] + found["differs"] == 11
    lone = counts([row for row in rows["navigation"] if row["held_out"]])
    assert (lone["agrees"], lone["near"], lone["differs"], lone["held_out"]) == (0, 0, 0, found["held_out"])


def test_numbers_are_those_of_the_flight(flight):
    """Times over thresholds go by their name in newtons."""
    numbers = computed_numbers(flight)
    np.testing.assert_array_equal(
        [numbers[f"seconds_above {limit}"] for limit in ("144.3 N", "481 N", "2354 N", "3040 N")],
        flight.metrics["seconds_above"],
    )
