"""The demo's scene as a clip: cameras and geometry stand still, the light moves."""

from __future__ import annotations

import json

import cv2
import numpy as np
import pytest

from eigenfield.evaluation.flicker import StillPixels
from evidence.moving_light import draw_clip

FRAMES = 4


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return draw_clip(tmp_path_factory.mktemp("drawn") / "clip", rows=1, columns=3, size=32, frames=FRAMES)


def pictures(folder, name="cam_0_1"):
    return [cv2.imread(str(path)) for path in sorted((folder / name).glob("*.png"))]


def test_each_frame_has_a_time_and_its_camera_stands_still(folder):
    document = json.loads((folder / "transforms.json").read_text())
    frames = document["frames"]
    assert len(frames) == 3 * FRAMES
    assert {round(frame["time"] * 30, 6) for frame in frames} == set(range(FRAMES))
    for frame in frames:
        assert (folder / frame["file_path"]).is_file()
        assert int(frame["file_path"][-10:-4]) == round(frame["time"] * 30)
    poses = {(frame["file_path"].split("/")[0], str(frame["transform_matrix"])) for frame in frames}
    assert len(poses) == 3


def test_some_of_it_moves_and_some_stands_still(folder):
    found = StillPixels()
    for picture in pictures(folder):
        found.add(picture)
    assert 0.05 < found.still.mean() < 0.9
    first, second, *_ = pictures(folder)
    assert np.abs(first.astype(int) - second).max() > 20


def test_what_is_drawn_is_kept(folder):
    document = (folder / "transforms.json").read_bytes()
    (folder / "transforms.json").unlink()
    kept = folder / "cam_0_0" / "000001.png"
    kept.write_bytes(b"kept")
    gone = folder / "cam_0_2" / "000003.png"
    before = gone.read_bytes()
    gone.unlink()
    draw_clip(folder, rows=1, columns=3, size=32, frames=FRAMES)
    assert kept.read_bytes() == b"kept"
    assert gone.read_bytes() == before
    assert (folder / "transforms.json").read_bytes() == document
