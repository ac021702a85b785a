"""Flying a campaign's batches: in this process, in others, or on a Dask cluster. Depends on: campaign.

One loop for all three: what can `submit` is given batches, a few more than it has hands, and what it returns is
written as it comes. Memory does not grow with the number of cases.
"""

import logging
import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor, wait
from concurrent.futures import CancelledError as Cancelled
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from typing import Any, NamedTuple, cast

import xarray as xr

from tethership._extras import needs
from tethership._version import __version__
from tethership.campaign.plan import Batch, Plan
from tethership.campaign.store import CampaignStore
from tethership.campaign.work import fly_batch
from tethership.errors import ConfigError, SolveError

CONNECT = 10.0
"""How long a scheduler is waited for [s]."""

RETRIES = 3
"""How often a batch is given to another worker of a cluster when one died over it."""

Progress = Callable[[int, int], None]
"""Called with the flights that are done and their total."""


class Hands(NamedTuple):
    """Whatever flies batches.

    Attributes
    ----------
    executor : Executor
    at_once : int
        Batches that it flies at once.
    """

    executor: Executor
    at_once: int


def fly_campaign(plan: Plan, store: CampaignStore, hands: Hands, progress: Progress | None = None) -> int:
    """Fly all batches that have not ended, and return how many flights were flown.

    Raises
    ------
    SolveError
        A worker died, or the cluster was lost.
    ConfigError
        Results cannot be written.
    """
    work = plan.work()
    unfinished = store.unfinished()
    waiting = iter(unfinished)
    total = len(plan.laws) * plan.cases
    left = sum(len(plan.batch(number).values) for number in unfinished)
    done, flown = total - left, 0
    running: dict[Future, Batch] = {}

    def start() -> None:
        while len(running) < hands.at_once + 2 and (number := next(waiting, None)) is not None:
            batch = plan.batch(number)
            running[hands.executor.submit(fly_batch, work, batch)] = batch

    if progress is not None:
        progress(done, total)
    start()
    while running:
        ready, _ = wait(running, return_when=FIRST_COMPLETED)
        for future in ready:
            batch = running.pop(future)
            store.keep(batch, _result(future))
            flown += len(batch.values)
            if progress is not None:
                progress(done + flown, total)
        start()
    return flown


def _result(future: Future) -> Any:
    """Return what a batch gave, or raise SolveError that says what to do where its worker died."""
    try:
        return future.result()
    except BrokenProcessPool as error:
        raise SolveError("a worker process died; run the same command again to go on from the last batch") from error
    except ModuleNotFoundError as error:
        raise ConfigError(f"a worker lacks {error.name}; install tethership {__version__} where it runs") from error
    except Exception as error:
        if not isinstance(error, Cancelled) and type(error).__module__.partition(".")[0] != "distributed":
            raise
        raise SolveError(
            f"the cluster was lost ({type(error).__name__}): its scheduler or too many workers died. Start it again; "
            "the same command goes on from the last batch"
        ) from error


@contextmanager
def in_this_process() -> Iterator[Hands]:
    """Fly two batches at once on two threads: JAX lets go of Python's lock."""
    _load_for_threads()
    count = min(2, os.cpu_count() or 1)
    with _ended(ThreadPoolExecutor(count)) as pool:
        yield Hands(pool, count)


def _load_for_threads() -> None:
    """Have xarray import what it looks for with its first dataset (Dask, pint): threads would meet it half made."""
    xr.Dataset({"value": ("time", [0.0])}, {"time": [0.0], "name": ["text"]}).mean()


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
    """Give a pool and end it at once where the caller fails."""
    try:
        yield pool
    except BaseException:
        for process in list((getattr(pool, "_processes", None) or {}).values()):
            process.terminate()
        pool.shutdown(wait=False, cancel_futures=True)
        raise
    else:
        pool.shutdown()


@contextmanager
def on_cluster(address: str) -> Iterator[Hands]:
    """Fly on the workers of a Dask cluster.

    Parameters
    ----------
    address : str
        Of its scheduler, e.g. tcp://127.0.0.1:8786.

    Raises
    ------
    ConfigError
        Dask's `distributed` is not installed, the scheduler does not answer, it has no workers, or a worker lacks this
        version of the package.
    """
    with needs("cluster"):
        from distributed import Client
    for name in ("distributed", "distributed.client"):  # a scheduler that dies would fill the screen
        logging.getLogger(name).handlers[:] = [logging.NullHandler()]
    try:
        client = Client(address, timeout=CONNECT)
    except (OSError, TimeoutError, ValueError) as error:
        raise ConfigError(f"no scheduler answers at {address}: start one with `dask scheduler`, or check it") from error
    with client:
        _check_workers(client, address)
        threads = sum(cast(dict[str, int], client.nthreads()).values())
        yield Hands(client.get_executor(retries=RETRIES), threads)


def _worker_version() -> str:
    """Return the version of the package where this runs: a cluster calls it by name."""
    return __version__


def _check_workers(client: Any, address: str) -> None:
    """Raise ConfigError where a cluster cannot fly."""
    try:
        client.wait_for_workers(1, timeout=CONNECT)
    except TimeoutError as error:
        raise ConfigError(
            f"the scheduler at {address} has no workers; start some with `dask worker {address}`"
        ) from error
    found = client.run(_worker_version, on_error="return")
    for worker, version in found.items():
        if version != __version__:
            what = f"tethership {version}" if isinstance(version, str) else "no tethership that can be imported"
            raise ConfigError(
                f"worker {worker} of {address} has {what}; here it is {__version__}: install the same on all workers"
            )
