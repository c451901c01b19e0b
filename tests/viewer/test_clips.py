"""Clips in the viewer's server and in pages: their files are carried as they are."""

from __future__ import annotations

import base64
import html
import http.client
import io
import re
import urllib.error
import urllib.request
from dataclasses import replace

import pytest
from PIL import Image

import eigenfield as ef
from eigenfield.core.clip import Audio
from eigenfield.core.errors import FormatError, OptionError
from eigenfield.gltf import load_clip, save
from eigenfield.rendering import RenderJob, viewpoint
from eigenfield.viewer import view
from eigenfield.viewer.exports import export
from support.clips import numbered_clip
from support.sounds import opus

EMBEDDED = re.compile(rb'id="eigenfield-scene">([^<]*)<')


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("clip") / "clip.glb"
    save(numbered_clip((2, 3)), path)
    return path


def held_in(page):
    return base64.b64decode(EMBEDDED.search(page.read_bytes())[1])


@pytest.mark.parametrize("laboratory", [False, True])
def test_a_page_holds_the_clip_s_file(file, tmp_path, laboratory):
    for name, clip in (("file", file), ("value", load_clip(file))):
        page = tmp_path / f"{name}.html"
        export(clip, page, **({"laboratory": True} if laboratory else {}))
        assert held_in(page) == file.read_bytes()


def test_the_poster_is_the_first_frame(file, tmp_path):
    export(file, tmp_path / "page.html")
    first = load_clip(file).scene(0.0)
    camera, weights = viewpoint(first)
    with Image.open(tmp_path / "page.jpg") as poster:
        assert poster.size == (camera.width, camera.height)
        shown = io.BytesIO()
        ground = (21 / 255, 23 / 255, 26 / 255)
        Image.fromarray(RenderJob(first, background=ground).rgb(camera, weights)).save(
            shown, "JPEG", quality=85, optimize=True
        )
        assert (tmp_path / "page.jpg").read_bytes() == shown.getvalue()


def test_a_notebook_shows_the_clip(file):
    shown = ef.load_clip(file)._repr_html_()
    page = html.unescape(re.search('srcdoc="([^"]*)"', shown)[1]).encode()
    assert base64.b64decode(EMBEDDED.search(page)[1]) == file.read_bytes() and 'sandbox="allow-scripts' in shown


def test_a_page_of_one_frame_holds_a_scene(file, tmp_path):
    export(file, tmp_path / "page.html", time=0.2)
    assert held_in(tmp_path / "page.html") != file.read_bytes()
    assert b"EFTL" not in held_in(tmp_path / "page.html")


def test_the_server_gives_the_clip_s_file(file):
    for clip in (file, load_clip(file)):
        with view(clip, browser=False) as server, urllib.request.urlopen(f"{server.address}scene.glb") as answer:
            assert answer.read() == file.read_bytes()


def test_a_clip_on_disk_is_read_for_each_answer_and_one_that_was_cut_meanwhile_ends_it(file, tmp_path):
    path = tmp_path / "clip.glb"
    path.write_bytes(file.read_bytes())
    size = path.stat().st_size
    with view(path, browser=False) as server:
        asked = urllib.request.Request(
            f"{server.address}scene.glb", headers={"Range": f"bytes={size - 20}-{size - 11}"}
        )
        with urllib.request.urlopen(asked) as answer:
            assert answer.status == 206 and answer.headers["Content-Range"] == f"bytes {size - 20}-{size - 11}/{size}"
            assert answer.read() == file.read_bytes()[-20:-10]
        path.write_bytes(file.read_bytes()[:-100])
        with urllib.request.urlopen(f"{server.address}scene.glb") as answer, pytest.raises(http.client.IncompleteRead):
            answer.read()


def test_a_folder_is_served_file_by_file_and_a_page_holds_it_as_one_file(tmp_path):
    save(replace(numbered_clip((2, 3)), audio=Audio(opus(0.5))), tmp_path / "clip.glb")
    export(tmp_path / "clip.glb", tmp_path / "clip", "folder")
    for place in (tmp_path / "clip", tmp_path / "clip" / "scene.glb"):
        with view(place, browser=False) as server:
            for name in ("scene.glb", "groups/00000.eftg", "groups/00001.eftg", "sound.opus"):
                with urllib.request.urlopen(f"{server.address}{name}") as answer:
                    assert answer.read() == (tmp_path / "clip" / name).read_bytes()
            for name in ("groups/00002.eftg", "eigenfield.json"):
                with pytest.raises(urllib.error.HTTPError, match="404"):
                    urllib.request.urlopen(f"{server.address}{name}")
    export(tmp_path / "clip", tmp_path / "page.html")
    assert held_in(tmp_path / "page.html") == (tmp_path / "clip.glb").read_bytes()
    export(tmp_path / "clip", tmp_path / "app", "app")
    assert (tmp_path / "app" / "samples" / "clip.glb").read_bytes() == (tmp_path / "clip.glb").read_bytes()
    clip = load_clip(tmp_path / "clip")
    with view(clip, browser=False) as server, urllib.request.urlopen(f"{server.address}scene.glb") as answer:
        assert answer.read() == (tmp_path / "clip.glb").read_bytes()


def test_the_folder_of_a_clip_is_a_second_scene_and_no_photographs(file, tmp_path):
    export(file, tmp_path / "clip", "folder")
    with view(file, tmp_path / "clip", browser=False) as server:
        assert urllib.request.urlopen(f"{server.address}second.glb").read() == file.read_bytes()


def test_a_plain_file_is_compared_with_no_scene(file, tmp_path):
    export(file, tmp_path / "plain.glb", "glb", time=0.0)
    with pytest.raises(FormatError, match="EIGENFIELD_eigen_textures"):
        view(tmp_path / "plain.glb", file, browser=False)


def test_photographs_are_not_shown_beside_a_clip(file, tmp_path):
    with pytest.raises(OptionError) as error:
        view(file, tmp_path, browser=False)
    assert error.value.code == "clip-photographs"
    assert error.value.remedy == "leave the capture out"
