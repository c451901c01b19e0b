"""From depth maps of known scenes to points: fusion, thinning, neighbours, what depth is made from."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eigenfield.capture.photographs.lens import Lens, source_positions
from eigenfield.core.errors import ProxyError
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.surface import multiview
from eigenfield.proxy.surface.fusion import DepthView, fuse_depth_maps, subsample_points
from eigenfield.proxy.surface.multiview import surface_from_views
from eigenfield.proxy.surface.neighbours import choose_neighbours, frustum_points, spread_views
from eigenfield.runtime import parallel
from support.surfaces import Drawn, ball, ball_before_wall, depth_views, looking, nine_cameras, truth


@pytest.fixture(scope="module")
def scene():
    return ball_before_wall()


@pytest.fixture(scope="module")
def cameras():
    return nine_cameras()


@pytest.fixture(scope="module")
def points(scene, cameras):
    return fuse_depth_maps(depth_views(scene, cameras))


def test_fused_points_lie_on_the_surfaces_and_face_outwards(points):
    off = truth(points.positions)
    assert np.median(off) < 1e-4 and np.percentile(off, 99) < 0.01
    on_wall = np.abs(points.positions[:, 2] - 1.2) < 0.01
    assert 0.5 < on_wall.mean() < 0.95
    assert (points.normals[on_wall] @ [0, 0, -1] > 0.999).mean() > 0.98  # the rest lies at the ball's rim
    on_ball = np.abs(np.linalg.norm(points.positions, axis=1) - 1) < 0.01
    assert ((points.normals * points.positions)[on_ball].sum(axis=1) > 0.97).mean() > 0.98


def test_one_point_stands_for_a_surface_element(points):
    from scipy.spatial import KDTree

    nearest = KDTree(points.positions).query(points.positions, k=2)[0][:, 1]
    ratio = nearest / points.spacing
    assert 0.6 < np.median(ratio) < 1.2  # nine views see most of it: their own points would be a third as far apart
    assert np.percentile(ratio, 1) > 0.4


def test_fusion_does_not_depend_on_threads(scene, cameras, points):
    try:
        parallel.set_threads(1)
        one = fuse_depth_maps(depth_views(scene, cameras))
        parallel.set_threads(3)
        three = fuse_depth_maps(depth_views(scene, cameras))
    finally:
        parallel.set_threads(None)
    for name in ("positions", "normals", "spacing"):
        assert np.array_equal(getattr(one, name), getattr(three, name))
        assert np.array_equal(getattr(one, name), getattr(points, name))


def test_wrong_depths_in_one_view_leave_no_trace(scene, cameras):
    views = depth_views(scene, cameras)
    wrong = views[4].inverse_depth.copy()
    wrong[30:60, 40:80] *= 1.5  # a piece that floats before everything
    wrong[0, :5] = [np.nan, np.inf, -1, 0, 1e30]
    views[4] = DepthView(views[4].camera, wrong)
    fused = fuse_depth_maps(views)
    assert np.percentile(truth(fused.positions), 99.5) < 0.02


def test_masks_keep_the_foreground_only(scene, cameras):
    masks = [rasterise_view(ball(), camera).face >= 0 for camera in cameras]
    views = [
        DepthView(c, rasterise_view(scene, c).inverse_depth, mask=mask) for c, mask in zip(cameras, masks, strict=True)
    ]
    fused = fuse_depth_maps(views)
    assert np.abs(np.linalg.norm(fused.positions, axis=1) - 1).max() < 0.05


def test_one_mask_that_was_not_drawn_does_not_bring_the_background_back(scene, cameras):
    masks = [rasterise_view(ball(), camera).face >= 0 for camera in cameras]
    masks[3] = np.ones_like(masks[3])
    views = [
        DepthView(c, rasterise_view(scene, c).inverse_depth, mask=mask) for c, mask in zip(cameras, masks, strict=True)
    ]
    assert np.abs(np.linalg.norm(fuse_depth_maps(views).positions, axis=1) - 1).max() < 0.05


def test_masks_that_hide_everything(scene, cameras):
    nothing = np.zeros((120, 160), np.bool_)
    with pytest.raises(ProxyError, match="masks hide") as caught:
        fuse_depth_maps(depth_views(scene, cameras, mask=nothing))
    assert caught.value.code == "surface-masked" and caught.value.remedy


def test_no_agreement_is_said(cameras):
    random = np.random.default_rng(0)
    views = [DepthView(c, random.uniform(0.1, 1, (120, 160)).astype(np.float32)) for c in cameras]
    with pytest.raises(ProxyError) as caught:
        fuse_depth_maps(views)
    assert caught.value.code == "surface-no-points" and "9 views" in str(caught.value)
    with pytest.raises(ProxyError) as caught:
        fuse_depth_maps([])
    assert caught.value.code == "surface-no-points"
    with pytest.raises(ProxyError):
        fuse_depth_maps([DepthView(c, np.zeros((120, 160), np.float32)) for c in cameras])


def test_thinning_keeps_the_surface_and_the_limit(points):
    few = subsample_points(points, 2000)
    assert 800 < len(few) <= 2000
    assert np.median(truth(few.positions)) < 0.005
    assert np.median(few.spacing) > 2 * np.median(points.spacing)
    assert np.allclose(np.linalg.norm(few.normals, axis=1), 1, atol=1e-5)
    assert subsample_points(points, len(points)) is points


def test_neighbours_stand_aside_but_not_too_far():
    arc = [looking(np.array([5 * np.sin(a), 0, -5 * np.cos(a)]), (0, 0, 0)) for a in np.radians(np.arange(0, 360, 5))]
    chosen = choose_neighbours(0, arc, frustum_points(arc[0], 1 / 5.5, 1 / 4.5), 4)
    steps = [i if i < 36 else i - len(arc) for i in chosen]
    assert (
        len(steps) == 4 and max(map(abs, steps)) <= 4 and min(steps) < 0 < max(steps)
    )  # at most 20 degrees, both sides


def test_a_view_from_the_same_place_is_no_neighbour(cameras):
    twice = [*cameras, cameras[4]]
    chosen = choose_neighbours(4, twice, frustum_points(cameras[4], 0.15, 0.25), 8)
    assert len(twice) - 1 not in chosen and len(chosen) >= 3


def test_spread_views_are_spread(cameras):
    assert spread_views(cameras, 20) == list(range(9))
    chosen = spread_views(cameras, 5)
    assert set(chosen) == {0, 2, 4, 6, 8}


def test_photographs_that_are_all_masked(scene, cameras):
    masks = [np.zeros((120, 160), np.bool_)] * len(cameras)
    with pytest.raises(ProxyError) as caught:
        surface_from_views(Drawn(scene, cameras, masks))
    assert caught.value.code == "surface-masked"


def test_photographs_that_share_nothing(scene):
    apart = [looking(np.array([100.0 * i, 0, -5]), (100.0 * i + 500 * i, 0, 0)) for i in range(4)]
    points = np.random.default_rng(0).normal(size=(100, 3))
    with pytest.raises(ProxyError) as caught:
        surface_from_views(Drawn(scene, apart), points)
    assert caught.value.code == "surface-overlap" and "4 photographs" in str(caught.value)


def test_the_border_that_lens_removal_leaves_is_no_mask(scene, cameras):
    lens = Lens("brown", (0.3, 0.0, 0.0, 0.0, 0.0))
    K = cameras[0].K
    inside = source_positions(K, lens, 160, 120)[2]
    assert 0.5 < inside.mean() < 0.99
    drawn = rasterise_view(ball(), cameras[0]).face >= 0
    for mask, real in ((inside, False), (inside & drawn, True)):
        light_field = Drawn(scene, cameras, [mask] * 9)
        object.__setattr__(light_field, "views", tuple(replace(view, lens=lens) for view in light_field.views))
        picture = multiview._pictures(light_field, [0], 100_000, None)[0]
        assert (picture.mask is not None) == real
        assert picture.known is not None and np.array_equal(picture.known, inside)


def test_resizing_keeps_what_a_camera_sees():
    camera = looking(np.array([0, 0, -5.0]), (0, 0, 0), width=160, height=121)
    small = camera.resize(53, 40)
    x, y = np.meshgrid(np.arange(160) + 0.5, np.arange(121) + 0.5)
    picture = np.stack([x, y, np.zeros_like(x)], axis=-1).astype(np.float32)
    result = multiview._resample(picture, camera, small)
    back = np.linalg.inv(small.K) @ np.array([20.5, 10.5, 1])  # the middle of pixel (10, 20)
    place = camera.K @ back
    assert np.allclose(result[10, 20, :2], place[:2] / place[2], atol=0.05)
