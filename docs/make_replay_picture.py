"""Make docs/replay.png: the replay page of a flight at one time, as a browser draws it.

Run: python docs/make_replay_picture.py REPLAY.html PICTURE.png (needs Chromium and playwright)
"""

import shutil
import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

TIME = 22.6
"""Time shown [s]: in the gust."""

FLAGS = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def main(source: Path, picture: Path) -> None:
    """Open the page, go to the time, take the picture."""
    found = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if found is None:
        sys.exit("docs/make_replay_picture.py needs Chromium; install it, e.g. apt-get install chromium")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=found, args=FLAGS)
        page = browser.new_page(viewport={"width": 1440, "height": 860})
        page.goto(source.resolve().as_uri())
        page.evaluate(
            "(t) => { const s = document.getElementById('time'); s.value = t; s.dispatchEvent(new Event('input')); }",
            TIME,
        )
        page.wait_for_timeout(1000)
        page.screenshot(path=picture)
        browser.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
