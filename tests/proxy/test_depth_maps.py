"""What the maps of other views say of a point: true maps of a ball before a wall, seen from beside."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.surface.depth_maps import (
    DepthJob,
    WorkingPicture,
    _count_agreeing,
    _FirstMap,
    _projected_labels,
    _quantiles,
    _stack_pictures,
)
from eigenfield.stereo import ReferenceView
from eigenfield.stereo.views import inside_pictures
from support.surfaces import ball_before_wall, looking

TOLERANCE = 0.01
CAMERAS = [looking(np.array([x, 0.0, -5.0]), (0, 0, 0.5)) for x in (0.0, -0.6, 0.6, 1.2)]


@pytest.fixture(scope="module")
def maps():
    """The reference view, and (V, h, w) inverse depths of all cameras at half resolution."""
    mesh = ball_before_wall()
    half = [camera.resize(camera.width // 2, camera.height // 2) for camera in CAMERAS]
    reference = ReferenceView.with_margin(CAMERAS[0], 0, 0.05, 0.01)
    return reference.at_half_resolution(), np.stack([rasterise_view(mesh, c).inverse_depth for c in half])


def true_labels(maps):
    reference, depths = maps
    return ((depths[0] - reference.offset) / reference.scale).astype(np.float32)


def test_true_depth_is_confirmed_and_wrong_depth_is_not(maps):
    reference, depths = maps
    d = true_labels(maps)
    right = _count_agreeing(reference, d, CAMERAS[1:], depths[1:], TOLERANCE)
    wrong = _count_agreeing(reference, d * 1.1, CAMERAS[1:], depths[1:], TOLERANCE)
    assert (right[10:-10, 15:-15] >= 2).mean() > 0.9  # beside the ball some views see only the ball
    assert (wrong > 0).mean() < 0.05
    none = _count_agreeing(reference, d, CAMERAS[1:], np.zeros_like(depths[1:]), TOLERANCE)
    assert not none.any()


def test_points_of_another_map_fall_on_their_labels(maps):
    reference, depths = maps
    other = _FirstMap(np.zeros((*depths[1].shape, 3), np.float32), np.zeros_like(depths[1]), depths[1], TOLERANCE)
    labels = _projected_labels(reference, CAMERAS[1], other)
    known = np.isfinite(labels)
    off = np.abs(labels - true_labels(maps))[known]
    assert known.mean() > 0.6 and np.median(off) < 0.05 and (off < 0.5).mean() > 0.85
    doubtful = _FirstMap(other.planes, np.ones_like(other.cost), other.inverse_depth, TOLERANCE)
    assert not np.isfinite(_projected_labels(reference, CAMERAS[1], doubtful)).any()


def test_photographs_of_a_job_end_where_they_end():
    small = CAMERAS[1].resize(90, 70)
    pictures = [
        WorkingPicture(c, np.full((c.height, c.width, 3), 9, np.uint8), None, None) for c in (CAMERAS[0], small)
    ]
    inside = inside_pictures(_stack_pictures(DepthJob(0, (1,), (0.1, 0.3)), pictures).pictures)
    assert inside[0].all() and inside[1, :70, :90].all() and inside[1].sum() == 70 * 90


def test_quantiles_leave_out_what_is_not_known():
    labels = np.full((4, 1, 3), np.nan, np.float32)
    labels[[3, 1], 0, 0] = 5, 2
    labels[:, 0, 1] = 4, 3, 2, 1
    picked = _quantiles(labels)[:, 0]
    assert picked[:, 0].tolist() == [2, 5, 5] and picked[:, 1].tolist() == [1, 3, 4] and np.isnan(picked[:, 2]).all()
