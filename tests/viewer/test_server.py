"""The viewer's server on real sockets: what it gives, and that no client can harm it or another."""

from __future__ import annotations

import contextlib
import gzip
import io
import logging
import threading
import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from eigenfield.capture import open_capture
from eigenfield.gltf import outline
from eigenfield.viewer import Content, Server, request, server
from eigenfield.viewer.request import RefusedError, wanted_range
from support.http_client import Client, until

ALWAYS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}


def test_the_page_and_its_files(client, scene):
    for path, kind in (
        ("/", "text/html; charset=utf-8"),
        ("/viewer.js", "text/javascript; charset=utf-8"),
        ("/eigenfield-three.js", "text/javascript; charset=utf-8"),
        ("/viewer.css", "text/css; charset=utf-8"),
        ("/scene.glb", "model/gltf-binary"),
        ("/photographs/0", "image/png"),
    ):
        answer = client.request(path)
        assert (answer.status, answer.headers["Content-Type"]) == (200, kind)
        assert answer.body and int(answer.headers["Content-Length"]) == len(answer.body)
    assert client.request("/scene.glb").body == scene.read_bytes()
    assert client.request("/scene.glb?again=%2e%2e").body == scene.read_bytes()
    assert b'"scene":"scene.glb"' in client.request("/").body


def test_a_photograph_is_the_capture_s_own(client, scene, capture):
    loaded, opened = outline(scene)[0], open_capture(capture)
    for index in (0, 4, 8):
        answer = client.request(f"/photographs/{index}")
        picture = np.asarray(Image.open(io.BytesIO(answer.body)))
        truth = opened.photograph(opened.names.index(loaded.rig.names[index])).pixels
        assert picture.shape == (56, 64, 3)
        assert np.abs(picture / 255 - truth).max() <= 0.5 / 255 + 1e-6


def test_every_answer_has_the_policies(client):
    requests = [
        ("/", "GET", {}), ("/nothing", "GET", {}), ("/", "POST", {}), ("/scene.glb", "GET", {"Range": "bytes=0-3"}),
        ("/scene.glb", "GET", {"Range": "bytes=99999999-"}), ("/", "GET", {"Expect": "100-continue"}),
    ]  # fmt: skip
    for target, method, headers in requests:
        check_policies(client.request(target, method, **headers))
    tag = client.request("/").headers["ETag"]
    check_policies(client.request("/", If_None_Match=tag))
    check_policies(client.request("/", host="evil.example"))
    client.send(b"rubbish\r\n\r\n")
    check_policies(client.answer())


def check_policies(answer):
    policy = dict(part.strip().split(" ", 1) for part in answer.headers["Content-Security-Policy"].split(";"))
    assert policy == {
        "default-src": "'none'", "script-src": "'self'", "style-src": "'self'", "img-src": "'self' blob: data:",
        "media-src": "blob:", "connect-src": "'self' blob:",
        "base-uri": "'none'", "form-action": "'none'", "frame-ancestors": "'none'",
    }  # fmt: skip
    assert answer.headers.items() >= ALWAYS.items()
    allowed = answer.headers["Permissions-Policy"].split(", ")
    assert {part for part in allowed if not part.endswith("=()")} == {
        "xr-spatial-tracking=(self)", "gyroscope=(self)", "accelerometer=(self)", "fullscreen=(self)"
    }  # fmt: skip


def test_head_has_the_headers_of_get_and_no_body(client):
    for path in ("/", "/scene.glb", "/photographs/2"):
        got, head = client.request(path), client.request(path, "HEAD")
        assert head.status == 200 and head.body == b""
        assert {k: v for k, v in head.headers.items() if k != "Date"} == {
            k: v for k, v in got.headers.items() if k != "Date"
        }
    assert client.request("/nothing", "HEAD").status == 404
    assert client.request("/", "HEAD").status == 200  # nothing of a body is left on the connection


def test_what_is_known_is_not_sent_again(client):
    answer = client.request("/scene.glb")
    for known in (answer.headers["ETag"], f'"other", W/{answer.headers["ETag"]}', "*"):
        again = client.request("/scene.glb", If_None_Match=known)
        assert (again.status, again.body, again.headers["ETag"]) == (304, b"", answer.headers["ETag"])
    assert client.request("/scene.glb", If_None_Match='"other"').status == 200


@pytest.mark.parametrize("accepted", ["gzip", "deflate, GZIP;q=0.5", "br , x-gzip ; q=1.000"])
def test_texts_are_packed_for_who_unpacks_them(client, accepted):
    for path in ("/", "/viewer.js", "/viewer.css"):
        plain, packed = client.request(path), client.request(path, Accept_Encoding=accepted)
        assert gzip.decompress(packed.body) == plain.body and len(packed.body) == int(packed.headers["Content-Length"])
        assert (packed.headers["Content-Encoding"], packed.headers["Vary"]) == ("gzip", "Accept-Encoding")
        assert plain.headers["Vary"] == "Accept-Encoding" and "Content-Encoding" not in plain.headers
        assert packed.headers["ETag"] != plain.headers["ETag"]
        known = client.request(path, Accept_Encoding=accepted, If_None_Match=packed.headers["ETag"])
        assert known.status == 304
    assert "Content-Encoding" not in client.request("/scene.glb", Accept_Encoding=accepted).headers


@pytest.mark.parametrize("accepted", ["", "identity", "gzip;q=0", "gzip;q=0.0", "gzipped", "gzip;q=x", "*"])
def test_texts_are_sent_as_they_are_to_others(client, accepted):
    answer = client.request("/viewer.js", Accept_Encoding=accepted)
    assert "Content-Encoding" not in answer.headers and answer.body == client.request("/viewer.js").body


@pytest.mark.parametrize(
    ("asked", "part"),
    [
        ("bytes=0-0", slice(0, 1)),
        ("bytes=0-99", slice(0, 100)),
        ("bytes=100-199", slice(100, 200)),
        ("bytes=1000-", slice(1000, None)),
        ("bytes=-7", slice(-7, None)),
        ("bytes=-99999999999999999999999999", slice(0, None)),
        ("bytes=5-99999999999999999999999999", slice(5, None)),
    ],
)
def test_ranges(client, scene, asked, part):
    data = scene.read_bytes()
    answer = client.request("/scene.glb", Range=asked)
    assert answer.status == 206 and answer.body == data[part]
    first, last, _ = part.indices(len(data))
    assert answer.headers["Content-Range"] == f"bytes {first}-{last - 1}/{len(data)}"
    assert client.request("/scene.glb", Range=asked, If_Range=answer.headers["ETag"]).status == 206
    other = client.request("/scene.glb", Range=asked, If_Range='"another"')
    assert other.status == 200 and other.body == data


@pytest.mark.parametrize(
    "asked", ["bytes=0-3,10-13", "bytes=9-3", "bytes=-", "bytes=a-b", "lines=0-3", "bytes=0x0-4", "bytes=+1-4", ""]
)
def test_ranges_that_are_ignored(client, scene, asked):
    answer = client.request("/scene.glb", Range=asked)
    assert answer.status == 200 and answer.body == scene.read_bytes()


def test_ranges_outside(client, scene):
    size = scene.stat().st_size
    for asked in (f"bytes={size}-", f"bytes={size}-{size + 5}", "bytes=-0", "bytes=99999999999999999999-"):
        answer = client.request("/scene.glb", Range=asked)
        assert answer.status == 416 and answer.headers["Content-Range"] == f"bytes */{size}"


@given(st.text(alphabet="0123456789-,= bytes", max_size=20) | st.text(), st.integers(0, 50))
def test_a_range_is_within_the_content_whatever_is_asked(text, size):
    with contextlib.suppress(RefusedError):
        found = wanted_range({"range": text}, size, '"tag"')
        assert found is None or 0 <= found[0] < found[1] <= size


def test_one_connection_serves_many_requests_also_when_sent_at_once(running):
    with Client(running.port) as client:
        lines = f" HTTP/1.1\r\nHost: localhost:{running.port}\r\n\r\n"
        client.send(b"\r\n".join(f"GET {path}{lines}".encode() for path in ("/viewer.js", "/nothing", "/viewer.css")))
        assert [client.answer().status for _ in range(3)] == [200, 404, 200]
        answer = client.request("/", Connection="close")
        assert answer.status == 200 and answer.headers["Connection"] == "close"
        assert client.is_closed()


def test_http_1_0_is_answered_once(running):
    with Client(running.port) as client:
        client.send(b"GET /viewer.css HTTP/1.0\r\n\r\n")
        answer = client.answer()
        assert answer.status == 200 and answer.headers["Connection"] == "close"
        assert client.is_closed()


def test_requests_in_small_pieces(running):
    with Client(running.port) as client:
        for byte in f"\r\nGET /viewer.css HTTP/1.1\r\nHost: localhost:{running.port}\r\n\r\n".encode():
            client.send(bytes([byte]))
        assert client.answer().status == 200


def test_slow_clients_are_dropped(running, impatient):
    with Client(running.port) as silent, Client(running.port) as begun, Client(running.port) as dripping:
        started = time.monotonic()
        begun.send(b"GET / HT")
        for _ in range(10):  # a byte at a time does not extend the time
            dripping.send(b"G")
            time.sleep(0.05)
        assert dripping.answer().status == begun.answer().status == 408
        assert silent.is_closed()
        assert time.monotonic() - started < 3


def test_a_kept_connection_that_says_nothing_is_closed(running, impatient):
    with Client(running.port) as client:
        assert client.request("/").status == 200
        assert client.is_closed()


def test_too_many_connections(running, monkeypatch):
    monkeypatch.setattr(server, "SERVER_MAX_CONNECTIONS", 4)
    with contextlib.ExitStack() as stack:
        first = [stack.enter_context(Client(running.port)) for _ in range(4)]
        for client in first:
            assert client.request("/").status == 200
        with Client(running.port) as late:
            assert late.answer().status == 503
        assert first[0].request("/").status == 200
    until(lambda: not running._connections)
    with Client(running.port) as client:
        assert client.request("/").status == 200


def test_many_clients_at_a_time(running, scene):
    data, seen = scene.read_bytes(), []

    def ask():
        with Client(running.port) as client:
            for path in ("/", "/scene.glb", "/photographs/3"):
                answer = client.request(path)
                seen.append(answer.status == 200 and (path != "/scene.glb" or answer.body == data))

    threads = [threading.Thread(target=ask) for _ in range(30)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert seen == [True] * 90


def test_clients_that_go_away_are_forgotten_in_silence(manifest, caplog, capfd):
    large = Content.of("model/gltf-binary", bytes(20_000_000))
    with Server({**manifest, "/large": lambda: large}) as started, caplog.at_level(logging.WARNING):
        for _ in range(5):
            with Client(started.port) as client:
                client.send(f"GET /large HTTP/1.1\r\nHost: localhost:{started.port}\r\n\r\n".encode())
                client.socket.recv(10)
            with Client(started.port) as client:
                client.send(b"GET /")
        until(lambda: not started._connections)
        with Client(started.port) as client:
            assert client.request("/large").body == large.data.data
    assert not caplog.records and not capfd.readouterr().err


def test_a_client_that_does_not_read_is_dropped(manifest, monkeypatch):
    monkeypatch.setattr(request, "SEND_SECONDS", 0.3)
    monkeypatch.setattr(request, "LINGER_SECONDS", 0.2)
    large = Content.of("model/gltf-binary", bytes(50_000_000))
    with Server({"/large": lambda: large}) as started, Client(started.port) as client:
        client.send(f"GET /large HTTP/1.1\r\nHost: localhost:{started.port}\r\n\r\n".encode())
        until(lambda: started._connections)
        until(lambda: not started._connections)


def test_closing_frees_the_port_and_ends_connections(manifest):
    threads = threading.active_count()
    with Server(manifest) as started:
        client = Client(started.port)
        assert client.request("/").status == 200
    assert client.is_closed()
    client.socket.close()
    until(lambda: threading.active_count() == threads)
    with pytest.raises(ConnectionRefusedError):
        Client(started.port)
    with Server(manifest, port=started.port) as again, Client(again.port) as client:
        assert client.request("/").status == 200


def test_a_server_that_was_never_entered_can_be_given_up(manifest):
    made = Server(manifest)
    made.close()
    with pytest.raises(ConnectionRefusedError):
        Client(made.port)
