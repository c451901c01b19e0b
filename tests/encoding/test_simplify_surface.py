"""How many triangles a mesh keeps for the pictures that it draws."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from eigenfield.capture import open_capture
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.encoding import EncodeOptions, prepare
from eigenfield.encoding.geometry.simplify_surface import _cleared, _loss, _points, _view, simplify_surface_rd
from eigenfield.encoding.options import density_for_quality
from eigenfield.encoding.prepare import plan_at_quality, plan_encoding
from eigenfield.proxy import simplify_mesh, unwrap_mesh
from support.captures import write_capture
from support.observations import greys, repeated
from support.scenes import row_grid
from support.surfaces import ball, nine_cameras, square

CAMERAS = tuple(camera.resize(120, 100) for camera in row_grid(9))


def wavy(height: float, nodes: int = 42) -> Mesh:
    """A square of over 3,000 triangles with waves of `height`, before the cameras."""
    flat = square(2.0, 0.0, nodes)
    x, y, _ = flat.vertices.T
    return Mesh(np.stack([x, y, height * np.sin(4 * x) * np.cos(3 * y)], axis=1).astype(np.float32), flat.faces)


def stripes(camera: Camera) -> np.ndarray:
    column, row = np.arange(camera.width), np.arange(camera.height)
    return (0.5 + 0.2 * np.cos(0.7 * column) + 0.2 * np.cos(0.5 * row)[:, None]).astype(np.float32)


def count_of(mesh: Mesh, lambda_: float) -> int | None:
    found = simplify_surface_rd(mesh, CAMERAS, greys([stripes(camera) for camera in CAMERAS]), lambda_)
    return None if found is None else len(found.faces)


@pytest.mark.slow
def test_a_plane_keeps_next_to_nothing_and_waves_as_many_as_their_bytes_pay_for():
    found = [count_of(wavy(height), 7.5e-6) for height in (0.0, 0.05, 0.1)]
    assert all(found) and found == sorted(set(found))
    assert found[0] < 400
    assert count_of(wavy(0.2), 7.5e-6) is None  # too few would go for new charts
    few = count_of(wavy(0.2), 1e-3)
    assert few is not None and few < found[-1]
    assert count_of(wavy(0.2), 1e-9) is None  # bytes cost nothing: all are kept
    assert count_of(wavy(0.0), 0) is None


def test_few_triangles_and_meshes_that_no_camera_sees_stay():
    small = simplify_mesh(wavy(0.1), 200)
    assert count_of(small, 1.0) is None
    assert count_of(replace(wavy(0.1), vertices=wavy(0.1).vertices - np.float32([0, 0, 50])), 1.0) is None


def test_one_camera_determines_no_depth():
    assert simplify_surface_rd(wavy(0.1), CAMERAS[:1], greys([stripes(CAMERAS[0])]), 1e-5) is None


@pytest.mark.slow
def test_photographs_again_at_another_time_keep_as_many_triangles():
    twice = repeated(greys([stripes(camera) for camera in CAMERAS]).pixels, 2)
    found = simplify_surface_rd(wavy(0.05), CAMERAS, twice, 1e-5)
    assert found is not None and len(found.faces) == count_of(wavy(0.05), 1e-5)
    assert simplify_surface_rd(wavy(0.1), CAMERAS[:1], repeated([twice.pixels[0]], 2), 1e-5) is None


def test_the_loss_is_that_of_a_texture_drawn_at_the_wrong_depth():
    """A wall whose copy stands too near by so much that it is half a pixel off beside each camera: the mean of the
    others, drawn on the copy, misses a photograph by gradient times displacement."""
    wall = square(3.0, 0.0, 8)
    cameras = CAMERAS[3:6]  # in a row, half a unit apart
    angle = 0.3
    pictures = []
    for camera in cameras:  # a wave on the wall along x, as each camera sees it
        x = (np.arange(camera.width) + 0.5 - camera.K[0, 2]) / camera.K[0, 0] * 3.0 - camera.t[0]
        pictures.append(np.tile(np.cos(angle * x * camera.K[0, 0] / 3.0), (camera.height, 1)).astype(np.float32))
    views = [_view(wall, camera, 0, picture) for camera, picture in zip(cameras, pictures, strict=True)]
    looked = [_points(views, number) for number in range(3)]
    assert _loss(wall, views, looked, True) == pytest.approx(0, abs=1e-9)
    off = 0.5 / (0.5 * cameras[0].K[0, 0])  # of inverse depth, for half a pixel between neighbours
    near = replace(wall, vertices=wall.vertices + np.float32([0, 0, 1 / (1 / 3 + off) - 3]))
    # An outer camera's points lie half a pixel off beside its neighbour, one beside the other; the middle one's half a
    # pixel, either way. At the sides some see what others do not.
    away = 0.5 / 3.0 * cameras[0].K[0, 0] / cameras[0].width
    both, one = 1 - 2 * away, away
    squares = 2 * (both * ((0.5 + 1) / 2) ** 2 + one * 0.5**2) + 2 * one * 0.5**2
    slope = 0.5 * angle**2
    assert _loss(near, views, looked, True) == pytest.approx(views[0].grey.size * slope * squares, rel=0.08)


def test_at_a_silhouette_two_unlike_values_differ_and_no_texture_corrects_it():
    """Half of a wall is gone, and another one stands behind it: there the error is twice the variance, in full."""
    wall, behind = square(3.0, 0.0, 8), square(3.0, 0.0, 8)
    left = wall.faces[wall.vertices[wall.faces].mean(axis=1)[:, 0] < 0]
    far = behind.vertices + np.float32([0, 0, 1.0])
    both = Mesh(np.concatenate([wall.vertices, far]), np.concatenate([left, behind.faces + np.int32(len(far))]))
    views = [_view(wall, camera, 0, stripes(camera)) for camera in CAMERAS]
    looked = [_points(views, number) for number in range(len(views))]
    drawn = [_view(both, view.camera, 0, view.grey).inverse_depth for view in views]
    shown = [(one > 0) & (one < 0.99 * view.inverse_depth) for one, view in zip(drawn, views, strict=True)]
    assert all(0.25 < one.mean() < 0.7 for one in shown)
    expected = sum(float(view.around[one].sum()) for one, view in zip(shown, views, strict=True)) * 2 / 0.4
    assert _loss(both, views, looked, True) == pytest.approx(expected, rel=0.02)
    assert _loss(both, views, looked, False) < expected / 5  # at most the variance, of which 0.4 remain


def test_where_nothing_is_left_the_picture_is_black():
    wall = square(3.0, 0.0, 8)
    half = replace(wall, faces=wall.faces[wall.vertices[wall.faces].mean(axis=1)[:, 0] < 0])
    views = [_view(wall, camera, 0, stripes(camera)) for camera in CAMERAS]
    looked = [_points(views, number) for number in range(len(views))]
    gone = [view.grey[_view(half, view.camera, 0, view.grey).inverse_depth <= 0] for view in views]
    assert _loss(half, views, looked, True) == pytest.approx(
        sum(float(np.square(one).sum()) for one in gone) / 0.4, rel=1e-5
    )


def test_large_photographs_are_looked_at_smaller():
    wall = wavy(0.1)
    camera = CAMERAS[4].resize(2400, 2000)
    grey = np.kron(stripes(CAMERAS[4]), np.ones((20, 20), np.float32))
    view = _view(wall, camera, 0, grey)
    assert view.grey.size <= 1 << 20 and view.pixels == pytest.approx(2400 * 2000 / (1 << 20))
    assert view.grey.shape == (view.camera.height, view.camera.width) == view.inverse_depth.shape


@pytest.mark.slow
def test_a_surface_before_cameras_in_no_array_has_fewer_texels(tmp_path):
    given = unwrap_mesh(ball(radius=1.5, level=2))
    grid = nine_cameras()
    away = np.random.default_rng(1).uniform(-1, 1, (9, 3))
    scattered = [replace(camera, t=camera.t + offset) for camera, offset in zip(grid, away, strict=True)]
    density = {}
    for name, cameras in (("grid", grid), ("scattered", scattered)):
        field = open_capture(write_capture(tmp_path / name, tuple(cameras), given))
        left_out = "every:4"  # by which what is encoded is on no grid
        plan = plan_encoding(field, given, EncodeOptions(quality=89, triangles=len(given.faces), hold_out=left_out))
        density[name] = plan.options.density
        asked = plan_encoding(field, given, EncodeOptions(quality=89, density=1.2, triangles=len(given.faces)))
        assert asked.options.density == 1.2
    assert density["grid"] == density_for_quality(89)
    assert density["scattered"] == pytest.approx(0.7 * density["grid"])


@pytest.mark.slow
def test_a_fit_has_fewer_triangles_the_coarser_its_quality_and_as_many_as_were_asked_for(tmp_path):
    smooth = ball(radius=1.5, level=3)
    bumps = 1 + 0.03 * np.sin(9 * smooth.vertices).prod(axis=1, keepdims=True)
    given = replace(smooth, vertices=(smooth.vertices * bumps).astype(np.float32))
    field = open_capture(write_capture(tmp_path / "ball", tuple(nine_cameras()), unwrap_mesh(given)))
    coarse = plan_encoding(field, given, EncodeOptions(quality=55))
    fine = plan_at_quality(coarse, 92)
    counts = [len(plan.mesh.faces) for plan in (coarse, fine)]
    assert counts[0] < 0.6 * counts[1] and counts[1] <= len(given.faces)
    assert fine.options.quality == 92 and fine.mesh_bytes > coarse.mesh_bytes
    again = plan_at_quality(fine, 55)
    np.testing.assert_array_equal(again.mesh.vertices, coarse.mesh.vertices)
    assert len(plan_encoding(field, given, EncodeOptions(fit="none")).mesh.faces) == len(given.faces)
    asked = plan_encoding(field, given, EncodeOptions(quality=55, triangles=1000))
    assert 960 <= len(asked.mesh.faces) <= 1000
    assert len(plan_at_quality(asked, 92).mesh.faces) == len(asked.mesh.faces)


def test_the_mesh_is_the_one_whose_pictures_were_measured():
    """Of two ways to a number of triangles the nearer one is returned, and not a third made for that number."""
    observations = greys([stripes(camera) for camera in CAMERAS])
    mesh = wavy(0.1)
    found = simplify_surface_rd(mesh, CAMERAS, observations, 2e-5)
    assert found is not None and found.uv is None
    views = [_view(mesh, camera, 0, stripes(camera)) for camera in CAMERAS]
    looked = [_points(views, number) for number in range(len(views))]
    at_once = simplify_mesh(mesh, 3362 // 4)
    assert len(found.faces) == pytest.approx(len(at_once.faces), abs=2)
    assert _loss(found, views, looked, True) <= _loss(at_once, views, looked, True)


@pytest.mark.parametrize("is_estimated", [False, True])
def test_silhouettes_of_an_estimated_surface_do_not_count_in_full(tmp_path, monkeypatch, is_estimated):
    given = ball(radius=1.5, level=2)
    field = open_capture(write_capture(tmp_path / "ball", tuple(nine_cameras()), unwrap_mesh(given)))
    counted = []

    def watched(*arguments, silhouettes):
        counted.append(silhouettes)
        return simplify_surface_rd(*arguments, silhouettes=silhouettes)

    monkeypatch.setattr(prepare, "simplify_surface_rd", watched)
    plan_encoding(field, Proxy(given) if is_estimated else given, EncodeOptions(quality=55))
    assert counted == [not is_estimated]


@pytest.mark.parametrize(("faces_camera", "left"), [(True, 18), (False, 0)])
def test_a_wall_that_shows_a_camera_its_back_is_cut_away_again(faces_camera, left):
    """Simplification may close the hole in a wall through which a camera looks; what faces the camera stays."""
    scene, camera = square(3.0, 0.0, 8), CAMERAS[4]
    wall = square(0.02, float(camera.centre[2]) + 0.2, 4)
    shown = wall.faces if faces_camera else wall.faces[:, ::-1]
    faces = np.concatenate([scene.faces, shown + np.int32(len(scene.vertices))])
    both = Mesh(np.concatenate([scene.vertices, wall.vertices + np.float32([*camera.centre[:2], 0])]), faces)
    found = _cleared(both, [_view(scene, camera, 0, stripes(camera))])
    assert len(found.faces) - len(scene.faces) == left
