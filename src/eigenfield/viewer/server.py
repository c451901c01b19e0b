"""The viewer's server: HTTP/1.1 for one browser on this machine, out of a manifest, from the standard library alone.

What it guards against: other sites that reach for a server on this machine (the Host must be ours, so that a name
which someone points at 127.0.0.1 is refused; no answer may be read by or embedded in another origin), paths to other
files (there are none: exact matches in a table), and clients that are slow, greedy or broken (limits of time, size and
number).
"""

from __future__ import annotations

import contextlib
import errno
import ipaddress
import logging
import selectors
import socket
import threading
import time
from email.utils import formatdate
from http import HTTPStatus
from types import TracebackType

from eigenfield.core.errors import EigenfieldError, OptionError
from eigenfield.viewer.manifest import Content, Manifest
from eigenfield.viewer.ranges import RangeError, is_known, wanted_range
from eigenfield.viewer.request import RefusedError, Request, SilentError, parse_head, read_head

log = logging.getLogger("eigenfield.viewer")

LOOPBACK = "127.0.0.1"
MOST = 64  # connections at a time; a browser opens six
REQUEST_SECONDS = 10.0  # for a request's head, from the first moment it may come
SEND_SECONDS = 30.0  # for each piece of an answer
LINGER_SECONDS = 2.0  # for reading what a refused client still sends, so that it sees the answer
PIECE = 256 * 1024
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self' blob:; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
REFUSED_FEATURES = (
    "camera", "clipboard-read", "display-capture", "geolocation", "hid", "microphone", "midi", "payment",
    "serial", "usb",
)  # fmt: skip
FEATURES = ", ".join(
    [f"{name}=(self)" for name in ("xr-spatial-tracking", "gyroscope", "accelerometer", "fullscreen")]
    + [f"{name}=()" for name in REFUSED_FEATURES]
)
ALWAYS = {
    "Content-Security-Policy": POLICY,
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Permissions-Policy": FEATURES,
    "Cache-Control": "no-cache",
}


class Server:
    """Answers from a manifest, in threads of its own, from `with` until the block ends.

    host: name or address to listen on; port: 0 for one that is free. Raises OptionError `host-unknown`, `port-busy`,
    `port-refused`.
    """

    def __init__(self, manifest: Manifest, host: str = LOOPBACK, port: int = 0) -> None:
        self._manifest = manifest
        self._listener = _listen(host, port)
        self.host = host
        self.port: int = self._listener.getsockname()[1]
        self._connections: set[socket.socket] = set()
        self._gate = threading.Lock()
        self._open = True
        self._wake, self._woken = socket.socketpair()
        self._acceptor = threading.Thread(target=self._accept, name="eigenfield-view", daemon=True)

    def __enter__(self) -> Server:
        self._acceptor.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Free the port and end every connection; what is being sent is cut off."""
        self._open = False
        self._wake.close()
        if self._acceptor.ident is not None:
            self._acceptor.join()
        self._woken.close()
        self._listener.close()
        with self._gate:
            for connection in self._connections:
                with contextlib.suppress(OSError):
                    connection.shutdown(socket.SHUT_RDWR)
        deadline = time.monotonic() + LINGER_SECONDS
        while self._connections and time.monotonic() < deadline:
            time.sleep(0.01)  # threads that are decoding a photograph end with the process

    @property
    def address(self) -> str:
        """Where a browser on this machine finds the page."""
        bound = self._listener.getsockname()[0]
        place = {"0.0.0.0": LOOPBACK, "::": "::1"}.get(bound, bound)
        return f"http://{_authority(place, self.port)}/"

    @property
    def is_public(self) -> bool:
        """Whether other machines can reach it."""
        return not ipaddress.ip_address(self._listener.getsockname()[0].partition("%")[0]).is_loopback

    def _accept(self) -> None:
        with selectors.DefaultSelector() as selector:
            selector.register(self._listener, selectors.EVENT_READ)
            selector.register(self._woken, selectors.EVENT_READ)
            while self._open:
                selector.select()
                if not self._open:
                    return
                try:
                    connection, _ = self._listener.accept()
                except BlockingIOError:
                    continue  # it went away again
                except OSError:
                    time.sleep(0.1)  # no file descriptors left: some come free when others end
                    continue
                self._begin(connection)

    def _begin(self, connection: socket.socket) -> None:
        connection.settimeout(SEND_SECONDS)
        with self._gate:
            full = len(self._connections) >= MOST
            if not full:
                self._connections.add(connection)
        if full:
            connection.setblocking(False)
            with contextlib.suppress(OSError):
                connection.send(_refusal(RefusedError(503, "too many connections"), False))
            connection.close()
            return
        try:
            threading.Thread(target=self._run, args=(connection,), name="eigenfield-client", daemon=True).start()
        except RuntimeError:  # the system gives no more threads
            self._end(connection)

    def _run(self, connection: socket.socket) -> None:
        try:
            with contextlib.suppress(OSError, SilentError):
                self._serve(connection)
        finally:
            self._end(connection)

    def _end(self, connection: socket.socket) -> None:
        connection.close()
        with self._gate:
            self._connections.discard(connection)

    def _serve(self, connection: socket.socket) -> None:
        waiting = bytearray()
        keep = True
        while keep and self._open:
            try:
                request = parse_head(read_head(connection, waiting, REQUEST_SECONDS))
            except RefusedError as error:
                _send(connection, _refusal(error, False))
                _linger(connection)
                return
            try:
                keep = request.keep and not request.body
                self._answer(connection, request, keep)
            except RefusedError as error:
                keep = keep and not error.fatal
                log.info("%s %r: %d %s", request.method, request.path, error.status, error.reason)
                _send(connection, _refusal(error, keep, request.method == "HEAD"))
        _linger(connection)

    def _answer(self, connection: socket.socket, request: Request, keep: bool) -> None:
        if request.host is not None and request.host not in self._hosts(connection):
            raise RefusedError(421, f"this server is {self.address}")
        if _is_foreign(request):
            raise RefusedError(403, "another site asked for this")
        if request.method not in ("GET", "HEAD"):
            raise RefusedError(405, "GET and HEAD only", {"Allow": "GET, HEAD"})
        if request.body:
            raise RefusedError(413, "a request here has no body")
        if "expect" in request.headers:
            raise RefusedError(417, "nothing is expected here")
        content = self._content(request.path)
        headers = {"Content-Type": content.type, "ETag": content.tag, "Accept-Ranges": "bytes"}
        if is_known(request.headers, content.tag):
            _send(connection, _head(304, {"ETag": content.tag}, keep))
            return
        size = len(content.data)
        first, last, status = 0, size, 200
        if request.method == "GET":
            try:
                part = wanted_range(request.headers, size, content.tag)
            except RangeError:
                raise RefusedError(416, f"there are {size} bytes", {"Content-Range": f"bytes */{size}"}) from None
            if part is not None:
                (first, last), status = part, 206
                headers["Content-Range"] = f"bytes {first}-{last - 1}/{size}"
        headers["Content-Length"] = str(last - first)
        log.info("%s %r: %d, %d bytes", request.method, request.path, status, last - first)
        _send(connection, _head(status, headers, keep))
        if request.method == "GET":
            _send(connection, memoryview(content.data)[first:last])

    def _content(self, path: str) -> Content:
        make = self._manifest.get(path)
        if make is None:
            raise RefusedError(404, "there is nothing here")
        try:
            return make()
        except EigenfieldError as error:
            log.warning("%s", error)  # with the path, which is for the person at this machine only
            raise RefusedError(500, error.message.splitlines()[0]) from None
        except Exception:
            log.exception("%s cannot be made", path)  # our own bug: the traceback is for the terminal, the server lives
            raise RefusedError(500, "this cannot be shown") from None

    def _hosts(self, connection: socket.socket) -> set[str]:
        """What a client of ours may believe to talk to. The address that it reached is safe, being no name: a name may
        be pointed at us by anyone."""
        reached = connection.getsockname()[0].partition("%")[0]
        places = {LOOPBACK, "localhost", "::1", self.host, reached}
        if self.is_public:
            places.add(socket.gethostname())
        hosts = {_authority(place, self.port).lower() for place in places}
        return hosts | {host.removesuffix(":80") for host in hosts} if self.port == 80 else hosts


def _is_foreign(request: Request) -> bool:
    """Whether the browser says that a page of another origin wants this, other than by a link to it. What comes back
    is out of that page's reach anyway, but it could have photographs decoded."""
    by = request.headers.get("sec-fetch-site", "none")
    return by not in ("none", "same-origin") and request.headers.get("sec-fetch-mode") != "navigate"


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
        listener = socket.create_server(place, family=family, backlog=MOST)
    except OSError as error:
        raise _not_listening(host, port, error) from error
    listener.setblocking(False)
    return listener


def _not_listening(host: str, port: int, error: OSError) -> OptionError:
    if error.errno == errno.EADDRINUSE:
        return OptionError("port-busy", f"port {port} of {host} is in use", remedy="leave out --port, or name another")
    reason = error.strerror or "cannot be listened on"
    return OptionError(
        "port-refused", f"port {port} of {host}: {reason}", remedy="leave out --port and --host, or name others"
    )


def _authority(place: str, port: int) -> str:
    return f"[{place}]:{port}" if ":" in place else f"{place}:{port}"


def _head(status: int, headers: dict[str, str], keep: bool) -> bytes:
    lines = [f"HTTP/1.1 {status} {HTTPStatus(status).phrase}", f"Date: {formatdate(usegmt=True)}"]
    lines += [f"{name}: {value}" for name, value in (ALWAYS | headers).items()]
    lines.append(f"Connection: {'keep-alive' if keep else 'close'}")
    return "\r\n".join([*lines, "", ""]).encode("ascii")


def _refusal(error: RefusedError, keep: bool, silent: bool = False) -> bytes:
    """An answer that is one line of text; without the line to a HEAD request."""
    body = f"{error.reason}\n".encode()
    headers = {"Content-Type": "text/plain; charset=utf-8", "Content-Length": str(len(body)), **error.headers}
    return _head(error.status, headers, keep) + (b"" if silent else body)


def _send(connection: socket.socket, data: bytes | memoryview) -> None:
    view = memoryview(data)
    for start in range(0, len(view), PIECE):
        connection.settimeout(SEND_SECONDS)
        connection.sendall(view[start : start + PIECE])


def _linger(connection: socket.socket) -> None:
    """Say that no more comes, and read what is on its way: closing with bytes unread would take back the answer."""
    connection.shutdown(socket.SHUT_WR)
    deadline = time.monotonic() + LINGER_SECONDS
    while (left := deadline - time.monotonic()) > 0:
        connection.settimeout(left)
        if not connection.recv(PIECE):
            return
