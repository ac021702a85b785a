"""The server: one socket on loopback, ended cleanly with its computing process. Depends on: explorer.

The computing process is started first and told at once what a page will ask for: while this process makes the page,
the other one computes.
"""

import contextlib
import errno
import logging
import signal
import socket
import threading
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

from tethership._extras import needs
from tethership.errors import ConfigError
from tethership.explorer.ticket import PARAMETER, Ticket
from tethership.explorer.worker import Worker

if TYPE_CHECKING:
    from tethership.explorer.requests import Understanding

LOOPBACK = "127.0.0.1"


class Explorer:
    """A server that listens already; use it as a context, so that its computing process ends with it.

    Parameters
    ----------
    scenario : str
        Shown at first: a packaged name, or the name of a file in the folder.
    folder : Path
        Scenario files are read and saved there.
    port : int
        0 for a free one.

    Raises
    ------
    ConfigError
        No such scenario or folder, the port is in use, or something that the page needs is not installed.
    """

    def __init__(self, scenario: str = "docking", folder: Path = Path(), port: int = 0) -> None:
        worker = Worker()
        with contextlib.ExitStack() as undo:
            undo.callback(worker.close)
            from tethership.explorer.folder import Folder
            from tethership.explorer.queue import AHEAD, Desk
            from tethership.explorer.requests import Understanding

            known = Understanding(Folder(folder))
            self.folder = known.folder.root
            self.desk = Desk(worker)
            undo.callback(self.desk.close)
            for request in known.at_start(scenario):
                self.desk.ask(AHEAD, request)
            self._open(known, scenario, port)
            undo.pop_all()

    def _open(self, known: "Understanding", scenario: str, port: int) -> None:
        """Make the page and listen; what that needs is imported while the computing process is at work already."""
        with needs("explore"):
            from tethership.explorer.app import make_app
            from tethership.explorer.connections import Server
            from tethership.explorer.guard import guard
            from tethership.explorer.replays import serve_replays
        listening = _listen(port)
        self.port: int = listening.getsockname()[1]
        app = make_app(known, self.desk, scenario)
        self.ticket, self.callbacks = Ticket(self.port), app.callback_map
        serve_replays(app.server, self.port, self.desk)
        guard(app.server, self.port, list(app.csp_hashes()), self.ticket, self.callbacks)
        logging.getLogger("werkzeug").setLevel(logging.ERROR)
        self._server = Server(LOOPBACK, self.port, app.server, fd=listening.fileno())
        listening.close()

    @property
    def address(self) -> str:
        """Where a browser finds it, with the token that lets it in."""
        return f"{self.base}/?{PARAMETER}={self.ticket.token}"

    @property
    def base(self) -> str:
        """The same for a client that has the cookie."""
        return f"http://{LOOPBACK}:{self.port}"

    def serve(self) -> None:
        """Answer until `stop`."""
        self._server.serve_forever(poll_interval=0.1)

    def stop(self) -> None:
        """Make `serve` return; from any thread but its own."""
        self._server.shutdown()

    def __enter__(self) -> "Explorer":
        return self

    def __exit__(self, *error: object) -> None:
        self._server.server_close()
        self.desk.close()


def serve_until_signal(explorer: Explorer, ready: Callable[[], None]) -> None:
    """Answer until SIGINT or SIGTERM, then end the computing process too.

    Parameters
    ----------
    explorer : Explorer
        Listens already.
    ready : callable
        Called once it answers.
    """

    def end(number: int, frame: FrameType | None) -> None:
        threading.Thread(target=explorer.stop, daemon=True).start()

    former = {number: signal.signal(number, end) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        with explorer:
            threading.Thread(target=ready, daemon=True).start()
            explorer.serve()
    finally:
        for number, handler in former.items():
            signal.signal(number, handler)


def _listen(port: int) -> socket.socket:
    """Return a socket that listens on loopback; raises ConfigError where it cannot."""
    if not 0 <= port <= 65535:
        raise ConfigError(f"--port {port} is no port; give one from 1024 to 65535, or 0 for a free one")
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listening.bind((LOOPBACK, port))
        listening.listen(64)
    except OSError as error:
        listening.close()
        reason = "is in use" if error.errno == errno.EADDRINUSE else f"cannot be used ({error.strerror})"
        raise ConfigError(f"port {port} {reason}; choose another with --port, or --port 0 for a free one") from error
    return listening
