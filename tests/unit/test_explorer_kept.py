"""What the explorer computes before it is asked, keeps, and draws over what was pinned.

If one of these failed, a page would wait for what is known already, or a comparison would leave something out.
"""

import copy
import threading
import time

import pytest

from tethership.errors import ConfigError
from tethership.explorer.choice import Form
from tethership.explorer.compare import GREY, PINNED, Pins, differences, drawn_over
from tethership.explorer.folder import Folder
from tethership.explorer.queue import AHEAD, Desk
from tethership.explorer.requests import Understanding
from tethership.explorer.server import Explorer
from tethership.explorer.tasks import compute
from tethership.explorer.worker import GRACE
from tethership.scenario.load import packaged_text

USUAL = ("wind.speed", "6", "12", "13")


class Clerk:
    """A stand-in for the computing process that gives every job back, once it is let."""

    def __init__(self):
        self.jobs, self.free, self.graces = [], threading.Event(), []
        self.free.set()

    def run(self, job, progress, should_stop):
        self.jobs.append(job)
        while not self.free.wait(0.005):
            grace = should_stop()
            if grace is not None:
                self.graces.append(grace)
                self.free.set()
        return {"job": job}

    def close(self):
        self.free.set()


@pytest.fixture
def desk():
    desk = Desk(Clerk())
    yield desk
    desk.close()


@pytest.fixture
def known(tmp_path):
    return Understanding(Folder(tmp_path))


def trim_at(known, speed):
    return known.request("trim", Form("docking", {"wind.speed": str(speed)}), USUAL)


def until(condition):
    end = time.monotonic() + 30.0
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.005)


def shown_texts(known, name):
    """Return what the page of a scenario says where nobody has typed anything."""
    from tethership.explorer.fields import groups

    return {field.name: field.text for rows in groups(known.base(name).config).values() for field in rows}


@pytest.mark.parametrize("name", ["docking", "hover", "mine.toml"])
def test_what_is_computed_first_is_what_a_page_asks_for_first(known, name):
    """To the letter: another key would be computed in vain, and the page would wait."""
    if name.endswith(".toml"):
        known.folder.save(name, packaged_text("scenarios", "docking"))
    ahead = {request.view: request for request in known.at_start(name)}
    form = Form(name, shown_texts(known, name))
    over = known.usual_span(ahead["locus"].span.name, name)[:3]
    for view, request in ahead.items():
        assert known.request(view, form, (ahead["locus"].span.name, *over)) == request
    assert list(ahead) == ["trim", "locus", "flight"]


def test_computing_begins_with_the_server_and_the_page_gets_what_is_there(tmp_path, monkeypatch):
    monkeypatch.setattr("tethership.explorer.server.Worker", Clerk)
    with Explorer("docking", tmp_path) as explorer:
        jobs = explorer.desk.worker.jobs
        until(lambda: len(jobs) == 3)
        assert [job[0] for job in jobs] == ["trim", "locus", "flight"]
        known = Understanding(Folder(tmp_path))
        request = known.request("trim", Form("docking", shown_texts(known, "docking")), USUAL)
        until(
            lambda: explorer.desk.done("flight", next(r for r in known.at_start("docking") if r.view == "flight").key)
        )
        assert explorer.desk.ask("page", request).status == "done"
        assert len(jobs) == 3


def test_a_file_that_names_files_outside_is_not_given_to_the_computing_process(tmp_path, monkeypatch):
    made = []
    monkeypatch.setattr("tethership.explorer.server.Worker", lambda: made.append(Clerk()) or made[0])
    text = packaged_text("scenarios", "docking").replace('vehicle = "lotte"', 'vehicle = "../ship.toml"')
    (tmp_path / "mine.toml").write_text(text)
    with pytest.raises(ConfigError, match="outside"):
        Explorer("mine.toml", tmp_path)
    assert made[0].jobs == []


def test_a_page_goes_before_what_nobody_has_asked_for(known, desk):
    desk.worker.free.clear()
    trim, locus, flight = known.at_start("docking")
    desk.ask(AHEAD, trim)
    until(lambda: desk.worker.jobs)
    desk.ask(AHEAD, locus)
    desk.ask(AHEAD, flight)
    desk.ask("page", flight)
    desk.worker.free.set()
    until(lambda: len(desk.worker.jobs) == 3)
    assert [job[0] for job in desk.worker.jobs] == ["trim", "flight", "locus"]


def test_what_is_computed_ahead_is_not_given_up_for_what_else_is(known, desk, monkeypatch):
    """It takes longer than a page would be waited for, and nobody asks after it meanwhile."""
    monkeypatch.setattr("tethership.explorer.queue.GONE", 0.02)
    desk.worker.free.clear()
    ahead = list(known.at_start("docking"))
    for request in ahead:
        desk.ask(AHEAD, request)
    until(lambda: desk.worker.jobs)
    time.sleep(0.2)
    desk.worker.free.set()
    until(lambda: all(desk.done(request.view, request.key) for request in ahead))
    assert desk.worker.graces == []


def test_going_back_computes_nothing(known, desk):
    for speed in (7, 8, 9):
        assert desk.ask("page", trim_at(known, speed), 20.0).status == "done"
    assert len(desk.worker.jobs) == 3
    for speed in (8, 7, 9):
        found = desk.ask("page", trim_at(known, speed))
        assert found.status == "done"
        assert found.result["job"][2] == {"wind.speed": float(speed)}
    assert len(desk.worker.jobs) == 3


def test_what_was_asked_for_long_ago_is_forgotten_first(known, desk, monkeypatch):
    monkeypatch.setattr("tethership.explorer.queue.KEPT", 3)
    for speed in (6, 7, 8, 6, 9, 10):  # 6 is looked at again
        desk.ask("page", trim_at(known, speed), 20.0)
    kept = [speed for speed in (6, 7, 8, 9, 10) if desk.find(lambda one, speed=speed: one == trim_at(known, speed))]
    assert {6, 9, 10} <= set(kept)
    assert 7 not in kept


def test_an_answer_waits_for_a_quick_result_and_not_for_a_slow_one(known, desk):
    desk.worker.free.clear()
    assert desk.ask("page", trim_at(known, 7), 0.05).busy
    threading.Timer(0.2, desk.worker.free.set).start()
    assert desk.ask("page", trim_at(known, 7), 20.0).status == "done"


def test_what_is_replaced_may_finish_compiling_and_what_is_cancelled_may_not(known, desk):
    """A process that is ended takes with it what it had compiled, which the next request would have used."""
    desk.worker.free.clear()
    desk.ask("page", trim_at(known, 7))
    until(lambda: desk.worker.jobs)
    desk.ask("page", trim_at(known, 8))
    until(lambda: desk.worker.graces)
    assert desk.worker.graces[0] > 5.0
    until(lambda: desk.ask("page", trim_at(known, 8)).status == "done")
    desk.worker.free.clear()
    desk.worker.graces.clear()
    desk.ask("page", trim_at(known, 9))
    until(lambda: len(desk.worker.jobs) == 3)
    desk.cancel("page")
    until(lambda: desk.worker.graces)
    assert desk.worker.graces[0] == GRACE


# Pinned


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    """Two results of every view: as it stands, and in 9 m/s of wind for 2 s."""
    known = Understanding(Folder(tmp_path_factory.mktemp("kept")))
    found = {}
    for view in ("trim", "locus", "flight"):
        over = ("wind.speed", "6", "8", "3")
        requests = [known.request(view, Form("docking", {"stop.time_limit": "2", **more}), over) for more in CHANGES]
        found[view] = [compute(*request.job(), lambda words, share: None) for request in requests]
    return found


CHANGES = ({}, {"wind.speed": "9", "cables.nose.length": "22"})


@pytest.mark.parametrize("view", ["trim", "locus", "flight"])
def test_both_are_drawn_the_pinned_one_in_grey(results, view):
    pinned, now = (result["figure"] for result in results[view])
    before = copy.deepcopy((pinned, now))
    both = drawn_over(now, pinned)
    assert (pinned, now) == before
    below = [trace for trace in both["data"] if trace.get("name") == PINNED]
    above = [trace for trace in both["data"] if trace.get("name") != PINNED]
    marks = [trace for trace in below if trace.get("mode") == "markers"]
    assert both["data"] == [*[trace for trace in below if trace not in marks], *above, *marks]
    assert all(trace["marker"]["symbol"].endswith("-open") for trace in marks)
    assert [trace["x"] for trace in above] == [trace["x"] for trace in now["data"]]
    drawn = [(trace["x"], trace["y"]) for trace in both["data"]]
    lacking = [trace for trace in pinned["data"] if (trace["x"], trace["y"]) not in drawn]
    assert all(trace["y"] in [other["y"] for other in above] and len(trace["x"]) == 2 for trace in lacking)  # limits
    for trace in below:
        looks = [trace.get("line", {}).get("color"), trace.get("marker", {}).get("line", {}).get("color")]
        assert GREY in looks
        assert not trace["showlegend"]


def test_axes_are_wide_enough_for_both():
    def figure(low, high):
        return {"data": [], "layout": {"xaxis": {"range": [low, high]}, "yaxis2": {"title": "y"}, "height": 3}}

    both = drawn_over(figure(0, 5), figure(-1, 4))
    assert both["layout"]["xaxis"]["range"] == [-1, 5]
    assert both["layout"]["yaxis2"] == {"title": "y"}


TOLD = {
    "trim": ("tension, nose", lambda result: result["tension"]["nose"], ".4f", "N"),
    "locus": (
        "pendulum, Re λ",
        lambda result: next(mode for mode in result["modes"] if mode["name"] == "pendulum")["eigenvalue"][0],
        ".4f",
        "1/s",
    ),
    "flight": ("mean tension", lambda result: result["metrics"]["tension_mean"], ".1f", "N"),
}
"""A number of each view: its words, where it stands, how it is told, its unit."""


@pytest.mark.parametrize("view", ["trim", "locus", "flight"])
def test_every_number_that_differs_is_told_and_no_other(results, view):
    pinned, now = results[view]
    assert list(differences(view, now, now)) == []
    rows = {words: entries for words, *entries in differences(view, now, pinned)}
    words, of, form, unit = TOLD[view]
    before, after = (format(of(result), form) for result in (pinned, now))
    assert rows[words][:2] == [before, after]
    assert rows[words][3] == unit
    assert float(rows[words][2]) == pytest.approx(float(after) - float(before), abs=1e-9)


def test_what_only_one_has_is_told():
    def flight(outcome, **more):
        base = dict.fromkeys(
            ("tension_max", "tension_mean", "rewind_rate_min", "theta_rms", "ADC", "E", "saturated_seconds"), 1.0
        )
        return {
            "outcome": outcome,
            "time": 3.0,
            "limits": [],
            "metrics": {**base, "clearance_min": 1.0, **more, "seconds_above": []},
        }

    rows = list(differences("flight", flight("docked", clearance_min=float("nan")), flight("time_limit")))
    assert rows == [("outcome", "time limit", "docked", "", ""), ("least hull clearance", "1.00", "–", "", "m")]


def test_pins_are_of_one_page_and_one_view_and_bounded(known, desk, monkeypatch):
    monkeypatch.setattr("tethership.explorer.compare.MOST_PINS", 2)
    pins = Pins()
    standing = desk.ask("page", trim_at(known, 7), 20.0)
    pins.toggle("page", "trim", standing)
    assert pins.of("page", "trim") is standing
    assert pins.of("page", "locus") is pins.of("other", "trim") is None
    pins.toggle("page", "trim", standing)
    assert pins.of("page", "trim") is None
    pins.toggle("page", "trim", None)
    assert pins.of("page", "trim") is None
    for client in ("a", "b", "c"):
        pins.toggle(client, "trim", standing)
    assert [client for client in "abc" if pins.of(client, "trim")] == ["b", "c"]
