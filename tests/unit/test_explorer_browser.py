"""The explorer as it is used: served, opened in a browser, changed, cancelled, refused to strangers, ended.

If one of these failed, a page would show old numbers as new ones, hang, call home, or leave processes behind.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import numpy as np
import pytest

import tethership as ts

BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)

playwright = pytest.importorskip("playwright.sync_api", reason="NO PLAYWRIGHT: the explorer is NOT tested in a browser")

FOLDER_FLAGS = ("--port", "0", "--no-open", "--json")


def started(folder, *flags):
    """Start the command and return its process and what it says once it serves."""
    command = [sys.executable, "-m", "tethership", "explore", *FOLDER_FLAGS, "--folder", str(folder), *flags]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return process, json.loads(process.stdout.readline())


def descendants(pid):
    """Return the processes that a process started, and theirs."""
    children = [int(c) for task in Path(f"/proc/{pid}/task").glob("*/children") for c in task.read_text().split()]
    return children + [other for child in children for other in descendants(child)]


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
    process, said = started(folder)
    yield said, folder
    process.terminate()
    process.wait(15)


@pytest.fixture(scope="module")
def browser():
    if BROWSER is None:
        pytest.skip(
            "NO BROWSER: the explorer is NOT tested in one; install Debian's chromium (apt-get install chromium)"
        )
    with playwright.sync_playwright() as api:
        opened = api.chromium.launch(executable_path=BROWSER, args=["--no-sandbox"])
        yield opened
        opened.close()


class Page:
    """The page as a user has it."""

    def __init__(self, page, said):
        self.page, self.troubles = page, []
        page.set_default_timeout(90_000)
        page.on("console", lambda line: line.type in ("error", "warning") and self.troubles.append(line.text))
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


def test_only_this_machine_is_answered(served):
    """The socket is bound to 127.0.0.1, not to every address: the kernel's own list says so."""
    port = int(served[0]["server"].rsplit(":", 1)[1])
    listening = [
        line.split()[1] for line in Path("/proc/net/tcp").read_text().splitlines()[1:] if line.split()[3] == "0A"
    ]
    assert [place for place in listening if place.endswith(f":{port:04X}")] == [f"0100007F:{port:04X}"]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_nothing_is_left_behind(tmp_path, number):
    process, said = started(tmp_path)
    children = descendants(process.pid)
    assert children
    assert said["pid"] == process.pid
    os.kill(process.pid, number)
    assert process.wait(15) == (-number if number == signal.SIGKILL else 0)
    assert gone(children)
    assert "Traceback" not in process.stderr.read()
