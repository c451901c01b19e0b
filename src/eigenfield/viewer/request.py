"""One HTTP/1.x request: its head read from a socket within limits of time and size, and taken apart (RFC 9112)."""

from __future__ import annotations

import re
import socket
import time
from collections.abc import Mapping
from dataclasses import dataclass

MAX_LINE = 8192  # bytes of the request line
MAX_HEAD = 32768  # bytes of request line and headers together
MAX_HEADERS = 100
TOKEN = re.compile(r"[!#$%&'*+.^_`|~0-9A-Za-z-]+")
VERSION = re.compile(r"HTTP/([0-9])\.([0-9])")
PIECE = 16384


class RefusedError(Exception):
    """A request that is answered with an error: its status, one line for a person, and headers of the answer.

    fatal: where the next request begins can no longer be told, so the connection ends with the answer.
    """

    def __init__(self, status: int, reason: str, headers: Mapping[str, str] | None = None, fatal: bool = False) -> None:
        self.status = status
        self.reason = reason
        self.headers = dict(headers or {})
        self.fatal = fatal
        super().__init__(status, reason)


class SilentError(Exception):
    """The client is gone, or never said anything: nobody is there to be answered."""


@dataclass(frozen=True)
class Request:
    """A well-formed request head.

    path: of the target, as sent, without its query; never decoded.
    host: the authority that the client believes to talk to, in small letters; None only in HTTP/1.0.
    headers: by name in small letters; those that came twice are joined by commas.
    keep: whether the client will send another request on this connection.
    body: whether bytes follow the head.
    """

    method: str
    path: str
    host: str | None
    headers: Mapping[str, str]
    keep: bool
    body: bool


def read_head(connection: socket.socket, waiting: bytearray, seconds: float) -> bytes:
    """The next request head, up to and with its empty line; what was received beyond it stays in `waiting`.

    The head must be there whole within `seconds`, however its bytes trickle in. Raises RefusedError 400, 408, 414, 431;
    SilentError if the client closes, or lets the time pass without a byte.
    """
    deadline = time.monotonic() + seconds
    seen = 0
    while True:
        while waiting.startswith(b"\r\n"):
            del waiting[:2]  # some clients send an empty line behind a body
            seen = 0
        end = waiting.find(b"\r\n\r\n", max(0, seen - 3))
        _check_size(waiting if end < 0 else waiting[: end + 4], waiting.find(b"\n"))
        if end >= 0:
            head = bytes(waiting[: end + 4])
            del waiting[: end + 4]
            return head
        _check_lines(waiting, seen)
        seen = len(waiting)
        waiting += _receive(connection, deadline, seen > 0)


def _check_size(head: bytearray, line: int) -> None:
    if line > MAX_LINE or (line < 0 and len(head) > MAX_LINE):
        raise RefusedError(414, f"the request line is longer than {MAX_LINE} bytes", fatal=True)
    if len(head) > MAX_HEAD:
        raise RefusedError(431, f"the headers are longer than {MAX_HEAD} bytes", fatal=True)


def _check_lines(head: bytearray, start: int) -> None:
    """Answer at once what can no longer become a head: waiting for CR LF CR LF would only end by the clock."""
    newline = head.find(b"\n", start)
    while newline >= 0:
        if newline == 0 or head[newline - 1] != 0x0D:
            raise RefusedError(400, "lines end in CR LF", fatal=True)
        newline = head.find(b"\n", newline + 1)
    if head and head[0] != 0x0D and not 0x21 <= head[0] <= 0x7E:
        raise RefusedError(400, "this is not HTTP", fatal=True)  # TLS, as a rule


def _receive(connection: socket.socket, deadline: float, begun: bool) -> bytes:
    left = deadline - time.monotonic()
    try:
        if left <= 0:
            raise TimeoutError
        connection.settimeout(left)
        data = connection.recv(PIECE)
    except TimeoutError:
        if begun:
            raise RefusedError(408, "the request did not arrive in time", fatal=True) from None
        raise SilentError from None
    except OSError:
        raise SilentError from None
    if not data:
        raise SilentError
    return data


def parse_head(head: bytes) -> Request:
    """Take a head apart. Raises RefusedError 400, 431, 505."""
    line, *fields = head.decode("latin-1").removesuffix("\r\n\r\n").split("\r\n")
    words = line.split(" ")
    version = VERSION.fullmatch(words[-1])
    if len(words) != 3 or version is None or not TOKEN.fullmatch(words[0]):
        raise RefusedError(400, "the request line is not METHOD TARGET HTTP/1.1", fatal=True)
    if version[1] != "1":
        raise RefusedError(505, "this server speaks HTTP/1.1", fatal=True)
    headers = _headers(fields)
    path, authority = _target(words[1])
    host = authority or headers.get("host")
    if host is None and version[2] != "0":
        raise RefusedError(400, "a request names its Host", fatal=True)
    tokens = {token.strip().lower() for token in headers.get("connection", "").split(",")}
    return Request(
        method=words[0],
        path=path,
        host=None if host is None else host.lower(),
        headers=headers,
        keep=version[2] != "0" and "close" not in tokens,
        body=_has_body(headers),
    )


def _headers(fields: list[str]) -> dict[str, str]:
    if len(fields) > MAX_HEADERS:
        raise RefusedError(431, f"more than {MAX_HEADERS} headers", fatal=True)
    headers: dict[str, str] = {}
    for field in fields:
        name, colon, value = field.partition(":")
        value = value.strip(" \t")
        if not colon or not TOKEN.fullmatch(name) or any(c < " " and c != "\t" for c in value):
            raise RefusedError(400, "a header is not NAME: VALUE", fatal=True)
        key = name.lower()
        if key in headers and key in ("host", "content-length", "transfer-encoding"):
            raise RefusedError(400, f"{key} is there twice", fatal=True)
        headers[key] = f"{headers[key]}, {value}" if key in headers else value
    return headers


def _target(target: str) -> tuple[str, str | None]:
    """Path and authority of a request target: "/path?query", or "http://authority/path?query" (RFC 9112, 3.2)."""
    authority = None
    if target[:7].lower() == "http://":
        authority, slash, rest = target[7:].partition("/")
        target = slash + rest or "/"
        if not authority:
            raise RefusedError(400, "the target names no host", fatal=True)
    return target.partition("?")[0], authority


def _has_body(headers: Mapping[str, str]) -> bool:
    if "transfer-encoding" in headers:
        return True
    length = headers.get("content-length", "0")
    if not re.fullmatch(r"[0-9]{1,100}", length):
        raise RefusedError(400, "Content-Length is no number", fatal=True)
    return int(length) > 0
