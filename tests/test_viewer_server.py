"""The viewer's server on real sockets: what it gives, what it refuses, and that no client can harm it or another."""

from __future__ import annotations

import contextlib
import io
import logging
import signal
import socket
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from captures import write_capture
from http_client import Client, write_build
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from eigenfield.capture import open_capture
from eigenfield.errors import CaptureError, OptionError
from eigenfield.evaluation import match_photographs
from eigenfield.format import file_bytes, outline
from eigenfield.viewer import Content, Photographs, Server, make_manifest, page, photographs, server
from eigenfield.viewer.ranges import RangeError, wanted_range
from eigenfield.viewer.request import RefusedError, Request, parse_head

ALWAYS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
}


@pytest.fixture(scope="module")
def capture(tmp_path_factory):
    return write_capture(tmp_path_factory.mktemp("capture") / "capture")


@pytest.fixture(scope="module")
def scene(capture, tmp_path_factory):
    from eigenfield import encode

    path = tmp_path_factory.mktemp("scene") / "scene.glb"
    encode(open_capture(capture), capture / "proxy.ply", textures=3, atlas=64, hold_out="view_04.png").save(path)
    return path


@pytest.fixture(scope="module", autouse=True)
def build(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(page, "STATIC", write_build(tmp_path_factory.mktemp("build") / "static"))
        yield


@pytest.fixture(scope="module")
def manifest(scene, capture):
    loaded, opened = outline(scene), open_capture(capture)
    return make_manifest(file_bytes(loaded), "scene", Photographs(loaded, opened, match_photographs(loaded, opened)))


@pytest.fixture
def running(manifest):
    with Server(manifest) as started:
        yield started


@pytest.fixture
def client(running):
    with Client(running.port) as connected:
        yield connected


@pytest.fixture
def impatient(monkeypatch):
    monkeypatch.setattr(server, "REQUEST_SECONDS", 0.4)
    monkeypatch.setattr(server, "LINGER_SECONDS", 0.2)


# what it gives


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
    loaded, opened = outline(scene), open_capture(capture)
    for index in (0, 4, 8):
        answer = client.request(f"/photographs/{index}")
        picture = np.asarray(Image.open(io.BytesIO(answer.body)))
        truth = opened.photograph(opened.names.index(loaded.names[index])).pixels
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
        "connect-src": "'self' blob:", "base-uri": "'none'", "form-action": "'none'", "frame-ancestors": "'none'",
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
    with contextlib.suppress(RangeError):
        found = wanted_range({"range": text}, size, '"tag"')
        assert found is None or 0 <= found[0] < found[1] <= size


# what it refuses


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
        "evil.example", f"evil.example:{port}", "127.0.0.1", "localhost", f"127.0.0.1:{port + 1}", f"127.0.0.2:{port}",
        f"localhost.evil.example:{port}", f"127.0.0.1:{port}@evil.example", f"0.0.0.0:{port}", "::1", "\xe9",
    ):  # fmt: skip
        with Client(port) as client:
            answer = client.request("/scene.glb", host=host)
            assert answer.status == 421 and b"glTF" not in answer.body, host


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


@given(st.binary(max_size=200))
def test_any_bytes_are_a_request_or_refused(data):
    with contextlib.suppress(RefusedError):
        assert isinstance(parse_head(data + b"\r\n\r\n"), Request)


@given(
    st.from_regex(r"[A-Z]{1,8}", fullmatch=True),
    st.from_regex(r"/[!->@-~]{0,40}", fullmatch=True),
    st.dictionaries(st.from_regex(r"x-[a-z]{1,8}", fullmatch=True), st.from_regex(r"[!-~]{0,20}", fullmatch=True)),
)
def test_well_formed_requests_are_understood(method, path, headers):
    lines = [f"{method} {path}?a=b HTTP/1.1", "hOST: A:1", *(f"{k.upper()}: \t{v} " for k, v in headers.items())]
    request = parse_head("\r\n".join([*lines, "", ""]).encode())
    assert request == Request(method, path, "a:1", {"host": "A:1", **headers}, True, False)


# clients of every kind


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
    monkeypatch.setattr(server, "MOST", 4)
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


def until(condition):
    deadline = time.monotonic() + 10
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.01)


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
            assert client.request("/large").body == large.data
    assert not caplog.records and not capfd.readouterr().err


def test_a_client_that_does_not_read_is_dropped(manifest, monkeypatch):
    monkeypatch.setattr(server, "SEND_SECONDS", 0.3)
    monkeypatch.setattr(server, "LINGER_SECONDS", 0.2)
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


# photographs


def test_a_damaged_photograph_is_one_line_and_the_server_lives(scene, tmp_path, caplog):
    folder = write_capture(tmp_path / "capture")
    loaded, opened = outline(scene), open_capture(folder)
    pairs = match_photographs(loaded, opened)
    damaged = folder / "images" / "view_02.png"
    damaged.write_bytes(damaged.read_bytes()[:700])
    (folder / "images" / "view_03.png").unlink()
    manifest = make_manifest(file_bytes(loaded), "scene", Photographs(loaded, opened, pairs))
    with Server(manifest) as started, Client(started.port) as client:
        for index in (2, 3):
            answer = client.request(f"/photographs/{index}")
            assert answer.status == 500 and answer.body.count(b"\n") == 1
            assert str(tmp_path).encode() not in answer.body  # the path is for the terminal only
        assert client.request("/photographs/1").status == 200
    assert "view_02.png" in caplog.text and "view_03.png" in caplog.text and "Traceback" not in caplog.text


def test_a_bug_is_told_on_the_terminal_and_the_server_lives(caplog):
    def fail():
        raise ZeroDivisionError("secret")

    with Server({"/bug": fail}) as started, Client(started.port) as client:
        answer = client.request("/bug")
        assert answer.status == 500 and b"secret" not in answer.body
        assert client.request("/bug").status == 500
    assert "ZeroDivisionError" in caplog.text


def test_photographs_are_kept_and_forgotten_by_size(scene, capture, monkeypatch):
    loaded, opened = outline(scene), open_capture(capture)
    made = Photographs(loaded, opened, match_photographs(loaded, opened))
    first = made.png(0)
    assert made.png(0) is first
    monkeypatch.setattr(photographs, "KEPT", len(first) + 10)
    assert made.png(1) is made.png(1)
    again = made.png(0)
    assert again is not first and again == first


def test_masks_are_left_alone(scene, capture, tmp_path):
    masks = tmp_path / "masks"
    masks.mkdir()
    for path in (capture / "images").iterdir():
        half = np.repeat(np.array([0, 255], np.uint8), 32)
        Image.fromarray(np.tile(half, (56, 1))).save(masks / path.name)
    loaded, plain, opened = outline(scene), open_capture(capture), open_capture(capture, masks=masks)
    pairs = match_photographs(loaded, opened)
    (masks / "view_01.png").write_bytes(b"damaged")
    assert opened.views[1].mask is not None
    assert Photographs(loaded, opened, pairs).png(1) == Photographs(loaded, plain, pairs).png(1)


def test_photographs_of_another_size_are_refused(scene, tmp_path):
    from scenes import row_grid

    loaded, opened = outline(scene), open_capture(write_capture(tmp_path / "capture", row_grid(9, 32, 28)))
    with pytest.raises(CaptureError) as caught:
        Photographs(loaded, opened, match_photographs(loaded, opened))
    assert caught.value.code == "photograph-size" and "32x28" in str(caught.value)


# the command


@contextlib.contextmanager
def command(*arguments):
    """`eigenfield view` with the stand-in for the built page, as a process of its own; its address."""
    code = (
        "import signal, sys; from pathlib import Path; from eigenfield.viewer import page\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        f"page.STATIC = Path({str(page.STATIC)!r}); sys.argv = ['eigenfield', 'view', *{list(map(str, arguments))!r}]\n"
        "from eigenfield.cli import main; main()"
    )
    process = subprocess.Popen(
        [sys.executable, "-X", "dev", "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def port_of(process):
    line = process.stdout.readline()
    assert line.startswith("http://127.0.0.1:") and line.endswith("/\n"), line + process.stderr.read()
    return int(line.rstrip("/\n").rpartition(":")[2])


@pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX")
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM], ids=lambda n: n.name)
def test_the_command_serves_until_it_is_stopped(scene, capture, number):
    with command(scene, capture, "--no-browser", "--metres-per-unit", "0.5") as process:
        port = port_of(process)
        with Client(port) as client:
            body = client.request("/").body
            assert b'"metresPerUnit":0.5' in body and b'"view_04.png":"photographs/4"' in body
            assert client.request("/photographs/4").status == 200
            process.send_signal(number)
            out, err = process.communicate(timeout=30)
        assert (process.returncode, out, err) == (0, "", "Ctrl-C ends it\nstopped\n")
        with pytest.raises(ConnectionRefusedError):
            Client(port)


def test_the_command_keeps_what_it_checked(scene, tmp_path):
    copy = tmp_path / "scene.glb"
    copy.write_bytes(scene.read_bytes())
    with command(copy, "--no-browser", "-q") as process, Client(port_of(process)) as client:
        copy.write_bytes(b"other")
        assert client.request("/scene.glb").body == scene.read_bytes()


def test_the_command_opens_the_browser(scene, tmp_path, monkeypatch):
    """$BROWSER is called with the address."""
    seen = tmp_path / "seen"
    script = tmp_path / "browser"
    script.write_text(f'#!/bin/sh\nprintf %s "$1" > {seen}.part; mv {seen}.part {seen}\n')
    script.chmod(0o755)
    monkeypatch.setenv("BROWSER", f"{script} %s")
    with command(scene) as process:
        port = port_of(process)
        until(seen.exists)
        assert seen.read_text() == f"http://127.0.0.1:{port}/"


def test_errors_of_the_command_are_one_line(scene, capture, tmp_path):
    damaged = tmp_path / "damaged.glb"
    damaged.write_bytes(scene.read_bytes()[:1000])
    other = write_capture(tmp_path / "others")
    for path in (other / "images").iterdir():
        path.rename(path.with_name("x" + path.name))
    text = (other / "transforms.json").read_text().replace("view_", "xview_")
    (other / "transforms.json").write_text(text)
    with socket.create_server(("127.0.0.1", 0)) as taken:
        for arguments, part in (
            ([tmp_path / "missing.glb"], "does not exist"),
            ([damaged], "copy or download it again"),
            ([scene, "--port", taken.getsockname()[1]], "in use"),
            ([scene, "--host", "nowhere.invalid"], "no such name"),
            ([scene, "--metres-per-unit", "nan"], "no length"),
            ([scene, "--grid", "3x3"], "--grid is for a capture"),
            ([scene, other], "no photograph has the name"),
        ):
            with command(*arguments, "--no-browser") as process:
                out, err = process.communicate(timeout=60)
                assert (process.returncode, out) == (2, ""), err
                assert err.count("\n") == 1 and err.startswith("eigenfield: ") and part in err, err


def test_the_command_says_when_the_network_can_see_it(scene):
    with command(scene, "--no-browser", "--host", "0.0.0.0") as process:
        port_of(process)
        assert "anyone on the network" in process.stderr.readline()
