"""Whatever flies batches on this machine: threads of this process, or fresh processes. Depends on nothing."""

import multiprocessing
import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import connection
from typing import NamedTuple

LEAVE = 20.0
"""How long worker processes may take to end, all together [s]; one that hangs is killed."""


class Hands(NamedTuple):
    """Whatever flies batches.

    Attributes
    ----------
    executor : Executor
    at_once : int
        Batches that it flies at once.
    here : bool
        Whether it is this process, whose threads share what is made ready before they start.
    watch : callable
        Called while nothing comes back; raises SolveError where nothing can come any more.
    """

    executor: Executor
    at_once: int
    here: bool = False
    watch: Callable[[], None] = lambda: None


@contextmanager
def in_this_process() -> Iterator[Hands]:
    """Fly two batches at once on two threads: JAX lets go of Python's lock."""
    count = min(2, os.cpu_count() or 1)
    with _ended(ThreadPoolExecutor(count)) as pool:
        yield Hands(pool, count, here=True)


@contextmanager
def in_processes(workers: int) -> Iterator[Hands]:
    """Fly on so many fresh processes of this machine."""
    with fresh_processes(workers) as pool:
        yield Hands(pool, workers)


@contextmanager
def fresh_processes(count: int) -> Iterator[Executor]:
    """Give a pool of fresh processes (JAX does not survive a fork), ended at once where the caller fails."""
    with _ended(ProcessPoolExecutor(count, multiprocessing.get_context("spawn"))) as pool:
        yield pool


@contextmanager
def _ended(pool: Executor) -> Iterator[Executor]:
    """Give a pool and end it, at once where the caller fails."""
    try:
        yield pool
    except BaseException:
        _end_processes(pool, 0.0)
        raise
    else:
        _end_processes(pool, LEAVE)
        pool.shutdown()


def _end_processes(pool: Executor, patience: float) -> None:
    """Send a pool's processes home; those that have not left after a while [s] are ended: none is waited for."""
    processes = list((getattr(pool, "_processes", None) or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    limit = time.monotonic() + patience
    for process in processes:
        connection.wait([process.sentinel], max(limit - time.monotonic(), 0.0))
    left = [process for process in processes if process.is_alive()]
    for process in left:
        process.terminate()
    for process in left:
        if not connection.wait([process.sentinel], 1.0):
            process.kill()
