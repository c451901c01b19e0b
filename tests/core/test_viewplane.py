"""The plane through an array, its coordinates and its grid."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from eigenfield.capture.holdout import held_out_cameras
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.viewplane import find_grid, fit_view_plane

K = np.array([[100.0, 0, 50], [0, 100, 40], [0, 0, 1]])


def cameras_at(centres, R=None):
    R = np.eye(3) if R is None else R
    return [Camera(K, R, -R @ np.asarray(c, float), 100, 80) for c in centres]


def grid_points(rows, columns, dx=1.0, dy=0.7):
    return np.array([[c * dx, r * dy, 0] for r in range(rows) for c in range(columns)])


@settings(max_examples=30)
@given(seed=st.integers(0, 10_000))
def test_coordinates_follow_the_cameras_whatever_the_world(seed):
    """X grows to the right of the cameras, Y against their down axis, ±1 at the edges."""
    generator = np.random.default_rng(seed)
    R = Rotation.random(random_state=seed).as_matrix()
    local = grid_points(4, 5) - [2, 1.05, 0]  # in camera axes: x right, y down
    shift = generator.normal(size=3) * 10
    plane = fit_view_plane(cameras_at(local @ R + shift, R))
    coordinates = plane.coordinates(local @ R + shift)
    np.testing.assert_allclose(coordinates[:, 0], local[:, 0] / 2, atol=1e-9)
    np.testing.assert_allclose(coordinates[:, 1], -local[:, 1] / 1.05, atol=1e-9)
    np.testing.assert_allclose(plane.point(*coordinates[3]), local[3] @ R + shift, atol=1e-9)
    np.testing.assert_allclose(plane.extent, [2, 1.05])


@pytest.mark.parametrize("seed", range(5))
def test_the_coordinates_of_any_array_reach_one_at_all_edges(seed):
    """Also where the cameras look slantwise through their plane and most stand in one corner of it."""
    random = np.random.default_rng(seed)
    centres = np.concatenate([random.exponential(size=(12, 2)), np.zeros((12, 1))], axis=1) - [0, 0, 3]
    R = Rotation.from_euler("xyz", random.uniform(-40, 40, 3), degrees=True).as_matrix()
    plane = fit_view_plane(cameras_at(centres, R))
    coordinates = plane.coordinates(centres)
    np.testing.assert_allclose([coordinates.min(axis=0), coordinates.max(axis=0)], [[-1, -1], [1, 1]])
    normal = np.cross(plane.right, -plane.up)
    np.testing.assert_allclose(normal, [0, 0, 1], atol=1e-12)
    assert np.linalg.norm(plane.right) == pytest.approx(1)
    np.testing.assert_allclose(plane.right @ np.cross(normal, R[0]), 0, atol=1e-12)


def test_one_camera_is_a_line_of_no_length():
    plane = fit_view_plane(cameras_at([[1, 2, 3]]))
    assert plane.is_line and plane.extent.tolist() == [0, 0] and plane.origin.tolist() == [1, 2, 3]


def test_cameras_on_a_line_have_no_second_coordinate():
    plane = fit_view_plane(cameras_at([[i, 0.001 * (-1) ** i, 0] for i in range(6)]))
    assert plane.is_line
    coordinates = plane.coordinates([[0, 0, 0], [5, 0, 0], [2, 7, 0]])
    np.testing.assert_allclose(coordinates[:2, 0], [-1, 1], atol=1e-3)
    assert (coordinates[:, 1] == 0).all()


@pytest.mark.parametrize("direction", [[1, 0, 0], [0, 1, 0], [0, -1, 0], [3, 4, 0], [1, 0, 2]])
def test_the_axes_of_a_line_are_those_of_a_picture(direction):
    """Right, down and forward are a right-handed system, also where the line is the cameras' own vertical."""
    direction = np.array(direction) / np.linalg.norm(direction)
    plane = fit_view_plane(cameras_at([3 * i * direction for i in range(4)]))
    assert plane.is_line and plane.extent == pytest.approx([4.5, 0])
    np.testing.assert_allclose(np.abs(plane.right), np.abs(direction), atol=1e-12)
    forward = np.array([0, 0, 1]) - direction[2] * direction
    np.testing.assert_allclose(np.cross(plane.right, -plane.up), forward / np.linalg.norm(forward), atol=1e-12)


@pytest.mark.parametrize(("rows", "columns"), [(17, 17), (4, 5), (5, 4), (3, 9), (2, 3)])
def test_a_jittering_grid_is_found(rows, columns):
    generator = np.random.default_rng(0)
    points = grid_points(rows, columns, 0.2, 0.17)[:, :2] + generator.uniform(-0.03, 0.03, (rows * columns, 2))
    order = generator.permutation(rows * columns)
    grid = find_grid(points[order])
    assert grid is not None and (grid.rows, grid.columns) == (rows, columns)
    np.testing.assert_array_equal(order[grid.index], np.arange(rows * columns).reshape(rows, columns))


def test_scattered_cameras_are_no_grid():
    assert find_grid(np.random.default_rng(1).random((24, 2))) is None
    assert find_grid(np.random.default_rng(1).random((13, 2))) is None


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize(("share", "found"), [(0.22, True), (0.28, False)])
def test_a_camera_may_stand_a_quarter_of_the_spacing_beside_its_node(axis, share, found):
    points = grid_points(20, 20, 0.3, 0.2)[:, :2]
    points[210, axis] += share * (0.3, 0.2)[axis]
    assert (find_grid(points) is not None) == found


def test_cameras_in_one_place_are_no_grid():
    assert find_grid([[0, 0], [0, 0], [1, 0], [1, 0]]) is None
    assert find_grid(np.repeat(grid_points(2, 3)[:, :2], 2, axis=0)) is None


def test_a_line_is_a_grid_of_one_row():
    grid = find_grid(np.array([[0.0, 0], [1, 0], [2, 0]]))
    assert grid is not None and (grid.rows, grid.columns) == (1, 3)


def coordinates(rows, columns):
    return fit_view_plane(cameras_at(grid_points(rows, columns))).coordinates(grid_points(rows, columns))


def test_holding_out_odd_rows_and_columns():
    names = [f"{i}" for i in range(25)]
    held = held_out_cameras("odd", names, coordinates(5, 5)).reshape(5, 5)
    assert (~held).sum() == 9 and not held[::2, ::2].any()


def test_holding_out_every_fifth_and_names():
    names = [f"{i}.png" for i in range(20)]
    assert np.flatnonzero(held_out_cameras("every:5", names, coordinates(4, 5))).tolist() == [2, 7, 12, 17]
    assert np.flatnonzero(held_out_cameras("3.png, 7.png", names, coordinates(4, 5))).tolist() == [3, 7]
    assert np.flatnonzero(held_out_cameras("3, 7.PNG", names, coordinates(4, 5))).tolist() == [3, 7]
    assert not held_out_cameras(None, names, coordinates(4, 5)).any()


@pytest.mark.parametrize(
    ("rule", "says"),
    [("every:1", "2 or more"), ("every:x", "2 or more"), ("30.png", "no camera is called 30.png"),
     ("every:2,3", "2 or more"), (",".join(f"{i}.png" for i in range(18)), "2 cameras would remain")],
)  # fmt: skip
def test_impossible_rules_are_refused(rule, says):
    with pytest.raises(OptionError, match=says):
        held_out_cameras(rule, [f"{i}.png" for i in range(20)], coordinates(4, 5))


def test_odd_needs_a_grid():
    with pytest.raises(OptionError, match="no grid"):
        held_out_cameras("odd", [str(i) for i in range(20)], np.random.default_rng(0).random((20, 2)))


@pytest.mark.parametrize(
    ("change", "code"),
    [({"R": np.diag([1.0, 1, -1])}, "camera-not-rotation"), ({"R": 2 * np.eye(3)}, "camera-not-rotation"),
     ({"t": [0, np.nan, 0]}, "camera-not-finite"), ({"K": np.diag([-1.0, 1, 1])}, "camera-focal"),
     ({"width": 0}, "camera-size"), ({"R": np.eye(2)}, "camera-shape")],
)  # fmt: skip
def test_impossible_cameras_are_refused_by_name(change, code):
    arguments = {"K": K, "R": np.eye(3), "t": [0, 0, 0], "width": 10, "height": 10, "name": "left.png", **change}
    with pytest.raises(CaptureError, match=r"left\.png") as caught:
        Camera.from_matrices(**arguments)
    assert caught.value.code == code
