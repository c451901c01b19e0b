"""Drafts: what they are made from, what they look like, and what the command line does with them."""

from __future__ import annotations

import json

import numpy as np
import pytest

import eigenfield as ef
from eigenfield.capture import open_any, open_capture
from eigenfield.capture.holdout import held_out_cameras
from eigenfield.cli import draft as command
from eigenfield.cli.progress import StepProgress
from eigenfield.core.errors import ProxyError
from eigenfield.encoding import draft as drafts
from eigenfield.encoding.draft import make_draft
from eigenfield.gltf import load
from eigenfield.reconstruction import SurfaceOptions
from support.captures import write_array, write_capture
from support.http_client import Client
from support.program import call
from support.scenes import row_grid


@pytest.fixture(scope="module")
def row(tmp_path_factory):
    return write_capture(tmp_path_factory.mktemp("draft") / "nine", row_grid(9, 192, 168))


@pytest.fixture(scope="module")
def array(tmp_path_factory):
    folder = tmp_path_factory.mktemp("draft") / "array"
    write_array(folder)
    return folder


@pytest.fixture
def worth_it(monkeypatch):
    monkeypatch.setattr(drafts, "DRAFT_WORTH_SECONDS", 0.0)


def small(monkeypatch, **changes):
    for name, value in {"min_side": 16, **changes}.items():
        monkeypatch.setattr(drafts, f"DRAFT_{name.upper()}", value)


def encode(folder, *options):
    return call("encode", folder, "--proxy", folder / "proxy.ply", "--draft", *options)


def test_it_draws_the_photographs_from_smaller_ones(row, monkeypatch):
    small(monkeypatch, texture_pixels=9 * 192 * 168 // 4)
    capture = open_capture(row)
    scene = make_draft(capture, row / "proxy.ply", ef.EncodeOptions(), None)
    assert scene.settings["draft"] == 2 and not scene.scores
    assert [(camera.width, camera.height) for camera in scene.rig.cameras] == capture.sizes
    assert scene.settings["photographs"]["pixels"] == 9 * 192 * 168
    report = ef.evaluate(scene, capture, progress=None)["image"]["encoded"]
    assert report["cameras"] == 9 and report["psnr"] > 27


def test_held_out_photographs_are_left_out_and_views_are_spread(row, monkeypatch):
    small(monkeypatch, max_views=4)
    rights = ef.Rights(author="Ann", licence="CC BY 4.0")
    options = ef.EncodeOptions(hold_out="every:2", reference="view_03.png", rights=rights)
    scene = make_draft(open_capture(row), row / "proxy.ply", options, None)
    assert scene.rights == rights
    held = held_out_cameras("every:2", open_capture(row).names, np.zeros((9, 2)))
    shown = {name for name, out in zip(open_capture(row).names, held, strict=True) if not out}
    assert set(scene.rig.names) < shown and len(scene.rig.names) == 4


def test_a_grid_keeps_whole_rows_and_columns(array, monkeypatch):
    small(monkeypatch, max_views=4, surface_pixels=16 * 96 * 96 // 4)
    capture = open_any(array)
    scene = make_draft(capture, None, ef.EncodeOptions(), SurfaceOptions())
    place = [capture.names.index(name) for name in scene.rig.names]
    assert len(place) == 4
    assert len(set(capture.layout.rows[place])) == len(set(capture.layout.columns[place])) == 2
    assert {(camera.width, camera.height) for camera in scene.rig.cameras} == {(96, 96)}


def test_what_is_named_in_pixels_or_by_photographs_stays_with_the_scene(array, monkeypatch):
    """Regions of spheres are in pixels of the whole photographs, and held-out ones are gone already."""
    asked = []

    def note_and_stop(capture, surface, progress):
        asked.append(surface)
        raise ProxyError("surface-empty", "stopped", remedy="")

    monkeypatch.setattr(drafts, "reconstruct", note_and_stop)
    for named in ({"surface": "layers"}, {"fit_spheres": ("a.png:1,2,3,4",)}):
        given = SurfaceOptions(**named, hold_out="every:4", blind="every:4")
        with pytest.raises(ProxyError):
            make_draft(open_any(array), None, ef.EncodeOptions(hold_out="every:4"), given)
    assert asked == 2 * [SurfaceOptions(layers=1, triangles=drafts.DRAFT_TRIANGLES)]


@pytest.mark.slow
def test_the_command_writes_a_draft_and_says_what_it_is(row, tmp_path, worth_it, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert encode(row) == 0
    said = capsys.readouterr().out.splitlines()
    assert len(said) == 3 and said[0].startswith("nine.draft.glb: ") and "a draft from 9 photographs" in said[0]
    assert said[2] == "look around in the draft: eigenfield view nine.draft.glb"
    assert load(tmp_path / "nine.draft.glb").settings["draft"] == 1
    assert call("info", "nine.draft.glb", "--json") == 0
    assert json.loads(capsys.readouterr().out)["settings"]["draft"] == 1
    assert encode(row) == 2  # it exists
    assert [path.name for path in tmp_path.iterdir()] == ["nine.draft.glb"]


def test_where_it_saves_nothing_the_scene_is_made(row, tmp_path, capsys):
    output = tmp_path / "scene.glb"
    assert (
        call("encode", str(row), "--proxy", str(row / "proxy.ply"), "--fit", "none", "--draft", "-o", str(output)) == 0
    )
    said = capsys.readouterr()
    assert "a draft saves nothing here: the scene itself takes about" in said.err
    assert "dB in captured views" in said.out and "draft" not in load(output).settings


def test_where_it_cannot_be_made_the_reason_is_said_and_the_scene_is_made(row, tmp_path, worth_it, monkeypatch, capsys):
    def fail(*_):
        raise ProxyError("surface-empty", "no surface was found", remedy="take more photographs")

    monkeypatch.setattr(drafts, "make_draft", fail)
    output = tmp_path / "scene.glb"
    assert (
        call("encode", str(row), "--proxy", str(row / "proxy.ply"), "--fit", "none", "--draft", "-o", str(output)) == 0
    )
    assert "no draft: no surface was found; going on with the whole scene" in capsys.readouterr().err
    assert "draft" not in load(output).settings


def test_a_draft_that_is_stopped_leaves_nothing(row, tmp_path, worth_it, monkeypatch):
    def stop(*_):
        raise KeyboardInterrupt

    monkeypatch.setattr(drafts, "make_draft", stop)
    with pytest.raises(KeyboardInterrupt):
        command.draft_of(open_capture(row), row / "proxy.ply", ef.EncodeOptions(), None, None, True)
    assert list(tmp_path.iterdir()) == []


class Told(StepProgress):
    def show_step(self, heading):
        pass


@pytest.mark.slow
def test_the_scene_takes_the_draft_s_place_at_the_same_address(row, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command.webbrowser, "open", lambda address: True)
    progress = Told()
    progress.plan({"fit": 90.0}, {})
    progress.begin("fit")
    draft = make_draft(open_capture(row), row / "proxy.ply", ef.EncodeOptions(), None)
    output = tmp_path / "scene.glb"
    ef.save(ef.encode(open_capture(row), row / "proxy.ply", fit="none", textures=2), output)
    with command.Window("scene.glb", quiet=True) as window:
        window.show_draft(draft, progress)
        port = int(capsys.readouterr().out.strip().rstrip("/").rsplit(":", 1)[1])
        with Client(port) as client:
            first = client.request("/scene.glb")
            assert 60 < json.loads(client.request("/draft").body)["seconds"] <= 90
            assert b'"draft":"draft"' in client.request("/").body
            window.show(output)
            assert client.request("/draft").status == 404 and b'"draft"' not in client.request("/").body
            second = client.request("/scene.glb")
            assert second.status == 200 and second.body != first.body and second.body[:4] == b"glTF"
    assert capsys.readouterr().out == ""
