"""Flying a campaign's batches: in this process, in others, or on a Dask cluster. Depends on: campaign.

One loop for all three: what can `submit` is given batches, a few more than it has hands, and what it returns is
written as it comes. Memory does not grow with the number of cases.
"""

from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from concurrent.futures import CancelledError as Cancelled
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from tethership._version import __version__
from tethership.campaign.cluster import on_cluster as on_cluster
from tethership.campaign.hands import Hands as Hands
from tethership.campaign.hands import fresh_processes as fresh_processes
from tethership.campaign.hands import in_processes as in_processes
from tethership.campaign.hands import in_this_process as in_this_process
from tethership.campaign.plan import Batch, Plan
from tethership.campaign.store import CampaignStore
from tethership.campaign.work import fly_batch, make_ready
from tethership.errors import ConfigError, SolveError

LISTEN = 5.0
"""How often it is looked whether anything flies still, while nothing comes back [s]."""

Progress = Callable[[int, int], None]
"""Called with the flights that are done and their total."""


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
    if hands.here and unfinished:
        make_ready(work)  # before there are threads: two that import the same modules first can meet them half made
    start()
    while running:
        ready, _ = wait(running, LISTEN, FIRST_COMPLETED)
        if not ready:
            hands.watch()
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
