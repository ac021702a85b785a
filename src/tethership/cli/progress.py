"""Progress on standard error: stages of seconds and work of minutes. Depends on: rich, typer.

A bar on a terminal; elsewhere (a log, a batch queue) a plain line every half minute, and nothing for shorter work.
"""

import math
import sys
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager

import typer

Report = Callable[[str, float], None]
"""Called with what is being done and the share of the whole that is done, 0 … 1."""

QUIET = 30.0
"""Time between two plain lines [s]."""

RECENT = 60.0
"""Time over which it is judged how fast work goes on [s]."""


class Pace:
    """How fast work goes on, by what was reported in the last minute, or by the last two reports if they are rarer."""

    def __init__(self) -> None:
        self._seen: deque[tuple[float, float]] = deque()

    def rate(self, done: float) -> float | None:
        """Take down how much is done and return how much that is in a second, None while it is not known."""
        now = time.monotonic()
        self._seen.append((now, done))
        while len(self._seen) > 2 and self._seen[1][0] <= now - RECENT:
            self._seen.popleft()
        then, before = self._seen[0]
        return (done - before) / (now - then) if done > before and now > then else None


@contextmanager
def progress_bar(title: str, resumed: bool = False) -> Iterator[Report]:
    """Show progress with the time left while the body runs; yields a function to call with (text, share done).

    Parameters
    ----------
    title : str
        Of the work.
    resumed : bool
        The first report says what was done before the work began; without it the work begins with nothing done.
    """
    pace = Pace()
    if not resumed:
        pace.rate(0.0)

    def left(share: float) -> float | None:
        rate = pace.rate(share)
        return (1.0 - share) / rate if rate is not None else None

    if sys.stderr.isatty():
        with _bar(title, left) as report:
            yield report
    else:
        yield _plain_lines(title, left)


@contextmanager
def stage(name: str) -> Iterator[Report]:
    """Show a stage of seconds on a terminal, and the time it took [s] once it is over; nothing elsewhere."""
    if not sys.stderr.isatty():
        yield lambda text, share: None
        return
    begun = time.perf_counter()
    try:
        with progress_bar(name) as report:
            yield report
    finally:
        typer.echo(f"  {name:<28} {time.perf_counter() - begun:6.2f} s", err=True)


@contextmanager
def flying(limit: float = math.inf) -> Iterator[Callable[[float], None]]:
    """Show a flight of at most `limit` [s]: it compiles until it first tells the time that it has reached [s]."""
    with ExitStack() as shown:
        shown.enter_context(stage("compile"))
        report: Report | None = None
        most = f" of at most {limit:.0f} s" if limit < math.inf else ""

        def reached(now: float) -> None:
            nonlocal report
            if report is None:
                shown.close()
                report = shown.enter_context(stage("fly"))
            report(f"fly: {now:.1f} s{most}", now / limit)

        yield reached


def _plain_lines(title: str, left: Callable[[float], float | None]) -> Report:
    """Return a report that prints a line now and then."""
    begun = last = time.monotonic()

    def report(text: str, share: float) -> None:
        nonlocal last
        now, rest = time.monotonic(), left(share)
        if now - last >= QUIET:
            last = now
            words = "" if rest is None else f", {rest:.0f} s left"
            print(f"{title}: {100 * share:.0f} %, {text}, {now - begun:.0f} s{words}", file=sys.stderr, flush=True)

    return report


@contextmanager
def _bar(title: str, left: Callable[[float], float | None]) -> Iterator[Report]:
    """Show a bar."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

    columns = (
        TextColumn("  {task.description}"),
        BarColumn(),
        TaskProgressColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("{task.fields[left]}"),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True, redirect_stdout=False) as bar:
        task = bar.add_task(f"{title:<36}", total=None, left="")

        def report(text: str, share: float) -> None:
            rest = left(share)
            words = "" if rest is None else f"{rest:.0f} s left"
            bar.update(task, description=f"{text:<36}", total=1.0, completed=share, left=words)

        yield report
