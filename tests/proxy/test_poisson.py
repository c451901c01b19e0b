"""From points to a mesh: Poisson, trimming, simplification, masks, background, and the whole from photographs."""

from __future__ import annotations

import numpy as np
import pytest

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.graph import face_edges
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.background import camera_coverage, fill_background, join_meshes
from eigenfield.proxy.samples import surface_samples
from eigenfield.proxy.surface.fusion import OrientedPoints, fuse_depth_maps
from eigenfield.proxy.surface.multiview import surface_from_views
from eigenfield.proxy.surface.poisson import poisson_surface
from eigenfield.proxy.surface.trim import (
    clear_views,
    simplify_with_error,
    surface_distances,
    surface_error,
    trim_by_masks,
    trim_surface,
)
from support.surfaces import Drawn, ball, ball_before_wall, depth_views, looking, nine_cameras, square


@pytest.fixture(scope="module")
def scene():
    return ball_before_wall()


@pytest.fixture(scope="module")
def cameras():
    return nine_cameras()


@pytest.fixture(scope="module")
def points(scene, cameras):
    return fuse_depth_maps(depth_views(scene, cameras))


@pytest.fixture(scope="module")
def whole(points):
    return poisson_surface(points)


@pytest.mark.slow
def test_poisson_is_the_same_twice_and_true(whole, points):
    again = poisson_surface(points)
    assert np.array_equal(again.vertices, whole.vertices) and np.array_equal(again.faces, whole.faces)
    assert surface_error(whole, points.positions, looking(np.array([0, 0, -5.0]), (0, 0, 0))).rms < 0.01


def test_the_surface_is_true_covers_and_is_manifold(whole, points, scene, cameras):
    mesh = trim_surface(whole, points)
    for camera in cameras:
        drawn, true = rasterise_view(mesh, camera).inverse_depth, rasterise_view(scene, camera).inverse_depth
        both = (drawn > 0) & (true > 0)
        off = np.abs(drawn[both] / true[both] - 1)
        assert np.median(off) < 1e-3 and (off < 0.01).mean() > 0.95 and both.mean() > 0.8
    assert camera_coverage(mesh, cameras)[4] > 0.99
    _, number = face_edges(mesh.faces)
    assert np.bincount(number).max() == 2
    assert np.abs(mesh.vertices).max() < 4.4  # Poisson's closed balloon is cut
    assert (mesh.face_normals()[mesh.face_areas() > 0] @ [0, 0, -1]).mean() > 0.5


def test_simplification_reports_its_error(points, cameras, whole):
    fine = trim_surface(whole, points)
    mesh, error = simplify_with_error(fine, points, 2000, cameras[4])
    assert 1000 < len(mesh.faces) <= 2000
    assert error.rms < 0.02 and error.relative < 0.003 and error.pixels < 0.6
    _, coarse = simplify_with_error(fine, points, 150, cameras[4])
    assert coarse.rms > 2 * error.rms and coarse.pixels > 2 * error.pixels
    assert "%" in str(error) and "px" in str(error)


def test_masks_cut_the_surface(scene, cameras):
    masks = [rasterise_view(ball(), camera).face >= 0 for camera in cameras]
    mesh = trim_by_masks(scene, cameras, masks)
    on_ball = np.abs(np.linalg.norm(mesh.vertices, axis=1) - 1) < 1e-4
    assert on_ball.sum() == 10242 and len(mesh.faces) < 20600  # all of the ball, of the wall only what it hides
    assert np.linalg.norm(mesh.vertices[~on_ball][:, :2], axis=1).max() < 0.9
    assert len(trim_by_masks(ball(), cameras, [None] * 9).faces) == len(ball().faces)
    with pytest.raises(ProxyError) as caught:
        trim_by_masks(scene, cameras, [np.zeros((120, 160), np.bool_)] * 9)
    assert caught.value.code == "surface-empty"


def test_the_wall_behind_which_a_camera_stands_does_not_hide_the_scene(scene, cameras):
    views = depth_views(scene, cameras)
    wall = square(0.5, 0.05, 20)
    turn, centre = cameras[4].R, cameras[4].centre
    behind = Mesh((wall.vertices @ turn + centre).astype(np.float32), wall.faces)
    facing = Mesh(behind.vertices, behind.faces[:, ::-1].copy())
    sides = [one.face_normals() @ turn[2] for one in (behind, facing)]
    away, towards = (behind, facing) if sides[0].min() > 0 else (facing, behind)
    cut = clear_views(join_meshes(scene, away), views)
    drawn, true = (rasterise_view(one, cameras[4]).inverse_depth for one in (cut, scene))
    assert np.allclose(drawn, true) and len(scene.faces) < len(cut.faces) < len(scene.faces) + len(wall.faces)
    for kept in (scene, join_meshes(scene, towards)):  # what shows its front stands there
        assert clear_views(kept, views) is kept


def test_too_few_points_are_no_surface():
    few = OrientedPoints(np.zeros((3, 3)), np.zeros((3, 3), np.float32), np.ones(3, np.float32))
    with pytest.raises(ProxyError, match="3 points") as caught:
        poisson_surface(few)
    assert caught.value.code == "surface-no-points"


def test_a_surface_far_from_all_points_comes_out_empty(points):
    with pytest.raises(ProxyError) as caught:
        trim_surface(ball(centre=(50, 0, 0), level=5, radius=8), points)
    assert caught.value.code == "surface-empty"


def test_distances_of_known_points():
    mesh = square(1, 0.0, 5)
    away = np.array([[0.1, 0.2, 0.5], [0.3, -0.2, -2.0], [2.0, 0.0, 0.0], [2.0, 2.0, 1.0]])
    assert np.allclose(surface_distances(mesh, away), [0.5, 2.0, 1.0, np.sqrt(3)], atol=1e-6)


def test_samples_are_spread_by_area():
    mesh = join_meshes(square(1, 0.0, 5), square(2, 1.0, 5))
    samples, face = surface_samples(mesh, 10_000)
    assert np.isclose((samples[:, 2] == 1).mean(), 0.8, atol=0.01)
    assert np.abs(samples[samples[:, 2] == 1][:, :2].mean(axis=0)).max() < 0.03
    assert np.array_equal(np.unique(face), np.arange(len(mesh.faces)))


def test_the_background_closes_every_view_behind_everything(cameras):
    mesh = join_meshes(ball(), square(1.5, 1.2))
    before = camera_coverage(mesh, cameras)
    assert before.max() < 0.6
    closed = fill_background(mesh, cameras)
    assert (camera_coverage(closed, cameras) == 1).all()
    for camera in cameras:  # nothing of the mesh is hidden by it, beyond a pixel's rounding
        own, both = rasterise_view(mesh, camera), rasterise_view(closed, camera)
        there = own.face >= 0
        assert (both.inverse_depth[there] > own.inverse_depth[there] * 1.001).mean() < 1e-3
    far = closed.vertices[len(mesh.vertices) :]
    assert 1.2 < np.median(far[:, 2]) < 2.5  # goes on where the wall ends, not at infinity


def test_the_background_goes_on_in_the_plane_of_a_slanted_wall(cameras):
    wall = square(2.5, 0.0, 40)
    tilt = wall.vertices.astype(np.float64) @ np.array([[1, 0, 0.3], [0, 1, 0], [0, 0, 1]])
    closed = fill_background(Mesh(tilt.astype(np.float32), wall.faces), cameras)
    assert (camera_coverage(closed, cameras) == 1).all()
    far = closed.vertices[len(wall.vertices) :].astype(np.float64)
    inside = np.abs(far[:, :2]).max(axis=1) < 3.5
    assert inside.sum() > 20
    assert np.abs(far[inside, 2] - 0.3 * far[inside, 0]).max() < 0.6


def test_a_walk_around_gets_a_dome(cameras):
    around = [
        looking(np.array([5 * np.sin(a), -1.0, 5 * np.cos(a)]), (0, 0, 0)) for a in np.linspace(0, 2 * np.pi, 12)[:-1]
    ]
    closed = fill_background(ball(), around)
    assert (camera_coverage(closed, around) == 1).all()
    assert np.linalg.norm(closed.vertices[2562:], axis=1).min() > 5.0  # beyond all cameras


def test_backgrounds_of_nothing_are_refused(cameras):
    with pytest.raises(ProxyError) as caught:
        fill_background(Mesh(np.zeros((0, 3), np.float32), np.zeros((0, 3), np.int32)), cameras)
    assert caught.value.code == "surface-empty"


@pytest.mark.slow
def test_photographs_to_a_surface(scene, cameras):
    light_field = Drawn(scene, cameras)
    stages = []
    surface = surface_from_views(light_field, triangles=4000, progress=lambda stage, done, total: stages.append(stage))
    assert (camera_coverage(surface.mesh, cameras) == 1).all()
    view = rasterise_view(surface.mesh, cameras[4])
    true = rasterise_view(scene, cameras[4]).inverse_depth
    off = np.abs(view.inverse_depth / true - 1)
    assert np.median(off) < 0.005 and (off < 0.02).mean() > 0.9
    assert {"photographs", "coarse depth", "depth", "fusion", "surface"} <= set(stages)


@pytest.mark.slow
def test_photographs_with_masks_give_the_foreground_without_a_background(scene, cameras):
    masks = [rasterise_view(ball(), camera).face >= 0 for camera in cameras]
    points = ball(level=3).vertices.astype(np.float64)
    surface = surface_from_views(Drawn(scene, cameras, masks), points, triangles=4000)
    near = surface.mesh.vertices[surface.mesh.vertices[:, 2] < 0.2]  # what is behind no camera sees
    off = np.abs(np.linalg.norm(near, axis=1) - 1)
    assert np.median(off) < 0.03 and np.percentile(off, 90) < 0.15
    seen = rasterise_view(surface.mesh, cameras[4]).face >= 0
    assert (seen & masks[4]).sum() > 0.85 * masks[4].sum() and (seen & ~masks[4]).sum() < 0.1 * masks[4].sum()
