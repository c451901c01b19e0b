"""A still capture as a clip in which nothing moves."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from eigenfield.capture import open_footage
from eigenfield.evaluation.flicker import StillPixels
from evidence.repeated import SIGMA_LEVELS, repeat
from support.redrawn import write_capture
from support.scenes import tiny_scene

FRAMES = 6


def test_each_frame_is_the_photograph_with_noise_of_its_own(tmp_path):
    scene = tiny_scene(cameras=4, size=32)
    capture = write_capture(scene, tmp_path / "still", lambda index, picture: np.clip(picture, 40, 215))
    folder = repeat(capture, tmp_path / "clip", FRAMES)
    pictures = np.stack([cv2.imread(str(folder / "view_02" / f"{n:06d}.png"))[..., ::-1] for n in range(FRAMES)])
    noise = pictures.astype(np.float32) - np.rint(capture.photograph(2).pixels * 255)
    assert noise.std() == pytest.approx(SIGMA_LEVELS, rel=0.05)
    assert abs(np.corrcoef(noise[0].ravel(), noise[1].ravel())[0, 1]) < 0.05
    found = StillPixels()
    for picture in pictures:
        found.add(np.ascontiguousarray(picture))
    assert found.still.mean() > 0.995
    footage = open_footage(folder)
    assert footage.names == tuple(scene.rig.names) and footage.timeline.frames == FRAMES
    np.testing.assert_allclose(footage.cameras[2].K, scene.rig.cameras[2].K)
    assert repeat(capture, folder, FRAMES) == folder
