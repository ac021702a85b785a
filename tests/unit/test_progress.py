"""Progress where there is no terminal: nothing for short work, a plain line with the time left for long."""

import time

from tethership.cli import progress
from tethership.cli.progress import progress_bar


def test_short_work_is_quiet_and_long_work_says_how_far_it_is(capsys, monkeypatch):
    with progress_bar("fit") as report:
        report("first", 0.1)
    assert capsys.readouterr().err == ""
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    with progress_bar("fit") as report:
        for _ in range(5):
            now[0] += progress.QUIET / 2
            report("evolution", 0.25)
    lines = capsys.readouterr().err.splitlines()
    assert lines == ["fit: 25 %, evolution, 30 s, 90 s left", "fit: 25 %, evolution, 60 s, 180 s left"]
