"""Flights compared, and flights to be explored, show the flights' own numbers where they are.

If one of these failed, two flights would be compared on different scales, or a peak would be missing from the plot.
"""

import copy
import json

import numpy as np
import plotly.graph_objects as go
import pytest

import tethership as ts
from tethership.errors import ConfigError
from tethership.studies.docking_paper.jobs import Settings
from tethership.studies.docking_paper.study import flight_file
from tethership.studies.docking_paper.view.comparison import AZIMUTH, ELEVATION, plot_comparison, three_quarter
from tethership.studies.docking_paper.view.ground_box import box_around, marking
from tethership.studies.docking_paper.view.pictures import docking_pictures
from tethership.view import plot_docking
from tethership.view.flight.hull_mesh import ship_mesh
from tethership.view.flight.interactive_histories import interactive_histories
from tethership.view.flight.projection import FROM_EAST
from tethership.view.flight.snapshots import take_snapshots
from tethership.view.flight.thinning import evenly, listed, with_peaks

VIEW = three_quarter(AZIMUTH, ELEVATION)


@pytest.fixture(scope="module")
def flight():
    """Return a docking in 12 m/s under rewind control alone, to its end."""
    scenario = ts.load_scenario("docking", {"wind.speed": 12.0})
    return ts.dock(scenario, ts.trim(scenario), ("rewind",))


@pytest.fixture(scope="module")
def hover():
    """Return a flight without a cable."""
    scenario = ts.load_scenario("hover", {"stop.time_limit": 2.0})
    return ts.dock(scenario, ts.trim(scenario), layers=())


@pytest.fixture(scope="module")
def start(flight):
    """Return the first 10 s of the flight."""
    return ts.Flight(flight.data.isel(time=flight.data["time"] <= 10.0), ts.Outcome.time_limit)


@pytest.fixture(scope="module")
def figure(flight, start):
    return plot_comparison({"all of it": flight, "<the start>": start}, "Two flights")


@pytest.fixture(scope="module")
def histories(flight):
    return interactive_histories(flight)


def by_name(axes, name):
    """Return the one artist with an identifier."""
    (artist,) = [artist for artist in axes.get_children() if artist.get_gid() == name]
    return artist


def trace(plot, name):
    """Return the one trace of a name."""
    (found,) = [t for t in plot.data if t.name == name]
    return found


def slower(flight, factor):
    """Return the flight as if it had taken longer."""
    return ts.Flight(flight.data.assign_coords(time=flight.data["time"] * factor), flight.outcome)


def with_scenario(flight, change):
    """Return the flight with its stored scenario changed in place by a function."""
    document = copy.deepcopy(flight.attributes["scenario"])
    change(document)
    return ts.Flight(flight.data.assign_attrs(scenario=json.dumps(document)), flight.outcome)


@pytest.mark.parametrize(("azimuth", "elevation"), [(0.0, 0.0), (AZIMUTH, ELEVATION), (4.0, 1.2), (-2.0, -0.3)])
def test_view_is_an_orthonormal_projection_as_seen_from_there(azimuth, elevation):
    view = three_quarter(azimuth, elevation)
    axes = np.stack([*view.plane, view.toward])
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(np.cross(view.plane[0], view.plane[1]), view.toward, atol=1e-12)
    assert view.plane[0, 2] == 0.0  # the horizon is level
    assert view.plane[1, 2] < 0.0  # and up is up


def test_view_from_east_is_that_of_the_docking_figure():
    view = three_quarter(0.5 * np.pi, 0.0)
    np.testing.assert_allclose(view.plane, FROM_EAST.plane, atol=1e-15)
    np.testing.assert_allclose(view.toward, FROM_EAST.toward, atol=1e-15)


def test_all_views_have_one_equal_scale_and_hold_what_is_drawn(figure):
    figure.draw_without_rendering()
    assert len(figure.axes) == 2
    assert len({(*axes.get_xlim(), *axes.get_ylim()) for axes in figure.axes}) == 1
    for axes in figure.axes:
        unit = axes.transData.transform([(0, 0), (1, 0), (0, 1)])
        assert unit[1, 0] - unit[0, 0] == pytest.approx(unit[2, 1] - unit[0, 1], rel=1e-6)
        ships = [path.vertices for name in ("ships", "start", "end") for path in by_name(axes, name).get_paths()]
        points = np.concatenate([*ships, *by_name(axes, "cable 0").get_segments(), by_name(axes, "path").get_xydata()])
        corners = axes.bbox.get_points()
        drawn = axes.transData.transform(points)
        assert np.all((drawn >= corners[0]) & (drawn <= corners[1]))
    areas = [axes.bbox.width * axes.bbox.height for axes in figure.axes]
    assert areas[0] == pytest.approx(areas[1])


def test_path_shadow_cable_and_anchor_are_the_flights(figure, flight):
    axes = figure.axes[0]
    position = flight.data["position"].to_numpy()  # Lotte's reference point is B
    np.testing.assert_allclose(by_name(axes, "path").get_xydata(), VIEW.project(position), atol=1e-12)
    shadow = position * np.array([1.0, 1.0, 0.0])
    np.testing.assert_allclose(by_name(axes, "shadow").get_xydata(), VIEW.project(shadow), atol=1e-12)
    segments = by_name(axes, "cable 0").get_segments()
    indices = take_snapshots(flight).indices
    np.testing.assert_allclose(flight.data["time"][indices[:-1]], 4.0 * np.arange(len(indices) - 1), atol=0.02)
    curves = flight.data["cable_curve"].to_numpy()[indices, 0]
    np.testing.assert_allclose(segments, VIEW.project(curves), atol=1e-12)
    np.testing.assert_allclose(by_name(axes, "anchor").get_xydata(), VIEW.project(curves[:1, 0]), atol=1e-12)


def test_first_is_green_last_is_red_and_cables_are_dashed(figure):
    for axes, between in zip(figure.axes, (15, 2), strict=True):
        red, green, _ = by_name(axes, "start").get_edgecolor()[0, :3]
        assert green > red
        red, green, _ = by_name(axes, "end").get_edgecolor()[0, :3]
        assert red > green
        parts = len(by_name(axes, "end").get_paths())
        assert parts == 5  # hull and four fins
        assert len(by_name(axes, "ships").get_paths()) == between * parts
        _, _, blue = by_name(axes, "cable 0").get_colors()[0, :3]
        assert blue > 0.5
        assert by_name(axes, "cable 0").get_linestyles()[0][1] is not None


def test_words_name_the_flights_and_how_they_ended(figure, flight):
    words = [text.get_text() for text in figure.axes[0].texts] + [text.get_text() for text in figure.axes[1].texts]
    tension = flight.metrics["tension_max"]
    assert f"docked after {flight.docking_time:.1f} s  ·  largest tension {tension:.0f} N" in words
    assert {"all of it", "<the start>"} <= set(words)
    assert any(word.startswith("time limit after 10.0 s") for word in words)
    assert figure.texts[0].get_text() == "Two flights"
    assert "every 4 s" in [text.get_text() for text in figure.legends[0].get_texts()]


def test_long_and_short_flights_have_the_same_interval(flight, start):
    figure = plot_comparison({"long": slower(flight, 3.0), "short": slower(start, 3.0)})
    assert "every 8 s" in [text.get_text() for text in figure.legends[0].get_texts()]
    counts = [len(by_name(axes, "dots").get_xdata()) for axes in figure.axes]
    assert counts == [int(3.0 * flight.data["time"][-1] // 8.0) + 2, 5]  # 0, 8, … and the end: 0, 8, 16, 24, 30


def test_four_flights_take_two_rows_and_no_flight_is_an_error(start, hover):
    figure = plot_comparison({"a": start, "b": hover, "c": start, "d": start})
    bottoms = [axes.get_position().y0 for axes in figure.axes]
    assert bottoms[0] == bottoms[1] == bottoms[2] > bottoms[3]
    assert not [artist for artist in figure.axes[1].get_children() if artist.get_gid() == "anchor"]
    with pytest.raises(ConfigError, match="no flights to compare; give at least one"):
        plot_comparison({})


def test_ground_box_holds_the_points_with_few_lines():
    points = np.array([[-31.0, 2.0, -12.0], [4.0, 7.5, 3.0]])
    box = box_around(points, 0.0)
    assert (box.low.tolist(), box.high.tolist(), box.top) == ([-35.0, 0.0], [5.0, 10.0], 15.0)
    assert box.near(VIEW).tolist() == [5.0, 10.0]  # seen from north-east
    assert box.far(VIEW).tolist() == [-35.0, 0.0]
    assert box.post(VIEW).tolist() == [-35.0, 10.0]  # east is on the left
    wide = box_around(10.0 * points, 0.0)
    assert np.max(wide.high - wide.low) / wide.step <= 11
    assert [marking(value) for value in (-5.0, -0.0, 10.0)] == ["−5", "0", "10"]


def test_docking_figure_takes_a_title(start):
    assert plot_docking(start, title="Figure 12").texts[0].get_text() == "Figure 12"
    assert plot_docking(start).texts[0].get_text() == start.attributes["scenario"]["title"]


def test_mesh_is_closed_of_the_hulls_size_and_turned_outward(flight):
    shape = take_snapshots(flight).shape
    mesh = ship_mesh(shape, rings=40, sectors=60)
    hull = mesh.faces[: -2 * len(shape.fins)]
    edges = np.concatenate([hull[:, [0, 1]], hull[:, [1, 2]], hull[:, [2, 0]]])
    assert len(np.unique(edges, axis=0)) == len(edges)  # each edge once in each direction: closed, one orientation
    assert {tuple(edge) for edge in edges} == {tuple(edge[::-1]) for edge in edges}
    a, b, c = (mesh.vertices[hull[:, i]] for i in range(3))
    volume = np.sum(a * np.cross(b, c)) / 6.0
    expected = -np.trapezoid(np.pi * shape.radius**2, shape.station)
    assert volume == pytest.approx(expected, rel=0.01)
    np.testing.assert_array_equal(mesh.vertices[-16:], shape.fins.reshape(-1, 3))


def test_histories_are_the_flights_with_every_peak(histories, flight):
    assert len(histories.to_json()) < 600_000
    tension = flight.data["tension"][:, 0].to_numpy()
    shown = trace(histories, "tension")
    assert len(shown.x) < 900 < len(tension)
    assert max(shown.y) == pytest.approx(tension.max(), rel=1e-3)
    index = int(tension.argmax())
    assert shown.x[int(np.argmax(shown.y))] == pytest.approx(float(flight.data["time"][index]), rel=1e-3)
    names = {"tension": "tension", "cable length": "cable_length", "rewind rate": "rewind_rate"}
    for name, output in {**names, "anchor to tether point": "distance"}.items():
        found = trace(histories, name)
        near = np.abs(flight.data["time"].to_numpy() - np.array(found.x)[:, None]) < 0.0126
        values = np.where(near, flight.data[output][:, 0].to_numpy(), np.nan)  # times are rounded, too
        assert np.all(found.y >= 0.999 * np.nanmin(values, axis=1))
        assert np.all(found.y <= 1.001 * np.nanmax(values, axis=1))
    assert min(trace(histories, "rewind rate").y) == pytest.approx(flight.metrics["rewind_rate_min"], rel=1e-3)


def test_histories_have_one_time_axis_limits_thrusters_and_gusts(histories, flight):
    names = [t.name for t in histories.data]
    assert "cable break 3040 N" in names
    assert trace(histories, "envelope tear 481 N").y == (481.0, 481.0)
    thrusters = [str(name).replace("_", " ") for name in flight.data["thruster"].to_numpy()]
    assert names[-len(thrusters) - 4 : -4] == thrusters
    axes = [histories.layout[name] for name in ("xaxis", "xaxis2", "xaxis3", "xaxis4")]
    assert {axis.matches for axis in axes if axis.matches} == {"x4"}
    assert histories.layout.yaxis.type == "log"
    gusts = [shape for shape in histories.layout.shapes if shape.type == "rect"]
    assert {(shape.x0, shape.x1) for shape in gusts} == {(20.0, 25.0)}


def test_two_cables_are_drawn_apart(start):
    double = start.data.isel(cable=[0, 0]).assign_coords(cable=["nose", "second"])

    def second(document):
        document["cables"].append({**document["cables"][0], "name": "second"})

    both = with_scenario(ts.Flight(double, start.outcome), second)
    plot = interactive_histories(both)
    first, second = trace(plot, "tension, nose"), trace(plot, "tension, second")
    assert first.line.color != second.line.color
    assert first.line.dash != second.line.dash
    axes = plot_comparison({"both": both}).axes[0]
    assert by_name(axes, "cable 1") is not by_name(axes, "cable 0")


def test_a_docking_of_the_study_is_drawn_explored_and_played(flight, tmp_path, is_whole):
    flight.save(flight_file(tmp_path, ("rewind", 12.0)))
    written = docking_pictures(tmp_path, Settings("consistent"))["files"]
    assert {file for file in written if "figure_12" in file} == {
        "figures/figure_12.png",
        "figures/figure_12.html",
        "figures/figure_12_histories.json",
        "figures/figure_12_histories.html",
    }
    assert [file for file in written if not is_whole(tmp_path / file)] == []
    assert "rewind control" in (tmp_path / "figures" / "figure_12.html").read_text(encoding="utf-8")


def test_flight_without_a_cable(hover):
    histories = interactive_histories(hover)
    assert all(isinstance(t, go.Scatter) for t in histories.data)
    assert len(histories.data) == hover.data.sizes["thruster"]
    assert len(plot_comparison({"hover": hover}).axes) == 1


def test_samples_are_the_nearest_and_the_last():
    time = np.array([0.0, 0.9, 1.2, 2.1, 2.9, 3.4])
    assert evenly(time, 1.0, 10).tolist() == [0, 1, 3, 4, 5]
    assert evenly(time, 1.0, 2).tolist() == [0, 3, 5]
    assert evenly(np.array([0.0]), 1.0, 10).tolist() == [0]


def test_peaks_are_kept():
    values = np.zeros((1000, 2))
    values[333, 0], values[777, 1] = 5.0, -5.0
    kept = with_peaks(values, 10)
    assert {0, 333, 777, 999} <= set(kept.tolist())
    assert len(kept) < 60
    assert with_peaks(values[:15], 10).tolist() == list(range(15))


def test_numbers_have_four_digits():
    assert listed(np.array([1.23456, -0.0, 123456.0, np.nan, np.inf])) == [1.235, 0.0, 123500.0, None, None]
    assert str(listed(np.array([-1e-30 * 0.0]))[0]) == "0.0"
