"""The viewer's server speaks to the user's own page: not to other pages, programs or users."""

from __future__ import annotations

import functools
import http.client
import http.server
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("mujoco.studio.app", reason="this MuJoCo comes without its studio")

from chromium import browser, needs_browser
from inerter.view.guard import LARGEST_MESSAGE, SOCKETS, Guard, _own_listener
from served import Served, served
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.http11 import Request
from websockets.sync.client import ClientConnection, connect


@pytest.fixture(scope="module")
def viewer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("viewer")) as found:
        yield found


def ask(viewer: Served, path: str, **headers: str) -> tuple[int, bytes, dict[str, str]]:
    """Status, body and headers of a GET."""
    connection = http.client.HTTPConnection("127.0.0.1", viewer.port, timeout=20)
    connection.putrequest("GET", path, skip_host="Host" in headers)
    for name, value in headers.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, body, {name.lower(): value for name, value in answer.getheaders()}


def speak(viewer: Served, path: str, origin: str | None) -> ClientConnection:
    return connect(f"ws://127.0.0.1:{viewer.port}{path}", origin=origin, open_timeout=20)  # type: ignore[arg-type]


def drain(socket_: ClientConnection) -> None:
    """Take what a socket has, for ten seconds at most."""
    until = time.monotonic() + 10
    while time.monotonic() < until:
        socket_.recv(timeout=10)


def refused(viewer: Served, path: str, origin: str | None, status: int) -> None:
    with pytest.raises(InvalidStatus) as caught, speak(viewer, path, origin):
        pass
    assert caught.value.response.status_code == status


# --- programs ----------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "path", ["/", "/index.html", "/model", "/web_client.js", "/assets/x", "/no"]
)
def test_nothing_is_served_without_the_token(viewer: Served, path: str) -> None:
    for query in ("", "?token=", "?token=guess", f"?token={viewer.token}&token=x", "?once=x"):
        status, body, _ = ask(viewer, path + query)
        assert (status, body[:16]) == (403, b"open the address"), query


def test_the_page_is_served_with_it(viewer: Served) -> None:
    status, page, headers = ask(viewer, f"/?token={viewer.token}")
    assert status == 200
    assert page.count(viewer.token.encode()) == 3  # what signs, the icon, the program
    assert int(headers["content-length"]) == len(page)
    assert "access-control-allow-origin" not in headers
    assert headers["referrer-policy"] == "no-referrer"
    assert headers["cross-origin-resource-policy"] == "same-origin"
    status, model, headers = ask(viewer, f"/model?token={viewer.token}")
    assert status == 200
    assert len(model) > 1000
    assert "access-control-allow-origin" not in headers


HOSTS = ["evil.example", "evil.example:{port}", "127.0.0.1.evil.example", "10.0.0.1:{port}", ""]


@pytest.mark.parametrize("host", HOSTS)
def test_a_name_of_a_stranger_that_leads_here_is_refused(viewer: Served, host: str) -> None:
    """DNS rebinding: the page of that name is of the same origin as the server."""
    headers = {"Host": host.format(port=viewer.port)}
    status, body, _ = ask(viewer, f"/model?token={viewer.token}", **headers)
    assert (status, body) == (403, b"the viewer is at 127.0.0.1 only\n")


ORIGINS = [
    "http://evil.example",
    "null",
    "http://127.0.0.1:{other}",
    "https://localhost:{port}",
    "x",
]


@pytest.mark.parametrize("origin", ORIGINS)
@pytest.mark.parametrize("path", [*SOCKETS, "/drop", "/model", "/"])
def test_another_origin_is_refused_though_it_knows_the_token(
    viewer: Served, path: str, origin: str
) -> None:
    origin = origin.format(port=viewer.port, other=viewer.port - 1)
    refused(viewer, f"{path}?token={viewer.token}&sid=a", origin, 403)


@pytest.mark.parametrize("path", SOCKETS)
def test_a_socket_needs_the_page_and_its_token(viewer: Served, path: str) -> None:
    own = f"http://127.0.0.1:{viewer.port}"
    for query, origin in ((f"?token={viewer.token}", None), ("?token=x", own), ("", own)):
        refused(viewer, f"{path}{query}", origin, 403)


def test_no_model_is_taken(viewer: Served) -> None:
    own = f"http://127.0.0.1:{viewer.port}"
    refused(viewer, f"/drop?token={viewer.token}&sid=a", own, 404)


def test_a_message_is_bounded(viewer: Served) -> None:
    own = f"http://127.0.0.1:{viewer.port}"
    with speak(viewer, f"/state?token={viewer.token}&sid=big", own) as socket_:
        assert socket_.recv(timeout=20)
        socket_.send(b"x" * (LARGEST_MESSAGE + 1))
        with pytest.raises(ConnectionClosed):
            drain(socket_)
    assert socket_.close_code == 1009


def test_an_address_for_a_command_line_works_once() -> None:
    """What other users of the machine can list is spent by the page that it opened."""
    guard = Guard()
    once = guard.address(8080, once=True).partition("8080")[2]
    assert guard.token not in once
    headers = Headers({"Host": "127.0.0.1:8080"})
    assert guard.refusal(Request(once.replace("/?", "/model?"), headers)) is not None
    assert guard.refusal(Request(once, headers)) is None
    assert guard.refusal(Request(once, headers)) is not None
    assert guard.refusal(Request(guard.address(8080).partition("8080")[2], headers)) is None


@pytest.mark.skipif(sys.platform != "linux", reason="Linux alone tells whose a connection is")
def test_the_port_of_the_drawing_hears_its_own_process_alone() -> None:
    listener = _own_listener()
    listener.settimeout(20)
    port = listener.getsockname()[1]
    strange = "import socket, sys; s = socket.create_connection(('127.0.0.1', int(sys.argv[1]))); "
    strange += "s.sendall(b'x'); print(s.recv(1))"
    with subprocess.Popen(
        [sys.executable, "-c", strange, str(port)], stdout=subprocess.PIPE
    ) as other:
        accepted: list[Any] = []
        thread = threading.Thread(target=lambda: accepted.append(listener.accept()[0]))
        thread.start()
        told = other.communicate(timeout=20)[0].strip()
        assert told in (b"b''", b"")  # shut, or reset
        assert not accepted
        with socket.create_connection(("127.0.0.1", port)) as own:
            thread.join(20)
            assert accepted[0].getpeername() == own.getsockname()
    accepted[0].close()
    listener.close()


@pytest.mark.parametrize("name", ["SIGTERM", "SIGHUP", "SIGINT", "SIGQUIT"])
def test_every_signal_ends_it_and_leaves_nothing(name: str, tmp_path: Path) -> None:
    with served(tmp_path) as found:
        own = f"http://127.0.0.1:{found.port}"
        with speak(found, f"/state?token={found.token}&sid=a", own) as socket_:
            assert socket_.recv(timeout=20)
            found.end(getattr(signal, name))
    assert list(found.temporary.iterdir()) == []
    assert "Traceback" not in found.log.read_text()


# --- a real browser ----------------------------------------------------------------------------

# what a page tries, and what comes of each: an answer that it can read or a socket that opens is
# "taken"
ATTACK = """<!doctype html><title>attack</title><script>
const [port, token] = location.hash.slice(1).split(",");
const found = {};
const late = () => new Promise((done) => setTimeout(done, 8000, "late"));
const reads = async (url) => {
  const answer = await fetch(url);
  return answer.ok ? "taken" : "refused " + answer.status;
};
const opens = (url) => new Promise((done) => {
  const socket = new WebSocket(url);
  socket.onopen = () => { socket.send(new Uint8Array(1000)); done("taken"); };
  socket.onerror = () => done("refused");
});
const loads = (kind, url) => new Promise((done) => {
  const element = document.createElement(kind);
  element.onload = () => done("taken");
  element.onerror = () => done("refused");
  element.src = url;
  document.head.append(element);
});
window.attack = async () => {
  const tries = {};
  for (const host of ["127.0.0.1", "localhost"]) {
    const at = host + ":" + port, web = "http://" + at;
    for (const query of ["", "?token=" + token]) {
      for (const path of ["/", "/model", "/web_client.js"])
        tries["fetch " + host + path + query] = reads(web + path + query);
      for (const path of ["/state", "/ui", "/drop"])
        tries["socket " + host + path + query] = opens("ws://" + at + path + query);
      tries["script " + host + query] = loads("script", web + "/web_client.js" + query);
      tries["image " + host + query] = loads("img", web + "/favicon.ico" + query);
    }
  }
  for (const [name, tried] of Object.entries(tries))
    found[name] = await Promise.race([tried.catch((error) => "refused " + error.name), late()]);
  return found;
};
</script>"""


@contextmanager
def other_site(folder: Path) -> Iterator[int]:
    """A web server with the page that attacks; its port."""
    (folder / "attack.html").write_text(ATTACK, encoding="utf-8")

    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, format: str, *args: Any) -> None:
            del format, args

    handler = functools.partial(Quiet, directory=str(folder))
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    try:
        yield server.server_address[1]
    finally:
        server.shutdown()
        thread.join()
        server.server_close()


@needs_browser
def test_a_page_of_another_site_gets_nothing(viewer: Served, tmp_path: Path) -> None:
    """Not even where it knows the token."""
    site = tmp_path / "site"
    site.mkdir()
    with other_site(site) as port, browser(tmp_path) as tab:
        for host in ("127.0.0.1", "localhost"):
            tab.go(f"http://{host}:{port}/attack.html#{viewer.port},{viewer.token}")
            tab.until("window.attack !== undefined")
            found = tab.value("attack()")
            assert len(found) == 32
            taken = {name: what for name, what in found.items() if what.split()[0] != "refused"}
            assert taken == {}, json.dumps(found, indent=1)


@needs_browser
def test_the_attack_would_be_seen(viewer: Served, tmp_path: Path) -> None:
    """The same page on the viewer's own origin reads and opens what is there to be had."""
    with browser(tmp_path) as tab:
        tab.go(f"http://127.0.0.1:{viewer.port}/favicon.ico?token={viewer.token}")
        script = ATTACK.partition("<script>")[2].partition("</script>")[0]
        tab.until("location.pathname == '/favicon.ico'")
        tab.value(f"location.hash = '{viewer.port},{viewer.token}'")
        tab.value(f"(0, eval)({json.dumps(script)})")
        found = tab.value("attack()")
    own = f"127.0.0.1{{}}?token={viewer.token}"
    for name in ("fetch " + own.format("/model"), "socket " + own.format("/state")):
        assert found[name] == "taken", json.dumps(found, indent=1)
    assert found["fetch 127.0.0.1/model"] == "refused 403"
    assert found["socket " + own.format("/drop")] == "refused"


@needs_browser
def test_the_users_own_page_works(viewer: Served, tmp_path: Path) -> None:
    """The model and the stream of states arrive, the panel's too."""
    with browser(tmp_path) as tab:
        tab.go(viewer.address)
        tab.until("typeof currentModelCrc !== 'undefined' && currentModelCrc !== 0")
        tab.until("Module.canvas.width > 200")
        assert [text for text in tab.console if "Failed to load" in text] == []
        # so that a page that is loaded again, as it is with another model, is let in again
        assert tab.value("location.search") == f"?token={viewer.token}"
    assert "Browser connected" in viewer.log.read_text()
    assert os.listdir(viewer.temporary) == []
