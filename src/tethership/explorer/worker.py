"""The computing process: warm, given one job at a time, stopped at once where it must be. Depends on: explorer.tasks.

It is spawned, never forked: JAX does not survive a fork. It ends with its parent however that ends.
"""

import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable
from functools import partial
from multiprocessing.connection import Connection
from typing import Any

from tethership.errors import ConfigError, SolveError, TethershipError

GRACE = 1.0
"""How long a cancelled job may take to notice that it is to stop before its process is ended [s]."""

LISTEN = 0.05
"""Time between two looks at whether to stop [s]."""

DIED = "The computing process ended (out of memory?); it was started again. Change something, or compute again."


class Stopped(TethershipError):
    """A job was told to stop."""


class Worker:
    """One computing process, started again after it had to be ended.

    A job that is told to stop has some time to notice, then its process is ended.
    """

    def __init__(self) -> None:
        self._context = multiprocessing.get_context("spawn")
        self._closed = False
        self._ending = threading.Lock()
        self._start()

    def _start(self) -> None:
        self._pipe, theirs = self._context.Pipe()
        self._stop = self._context.Event()
        self._process = self._context.Process(
            target=_serve, args=(theirs, self._stop), name="tethership-explorer", daemon=True
        )
        self._process.start()
        theirs.close()

    @property
    def pid(self) -> int | None:
        """Its process number."""
        return self._process.pid

    def run(
        self,
        job: tuple[Any, ...],
        progress: Callable[[str, float | None], None],
        should_stop: Callable[[], float | None],
    ) -> Any:
        """Return what a job gives; called from one thread only.

        Parameters
        ----------
        job : tuple
            Arguments of `tasks.compute` but the last.
        progress : callable
            Called with what is being done and the share that is done [-].
        should_stop : callable
            Asked every `LISTEN` [s]; returns how long the job may take to notice that it is to stop [s], None to go on.

        Raises
        ------
        Stopped
            It was told to stop.
        ConfigError, SolveError
            What the job raised.
        """
        self._stop.clear()
        try:
            self._pipe.send(job)
            return self._answer(progress, should_stop)
        except (EOFError, OSError) as error:
            self._again()
            raise SolveError(DIED) from error

    def _answer(self, progress: Callable[[str, float | None], None], should_stop: Callable[[], float | None]) -> Any:
        """Return the answer to the job that was sent."""
        told = None
        while True:
            if self._pipe.poll(LISTEN):
                kind, *content = self._pipe.recv()
                match kind:
                    case "progress":
                        progress(*content)
                    case "done":
                        return content[0]
                    case "stopped":
                        raise Stopped("stopped")
                    case "wrong":
                        raise ConfigError(content[0])
                    case _:
                        raise SolveError(content[0])
            grace = should_stop()
            if grace is not None:
                self._stop.set()
                told = time.monotonic() if told is None else told
                if time.monotonic() > told + grace:
                    self._again()
                    raise Stopped("stopped")

    def _again(self) -> None:
        """End the process and start a fresh one, unless it was closed meanwhile from another thread."""
        with self._ending:
            if not self._closed:
                self._end()
                self._start()

    def _end(self) -> None:
        """End the process: asked first, so that no file of the compilation cache is left half written.

        Done by one thread alone: a pipe that two close at once may be another file by the second time.
        """
        self._process.terminate()
        self._process.join(0.5)
        if self._process.is_alive():
            self._process.kill()
            self._process.join(5.0)
        self._pipe.close()

    def close(self) -> None:
        """End the process for good; from any thread."""
        with self._ending:
            if not self._closed:
                self._closed = True
                self._end()


def _serve(pipe: Connection, stop: Any) -> None:
    """Do jobs until the pipe closes; runs in the computing process."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, lambda number, frame: os._exit(0))
    threading.Thread(target=_end_with_parent, daemon=True).start()
    from tethership.explorer.tasks import compute

    def report(text: str, share: float | None) -> None:
        if stop.is_set():
            raise Stopped("stopped")
        pipe.send(("progress", text, share))

    while True:
        try:
            view, path, changes, options = pipe.recv()
        except (EOFError, OSError):
            return
        pipe.send(_done(partial(compute, view, path, changes, options, report)))


def _done(work: Callable[[], Any]) -> tuple[str, Any]:
    """Return what work gives, or how it failed, as plain data."""
    try:
        return "done", work()
    except Stopped:
        return "stopped", None
    except ConfigError as error:
        return "wrong", _line(error)
    except Exception as error:
        return "failed", _line(error) if isinstance(
            error, TethershipError
        ) else f"{type(error).__name__}: {_line(error)}"


def _line(error: Exception) -> str:
    """Return an error as one line."""
    return " ".join(str(error).split())[:600]


def _end_with_parent() -> None:
    """End this process as soon as its parent has ended, in the middle of any computation."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(0)
