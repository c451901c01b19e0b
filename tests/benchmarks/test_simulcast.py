"""The peers of a clip: streams of its cameras, measured as the clip is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evidence import simulcast
from support.moving_clips import tiny_clip, write_footage

CRF, PRESET = 24, 12


def brighter(frame, mean):
    return mean + np.float32(0.03 * frame)


@pytest.fixture(scope="module")
def taken(tmp_path_factory):
    """Four cameras of 96x80, large enough for the encoder; one is held out."""
    clip = tiny_clip((3, 3), brighter, cameras=4, size=64, held_out=(1,))
    cameras = tuple(camera.resize(96, 80) for camera in clip.rig.cameras)
    clip = replace(clip, rig=replace(clip.rig, cameras=cameras))
    footage = write_footage(clip, tmp_path_factory.mktemp("clip") / "f")
    return simulcast.take(footage, clip)


def test_photographs_are_taken_by_camera_and_frame(taken):
    assert taken.encoded == ["view_00", "view_02", "view_03"] and taken.held_out == ["view_01"]
    assert {len(pictures) for pictures in taken.pictures.values()} == {6}
    covered = taken.covered["view_01"]
    levels = [picture[covered].mean() for picture in taken.pictures["view_01"]]
    assert np.all(np.diff(levels) > 3)


@pytest.mark.parametrize("way", simulcast.WAYS)
def test_each_way_decodes_to_each_camera(taken, way):
    coded = list(simulcast.streams(taken, way, CRF, PRESET))
    assert sorted(name for name, _, _ in coded) == taken.encoded
    for name, _, pictures in coded:
        assert len(pictures) == 6
        for picture, photograph in zip(pictures, taken.pictures[name], strict=True):
            assert np.abs(picture.astype(int) - photograph).mean() < 6, name


def test_more_keys_take_more_bytes(taken):
    sizes = {way: sum(size for _, size, _ in simulcast.streams(taken, way, CRF, PRESET)) for way in simulcast.WAYS}
    assert sizes["one-key"] < sizes["keys"]
    assert min(sizes.values()) > 0


def test_a_point_has_the_figures_of_a_clip(taken):
    found = simulcast.point(taken, simulcast.streams(taken, "keys", CRF, PRESET), [0, 4])
    assert found["worst"] <= found["fifth"] <= found["psnr_luma"] + 1
    assert found["psnr_luma"] > 30
    assert 15 < found["held_out"]["psnr_luma"] < found["psnr_luma"]
    assert found["border"]["frame"] == 3
    exact = [(name, 0, taken.pictures[name]) for name in taken.encoded]
    assert simulcast.point(taken, exact, [])["psnr"] == 100
    assert simulcast.point(taken, exact, [])["held_out"] is None
