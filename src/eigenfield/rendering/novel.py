"""A camera at a viewpoint between the captured ones."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.scene import Scene
from eigenfield.rendering.weights import place_weights


def novel_camera(scene: Scene, at: tuple[float, float]) -> Camera:
    """The camera at a viewpoint, as large as the reference camera.

    Its centre is the point of the view plane. K is the mean of the captured cameras' with Delaunay weights: in a
    rectified array the principal point moves with the camera, which keeps the plane of zero parallax in its place. R is
    the rotation nearest to their weighted mean.

    Args:
        scene: The scene.
        at: View-plane coordinates, clamped to the array's [-1, 1].

    Raises:
        OptionError: `viewpoint`.
    """
    cameras, weights = place_weights(scene, at)
    x, y = np.clip(np.asarray(at, dtype=np.float64), -1.0, 1.0)
    reference = scene.rig.cameras[scene.rig.reference]
    K, R = np.zeros((3, 3)), np.zeros((3, 3))
    for index, weight in zip(cameras, weights, strict=True):
        camera = scene.rig.cameras[index].resize(reference.width, reference.height)
        K += weight * camera.K
        R += weight * camera.R
    rotation = nearest_rotation(R)
    centre = scene.rig.view_plane.point(float(x), float(y))
    return Camera(K, rotation, -rotation @ centre, reference.width, reference.height)


def nearest_rotation(matrix: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3) the rotation nearest to a matrix, by least squares (polar decomposition).

    Args:
        matrix: (3, 3).
    """
    u, _, vt = np.linalg.svd(matrix)
    turn = np.array([1.0, 1.0, np.sign(np.linalg.det(u @ vt))])
    rotation: NDArray[np.float64] = (u * turn) @ vt
    return rotation
