"""Requests and what became of them: one at a time, every result kept under its own request.

Depends on: explorer.standing, explorer.worker.
"""

import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

from tethership.errors import TethershipError
from tethership.explorer.standing import Request, Standing
from tethership.explorer.worker import GRACE, Stopped, Worker

KEPT = 60
"""Results that are kept: those that were asked for last."""

AHEAD = ""
"""The client that asks for what a page will ask for first; every page goes before it."""

REPLACED = 30.0
"""How long a job that nobody waits for may take to notice it [s]: what it compiles serves the next one too."""

GONE = 3.0
"""How long nobody may ask after running work while other work waits: its page was closed [s]."""

FORGOTTEN = 150.0
"""The same while nothing waits; browsers let a hidden page ask only once a minute [s]."""

LAST = {"trim": 0, "locus": 1, "flight": 2}
"""Order in which waiting views are computed: the quick ones first."""


class Desk:
    """Takes requests and has them computed one after the other; safe to use from any thread.

    Work for which nobody has asked for `GONE` [s] while other work waits, or for `FORGOTTEN` [s] while none does, is
    stopped.

    Parameters
    ----------
    worker : Worker
        Computes; a stand-in in tests.
    """

    def __init__(self, worker: Worker) -> None:
        self.worker = worker
        self._standings: OrderedDict[Request, Standing] = OrderedDict()
        self._wanted: dict[tuple[str, str], Request] = {}
        self._seen: dict[Request, float] = {}
        self._running: Request | None = None
        self._askings = 0
        self._stopping: float | None = None
        self._closed = False
        self._changed = threading.Condition()
        self._thread = threading.Thread(target=self._work, name="tethership-desk", daemon=True)
        self._thread.start()

    def ask(self, client: str, request: Request, patience: float = 0.0) -> Standing:
        """Return how a request stands; a new one waits, and replaces the client's earlier one of the same view.

        Parameters
        ----------
        client : str
            Who asks: a page.
        request : Request
            For what.
        patience : float
            How long its end is waited for [s].
        """
        with self._changed:
            former = self._wanted.get((client, request.view))
            self._wanted[client, request.view] = request
            self._seen[request] = time.monotonic()
            if former is not None and former != request:
                self._drop(former)
            standing = self._standings.get(request)
            if standing is None:
                self._askings += 1
                now = time.monotonic()
                standing = Standing(request, "waiting", "waiting", begun=now, asking=self._askings, asked=now)
                self._standings[request] = standing
                self._trim_kept()
                self._changed.notify_all()
            self._standings.move_to_end(request)
            self._changed.wait_for(lambda: not self._goes_on(request), patience)
            return self._standings.get(request, standing)

    def cancel(self, client: str) -> None:
        """Cancel all that a client waits for."""
        with self._changed:
            for (owner, _), request in self._wanted.items():
                standing = self._standings.get(request)
                if owner == client and standing is not None and standing.busy:
                    self._standings[request] = standing._replace(
                        status="cancelled", text="cancelled", seconds=time.monotonic() - standing.begun
                    )
                    self._stop(request, GRACE)
            if self._stopping is not None:  # what was replaced has no more time either
                self._stopping = GRACE
            self._changed.notify_all()

    def forget(self, request: Request) -> None:
        """Forget what has ended, so that asking again computes again."""
        with self._changed:
            if request in self._standings and not self._standings[request].busy:
                del self._standings[request]

    def find(self, wanted: Callable[[Request], bool]) -> Request | None:
        """Return a request that is kept and wanted, if there is one."""
        with self._changed:
            return next(filter(wanted, self._standings), None)

    def done(self, view: str, key: str) -> Standing | None:
        """Return what has been computed of a view under a request's key, if it is kept."""
        with self._changed:
            found = (one for request, one in self._standings.items() if (request.view, request.key) == (view, key))
            return next((one for one in found if one.status == "done"), None)

    def close(self) -> None:
        """Stop everything and end the computing process."""
        with self._changed:
            self._closed, self._stopping = True, GRACE
            self._changed.notify_all()
        self.worker.close()
        self._thread.join(5.0)

    def _drop(self, request: Request) -> None:
        """Let go of a request that nobody waits for any more."""
        standing = self._standings.get(request)
        if standing is None or not standing.busy or request in self._wanted.values():
            return
        del self._standings[request]
        self._stop(request, REPLACED)

    def _stop(self, request: Request, grace: float) -> None:
        """Have a request that runs stop within some time [s]."""
        if request == self._running:
            self._stopping = grace if self._stopping is None else min(grace, self._stopping)

    def _goes_on(self, request: Request) -> bool:
        """Return whether a request has not ended."""
        return not self._closed and request in self._standings and self._standings[request].busy

    def _trim_kept(self) -> None:
        """Keep only the results that were asked for last."""
        ended = [request for request, standing in self._standings.items() if not standing.busy]
        for request in ended[: max(0, len(ended) - KEPT)]:
            del self._standings[request]
        self._seen = {request: seen for request, seen in self._seen.items() if request in self._standings}

    def _next(self) -> Standing | None:
        """Wait for work and return it; None where the desk closes."""
        with self._changed:
            while not self._closed:
                waiting = [standing for standing in self._standings.values() if standing.status == "waiting"]
                if waiting:
                    pages = self._of_pages()
                    run = min(waiting, key=lambda one: (one.request not in pages, LAST[one.request.view], one.asking))
                    self._running = run.request
                    self._stopping = None
                    self._note(run, status="running", text="starting", begun=time.monotonic())
                    return run
                self._changed.wait()
        return None

    def _of_pages(self) -> set[Request]:
        """Return what pages want, and not only what is computed ahead of them."""
        return {request for (client, _), request in self._wanted.items() if client != AHEAD}

    def _note(self, run: Standing, **entries: Any) -> None:
        """Write down how a run stands, unless it was cancelled, dropped or asked for anew meanwhile."""
        with self._changed:
            standing = self._standings.get(run.request)
            if standing is not None and standing.busy and standing.asking == run.asking:
                self._standings[run.request] = standing._replace(**entries)
                self._changed.notify_all()

    def _work(self) -> None:
        """Compute requests until the desk closes."""
        while (run := self._next()) is not None:
            begun = time.monotonic()
            ended = self._outcome(run)
            self._note(run, seconds=time.monotonic() - begun, share=None, **ended)
            with self._changed:
                self._running = None

    def _outcome(self, run: Standing) -> dict[str, Any]:
        """Return how a run ended."""

        def progress(text: str, share: float | None) -> None:
            self._note(run, text=text, share=share)

        try:
            result = self.worker.run(run.request.job(), progress, self._told_to_stop)
        except Stopped:
            return {"status": "cancelled", "text": "cancelled"}
        except TethershipError as error:
            return {"status": "failed", "text": str(error)}
        return {"status": "done", "text": "", "result": result}

    def _told_to_stop(self) -> float | None:
        """Return how soon the running request is to end [s], if it is: told to, or its page has gone."""
        with self._changed:
            running = self._running
            if running is not None and self._stopping is None:
                pages = self._of_pages()
                waited_for = any(one.status == "waiting" and one.request in pages for one in self._standings.values())
                silence = time.monotonic() - self._seen.get(running, 0.0)
                if silence > (GONE if waited_for else FORGOTTEN):
                    self._standings.pop(running, None)
                    self._stopping = REPLACED
            return self._stopping
