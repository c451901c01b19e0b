"""`eigenfield view`, and the photographs that it shows."""

from __future__ import annotations

import contextlib
import json
import signal
import socket
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

import eigenfield as ef
from eigenfield.capture import match_photographs, open_capture
from eigenfield.core.errors import CaptureError, FormatError, OptionError
from eigenfield.gltf import outline
from eigenfield.viewer import Photographs, Server, make_manifest, page, photographs
from support.captures import write_capture
from support.http_client import Client, until
from support.viewer_scenes import glb_parts, join_glb


def test_a_damaged_photograph_is_one_line_and_the_server_lives(scene, tmp_path, caplog):
    folder = write_capture(tmp_path / "capture")
    (loaded, data), opened = outline(scene), open_capture(folder)
    pairs = match_photographs(loaded, opened)
    damaged = folder / "images" / "view_02.png"
    damaged.write_bytes(damaged.read_bytes()[:700])
    (folder / "images" / "view_03.png").unlink()
    manifest = make_manifest(data, "scene", Photographs(loaded, opened, pairs))
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
    loaded, opened = outline(scene)[0], open_capture(capture)
    made = Photographs(loaded, opened, match_photographs(loaded, opened))
    first = made.png(0)
    assert made.png(0) is first
    monkeypatch.setattr(photographs, "PHOTOGRAPH_CACHE_BYTES", len(first) + 10)
    assert made.png(1) is made.png(1)
    again = made.png(0)
    assert again is not first and again == first


def test_masks_are_left_alone(scene, capture, tmp_path):
    masks = tmp_path / "masks"
    masks.mkdir()
    for path in (capture / "images").iterdir():
        half = np.repeat(np.array([0, 255], np.uint8), 32)
        Image.fromarray(np.tile(half, (56, 1))).save(masks / path.name)
    loaded, plain, opened = outline(scene)[0], open_capture(capture), open_capture(capture, masks=masks)
    pairs = match_photographs(loaded, opened)
    (masks / "view_01.png").write_bytes(b"damaged")
    assert opened.views[1].mask is not None
    assert Photographs(loaded, opened, pairs).png(1) == Photographs(loaded, plain, pairs).png(1)


def test_photographs_of_another_size_are_refused(scene, tmp_path):
    from support.scenes import row_grid

    loaded, opened = outline(scene)[0], open_capture(write_capture(tmp_path / "capture", row_grid(9, 32, 28)))
    with pytest.raises(CaptureError) as caught:
        Photographs(loaded, opened, match_photographs(loaded, opened))
    assert caught.value.code == "photograph-size" and "32x28" in str(caught.value)


@contextlib.contextmanager
def command(*arguments):
    """`eigenfield view` with the stand-in for the built page, as a process of its own; its address."""
    code = (
        "import signal, sys; from pathlib import Path; from eigenfield.viewer import page\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        f"page.STATIC_FOLDER = Path({str(page.STATIC_FOLDER)!r})\n"
        f"sys.argv = ['eigenfield', 'view', *{list(map(str, arguments))!r}]\n"
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
@pytest.mark.parametrize(
    "number",
    [pytest.param(signal.SIGINT, marks=pytest.mark.slow), signal.SIGTERM, getattr(signal, "SIGHUP", signal.SIGTERM)],
    ids=lambda n: n.name,
)
@pytest.mark.slow
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


@pytest.mark.slow
def test_the_command_keeps_what_it_checked(scene, tmp_path):
    copy = tmp_path / "scene.glb"
    copy.write_bytes(scene.read_bytes())
    with command(copy, "--no-browser", "-q") as process, Client(port_of(process)) as client:
        copy.write_bytes(b"other")
        assert client.request("/scene.glb").body == scene.read_bytes()


@pytest.mark.slow
def test_a_plain_gltf_file_is_shown_as_one(scene, capture, tmp_path):
    text, rest = glb_parts(scene.read_bytes())
    root = json.loads(text)
    del root["extensions"]
    root["extensionsUsed"].remove("EIGENFIELD_eigen_textures")
    plain = tmp_path / "plain.glb"
    plain.write_bytes(join_glb(json.dumps(root).encode(), rest))
    with command(plain, "--no-browser") as process, Client(port_of(process)) as client:
        assert client.request("/scene.glb").body == plain.read_bytes()
        assert "no eigen textures" in process.stderr.readline()
    with command(plain, capture, "--no-browser") as process:
        assert process.wait(20) == 2 and "plain.glb" in process.stderr.readline()


@pytest.mark.slow
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


def test_errors_of_the_command_are_one_line(scene, tmp_path, run):
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
            code, out, err = run("view", *arguments, "--no-browser")
            assert (code, out) == (2, ""), err
            assert err.count("\n") == 1 and err.startswith("eigenfield: ") and part in err, err


@pytest.mark.slow
def test_the_command_says_when_the_network_can_see_it(scene):
    with command(scene, "--no-browser", "--host", "0.0.0.0") as process:
        port_of(process)
        assert "anyone on the network" in process.stderr.readline()


def test_a_second_scene_is_served_beside_the_first(scene, tmp_path):
    second = tmp_path / "small.GLB"
    second.write_bytes(scene.read_bytes())
    with ef.view(scene, second, browser=False) as running, Client(running.port) as client:
        assert client.request("/second.glb").body == outline(scene)[1]
        page = client.request("/").body.decode()
        assert '"beside":{"names":["scene","small"],"scene":"second.glb"' in page and '"photographs"' not in page
    with ef.view(ef.load(scene), ef.load(second), browser=False) as running, Client(running.port) as client:
        assert '"names":["A","B"]' in client.request("/").body.decode()
    with pytest.raises(OptionError) as caught:
        ef.view(scene, second, browser=False, grid=(3, 3))
    assert caught.value.code == "no-capture" and "a second scene is named" in str(caught.value)
    with pytest.raises(FormatError):
        ef.view(scene, tmp_path / "none.glb", browser=False)
