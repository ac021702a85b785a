"""What a user waits for, from the shell: CPU seconds of all processes, beside `python -c "import jax"` in the same run.

Depends on: the installed command alone, and for the explorer Playwright and Chromium (left out without them). Cold is
an empty cache folder, warm the same command again. `--quick` leaves the long rows out. See README.md for the claims.
"""

import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

TETHERSHIP = [sys.executable, "-m", "tethership"]

TAB = {"_TETHERSHIP_COMPLETE": "complete_bash", "COMP_WORDS": "tethership dock do", "COMP_CWORD": "2"}

OTHER_LAYERS = """
import time
import tethership as ts
scenario = ts.load_scenario("docking")
point = ts.trim(scenario)
ts.dock(scenario, point)
begun = time.process_time()
ts.dock(scenario, point, layers=("rewind",))
print(time.process_time() - begun)
"""
"""Another set of layers in a process that has flown: prints its CPU seconds."""

OTHER_NAMES = """
title = "Other names"
scenario = "docking"
samples = 20
seed = 1
[vary."vehicle.body.mass"]
distribution = "uniform"
low = 120.0
high = 130.0
unit = "kg"
"""
"""A campaign over what no packaged one varies."""

BUDGET = 600.0
"""Longest wait for one row [s]."""


class Claim(NamedTuple):
    """One row: what is run, what it may take [CPU s], and with which variables; a script prints its own seconds."""

    name: str
    words: list[str]
    reach: float
    variables: dict[str, str] | None = None
    script: bool = False


def claims() -> list[Claim]:
    """Return the rows that are run from the shell; the first ones are quick."""
    return [
        Claim("--version", [*TETHERSHIP, "--version"], 0.3),
        Claim("--help", [*TETHERSHIP, "--help"], 0.3),
        Claim("dock --help", [*TETHERSHIP, "dock", "--help"], 0.3),
        Claim("one Tab", TETHERSHIP, 0.3, TAB),
        Claim("trim", [*TETHERSHIP, "trim"], 2.0),
        Claim("modes", [*TETHERSHIP, "modes"], 3.0),
        Claim("dock", [*TETHERSHIP, "dock"], 3.0),
        Claim("another set of layers, warm process", [sys.executable, "-c", OTHER_LAYERS], 0.2, script=True),
        Claim("campaign gusts --samples 20", [*TETHERSHIP, "campaign", "gusts", "--samples", "20"], 12.0),
        Claim("campaign of other names, 20", [*TETHERSHIP, "campaign", "other.toml"], 12.0),
        Claim("campaign gusts --samples 1000", [*TETHERSHIP, "campaign", "gusts", "--samples", "1000"], 10.0),
    ]


QUICK = ("--version", "--help", "dock --help", "one Tab", "trim")

VIEWS = {"trim": (None, 3.0), "root locus": ("Root locus", 5.0), "flight": ("Flight", 4.0)}
"""Views of the explorer, each after a fresh start: the tab that is chosen, and what it may take [CPU s]."""

SHOWN = """view => document.querySelector("#state").className === "state good"
  && [...document.querySelectorAll("[id*='" + view + "'].view")].some(
    e => e.offsetParent && !e.classList.contains("stale") && e.innerText.trim())"""
"""Whether a view is there and answers what is asked."""


def spent(words: list[str], place: Path, variables: dict[str, str]) -> tuple[float, str]:
    """Return the CPU seconds of a command and of all that it starts, and what it printed."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(words, cwd=place, env=variables, capture_output=True, text=True, timeout=BUDGET, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise SystemExit(f"{' '.join(words)} ended with {done.returncode}: {done.stderr.strip()[-500:]}")
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, done.stdout


def environment(cache: Path, **more: str) -> dict[str, str]:
    """Return the variables of a user whose caches lie in a folder, and nowhere else."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith(("JAX_", "XLA_", "EQX_"))}
    found = [os.path.abspath(place) for place in kept.get("PYTHONPATH", "").split(os.pathsep) if place]
    return kept | {"XDG_CACHE_HOME": str(cache), "PYTHONPATH": os.pathsep.join(found)} | more


def measured(claim: Claim, cache: Path) -> float:
    """Return the CPU seconds of one row, in an empty folder."""
    with tempfile.TemporaryDirectory() as place:
        (Path(place) / "other.toml").write_text(OTHER_NAMES, encoding="utf-8")
        seconds, printed = spent(claim.words, Path(place), environment(cache, **(claim.variables or {})))
    return float(printed.split()[-1]) if claim.script else seconds


def tree(root: int) -> float:
    """Return the CPU seconds of a running process and of all that it has started, those that ended included [s]."""
    tick = os.sysconf("SC_CLK_TCK")
    found: dict[int, tuple[int, float]] = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            numbers = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        found[int(stat.parent.name)] = (int(numbers[1]), sum(map(int, numbers[11:15])) / tick)
    members = {root}
    while more := {child for child, (parent, _) in found.items() if parent in members} - members:
        members |= more
    return sum(found[member][1] for member in members if member in found)


def shown(view: str, cache: Path) -> float:
    """Return the CPU seconds of a freshly started explorer until a view is shown; the browser is not counted."""
    from playwright.sync_api import sync_playwright

    tab, _ = VIEWS[view]
    with tempfile.TemporaryDirectory() as place:
        words = [*TETHERSHIP, "explore", "--no-open", "--json", "--port", "0"]
        served = subprocess.Popen(words, cwd=place, env=environment(cache), stdout=subprocess.PIPE, text=True)
        try:
            assert served.stdout is not None
            address = json.loads(served.stdout.readline())["address"]
            with sync_playwright() as api:
                browser = api.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
                page = browser.new_page()
                page.goto(address)
                if tab is not None:
                    page.locator("#tab").get_by_text(tab).click()
                page.wait_for_function(SHOWN, arg=view.rpartition(" ")[2], timeout=BUDGET * 1e3)
                seconds = tree(served.pid)
                browser.close()
            return seconds
        finally:
            served.send_signal(signal.SIGTERM)
            served.wait(30)


def rows(quick: bool, cache: Path) -> Iterator[tuple[str, float, float, float]]:
    """Yield name, CPU seconds cold and warm, and those to be reached."""
    for claim in claims():
        if claim.name in QUICK or not quick:
            yield claim.name, measured(claim, cache), measured(claim, cache), claim.reach
    if quick:
        return
    try:
        import playwright.sync_api  # noqa: F401
    except ImportError:
        print("no Playwright: the explorer is left out", file=sys.stderr)
        return
    if shutil.which("chromium") is None:
        print("no Chromium: the explorer is left out", file=sys.stderr)
        return
    for view, (_, reach) in VIEWS.items():
        yield f"explorer, first {view}", shown(view, cache), shown(view, cache), reach


def importing_jax(cache: Path) -> float:
    """Return the CPU seconds of `python -c "import jax"`, the least of three."""
    with tempfile.TemporaryDirectory() as place:
        return min(spent([sys.executable, "-c", "import jax"], Path(place), environment(cache))[0] for _ in range(3))


def main() -> None:
    """Print the figures; with --json as one object."""
    begun = time.perf_counter()
    found = []
    with tempfile.TemporaryDirectory() as folder:
        cache = Path(folder)
        unit = importing_jax(cache)
        print(f"import jax: {unit:.2f} CPU s; in brackets times that", file=sys.stderr)
        print(f"{'CPU s':<36}{'cold':>16}{'warm':>16}{'to reach':>10}", file=sys.stderr)
        for name, cold, warm, reach in rows("--quick" in sys.argv, cache):
            verdict = "" if warm <= reach else "  missed"
            cells = "".join(f"{f'{value:.2f} ({value / unit:.1f})':>16}" for value in (cold, warm))
            print(f"{name:<36}{cells}{reach:>10g}{verdict}", file=sys.stderr, flush=True)
            found.append({"name": name, "cold": cold, "warm": warm, "reach": reach})
    print(f"measured in {time.perf_counter() - begun:.0f} s", file=sys.stderr)
    if "--json" in sys.argv:
        print(json.dumps({"import_jax": unit, "rows": found}))


if __name__ == "__main__":
    main()
