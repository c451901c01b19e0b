"""Photographs without their calibration are turned by EXIF as those were from which the scene was encoded."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from eigenfield import encode, load
from eigenfield.capture import open_any, open_capture, with_scene_cameras
from eigenfield.core.errors import CaptureError
from eigenfield.gltf import save
from support.captures import write_capture


def mark(images: Path, orientation: int) -> None:
    """Every photograph but one says that it was taken by a turned camera."""
    exif = Image.Exif()
    exif[0x0112] = orientation
    for path in sorted(images.iterdir())[1:]:
        with Image.open(path) as picture:
            picture.save(path, exif=exif)


def photographs_of(light_field):
    return [light_field.photograph(index).pixels for index in range(len(light_field))]


@pytest.mark.parametrize("orientation", [1, 2, 3, 4, 6])
def test_bare_photographs_follow_the_scene(tmp_path, run, orientation):
    folder = write_capture(tmp_path / "c")
    mark(folder / "images", orientation)
    capture = open_capture(folder)
    save(encode(capture, folder / "proxy.ply", atlas=32, textures=2, fit="none"), tmp_path / "a.glb")
    scene = load(tmp_path / "a.glb")
    told = list(range(1, len(capture)))
    assert scene.settings.get("asStored") == {2: told, 3: told, 4: told}.get(orientation)
    bare = shutil.copytree(folder / "images", tmp_path / "bare")
    shown = with_scene_cameras(scene, open_any(bare))
    assert [view.name for view in shown.views] == [view.name for view in capture.views]
    for ours, theirs in zip(photographs_of(shown), photographs_of(capture), strict=True):
        assert np.array_equal(ours, theirs)
    if orientation == 3:
        both = [run("evaluate", tmp_path / "a.glb", where, "--json")[1] for where in (folder, bare)]
        assert all(both) and both[0].partition('"seconds"')[0] == both[1].partition('"seconds"')[0]


def test_photographs_that_were_turned_when_they_were_encoded_are_turned(tmp_path):
    """Bare photographs are turned as their EXIF says, and their scene records nothing."""
    folder = write_capture(tmp_path / "c")
    mark(folder / "images", 3)
    capture = open_capture(folder)
    turned = replace(capture, views=tuple(replace(view, upright=True) for view in capture.views))
    save(encode(turned, folder / "proxy.ply", atlas=32, textures=2, fit="none"), tmp_path / "a.glb")
    scene = load(tmp_path / "a.glb")
    assert "asStored" not in scene.settings
    bare = shutil.copytree(folder / "images", tmp_path / "bare")
    shown = with_scene_cameras(scene, open_any(bare))
    for ours, theirs in zip(photographs_of(shown), photographs_of(turned), strict=True):
        assert np.array_equal(ours, theirs)


@pytest.mark.parametrize("record", [3, "all", [None, "1", 99, -1], {"1": 2}])
def test_a_record_that_makes_no_sense_is_ignored(tmp_path, record):
    folder = write_capture(tmp_path / "c")
    scene = encode(open_capture(folder), folder / "proxy.ply", atlas=32, textures=2, fit="none")
    scene = replace(scene, settings={**scene.settings, "asStored": record})
    shown = with_scene_cameras(scene, open_any(shutil.copytree(folder / "images", tmp_path / "bare")))
    assert all(view.upright for view in shown.views)


def test_photographs_of_another_size_are_named_as_before(tmp_path):
    folder = write_capture(tmp_path / "c")
    scene = encode(open_capture(folder), folder / "proxy.ply", atlas=32, textures=2, fit="none")
    bare = shutil.copytree(folder / "images", tmp_path / "bare")
    for path in bare.iterdir():
        with Image.open(path) as picture:
            picture.transpose(Image.Transpose.ROTATE_90).save(path)
    shown = with_scene_cameras(scene, open_any(bare))
    with pytest.raises(CaptureError) as caught:
        shown.photograph(0)
    assert caught.value.code == "image-size"
