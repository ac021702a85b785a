"""Who gets into the explorer, what it takes, and how long it listens: every user of a machine can reach its port.

If one of these failed, another user could compute and write files as the owner, or keep the owner out.
"""

import contextlib
import copy
import gzip
import http.client
import itertools
import json
import random
import re
import socket
import stat
import threading
import time
from pathlib import Path

import pytest

import tethership.explorer
from tethership.cli import explore
from tethership.explorer import connections
from tethership.explorer.server import Explorer
from tethership.explorer.standing import Standing

CALLBACK = "/_dash-update-component"

PATHS = ("/", "/_dash-layout", "/_dash-dependencies", "/assets/explorer.css", "/nowhere", CALLBACK)


class Idle:
    """A stand-in for the computing process that never ends a job before it is told to."""

    def run(self, job, progress, should_stop):
        while not should_stop():
            time.sleep(0.01)

    def close(self):
        pass


@pytest.fixture
def explorer(tmp_path, monkeypatch):
    monkeypatch.setattr("tethership.explorer.server.Worker", Idle)
    with Explorer("docking", tmp_path) as made:
        thread = threading.Thread(target=made.serve)
        thread.start()
        yield made
        made.stop()
        thread.join(10)


def asked(explorer, method, path, body=None, **headers):
    """Return status, text and headers of an answer."""
    connection = http.client.HTTPConnection("127.0.0.1", explorer.port, timeout=20)
    with contextlib.closing(connection):
        words = {name.replace("_", "-"): value for name, value in headers.items()}
        if body is not None:
            words.setdefault("Content-Type", "application/json")
        connection.request(method, path, body, words)
        answer = connection.getresponse()
        return answer.status, answer.read().decode(errors="replace"), answer.headers


def entered(explorer, method, path, body=None, **headers):
    """Return the same for whoever has the cookie."""
    return asked(explorer, method, path, body, Cookie=explorer.ticket.cookie, **headers)


@pytest.mark.parametrize("cookie", [None, "", "wrong", "é§", "the token"])
def test_without_the_cookie_every_request_is_refused(explorer, cookie):
    """One plain line; the token itself is no cookie."""
    value = explorer.ticket.token if cookie == "the token" else cookie
    words = {} if value is None else {"Cookie": f"{explorer.ticket.cookie_name}={value}".encode()}
    for path, method in itertools.product(PATHS, ("GET", "POST", "PUT", "DELETE", "OPTIONS", "PATCH")):
        status, text, headers = asked(explorer, method, path, b"{}" if method == "POST" else None, **words)
        assert status == 403, (method, path)
        assert text == "403: open the address that tethership explore printed: it holds the token of this run\n"
        assert headers.get_content_type() == "text/plain"


def test_the_token_gives_a_strict_cookie_and_the_cookie_lets_in(explorer):
    path = explorer.address.removeprefix(explorer.base)
    status, text, headers = asked(explorer, "GET", path, Sec_Fetch_Site="cross-site")  # from a file or a mail
    assert status == 200
    assert explorer.ticket.token not in text
    value, *attributes = headers["Set-Cookie"].split("; ")
    assert value == explorer.ticket.cookie
    assert {"HttpOnly", "SameSite=Strict", "Path=/"} <= set(attributes)
    assert asked(explorer, "GET", "/_dash-layout", Cookie=value)[0] == 200
    assert explorer.ticket.token not in asked(explorer, "GET", "/", Cookie=value)[1]
    assert asked(explorer, "GET", "/_dash-layout", Cookie=value, Sec_Fetch_Site="cross-site")[0] == 403


@pytest.mark.parametrize("token", ["", "x", "%ff", "é".encode().hex(), "a" * 60000])
def test_another_token_opens_nothing(explorer, token):
    status, text, headers = asked(explorer, "GET", f"/?token={token}")
    assert status == 403
    assert "not the token" in text
    assert "Set-Cookie" not in headers


def test_secrets_are_long_and_of_one_run(tmp_path, monkeypatch):
    monkeypatch.setattr("tethership.explorer.server.Worker", Idle)
    with Explorer("docking", tmp_path) as one, Explorer("docking", tmp_path) as other:
        secrets = {one.ticket.token, other.ticket.token, one.ticket.cookie_value, other.ticket.cookie_value}
        assert len(secrets) == 4
        assert min(map(len, secrets)) >= 43  # 256 bits
        assert one.ticket.cookie_name != other.ticket.cookie_name  # a browser has one jar for all ports


def test_a_browser_is_not_told_the_token_where_others_can_read_it(tmp_path, monkeypatch):
    """A command line is every user's to read; the file that leads to the page is in a private folder."""
    told = []
    monkeypatch.setenv("DISPLAY", ":0")
    monkeypatch.setattr("webbrowser.open", lambda url: told.append(url) or True)

    def serve(explorer, ready):
        ready()
        door = Path(told[0].removeprefix("file://"))
        assert stat.S_IMODE(door.parent.stat().st_mode) == 0o700
        assert explorer.address in door.read_text()
        assert explorer.ticket.token not in told[0]
        explorer._server.server_close()
        explorer.desk.close()

    assert tethership.explorer.serve_until_signal is not serve  # looked up by another test of this process or not
    monkeypatch.setattr("tethership.explorer.server.Worker", Idle)
    monkeypatch.setattr("tethership.explorer.server.serve_until_signal", serve)
    monkeypatch.delattr(Explorer, "serve")  # it would listen for ever
    explore.explore("docking", 0, "127.0.0.1", tmp_path)
    assert not Path(told[0].removeprefix("file://")).exists()


@pytest.mark.parametrize(
    "headers",
    [
        {"Host": "evil.example"},
        {"Host": "evil.example:8050"},
        {"Host": "127.0.0.1:1"},
        {"Host": ""},
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Sec_Fetch_Site": "cross-site"},
        {"Sec_Fetch_Site": "same-site"},
    ],
)
@pytest.mark.parametrize(("method", "path"), [("GET", "/"), ("GET", "/_dash-layout"), ("POST", CALLBACK)])
def test_pages_of_others_are_refused_even_with_the_cookie(explorer, headers, method, path):
    assert entered(explorer, method, path, b"{}" if method == "POST" else None, **headers)[0] == 403


# What is sent


@pytest.fixture
def app(tmp_path, monkeypatch):
    """The app with its guard, asked without a network; any trace of an error in its log fails."""
    monkeypatch.setattr("tethership.explorer.server.Worker", Idle)
    with Explorer("docking", tmp_path) as made:
        client = made._server.app.test_client()
        client.set_cookie(made.ticket.cookie_name, made.ticket.cookie_value, domain="127.0.0.1")

        def post(body, kind="application/json"):
            body = body if isinstance(body, bytes) else json.dumps(body).encode()
            return client.post(CALLBACK, base_url=made.base, data=body, content_type=kind)

        yield made, post


def value_of(place, name):
    """Return what the page would say."""
    return {
        "n_clicks": 1,
        "n_intervals": 3,
        "id": place if isinstance(place, dict) else {},
        "tab": "trim",
        "scenario": "docking",
        "layers": ["rewind"],
        "sas": [],
        "shown": {"trim": "0"},
        "over": "wind.speed",
        "more": "vehicle.fins.*.area",
        "low": "6",
        "high": "8",
        "points": "3",
    }.get(name if name in ("n_clicks", "n_intervals", "id") else str(place), "9")


def bodies(callbacks):
    """Yield a body as the page sends it for every callback of the server."""

    def entry(given, several):
        place = json.loads(given["id"]) if given["id"].startswith("{") else given["id"]
        wild = isinstance(place, dict) and "ALL" in str(place)
        if isinstance(place, dict):
            words = {"view": "trim", "name": "wind.speed", "kind": "main"}
            place = {key: words[key] if isinstance(part, list) else part for key, part in place.items()}
        made = {"id": place, "property": given["property"]}
        if several:
            made["value"] = value_of(place, given["property"])
        return [made] if wild and several else made

    for output, callback in callbacks.items():
        if callback["inputs_state_indices"] is None:
            continue
        wanted = callback["output"]
        outputs = [entry(one.to_dict(), False) for one in (wanted if isinstance(wanted, list) else [wanted])]
        inputs = [entry(one, True) for one in callback["inputs"]]
        first = (
            inputs[0]["id"] if isinstance(inputs[0]["id"], str) else json.dumps(inputs[0]["id"], separators=(",", ":"))
        )
        yield {
            "output": output,
            "outputs": outputs if isinstance(wanted, list) else outputs[0],
            "inputs": inputs,
            "state": [entry(one, True) for one in callback["state"]],
            "changedPropIds": [f"{first}.{inputs[0]['property']}"],
        }


ODD = (
    None, True, False, 0, -1, 1e308, 10**400, float("nan"), float("inf"), "", "x" * 10_000, "\ud800", "\0", "9" * 300,
    "1 m/s*9**9**9", "../x.toml", "docking.toml", [], {}, [[]], [None], {"": ""}, {"name": 3}, [{}], [["a"]],
    {"a": [1]}, "ALL", ["ALL"], "trim.figure", "__class__", [[[[[[]]]]]],
)  # fmt: skip


def mutated(body, dice):
    """Return a body with one to three parts replaced, dropped, doubled or added."""
    body, odd = copy.deepcopy((body, ODD))
    for _ in range(dice.randint(1, 3)):
        spots = [(body, key) for key in body]
        for holder, key in spots:
            inner = holder[key]
            if isinstance(inner, dict | list) and len(spots) < 400:
                spots += [(inner, one) for one in (inner if isinstance(inner, dict) else range(len(inner)))]
        holder, key = dice.choice(spots)
        match dice.randrange(4):
            case 0 if isinstance(holder, dict):
                holder.pop(key, None)
            case 1 if isinstance(holder, list):
                holder.insert(key, dice.choice(odd))
            case 2 if isinstance(holder, dict):
                holder[str(dice.choice(odd))[:50]] = dice.choice(odd)
            case _:
                holder[key] = dice.choice(odd)
    return body


def quiet(caplog, capfd):
    """Return whether nothing was logged and nothing printed."""
    printed = capfd.readouterr()
    return "Traceback" not in printed.out + printed.err and not [r for r in caplog.records if r.exc_info]


def test_what_the_page_sends_is_answered(app):
    """Else the tests below would prove nothing: every callback is reached by a right body."""
    made, post = app
    found = list(bodies(made.callbacks))
    assert len(found) == 5
    for body in found:
        assert post(body).status_code in (200, 204), body["output"]


def test_no_body_makes_the_server_fail(app, caplog, capfd):
    """Three thousand bodies, each a right one with parts that are missing, odd, huge or of another kind."""
    made, post = app
    dice = random.Random(20261127)
    right = list(bodies(made.callbacks))
    seen = set()
    for _ in range(3000):
        body = mutated(dice.choice(right), dice)
        answer = post(body)
        seen.add(answer.status_code)
        assert answer.status_code < 500, body
        if answer.status_code >= 400:
            assert answer.mimetype == "text/plain"
            assert answer.text.count("\n") == 1
    assert seen >= {200, 400}
    assert quiet(caplog, capfd)


@pytest.mark.parametrize(
    ("body", "kind", "status"),
    [
        (b"", "application/json", 400),
        (b"{", "application/json", 400),
        (b"null", "application/json", 400),
        (b"[]", "application/json", 400),
        (b"3", "application/json", 400),
        (b'"x"', "application/json", 400),
        (b"NaN", "application/json", 400),
        (b"{}", "application/json", 400),
        (b'{"output": 5}', "application/json", 400),
        (b'{"output": ["a"]}', "application/json", 400),
        (b'{"output": {"a": 1}}', "application/json", 400),
        (b'{"output": "nobody.children"}', "application/json", 400),
        (b'{"output": "{\\"part\\":\\"download\\",\\"view\\":[\\"MATCH\\"]}.title"}', "application/json", 400),
        (b"\xff\xfe\xfd", "application/json", 400),
        (b'{"output": "\xe9"}', "application/json", 400),
        (b"9" * 100_000, "application/json", 400),
        (b"[" * 200_000, "application/json", 400),
        (b'{"a":' * 100_000, "application/json", 400),
        (b" " * 1_000_001, "application/json", 413),
        (b"a=1", "application/x-www-form-urlencoded", 415),
        (b"{}", "text/plain", 415),
        (b"{}", "application/jsonp", 415),
        (b"{}", "", 415),
    ],
)
def test_odd_bodies_are_the_clients_fault(app, caplog, capfd, body, kind, status):
    answer = app[1](body, kind)
    assert answer.status_code == status
    assert answer.text.count("\n") == 1
    assert quiet(caplog, capfd)


@pytest.mark.parametrize(
    "path",
    [
        "/assets/../../vehicles/lotte.toml",
        "/assets/%2e%2e/%2e%2e/vehicles/lotte.toml",
        "/assets//etc/passwd",
        "/assets/%00",
        "/_dash-component-suites/dash/../../../etc/passwd",
        "/_dash-component-suites/tethership/__init__.py",
        "/_dash-component-suites/dash/nothing.js",
        "/_reload-hash",
        "/static/x",
        "/../pyproject.toml",
        "/any/other/page",
        "//[bad",
        "/%ff%fe",
    ],
)
def test_no_file_of_the_machine_is_served(explorer, capfd, caplog, path):
    status, text, _ = entered(explorer, "GET", path)
    assert status == 404
    assert text.count("\n") == 1
    assert quiet(caplog, capfd)


def test_a_replay_is_served_to_the_owner_alone_and_into_a_sandbox(explorer, monkeypatch):
    """Its scripts stand in the page, so it gets an origin of its own, from which nothing here can be asked."""
    flight = Standing(None, "done", result={"replay": gzip.compress(b"<p>played</p>")})
    found = {("flight", "0123"): flight, ("flight", "4567"): flight._replace(result={"replay": None})}
    monkeypatch.setattr(explorer.desk, "done", lambda view, key: found.get((view, key)))
    status, _, headers = entered(explorer, "GET", "/replay/0123", Sec_Fetch_Site="same-origin")
    assert status == 200
    policy = headers["Content-Security-Policy"].split("; ")
    assert {"default-src 'none'", "sandbox allow-scripts"} <= set(policy)
    assert (headers["X-Frame-Options"], headers["Content-Encoding"]) == ("SAMEORIGIN", "gzip")
    for path in ("/replay/4567", "/replay/89", "/replay/", "/replay/../0123"):
        status, text, headers = entered(explorer, "GET", path)
        assert (status, text.count("\n")) == (404, 1)
        assert "frame-ancestors 'none'" in headers["Content-Security-Policy"]
    assert asked(explorer, "GET", "/replay/0123")[0] == 403
    assert entered(explorer, "GET", "/replay/0123", Sec_Fetch_Site="cross-site")[0] == 403


@pytest.mark.parametrize(
    "head",
    [
        b"GET / HTTP/1.1\r\nHost: \xff\r\n\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n",
        b"GET\r\n\r\n",
        b"GET http://[bad/ HTTP/1.1\r\nHost: HOST\r\n\r\n",
        b"GET / HTTP/9.9.9\r\n\r\n",
        b"A" * 70_000 + b"\r\n\r\n",
        b"GET / HTTP/1.1\r\n" + b"X: y\r\n" * 200 + b"\r\n",
        b"POST "
        + CALLBACK.encode()
        + b" HTTP/1.1\r\nHost: HOST\r\nCookie: COOKIE\r\nContent-Type: application/json\r\n"
        b"Transfer-Encoding: chunked\r\n\r\nzz\r\n",
        b"POST "
        + CALLBACK.encode()
        + b" HTTP/1.1\r\nHost: HOST\r\nCookie: COOKIE\r\nContent-Type: application/json\r\n"
        b"Content-Length: -5\r\n\r\n{}",
        b"POST "
        + CALLBACK.encode()
        + b" HTTP/1.1\r\nHost: HOST\r\nCookie: COOKIE\r\nContent-Type: application/json\r\n"
        b"Content-Length: 500\r\n\r\n{}",
    ],
)
def test_nonsense_on_the_socket_ends_in_a_refusal(explorer, capfd, caplog, head):
    head = head.replace(b"HOST", explorer.base[7:].encode()).replace(b"COOKIE", explorer.ticket.cookie.encode())
    with socket.create_connection(("127.0.0.1", explorer.port), timeout=20) as client:
        client.sendall(head)
        client.shutdown(socket.SHUT_WR)
        answer = b"".join(iter(lambda: client.recv(65536), b""))
    first = answer.split(b"\r\n")[0]
    assert not answer or re.fullmatch(rb"HTTP/1\.[01] (4\d\d|505) .*", first) or first.startswith(b"<!DOCTYPE"), first
    assert quiet(caplog, capfd)
    assert entered(explorer, "GET", "/_dash-layout")[0] == 200


# How long it listens


def half_open(explorer, count, words=b"POST / HTTP/1.1\r\nHost: x\r\n"):
    """Return connections that have begun to speak."""
    made = [socket.create_connection(("127.0.0.1", explorer.port), timeout=30) for _ in range(count)]
    for one in made:
        one.sendall(words)
    return made


def threads():
    return sum("process_request_thread" in thread.name for thread in threading.enumerate())


def ended(client):
    """Return whether the other side has closed a connection."""
    with contextlib.suppress(ConnectionError):
        while client.recv(65536):
            pass
    return True


def test_a_client_that_drips_holds_a_thread_for_a_while_only(explorer, monkeypatch):
    monkeypatch.setattr(connections, "PATIENCE", 0.5)
    (client,) = half_open(explorer, 1)
    begun = time.monotonic()
    with contextlib.suppress(ConnectionError):
        while time.monotonic() < begun + 20:
            client.sendall(b"X")
            time.sleep(0.02)
    assert time.monotonic() - begun < 5
    assert ended(client)


def test_the_owner_is_answered_while_others_hold_the_door(explorer, monkeypatch):
    """The oldest of too many is ended; the newest, the owner's, is heard at once."""
    monkeypatch.setattr(connections, "MOST_CONNECTIONS", 8)
    held = half_open(explorer, 40)
    begun = time.monotonic()
    assert entered(explorer, "GET", "/_dash-layout")[0] == 200
    assert time.monotonic() - begun < 3
    assert all(ended(client) for client in held[:25])
    end = time.monotonic() + 10
    while threads() > 9 and time.monotonic() < end:
        time.sleep(0.02)
    assert threads() <= 9
    for client in held:
        client.close()


def test_an_endless_body_is_not_read_to_its_end(explorer):
    """Not even after the refusal, where the rest is drained so that it can be read."""
    head = f"POST {CALLBACK} HTTP/1.1\r\nHost: {explorer.base[7:]}\r\nContent-Length: 900000000\r\n\r\n".encode()
    (client,) = half_open(explorer, 1, head)
    sent = 0
    with contextlib.suppress(OSError):
        while sent < 100_000_000:
            client.sendall(b"x" * 100_000)
            sent += 100_000
    assert sent < 50_000_000
