"""Points triangulated from photographs whose cameras are known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PIL import Image

from eigenfield.calibration import triangulate_points
from eigenfield.calibration.motion.features import Features
from eigenfield.calibration.motion.triangulate import _pairs, _triangulate_tracks, fundamental_matrix
from eigenfield.capture.lightfield import LightField, View
from eigenfield.core.errors import CaptureError
from eigenfield.imaging.raster import rasterise_view
from support.planes import look_up, paint
from support.surfaces import ball_before_wall, looking, truth


def five_cameras():
    places = [(-1, 0), (0, 0), (1, 0), (-0.5, 0.8), (0.6, -0.7)]
    return [looking(np.array([x, y, -5.0]), (0, 0, 0.5), focal=280.0, width=320, height=240) for x, y in places]


def seen(points, camera):
    pixels, _ = camera.project(points)
    count = len(points)
    return Features(pixels, np.zeros((count, 128), np.uint8), np.zeros((count, 3), np.uint8))


def saved(folder, pictures, cameras):
    views = []
    for index, (picture, camera) in enumerate(zip(pictures, cameras, strict=True)):
        path = folder / f"{index}.png"
        Image.fromarray(picture).save(path)
        views.append(View(path.name, path, camera))
    return LightField(folder, tuple(views), (), "drawn")


@pytest.fixture(scope="module")
def painted(tmp_path_factory):
    """A ball before a wall, both painted with noise: colours look down the z axis onto them."""
    scene, cameras, texture = ball_before_wall(), five_cameras(), paint(3, 512, 2.0)
    pictures = []
    for camera in cameras:
        raster = rasterise_view(scene, camera)
        x, y = np.meshgrid(np.arange(camera.width) + 0.5, np.arange(camera.height) + 0.5)
        rays = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(camera.K).T
        world = (rays / np.maximum(raster.inverse_depth, 1e-9)[..., None] - camera.t) @ camera.R
        pictures.append(np.rint(look_up(texture, world[..., 0] * 40, world[..., 1] * 40)).astype(np.uint8))
    return saved(tmp_path_factory.mktemp("painted"), pictures, cameras)


def test_the_fundamental_matrix_joins_pixels_of_one_point():
    points = np.random.default_rng(0).normal(size=(40, 3))
    first, second = five_cameras()[0], five_cameras()[3]
    F = fundamental_matrix(first, second)
    x1, x2 = (np.column_stack([camera.project(points)[0], np.ones(40)]) for camera in (first, second))
    line = x1 @ F.T
    assert np.abs((line * x2).sum(axis=1) / np.linalg.norm(line[:, :2], axis=1)).max() < 1e-9
    astray = x2 + np.array([0, 5, 0])
    assert np.abs((line * astray).sum(axis=1) / np.linalg.norm(line[:, :2], axis=1)).min() > 1


def test_photographs_give_points_on_the_surfaces(painted):
    points = triangulate_points(painted)
    off = truth(points)
    assert len(points) > 100
    assert np.median(off) < 0.01 and np.percentile(off, 95) < 0.05
    assert (np.linalg.norm(points, axis=1) < 1.05).sum() > 10  # some of the ball


def test_bare_photographs_give_none(tmp_path):
    cameras = five_cameras()[:3]
    grey = [np.full((240, 320, 3), 128, np.uint8)] * 3
    assert triangulate_points(saved(tmp_path, grey, cameras)).shape == (0, 3)


def test_an_unreadable_photograph_is_named(painted, tmp_path):
    broken = tmp_path / "broken.png"
    broken.write_bytes(b"no picture")
    views = (replace(painted.views[0], path=broken), *painted.views[1:])
    with pytest.raises(CaptureError, match=r"broken\.png"):
        triangulate_points(replace(painted, views=views))


def test_wrong_matches_are_no_points():
    cameras = five_cameras()
    true = np.random.default_rng(1).uniform(-0.5, 0.5, (30, 3))
    features = [seen(true, camera) for camera in cameras]
    features[2].points[:10] += [0, 8]  # ten tracks have one view that does not fit
    same = np.repeat(np.arange(30)[:, None], 2, axis=1)
    matches = [(0, 1, same), (1, 2, same), (3, 4, same)]  # 3 and 4 are two views alone
    points = _triangulate_tracks(features, cameras, matches)
    assert len(points) == 20
    assert np.abs(points - true[10:]).max() < 1e-9


def test_a_track_with_two_features_of_one_view_is_dropped():
    cameras = five_cameras()
    true = np.random.default_rng(1).uniform(-0.5, 0.5, (4, 3))
    features = [seen(true, camera) for camera in cameras]
    same = np.repeat(np.arange(4)[:, None], 2, axis=1)
    mixed = same.copy()
    mixed[0, 1] = 1  # view 2's second feature now also belongs to the first point
    assert len(_triangulate_tracks(features, cameras, [(0, 1, same), (1, 2, same), (0, 2, mixed)])) == 2


def test_rays_that_hardly_cross_give_no_point():
    near = [looking(np.array([0.001 * x, 0, -5.0]), (0, 0, 0)) for x in range(3)]
    true = np.random.default_rng(1).uniform(-0.5, 0.5, (5, 3))
    same = np.repeat(np.arange(5)[:, None], 2, axis=1)
    features = [seen(true, camera) for camera in near]
    assert len(_triangulate_tracks(features, near, [(0, 1, same), (1, 2, same)])) == 0


def test_views_at_one_place_and_back_to_back_are_no_pair():
    cameras = [*five_cameras(), five_cameras()[0], looking(np.array([0, 0, 5.0]), (0, 0, 0))]
    pairs = _pairs(cameras)
    assert (0, 5) not in pairs and (0, 1) in pairs
    assert all(6 not in pair for pair in pairs)
