"""Shared starts: a scenario, its trim and one flight, computed once per worker."""

import gc
import shutil
import subprocess
from pathlib import Path

import jax
import pytest

import tethership as ts

MAPS = Path("/proc/self/maps")
MOST_MAPS = 20_000
"""Every compiled program keeps hundreds of memory maps; Linux allows a process 65 530 and XLA aborts beyond."""


@pytest.fixture(autouse=True, scope="module")
def _room_for_programs():
    """Forget compiled programs before a process has no maps left; they come back from the compilation cache."""
    yield
    if MAPS.exists() and MAPS.read_bytes().count(b"\n") > MOST_MAPS:
        jax.clear_caches()
        gc.collect()


@pytest.fixture(scope="session")
def docking():
    """The packaged docking scenario."""
    return ts.load_scenario("docking")


@pytest.fixture(scope="session")
def point(docking):
    """Its trim."""
    return ts.trim(docking)


@pytest.fixture(scope="session")
def flight(docking, point):
    """Its flight with all three layers."""
    return ts.dock(docking, point)


BROWSER = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)

BROWSER_FLAGS = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--virtual-time-budget=20000",
    "--dump-dom",
]


@pytest.fixture(scope="session")
def browser():
    """Path of a browser; without one the test is skipped."""
    if BROWSER is None:
        pytest.skip("NO BROWSER: pages are NOT tested in one; install Debian's chromium (apt-get install chromium)")
    return BROWSER


@pytest.fixture
def browsed(browser, tmp_path):
    """Return a function from a page and a fragment to the page as a headless browser has it once it is loaded."""

    def shown(page: Path, fragment: str = "") -> str:
        profile = f"--user-data-dir={tmp_path / 'profile'}"
        command = [browser, *BROWSER_FLAGS, profile, f"{page.as_uri()}{fragment}"]
        return subprocess.run(command, capture_output=True, text=True, timeout=120, check=True).stdout

    return shown
