"""Ctrl-C in the seconds that the command takes to load: one line and the end. Depends on nothing.

Importing this module sees to it, where Python was started as the command. Extension modules do not survive Python's
own KeyboardInterrupt while they load: they end in tracebacks or crash.
"""

import multiprocessing
import os
import signal
import sys
import threading
from pathlib import PurePath
from typing import Any

COMMAND = ("tethership", "tethership.exe", "-m")
"""Name of the program where it is the command; `python -m tethership` has not named its file yet."""


def loaded() -> None:
    """From here on an interrupt is Python's KeyboardInterrupt again."""
    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, signal.default_int_handler)


def _end(*_: Any) -> None:
    os.write(2, b"tethership: interrupted while it was being loaded\n")
    os._exit(3)  # as after any other interrupt


if (
    PurePath(sys.argv[0] if sys.argv else "").name in COMMAND
    and multiprocessing.parent_process() is None  # a worker has its parent's name
    and threading.current_thread() is threading.main_thread()
    and signal.getsignal(signal.SIGINT) is signal.default_int_handler
):
    signal.signal(signal.SIGINT, _end)
