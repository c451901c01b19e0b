"""What the viewer's server refuses, on real sockets, and how it reads requests."""

from __future__ import annotations

import socket

import pytest
from hypothesis import given
from hypothesis import strategies as st

from eigenfield.core.errors import OptionError
from eigenfield.gltf.source import HeldBytes
from eigenfield.viewer import Server
from eigenfield.viewer.request import StrictHandler
from support.http_client import Client


@pytest.mark.parametrize(
    "target",
    [
        "/../scene.glb", "/..", "/%2e%2e/scene.glb", "/%2e%2e%2f%2e%2e%2fetc/passwd", "//etc/passwd", "/scene%2eglb",
        "/scene.glb/", "/./scene.glb", "/SCENE.GLB", "/photographs/", "/photographs/9", "/photographs/-1",
        "/photographs/00", "/photographs/0/", "/photographs/../scene.glb", "/static/index.html", "/index.html",
        "/..\\scene.glb", "/C:/Windows/win.ini", "/%00", "/viewer.js%00.css", "/favicon.ico", "\xff", "*", "scene.glb",
    ],
)  # fmt: skip
def test_other_paths_are_not_there(client, target):
    answer = client.request(target)
    assert (answer.status, answer.body) == (404, b"there is nothing here\n")
    assert client.request("/").status == 200


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "TRACE", "CONNECT", "PATCH", "get", "QUERY"])
def test_other_methods(client, method):
    answer = client.request("/", method)
    assert answer.status == 405 and answer.headers["Allow"] == "GET, HEAD"


def test_only_our_own_names_are_answered(running):
    port = running.port
    for host in (f"127.0.0.1:{port}", f"localhost:{port}", f"LOCALHOST:{port}", f"[::1]:{port}"):
        with Client(port) as client:
            assert client.request("/", host=host).status == 200
    for host in (
        "evil.example", f"evil.example:{port}", f"localhost.evil.example:{port}", f"evillocalhost:{port}",
        f"127.0.0.1.evil.example:{port}", f"127.0.0.1:{port}@evil.example", f"evil.example@localhost:{port}",
        f"0.0.0.0:{port}", f"10.0.0.1:{port}", f"[::2]:{port}", "::1", "localhost:", "\xe9",
    ):  # fmt: skip
        with Client(port) as client:
            answer = client.request("/scene.glb", host=host)
            assert answer.status == 421 and b"glTF" not in answer.body, host
            assert b"--host NAME" in answer.body and answer.body.count(b"\n") == 1


@pytest.mark.parametrize("listens", ["127.0.0.1", "0.0.0.0"])
def test_a_forwarded_port_may_have_another_number(manifest, listens):
    with Server(manifest, listens) as started:
        for host in ("localhost:9000", "localhost", "127.0.0.1:1", "127.0.0.2:9000", "[::1]:9000", "a.localhost:9000"):
            with Client(started.port) as client:
                assert client.request("/", host=host).status == 200, host
                foreign = {"Sec_Fetch_Site": "same-site", "Sec_Fetch_Mode": "cors"}  # a page at another port
                assert client.request("/scene.glb", host=host, **foreign).status == 403


def test_other_sites_may_link_to_it_and_no_more(client):
    for site, mode, status in (
        ("cross-site", "no-cors", 403), ("same-site", "cors", 403), ("cross-site", "navigate", 200),
        ("same-origin", "cors", 200), ("none", "navigate", 200),
    ):  # fmt: skip
        assert client.request("/photographs/0", Sec_Fetch_Site=site, Sec_Fetch_Mode=mode).status == status


def test_absolute_targets_count_as_the_host(running):
    with Client(running.port) as client:
        assert client.request(f"http://localhost:{running.port}/viewer.js").status == 200
        assert client.request(f"HTTP://localhost:{running.port}").status == 200
        assert client.request("http://evil.example/viewer.js").status == 421
        assert client.request("http:///viewer.js").status == 400


def test_a_public_server_answers_to_the_address_that_was_reached(manifest):
    with Server(manifest, "0.0.0.0") as started:
        assert started.is_public and started.address == f"http://127.0.0.1:{started.port}/"
        for host, status in ((f"0.0.0.0:{started.port}", 200), (f"{socket.gethostname()}:{started.port}", 200),
                             (f"evil.example:{started.port}", 421)):  # fmt: skip
            with Client(started.port) as client:
                assert client.request("/", host=host).status == status
    with Server(manifest) as started:
        assert not started.is_public


@pytest.mark.skipif(not socket.has_dualstack_ipv6(), reason="needs IPv6")
def test_all_addresses_of_ipv6_are_those_of_ipv4_too(manifest):
    with Server(manifest, "::") as started:
        assert started.is_public and started.address == f"http://[::1]:{started.port}/"
        with Client(started.port) as client:  # at 127.0.0.1
            assert client.request("/").status == 200
            assert client.request("/", host=f"evil.example:{started.port}").status == 421


def test_hosts_and_ports_that_cannot_be(manifest):
    with pytest.raises(OptionError) as caught:
        Server(manifest, "no such host.invalid")
    assert caught.value.code == "host-unknown"
    with Server(manifest) as started, pytest.raises(OptionError) as caught:
        Server(manifest, port=started.port)
    assert caught.value.code == "port-busy" and str(started.port) in str(caught.value)
    with pytest.raises(OptionError) as caught:
        Server(manifest, "192.0.2.1")  # an address of documentation, of no machine
    assert caught.value.code == "port-refused"


@pytest.mark.parametrize(
    ("sent", "status"),
    [
        (b"GET /\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\n\r\n", 400),  # no Host
        (b"GET  / HTTP/1.1\r\nHost: HOST\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nHost: HOST\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\nHost : HOST\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\n folded: line\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nX: a\0b\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nX: a\rb\r\n\r\n", 400),
        (b"GET / HTTP/1.1\nHost: HOST\n\n", 400),
        (b"G\0T / HTTP/1.1\r\nHost: HOST\r\n\r\n", 400),
        (b"GET / HTTP/2.0\r\nHost: HOST\r\n\r\n", 505),
        (b"GET / HTTP/11\r\nHost: HOST\r\n\r\n", 400),
        (b"\x16\x03\x01\x02\0\x01\0\x01\xfc\x03\x03" + bytes(64), 400),  # TLS
        (bytes(100), 400),
        (b"GET /" + b"a" * 20000 + b" HTTP/1.1\r\nHost: HOST\r\n\r\n", 414),
        (b"A" * 100000, 414),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nX: " + b"a" * 100000 + b"\r\n\r\n", 431),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\n" + b"X: a\r\n" * 200 + b"\r\n", 431),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nContent-Length: 5\r\n\r\nhello", 413),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nContent-Length: 99999999999999\r\n\r\n", 413),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nContent-Length: -5\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nContent-Length: 0x5\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n", 400),
        (b"GET / HTTP/1.1\r\nHost: HOST\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n0\r\n\r\n", 413),
        (b"POST / HTTP/1.1\r\nHost: HOST\r\nContent-Length: 50000\r\n\r\n" + b"a" * 50000, 405),
    ],
)
def test_malformed_requests_are_refused_and_the_connection_ends(running, impatient, sent, status):
    with Client(running.port) as client:
        client.send(sent.replace(b"HOST", f"127.0.0.1:{running.port}".encode()))
        answer = client.answer()
        assert answer.status == status and answer.body.count(b"\n") == 1
        assert answer.headers["Connection"] == "close"
        assert client.is_closed()
    with Client(running.port) as client:
        assert client.request("/").status == 200


@pytest.fixture(scope="module")
def shared(manifest):
    """A server for the examples of one property."""
    with Server(manifest) as started:
        yield started


@given(st.binary(max_size=200))
def test_any_bytes_are_answered_in_one_line_or_not_at_all(shared, data):
    with Client(shared.port) as client:
        client.send(data + b"\r\n\r\n")
        client.socket.shutdown(socket.SHUT_WR)
        received = b"".join(iter(lambda: client.socket.recv(1 << 16), b""))
    assert not received or (received.startswith(b"HTTP/1.1 4") and received.count(b"Content-Length") >= 1)
    assert not received or received.endswith(b"\n")


class Understood(StrictHandler):
    """Keeps what the last request was understood as."""

    def answer(self):
        Understood.last = (self.command, self.target, self.host, dict(self.headers.items()), self.has_body)
        self.reply(200, {}, HeldBytes(b"\n"))


@given(
    st.from_regex(r"[A-Z]{1,8}", fullmatch=True),
    st.from_regex(r"/(?!/)[!->@-~]{0,40}", fullmatch=True),
    st.dictionaries(st.from_regex(r"x-[a-z]{1,8}", fullmatch=True), st.from_regex(r"[!-~]{0,20}", fullmatch=True)),
)
def test_well_formed_requests_are_understood(method, path, headers):
    lines = [f"{method} {path}?a=b HTTP/1.1", "hOST: A:1", *(f"{k.upper()}: \t{v} " for k, v in headers.items())]
    near, far = socket.socketpair()
    with near, far:
        near.sendall("\r\n".join([*lines, "", ""]).encode())
        near.shutdown(socket.SHUT_WR)
        Understood(far, ("", 0), None)
        assert near.recv(1 << 16).startswith(b"HTTP/1.1 200")
    fields = {"hOST": "A:1", **{name.upper(): value for name, value in headers.items()}}
    command, target, host, found, has_body = Understood.last
    assert (command, target, host, has_body) == (method, path, "a:1", False)
    assert {name: value.strip() for name, value in found.items()} == fields
