"""Known lenses: undone, and read from files."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from eigenfield.calibration import (
    KnownLens,
    read_known_lenses,
)
from eigenfield.calibration.lenses import distort_to_pixels, undistort_pixels
from eigenfield.capture import Lens, LightField, PhotoSet
from eigenfield.core.errors import CaptureError
from support.motion import HEIGHT, WIDTH, K, photographed


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> tuple[PhotoSet, LightField]:
    """Five photographs and the truth."""
    return photographed(tmp_path_factory.mktemp("scene") / "photos")


@pytest.mark.parametrize(
    "lens",
    [
        None,
        Lens("brown", (-0.3, 0.1, 0.002, -0.001, 0.01)),
        Lens("fisheye", (-0.02, 0.003, 0.0, 0.0)),
        Lens("rational", (0.1, -0.2, 0.001, 0.0, 0.05, 0.2, -0.1, 0.02)),
        Lens("metashape", (-0.2, 0.05, 0.0, 0.0, 0.001, -0.002, 0.1, 0.0, 0.003)),
        Lens("metashape-equidistant", (-0.02, 0.003, 0.0, 0.0, 0.001, 0.0, 0.0, 0.0, 0.0)),
    ],
)
def test_undistorting_is_the_inverse(lens):
    known = KnownLens(K, lens)
    points = np.random.default_rng(1).uniform([0, 0], [WIDTH, HEIGHT], (200, 2))
    flat = undistort_pixels(points, known)
    assert np.isfinite(flat).all()
    rays = (flat - K[:2, 2]) / [K[0, 0], K[1, 1]]
    np.testing.assert_allclose(distort_to_pixels(rays, known), points, atol=1e-6)


def test_pixels_beyond_the_lens_are_nowhere():
    known = KnownLens(K, Lens("brown", (-1.0, 0.0, 0.0, 0.0, 0.0)))  # the picture ends at a radius of 0.385
    flat = undistort_pixels(np.array([[165.0, 118.0], [165 + 0.3 * 300, 118.0], [165 + 0.5 * 300, 118.0]]), known)
    assert np.isfinite(flat[:2]).all() and np.isnan(flat[2]).all()


# known lenses from files


def test_lenses_are_read_from_a_matrix_and_from_a_calibration(scene, tmp_path):
    photos, _ = scene
    (tmp_path / "K.txt").write_text("\n".join(" ".join(map(str, row)) for row in K))
    assert all(np.array_equal(known.K, K) for known in read_known_lenses(tmp_path / "K.txt", photos))
    frames = [
        {
            "file_path": f"elsewhere/{name}", "fl_x": 600.0 + 2 * i, "fl_y": 600.0, "cx": 320.0, "cy": 240.0,
            "w": 2 * WIDTH, "h": 2 * HEIGHT, "k1": 0.01, "transform_matrix": np.eye(4).tolist(),
        }
        for i, name in enumerate(photos.names)
    ]  # fmt: skip
    (tmp_path / "transforms.json").write_text(json.dumps({"frames": frames}))
    known = read_known_lenses(tmp_path / "transforms.json", photos)
    assert [k.K[0, 0] for k in known] == [300.0 + i for i in range(5)]
    assert known[0].lens == Lens("brown", (0.01, 0.0, 0.0, 0.0, 0.0))
    with pytest.raises(CaptureError) as error:
        read_known_lenses(
            tmp_path / "transforms.json",
            replace(photos, shots=(replace(photos.shots[0], name="x.png", path=Path("x")),)),
        )
    assert error.value.code == "intrinsics-missing"


def test_lenses_of_another_picture_are_refused(scene, tmp_path):
    frame = {"file_path": "a.png", "fl_x": 600.0, "w": 640, "h": 640, "transform_matrix": np.eye(4).tolist()}
    (tmp_path / "transforms.json").write_text(json.dumps({"frames": [frame]}))
    with pytest.raises(CaptureError) as error:
        read_known_lenses(tmp_path / "transforms.json", scene[0])
    assert error.value.code == "image-size"
    with pytest.raises(CaptureError):
        read_known_lenses(tmp_path / "nothing.yml", scene[0])
