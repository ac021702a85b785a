"""Draw docs/explorer.png: the explorer's root locus in 9 m/s of wind. Needs Playwright and Chromium.

Run from the top of the repository: python docs/make_explorer.py
"""

import shutil
import sys
import tempfile
import threading
from pathlib import Path

from playwright.sync_api import sync_playwright

from tethership.explorer.server import Explorer

READY = """() => document.querySelector("#state").className === "state good"
  && !document.querySelector("[id*='locus'].view").classList.contains("stale")
  && document.querySelector("[id*='locus'].view").innerText.includes("wind.speed = 9 m/s")"""


def main() -> None:
    """Serve, look, save the picture."""
    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if chromium is None:
        sys.exit("no Chromium: apt-get install chromium")
    with tempfile.TemporaryDirectory() as folder, Explorer("docking", Path(folder)) as explorer:
        threading.Thread(target=explorer.serve, daemon=True).start()
        with sync_playwright() as api:
            browser = api.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
            page = browser.new_page(viewport={"width": 1400, "height": 900})
            page.goto(explorer.address)
            page.locator("#tab").get_by_text("Root locus").click()
            box = page.locator("""[id*='"name":"wind.speed","part":"text"']""")
            box = box if box.evaluate("e => e.tagName") == "INPUT" else box.locator("input")
            box.fill("9")
            box.press("Enter")
            page.wait_for_function(READY, timeout=120_000)
            page.mouse.move(700, 60)
            page.wait_for_timeout(1000)
            page.screenshot(path="docs/explorer.png")
            browser.close()
        explorer.stop()


if __name__ == "__main__":
    main()
