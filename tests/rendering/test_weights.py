"""View weights: barycentric, continuous where they must be, exact at the cameras."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import reference
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.rig import Rig
from eigenfield.core.viewplane import fit_view_plane
from eigenfield.rendering import ViewWeights, camera_weights, delaunay_triangles, novel_camera, view_weights
from support.scenes import tiny_scene

K = np.array([[100.0, 0, 50], [0, 100, 40], [0, 0, 1]])


def scene_at(centres, held_out=()):
    """A scene whose cameras stand at (n, 2) places, looking along z."""
    cameras = tuple(Camera(K, np.eye(3), -np.array([x, -y, 0.0]), 100, 80) for x, y in centres)
    held = np.zeros(len(cameras), bool)
    held[list(held_out)] = True
    plane = fit_view_plane(cameras)
    places = plane.coordinates([camera.centre for camera in cameras])
    triangles = delaunay_triangles(places[~held])
    names = tuple(str(index) for index in range(len(cameras)))
    scene = replace(
        tiny_scene(),
        rig=replace(
            tiny_scene().rig, names=names, cameras=cameras, held_out=held, view_plane=plane, triangles=triangles
        ),
    )
    return replace(scene, rig=replace(scene.rig, reference=int(np.flatnonzero(~held)[0]))), places


def dense_weights(scene, at, mode="delaunay"):
    return view_weights(scene, at, mode).dense(scene.observations)


def jittered(rows, columns, seed=0, amount=0.15):
    random = np.random.default_rng(seed)
    grid = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2).astype(float)
    return grid + random.uniform(-amount, amount, grid.shape)


def test_weights_blend_the_rows_that_they_name():
    matrix = np.array([[1, 2], [10, 20], [100, 200], [1000, 2000]], np.float32)
    weights = ViewWeights(np.array([1, 3]), np.array([0.25, 0.75]))
    np.testing.assert_array_equal(weights.blend(matrix), [752.5, 1505])
    np.testing.assert_array_equal(weights.dense(5), [0, 0.25, 0, 0.75, 0])
    np.testing.assert_array_equal(ViewWeights.one(2).blend(matrix), matrix[2])
    np.testing.assert_array_equal(ViewWeights().blend(matrix), [0, 0])
    assert weights.blend(matrix).dtype == np.float64


@pytest.mark.parametrize("rows, values", [([0, 1], [1]), ([[0]], [[1]]), ([2, 2], [0.5, 0.5]), ([-1], [1])])
def test_weights_of_no_or_of_the_same_observation_are_refused(rows, values):
    with pytest.raises(ValueError, match="view weights"):
        ViewWeights(np.array(rows), np.array(values, float))


@pytest.mark.parametrize("mode, most", [("delaunay", 3), ("nearest3", 3), ("bilinear", 4)])
def test_a_place_takes_of_the_cameras_around_it_alone(mode, most):
    """In the order of the cameras, held-out ones left out."""
    scene, places = scene_at(jittered(3, 4), held_out=[11] if mode != "bilinear" else [])
    for at in (*places, (0.1, 0.2), (-0.4, 0.7), (0.9, -0.9)):
        weights = view_weights(scene, at, mode)
        assert 1 <= len(weights.rows) <= most and (np.diff(weights.rows) > 0).all() and weights.values.all()
        assert weights.rows.max() < len(scene.rig.encoded)


@settings(max_examples=30)
@given(seed=st.integers(0, 1000), mode=st.sampled_from(["delaunay", "bilinear"]))
def test_continuous_modes_reproduce_positions_and_sum_to_one(seed, mode):
    """Inside the hull the weighted mean of the cameras' places is the viewpoint itself."""
    scene, places = scene_at(jittered(5, 6, seed, 0.12))  # a grid has less than a quarter of its spacing
    random = np.random.default_rng(seed)
    for at in random.uniform(-0.7, 0.7, (5, 2)):
        weights = dense_weights(scene, at, mode)
        assert weights.sum() == pytest.approx(1, abs=1e-12) and weights.min() >= -1e-12
        np.testing.assert_allclose(weights @ places, at, atol=1e-9)


@pytest.mark.parametrize("mode", ["delaunay", "bilinear", "nearest3"])
def test_exact_at_the_cameras(mode):
    scene, places = scene_at(jittered(4, 4))
    for index, at in enumerate(places):
        weights = dense_weights(scene, at, mode)
        assert weights[index] == pytest.approx(1, abs=1e-9)
        own = camera_weights(scene, index, mode)
        assert own.rows.tolist() == [index] and own.values.tolist() == [1]


def test_a_cameras_own_observation_has_no_rounding_of_its_place():
    scene, _ = scene_at(np.roll(jittered(3, 3, seed=1), 3, axis=0))  # the place of the first has a second of 2e-16
    for index in range(9):
        assert camera_weights(scene, index).rows.tolist() == [index]


@settings(max_examples=20)
@given(seed=st.integers(0, 1000))
def test_nearest3_is_equation_7(seed):
    random = np.random.default_rng(seed)
    scene, places = scene_at(random.uniform(-1, 1, (9, 2)))
    rows = random.normal(size=(9, 4))
    at = random.uniform(-0.9, 0.9, 2)
    expected = reference.nearest3_weights(at, places, rows)
    np.testing.assert_allclose(view_weights(scene, at, "nearest3").blend(rows), expected, rtol=1e-6, atol=1e-6)


def largest_jump(scene, mode, steps):
    angle = np.linspace(0, 2 * np.pi, steps)
    path = 0.8 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    weights = np.array([dense_weights(scene, at, mode) for at in path])
    return np.abs(np.diff(weights, axis=0)).max()


def test_delaunay_and_bilinear_do_not_jump_and_nearest3_does():
    """Halving the step halves the largest change of a weight; for nearest3 it stays."""
    scene, _ = scene_at(jittered(5, 5))
    for mode in ("delaunay", "bilinear"):
        assert largest_jump(scene, mode, 801) < 0.6 * largest_jump(scene, mode, 401)
    assert largest_jump(scene, "nearest3", 801) > 0.8 * largest_jump(scene, "nearest3", 401)


def test_outside_the_hull_the_nearest_point_of_it_counts():
    scene, places = scene_at([[0, 0], [2, 0], [1, 2]])
    weights = dense_weights(scene, (-1, 1))  # the bounding box's corner, outside the triangle
    assert weights.min() >= 0 and weights.sum() == pytest.approx(1) and (weights > 0).sum() == 2
    nearest = weights @ places
    for other in np.random.default_rng(0).dirichlet([1, 1, 1], 200) @ places:
        assert np.linalg.norm(nearest - [-1, 1]) <= np.linalg.norm(other - [-1, 1]) + 1e-9


def test_viewpoints_are_clamped_to_the_array():
    scene, _ = scene_at(jittered(3, 3))
    np.testing.assert_array_equal(dense_weights(scene, (9, -9)), dense_weights(scene, (1, -1)))


@pytest.mark.parametrize("mode", ["delaunay", "bilinear", "nearest3"])
def test_cameras_on_a_line_are_one_dimensional(mode):
    scene, places = scene_at([[0, 0], [1, 0], [3, 0], [4, 0]])
    for y in (0.0, 0.7):
        weights = dense_weights(scene, (0.1, y), mode)
        assert weights.sum() == pytest.approx(1)
        if mode == "delaunay":
            np.testing.assert_allclose(weights @ places[:, 0], 0.1, atol=1e-9)
            assert (weights > 0).sum() == 2


def test_held_out_cameras_take_the_weights_of_where_they_stand():
    scene, places = scene_at(jittered(3, 3, amount=0), held_out=[4])
    weights = camera_weights(scene, 4).dense(scene.observations)
    assert weights.shape == (8,)
    np.testing.assert_allclose(weights @ places[scene.rig.encoded], places[4], atol=1e-9)


def test_impossible_requests_are_refused():
    scene, _ = scene_at(np.random.default_rng(0).random((7, 2)))
    with pytest.raises(OptionError, match="delaunay"):
        view_weights(scene, (0, 0), "bilinear")
    with pytest.raises(OptionError, match="use one of"):
        view_weights(scene, (0, 0), "best")
    with pytest.raises(OptionError):
        view_weights(scene, (float("nan"), 0))


def test_a_novel_camera_of_a_rectified_array_keeps_the_plane_of_zero_parallax():
    """Principal points move with the cameras so that z = 2 stands still; so it does between them."""
    cameras = tuple(
        Camera(K + np.array([[0, 0, 50 * x], [0, 0, 50 * y], [0, 0, 0]]), np.eye(3), -np.array([x, y, 0.0]), 100, 80)
        for y in (0, 0.5, 1)
        for x in (0, 0.4, 1)
    )
    plane = fit_view_plane(cameras)
    places = plane.coordinates([camera.centre for camera in cameras])
    rig = Rig(tuple("abcdefghi"), cameras, np.zeros(9, bool), 4, plane, delaunay_triangles(places))
    scene = replace(tiny_scene(), rig=rig)
    point = np.array([[0.3, 0.4, 2.0]])
    still = cameras[0].project(point)[0]
    for at in ((0, 0), (0.3, -0.8), (-1, 1)):
        camera = novel_camera(scene, at)
        np.testing.assert_allclose(camera.project(point)[0], still, atol=1e-9)
        np.testing.assert_allclose(camera.centre, plane.point(*at), atol=1e-9)


@pytest.mark.parametrize("mode", ["delaunay", "bilinear"])
def test_weights_on_an_edge_are_those_of_its_ends(mode):
    """Rounding may put such a point outside the triangles, or cells, on both sides: it must not fall to the rim."""
    random = np.random.default_rng(3)
    scene, places = scene_at(jittered(5, 5))
    rows = [(5 * row + column, 5 * row + column + 1) for row, column in np.ndindex(5, 4)]
    edges = rows if mode == "bilinear" else scene.rig.triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2).tolist()
    assert len(edges) >= 20
    for first, second in edges:
        for part in random.uniform(0.05, 0.95, 40):
            weights = dense_weights(scene, tuple((1 - part) * places[first] + part * places[second]), mode)
            assert weights[[first, second]] == pytest.approx([1 - part, part], abs=1e-6) and weights.min() >= 0
