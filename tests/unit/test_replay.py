"""The replay's data: geometry, axes, thrust and gust against the flight, peaks kept, size, clean JSON, wrong input.

If one of these failed, the page would show another flight than the file holds.
"""

import base64
import dataclasses
import json
import re
import webbrowser

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import tethership as ts
from tethership.cli.view import view
from tethership.scenario import ScenarioConfig
from tethership.scenario.load import from_document, validated
from tethership.spatial import rotation_matrix
from tethership.view.flight.ship import ship_shape
from tethership.view.replay.derived import quaternions, rotations, thrusts
from tethership.view.replay.page import replay_page
from tethership.view.replay.scene import scene
from tethership.view.replay.tracks import BUDGET, chosen, tracks


@pytest.fixture(scope="module")
def windy():
    """A flight in 12 m/s, whose tension has narrow peaks, cut after the gust."""
    scenario = ts.load_scenario("docking", {"wind.speed": 12.0, "stop.time_limit": 30.0})
    return ts.dock(scenario, ts.trim(scenario), ["rewind", "heading"])


@pytest.fixture(scope="module")
def shown(windy):
    return scene(windy, "windy")


def unpacked(shown, name):
    """Return a track of a scene."""
    track = shown["tracks"][name]
    return np.frombuffer(base64.b64decode(track["data"]), dtype="<f4").reshape(-1, track["width"])


def config_of(flight):
    return validated(ScenarioConfig, flight.attributes["scenario"], flight.attributes["scenario_name"])


def without(flight, *names):
    """Return a flight whose file lacks some outputs."""
    return dataclasses.replace(flight, data=flight.data.drop_vars(names))


def test_peaks_of_tension_are_kept(windy, shown):
    tension = windy.data["tension"].to_numpy()
    kept = unpacked(shown, "tension")
    assert len(kept) < 0.6 * len(tension)
    assert kept.max() == np.float32(tension.max())
    peaks = [i for i in range(1, len(tension) - 1) if tension[i - 1, 0] < tension[i, 0] > tension[i + 1, 0]]
    assert set(np.float32(tension[peaks, 0])) <= set(kept[:, 0].tolist())


def test_samples_rise_and_hold_both_ends(windy, shown):
    time = unpacked(shown, "time")[:, 0]
    assert np.all(np.diff(time) > 0)
    assert np.diff(time).max() < 0.05
    assert time[0] == 0.0
    assert time[-1] == np.float32(windy.data["time"][-1])


def test_a_long_flight_keeps_to_its_budget(windy):
    longer = windy.data.isel(time=np.tile(np.arange(2000), 10)).assign_coords(time=np.arange(20_000) * 0.0125)
    assert 500 < len(chosen(longer)) < BUDGET / (4 * 4 / 3 * 60)


def test_quaternions_turn_as_the_matrix_of_the_flight_does():
    angles = np.random.default_rng(1).uniform([-3, -1.5, -9], [3, 1.5, 9], (50, 3))
    turned = rotations(angles)
    np.testing.assert_allclose(turned.as_matrix(), [rotation_matrix(one) for one in angles], atol=1e-12)
    x, y, z, w = quaternions(turned).T
    np.testing.assert_allclose(2 * (x * z - w * y), -np.sin(angles[:, 1]), atol=1e-12)  # the third row of R


def test_quaternions_do_not_jump():
    yaw = np.linspace(0.0, 12.0, 400)
    unit = quaternions(rotations(np.stack([0 * yaw, 0 * yaw, yaw], axis=1)))
    assert np.abs(np.diff(unit, axis=0)).max() < 0.02


def test_thrust_of_all_thrusters_is_the_recorded_load(windy, shown):
    ship = shown["ship"]["thrusters"]
    directions = np.array([one["direction"] for one in ship])
    places = np.array([one["position"] for one in ship])
    thrust = thrusts(windy.data, config_of(windy))
    load = {name: windy.data[name].sel(load="thrust").to_numpy() for name in ("load_force", "load_moment")}
    np.testing.assert_allclose(thrust @ directions, load["load_force"], atol=1e-9)
    np.testing.assert_allclose(thrust @ np.cross(places, directions), load["load_moment"], atol=1e-8)


def test_thrust_falls_with_airspeed_as_the_load_does():
    changes = {"vehicle": "lotte", "stop.time_limit": 3.0, "wind.speed": 9.0}
    scenario = ts.load_scenario("docking", changes)
    vehicle = scenario.document["vehicle"]
    for one in vehicle["thrusters"]:
        one["speed_of_no_thrust"] = {"value": 30.0, "unit": "m/s", "source": "assumed: test"}
    slower = from_document(scenario.document, "slower")
    flight = ts.dock(slower, ts.trim(slower))
    thrust = thrusts(flight.data, config_of(flight))
    directions = np.array([one.direction for one in config_of(flight).vehicle.thrusters])
    recorded = flight.data["load_force"].sel(load="thrust").to_numpy()
    np.testing.assert_allclose(thrust @ directions, recorded, atol=1e-9)
    throttle = flight.data["throttle"].to_numpy()
    assert np.abs(thrust / (120.0 * throttle) - 1.0).max() > 0.1  # it is not the throttle alone


def test_gust_is_what_the_scenario_adds_to_the_wind(shown):
    time, gust = unpacked(shown, "time")[:, 0], unpacked(shown, "gust")
    expected = np.where((time > 20) & (time < 25), 0.5 * 4.0 * (1 - np.cos(2 * np.pi * (time - 20) / 5)), 0.0)
    np.testing.assert_allclose(gust[:, 1], expected, atol=1e-4)  # from the west: the air goes east
    np.testing.assert_allclose(unpacked(shown, "wind")[:, 0], -12.0, atol=1e-5)  # from the north: it goes south


def test_ship_is_that_of_the_vehicle(windy, shown):
    shape = ship_shape(config_of(windy).vehicle)
    vertices = np.frombuffer(base64.b64decode(shown["ship"]["vertices"]), dtype="<f4").reshape(-1, 3)
    faces = np.frombuffer(base64.b64decode(shown["ship"]["faces"]), dtype="<u2")
    assert faces.max() == len(vertices) - 1
    np.testing.assert_allclose(vertices[-16:], shape.fins.reshape(-1, 3), atol=1e-6)
    hull = vertices[:-16] - shape.axis
    np.testing.assert_allclose([hull[:, 0].max(), hull[:, 0].min()], shape.station[[0, -1]], atol=1e-5)
    radius = np.hypot(hull[:, 1], hull[:, 2])
    np.testing.assert_allclose(radius, np.interp(hull[:, 0], shape.station[::-1], shape.radius[::-1]), atol=2e-3)
    np.testing.assert_allclose(shown["ship"]["nose"], config_of(windy).cables[0].tether_point, atol=0.01)


def test_cable_ends_at_anchor_and_nose(windy, shown):
    curve, position, quaternion = (unpacked(shown, name) for name in ("cable_curve", "position", "quaternion"))
    nose = position + Rotation.from_quat(quaternion).apply(shown["cables"][0]["tether_point"])
    np.testing.assert_allclose(curve[:, -3:], nose, atol=1e-4)
    np.testing.assert_allclose(curve[:, :3], 0.0, atol=1e-6)


def test_page_is_small_clean_and_alone(windy, shown, tmp_path):
    page = ts.write_replay({"first": windy, "second": windy}, tmp_path / "deep" / "two.html")
    text = page.read_text(encoding="utf-8")
    assert len(text.encode()) < 5e6
    data = json.loads(re.search(r'id="flights">(.*?)</script>', text, re.DOTALL).group(1), parse_constant=pytest.fail)
    assert [flight["name"] for flight in data["flights"]] == ["first", "second"]
    assert all(np.isfinite(unpacked(shown, name)).all() for name in shown["tracks"])
    assert "default-src 'none'" in text
    assert not re.search(r"<(script|link|img)[^>]*(src|href)=", text)
    for notice in ("The MIT License", "three.js authors", "Leon Sorokin"):
        assert notice in text


def test_words_of_a_file_cannot_become_markup(shown):
    evil = {**shown, "title": "</script><b>", "words": ["</SCRIPT>"]}
    text = replay_page([evil])
    assert "</script><b>" not in text
    assert "</SCRIPT>" not in text


@pytest.mark.parametrize(("dropped", "said"), [("wind", ["wind", "gust"]), ("throttle", ["throttle", "thrust"])])
def test_what_a_file_lacks_is_said(windy, dropped, said):
    found = scene(without(windy, dropped), "old")
    assert found["missing"] == said
    assert not set(said) & set(found["tracks"])


def test_nothing_to_replay(windy, tmp_path):
    with pytest.raises(ts.ConfigError, match="holds no position: it cannot be replayed; fly it again"):
        tracks(without(windy, "position").data, config_of(windy))
    empty = dataclasses.replace(windy, data=windy.data.isel(time=slice(0)))
    with pytest.raises(ts.SolveError, match="no sample to show"):
        ts.write_replay(empty, tmp_path / "x.html")
    with pytest.raises(ts.ConfigError, match="one flight, or two side by side; 3 were given"):
        ts.write_replay([windy] * 3, tmp_path / "x.html")
    assert not (tmp_path / "x.html").exists()


@pytest.mark.parametrize("name", ["side_cables", "aerostat", "cruise", "hover"])
def test_every_kind_of_flight(name):
    scenario = ts.load_scenario(name, {"stop.time_limit": 1.0})
    found = scene(ts.dock(scenario, ts.trim(scenario)), name)
    assert found["missing"] == []
    assert found["tracks"].get("cable_curve", {"width": 0})["width"] == 51 * len(found["cables"])


@pytest.fixture
def stored(windy, tmp_path):
    windy.save(tmp_path / "flight.nc")
    return tmp_path / "flight.nc"


def test_view_writes_beside_the_flight_and_opens(stored, monkeypatch, capsys):
    opened = []

    class Browser:
        def open(self, address):
            opened.append(address)
            return True

    monkeypatch.setattr(webbrowser, "get", Browser)
    view([stored], json=True)
    out, err = capsys.readouterr()
    page = stored.parent / "flight_replay.html"
    assert json.loads(out) == {"file": str(page), "flights": [str(stored)]}
    assert err == ""
    assert opened == [page.as_uri()]


def test_view_without_a_browser_says_where_the_page_is(stored, monkeypatch, capsys):
    def none():
        raise webbrowser.Error("could not locate runnable browser")

    monkeypatch.setattr(webbrowser, "get", none)
    view([stored, stored], stored.parent / "two.html")
    out, err = capsys.readouterr()
    assert out == f"wrote {stored.parent / 'two.html'}\n"
    assert err == f"tethership: no browser could be opened; the page is {stored.parent / 'two.html'}\n"


@pytest.mark.parametrize("part", [0.0, 0.0005, 0.01, 0.3, 0.7, 0.99, 0.999999])
def test_view_refuses_a_truncated_file(stored, part):
    whole = stored.read_bytes()
    stored.write_bytes(whole[: int(part * len(whole))])
    with pytest.raises(ts.ConfigError, match="is not a readable netCDF file"):
        view([stored], no_open=True)


def test_view_refuses(stored, tmp_path):
    with pytest.raises(
        ts.ConfigError, match=r"is a folder, not a flight; name one of its flights, e\.g\. .*flight\.nc"
    ):
        view([tmp_path], no_open=True)
    (tmp_path / "empty").mkdir()
    with pytest.raises(ts.ConfigError, match=r"is a folder, not a flight; name a flight\.nc that `dock` wrote"):
        view([tmp_path / "empty"], no_open=True)
    with pytest.raises(ts.ConfigError, match="no such file"):
        view([tmp_path / "none.nc"], no_open=True)
    with pytest.raises(ts.ConfigError, match="two side by side; 3 files were given"):
        view([stored] * 3, no_open=True)
    with pytest.raises(ts.ConfigError, match=r"is no page: give a name that ends in \.html, or a folder"):
        view([stored], stored, no_open=True)
    with pytest.raises(ts.ConfigError, match=r"cannot write .*; choose another folder with --out"):
        view([stored], stored / "inside" / "page.html", no_open=True)
