"""Progress: stages and bars on a terminal; elsewhere nothing for short work, a plain line now and then for long."""

import re
import sys
import time

from tethership.cli import progress
from tethership.cli.campaign import _counted
from tethership.cli.progress import flying, progress_bar, stage


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


def test_work_gone_on_with_is_judged_by_what_this_run_does(capsys, monkeypatch):
    """900 of 1000 flights stood; this run flew 10 in a minute, then 60 in another: 30 s are left."""
    now = [100.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    with progress_bar("campaign", resumed=True) as report:
        count = _counted(report)
        for after, done in ((0.0, 900), (60.0, 910), (60.0, 970)):
            now[0] += after
            count(done, 1000)
    lines = capsys.readouterr().err.splitlines()
    assert lines == [
        "campaign: 91 %, 910 of 1000 flights, 0.167/s, 60 s, 540 s left",
        "campaign: 97 %, 970 of 1000 flights, 1/s, 120 s, 30 s left",
    ]


def test_where_nothing_moves_no_time_is_promised(capsys, monkeypatch):
    """After a minute without progress the last pace says nothing of what is left."""
    now = [0.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])
    with progress_bar("fit") as report:
        for after in (10.0, 40.0, 70.0):
            now[0] += after
            report("evolution", 0.5)
    assert capsys.readouterr().err.splitlines() == [
        "fit: 50 %, evolution, 50 s, 50 s left",
        "fit: 50 %, evolution, 120 s",
    ]


def fly_and_draw():
    with flying(60.0) as reached:
        reached(15.0)
        reached(60.0)
    with stage("draw"):
        pass


def test_stages_are_quiet_where_there_is_no_terminal(capsys):
    fly_and_draw()
    assert capsys.readouterr() == ("", "")


def test_stages_on_a_terminal_leave_the_time_they_took(capsys, monkeypatch):
    """A flight compiles until it first tells how far it is; standard output stays for the result."""
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True)
    fly_and_draw()
    out, err = capsys.readouterr()
    assert out == ""
    assert re.findall(r"^.*?(\w+) +\d+\.\d\d s$", err, re.MULTILINE) == ["compile", "fly", "draw"]
