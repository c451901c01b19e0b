"""HTTP/1.1 on one connection: `http.server` of the standard library, made strict, with limits of time and size.
Byte ranges and validators are those of RFC 9110, sections 13 and 14.

`BaseHTTPRequestHandler` takes request lines and headers apart, keeps connections and writes answers. Written by hand is
what it does not promise:

- The head of a request must arrive within a time. A socket's timeout begins anew with every byte that trickles in.
- A head is at most 32 kB long. `http.server` reads up to 6.5 MB.
- Bare line feeds, folded lines, control characters and repeated Host headers are refused (RFC 9112).
- An error is one line of text with the headers of every answer, not a page of HTML.
- A refused client sees the answer. Closing a socket that has unread bytes would take the answer back.
"""

from __future__ import annotations

import contextlib
import io
import re
import socket
import time
from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler
from typing import ClassVar

from eigenfield.core.errors import FormatError
from eigenfield.gltf.source import ByteSource, HeldBytes

REQUEST_LINE_MAX_BYTES = 8192
REQUEST_HEAD_MAX_BYTES = 32768  # request line and headers together
REQUEST_SECONDS = 10.0  # for a request's head, from the first moment it may come
SEND_SECONDS = 30.0  # for each piece of an answer
LINGER_SECONDS = 2.0  # for reading what a refused client still sends, so that it sees the answer
SEND_PIECE_BYTES = 256 * 1024  # of an answer, sent at a time
TOKEN_PATTERN = rb"[!#$%&'*+.^_`|~0-9A-Za-z-]+"
REQUEST_LINE = re.compile(TOKEN_PATTERN + rb" [^ \r\n]+ HTTP/[0-9]\.[0-9]\r\n")
RANGE_HEADER = re.compile(r"bytes=\s*([0-9]{0,100})-([0-9]{0,100})\s*", re.IGNORECASE)
GZIP_CODING = re.compile(r"(?:x-)?gzip\s*(?:;\s*q=([01](?:\.[0-9]{0,3})?)\s*)?", re.IGNORECASE)
HEADER_LINE = re.compile(TOKEN_PATTERN + rb":[^\x00-\x08\x0a-\x1f]*\r\n")


@dataclass(eq=False)
class RefusedError(Exception):
    """A request that is answered with an error.

    Attributes:
        reason: One line for a person.
    """

    status: int
    reason: str
    headers: Mapping[str, str] = field(default_factory=dict)


class StrictHandler(BaseHTTPRequestHandler, ABC):
    """Reads the requests of one connection and calls `answer` for each that is well formed.

    A connection ends with the answer to a malformed request, as the beginning of the next request cannot be known.

    Attributes:
        target: path of the request as the client sent it, without its query; never decoded.
        host: authority that the client believes to talk to, in small letters; None only in HTTP/1.0.
        has_body: whether bytes follow the head. The connection then ends with the answer.
    """

    protocol_version = request_version = default_request_version = "HTTP/1.1"
    always: ClassVar[Mapping[str, str]] = {}
    target: str
    host: str | None
    has_body: bool

    @abstractmethod
    def answer(self) -> None:
        """Answer the request by `reply`, once, or raise RefusedError."""

    def setup(self) -> None:
        super().setup()
        self._incoming = _Incoming(self.connection)
        self._lines = io.BufferedReader(self._incoming)
        self.command, self.raw_requestline = "", b""
        self.close_connection = True

    def handle(self) -> None:
        with contextlib.suppress(OSError):  # the client is gone, or never said anything
            super().handle()
            self._linger()

    def handle_one_request(self) -> None:
        try:
            self._read_request()
        except RefusedError as error:
            self.close_connection = True
            self.refuse(error)
            return
        try:
            self.answer()
        except RefusedError as error:
            self.refuse(error)

    def handle_expect_100(self) -> bool:
        return True  # whether anything is expected is for `answer` to see

    def send_error(self, code: int, message: str | None = None, explain: str | None = None) -> None:
        raise RefusedError(code, HTTPStatus(code).phrase)  # found by parse_request

    def refuse(self, error: RefusedError) -> None:
        """Answer with an error: one line of text."""
        headers = {"Content-Type": "text/plain; charset=utf-8", **error.headers}
        self.reply(error.status, headers, HeldBytes(f"{error.reason}\n".encode()))

    def reply(self, status: int, headers: Mapping[str, str], content: ByteSource | None) -> None:
        """Send an answer, to HEAD without the content.

        Args:
            headers: Beside those of every answer.
            content: None: the answer has none (304).

        Raises:
            OSError: The connection is gone, or the content could not be read to its end.
        """
        self.connection.settimeout(SEND_SECONDS)
        self.send_response_only(status)
        length = {} if content is None else {"Content-Length": str(content.size)}
        connection = {"Connection": "close" if self.close_connection else "keep-alive"}
        date = {"Date": self.date_time_string()}
        for name, value in {**date, **self.always, **headers, **length, **connection}.items():
            self.send_header(name, value)
        self.end_headers()
        if content is not None and self.command != "HEAD":
            for first in range(0, content.size, SEND_PIECE_BYTES):
                try:
                    piece = content.read(first, min(first + SEND_PIECE_BYTES, content.size))
                except FormatError as error:
                    raise ConnectionError(str(error)) from error
                self.connection.settimeout(SEND_SECONDS)
                self.connection.sendall(piece)

    def _read_request(self) -> None:
        """The next request. Raises RefusedError; OSError if the client closes, or lets the time pass without a byte."""
        self.command, self.raw_requestline = "", b""
        self.raw_requestline, headers = self._read_head()
        self.rfile = io.BytesIO(headers)
        self.parse_request()
        for name in ("Host", "Content-Length", "Transfer-Encoding"):
            if len(self.headers.get_all(name, [])) > 1:
                raise RefusedError(400, f"{name} is there twice")
        target, host = self.path, self.headers["Host"]
        if target[:7].lower() == "http://":  # the absolute form (RFC 9112, 3.2.2)
            host, slash, rest = target[7:].partition("/")
            target = slash + rest or "/"
        if not host and (host is not None or self.request_version != "HTTP/1.0"):
            raise RefusedError(400, "a request names its Host")
        length = self.headers.get("Content-Length", "0").strip()
        if not re.fullmatch(r"[0-9]{1,100}", length):
            raise RefusedError(400, "Content-Length is no number")
        self.target, self.host = target.partition("?")[0], host and host.strip().lower()
        self.has_body = "Transfer-Encoding" in self.headers or int(length) > 0
        self.close_connection = self.close_connection or self.has_body

    def _read_head(self) -> tuple[bytes, bytes]:
        """Request line and header lines, with the empty line, as they were sent."""
        self._incoming.deadline = time.monotonic() + REQUEST_SECONDS
        line = b"\r\n"
        while line == b"\r\n":  # some clients send an empty line behind a body
            start = self._lines.peek(1)[:1]
            if start != b"\r" and not b"!" <= start <= b"~":
                if not start:
                    raise ConnectionAbortedError
                raise RefusedError(400, "this is not HTTP")  # TLS, as a rule
            line = self._read_line(
                REQUEST_LINE_MAX_BYTES,
                RefusedError(414, f"the request line is longer than {REQUEST_LINE_MAX_BYTES} bytes"),
            )
        if not REQUEST_LINE.fullmatch(line):
            raise RefusedError(400, "the request line is not METHOD TARGET HTTP/1.1")
        headers = bytearray()
        long = RefusedError(431, f"the headers are longer than {REQUEST_HEAD_MAX_BYTES} bytes")
        while True:
            header = self._read_line(REQUEST_HEAD_MAX_BYTES - len(line) - len(headers), long)
            headers += header
            if header == b"\r\n":
                return line, bytes(headers)
            if not HEADER_LINE.fullmatch(header):
                raise RefusedError(400, "a header is not NAME: VALUE")

    def _read_line(self, limit: int, long: RefusedError) -> bytes:
        try:
            line = self._lines.readline(limit + 1)
        except TimeoutError:
            raise RefusedError(408, "the request did not arrive in time") from None
        if len(line) > limit:
            raise long
        if not line.endswith(b"\n"):
            raise ConnectionAbortedError
        if not line.endswith(b"\r\n"):
            raise RefusedError(400, "lines end in CR LF")
        return line

    def _linger(self) -> None:
        """Say that no more comes, and read what is on its way: closing with bytes unread would take back the answer."""
        self.connection.shutdown(socket.SHUT_WR)
        self._incoming.deadline = time.monotonic() + LINGER_SECONDS
        while self._incoming.read(SEND_PIECE_BYTES):
            pass


class _Incoming(io.RawIOBase):
    """The bytes that a connection receives until `deadline`, a value of time.monotonic(); then TimeoutError."""

    def __init__(self, connection: socket.socket) -> None:
        self.deadline = 0.0
        self._connection = connection

    def readable(self) -> bool:
        return True

    def readinto(self, buffer: bytearray | memoryview) -> int:  # type: ignore[override]  # Buffer is of Python 3.12
        left = self.deadline - time.monotonic()
        if left <= 0:
            raise TimeoutError
        self._connection.settimeout(left)
        return self._connection.recv_into(buffer)


def wanted_range(headers: Mapping[str, str], size: int, tag: str) -> tuple[int, int] | None:
    """First byte and the one behind the last that a GET asks for; None: all of it.

    None also for several ranges and for a Range that cannot be read, which a server may ignore, and where If-Range
    names another content.

    Args:
        headers: By names in lower case.
        tag: Strong ETag of the content, quotes included.

    Raises:
        RefusedError: 416: no byte of the content is in the range.
    """
    match = RANGE_HEADER.fullmatch(headers.get("range", ""))
    if match is None or headers.get("if-range", tag) != tag:
        return None
    first, last = match[1], match[2]
    if not first:
        if not last:
            return None
        if int(last) == 0 or size == 0:
            raise _outside(size)
        return max(0, size - int(last)), size
    if last and int(last) < int(first):
        return None
    if int(first) >= size:
        raise _outside(size)
    return int(first), min(size, int(last) + 1) if last else size


def takes_gzip(headers: Mapping[str, str]) -> bool:
    """Whether Accept-Encoding (RFC 9110, section 12.5.3) names gzip, and does not refuse it by a weight of 0.

    Args:
        headers: By names in lower case.
    """
    codings = [GZIP_CODING.fullmatch(coding.strip()) for coding in headers.get("accept-encoding", "").split(",")]
    return any(match is not None and float(match[1] or 1) > 0 for match in codings)


def is_known(headers: Mapping[str, str], tag: str) -> bool:
    """Whether If-None-Match says that the client has this content already: status 304.

    Args:
        headers: By names in lower case.
        tag: Strong ETag of the content, quotes included.
    """
    tags = [entry.strip().removeprefix("W/") for entry in headers.get("if-none-match", "").split(",")]
    return tag in tags or tags == ["*"]


def _outside(size: int) -> RefusedError:
    return RefusedError(416, f"there are {size} bytes", {"Content-Range": f"bytes */{size}"})
