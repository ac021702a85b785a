"""Progress on standard error for work of minutes. Depends on: rich.

A bar on a terminal; elsewhere (a log, a batch queue) a plain line every half minute, and nothing for shorter work.
"""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Report = Callable[[str, float], None]
"""Called with what is being done and the share of the whole that is done, 0 … 1."""

QUIET = 30.0
"""Time between two plain lines [s]."""


@contextmanager
def progress_bar(title: str) -> Iterator[Report]:
    """Show progress with the time left while the body runs; yields a function to call with (text, share done)."""
    if sys.stderr.isatty():
        with _bar(title) as report:
            yield report
    else:
        yield _plain_lines(title)


def _plain_lines(title: str) -> Report:
    """Return a report that prints a line now and then."""
    begun = last = time.monotonic()

    def report(text: str, share: float) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= QUIET:
            last = now
            left = f", {(now - begun) * (1.0 / share - 1.0):.0f} s left" if share > 0 else ""
            print(f"{title}: {100 * share:.0f} %, {text}, {now - begun:.0f} s{left}", file=sys.stderr, flush=True)

    return report


@contextmanager
def _bar(title: str) -> Iterator[Report]:
    """Show a bar."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (
        TextColumn("  {task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task(title, total=1.0)

        def report(text: str, share: float) -> None:
            bar.update(task, description=f"{text:<36}", completed=share)

        yield report
