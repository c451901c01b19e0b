"""Cameras of footage: found once from several instants, and used for another take."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from eigenfield.calibration.motion.features import (
    NO_FEATURES,
    FeatureOptions,
    Features,
    extract_features_of,
    join_features,
)
from eigenfield.calibration.whole import calibrate
from eigenfield.capture import Footage, open_path
from support.motion import photographed


def features(*points: tuple[float, float]) -> Features:
    count = len(points)
    shades = np.arange(3 * count).reshape(-1, 3).astype(np.uint8)
    return Features(np.array(points, np.float64), np.full((count, 128), count, np.uint8), shades)


def test_what_stands_still_is_joined_once():
    first, second, third = features((10, 10), (20, 20)), features((11, 10), (50, 5)), features((50, 6), (90, 9), (9, 9))
    joined = join_features([first, second, third])
    assert joined.points.tolist() == [[10, 10], [20, 20], [50, 5], [90, 9]]
    assert joined.descriptors[:, 0].tolist() == [2, 2, 2, 3] and joined.colours.shape == (4, 3)
    assert join_features([NO_FEATURES, first]).points.tolist() == first.points.tolist()
    assert len(join_features([first, NO_FEATURES])) == 2


@pytest.fixture(scope="module")
def takes(tmp_path_factory) -> Path:
    """Two takes of one rig, of three instants and, the first, of two, which show one half of the scene each."""
    root = tmp_path_factory.mktemp("rig")
    photos, _ = photographed(root / "stills")
    for camera, shot in enumerate(photos.shots):
        pixels = np.asarray(Image.open(shot.path)).copy()
        for instant in range(3):
            shown, other = pixels.copy(), root / "second" / f"cam_{camera}" / f"{100 + instant}.png"
            shown[:, slice(0, 160) if instant == 0 else slice(160, 320)] = 128
            first = root / "first" / f"cam_{camera}" / f"{instant}.png"
            for picture, file in [(pixels, other)] + [(shown, first)] * (instant < 2):
                file.parent.mkdir(parents=True, exist_ok=True)
                Image.fromarray(picture).save(file)
    return root


@pytest.mark.slow
def test_cameras_are_found_once_and_used_for_another_take(takes, tmp_path):
    footage = open_path(takes / "first", clip=":")
    assert isinstance(footage, Footage)
    motion = calibrate(footage, tmp_path / "rig", progress=None)
    assert motion.light_field.names == tuple(f"cam_{camera}" for camera in range(5)) and len(motion.light_field) == 5
    alone = [len(extract_features_of(shot, FeatureOptions())) for shot in footage.photographs(0).shots]
    assert all(entry.features > 1.6 * one for entry, one in zip(motion.report, alone, strict=True))
    for calibration in (tmp_path / "rig" / "transforms.json", tmp_path / "rig" / "sparse" / "0"):
        other = open_path(takes / "second", clip=":", calibration=calibration)
        assert isinstance(other, Footage) and other.names == motion.light_field.names and len(other) == 3
        for found, known in zip(other.cameras, motion.light_field.cameras, strict=True):
            assert np.allclose(found.R, known.R) and np.allclose(found.t, known.t) and np.allclose(found.K, known.K)
        assert other.instant(2).views[4].path == takes / "second" / "cam_4" / "102.png"


@pytest.mark.slow
def test_the_verb(takes, tmp_path, run):
    code, out, err = run("calibrate", takes / "first", "--clip", "0:2", "-o", tmp_path / "rig")
    assert code == 0 and "5 of 5 photographs registered" in out and "--rate" in err, out + err
    assert (tmp_path / "rig" / "transforms.json").exists()
