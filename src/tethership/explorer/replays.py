"""Replays of flights that are kept, each a page of its own for a frame of the explorer's page. Depends on: flask.

A replay is the page that `tethership dock` writes, with its scripts in it. It is served into a sandbox: whatever stood
in it could neither ask this server for anything nor reach the page around it.
"""

from flask import Flask, Response, abort

from tethership.explorer.guard import REPLAY
from tethership.explorer.queue import Desk

POLICY = (
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; "
    "sandbox allow-scripts; base-uri 'none'; form-action 'none'; frame-ancestors 'self' {around}"
)


def serve_replays(server: Flask, port: int, desk: Desk) -> None:
    """Answer with the replays of flights that a desk keeps, to be framed by the pages of this port."""
    headers = {
        "Content-Encoding": "gzip",
        "X-Frame-Options": "SAMEORIGIN",
        "Content-Security-Policy": POLICY.format(around=f"http://127.0.0.1:{port} http://localhost:{port}"),
    }

    @server.get(REPLAY)
    def _replay(key: str) -> Response:
        flight = desk.done("flight", key)
        page = None if flight is None else flight.result.get("replay")
        if page is None:
            abort(404, "this flight is no longer kept; change something or compute again")
        return Response(page, mimetype="text/html", headers=headers)
