"""What other glTF viewers see first: axes, rotations, the opening view."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.rig import Rig
from eigenfield.core.viewplane import ViewPlane, fit_view_plane
from eigenfield.gltf import save
from eigenfield.gltf.axes import capture_to_gltf, opening_view, quaternion
from support import glb_surgery
from support.scenes import bumpy_square, row_grid, tiny_scene


@given(st.integers(0, 2**32 - 1))
@settings(max_examples=50)
def test_quaternions_are_rotations(seed):
    q = np.random.default_rng(seed).normal(size=4)
    q /= np.linalg.norm(q)
    x, y, z, w = q
    rotation = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
    found = np.array(quaternion(rotation))
    assert min(np.abs(found - q).max(), np.abs(found + q).max()) < 1e-7
    assert found[np.argmax(np.abs(found))] > 0


def rig_of(cameras, plane=None):
    none = np.zeros((0, 3), np.int32)
    names = tuple(f"{number}.png" for number in range(len(cameras)))
    return Rig(names, tuple(cameras), np.zeros(len(cameras), bool), 0, plane or fit_view_plane(cameras), none)


def test_the_array_looks_along_minus_z_with_y_up():
    turn = capture_to_gltf(rig_of(row_grid(9)))
    np.testing.assert_allclose(turn @ [0, 0, 1], [0, 0, -1], atol=1e-12)  # the cameras' forward
    np.testing.assert_allclose(turn @ [0, 1, 0], [0, -1, 0], atol=1e-12)  # their down
    np.testing.assert_allclose(np.linalg.det(turn), 1)


def test_axes_of_any_length_and_angle_give_a_rotation():
    plane = ViewPlane(np.zeros(3), np.array([2, 0.1, 0]), np.array([0.3, -1.5, 0.2]), np.ones(2))
    turn = capture_to_gltf(rig_of(row_grid(9), plane))
    np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(turn) == pytest.approx(1)
    np.testing.assert_allclose(turn @ plane.right, [np.hypot(2, 0.1), 0, 0], atol=1e-12)
    x, y, z = turn @ plane.up  # in the plane of both, on its own side
    assert y > 1.5 and abs(z) < 1e-12 and x == pytest.approx(plane.right @ plane.up / np.hypot(2, 0.1))


@pytest.mark.parametrize("direction", [(1, 0, 0), (0, 1, 0), (0.9, 0.4, 0), (0, 0, 1)])
def test_a_line_of_cameras_is_upright_wherever_it_climbs(direction):
    camera = row_grid(1)[0]
    rig = rig_of([replace(camera, t=camera.t - step * np.array(direction)) for step in (-0.5, 0.0, 0.5)])
    assert rig.view_plane.is_line
    np.testing.assert_allclose(capture_to_gltf(rig), np.diag([1, -1, -1]), atol=1e-12)


def test_the_opening_view_is_the_photograph_where_gltf_can_say_it():
    K = np.array([[70.0, 0, 32], [0, 50, 24], [0, 0, 1]])
    camera = Camera(K, np.eye(3), np.array([0, 0, 3.0]), 64, 48)
    perspective, axes = opening_view(camera, bumpy_square())
    np.testing.assert_allclose(perspective["yfov"], 2 * np.arctan(24 / 50))
    np.testing.assert_allclose(perspective["aspectRatio"], (32 / 70) / (24 / 50))
    np.testing.assert_allclose(axes, np.diag([1, -1, -1]), atol=1e-12)
    assert 0 < perspective["znear"] < 3


@pytest.mark.parametrize(("depths", "near"), [((-0.5, 0.5, 5), 0.05), ((-3, -1, -2), 0.01)])
def test_the_near_plane_is_before_what_is_before_the_camera(depths, near):
    mesh = Mesh(np.array([[0, 0, z] for z in depths], np.float32), np.array([[0, 1, 2]], np.int32))
    camera = Camera(np.array([[60.0, 0, 32], [0, 60, 24], [0, 0, 1]]), np.eye(3), np.zeros(3), 64, 48)
    assert opening_view(camera, mesh)[0]["znear"] == pytest.approx(near)


def test_the_opening_view_aims_at_the_photographs_middle():
    random = np.random.default_rng(3)
    R = np.linalg.qr(random.normal(size=(3, 3)))[0]
    R *= np.sign(np.linalg.det(R))
    camera = Camera(np.array([[60.0, 0, 5], [0, 60, 70], [0, 0, 1]]), R, np.zeros(3), 64, 48)
    _, axes = opening_view(camera, bumpy_square())
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(axes), 1)
    pixel, depth = camera.project([-axes[:, 2]])  # a glTF camera looks along -z
    assert depth[0] > 0
    np.testing.assert_allclose(pixel[0], (32, 24), atol=1e-9)
    assert axes[:, 1] @ -R[1] > 0 and axes[:, 0] @ R[0] > 0.7  # upright


def turned(quaternion_xyzw: list[float], points: np.ndarray) -> np.ndarray:
    axis, w = np.array(quaternion_xyzw[:3]), quaternion_xyzw[3]
    return points + 2 * np.cross(axis, np.cross(axis, points) + w * points)


def test_a_gltf_viewer_opens_on_what_the_reference_camera_saw(tmp_path):
    """Nodes and perspective of the file, as a viewer applies them, against the camera's own projection."""
    scene = tiny_scene()
    R = turned([0.1, -0.2, 0.05, np.sqrt(1 - 0.0525)], np.eye(3)).T
    camera = Camera(np.array([[55.0, 0, 24], [0, 50, 20], [0, 0, 1]]), R, np.array([0.1, -0.2, 3]), 48, 40)
    others = scene.rig.cameras[1:]
    scene = replace(
        scene,
        rig=replace(scene.rig, cameras=(camera, *others), reference=0, view_plane=fit_view_plane([camera, *others])),
    )
    save(scene, tmp_path / "scene.glb")
    gltf, _ = glb_surgery.split((tmp_path / "scene.glb").read_bytes())
    proxy, eye = gltf["nodes"]
    assert (proxy["mesh"], eye["camera"]) == (0, 0)
    world = turned(proxy["rotation"], scene.proxy.mesh.vertices.astype(np.float64))
    x, y, z, w = eye["rotation"]
    seen = turned([-x, -y, -z, w], world - eye["translation"])
    perspective = gltf["cameras"][0]["perspective"]
    half = np.tan(perspective["yfov"] / 2)
    clip = seen[:, :2] / (-seen[:, 2:] * half * np.array([perspective["aspectRatio"], 1]))
    pixels, depth = camera.project(scene.proxy.mesh.vertices)
    assert depth.min() > perspective["znear"]
    np.testing.assert_allclose((clip * (1, -1) + 1) / 2 * (48, 40), pixels, atol=1e-6)


def test_a_scene_that_stands_as_gltf_has_it_needs_no_rotation(tmp_path):
    K, upright = np.array([[50.0, 0, 24], [0, 50, 20], [0, 0, 1]]), np.diag([1.0, -1, -1])  # y up, looking along -z
    places = [(x, y, 3.0) for y in (-0.1, 0.1) for x in (-0.1, 0.1)]
    cameras = tuple(Camera(K, upright, -upright @ np.array(place), 48, 40) for place in places)
    scene = replace(
        tiny_scene(cameras=4),
        rig=replace(tiny_scene(cameras=4).rig, cameras=cameras, view_plane=fit_view_plane(cameras)),
    )
    save(scene, tmp_path / "scene.glb")
    gltf, _ = glb_surgery.split((tmp_path / "scene.glb").read_bytes())
    assert not any("rotation" in node for node in gltf["nodes"])
    np.testing.assert_allclose(gltf["nodes"][1]["translation"], places[scene.rig.reference], atol=1e-7)
