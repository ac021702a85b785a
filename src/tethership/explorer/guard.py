"""Who may talk to the explorer: pages that it served itself, on this machine. Depends on: flask.

A foreign page that resolves its own name to 127.0.0.1 (DNS rebinding) sends its own Host; one that posts across sites
sends its Origin. Both are refused before anything is read.
"""

from flask import Flask, Response, abort, request

LARGEST_BODY = 1_000_000
"""Longest request [bytes]."""

HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}


def guard(server: Flask, port: int, scripts: list[str]) -> None:
    """Refuse what does not come from a page of this server, and let its pages load nothing from elsewhere.

    Parameters
    ----------
    server : Flask
        What answers.
    port : int
        Where it listens.
    scripts : list of str
        Hashes of the inline scripts of its pages, as a content security policy has them.
    """
    hosts = {f"127.0.0.1:{port}", f"localhost:{port}", *({"127.0.0.1", "localhost"} if port == 80 else set())}
    origins = {f"http://{host}" for host in hosts}
    policy = "; ".join(
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
    server.config["MAX_CONTENT_LENGTH"] = LARGEST_BODY

    @server.before_request
    def _refuse() -> None:
        if request.headers.get("Host", "").lower() not in hosts:
            abort(403, "this server answers only to 127.0.0.1 and localhost")
        origin = request.headers.get("Origin")
        if origin is not None and origin.lower() not in origins:
            abort(403, "requests of other sites are refused")
        if request.headers.get("Sec-Fetch-Site", "none") not in ("same-origin", "none"):
            abort(403, "requests of other sites are refused")
        if request.method not in ("GET", "HEAD") and request.mimetype != "application/json":
            abort(415, "only JSON is taken")

    @server.after_request
    def _headers(response: Response) -> Response:
        for name, value in HEADERS.items():
            response.headers[name] = value
        if "component-suites" not in request.path:
            response.headers["Cache-Control"] = "no-store"
        response.headers["Content-Security-Policy"] = policy
        return response

    # Dash puts its own checks before these; refusals must come first.
    checks = server.before_request_funcs[None]
    checks.insert(0, checks.pop())
