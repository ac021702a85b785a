"""Following eigenvalues, placing events, and drawing what was found.

Truth: eigenvalue paths made by hand, whose coalescence, splits and crossings are roots of a polynomial; and what the
drawing's own objects hold.
If this fails, two modes exchange their names along a sweep, a coalescence is told at the wrong wind, or a plot shows
other numbers or other units than the sweep has.
"""

import re

import numpy as np
import plotly.graph_objects as go
import pytest
from matplotlib.figure import Figure

import tethership as ts
from tethership.analysis.loci.locus_events import find_events
from tethership.analysis.loci.tracking import eigen_path, follow, named_order, partners_of
from tethership.analysis.modes.names import slots_of
from tethership.view.linear.interactive_locus import interactive_root_locus, write_page
from tethership.view.linear.mode_names import ANNOTATION
from tethership.view.linear.root_locus import SLOWEST, display

STATES = ("q", "u", "north")
"""In the order of their modes: pitch subsidence, surge, north."""
POINTS = np.linspace(0.0, 1.0, 41)
STEP = POINTS[1] - POINTS[0]
MERGE, BREAK = 0.3, 0.72
ELONGATIONS = (0.8, 0.95, 1.02)


def followed(matrices, states=STATES, valid=None):
    """Return λ of every track, shape (points, tracks)."""
    valid = np.ones(len(matrices), dtype=bool) if valid is None else valid
    path = eigen_path(np.asarray(matrices, dtype=float), valid)
    start = int(np.flatnonzero(valid)[0])
    orders = follow(path, start, named_order(path, start, states), states, slots_of(states))
    return np.take_along_axis(path.values, orders, axis=1)


def tracks(states=STATES):
    """Return the names of the tracks."""
    return [slot.name for slot in slots_of(states)]


def happenings(values, states=STATES, valid=None):
    """Return kind, tracks and parameter of every event."""
    valid = np.ones(len(values), dtype=bool) if valid is None else valid
    return [
        (event.kind, set(event.tracks), event.position * STEP) for event in find_events(values, valid, tracks(states))
    ]


def meeting(p):
    """Return a matrix with −4 and −1 ± √((p − 0.3)(p − 0.72)): a pair between 0.3 and 0.72."""
    return np.array([[-4.0, 0.0, 0.0], [0.0, -1.0, 1.0], [0.0, (p - MERGE) * (p - BREAK), -1.0]])


def passing(p, turn):
    """Return a matrix with −4, −1 + 0.9p and −0.37 − 0.11p in other coordinates: two cross at 0.63/1.01."""
    return turn @ np.diag([-4.0, -1.0 + 0.9 * p, -0.37 - 0.11 * p]) @ turn.T


CROSSING = 0.63 / 1.01


def test_coalescence_and_split_are_placed():
    found = happenings(followed([meeting(p) for p in POINTS]))
    assert [kind for kind, _, _ in found] == ["coalesce", "split"]
    assert all(who == {"surge", "north"} for _, who, _ in found)
    # the squared difference 4(p − 0.3)(p − 0.72) is taken as straight: h²/8 · 2 / 0.42 = 4e-4
    assert [place for _, _, place in found] == pytest.approx([MERGE, BREAK], abs=5e-4)


def test_eigenvalue_of_an_event():
    values = followed([meeting(p) for p in POINTS])
    first, second = find_events(values, np.ones(41, dtype=bool), tracks())
    for event in (first, second):
        assert event.eigenvalue == pytest.approx(-1.0, abs=1e-12)  # the pair's mean does not move


def test_a_pair_has_its_upper_member_in_the_earlier_track():
    values = followed([meeting(p) for p in POINTS])
    inside = (POINTS > MERGE) & (POINTS < BREAK)
    assert np.all(values[inside, 1].imag > 0)
    np.testing.assert_array_equal(values[inside, 2], values[inside, 1].conj())
    assert np.all(values[~inside].imag == 0)
    root = np.sqrt(np.abs((POINTS - MERGE) * (POINTS - BREAK)))
    # rounding of the squared difference, near its roots
    np.testing.assert_allclose(np.abs(values[:, 1] - values[:, 2]), 2.0 * root, atol=1e-7)


@pytest.mark.parametrize("seed", [None, 0, 1])
def test_real_modes_that_cross_keep_their_identity(seed):
    turn = np.eye(3) if seed is None else np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    values = followed([passing(p, turn) for p in POINTS])
    lines = np.array([-1.0 + 0.9 * POINTS, -0.37 - 0.11 * POINTS, np.full(41, -4.0)])
    for track in values.T:  # whatever it is called, each track is one of the lines all the way
        assert min(np.abs(track - line).max() for line in lines) < 1e-12
    found = [(kind, place) for kind, _, place in happenings(values)]
    assert found == [("cross", pytest.approx(CROSSING, abs=1e-9))]  # straight lines: interpolation is exact


def test_decoupled_modes_are_called_by_their_states():
    values = followed([passing(p, np.eye(3)) for p in POINTS])
    np.testing.assert_allclose(values[:, tracks().index("surge")], -1.0 + 0.9 * POINTS, atol=1e-14)
    np.testing.assert_allclose(values[:, tracks().index("north")], -0.37 - 0.11 * POINTS, atol=1e-14)
    assert happenings(values)[0][1] == {"surge", "north"}


def test_backwards_is_the_same():
    forward, backward = (followed([passing(p, np.eye(3)) for p in points]) for points in (POINTS, POINTS[::-1]))
    np.testing.assert_array_equal(backward[::-1], forward)


def test_a_gap_is_bridged():
    valid = np.ones(41, dtype=bool)
    valid[24:27] = False  # the crossing at 0.6238 is the point 24.95
    values = followed([passing(p, np.eye(3)) for p in POINTS], valid=valid)
    assert happenings(values, valid=valid) == [("cross", {"surge", "north"}, pytest.approx(CROSSING, abs=1e-9))]
    np.testing.assert_allclose(values[valid, 1], -1.0 + 0.9 * POINTS[valid], atol=1e-14)


def test_axis_passages():
    values = np.stack([np.full(41, -4.0), POINTS - 0.31, 0.21 - POINTS], axis=1).astype(complex)
    assert happenings(values) == [
        ("stable", {"north"}, pytest.approx(0.21, abs=1e-12)),  # straight lines
        ("cross", {"surge", "north"}, pytest.approx(0.26, abs=1e-12)),
        ("unstable", {"surge"}, pytest.approx(0.31, abs=1e-12)),
    ]


def test_a_pair_passes_the_axis_once():
    growth = POINTS - 0.61
    values = np.stack([np.full(41, -4.0), growth + 0.5j, growth - 0.5j], axis=1)
    assert happenings(values) == [("unstable", {"surge"}, pytest.approx(0.61, abs=1e-12))]


def test_nothing_happens_without_two_valid_points():
    values = np.stack([POINTS - 0.5, 0.5 - POINTS], axis=1).astype(complex)
    valid = np.zeros(41, dtype=bool)
    assert find_events(values, valid, ["a", "b"]) == []
    valid[3] = True
    assert find_events(values, valid, ["a", "b"]) == []


def test_partners():
    values = np.array([-1.0 + 2j, -3.0, -1.0 - 2j, 0.5 - 1j, 0.5 + 1j])
    np.testing.assert_array_equal(partners_of(values), [2, 1, 0, 4, 3])


def test_a_crossing_at_a_point_is_found():
    # λ₁ = λ₂ at p = 0.5, which is a point of the path: the product of neighbouring differences is zero, not negative
    values = np.stack([np.full(41, -4.0), POINTS - 2.5, -1.5 - POINTS], axis=1).astype(complex)
    values[20, 1] = values[20, 2]
    assert [(kind, place) for kind, _, place in happenings(values)] == [("cross", pytest.approx(0.5, abs=1e-9))]


def test_a_passage_of_the_axis_at_a_point_is_found():
    values = np.stack([np.full(41, -4.0), POINTS - 0.5, np.full(41, -3.0)], axis=1).astype(complex)
    values[20, 1] = 0.0
    assert [(kind, place) for kind, _, place in happenings(values)] == [("unstable", pytest.approx(0.5, abs=1e-9))]


def test_what_passes_zero_does_not_cross_the_null_modes():
    values = np.stack([np.zeros(41), POINTS - 0.505, np.zeros(41)], axis=1).astype(complex)
    assert [kind for kind, _, _ in happenings(values)] == ["unstable"]


def test_a_sign_of_rounding_is_no_passage():
    # undamped in still air: Re λ = −6e-33 at the first point, then damped; seen in an aerostat swept from no wind
    values = np.stack([np.full(41, -4.0), -POINTS + 0j, np.full(41, -3.0)], axis=1).astype(complex)
    values[0, 1] = 6e-33
    assert happenings(values) == []


def test_a_coalescence_at_a_point_is_placed_there():
    root = np.sqrt((0.5 - POINTS).astype(complex))
    root[20] = 0.0
    values = np.stack([np.full(41, -4.0), -1.0 + root, -1.0 - root], axis=1)
    # the squared difference is straight: half a step, 0.0125, is no accuracy
    assert [(kind, place) for kind, _, place in happenings(values)] == [("coalesce", pytest.approx(0.5, abs=1e-9))]


@pytest.mark.parametrize(
    ("name", "unit", "label", "shown", "factor"),
    [
        ("wind.speed", "m/s", "wind speed", "m/s", 1.0),
        ("trim.elevation", "rad", "trim elevation", "°", 180.0 / np.pi),
        ("trim.elongation", "1", "trim elongation", "", 1.0),
        ("cables.nose.diameter", "m", "cable nose diameter", "mm", 1e3),
        ("cables.*.diameter", "m", "cable diameter", "mm", 1e3),
        ("vehicle.hull.diameter", "m", "hull diameter", "m", 1.0),
        ("cables.nose.tether_point.0", "m", "cable nose tether point forward", "m", 1.0),
        ("vehicle.body.centre_of_gravity.2", "m", "body centre of gravity down", "m", 1.0),
        ("vehicle.body.inertia.0.2", "kg m^2", "body inertia 0 2", "kg m^2", 1.0),
    ],
)
def test_display(name, unit, label, shown, factor):
    text, its_unit, times = display(name, unit)
    assert (text, its_unit, times) == (label, shown, factor)


@pytest.fixture(scope="module")
def found(docking):
    """Return a sweep whose last point needs more thrust than there is."""
    return ts.sweep(docking, {"wind.speed": [6.0] * 3, "trim.elongation": ELONGATIONS})


@pytest.fixture(scope="module")
def free():
    hover = ts.load_scenario("hover")
    return ts.linearize(hover, ts.trim(hover)).modes()


def test_it_draws_where_it_is_told(found):
    axes = Figure().subplots()
    assert ts.plot_root_locus(found, axes, parameter="trim.elongation") is axes
    assert axes.get_xlabel() == "Re λ [1/s]"
    assert axes.get_ylabel() == "Im λ [rad/s]"
    bar = next(other for other in axes.figure.axes if other is not axes)
    assert bar.get_ylabel() == "trim elongation"
    assert bar.get_ylim() == (0.8, 1.02)


def test_the_bar_has_the_unit(found):
    axes = ts.plot_root_locus(found)
    bar = next(other for other in axes.figure.axes if other is not axes)
    assert bar.get_ylabel() == "wind speed [m/s]"


def test_dots_are_the_eigenvalues(found):
    axes = ts.plot_root_locus(found, parameter="trim.elongation")
    drawn = np.concatenate([np.asarray(dots.get_offsets()) for dots in axes.collections if len(dots.get_offsets())])
    expected = found.eigenvalues[:2]  # the third point has no trim
    assert len(drawn) == expected.size
    np.testing.assert_array_equal(
        np.sort_complex(drawn[:, 0] + 1j * drawn[:, 1]), np.sort_complex(np.asarray(expected).ravel())
    )
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    assert left < expected.real.min()
    assert right > expected.real.max()
    assert low < expected.imag.min()
    assert high > expected.imag.max()


def test_missing_points_are_told(found):
    legend = ts.plot_root_locus(found, parameter="trim.elongation").get_legend()
    assert [text.get_text() for text in legend.get_texts()] == ["1 of 3 points: no trim"]


def test_modes_are_named(found):
    axes = ts.plot_root_locus(found, parameter="trim.elongation")
    written = {text.get_text() for text in axes.texts}
    assert {"pendulum", "surge–north", "heading–east", "roll oscillation", "vertical"} <= written


def test_slow_shows_the_slow_ones(found):
    axes = ts.plot_root_locus(found, parameter="trim.elongation", slow=True)
    assert axes.get_xlim()[0] > -0.6  # 0.4 1/s and margins
    written = {text.get_text() for text in axes.texts}
    assert "pendulum" in written
    assert "roll oscillation" not in written


def test_reference_and_free_ship_are_marked(found, free):
    axes = ts.plot_root_locus(found, parameter="trim.elongation", star=0, free=free)
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert texts == ["reference", "untethered, 12 states", "1 of 3 points: no trim"]
    stars = next(line for line in axes.lines if line.get_marker() == "*")
    np.testing.assert_array_equal(stars.get_xdata(), [found.track(name)[0].real for name in found.tracks])
    circles = next(line for line in axes.lines if line.get_marker() == "o")
    np.testing.assert_array_equal(circles.get_xdata(), free.eigenvalues.real)


def test_a_reference_that_cannot_be_trimmed_is_not_marked(found):
    axes = ts.plot_root_locus(found, parameter="trim.elongation", star=2)
    assert [text.get_text() for text in axes.get_legend().get_texts()] == ["1 of 3 points: no trim"]


def test_every_mode_is_named_beside_its_track(found):
    """Without hovering, which a finger and a print cannot; the slow ones where they are drawn larger."""
    figure = interactive_root_locus(found)
    names = [note for note in figure.layout.annotations if note.name == ANNOTATION]
    middle = int(np.flatnonzero(found.trimmed)[found.trimmed.sum() // 2])
    roots = {note.text: complex(note.x, note.y) for note in names}
    named = [(n, found.track(t)[middle]) for n, t in zip(found.names_at(middle), found.tracks, strict=True)]
    upper = {name: root for name, root in named if root.imag >= 0}
    assert roots.keys() == upper.keys() == set(found.names_at(middle))
    assert len(names) == len(roots)
    for note in names:
        assert roots[note.text] == pytest.approx(upper[note.text], abs=1e-12)
        assert note.xref == ("x2" if abs(roots[note.text]) < SLOWEST else "x")
    explained = [trace.name for trace in figure.data if trace.showlegend]
    assert explained == ["reference"]


def test_hover_tells_parameter_eigenvalue_and_mode(found):
    figure = interactive_root_locus(found, "Title of mine", parameter="trim.elongation")
    assert isinstance(figure, go.Figure)
    assert figure.layout.title.text == "Title of mine"
    titles = [note.text for note in figure.layout.annotations if note.name != ANNOTATION]
    assert titles == ["all modes", "slow modes"]
    panel = [trace for trace in figure.data if trace.xaxis == "x"]  # the second one has the same data, zoomed
    assert len(figure.data) == 2 * len(panel)
    traces = {trace.name: trace for trace in panel}
    star = traces.pop("reference")  # the scenario's own elongation is among the points
    assert sorted(star.x) == pytest.approx(sorted(found.eigenvalues[0].real), rel=1e-12)
    assert set(traces) == set(found.tracks)
    names = [found.names_at(point) for point in (0, 1)]
    for index, track in enumerate(found.tracks):
        trace = traces[track]
        np.testing.assert_array_equal(np.asarray(trace.x) + 1j * np.asarray(trace.y), found.track(track)[:2])
        np.testing.assert_array_equal(trace.marker.color, ELONGATIONS[:2])
        for point, (mode, note, value, whose) in enumerate(trace.customdata):
            assert (mode, whose) == (names[point][index], track)
            assert note == f"wind speed = 6 m/s<br>trim elongation = {ELONGATIONS[point]:g}"
            root = complex(value.replace(" ", "").replace("i", "j"))
            assert root == pytest.approx(found.track(track)[point], abs=1e-5)  # five decimals are shown
        assert all(f"customdata[{i}]" in trace.hovertemplate for i in range(4))
    assert {"pendulum", "surge–north"} <= {row[0] for trace in traces.values() for row in trace.customdata}


def test_the_page_needs_no_network(found, tmp_path):
    write_page(interactive_root_locus(found), tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text(encoding="utf-8")
    assert re.match(r"(<!doctype html>\s*)?<html>", page)
    assert not re.search(r"<script[^>]*\ssrc\s*=", page)
    assert not re.search(r"<link[^>]*\shref\s*=", page)
    assert len(page) > 1_000_000  # plotly's own program is inside
    assert "surge\\u2013north" in page
    (tmp_path / "file").write_text("")
    with pytest.raises(ts.ConfigError, match=r"cannot write .*; choose another folder with --out"):
        write_page(interactive_root_locus(found), tmp_path / "file" / "page.html")


def test_the_paper_has_no_other_root_loci():
    with pytest.raises(ts.ConfigError, match=r"no root locus in figure 12; give one of 6, 7, 8, 9, 10, 11 \(12 to 15"):
        ts.linear_figure(12)
