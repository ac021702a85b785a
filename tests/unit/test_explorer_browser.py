"""The explorer as it is used: served, opened in a browser, changed, cancelled, refused to strangers, ended.

If one of these failed, a page would show old numbers as new ones, hang, call home, or leave processes behind.
"""

import contextlib
import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
import urllib.request
from pathlib import Path

import numpy as np
import pytest

import tethership as ts

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)

playwright = pytest.importorskip("playwright.sync_api", reason="NO PLAYWRIGHT: the explorer is NOT tested in a browser")

FOLDER_FLAGS = ("--port", "0", "--no-open", "--json")

FLAGS = ["--no-sandbox", "--enable-unsafe-swiftshader"]

SERVES = 120.0
"""How long the command may take until it serves [s]."""

pytestmark = pytest.mark.timeout(400)


def started(folder, errors):
    """Start the command and return its process and what it says once it serves; its errors go into a file.

    Into a file, for a pipe stays open as long as any process of its family lives: to read it to its end may take for
    ever after the command itself was killed.
    """
    command = [sys.executable, "-m", "tethership", "explore", *FOLDER_FLAGS, "--folder", str(folder)]
    with errors.open("w") as sink:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=sink, text=True)
    lines = []
    reader = threading.Thread(target=lambda: lines.append(process.stdout.readline()), daemon=True)
    reader.start()
    reader.join(SERVES)
    if not lines or not lines[0]:
        kill([process.pid, *descendants(process.pid)])
        raise AssertionError(f"it did not serve within {SERVES:g} s: {errors.read_text()}")
    return process, json.loads(lines[0])


def descendants(pid):
    """Return the processes that a process started, and theirs."""
    children = [int(c) for task in Path(f"/proc/{pid}/task").glob("*/children") for c in task.read_text().split()]
    return children + [other for child in children for other in descendants(child)]


def kill(pids):
    for pid in pids:
        with contextlib.suppress(ProcessLookupError):
            os.kill(pid, signal.SIGKILL)


def alive(pids):
    return [
        pid for pid in pids if Path(f"/proc/{pid}/stat").exists() and " Z " not in Path(f"/proc/{pid}/stat").read_text()
    ]


def gone(pids, seconds=10.0):
    """Wait until processes have ended; return whether they did."""
    end = time.monotonic() + seconds
    while alive(pids) and time.monotonic() < end:
        time.sleep(0.05)
    return not alive(pids)


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    folder = tmp_path_factory.mktemp("explored")
    process, said = started(folder, tmp_path_factory.mktemp("said") / "errors")
    yield said, folder
    family = [process.pid, *descendants(process.pid)]
    process.terminate()
    try:
        process.wait(15)
    finally:
        kill(family)


@pytest.fixture(scope="module")
def browser(limited):
    if BROWSER is None:
        pytest.skip(
            "NO BROWSER: the explorer is NOT tested in one; install Debian's chromium (apt-get install chromium)"
        )
    known = limited.known()
    api = playwright.sync_playwright().start()
    opened = api.chromium.launch(executable_path=BROWSER, args=FLAGS)
    yield opened
    with limited(60.0, known):  # neither end takes a limit
        opened.close()
        api.stop()


def serious(line):
    """Return what a line of the console tells of the page, and not of the machine's graphics."""
    return [line.text] if line.type in ("error", "warning") and "GL Driver Message" not in line.text else []


class Page:
    """The page as a user has it."""

    def __init__(self, page, said):
        self.page, self.troubles = page, []
        page.set_default_timeout(90_000)
        page.on("console", lambda line: self.troubles.extend(serious(line)))
        page.on("pageerror", lambda error: self.troubles.append(str(error)))
        page.on(
            "request", lambda r: r.url.startswith((said["server"], "data:", "blob:")) or self.troubles.append(r.url)
        )
        page.goto(said["address"])
        self.settled()

    def text(self, name):
        return self.page.locator(f"""[id*='"name":"{name}","part":"text"']""")

    def write(self, name, value):
        box = self.text(name)
        self.page.evaluate("for (const d of document.querySelectorAll('.group')) d.open = true")
        box = box if box.evaluate("e => e.tagName") == "INPUT" else box.locator("input")
        box.fill(value)
        box.press("Enter")

    def open(self, tab):
        self.page.locator("#tab").get_by_text(tab, exact=True).click()

    def settled(self, words=""):
        """Wait until what is shown answers what is asked for, which these words of the visible view tell."""
        self.page.wait_for_function(
            """words => {
                const view = [...document.querySelectorAll(".view")].find((one) => one.offsetParent);
                return view && !view.classList.contains("stale") && view.querySelector(".verdict")
                  && view.innerText.includes(words) && document.querySelector("#state").className === "state good";
            }""",
            arg=words,
        )

    def drawn(self, view, name):
        """Return the numbers of a trace as plotly has them."""
        found = self.page.evaluate(
            """([view, name]) => {
                const graph = document.querySelector(`[id*='"figure":"${view}"'] .js-plotly-plot`);
                const trace = graph.data.find((one) => one.name === name);
                const numbers = (part) => Array.from(trace[part]._inputArray ?? trace[part]);
                return [numbers("x"), numbers("y")];
            }""",
            [view, name],
        )
        return np.array(found[0]) + 1j * np.array(found[1])


@pytest.fixture
def page(browser, served):
    context = browser.new_context(viewport={"width": 1400, "height": 900})
    opened = Page(context.new_page(), served[0])
    yield opened
    assert opened.troubles == []
    context.close()


def test_the_token_leaves_the_address_and_a_script_can_do_with_the_cookie(page, served):
    """What stands in the address line is seen over a shoulder, kept in the history and sent to nobody."""
    said = served[0]
    assert page.page.url == said["server"] + "/"
    (cookie,) = page.page.context.cookies()
    assert said["cookie"] == f"{cookie['name']}={cookie['value']}"
    assert cookie["httpOnly"]
    assert cookie["sameSite"] == "Strict"
    request = urllib.request.Request(said["server"] + "/_dash-layout", headers={"Cookie": said["cookie"]})
    with urllib.request.urlopen(request, timeout=20) as answer:
        assert answer.status == 200


def test_a_file_that_leads_to_the_page_opens_it(browser, served, tmp_path):
    """As `explore` opens a browser: across sites, where a strict cookie is held back from a redirect."""
    from tethership.cli.explore import DOOR

    door = tmp_path / "door.html"
    door.write_text(DOOR.format(address=served[0]["address"]))
    context = browser.new_context()
    opened = context.new_page()
    opened.goto(door.as_uri())
    opened.wait_for_selector("#state", timeout=90_000)
    assert opened.url == served[0]["server"] + "/"
    context.close()


NAMES = """() => {
  for (const one of document.querySelectorAll("details")) one.open = true;
  const words = (id) => document.getElementById(id)?.textContent.trim() ?? "";
  const name = (e) => e.getAttribute("aria-labelledby")?.split(" ").map(words).join(" ").trim()
    || e.getAttribute("aria-label") || [...(e.labels ?? [])].map((label) => label.textContent).join(" ").trim()
    || (e.tagName === "BUTTON" ? e.textContent.trim() : "");
  return [...document.querySelectorAll("input, button, select, textarea, [role=slider]")]
    .filter((e) => e.getAttribute("aria-hidden") !== "true" && !e.closest(".js-plotly-plot"))
    .map((e) => [e.tagName + " " + e.id, name(e)]);
}"""
"""What every control of the page is called to somebody who does not see it."""


def test_every_control_has_a_name(page):
    """Numbers by their label, sliders by that of their number, lists by their label and what is chosen."""
    for tab in ("Trim", "Root locus", "Flight"):
        page.open(tab)
        page.settled()
        found = page.page.evaluate(NAMES)
        assert [place for place, name in found if not name] == []
    names = [name for _, name in found]
    assert names.count("wind speed") == 2  # its box and its slider
    assert {"from", "to", "points", "over wind.speed", "Scenario docking", "file name"} <= set(names)
    assert len(found) > 60


@pytest.mark.parametrize("width", [420, 768])
def test_a_narrow_page_is_read_and_used_without_scrolling_sideways(browser, served, width):
    context = browser.new_context(viewport={"width": width, "height": 900})
    opened = Page(context.new_page(), served[0])
    for tab, view in (("Trim", "trim"), ("Root locus", "locus"), ("Flight", "flight")):
        opened.open(tab)
        opened.settled()
        opened.page.evaluate("for (const one of document.querySelectorAll('.recipe')) one.open = true")
        opened.page.wait_for_timeout(500)
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
        panels = opened.page.evaluate(
            """view => [...document.querySelectorAll(`[id*='"figure":"${view}"'] .cartesianlayer .bglayer rect,
              [id*='"figure":"${view}"'] .bglayer .bg`)].map((e) => e.getBoundingClientRect().width)""",
            view,
        )
        assert min(panels, default=999) > 0.25 * min(width, 700) - 60
    opened.page.get_by_text("Numbers ↓").click()
    opened.write("wind.speed", "7")
    opened.page.get_by_text("Results ↑").click()
    opened.settled("wind.speed = 7 m/s")
    assert opened.troubles == []
    context.close()


def test_the_keyboard_reaches_the_controls_and_shows_where_it_is(page):
    """Each stop of the first twelve has an outline that the others do not have, and the tabs are moved by arrows."""
    seen = []
    for _ in range(12):
        page.page.keyboard.press("Tab")
        seen.append(
            page.page.evaluate(
                """() => {
                    const e = document.activeElement, style = getComputedStyle(e);
                    const around = e.closest(".tabs label, .dash-dropdown-grid-container, .dash-input-container") ?? e;
                    const looks = [style, getComputedStyle(around)];
                    const near = e.nextElementSibling && getComputedStyle(e.nextElementSibling);
                    return [e.id || e.className || e.tagName, [...looks, near].some((look) => look
                      && ((look.outlineStyle !== "none" && look.outlineWidth !== "0px") || look.boxShadow !== "none"))];
                }"""
            )
        )
    assert [place for place, shown in seen if not shown] == []
    assert len({place for place, _ in seen}) >= 8
    page.page.locator("#tab input:checked").focus()
    page.page.keyboard.press("ArrowRight")
    page.settled("13 of 13")


def test_changing_a_number_moves_the_locus(page):
    """Stars are the chosen ship's own roots, and follow the wind; dots follow the cable: as `sweep` and `modes` say."""
    page.open("Root locus")
    page.settled("13 of 13")
    before = page.drawn("locus", "chosen scenario")
    page.write("wind.speed", "9")
    page.settled("wind.speed = 9 m/s")
    after = page.drawn("locus", "chosen scenario")
    page.write("cables.nose.length", "24")
    page.settled("cables.nose.length = 24 m")
    moved = page.drawn("locus", "pendulum")
    assert np.abs(np.sort_complex(after) - np.sort_complex(before)).max() > 0.1
    chosen = ts.load_scenario("docking", {"wind.speed": 9.0})
    roots = ts.linearize(chosen, ts.trim(chosen)).modes().eigenvalues
    assert np.allclose(np.sort_complex(after), np.sort_complex(roots), rtol=0, atol=1e-9)
    longer = ts.load_scenario("docking", {"wind.speed": 9.0, "cables.nose.length": 24.0})
    found = ts.sweep(longer, {"wind.speed": np.linspace(6.0, 12.0, 13)})
    assert np.allclose(moved, found.track("pendulum"), rtol=0, atol=1e-9)


def test_a_slider_moves_its_number(page):
    handle = page.page.locator(""".dash-slider-thumb, [role=slider]""").first
    handle.focus()
    handle.press("ArrowRight")
    page.settled("wind.speed = 6.1 m/s")
    assert "changed" in page.page.locator("""[id*='"name":"wind.speed","part":"field"']""").get_attribute("class")
    page.page.locator("#reset").click()
    page.settled("unchanged")


def test_a_flight_is_cancelled_and_the_page_goes_on(page):
    page.open("Flight")
    page.write("cables.nose.winch.rewind_rate", "0")
    page.write("stop.time_limit", "1e6")
    page.page.wait_for_function("() => document.querySelector('#state').innerText.startsWith('flying')")
    page.page.locator("#cancel").click()
    page.page.wait_for_function("() => document.querySelector('#state').innerText === 'cancelled'")
    page.write("stop.time_limit", "2")
    page.settled("time limit after 2.00 s")


def test_wrong_input_is_one_line_and_nothing_old_is_shown_as_new(page):
    page.write("wind.speed", "fast")
    page.page.wait_for_selector("#trouble:has-text('no number')")
    assert page.page.locator(".view.stale:visible").count() == 1
    assert "Traceback" not in page.page.content()
    page.write("wind.speed", "7")
    page.settled("wind.speed = 7 m/s")
    assert page.page.locator("#trouble").inner_text() == ""


def test_another_scenario_and_the_file_are_offered(page, served):
    page.page.locator("#scenario").click()
    page.page.get_by_role("option", name="aerostat").or_(
        page.page.locator(".dash-options-list-option", has_text="aerostat")
    ).first.click()
    page.settled("aerostat")
    page.write("wind.speed", "8")
    page.settled("wind.speed = 8 m/s")
    page.page.get_by_text("Show the command").locator("visible=true").click()
    assert page.page.locator("#command-trim").inner_text() == "tethership trim aerostat --set wind.speed=8"
    page.page.get_by_text("Save in the folder").locator("visible=true").click()
    page.page.wait_for_selector(".saved:has-text('saved:')")
    saved = served[1] / "aerostat_explored.toml"
    assert saved.read_text() == page.page.locator("#toml-trim").text_content()
    assert ts.load_scenario(str(saved)).config.wind.speed == 8.0
    with page.page.expect_download() as download:
        page.page.get_by_text("Download").locator("visible=true").click()
    assert Path(download.value.path()).read_text() == saved.read_text()
    name = page.page.locator("""[id*='"part":"file-name"']""").locator("visible=true")
    name = name if name.evaluate("e => e.tagName") == "INPUT" else name.locator("input")
    name.fill("../outside.toml")
    page.page.get_by_text("Save in the folder").locator("visible=true").click()
    page.page.wait_for_selector(".saved:has-text('no name')")
    assert not (served[1].parent / "outside.toml").exists()


def test_what_was_seen_before_is_shown_again_without_computing(page):
    """Told by the time that it took: this is the former result, not a new one."""
    page.write("wind.speed", "7.5")
    page.settled("wind.speed = 7.5 m/s")
    took = page.page.locator("#state").inner_text()
    page.write("wind.speed", "8.5")
    page.settled("wind.speed = 8.5 m/s")
    page.write("wind.speed", "7.5")
    page.settled("wind.speed = 7.5 m/s")
    assert page.page.locator("#state").inner_text() == took


def test_while_something_is_computed_the_former_result_stays_with_a_sign(page):
    page.open("Flight")
    page.settled()
    page.write("cables.nose.winch.rewind_rate", "0")
    page.write("stop.time_limit", "2e6")
    page.page.wait_for_selector(".view.stale.busy:visible")
    sign = page.page.locator(".view.busy:visible").evaluate("e => getComputedStyle(e, '::before').content")
    assert "computing" in sign
    assert page.page.locator(".view.busy:visible .metrics").count() == 1
    page.page.locator("#cancel").click()
    page.page.wait_for_selector(".view.stale:not(.busy):visible")


def test_a_pinned_result_is_drawn_below_and_compared_until_it_is_let_go(page):
    page.settled("unchanged")
    page.page.locator(".pin:visible").click()
    page.page.wait_for_selector(".pin:visible:has-text('Unpin')")
    page.settled("pinned, in grey: docking · unchanged")
    page.write("wind.speed", "9")
    page.settled("wind.speed = 9 m/s")
    both = page.page.evaluate(
        """() => document.querySelector(`[id*='"figure":"trim"'] .js-plotly-plot`).data
          .filter((trace) => trace.type === "bar").map((trace) => [trace.name, trace.marker.line?.color])"""
    )
    assert both == [["pinned", "#808080"], ["throttle", None]]
    rows = page.page.locator(".view:visible tr", has_text="tension, nose").all_inner_texts()
    chosen = [ts.trim(ts.load_scenario("docking", {"wind.speed": speed})).tension[0] for speed in (6.0, 9.0)]
    change = round(float(chosen[1]), 4) - round(float(chosen[0]), 4)
    told = ["tension, nose", f"{chosen[0]:.4f}", f"{chosen[1]:.4f}", f"{change:+.4f}", "N"]
    assert rows[0].split("\t") == told
    page.page.locator(".pin:visible").click()
    page.page.wait_for_selector(".pin:visible:has-text('Pin this result')")
    page.page.wait_for_function("() => !document.querySelector('.pinned')")
    assert page.page.get_by_text("Changed since it was pinned").count() == 0


def test_the_flight_is_replayed_in_space(page):
    """The replay's own page, in a frame that can reach nothing else; loaded when it is to be seen, not before."""
    page.open("Flight")
    page.write("stop.time_limit", "3")
    page.settled("time limit after 3.00 s")
    assert page.page.locator("iframe.space").get_attribute("src") is None
    page.page.get_by_text("in space (3-D)").click()
    page.page.wait_for_selector("iframe.space[src]")
    frame = page.page.locator("iframe.space").element_handle().content_frame()
    end = time.monotonic() + 90
    while not frame.evaluate("Boolean(window.tethership) && tethership.state().frames.every((count) => count > 0)"):
        assert time.monotonic() < end
        page.page.wait_for_timeout(50)
    (shown,) = frame.evaluate("tethership.state().flights")
    scenario = ts.load_scenario("docking", {"stop.time_limit": 3.0})
    start = ts.dock(scenario, ts.trim(scenario)).data["tension"].to_numpy()[0]
    assert np.allclose(shown["tension"], start, rtol=1e-5)
    assert page.page.locator("iframe.space").get_attribute("sandbox") == "allow-scripts"
    page.page.get_by_text("histories", exact=True).click()
    assert page.page.locator("iframe.space:visible").count() == 0


COLOURS = """view => {
  const graph = document.querySelector(`[id*='"figure":"${view}"'] .js-plotly-plot`);
  const full = graph._fullLayout;
  const lines = graph._fullData.flatMap((one) => [one.line?.color, one.marker?.color])
    .filter((colour) => typeof colour === "string");
  return { paper: full.paper_bgcolor, words: full.font.color, lines,
    page: getComputedStyle(document.body).backgroundColor, text: getComputedStyle(document.body).color };
}"""
"""The colours of a figure, and of the page around it."""


def luminance(colour):
    """Return the relative luminance of a CSS colour (WCAG 2)."""
    if colour.startswith("#"):
        parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    else:
        parts = [float(part) / 255 for part in colour[colour.index("(") + 1 : -1].split(",")[:3]]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one, other):
    """Return the contrast of two colours [-], 1 … 21."""
    high, low = sorted((luminance(one), luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_page_and_figures_are_dark_where_the_system_is(browser, served, scheme):
    """Words are read (7 : 1) and lines are seen (3 : 1; on white as ever) in both."""
    context = browser.new_context(viewport={"width": 1400, "height": 900}, color_scheme=scheme)
    opened = Page(context.new_page(), served[0])
    for tab, view in (("Trim", "trim"), ("Root locus", "locus"), ("Flight", "flight")):
        opened.open(tab)
        opened.settled()
        opened.page.wait_for_timeout(300)
        found = opened.page.evaluate(COLOURS, view)
        assert (luminance(found["page"]) < 0.05) == (scheme == "dark")
        assert contrast(found["paper"], found["page"]) < 1.02
        assert contrast(found["text"], found["page"]) > 7
        assert contrast(found["words"], found["paper"]) > 7
        if scheme == "dark":
            assert min(contrast(colour, found["paper"]) for colour in found["lines"]) > 3
    assert opened.troubles == []
    context.close()


def test_dark_may_be_chosen_and_is_remembered(browser, served):
    context = browser.new_context(color_scheme="light")
    opened = Page(context.new_page(), served[0])

    def is_dark():
        opened.page.wait_for_timeout(300)
        found = opened.page.evaluate(COLOURS, "trim")
        assert (luminance(found["page"]) < 0.05) == (luminance(found["paper"]) < 0.05)
        return luminance(found["page"]) < 0.05

    assert not is_dark()
    opened.page.locator("#dark").click()
    assert is_dark()
    opened.page.reload()
    opened.settled()
    assert is_dark()
    opened.page.locator("#dark").click()
    assert not is_dark()
    opened.page.emulate_media(color_scheme="dark")  # as the system again: followed from now on
    assert is_dark()
    assert opened.troubles == []
    context.close()


def test_only_this_machine_is_answered(served):
    """The socket is bound to 127.0.0.1, not to every address: the kernel's own list says so."""
    port = int(served[0]["server"].rsplit(":", 1)[1])
    listening = [
        line.split()[1] for line in Path("/proc/net/tcp").read_text().splitlines()[1:] if line.split()[3] == "0A"
    ]
    assert [place for place in listening if place.endswith(f":{port:04X}")] == [f"0100007F:{port:04X}"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_nothing_is_left_behind(tmp_path, number):
    process, said = started(tmp_path, tmp_path / "errors")
    children = descendants(process.pid)
    assert children
    assert said["pid"] == process.pid
    os.kill(process.pid, number)
    assert process.wait(15) == (-number if number == signal.SIGKILL else 0)
    assert gone(children)
    assert "Traceback" not in (tmp_path / "errors").read_text()
