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


@settings(max_examples=30, deadline=None)
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


def test_cameras_on_a_line_have_no_second_coordinate():
    plane = fit_view_plane(cameras_at([[i, 0.001 * (-1) ** i, 0] for i in range(6)]))
    assert plane.is_line
    coordinates = plane.coordinates([[0, 0, 0], [5, 0, 0], [2, 7, 0]])
    np.testing.assert_allclose(coordinates[:2, 0], [-1, 1], atol=1e-3)
    assert (coordinates[:, 1] == 0).all()


def test_a_vertical_line_runs_along_x_too():
    plane = fit_view_plane(cameras_at([[0, i, 0] for i in range(4)]))
    assert plane.is_line and plane.extent[0] == pytest.approx(1.5)
    assert abs(plane.right @ plane.up) < 1e-12


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
