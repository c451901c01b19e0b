"""Lenses: where they fold back, and what is left of a picture without its lens."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from eigenfield.capture.photographs.lens import Lens, remove_lens, resample, source_positions


@pytest.mark.parametrize(
    ("lens", "expected"),
    [
        (Lens("brown", (-0.3, 0, 0, 0, 0)), np.sqrt(1 / 0.9)),
        (Lens("rational", (-0.3, 0, 0, 0, 0, 0, 0, 0)), np.sqrt(1 / 0.9)),
        (Lens("rational", (0, 0, 0, 0, 0, 1.0, 0, 0)), 1.0),  # s / (1 + s^2) grows up to 1
        (Lens("metashape", (-0.3, 0, 0, 0, 0, 0, 0, 0, 0)), np.sqrt(1 / 0.9)),
        (Lens("metashape", (0, 0, 0, -1 / 9, 0, 0, 0, 0, 0)), 1.0),
        (Lens("metashape-equidistant", (-0.3, 0, 0, 0, 0, 0, 0, 0, 0)), np.tan(np.sqrt(1 / 0.9))),
        (Lens("metashape-equisolid", (-0.5, 0, 0, 0, 0, 0, 0, 0, 0)), np.tan(2 * np.arcsin(np.sqrt(2 / 3) / 2))),
        (Lens("metashape", (0.1, 0, 0, 0, 0, 0, 0, 0, 0.01)), np.inf),
    ],
)  # fmt: skip
def test_where_a_lens_folds_back(lens, expected):
    assert lens.valid_radius() == pytest.approx(expected)


def test_a_skew_alone_is_a_lens():
    assert not Lens("metashape", (*(0.0,) * 8, 0.01)).is_identity
    assert Lens("metashape", (0.0,) * 9).is_identity
    assert not Lens("metashape-equisolid", (0.0,) * 9).is_identity


BROWN = Lens("brown", (-0.12, 0.03, 0.004, -0.003, 0.01))
FISHEYE = Lens("fisheye", (0.05, -0.02, 0.004, 0.001))
K = np.array([[150.0, 0, 83.25], [0, 140.0, 57.75], [0, 0, 1]])


@pytest.mark.parametrize("lens", [BROWN, FISHEYE])
def test_lens_positions_agree_with_projection(lens):
    """A point seen at a pinhole pixel lies, through the lens, where source_positions says: OpenCV's own projection
    with K as it stands gives positions from the picture's corner, source_positions counts from pixel centres."""
    x, y, inside = source_positions(K, lens, 160, 120)
    for row, column in ((0, 0), (60, 80), (119, 3), (31, 159)):
        ray = np.linalg.solve(K, [column + 0.5, row + 0.5, 1.0])[None, None]
        project = cv2.projectPoints if lens.model == "brown" else cv2.fisheye.projectPoints
        seen = project(ray, np.zeros(3), np.zeros(3), K, np.array(lens.coefficients))[0].ravel()
        assert np.allclose([x[row, column] + 0.5, y[row, column] + 0.5], seen, atol=1e-3)
        assert inside[row, column] == (0 <= seen[0] <= 160 and 0 <= seen[1] <= 120)


@pytest.mark.parametrize("lens", [BROWN, FISHEYE])
def test_lens_removal_gives_the_pinhole_picture(lens):
    """A smooth pattern on the rays, photographed through the lens, comes back as the pinhole shows it."""

    def pattern(nx, ny):
        return np.stack([0.5 + 0.3 * np.sin(7 * nx + 3 * ny), 0.5 + 0.3 * np.cos(6 * ny), 0.5 + 0.2 * nx], axis=-1)

    v, u = np.mgrid[0:120, 0:160] + 0.5
    undistort = cv2.undistortPoints if lens.model == "brown" else cv2.fisheye.undistortPoints
    criteria = (cv2.TERM_CRITERIA_COUNT | cv2.TERM_CRITERIA_EPS, 100, 1e-12)
    points = np.stack([u, v], axis=-1).reshape(-1, 1, 2)
    rays = undistort(points, K, np.array(lens.coefficients), criteria=criteria).reshape(120, 160, 2)
    photograph = pattern(rays[..., 0], rays[..., 1]).astype(np.float32)
    expected = pattern((u - K[0, 2]) / K[0, 0], (v - K[1, 2]) / K[1, 1])
    pixels, mask = remove_lens(photograph, None, K, lens)
    rim = cv2.erode(mask, np.ones((7, 7)))
    assert rim.mean() > 0.7
    assert np.abs(pixels - expected)[rim > 0].max() < 1e-3
    marked = photograph.copy()
    marked[:, :60] = 1e3  # what does not count may hold anything
    counts = (np.arange(160) >= 60).astype(np.float32)[None].repeat(120, 0)
    pixels, mask = remove_lens(marked, counts, K, lens)
    whole = (mask > 0.99) & (rim > 0)
    assert whole.mean() > 0.3 and np.abs(pixels - expected)[whole].max() < 2e-2


def test_cubic_sampling_keeps_planes_and_values():
    y, x = np.mgrid[0:20, 0:30].astype(np.float32)
    plane = np.stack([x, 2 * y + x], axis=-1)
    px, py = (x + 0.37)[2:-3, 2:-3], (y + 0.81)[2:-3, 2:-3]
    out = resample(plane, np.ascontiguousarray(px), np.ascontiguousarray(py))
    assert np.abs(out - np.stack([px, 2 * py + px], axis=-1)).max() < 1e-4
    random = np.random.default_rng(1).random((20, 30, 3), dtype=np.float32)
    assert np.array_equal(resample(random, x, y), random)


def test_nothing_is_shown_where_the_lens_polynomial_folds_back():
    wide = np.array([[60.0, 0, 80], [0, 60, 60], [0, 0, 1]])
    lens = Lens("brown", (-0.3, 0, 0, 0, 0))
    assert np.isclose(lens.valid_radius(), np.sqrt(1 / 0.9))
    _, mask = remove_lens(np.ones((120, 160, 3), np.float32), None, wide, lens)
    v, u = np.mgrid[0:120, 0:160] + 0.5
    assert mask[np.hypot((u - 80) / 60, (v - 60) / 60) > lens.valid_radius()].max() == 0
    assert mask[60, 80] == 1
    assert Lens("brown", (0.1, 0.02, 0, 0, 0)).valid_radius() == np.inf
