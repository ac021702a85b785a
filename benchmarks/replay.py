"""Replay page: frames per second while a 65 s docking is played, time to write it, size.

Claims: at least 30 frames per second on an ordinary machine; less than 5 MB; less than 0.5 s in `dock`. Frames are
counted in the page by requestAnimationFrame and by what was rendered, for 4 s, at three sizes of the window. Without a
graphics card (most servers) Chromium draws in software (SwiftShader), on the processor, which is a lower bound.
Run: python benchmarks/replay.py [--gpu] (needs Chromium and playwright)
"""

import shutil
import sys
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

import tethership as ts

SOFTWARE = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
SIZES = [(1400, 900), (1920, 1080), (420, 900)]
SECONDS = 4.0
BROWSERS = ("chromium", "chromium-browser", "google-chrome")

COUNT = """(seconds) => new Promise((done) => {
  const first = tethership.state().frames, begun = performance.now();
  let called = 0;
  const count = () => {
    called += 1;
    const passed = (performance.now() - begun) / 1000;
    if (passed < seconds) return requestAnimationFrame(count);
    done({ called: called / passed, drawn: (tethership.state().frames[0] - first[0]) / passed });
  };
  requestAnimationFrame(count);
})"""

RENDERER = """() => {
  const gl = document.createElement('canvas').getContext('webgl2');
  return gl.getParameter(gl.getExtension('WEBGL_debug_renderer_info').UNMASKED_RENDERER_WEBGL);
}"""


def pages(folder):
    """Return pages of one flight and of two; print how long writing takes."""
    scenario = ts.load_scenario("docking", {"wind.speed": 12.0})
    point = ts.trim(scenario)
    rewind = ts.dock(scenario, point, ["rewind", "heading"])
    navigation = ts.dock(scenario, point)
    found = []
    for name, flights in (("one", rewind), ("two", [rewind, navigation])):
        for call in ("first", "next"):
            begun = time.perf_counter()
            path = ts.write_replay(flights, folder / f"{name}.html")
            took = time.perf_counter() - begun
            print(f"{name}, {call} call: written in {took:.3f} s, {path.stat().st_size / 1e6:.2f} MB")
        found.append(path)
    return found


def main():
    browser_path = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser_path is None:
        sys.exit("benchmarks/replay.py needs Chromium; install it, e.g. apt-get install chromium")
    flags = ["--no-sandbox", *([] if "--gpu" in sys.argv else SOFTWARE)]
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        written = pages(Path(folder))
        browser = playwright.chromium.launch(executable_path=browser_path, args=flags)
        for path in written:
            for width, height in SIZES:
                page = browser.new_page(viewport={"width": width, "height": height})
                page.goto(path.as_uri())
                page.wait_for_timeout(1500)
                page.keyboard.press("Space")
                page.wait_for_timeout(500)
                rates = page.evaluate(COUNT, SECONDS)
                print(
                    f"{path.stem} at {width} x {height}: {rates['called']:.0f} frames/s offered, "
                    f"{rates['drawn']:.0f} drawn, "
                    f"{page.evaluate('tethership.state().work'):.2f} ms of scripts a frame ({page.evaluate(RENDERER)})"
                )
                page.close()
        browser.close()


if __name__ == "__main__":
    main()
