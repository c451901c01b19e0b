"""Similarities between two sets of cameras."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.calibration import (
    align_similarity,
    calibration_error,
)
from eigenfield.calibration.align import natural_gauge
from eigenfield.capture import LightField, PhotoSet
from eigenfield.core.errors import CaptureError
from support.motion import photographed


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> tuple[PhotoSet, LightField]:
    """Five photographs and the truth."""
    return photographed(tmp_path_factory.mktemp("scene") / "photos")


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1), st.floats(1e-3, 1e3), st.integers(3, 12))
def test_similarities_are_recovered(seed, scale, count):
    random = np.random.default_rng(seed)
    q, _ = np.linalg.qr(random.normal(size=(3, 3)))
    R = q * np.sign(np.linalg.det(q))
    t = random.normal(size=3) * 10
    points = random.normal(size=(count, 3))
    found, turn, shift = align_similarity(points, scale * points @ R.T + t)
    assert found == pytest.approx(scale, rel=1e-6)
    np.testing.assert_allclose(turn, R, atol=1e-5)
    np.testing.assert_allclose(shift, t, atol=1e-5 * max(1, scale))


def test_a_mirrored_set_gives_a_rotation_all_the_same():
    points = np.random.default_rng(0).normal(size=(8, 3))
    _, R, _ = align_similarity(points, points * [1, 1, -1])
    assert np.linalg.det(R) == pytest.approx(1)


def test_what_cannot_be_aligned_is_refused():
    for points in (np.zeros((5, 3)), np.eye(3)[:2]):
        with pytest.raises(CaptureError) as error:
            align_similarity(points, points)
        assert error.value.code == "align"


def test_the_error_of_a_moved_copy_is_none_and_of_a_turned_camera_its_angle(scene):
    _, truth = scene
    scale, R, t = natural_gauge(truth.cameras)
    from eigenfield.calibration.align import transform_camera

    views = [replace(v, camera=transform_camera(v.camera, scale, R, t)) for v in truth.views]
    error = calibration_error(replace(truth, views=tuple(views)), truth)
    assert error.rotation.max() < 1e-6 and error.position.max() < 1e-9
    turn, _ = cv2.Rodrigues(np.radians([0.0, 2.0, 0.0]))
    camera = views[2].camera
    views[2] = replace(views[2], camera=replace(camera, R=turn @ camera.R, t=turn @ camera.t))
    error = calibration_error(replace(truth, views=tuple(views)), truth)
    assert error.rotation[2] == pytest.approx(2, abs=1e-6) and np.delete(error.rotation, 2).max() < 1e-6
