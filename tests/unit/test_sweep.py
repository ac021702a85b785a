"""A sweep is many trims and linear models at once, and says the same as each of them alone.

Truth: `trim` and `linearize` of single scenarios, which are tested against the paper and against other routes.
If this fails, a root locus shows another ship than the one that is flown, or a point that cannot be held in the wind is
drawn as if it could.
"""

import numpy as np
import pytest

import tethership as ts
from tethership.analysis import TrimOutcome
from tethership.analysis.loci.grid import fill_lines
from tethership.plant import Command, State

WIND = np.linspace(6.0, 12.0, 13)
ELONGATIONS = (0.8, 0.95, 1.02)
TWO = ({"wind.speed": [6.0, 8.0]}, {"trim.elongation": [0.7, 0.8, 0.9]})


@pytest.fixture(scope="module")
def wind(docking):
    return ts.sweep(docking, {"wind": WIND})


@pytest.fixture(scope="module")
def taut(docking):
    """Return a sweep whose last point needs more thrust than there is."""
    return ts.sweep(docking, {"wind.speed": [6.0] * 3, "trim.elongation": ELONGATIONS})


@pytest.fixture(scope="module")
def grid(docking):
    return ts.sweep(docking, *TWO)


def apart(one, other):
    """Return how far two lists of eigenvalues are apart, each to its nearest."""
    distance = np.abs(np.asarray(one)[:, None] - np.asarray(other)[None, :])
    return max(distance.min(axis=0).max(), distance.min(axis=1).max())


def agrees(found, place):
    """Check one point of a sweep against its own trim and linear model."""
    scenario = found.at(place)
    point = ts.trim(scenario)
    model = ts.linearize(scenario, point)
    # both trims stop at a residual of 1e-6 of the weight, and are near each other to 1e-7
    np.testing.assert_allclose(found.throttle[place], point.command.throttle, atol=1e-6)
    np.testing.assert_allclose(found.states[place], point.state.as_vector(), atol=1e-6)
    np.testing.assert_allclose(found.tension[place], point.tension, rtol=1e-6)
    np.testing.assert_allclose(found.matrices[place], model.A, atol=1e-6)
    assert apart(found.eigenvalues[place], model.modes().eigenvalues) < 1e-6
    assert found.outcomes[place] is point.outcome


@pytest.mark.parametrize("place", [0, 5, 12])
def test_a_point_is_its_own_trim(wind, place):
    assert wind.at(place).config.wind.speed == WIND[place]
    agrees(wind, place)


@pytest.mark.parametrize("place", [0, 2])
def test_parameters_move_together(taut, place):
    config = taut.at(place).config
    assert (config.wind.speed, config.trim.elongation) == (6.0, ELONGATIONS[place])
    agrees(taut, place)


def test_what_a_sweep_says_of_itself(wind, docking):
    assert wind.scenario is docking
    assert wind.axes == (("wind.speed",),)  # the full name, whatever it was asked by
    assert wind.units == {"wind.speed": "m/s"}
    np.testing.assert_array_equal(wind.values["wind.speed"], WIND)
    assert wind.shape == (13,)
    assert len(wind.tracks) == 12
    assert wind.eigenvalues.shape == (13, 12)
    assert wind.outcomes == (TrimOutcome.converged,) * 13
    assert wind.trimmed.all()
    assert np.abs(wind.residual).max() < 1e-3  # N and N m, of a weight of 1342 N


def test_every_eigenvalue_has_one_track(wind):
    for row, order in zip(wind.path.values, wind.orders, strict=True):
        assert sorted(order) == list(range(12))
        np.testing.assert_array_equal(np.sort_complex(row[order]), np.sort_complex(row))
    for point in range(13):
        np.testing.assert_array_equal(wind.eigenvalues[point], wind.path.values[point][wind.orders[point]])


def test_tracks_are_named_as_the_modes_are(wind, docking, point):
    modes = ts.linearize(docking, point).modes()
    for name in ("pendulum", "pitch subsidence", "side-slip", "vertical"):
        # the reference is a point of this sweep; 1e-6 as above
        assert wind.track(name)[0] == pytest.approx(modes.find(name).eigenvalue, abs=1e-6)
    for track, name in zip(wind.tracks, wind.names_at(0), strict=True):
        assert wind.track(track)[0] == pytest.approx(modes.find(name).eigenvalue, abs=1e-6) or wind.track(track)[
            0
        ] == pytest.approx(modes.find(name).eigenvalue.conjugate(), abs=1e-6)


def test_a_mode_by_its_name_at_each_point(wind, taut):
    np.testing.assert_array_equal(wind.named("pendulum"), wind.track("pendulum"))  # here it keeps its character
    np.testing.assert_array_equal(wind.named("surge"), wind.named("north"))  # coalesced: one oscillation
    assert np.isnan(wind.named("phugoid")).all()
    assert np.isnan(taut.named("pendulum")[2])  # no trim


def test_points_in_between_lie_on_straight_lines():
    grid = np.array([[6.0, 0.7], [6.0, 0.8], [6.0, 1.0], [8.0, 0.7], [8.0, 0.8], [8.0, 1.0]])
    fine, per_line = fill_lines(grid, 3, 4)
    assert (fine.shape, per_line) == ((18, 2), 9)
    np.testing.assert_array_equal(fine[[0, 4, 8, 9, 13, 17]], grid)  # those that were asked for, to the bit
    np.testing.assert_allclose(fine[:9, 1], [0.7, 0.725, 0.75, 0.775, 0.8, 0.85, 0.9, 0.95, 1.0], rtol=1e-15)
    np.testing.assert_array_equal(fine[:9, 0], 6.0)


def test_tracks_do_not_jump(wind):
    # 0.5 m/s between points: the fastest track moves by less than 0.25 1/s; an exchange of two would move by more
    assert np.abs(np.diff(wind.eigenvalues, axis=0)).max() < 0.25


def test_unknown_track(wind):
    with pytest.raises(ts.ConfigError, match=r"the sweep has no track 'phugoid'; it has pitch subsidence, yaw"):
        wind.track("phugoid")


def test_a_point_beyond_the_thrust_stays(taut):
    assert taut.outcomes == (TrimOutcome.converged, TrimOutcome.converged, TrimOutcome.saturated)
    np.testing.assert_array_equal(taut.trimmed, [True, True, False])
    assert np.abs(taut.throttle[2]).max() > 1.0  # what would be needed, not clipped
    assert np.abs(taut.throttle[:2]).max() < 1.0
    assert taut.tension[2, 0] > 10.0 * taut.tension[0, 0]
    for name in taut.tracks:
        track = taut.track(name)
        assert np.isfinite(track[:2]).all()
        assert np.isnan(track[2])
    np.testing.assert_array_equal(taut.values["trim.elongation"], ELONGATIONS)
    agrees(taut, 2)  # the linear model beyond the thrust is there, for those who ask


def test_an_event_is_where_the_model_has_it(taut):
    crossings = [event for event in taut.events if event.kind == "cross"]
    assert [set(event.tracks) for event in crossings] == [{"side-slip", "vertical"}]
    (event,) = crossings
    assert event.at["wind.speed"] == 6.0
    assert event.name in {"side-slip", "vertical"}
    there = ts.scenario_at(taut.scenario, event.at)
    values = ts.linearize(there, ts.trim(there)).modes().eigenvalues
    near = np.sort(np.abs(values - event.eigenvalue))
    # lines between points 9e-4 apart in elongation: curvature times step squared leaves 1e-4
    assert near[1] < 1e-3
    assert near[2] > 1e-2


def test_a_grid_has_the_last_axis_fastest(grid):
    assert grid.shape == (2, 3)
    assert grid.axes == (("wind.speed",), ("trim.elongation",))
    np.testing.assert_array_equal(grid.values["wind.speed"], [6.0, 6.0, 6.0, 8.0, 8.0, 8.0])
    np.testing.assert_array_equal(grid.values["trim.elongation"], [0.7, 0.8, 0.9] * 2)
    assert grid.eigenvalues.shape == (6, 12)


def test_a_grid_is_its_lines(docking, grid):
    for row, speed in enumerate((6.0, 8.0)):
        line = ts.sweep(docking, {"wind.speed": [speed] * 3, "trim.elongation": [0.7, 0.8, 0.9]})
        part = slice(3 * row, 3 * row + 3)
        # every point is reached from the same reference: nothing but the batch is different
        np.testing.assert_allclose(grid.throttle[part], line.throttle, atol=1e-12)
        np.testing.assert_allclose(grid.matrices[part], line.matrices, atol=1e-9)
        np.testing.assert_allclose(grid.eigenvalues[part], line.eigenvalues, atol=1e-8)


def test_the_same_again(docking, wind):
    again = ts.sweep(docking, {"wind": WIND})
    for name in ("eigenvalues", "states", "throttle", "tension", "residual", "matrices", "orders"):
        np.testing.assert_array_equal(getattr(again, name), getattr(wind, name))  # not a bit
    assert again.events == wind.events
    assert again.tracks == wind.tracks


def test_points_do_not_depend_on_their_neighbours(docking, wind):
    one = ts.sweep(docking, {"wind": [9.0]})
    assert one.shape == (1,)
    assert one.events == ()
    np.testing.assert_allclose(one.throttle[0], wind.throttle[6], atol=1e-12)  # the same Newton steps
    assert apart(one.eigenvalues[0], wind.eigenvalues[6]) < 1e-9


def test_downwards_is_upwards(docking, wind):
    down = ts.sweep(docking, {"wind": WIND[::-1]})
    np.testing.assert_allclose(down.throttle[::-1], wind.throttle, atol=1e-12)
    for one, other in zip(down.eigenvalues[::-1], wind.eigenvalues, strict=True):
        assert apart(one, other) < 1e-9


WRONG = {
    "no axis": ((), r"sweep: name at least one parameter with its values"),
    "empty axis": (({},), r"sweep: name at least one parameter with its values"),
    "unknown": (({"wnd.speed": [6.0]},), r"scenario docking has no number 'wnd\.speed'; nearest: wind\.speed"),
    "word": (({"trim.hold": [1.0]},), r"has no number 'trim\.hold'"),
    "twice": (({"wind": [6.0]}, {"wind.speed": [7.0]}), r"sweep: wind\.speed is named twice; name each parameter once"),
    "twice in one axis": (({"wind": [6.0], "wind.speed": [7.0]},), r"wind\.speed is named twice"),
    "lengths": (
        ({"wind.speed": [6.0, 7.0], "trim.elongation": [0.8]},),
        r"need as many values each; there are \{'wind\.speed': 2, 'trim\.elongation': 1\}",
    ),
    "empty": (({"wind.speed": []},), r"sweep: the range of wind\.speed is empty; give at least one value"),
    "nan": (({"wind.speed": [6.0, np.nan]},), r"the range of wind\.speed has values that are not finite numbers"),
    "infinite": (({"wind.speed": [6.0, np.inf]},), r"the range of wind\.speed has values that are not finite numbers"),
    "first out of bounds": (
        ({"wind.speed": [-1.0, 6.0]},),
        r"docking: wind\.speed: it is -1 m/s; it must be at least 0",
    ),
    "last out of bounds": (({"trim.elongation": [0.8, 0.0]},), r"trim\.elongation: it is 0 1; it must be above 0"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_input(docking, case):
    axes, message = WRONG[case]
    with pytest.raises(ts.ConfigError, match=message):
        ts.sweep(docking, *axes)


def test_a_value_in_the_middle_is_checked_too(docking):
    with pytest.raises(ts.ConfigError, match=r"wind\.speed: it is -1 m/s; it must be at least 0"):
        ts.sweep(docking, {"wind.speed": [6.0, -1.0, 8.0]})


@pytest.mark.parametrize("values", [["fast", "slow"], [[6.0, 7.0], [8.0, 9.0]]], ids=["words", "a table"])
def test_values_that_are_no_list_of_numbers(docking, values):
    with pytest.raises(ts.ConfigError, match=r"wind\.speed"):
        ts.sweep(docking, {"wind.speed": values})


def test_every_line_keeps_to_one_branch():
    """An aerostat in wind has several equilibria: low behind its anchor, or kiting; the sweep must not jump between.

    `trim` finds the low one at 13.75 m/s, the branch of the calm aerostat is the kiting one.
    """
    scenario = ts.load_scenario("aerostat")
    found = ts.sweep(scenario, {"wind.speed": np.linspace(4.0, 14.0, 41)})
    assert all(outcome is ts.TrimOutcome.converged for outcome in found.outcomes)
    pitch, down = found.states[:, 7], found.states[:, 11]
    # Steps of a quarter of a m/s: measured at most 0.06 rad and 1.6 m between neighbours; a jump is 0.67 rad and 42 m.
    assert np.abs(np.diff(pitch)).max() < 0.1
    assert np.abs(np.diff(down)).max() < 3.0
    for point in (0, 20, 40):
        here = found.at(point)
        model = ts.linearize(here.system, (State.from_vector(found.states[point]), Command(np.zeros(6), np.zeros(4))))
        np.testing.assert_allclose(model.A, found.matrices[point], rtol=0, atol=1e-8)  # the same program, batched
