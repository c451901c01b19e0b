"""Fixtures of the viewer's server: a capture, its scene, a stand-in build, and a server that runs."""

from __future__ import annotations

import pytest

from eigenfield.capture import match_photographs, open_capture
from eigenfield.gltf import outline, save
from eigenfield.viewer import Photographs, Server, make_manifest, page, request
from support.captures import write_capture
from support.http_client import Client, write_build


@pytest.fixture(scope="session")
def capture(tmp_path_factory):
    return write_capture(tmp_path_factory.mktemp("capture") / "capture")


@pytest.fixture(scope="session")
def scene(capture, tmp_path_factory):
    from eigenfield import encode

    path = tmp_path_factory.mktemp("scene") / "scene.glb"
    save(encode(open_capture(capture), capture / "proxy.ply", textures=3, atlas=64, hold_out="view_04.png"), path)
    return path


@pytest.fixture(scope="module", autouse=True)
def build(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(page, "STATIC_FOLDER", write_build(tmp_path_factory.mktemp("build") / "static"))
        yield


@pytest.fixture(scope="session")
def manifest(scene, capture):
    (loaded, data), opened = outline(scene), open_capture(capture)
    return make_manifest(data, "scene", Photographs(loaded, opened, match_photographs(loaded, opened)))


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
    monkeypatch.setattr(request, "REQUEST_SECONDS", 0.4)
    monkeypatch.setattr(request, "LINGER_SECONDS", 0.2)
