"""Who may talk to the explorer: pages that it served itself, to whoever started it. Depends on: flask, explorer.ticket.

A foreign page that resolves its own name to 127.0.0.1 (DNS rebinding) sends its own Host; one that posts across sites
sends its Origin; another user of the machine has no ticket. All are refused before anything is read, and what is read
is only what this app's own page says (`envelope`).
"""

from collections.abc import Mapping
from typing import Any

from dash.exceptions import DependencyException
from flask import Flask, Response, abort, request
from werkzeug.exceptions import HTTPException

from tethership.errors import ConfigError
from tethership.explorer.envelope import check_envelope
from tethership.explorer.ticket import PARAMETER, Ticket

LARGEST_BODY = 1_000_000
"""Longest body of a request [bytes]."""

HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}

CALLBACK = "/_dash-update-component"

REPLAY = "/replay/<string:key>"
"""Rule under which replays are served."""

SERVED = (
    "/",
    "/_dash-layout",
    "/_dash-dependencies",
    CALLBACK,
    "/_favicon.ico",
    REPLAY,
    "/assets/<path:filename>",
    "/_dash-component-suites/<string:package_name>/<path:fingerprinted_path>",
)
"""Rules of the app that are answered; Dash has more, and one that takes any path for the page."""

DOOR = """<!doctype html>
<html lang="en"><meta charset="utf-8"><title>tethership explore</title><link rel="icon" href="data:,">
<meta http-equiv="refresh" content="0; url=/"><p><a href="/">Open the explorer</a></p></html>
"""
"""Sent with the cookie. A redirect would not do: after a link from elsewhere a browser holds a strict cookie back."""


def guard(
    server: Flask, port: int, scripts: list[str], ticket: Ticket, callbacks: Mapping[str, Mapping[str, Any]]
) -> None:
    """Refuse what does not come from a page of this server, and let its pages load nothing from elsewhere.

    Refused are bodies of more than `LARGEST_BODY` [bytes] too.

    Parameters
    ----------
    server : Flask
        What answers.
    port : int
        Where it listens.
    scripts : list of str
        Hashes of the inline scripts of its pages, as a content security policy has them.
    ticket : Ticket
        What this run's own browser shows.
    callbacks : mapping
        The app's callbacks, as Dash keeps them.
    """
    hosts = {f"127.0.0.1:{port}", f"localhost:{port}", *({"127.0.0.1", "localhost"} if port == 80 else set())}
    origins = {f"http://{host}" for host in hosts}
    policy = _policy(scripts)
    server.config["MAX_CONTENT_LENGTH"] = LARGEST_BODY

    @server.before_request
    def _refuse() -> Response | None:
        if request.headers.get("Host", "").lower() not in hosts:
            abort(403, "this server answers only to 127.0.0.1 and localhost")
        origin = request.headers.get("Origin")
        if origin is not None and origin.lower() not in origins:
            abort(403, "requests of other sites are refused")
        if request.path == "/" and request.method == "GET" and PARAMETER in request.args:
            return _open_door(ticket)
        if request.headers.get("Sec-Fetch-Site", "none") not in ("same-origin", "none"):
            abort(403, "requests of other sites are refused")
        if not ticket.admits(request.cookies.get(ticket.cookie_name)):
            abort(403, "open the address that tethership explore printed: it holds the token of this run")
        _check_request(callbacks)
        return None

    @server.after_request
    def _headers(response: Response) -> Response:
        for name, value in HEADERS.items():
            response.headers.setdefault(name, value)
        if response.status_code != 200 or "component-suites" not in request.path:
            response.headers["Cache-Control"] = "no-store"
        response.headers.setdefault("Content-Security-Policy", policy)
        return response

    @server.errorhandler(HTTPException)
    def _plain(error: HTTPException) -> Response:
        words = " ".join((error.description or error.name).split())
        return Response(f"{error.code}: {words}\n", error.code, mimetype="text/plain")

    @server.errorhandler(DependencyException)
    @server.errorhandler(FileNotFoundError)
    def _no_such_file(error: Exception) -> Response:
        return Response("404: there is no such file\n", 404, mimetype="text/plain")

    # Dash puts its own checks before these; refusals must come first.
    checks = server.before_request_funcs[None]
    checks.insert(0, checks.pop())


def _open_door(ticket: Ticket) -> Response:
    """Return the page that gives the cookie to whoever has the token."""
    if not ticket.opens(request.args.get(PARAMETER)):
        abort(403, "this is not the token of this run; open the address that tethership explore printed")
    response = Response(DOOR, mimetype="text/html")
    response.set_cookie(ticket.cookie_name, ticket.cookie_value, httponly=True, samesite="Strict")
    return response


def _check_request(callbacks: Mapping[str, Mapping[str, Any]]) -> None:
    """Refuse paths that are none of the page's, and bodies that its scripts do not send."""
    if request.url_rule is not None and request.url_rule.rule not in SERVED:
        abort(404, "there is no such page")
    if request.method in ("GET", "HEAD") or request.url_rule is None:
        return
    if request.method != "POST":
        abort(405, "only GET, HEAD and POST are answered")
    if request.mimetype != "application/json":
        abort(415, "only JSON is taken")
    try:
        check_envelope(request.get_json(), callbacks)
    except RecursionError:
        abort(400, "the JSON is nested too deeply")
    except ConfigError as error:
        abort(400, str(error))


def _policy(scripts: list[str]) -> str:
    """Return the content security policy."""
    return "; ".join(
        (
            "default-src 'self'",
            f"script-src 'self' {' '.join(scripts)}",
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "object-src 'none'",
            "base-uri 'none'",
            "form-action 'none'",
            "frame-ancestors 'none'",
        )
    )
