"""Flying a campaign's batches on the workers of a Dask cluster. Depends on: distributed, campaign.hands."""

import contextlib
import logging
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, cast

from tethership._extras import needs
from tethership._version import __version__
from tethership.campaign.hands import Hands
from tethership.errors import ConfigError, SolveError

CONNECT = 10.0
"""How long a scheduler is waited for [s]."""

ANSWER = 120.0
"""How long workers of a cluster are waited for to say their version: they import the package first [s]."""

PATIENCE = 120.0
"""How long a cluster may be without any worker [s]."""

RETRIES = 3
"""How often a batch is given to another worker of a cluster when one died over it."""


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
    try:
        _check_workers(client, address)
        threads = sum(cast(dict[str, int], client.nthreads()).values())
        yield Hands(client.get_executor(retries=RETRIES), threads, watch=_Watch(client).look)
    finally:
        with contextlib.suppress(OSError, TimeoutError):  # a scheduler that is gone or hangs
            client.close(timeout=CONNECT)


class _Watch:
    """How long a cluster has been without workers: what was given to it would then be waited for without end."""

    def __init__(self, client: Any) -> None:
        self._client, self._seen = client, time.monotonic()

    def look(self) -> None:
        """Raise SolveError where there has been no worker for `PATIENCE`."""
        if self._client.nthreads():
            self._seen = time.monotonic()
        elif time.monotonic() - self._seen > PATIENCE:
            raise SolveError(
                f"the cluster has had no worker for {PATIENCE:g} s: start some again; the same command goes on from "
                "the last batch"
            )


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
    try:
        found = client.sync(client._run, _worker_version, on_error="return", callback_timeout=ANSWER)
    except TimeoutError as error:
        raise ConfigError(
            f"a worker of {address} does not answer within {ANSWER:g} s; end it, or start it again"
        ) from error
    for worker, version in found.items():
        if version != __version__:
            what = f"tethership {version}" if isinstance(version, str) else "no tethership that can be imported"
            raise ConfigError(
                f"worker {worker} of {address} has {what}; here it is {__version__}: install the same on all workers"
            )
