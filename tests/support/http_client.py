"""A small client on a bare socket, and a stand-in for the built page: what the tests of the viewer's server need."""

from __future__ import annotations

import socket
import time
from dataclasses import dataclass
from pathlib import Path

INDEX = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<title>eigenfield</title>
<link rel="icon" href="data:,">
<script type="module" crossorigin src="./viewer.js"></script>
<link rel="stylesheet" crossorigin href="./viewer.css">
</head>
<body>
<script type="application/json" id="eigenfield-config">{}</script>
</body>
</html>
"""


def write_build(folder: Path) -> Path:
    """A page with the marks that the real one has."""
    folder.mkdir()
    (folder / "index.html").write_text(INDEX, encoding="utf-8")
    script = 'document.title += "</script><!--"; const pattern = /<\\/SCRIPT>/;\r\n'
    (folder / "viewer.js").write_text(script, encoding="utf-8", newline="")
    (folder / "viewer.css").write_text("body::after { content: '</style>' }\n", encoding="utf-8")
    (folder / "eigenfield-three.js").write_text("export {};\n", encoding="utf-8")
    for name in ("worker.js", "icon.svg", "icon-192.png", "icon-512.png"):
        (folder / name).write_bytes(name.encode())
    return folder


@dataclass(frozen=True)
class Answer:
    status: int
    headers: dict[str, str]
    body: bytes


class Client:
    """One connection to 127.0.0.1:port."""

    def __init__(self, port: int, timeout: float = 20) -> None:
        self.port = port
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=timeout)
        self.waiting = b""

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def send(self, data: bytes) -> None:
        self.socket.sendall(data)

    def request(self, target: str = "/", method: str = "GET", host: str | None = None, **headers: str) -> Answer:
        """Send a request and read its answer; headers with _ for -."""
        lines = [f"{method} {target} HTTP/1.1", f"Host: {host or f'127.0.0.1:{self.port}'}"]
        lines += [f"{name.replace('_', '-')}: {value}" for name, value in headers.items()]
        self.send("\r\n".join([*lines, "", ""]).encode("latin-1"))
        return self.answer(method == "HEAD")

    def answer(self, bodiless: bool = False) -> Answer:
        while b"\r\n\r\n" not in self.waiting:
            self._more()
        head, _, self.waiting = self.waiting.partition(b"\r\n\r\n")
        line, *fields = head.decode("ascii").split("\r\n")
        headers = dict(field.split(": ", 1) for field in fields)
        assert len(headers) == len(fields), "a header is there twice"
        status = int(line.split(" ")[1])
        length = 0 if bodiless or status == 304 else int(headers["Content-Length"])
        while len(self.waiting) < length:
            self._more()
        body, self.waiting = self.waiting[:length], self.waiting[length:]
        return Answer(status, headers, body)

    def _more(self) -> None:
        data = self.socket.recv(1 << 16)
        if not data:
            raise EOFError("the server closed the connection")
        self.waiting += data

    def is_closed(self) -> bool:
        """Whether the server has closed, waiting for it; anything it still sends is a failure."""
        assert not self.waiting
        try:
            return self.socket.recv(1) == b""
        except ConnectionResetError:
            return True


def until(condition):
    """Waits, ten seconds at most."""
    deadline = time.monotonic() + 10
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)
