"""Noticing a signal without losing what was computed. Depends on nothing."""

import signal
import threading
from types import FrameType, TracebackType


class Interruption:
    """Context in which SIGINT and SIGTERM only set a flag; a second one acts as usual.

    Outside the main thread signals are left alone.
    """

    def __init__(self) -> None:
        self.raised = False
        self._former: dict[int, object] = {}

    def _note(self, number: int, frame: FrameType | None) -> None:
        self.raised = True
        self._restore()

    def _restore(self) -> None:
        for number, handler in self._former.items():
            signal.signal(number, handler)  # pyright: ignore[reportArgumentType]
        self._former = {}

    def __enter__(self) -> "Interruption":
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                self._former[number] = signal.signal(number, self._note)
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._restore()
