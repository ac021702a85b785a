"""What flies a campaign's batches: nothing of it is waited for without end.

Real processes, and a cluster's stand-in. If this fails, a command or the suite hangs until it is killed.
"""

import os
import time
from concurrent.futures import Executor, Future

import pytest

from tethership.campaign import cluster, execute, hands
from tethership.campaign.execute import fly_campaign
from tethership.campaign.hands import Hands, fresh_processes
from tethership.campaign.plan import make_plan
from tethership.campaign.store import CampaignStore
from tethership.errors import ConfigError, SolveError

STAY = "import threading, time; threading.Thread(target=time.sleep, args=(1000,)).start()"
"""Leaves a thread behind, on which a process waits before it ends."""


@pytest.fixture
def store(tmp_path):
    """A campaign of six batches, and its store."""
    plan = make_plan("layers", {"samples": 48})
    return plan, CampaignStore(tmp_path / "layers", plan)


def test_a_process_that_does_not_leave_is_ended(monkeypatch):
    monkeypatch.setattr(hands, "LEAVE", 0.5)
    with fresh_processes(1) as pool:
        number = pool.submit(os.getpid).result(120)
        pool.submit(exec, STAY).result(120)
    gone = time.monotonic() + 30
    while time.monotonic() < gone:
        try:
            os.kill(number, 0)
        except ProcessLookupError:
            return
        time.sleep(0.05)
    pytest.fail("the process is there still")


def test_a_caller_that_fails_waits_for_no_process():
    def failing():
        with fresh_processes(1) as pool:
            pool.submit(os.getpid).result(120)
            pool.submit(time.sleep, 1000)
            raise ConfigError("mine")

    with pytest.raises(ConfigError, match="mine"):
        failing()


def test_a_process_that_dies_is_told(store):
    """Whatever it does when it dies; here it ends as a kill would end it."""
    plan, place = store
    with (
        pytest.raises(SolveError, match="a worker process died; run the same command again"),
        fresh_processes(1) as pool,
    ):
        fly_campaign(plan, place, Hands(_Dying(pool), 1))


class _Dying(Executor):
    """Processes that end over whatever they are given."""

    def __init__(self, pool):
        self._pool = pool

    def submit(self, fn, /, *args, **kwargs):
        return self._pool.submit(os._exit, 1)


class _Silent(Executor):
    """Never gives anything back."""

    def submit(self, fn, /, *args, **kwargs):
        return Future()


class _Client:
    """A cluster's client, whose workers leave."""

    def __init__(self, *counts):
        self._counts = list(counts)

    def nthreads(self):
        return {"worker": 1} if self._counts.pop(0) else {}


def test_a_cluster_without_workers_is_not_waited_for_without_end(store, monkeypatch):
    plan, place = store
    monkeypatch.setattr(execute, "LISTEN", 0.01)
    monkeypatch.setattr(cluster, "PATIENCE", 0.05)
    client = _Client(1, 1, *[0] * 1000)
    with pytest.raises(SolveError, match=r"had no worker for 0\.05 s: start some again"):
        fly_campaign(plan, place, Hands(_Silent(), 1, watch=cluster._Watch(client).look))
    assert len(place.unfinished()) == 6


def test_threads_begin_when_what_they_share_is_ready(store, monkeypatch):
    plan, place = store
    done = []
    monkeypatch.setattr(execute, "make_ready", lambda work: done.append("ready"))

    class Noted(Executor):
        def submit(self, fn, /, *args, **kwargs):
            done.append("given")
            raise SolveError("enough")

    with pytest.raises(SolveError, match="enough"):
        fly_campaign(plan, place, Hands(Noted(), 1, here=True))
    assert done == ["ready", "given"]
