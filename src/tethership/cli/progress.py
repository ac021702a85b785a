"""A progress bar on standard error for work of minutes. Depends on: rich.

Nothing is shown where standard error is no terminal, so that logs and scripts stay clean.
"""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Report = Callable[[str, float], None]
"""Called with what is being done and the share of the whole that is done, 0 … 1."""


@contextmanager
def progress_bar(title: str) -> Iterator[Report]:
    """Show a bar with the time left while the body runs; yields a function to call with (text, share done)."""
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    console = Console(stderr=True)
    columns = (
        TextColumn("  {task.description}"),
        BarColumn(),
        TextColumn("{task.percentage:>3.0f} %"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True, disable=not sys.stderr.isatty()) as bar:
        task = bar.add_task(title, total=1.0)

        def report(text: str, share: float) -> None:
            bar.update(task, description=f"{text:<36}", completed=share)

        yield report
