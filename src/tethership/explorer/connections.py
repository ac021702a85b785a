"""Connections that end: a client that dawdles, floods or never speaks holds no thread and keeps nobody out.

Depends on: werkzeug.
"""

import contextlib
import io
import socket
import threading
import time
from collections import OrderedDict
from typing import Any

from werkzeug.serving import ThreadedWSGIServer, WSGIRequestHandler

PATIENCE = 10.0
"""How long a whole request may take to arrive [s]."""

DELIVERY = 60.0
"""How long a client may take to fetch a part of its answer [s]."""

LARGEST_REQUEST = 2_000_000
"""Bytes that are read of one connection, headers and body."""

MOST_CONNECTIONS = 128
"""Connections at a time; one more ends the oldest, so that the newest is always heard."""


class Handler(WSGIRequestHandler):
    """Reads one request within limits; says nothing of clients that go away or talk nonsense."""

    def setup(self) -> None:
        """Read through the limits."""
        super().setup()
        self.rfile = io.BufferedReader(Incoming(self.connection))

    def make_environ(self) -> Any:
        """Return the request, its address made harmless where it is none."""
        try:
            return super().make_environ()
        except ValueError:
            self.path = "/not-an-address"
            return super().make_environ()

    def log(self, type: str, message: str, *args: Any) -> None:
        """Say nothing: whoever connects decides what would stand there."""


class Incoming(io.RawIOBase):
    """What a connection sends, no longer than `PATIENCE` [s], no more than `LARGEST_REQUEST` [bytes]."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._until = time.monotonic() + PATIENCE
        self._left = LARGEST_REQUEST

    def readable(self) -> bool:
        """Return that it can be read."""
        return True

    def readinto(self, buffer: Any) -> int:
        """Read into a buffer and return how much [bytes]; raises TimeoutError where the time is up."""
        patience = self._until - time.monotonic()
        if patience <= 0:
            raise TimeoutError("the request took too long")
        self._connection.settimeout(patience)
        try:
            count = self._connection.recv_into(memoryview(buffer)[: self._left]) if self._left else 0
        finally:
            self._connection.settimeout(DELIVERY)
        self._left -= count
        return count


class Server(ThreadedWSGIServer):
    """A thread for each connection, of which there are no more than `MOST_CONNECTIONS`."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        self._open: OrderedDict[socket.socket, None] = OrderedDict()
        self._lock = threading.Lock()
        super().__init__(*arguments, handler=Handler, **options)

    def process_request(self, request: Any, client_address: Any) -> None:
        """Answer in a thread of its own, and end the oldest connection where there are too many."""
        with self._lock:
            self._open[request] = None
            oldest = self._open.popitem(last=False)[0] if len(self._open) > MOST_CONNECTIONS else None
        if oldest is not None:
            _end(oldest)
        super().process_request(request, client_address)

    def shutdown_request(self, request: Any) -> None:
        """Forget a connection that has ended."""
        with self._lock:
            self._open.pop(request, None)
        super().shutdown_request(request)


def _end(connection: socket.socket) -> None:
    """End a connection under its thread, which then reads its end."""
    with contextlib.suppress(OSError):  # it may have ended by itself
        connection.shutdown(socket.SHUT_RDWR)
