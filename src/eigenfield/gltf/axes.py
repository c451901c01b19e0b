"""From the capture's axes to glTF's (Y up, the array looking along -Z), and the camera a viewer opens on."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera, nearest_rotation
from eigenfield.core.mesh import Mesh
from eigenfield.core.rig import Rig

NEAR_PLANE_RATIO = 0.1  # of the near plane's distance to the nearest vertex's depth


def capture_to_gltf(rig: Rig) -> NDArray[np.float64]:
    """(3, 3) rotation: rows are the world directions that become glTF's x (right), y (up), z (against the view).

    They are those of the view plane. A line of cameras may climb, and has the mean axes of its cameras instead.
    """
    plane = rig.view_plane
    if plane.is_line:
        axes = nearest_rotation(np.mean([camera.R for camera in rig.cameras], axis=0))
        return axes * np.array([[1.0], [-1.0], [-1.0]])  # x right, y down, z forward, as cameras have them
    right = plane.right / np.linalg.norm(plane.right)
    up = plane.up - (plane.up @ right) * right
    up = up / np.linalg.norm(up)
    return np.stack([right, up, np.cross(right, up)])


def quaternion(rotation: NDArray[np.float64]) -> list[float]:
    """A (3, 3) rotation as a unit quaternion x, y, z, w, the largest entry positive.

    The eigenvector of the largest eigenvalue of Bar-Itzhack's symmetric matrix (J. Guidance 23(6), 2000): stable for
    every angle.
    """
    m = rotation
    k = np.array(
        [
            [m[0, 0] - m[1, 1] - m[2, 2], m[0, 1] + m[1, 0], m[0, 2] + m[2, 0], m[2, 1] - m[1, 2]],
            [m[0, 1] + m[1, 0], m[1, 1] - m[0, 0] - m[2, 2], m[1, 2] + m[2, 1], m[0, 2] - m[2, 0]],
            [m[0, 2] + m[2, 0], m[1, 2] + m[2, 1], m[2, 2] - m[0, 0] - m[1, 1], m[1, 0] - m[0, 1]],
            [m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1], m[0, 0] + m[1, 1] + m[2, 2]],
        ]
    )
    vector = np.linalg.eigh(k / 3)[1][:, -1]
    if vector[np.argmax(np.abs(vector))] < 0:
        vector = -vector
    return [float(x) + 0.0 for x in vector]  # + 0.0: no minus zero in the file


def opening_view(camera: Camera, mesh: Mesh) -> tuple[dict[str, Any], NDArray[np.float64]]:
    """A glTF perspective camera that shows what `camera` sees, and its rotation: (3, 3), columns its axes in the world.

    glTF's frustum is symmetric. For a principal point off the middle the camera is therefore turned, about its centre
    and without roll, towards the middle of its photograph: the same object stands in the middle, the edges differ by
    the keystone of that turn. yfov and aspectRatio are the angles that the photograph's middle column and row span,
    seen from there.

    Args:
        mesh: By whose nearest vertex the near plane is placed.
    """
    inverse = np.linalg.inv(camera.K)
    w, h = camera.width, camera.height
    middle, top, bottom, left, right = (
        inverse @ (x, y, 1) for x, y in ((w / 2, h / 2), (w / 2, 0), (w / 2, h), (0, h / 2), (w, h / 2))
    )
    forward = middle / np.linalg.norm(middle)
    x_axis = np.array([1.0, 0, 0]) - forward[0] * forward
    x_axis /= np.linalg.norm(x_axis)
    turned = np.stack([x_axis, np.cross(forward, x_axis), forward])  # rows: x right, y down, z forward
    vertical, horizontal = _angle(top, bottom), _angle(left, right)
    depth = (mesh.vertices.astype(np.float64) - camera.centre) @ camera.R.T @ forward
    nearest = depth[depth > 0].min(initial=np.inf)
    perspective = {
        "yfov": vertical,
        "aspectRatio": float(np.tan(horizontal / 2) / np.tan(vertical / 2)),
        "znear": float(nearest * NEAR_PLANE_RATIO) if np.isfinite(nearest) and nearest > 0 else 0.01,
    }
    axes = (turned @ camera.R).T * (1, -1, -1)  # glTF: y up, looking along -z
    return perspective, axes


def _angle(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))
