"""The replay works in a browser, from disk: it plays, seeks, turns; scene and plots show the flight's own numbers.

If one of these failed, the page would be blank, call a network, or point an arrow the wrong way.
"""

import contextlib
import time

import numpy as np
import pytest

import tethership as ts

sync_api = pytest.importorskip("playwright.sync_api", reason="NO PLAYWRIGHT: replays are NOT tested in a browser")

pytestmark = pytest.mark.slow

FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
SIZE = {"width": 1100, "height": 700}


def flown(**changes):
    scenario = ts.load_scenario("docking", {"wind.speed": 12.0, "stop.time_limit": 26.0, **changes})
    return ts.dock(scenario, ts.trim(scenario), ["rewind", "heading"])


@pytest.fixture(scope="module")
def windy():
    """A flight with a gust at 20 s, cut after it."""
    return flown()


@pytest.fixture(scope="module")
def folder(tmp_path_factory, windy):
    folder = tmp_path_factory.mktemp("replay")
    ts.write_replay(windy, folder / "one.html")
    ts.write_replay({"long": windy, "short": flown(**{"stop.time_limit": 12.0})}, folder / "two.html")
    return folder


@pytest.fixture(scope="module")
def playing(limited):
    known = limited.known()
    playwright = sync_api.sync_playwright().start()
    yield playwright
    with limited(60.0, known):
        playwright.stop()


@pytest.fixture(scope="module")
def chromium(playing, browser, limited):
    known = limited.known()
    running = playing.chromium.launch(executable_path=browser, args=FLAGS)
    yield running
    with limited(60.0, known):
        running.close()


def wait(page, condition):
    """Wait until a condition holds; the page's policy forbids Playwright's own way, which evaluates words in it."""
    end = time.monotonic() + 60
    while not page.evaluate(condition):
        assert time.monotonic() < end, condition
        page.wait_for_timeout(50)


@contextlib.contextmanager
def opened(chromium, path):
    """Open a page from disk; it may say nothing on the console and ask for nothing but itself."""
    page = chromium.new_page(viewport=SIZE)
    said, asked = [], []
    page.on("console", lambda message: said.append(message.text) if message.type == "error" else None)
    page.on("pageerror", lambda error: said.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(path.as_uri())
    wait(page, "Boolean(window.tethership) && tethership.state().frames.every((count) => count > 0)")
    yield page
    page.close()
    assert said == []
    assert asked == [path.as_uri()]


def state(page):
    return page.evaluate("tethership.state()")


def settle(page):
    """Wait until what was asked for is drawn."""
    page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def seek(page, time):
    page.evaluate(
        "(time) => { const s = document.getElementById('time'); s.value = time; s.dispatchEvent(new Event('input')); }",
        time,
    )
    settle(page)
    return state(page)


def at(flight, name, time):
    """Return an output of the flight at a time, straight between samples."""
    values = flight.data[name].to_numpy()
    flat = values.reshape(len(values), -1)
    return np.array([np.interp(time, flight.data["time"].to_numpy(), column) for column in flat.T])


def rotation(flight, time):
    return np.asarray(ts.spatial.rotation_matrix(at(flight, "attitude", time)))


def vector(arrow):
    return np.array(arrow["to"]) - np.array(arrow["from"])


@pytest.mark.parametrize("instant", [2.5, 11.0, 22.5])
def test_scene_and_plots_agree_with_the_flight(chromium, folder, windy, instant):
    with opened(chromium, folder / "one.html") as page:
        seen = seek(page, instant)
    shown, turned = seen["flights"][0], rotation(windy, instant)
    nose = at(windy, "position", instant) + turned @ [6.97, 0.0, 0.0]
    np.testing.assert_allclose(shown["nose"], nose, atol=0.02)
    np.testing.assert_allclose(shown["nose_in_scene"], [nose[1], -nose[2], -nose[0]], atol=0.02)  # east, up, south
    np.testing.assert_allclose(shown["cables"][0]["end"], nose, atol=0.02)
    np.testing.assert_allclose(shown["cables"][0]["anchor"], 0.0, atol=1e-5)
    np.testing.assert_allclose(shown["tension"], at(windy, "tension", instant), rtol=0.03)
    np.testing.assert_allclose(shown["cable_length"], at(windy, "cable_length", instant), rtol=1e-3)
    assert f"{shown['tension'][0]:.0f}" in shown["readout"][0]
    for plot in seen["plots"]:
        assert plot["time"] == pytest.approx(instant, abs=0.01)
    assert dict(map(tuple, seen["plots"][0]["shown"]))[""] == f"{shown['tension'][0]:.0f}"


@pytest.mark.parametrize("instant", [2.5, 22.5])
def test_arrows_are_forces_on_the_ship_and_the_way_of_the_air(chromium, folder, windy, instant):
    with opened(chromium, folder / "one.html") as page:
        shown = seek(page, instant)["flights"][0]
    forces = sum(vector(arrow) for arrow in shown["thrusts"])
    recorded = rotation(windy, instant) @ at(windy, "load_force", instant).reshape(-1, 3)[5]
    assert list(windy.data["load"].to_numpy())[5] == "thrust"
    scale = 0.24 * 16.0 / 120.0  # metres of arrow per newton, Lotte's length within 2 %
    np.testing.assert_allclose(forces / scale, recorded, atol=0.03 * np.linalg.norm(recorded) + 1.0)
    air, gust = vector(shown["wind"]), vector(shown["gust"])
    assert air[0] < 0
    assert abs(air[1]) < 1e-4
    if instant > 20:
        np.testing.assert_allclose(gust[1] / -air[0], at(windy, "wind", instant)[1] / 12.0, rtol=0.01)
        assert shown["gust"]["shown"]
        assert gust[1] > 0
    else:
        assert not shown["gust"]["shown"]


def test_plays_pauses_and_changes_speed(chromium, folder):
    with opened(chromium, folder / "one.html") as page:
        assert not state(page)["playing"]
        page.keyboard.press("Space")
        wait(page, "tethership.state().time > 0.3")
        page.click("#play")
        stopped = state(page)
        assert not stopped["playing"]
        assert stopped["frames"][0] > 2
        page.keyboard.press("ArrowUp")
        page.keyboard.press("ArrowUp")
        assert state(page)["speed"] == 4
        page.keyboard.press("End")
        assert state(page)["time"] == pytest.approx(26.0, abs=0.02)
        page.keyboard.press("ArrowLeft")
        assert state(page)["time"] == pytest.approx(25.5, abs=0.02)
        page.keyboard.press("Space")
        wait(page, "!tethership.state().playing")
        assert state(page)["time"] == state(page)["end"]  # it stops at the end
        page.keyboard.press("Space")
        wait(page, "tethership.state().time < 20")  # and begins again


def test_a_click_in_a_plot_seeks(chromium, folder):
    with opened(chromium, folder / "one.html") as page:
        first, second, *_ = page.query_selector_all(".u-over")
        for plot in (first, second):
            box = plot.bounding_box()
            page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 5)
            settle(page)
            assert state(page)["time"] == pytest.approx(13.0, abs=0.2)
            page.keyboard.press("Home")


def test_cameras_stand_where_their_names_say(chromium, folder):
    with opened(chromium, folder / "one.html") as page:
        seek(page, 5.0)
        eyes = {}
        for key, name in enumerate(["north", "east", "top", "three-quarter", "chase"], start=1):
            page.keyboard.press(str(key))
            settle(page)
            seen = state(page)
            assert seen["camera"] == name
            camera = seen["flights"][0]["camera"]
            eyes[name] = np.array(camera["position"]) - camera["target"]
            assert np.abs(seen["flights"][0]["nose_on_screen"][:2]).max() < 1
        assert np.argmax(np.abs(eyes["north"])) == 0
        assert eyes["north"][0] > 0
        assert np.argmax(np.abs(eyes["east"])) == 1
        assert eyes["east"][1] > 0
        assert np.argmax(np.abs(eyes["top"])) == 2
        assert eyes["top"][2] < 0
        assert eyes["chase"][0] < 0
        assert eyes["chase"][2] < 0
        box = page.query_selector(".view").bounding_box()
        page.mouse.move(box["x"] + 300, box["y"] + 300)
        page.mouse.down()
        page.mouse.move(box["x"] + 380, box["y"] + 320, steps=4)
        page.mouse.up()
        settle(page)
        assert state(page)["camera"] == "orbit"


def test_two_flights_in_step(chromium, folder, windy):
    with opened(chromium, folder / "two.html") as page:
        first, second = seek(page, 6.0)["flights"]
        assert (first["name"], second["name"]) == ("long", "short")
        np.testing.assert_allclose(first["nose"], second["nose"], atol=0.02)
        first, second = seek(page, 20.0)["flights"]  # the short one stands where it ended
        np.testing.assert_allclose(second["centre"], first_centre(windy, 12.0), atol=0.02)
        np.testing.assert_allclose(first["centre"], first_centre(windy, 20.0), atol=0.02)
        box = page.query_selector(".view").bounding_box()
        page.mouse.move(box["x"] + 100, box["y"] + 300)
        page.mouse.down()
        page.mouse.move(box["x"] + 160, box["y"] + 310, steps=4)
        page.mouse.up()
        settle(page)
        first, second = state(page)["flights"]
        np.testing.assert_allclose(first["camera"]["position"], second["camera"]["position"], atol=1e-6)


def test_both_flights_are_told_of_alike(chromium, folder):
    """Whatever is shown of A is shown of B, and what is compared has one scale."""
    with opened(chromium, folder / "two.html") as page:
        plots = seek(page, 6.0)["plots"]
        ranges = page.evaluate("tethership.state().plots.map((plot) => plot.range)")
    named = {plot["title"]: dict(map(tuple, plot["shown"])) for plot in plots}
    for letter in "AB":
        assert set(named[f"attitude {letter}"]) == {"roll", "pitch", "yaw"}
        assert len(named[f"throttle {letter}"]) == 6
    assert set(named["cable length, distance to anchor"]) == {"A: length", "A: distance", "B: length", "B: distance"}
    assert named["attitude A"] == named["attitude B"]  # both are the same flight at first
    first, second = (ranges[i] for i, plot in enumerate(plots) if plot["title"].startswith("attitude"))
    assert first == second


def test_without_webgl_a_sentence_stands_in_for_the_scene_alone(playing, browser, folder, windy):
    blind = playing.chromium.launch(executable_path=browser, args=["--no-sandbox", "--disable-3d-apis"])
    for name in ("one", "two"):
        with opened(blind, folder / f"{name}.html") as page:
            assert page.locator(".sentence").first.inner_text().startswith("The view in space needs WebGL 2, which")
            assert not page.locator("#cameras").is_visible()
            seen = seek(page, 11.0)
            assert len(seen["plots"]) >= 5
            assert f"{at(windy, 'tension', 11.0)[0]:.0f}" in seen["flights"][0]["readout"][0]
            assert dict(map(tuple, seen["plots"][0]["shown"])).keys() <= {"", "A", "B"}
            page.keyboard.press("Space")
            wait(page, "tethership.state().time > 11.3")
    blind.close()


def test_the_keyboard_reaches_every_control_and_shows_where_it_is(chromium, folder):
    with opened(chromium, folder / "one.html") as page:
        seek(page, 5.0)
        reached = []
        while len(reached) < 8:
            page.keyboard.press("Tab")
            if page.evaluate("document.activeElement.id") == "plots":
                continue  # where the histories are longer than the window, they can be scrolled by keys
            reached.append(page.evaluate("document.activeElement.dataset.camera ?? document.activeElement.id"))
            look = page.evaluate("getComputedStyle(document.activeElement).outlineStyle + document.activeElement.id")
            assert look.startswith("solid")
        assert reached == ["play", "time", "speed", "north", "east", "top", "three-quarter", "chase"]
        page.keyboard.press("Space")  # presses the button that has the focus, and does not play
        settle(page)
        assert state(page)["camera"] == "chase"
        assert not state(page)["playing"]


def first_centre(flight, time):
    """Return B [m], ground axes."""
    return at(flight, "position", time) + rotation(flight, time) @ [0.0, 0.0, 0.0]


@pytest.mark.parametrize("width", [420, 1920])
def test_nothing_sticks_out_of_the_window(chromium, folder, width):
    with opened(chromium, folder / "two.html") as page:
        page.set_viewport_size({"width": width, "height": 900})
        settle(page)
        assert page.evaluate("document.documentElement.scrollWidth") <= width
        widths = page.evaluate("[...document.querySelectorAll('canvas')].map((c) => c.getBoundingClientRect().right)")
        assert max(widths) <= width + 1
