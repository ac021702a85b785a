"""Ctrl-C in the seconds that modules take to load, at the start or later: one line and the end. Depends on nothing.

Importing this module sees to it, where Python was started as the command. Extension modules do not survive Python's
own KeyboardInterrupt while they load: they end in tracebacks or crash.
"""

import os
import signal
import sys
import threading
from pathlib import PurePath
from types import FrameType
from typing import Any

IMPORTING = "<frozen importlib._bootstrap>"
"""File of the frames in which Python imports something."""

COMMAND = ("tethership", "tethership.exe", "-m")
"""Name of the program where it is the command; `python -m tethership` has not named its file yet."""


def loaded() -> None:
    """From here on an interrupt is Python's KeyboardInterrupt again, but where something is being imported."""
    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, _end_while_importing)


def _end_while_importing(number: int, frame: FrameType | None) -> None:
    inner = frame
    while inner is not None:
        if inner.f_code.co_filename == IMPORTING:
            _end()
        inner = inner.f_back
    signal.default_int_handler(number, frame)


def _is_worker() -> bool:
    """Return whether another process of Python started this one, whose name it then has."""
    process = sys.modules.get("multiprocessing.process")  # whoever is a worker has imported it
    return process is not None and process.parent_process() is not None


def _end(*_: Any) -> None:
    os.write(2, b"tethership: interrupted while it was being loaded\n")
    os._exit(3)  # as after any other interrupt


if (
    PurePath(sys.argv[0] if sys.argv else "").name in COMMAND
    and not _is_worker()
    and threading.current_thread() is threading.main_thread()
    and signal.getsignal(signal.SIGINT) is signal.default_int_handler
):
    signal.signal(signal.SIGINT, _end)
