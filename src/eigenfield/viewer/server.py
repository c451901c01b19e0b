"""The viewer's server: HTTP/1.1 for one browser on this machine, out of a manifest, from the standard library alone.

What it guards against: other sites that reach for a server on this machine (the Host must be ours or a name of the
loopback, so that a name which someone points at 127.0.0.1 is refused; no answer may be read by or embedded in another
origin), paths to other files (there are none: exact matches in a table), and clients that are slow, greedy or broken
(limits of time, size and number).
"""

from __future__ import annotations

import contextlib
import errno
import ipaddress
import logging
import os
import re
import socket
import threading
import time
from collections.abc import Mapping
from http.server import ThreadingHTTPServer
from typing import Any

from eigenfield.core.errors import EigenfieldError, OptionError
from eigenfield.gltf.source import ByteRange
from eigenfield.viewer.manifest import Content, Manifest
from eigenfield.viewer.request import RefusedError, StrictHandler, is_known, takes_gzip, wanted_range

log = logging.getLogger("eigenfield.viewer")

LOOPBACK = "127.0.0.1"
SERVER_MAX_CONNECTIONS = 64  # at a time; a browser opens six
SERVER_CLOSE_SECONDS = 2.0  # for the threads of open connections to end
SERVER_POLL_SECONDS = 0.1  # between two checks whether the server is to close
HOST_HEADER = re.compile(r"(?:\[([0-9a-f:.]+)\]|([^\s:@/\[\]]+))(?::([0-9]{1,5}))?")  # address of IPv6, or name; port
REACHED_OTHERWISE = (
    "through a forwarded port open localhost; for another name start it with --host NAME, and use the same port on "
    "both sides"
)
CONTENT_SECURITY_POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; media-src blob:; "
    "connect-src 'self' blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
REFUSED_FEATURES = (
    "camera", "clipboard-read", "display-capture", "geolocation", "hid", "microphone", "midi", "payment",
    "serial", "usb",
)  # fmt: skip
PERMISSIONS_POLICY = ", ".join(
    [f"{name}=(self)" for name in ("xr-spatial-tracking", "gyroscope", "accelerometer", "fullscreen")]
    + [f"{name}=()" for name in REFUSED_FEATURES]
)
ANSWER_HEADERS = {
    "Content-Security-Policy": CONTENT_SECURITY_POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Permissions-Policy": PERMISSIONS_POLICY,
    "Cache-Control": "no-cache",
}


class Server(ThreadingHTTPServer):
    """Answers from a manifest, in threads of its own, from `with` or `start` until the block ends or `close`."""

    daemon_threads = True  # threads that are decoding a photograph end with the process

    def __init__(self, manifest: Manifest, host: str = LOOPBACK, port: int = 0) -> None:
        """Listen, without answering yet.

        Args:
            port: To listen on; 0: one that is free.

        Raises:
            OptionError: `host-unknown`, `port-busy`, `port-refused`.
        """
        listener = _listen(host, port)
        super().__init__(("", 0), _Answers, bind_and_activate=False)  # its own way to bind waits for a name server
        self.socket.close()
        self.socket = listener
        self.manifest = manifest
        self._process = os.getpid()
        self.host = host
        self.port: int = listener.getsockname()[1]
        self._connections: set[socket.socket] = set()
        self._lock = threading.Lock()
        self._acceptor = threading.Thread(target=self.serve_forever, args=(SERVER_POLL_SECONDS,), daemon=True)

    def start(self) -> None:
        """Answer from now on, in a thread."""
        if self._acceptor.ident is None:
            self._acceptor.start()

    def __enter__(self) -> Server:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Free the port and end every connection; what is being sent is cut off."""
        if os.getpid() != self._process:  # a forked child: thread and connections are its parent's
            self.socket.close()
            return
        if self._acceptor.ident is not None:
            self.shutdown()
        self.server_close()
        with self._lock:
            for connection in self._connections:
                with contextlib.suppress(OSError):
                    connection.shutdown(socket.SHUT_RDWR)
        deadline = time.monotonic() + SERVER_CLOSE_SECONDS
        while self._connections and time.monotonic() < deadline:
            time.sleep(0.01)

    @property
    def address(self) -> str:
        """Where a browser on this machine finds the page."""
        bound = self.socket.getsockname()[0]
        place = {"0.0.0.0": LOOPBACK, "::": "::1"}.get(bound, bound)
        return f"http://{_authority(place, self.port)}/"

    @property
    def is_public(self) -> bool:
        """Whether other machines can reach it."""
        return not _is_loopback(_plain(self.socket.getsockname()[0]))

    def is_named(self, host: str, reached: str) -> bool:
        """Whether a request may name `host`, in small letters, as its Host.

        Anyone may let a name resolve to this machine, but not a name of the loopback: those are answered at any port,
        since a port that is forwarded to this one may have another number. The address that a client reached is safe,
        too, being no name.

        Args:
            host: Name or address, and a port unless it is 80.
            reached: Address of this end of the connection.
        """
        if (match := HOST_HEADER.fullmatch(host)) is None:
            return False
        place, port = match[1] or match[2], int(match[3] or 80)
        if _is_loopback(place):
            return True
        places = {self.host.lower(), _plain(reached)}
        if self.is_public:
            places.add(socket.gethostname().lower())
        return port == self.port and place in places

    def get_request(self) -> tuple[socket.socket, Any]:
        try:
            return super().get_request()
        except OSError:
            time.sleep(SERVER_POLL_SECONDS)  # no file descriptors left: some come free when others end
            raise

    def verify_request(self, request: Any, client_address: Any) -> bool:
        """Whether there is room for another connection; else this thread answers 503, without waiting."""
        with self._lock:
            full = len(self._connections) >= SERVER_MAX_CONNECTIONS
            if not full:
                self._connections.add(request)
        if full:
            _Busy(request, client_address, self)
        return not full

    def close_request(self, request: Any) -> None:
        super().close_request(request)
        with self._lock:
            self._connections.discard(request)

    def handle_error(self, request: Any, client_address: Any) -> None:
        log.exception("a connection was ended")  # our own bug: the traceback is for the terminal, the server lives


class _Answers(StrictHandler):
    """What a connection is answered: a content of the manifest, whole or a range of it."""

    always = ANSWER_HEADERS
    server: Server

    def answer(self) -> None:
        if self.host is not None and not self.server.is_named(self.host, self.connection.getsockname()[0]):
            raise RefusedError(421, f"this server is {self.server.address}: {REACHED_OTHERWISE}")
        headers = {name.lower(): value for name, value in self.headers.items()}
        if _is_foreign(headers):
            raise RefusedError(403, "another site asked for this")
        if self.command not in ("GET", "HEAD"):
            raise RefusedError(405, "GET and HEAD only", {"Allow": "GET, HEAD"})
        if self.has_body:
            raise RefusedError(413, "a request here has no body")
        if "expect" in headers:
            raise RefusedError(417, "nothing is expected here")
        content, coding = self._content(), {}
        if content.gzip is not None:
            coding["Vary"] = "Accept-Encoding"
            if takes_gzip(headers):
                content, coding["Content-Encoding"] = content.gzip, "gzip"
        if is_known(headers, content.tag):
            self.reply(304, {"ETag": content.tag, **coding}, None)
            return
        size, status = content.data.size, 200
        about = {"Content-Type": content.type, "ETag": content.tag, "Accept-Ranges": "bytes", **coding}
        part = wanted_range(headers, size, content.tag) if self.command == "GET" else None
        first, last = part or (0, size)
        if part is not None:
            status, about["Content-Range"] = 206, f"bytes {first}-{last - 1}/{size}"
        log.info("%s %r: %d, %d bytes", self.command, self.target, status, last - first)
        self.reply(status, about, ByteRange(content.data, first, last))

    def refuse(self, error: RefusedError) -> None:
        log.info("%r: %d %s", self.raw_requestline, error.status, error.reason)
        super().refuse(error)

    def _content(self) -> Content:
        make = self.server.manifest.get(self.target)
        if make is None:
            raise RefusedError(404, "there is nothing here")
        try:
            return make()
        except EigenfieldError as error:
            log.warning("%s", error)  # with the path, which is for the person at this machine only
            raise RefusedError(500, error.message.splitlines()[0]) from None
        except Exception:
            log.exception("%s cannot be made", self.target)  # our own bug, as in handle_error
            raise RefusedError(500, "this cannot be shown") from None


class _Busy(_Answers):
    """The answer to a connection too many."""

    def handle(self) -> None:
        with contextlib.suppress(OSError):
            self.refuse(RefusedError(503, "too many connections"))


def _is_foreign(headers: Mapping[str, str]) -> bool:
    """Whether the browser says that a page of another origin wants this, other than by a link to it. What comes back
    is out of that page's reach anyway, but it could have photographs decoded."""
    by = headers.get("sec-fetch-site", "none")
    return by not in ("none", "same-origin") and headers.get("sec-fetch-mode") != "navigate"


def _listen(host: str, port: int) -> socket.socket:
    try:
        family, _, _, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
    except (OSError, UnicodeError) as error:
        raise OptionError(
            "host-unknown",
            f"--host {host}: no such name or address",
            remedy="leave it out, or name one of this machine",
        ) from error
    try:
        both = place[0] == "::" and socket.has_dualstack_ipv6()
        listener = socket.create_server(place, family=family, backlog=SERVER_MAX_CONNECTIONS, dualstack_ipv6=both)
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            raise OptionError(
                "port-busy", f"port {port} of {host} is in use", remedy="leave out --port, or name another"
            ) from error
        raise OptionError(
            "port-refused",
            f"port {port} of {host}: {error.strerror or 'cannot be listened on'}",
            remedy="leave out --port and --host, or name others",
        ) from error
    listener.setblocking(False)  # a client that goes away again before it is accepted blocks nobody
    return listener


def _is_loopback(place: str) -> bool:
    """Whether a name or address is this machine's own wherever it is looked up."""
    try:
        return ipaddress.ip_address(place).is_loopback
    except ValueError:
        return place == "localhost" or place.endswith(".localhost")


def _plain(address: str) -> str:
    """An address of a socket without its scope; of IPv4 where IPv6 carries it."""
    address = address.partition("%")[0]
    mapped = getattr(ipaddress.ip_address(address), "ipv4_mapped", None)
    return str(mapped or address)


def _authority(place: str, port: int) -> str:
    return f"[{place}]:{port}" if ":" in place else f"{place}:{port}"
