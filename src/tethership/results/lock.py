"""One at a time in a folder. Depends on: filelock, results.files, errors."""

import contextlib
import errno
import json
import os
import socket
import time
import warnings
from collections.abc import Iterator
from pathlib import Path

from filelock import BaseFileLock, FileLock, Timeout

from tethership.errors import ConfigError, TethershipWarning
from tethership.results.files import ELSEWHERE, write_atomically

LOCK, HOLDER = ".tethership-lock", ".tethership-lock.json"


@contextlib.contextmanager
def held(folder: Path) -> Iterator[None]:
    """Hold a folder, which is made, for as long as something runs in it.

    Raises
    ------
    ConfigError
        Another process holds it, which is named; or it cannot be written.

    Notes
    -----
    The system holds the lock and frees it when its process ends, however that ends: none is ever stale. Who holds it
    is written beside it.
    """
    lock = FileLock(folder / LOCK, timeout=0)
    _acquire(lock, folder)
    try:
        since = time.strftime("%Y-%m-%d %H:%M:%S %z")
        holder = {"host": socket.gethostname(), "process": os.getpid(), "since": since}
        write_atomically(folder / HOLDER, json.dumps(holder))
        yield
    finally:
        (folder / HOLDER).unlink(missing_ok=True)
        lock.release()


def _acquire(lock: BaseFileLock, folder: Path) -> None:
    """Take a folder's lock; on a disk that knows no locks, say so and go on."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        lock.acquire()
    except Timeout:
        raise ConfigError(f"{folder} is in use by {_holder(folder)}; wait until that ends, or {ELSEWHERE}") from None
    except (OSError, NotImplementedError) as error:
        if isinstance(error, OSError) and error.errno not in (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP):
            raise ConfigError(f"cannot write into {folder}: {error.strerror or error}; {ELSEWHERE}") from error
        warnings.warn(
            f"{folder} is on a disk without locks: see that nothing else writes there", TethershipWarning, stacklevel=4
        )


def _holder(folder: Path) -> str:
    """Return who holds a folder, in words."""
    try:
        holder = json.loads((folder / HOLDER).read_text(encoding="utf-8"))
        return f"process {holder['process']} of {holder['host']}, since {holder['since']}"
    except (OSError, ValueError, KeyError, TypeError):
        return "another process"
