"""Who may speak to the viewer's server: the user's own page, and nobody else.

The engine's server answers whoever reaches its port, and every page that a browser has open reaches
the ports of this machine. So each request must
- name this machine as its host: a name of a stranger's that leads here (DNS rebinding) does not;
- come from a page of this very server, where a browser says from which it comes;
- carry the token of the address that was printed: other users of the machine do not know it.
The page puts the token on everything that it asks for. It is in no cookie: a browser would send
that to every other port of this machine too. What is sent is bounded, models are not taken.
Why not a proxy in front: the server behind it would still be open to the machine.
"""

from __future__ import annotations

import hmac
import json
import os
import re
import secrets
import socket
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs

from mujoco.studio import web_viewer
from mujoco.studio.web import web_server
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

SOCKETS = ("/ui", "/state")
HOSTS = ("localhost", "127.0.0.1", "[::1]")
LARGEST_MESSAGE = 1 << 20
"""Bytes of one message from a page; what it sends of mouse and keys is below 1 kB."""
HANDSHAKE = 10.0  # seconds in which a connection has to say what it wants

# nobody else may show, read or guess at what is served
_HEADERS = {
    "Content-Security-Policy": "frame-ancestors 'none'",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
}
# ahead of the page's own scripts: what they ask this server for gets the token
_SIGNING = """<script>
(() => {
  const token = %s;
  history.replaceState(null, "", "?token=" + token);
  const signed = (address) => {
    const url = new URL(address, location.href);
    if (url.host === location.host) url.searchParams.set("token", token);
    return url.href;
  };
  const fetching = window.fetch;
  window.fetch = (what, how) => fetching(what instanceof Request ? what : signed(what), how);
  window.WebSocket = class extends WebSocket {
    constructor(address, protocols) {
      super(signed(address), protocols ?? []);
    }
  };
})();
</script>"""


class Guard:
    """The token of a server, and what is refused."""

    def __init__(self) -> None:
        self.token = secrets.token_urlsafe(24)
        # for the command line of a browser, which others may list: good for one page
        self.once: str | None = secrets.token_urlsafe(24)

    def address(self, port: int, once: bool = False) -> str:
        """Where the page is; `once`: an address that works a single time.

        Not localhost: that may be [::1] too, where another user may listen for the token.
        """
        return f"http://127.0.0.1:{port}/?token={self.once if once else self.token}"

    def refusal(self, request: Request) -> Response | None:
        """What a request that may not be is told, else None."""
        path, _, query = request.path.partition("?")
        host = request.headers.get_all("Host")
        if len(host) != 1 or _name(host[0]) not in HOSTS:
            return _told(403, "the viewer is at 127.0.0.1 only")
        origin = request.headers.get_all("Origin")
        own = (f"http://{host[0]}", f"https://{host[0]}")
        if len(origin) > 1 or (origin and origin[0] not in own):
            return _told(403, "a page of another site may not speak to the viewer")
        if path in SOCKETS and not origin:
            return _told(403, "only the viewer's own page may speak to it")
        if not self._known(path, parse_qs(query).get("token", [])):
            return _told(403, "open the address that `inerter view` has printed, with its token")
        if path == "/drop":
            return _told(404, "no models are taken here; start `inerter view` with another")
        return None

    def _known(self, path: str, given: list[str]) -> bool:
        if len(given) != 1:
            return False
        if hmac.compare_digest(given[0].encode(), self.token.encode()):
            return True
        if path == "/" and self.once and hmac.compare_digest(given[0].encode(), self.once.encode()):
            self.once = None
            return True
        return False

    def page(self, body: bytes) -> bytes:
        """The engine's page, whose requests carry the token."""
        text = body.decode("utf-8")
        signing = _SIGNING % json.dumps(self.token)
        text = re.sub(r"<head>", lambda match: match[0] + signing, text, count=1)
        return re.sub(
            r'(<(?:script|link)\b[^>]*\b(?:src|href)=")([^"?:]+)(")',
            lambda match: f"{match[1]}{match[2]}?token={self.token}{match[3]}",
            text,
        ).encode()

    def serve(self, serve: Callable[..., Any]) -> Callable[..., Any]:
        """Websockets' `serve`, behind this guard."""

        def guarded(handler: Any, *, process_request: Any, process_response: Any, **more: Any):
            def ask(connection: Any, request: Request) -> Response | None:
                if refused := self.refusal(request):
                    return refused
                response = process_request(connection, request)
                if response is not None:
                    if request.path.partition("?")[0] in ("/", "/index.html"):
                        response.body = self.page(response.body)
                        _set(response.headers, "Content-Length", str(len(response.body)))
                        _set(response.headers, "Cache-Control", "no-store")
                    _close(response.headers)
                return response

            def answer(connection: Any, request: Request, response: Response) -> Response | None:
                changed = process_response(connection, request, response)
                _close((changed or response).headers)
                return changed

            bounds = {"max_size": LARGEST_MESSAGE, "open_timeout": HANDSHAKE}
            return serve(
                handler, process_request=ask, process_response=answer, **{**more, **bounds}
            )

        return guarded


def put_before(guard: Guard) -> None:
    """Have the servers that the engine starts in this process ask a guard."""
    web_server.serve = guard.serve(web_server.serve)
    web_server.bind_loopback_socket = _own_listener
    # what it says about a server without a guard does not hold
    web_viewer._print_url_banner = lambda host, port: None


# --- answers -----------------------------------------------------------------------------------


def _name(host: str) -> str:
    """The name in a Host header, without its port."""
    return re.sub(r":\d{1,5}$", "", host).lower()


def _told(status: int, text: str) -> Response:
    body = f"{text}\n".encode()
    reason = {403: "Forbidden", 404: "Not Found"}[status]
    headers = Headers({"Content-Type": "text/plain; charset=utf-8", "Connection": "close"})
    headers["Content-Length"] = str(len(body))
    _close(headers)
    return Response(status, reason, headers, body)


def _set(headers: Headers, name: str, value: str) -> None:
    """Give a header one value; assigning adds another one."""
    if name in headers:
        del headers[name]
    headers[name] = value


def _close(headers: Headers) -> None:
    """Headers that keep an answer from pages of other sites."""
    if "Access-Control-Allow-Origin" in headers:
        del headers["Access-Control-Allow-Origin"]
    for name, value in _HEADERS.items():
        _set(headers, name, value)


# --- the engine's other port -------------------------------------------------------------------


class _OwnListener(socket.socket):
    """Hears this process alone: the drawing of the panel comes in over a port of its own."""

    def accept(self) -> tuple[socket.socket, Any]:
        while True:
            connection, address = super().accept()
            if _of_this_process(address, self.getsockname()):
                return connection, address
            connection.close()


def _own_listener(port: int = 0) -> socket.socket:
    listener = _OwnListener(socket.AF_INET, socket.SOCK_STREAM)
    listener.bind(("127.0.0.1", port))
    listener.listen()
    return listener


def _of_this_process(peer: tuple[str, int], here: tuple[str, int]) -> bool:
    """Whether the other end of a connection is a socket of this process; Linux alone tells."""
    if sys.platform != "linux":
        return True
    ends = [_as_in_proc(peer), _as_in_proc(here)]
    for line in Path("/proc/self/net/tcp").read_text(encoding="ascii").splitlines()[1:]:
        fields = line.split()
        if fields[1:3] == ends:
            return f"socket:[{fields[9]}]" in _open_files()
    return False


def _as_in_proc(end: tuple[str, int]) -> str:
    number = int.from_bytes(socket.inet_aton(end[0]), sys.byteorder)
    return f"{number:08X}:{end[1]:04X}"


def _open_files() -> set[str]:
    found = set()
    for name in os.listdir("/proc/self/fd"):
        try:
            found.add(os.readlink(f"/proc/self/fd/{name}"))
        except OSError:
            continue  # closed in between
    return found
