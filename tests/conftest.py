"""Shared starts: a scenario, its trim and one flight, computed once per worker."""

import contextlib
import ctypes
import gc
import json
import os
import shutil
import signal
import subprocess
import threading
from pathlib import Path

import equinox as eqx
import jax
import matplotlib.image
import numpy as np
import pytest

import tethership as ts
from tethership import cli

MAPS = Path("/proc/self/maps")
MOST_MAPS = 20_000
"""Every compiled program keeps hundreds of memory maps; Linux allows a process 65 530 and XLA aborts beyond."""

STATM = Path("/proc/self/statm")
MOST_MEMORY = 1.8e9
"""Resident memory [byte] above which compiled programs are forgotten: two workers then stay below 5 GB together."""

SLOW_FIXTURES = {"browser", "browsed", "cluster", "study"}
"""What makes a test slow: Chromium, a Dask cluster, the paper's study. Other slow tests carry the mark themselves."""


def pytest_collection_modifyitems(items):
    """Mark as slow what asks for a slow fixture."""
    for item in items:
        if SLOW_FIXTURES & set(getattr(item, "fixturenames", ())):
            item.add_marker(pytest.mark.slow)


def resident():
    """Return the memory of this process that lies in RAM [byte]; 0 where the system does not say."""
    return int(STATM.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") if STATM.exists() else 0


def _forget_programs():
    """Forget compiled programs, of which the compilation cache has a copy, and hand their memory back."""
    before = resident()
    eqx.clear_caches()
    jax.clear_caches()
    gc.collect()
    with contextlib.suppress(OSError, AttributeError):  # glibc keeps what is freed until it is asked
        ctypes.CDLL("libc.so.6").malloc_trim(0)
    print(f"compiled programs forgotten: {before / 1e9:.2f} -> {resident() / 1e9:.2f} GB")


@pytest.fixture(autouse=True)
def _room_for_memory():
    """Forget programs before a process has too much memory: after a test, since one module may take 2 GB."""
    yield
    if resident() > MOST_MEMORY:
        _forget_programs()


@pytest.fixture(autouse=True, scope="module")
def _room_for_maps():
    """Forget programs before a process has no maps left; counting them takes a while."""
    yield
    if MAPS.exists() and MAPS.read_bytes().count(b"\n") > MOST_MAPS:
        _forget_programs()


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


def _descendants(pid):
    """Return the processes that a process started, and theirs."""
    children = [int(c) for task in Path(f"/proc/{pid}/task").glob("*/children") for c in task.read_text().split()]
    return children + [other for child in children for other in _descendants(child)]


@pytest.fixture(scope="session")
def limited():
    """Kill what was started after `known` where a block that cannot be told a limit takes longer: a browser's end."""

    def kill(known):
        for pid in set(_descendants(os.getpid())) - known:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)

    @contextlib.contextmanager
    def within(seconds, known):
        timer = threading.Timer(seconds, kill, [known])
        timer.start()
        try:
            yield
        finally:
            timer.cancel()

    within.known = lambda: set(_descendants(os.getpid()))
    return within


def _is_whole(path):
    """Return whether a written file is what its name says, to its end: a drawn picture, a page, JSON, a flight."""
    match path.suffix:
        case ".png":
            pixels = matplotlib.image.imread(path)[..., :3]
            inked = np.abs(pixels - pixels[0, 0]).max(axis=-1) > 0.1
            rows, columns = inked.any(axis=1).mean(), inked.any(axis=0).mean()
            return 0.005 < inked.mean() < 0.95 and rows > 0.5 and columns > 0.5
        case ".html":
            text = path.read_text(encoding="utf-8").rstrip()
            return text.lower().startswith("<!doctype html>") and text.endswith("</html>")
        case ".json":
            return bool(json.loads(path.read_text(encoding="utf-8")))
        case ".nc":
            return len(ts.Flight.load(path).data["time"]) > 1
    raise AssertionError(f"what is {path}?")


@pytest.fixture(scope="session")
def is_whole():
    """Tell of a file that was written whether it is whole; an empty picture or a cut page is not."""
    return _is_whole


@pytest.fixture
def command(capsys, monkeypatch):
    """Run a command in this process: words to exit code, standard output and standard error."""

    def run(*words):
        monkeypatch.setattr("sys.argv", ["tethership", *words])
        with pytest.raises(SystemExit) as caught:
            cli.main()
        out, err = capsys.readouterr()
        return caught.value.code, out, err

    return run
