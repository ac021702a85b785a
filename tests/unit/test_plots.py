"""The docking figure shows the flight's own numbers, the right way round, and can be read."""

import copy
import dataclasses
import io
import itertools
import json
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

import tethership as ts
from tethership.errors import SolveError
from tethership.scenario import VehicleConfig
from tethership.view import plot_docking
from tethership.view.flight.captions import compass
from tethership.view.flight.histories import spread
from tethership.view.flight.projection import FROM_EAST, FROM_NORTH, FROM_TOP
from tethership.view.flight.ship import ship_outlines, ship_shape, silhouette
from tethership.view.flight.snapshots import snapshot_indices, snapshot_interval, take_snapshots

CHANGES = {"stop.time_limit": 5.0, "gusts.0.start": 1.0, "gusts.0.period": 2.0}
VIEWS = {0: FROM_NORTH, 1: FROM_EAST, 2: FROM_TOP}
ORIGIN = np.zeros(3)


@pytest.fixture(scope="module")
def flight():
    scenario = ts.load_scenario("docking", CHANGES)
    return ts.dock(scenario, ts.trim(scenario), layers=["rewind"])


@pytest.fixture(scope="module")
def figure(flight):
    return plot_docking(flight)


@pytest.fixture(scope="module")
def vehicle(flight):
    return flight.attributes["scenario"]["vehicle"]


@pytest.fixture(scope="module")
def shape(vehicle):
    return ship_shape(VehicleConfig.model_validate(vehicle))


def with_scenario(flight, change):
    """Return the flight with its stored scenario changed in place by a function."""
    document = copy.deepcopy(flight.attributes["scenario"])
    change(document)
    data = flight.data.assign_attrs(scenario=json.dumps(document))
    return ts.Flight(data, flight.outcome)


def by_name(axes, name):
    """Return the one artist with an identifier."""
    (artist,) = [artist for artist in axes.get_children() if artist.get_gid() == name]
    return artist


def turned(roll=0.0, pitch=0.0, yaw=0.0):
    """Return body to ground, by three elementary rotations [rad]."""

    def about(axis, angle):
        i, j = [(1, 2), (2, 0), (0, 1)][axis]
        matrix = np.eye(3)
        matrix[i, i] = matrix[j, j] = np.cos(angle)
        matrix[j, i], matrix[i, j] = np.sin(angle), -np.sin(angle)
        return matrix

    return about(2, yaw) @ about(1, pitch) @ about(0, roll)


def test_six_axes_in_four_panels(figure):
    titles = [axes.get_title(loc="left") for axes in figure.axes]
    assert len(titles) == 6
    assert [title.split(" (")[0] for title in titles if title] == [
        "View from north",
        "View from east",
        "View from top",
        "Time histories",
    ]
    north, east, top, *histories = (axes.get_position() for axes in figure.axes)
    assert north.x1 < east.x0  # two above, and below them the histories left of the view from top
    assert (north.y0, north.y1) == pytest.approx((east.y0, east.y1))
    assert top.y1 < east.y0
    assert all(one.y1 < north.y0 and one.x1 < top.x0 for one in histories)
    assert all(upper.y0 > lower.y1 for upper, lower in itertools.pairwise(histories))
    assert figure.axes[3].get_shared_x_axes().joined(figure.axes[3], figure.axes[5])


def test_title_says_what_was_flown(figure):
    text = " ".join(text.get_text() for text in figure.texts)
    for part in ("Docking with", "6 m/s from N", "gust from W", "rewind", "consistent", "time limit after 5.0 s"):
        assert part in text


@pytest.mark.parametrize(("axes", "name"), [(3, "cable_length"), (3, "distance"), (4, "tension"), (5, "rewind_rate")])
def test_histories_are_the_flights_numbers(figure, flight, axes, name):
    time, value = by_name(figure.axes[axes], f"{name} 0").get_data()
    np.testing.assert_array_equal(time, flight.data["time"])
    np.testing.assert_array_equal(value, flight.data[name][:, 0])
    low, high = figure.axes[axes].get_ylim()
    assert low <= value.min()
    assert value.max() <= high


def test_dots_stand_at_the_snapshots(figure, flight):
    dots = by_name(figure.axes[4], "tension 0").get_markevery()
    np.testing.assert_allclose(flight.data["time"].to_numpy()[dots], [0.0, 4.0, 5.0], atol=0.05)


def test_watched_tensions_are_drawn_and_named(figure, flight):
    axes = figure.axes[4]
    names = ["control_threshold", "envelope_tear", "envelope_tensile", "cable_break"]
    drawn = [by_name(axes, name).get_ydata()[0] for name in names]
    assert drawn == flight.attributes["limits"] == [144.3, 481.0, 2354.0, 3040.0]
    labels = [text.get_text() for text in axes.texts]
    assert labels == ["control threshold 144.3", "envelope tear 481", "envelope tensile 2354", "cable break 3040"]


@pytest.mark.parametrize("axes", [3, 4, 5])
def test_gust_is_shaded_and_does_not_widen_the_time_axis(figure, axes):
    shade = by_name(figure.axes[axes], "gust").get_extents()
    low, high = figure.axes[axes].transData.inverted().transform(shade)[:, 0]
    assert (low, high) == pytest.approx((1.0, 3.0))
    assert figure.axes[axes].get_xlim() == pytest.approx((0.0, 5.0))


def test_gust_in_another_unit_is_shaded_at_the_same_time(flight):
    def minutes(document):
        document["gusts"][0]["start"] = {"value": 1.0 / 60.0, "unit": "min"}

    axes = plot_docking(with_scenario(flight, minutes)).axes[4]
    shade = axes.transData.inverted().transform(by_name(axes, "gust").get_extents())
    assert shade[:, 0] == pytest.approx((1.0, 3.0))


@pytest.mark.parametrize(("axes", "view"), VIEWS.items())
def test_cables_are_the_flights_curves(figure, flight, axes, view):
    segments = by_name(figure.axes[axes], "cable 0").get_segments()
    north, east, down = flight.data["cable_curve"][:, 0].to_numpy().T
    across, up = {0: (east, -down), 1: (north, -down), 2: (east, north)}[axes]
    assert len(segments) == 3
    four_seconds = int(np.abs(flight.data["time"].to_numpy() - 4.0).argmin())
    for segment, index in zip(segments, (0, four_seconds, -1), strict=True):
        np.testing.assert_array_equal(segment, np.stack([across[:, index], up[:, index]], axis=1))
    anchor = by_name(figure.axes[axes], "anchor").get_xydata()[0]
    np.testing.assert_allclose(anchor, [0.0, 0.0], atol=1e-12)
    assert view.shows_altitude == (axes != 2)


@pytest.mark.parametrize("axes", VIEWS)
def test_path_is_that_of_the_centre_of_buoyancy(figure, flight, axes):
    north, east, down = flight.data["position"].to_numpy().T  # Lotte's reference point is B
    across, up = {0: (east, -down), 1: (north, -down), 2: (east, north)}[axes]
    drawn = by_name(figure.axes[axes], "path").get_data()
    np.testing.assert_allclose(drawn, [across, up], atol=1e-12)


def test_path_follows_a_centre_away_from_the_reference_point(flight):
    def moved(document):
        document["vehicle"]["buoyancy"]["centre"]["value"] = [1.0, 2.0, 3.0]

    snapshots = take_snapshots(with_scenario(flight, moved))
    rotation = turned(*flight.data["attitude"].to_numpy()[0])
    expected = flight.data["position"].to_numpy()[0] + rotation @ [1.0, 2.0, 3.0]
    np.testing.assert_allclose(snapshots.path[0], expected, atol=1e-12)
    np.testing.assert_allclose(snapshots.rotations[0], rotation, atol=1e-12)


def test_directions_on_paper(figure):
    def place(axes, across, up):
        return figure.axes[axes].transData.transform((across, up))

    assert place(0, 1.0, 0.0)[0] < place(0, 0.0, 0.0)[0]  # from north, east is on the left
    assert place(1, 1.0, 0.0)[0] > place(1, 0.0, 0.0)[0]  # from east, north is on the right
    assert place(2, 1.0, 0.0)[0] > place(2, 0.0, 0.0)[0]  # from top, east is on the right
    assert all(place(axes, 0.0, 1.0)[1] > place(axes, 0.0, 0.0)[1] for axes in VIEWS)
    for view in VIEWS.values():  # horizontal, vertical and line of sight are right-handed as seen on paper
        rightward = -view.plane[0] if view.leftward else view.plane[0]
        np.testing.assert_allclose(np.cross(rightward, view.plane[1]), view.toward)


@pytest.mark.parametrize("axes", VIEWS)
def test_scales_are_equal_and_everything_is_inside(figure, axes):
    axes = figure.axes[axes]
    figure.draw_without_rendering()
    unit = axes.transData.transform([(0, 0), (1, 0), (0, 1)])
    assert abs(unit[1, 0] - unit[0, 0]) == pytest.approx(unit[2, 1] - unit[0, 1], rel=1e-6)
    points = [path.vertices for path in by_name(axes, "ships").get_paths()]
    points += by_name(axes, "cable 0").get_segments()
    inside = axes.bbox.get_points()
    drawn = axes.transData.transform(np.concatenate(points))
    assert np.all((drawn >= inside[0]) & (drawn <= inside[1]))


def test_ground_is_at_the_anchor_without_a_mast_and_below_it_with_one(figure, flight):
    assert by_name(figure.axes[1], "ground").get_ydata()[0] == 0.0

    def mast(document):
        document["ground"] = {"anchor_height": {"value": 4.0, "unit": "m"}}

    raised = plot_docking(with_scenario(flight, mast))
    assert by_name(raised.axes[0], "ground").get_ydata()[0] == -4.0
    assert not [artist for artist in raised.axes[2].get_children() if artist.get_gid() == "ground"]


def test_start_is_green_end_is_red_and_both_are_painted_last(figure):
    ships = by_name(figure.axes[1], "ships")
    assert isinstance(ships, PolyCollection)
    red, green, blue = ships.get_edgecolor()[:, :3].T
    parts = 5  # hull and four fins
    assert len(red) == 3 * parts
    assert np.ptp([red[:parts], green[:parts], blue[:parts]]) == 0.0
    assert np.all(green[parts : 2 * parts] > red[parts : 2 * parts])
    assert np.all(red[2 * parts :] > green[2 * parts :])


def test_level_ship_points_north_with_its_fins_aft(shape):
    outlines = ship_outlines(shape, ORIGIN, np.eye(3), FROM_EAST)
    hull = max(outlines, key=len)
    assert len(outlines) == 5
    assert hull[:, 0].max() == pytest.approx(6.9702, abs=1e-3)  # nose; the notes and the paper's tether point 6.97 m
    assert hull[:, 0].min() == pytest.approx(6.9702 - 16.0, abs=1e-3)
    assert hull[:, 1].max() == pytest.approx(0.5 * 3.98432, rel=2e-3)
    fins = np.concatenate([outline for outline in outlines if outline is not hull])
    assert fins[:, 0].max() < -4.0
    assert fins[:, 0].min() > hull[:, 0].min()


def test_nose_up_and_turned_east_the_ship_stands_on_its_tail(shape):
    rotation = turned(pitch=0.5 * np.pi, yaw=0.5 * np.pi)
    outlines = ship_outlines(shape, np.array([10.0, 20.0, -30.0]), rotation, FROM_NORTH)
    hull = max(outlines, key=len)
    assert hull[:, 1].max() == pytest.approx(30.0 + 6.9702, abs=1e-3)
    assert hull[:, 0].mean() == pytest.approx(20.0)
    fins = np.array([outline for outline in outlines if outline is not hull])
    assert fins[..., 1].max() < 30.0 - 4.0
    assert fins[..., 0].mean() == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("wind", "arrows"),
    [
        ([-6.0, 0.0, 0.0], [None, (-1, 0), (0, -1)]),  # from north
        ([0.0, 6.0, 0.0], [(-1, 0), None, (1, 0)]),  # from west
        ([0.0, 0.0, 0.0], [None, None, None]),
    ],
)
def test_wind_arrows_point_where_the_air_goes(flight, wind, arrows):
    data = flight.data.assign(wind=flight.data["wind"] * 0.0 + xr.DataArray(wind, dims="ground_axis"))
    figure = plot_docking(ts.Flight(data, flight.outcome))
    for axes, arrow in zip(figure.axes[:3], arrows, strict=True):
        found = [text for text in axes.texts if text.get_gid() == "wind"]
        assert len(found) == (arrow is not None)
        for text in found:
            tail = np.array(text.xyann)
            np.testing.assert_allclose(-tail / np.linalg.norm(tail), arrow, atol=1e-9)


def test_fins_have_the_area_and_the_places_of_the_file(shape):
    root_ahead, tip_ahead, tip_aft, root_aft = np.moveaxis(shape.fins, 1, 0)
    area = 0.5 * np.linalg.norm(np.cross(tip_aft - root_ahead, root_aft - tip_ahead), axis=1)
    np.testing.assert_allclose(area, 2.88)
    middle = shape.fins.mean(axis=1)
    outward = [[0, 1, 0], [0, 0, 1], [0, -1, 0], [0, 0, -1]]  # starboard, bottom, port, top
    np.testing.assert_allclose(middle[:, 1:], 1.6 * np.array(outward)[:, 1:], atol=1e-12)


def test_side_view_is_the_profile(shape):
    outline = silhouette(shape, ORIGIN, np.eye(3), FROM_EAST)
    half = outline[: len(outline) // 2]
    expected = np.interp(half[:, 0], shape.station[::-1], shape.radius[::-1])
    np.testing.assert_allclose(half[:, 1], expected, atol=1e-9)


def test_seen_on_the_nose_the_hull_is_its_largest_circle(shape):
    outline = silhouette(shape, ORIGIN, np.eye(3), FROM_NORTH)
    np.testing.assert_allclose(np.linalg.norm(outline, axis=1), shape.radius.max(), rtol=1e-3)


@pytest.mark.parametrize("yaw", [0.02, 0.3, 0.9, 1.4])
def test_ellipsoid_is_seen_as_the_ellipse_of_analytic_geometry(vehicle, yaw):
    hull = {key: vehicle["hull"][key] for key in ("length", "diameter")}
    volume = {"value": np.pi / 6.0 * 16.0 * 3.98432**2, "unit": "m^3", "source": "geometry"}
    own = {"hull": {"profile": "ellipsoid", **hull}, "buoyancy": {**vehicle["buoyancy"], "volume": volume}}
    config = VehicleConfig.model_validate({**vehicle, **own})
    outline = silhouette(ship_shape(config), ORIGIN, turned(yaw=yaw), FROM_NORTH)
    long, short = 8.0, 0.5 * 3.98432
    along = np.hypot(long * np.sin(yaw), short * np.cos(yaw))
    assert outline[:, 0].max() == pytest.approx(along, rel=1e-3)
    np.testing.assert_allclose((outline[:, 0] / along) ** 2 + (outline[:, 1] / short) ** 2, 1.0, atol=5e-3)


def test_hull_by_its_shape_parameters_has_their_volume(vehicle):
    numbers = {"largest_section": 0.45, "nose_radius": 0.58, "tail_radius": 0.1, "prismatic_coefficient": 0.55}
    hull = {key: vehicle["hull"][key] for key in ("length", "diameter")}
    hull |= {key: {"value": value, "unit": "1", "source": "test"} for key, value in numbers.items()}
    shape = ship_shape(VehicleConfig.model_validate({**vehicle, "hull": {"profile": "gertler_shape", **hull}}))
    volume = -np.trapezoid(np.pi * shape.radius**2, shape.station)
    assert volume == pytest.approx(0.55 * 0.25 * np.pi * 3.98432**2 * 16.0, rel=1e-3)


def test_fins_towards_the_viewer_are_painted_over_the_hull(shape):
    bottom = ship_outlines(shape, ORIGIN, np.eye(3), FROM_TOP)
    hull = int(np.argmax([len(outline) for outline in bottom]))
    assert np.ptp(bottom[-1][:, 0]) < 1e-9  # the top fin, seen edge on, comes last
    assert 1 <= hull <= 3  # the bottom fin comes before it
    ahead = ship_outlines(shape, ORIGIN, np.eye(3), FROM_NORTH)
    assert len(ahead[-1]) > 4  # seen on the nose all fins are behind the hull
    aft = ship_outlines(shape, ORIGIN, turned(yaw=np.pi), FROM_NORTH)
    assert len(aft[0]) > 4  # seen from behind all fins are ahead of it


def test_flight_without_a_cable():
    scenario = ts.load_scenario("hover", {"stop.time_limit": 2.0})
    flight = ts.dock(scenario, ts.trim(scenario), layers=())
    figure = plot_docking(flight)
    assert len(figure.axes) == 6
    assert not figure.findobj(LineCollection)
    assert [axes.texts[0].get_text() for axes in figure.axes[3:]] == ["no cable"] * 3
    assert save(figure, "png")


def test_two_cables_have_their_own_curves_and_colours(flight):
    def second(document):
        document["cables"].append({**document["cables"][0], "name": "second"})

    drawn = with_scenario(flight, second)
    per_cable = [name for name, value in drawn.data.items() if "cable" in value.dims]
    double = 2.0 * drawn.data[per_cable].assign_coords(cable=["second"])
    both = xr.concat([drawn.data[per_cable], double], dim="cable")
    data = drawn.data.drop_vars(per_cable).drop_vars("cable").merge(both).assign_attrs(drawn.data.attrs)
    figure = plot_docking(dataclasses.replace(drawn, data=data))
    lines = [by_name(figure.axes[4], f"tension {i}") for i in range(2)]
    np.testing.assert_array_equal(lines[1].get_ydata(), 2.0 * lines[0].get_ydata())
    assert lines[0].get_color() != lines[1].get_color()
    assert {artist.get_gid() for artist in figure.axes[2].findobj(LineCollection)} == {"cable 0", "cable 1"}
    assert "cable second" in [text.get_text() for text in figure.legends[0].get_texts()]


def save(figure, kind):
    """Return a figure's file."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format=kind, dpi=60)
    return buffer.getvalue()


@pytest.mark.parametrize(("kind", "head"), [("png", b"\x89PNG"), ("pdf", b"%PDF"), ("svg", b"<?xml")])
def test_figure_is_saved_to_a_buffer(figure, kind, head):
    assert save(figure, kind).startswith(head)


def test_nothing_written_is_clipped_or_overlaps(figure):
    renderer = FigureCanvasAgg(figure).get_renderer()
    figure.draw(renderer)
    texts = [*figure.texts, *figure.legends[0].get_texts()]
    for axes in figure.axes:
        texts += [axes.xaxis.label, axes.yaxis.label, axes.title, axes._left_title, *axes.texts]
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            texts += [tick.label1 for tick in axis.get_major_ticks() if low <= tick.get_loc() <= high]
        legend = axes.get_legend()
        texts += legend.get_texts() if legend else []
    boxes = [(t.get_text(), t.get_window_extent(renderer)) for t in texts if t.get_text() and t.get_visible()]
    assert len(boxes) > 50
    for i, (name, box) in enumerate(boxes):
        assert figure.bbox.x0 <= box.x0 < box.x1 <= figure.bbox.x1, name
        assert figure.bbox.y0 <= box.y0 < box.y1 <= figure.bbox.y1, name
        for other, other_box in boxes[i + 1 :]:
            apart = box.x1 <= other_box.x0 or other_box.x1 <= box.x0 or box.y1 <= other_box.y0 or other_box.y1 <= box.y0
            assert apart, f"{name!r} overlaps {other!r}"


def test_a_given_figure_is_cleared_and_drawn_into(flight):
    given = Figure(figsize=(12.0, 9.0))
    given.add_subplot().plot([0.0, 1.0])
    assert plot_docking(flight, given) is given
    assert len(given.axes) == 6
    assert tuple(given.get_size_inches()) == (12.0, 9.0)


def test_one_sample_is_drawn_and_none_is_an_error(flight):
    assert len(plot_docking(ts.Flight(flight.data.isel(time=slice(0, 1)), flight.outcome)).axes) == 6
    with pytest.raises(SolveError, match="no sample to draw"):
        plot_docking(ts.Flight(flight.data.isel(time=slice(0, 0)), flight.outcome))


def test_snapshots_stand_every_four_seconds_and_at_the_end():
    time = np.append(np.arange(0.0, 63.0, 0.025), 63.01)
    found = time[snapshot_indices(time, 4.0)]
    np.testing.assert_allclose(found, [*np.arange(0.0, 61.0, 4.0), 63.01], atol=1e-9)
    assert snapshot_interval(63.0) == 4.0
    assert snapshot_interval(200.0) == 8.0


def test_points_of_the_compass():
    degrees = [0.0, 270.0, -60.0, 359.0, 135.0]
    assert [compass(np.radians(angle)) for angle in degrees] == ["N", "W", "WNW", "N", "SE"]


def test_labels_are_moved_apart_only_where_they_must():
    moved = spread(np.array([0.1, 0.5, 0.9, 0.92]), 0.1)
    np.testing.assert_allclose(moved, [0.1, 0.5, 0.86, 0.96])


def test_drawing_needs_no_pyplot():
    code = "import sys, tethership.view; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
