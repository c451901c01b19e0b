"""Similarity alignment of camera centres, the error of a calibration against ground truth, and a canonical gauge."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.capture.lightfield import LightField
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError

F64 = NDArray[np.float64]


def align_similarity(source: ArrayLike, target: ArrayLike) -> tuple[float, F64, F64]:
    """The similarity that best maps one set of points onto another.

    It minimises sum |target - (s R source + t)|^2: Umeyama, *Least-Squares Estimation of Transformation Parameters
    Between Two Point Patterns*, PAMI 1991. Points on a line leave the rotation about it open; then the smallest
    rotation that fits is returned.

    Args:
        source: (n, 3) points, n >= 3.
        target: (n, 3) the points they correspond to.

    Returns:
        Scale s, rotation R (3, 3) and shift t (3,).

    Raises:
        CaptureError: `align`: too few points, or all in one place.
    """
    x, y = np.asarray(source, np.float64), np.asarray(target, np.float64)
    if x.shape != y.shape or x.ndim != 2 or x.shape[1] != 3 or len(x) < 3:
        raise CaptureError("align", f"{len(x)} and {len(y)} points cannot be aligned", remedy="give 3 or more pairs")
    middle_x, middle_y = x.mean(axis=0), y.mean(axis=0)
    spread = ((x - middle_x) ** 2).sum()
    if not spread > 0 or not np.isfinite(spread):
        raise CaptureError("align", "all cameras stand in one place", remedy="give cameras that stand apart")
    u, d, vt = np.linalg.svd((y - middle_y).T @ (x - middle_x))
    sign = np.ones(3)
    if np.linalg.det(u @ vt) < 0:
        sign[2] = -1
    R = u @ np.diag(sign) @ vt
    scale = float((d * sign).sum() / spread)
    return scale, R, middle_y - scale * (R @ middle_x)


@dataclass(frozen=True, eq=False)
class CalibrationError:
    """Errors of cameras against ground truth, after a similarity fit of their centres.

    Attributes:
        names: The n cameras in both calibrations.
        rotation: (n,) degrees.
        position: (n,) distance over the diagonal of the box around the true centres.
        focal: (n,) estimated over true focal length, minus one.
    """

    names: tuple[str, ...]
    rotation: F64
    position: F64
    focal: F64


def calibration_error(estimated: LightField, truth: LightField) -> CalibrationError:
    """Compare cameras by name; cameras in only one light field are left out.

    Raises:
        CaptureError: `align`: fewer than three common cameras, or all in one place.
    """
    true = dict(zip(truth.names, truth.cameras, strict=True))
    names = tuple(name for name in estimated.names if name in true)
    ours = [camera for name, camera in zip(estimated.names, estimated.cameras, strict=True) if name in true]
    theirs = [true[name] for name in names]
    centres = np.array([camera.centre for camera in theirs]).reshape(-1, 3)
    scale, R, t = align_similarity(np.array([camera.centre for camera in ours]).reshape(-1, 3), centres)
    extent = float(np.linalg.norm(np.ptp(centres, axis=0)))
    moved = [transform_camera(camera, scale, R, t) for camera in ours]
    rotation = np.array([angle_between(a.R, b.R) for a, b in zip(moved, theirs, strict=True)])
    position = np.array([np.linalg.norm(a.centre - b.centre) for a, b in zip(moved, theirs, strict=True)]) / extent
    focal = np.array([a.K[0, 0] / b.K[0, 0] - 1 for a, b in zip(ours, theirs, strict=True)])
    return CalibrationError(names, rotation, position, focal)


def angle_between(first: F64, second: F64) -> float:
    """The angle in degrees of the rotation that takes one to the other.

    Args:
        first: (3, 3) rotation.
        second: (3, 3) rotation.
    """
    difference = first @ second.T
    # the sine from the antisymmetric part: the arc cosine of the trace loses half the digits near zero
    axis = np.array([
        difference[2, 1] - difference[1, 2], difference[0, 2] - difference[2, 0], difference[1, 0] - difference[0, 1]
    ])  # fmt: skip
    return float(np.degrees(np.arctan2(np.linalg.norm(axis), np.trace(difference) - 1)))


def transform_camera(camera: Camera, scale: float, R: F64, t: F64) -> Camera:
    """The camera in the world x' = scale R x + t: it sees the transformed points where it saw the old ones.

    Args:
        R: (3, 3) rotation of the similarity.
        t: (3,) shift of the similarity.
    """
    rotated = camera.R @ R.T
    centre = scale * (R @ camera.centre) + t
    return Camera(camera.K, rotated, -(rotated @ centre), camera.width, camera.height)


def natural_gauge(cameras: Sequence[Camera]) -> tuple[float, F64, F64]:
    """The similarity into a world that depends on the cameras alone.

    The origin is the mean of their centres. The axes are the rotation nearest to the sum of theirs (x right, y down,
    z forward); of a ring that looks inwards only the vertical remains. The unit is the median distance from a camera to
    its nearest neighbour, ignoring cameras in the same place.

    Args:
        cameras: At least one.

    Returns:
        Scale, rotation (3, 3) and shift (3,).
    """
    centres = np.array([camera.centre for camera in cameras])
    u, _, vt = np.linalg.svd(sum(camera.R for camera in cameras))
    if np.linalg.det(u @ vt) < 0:
        u[:, 2] *= -1
    R = u @ vt
    middle = centres.mean(axis=0)
    extent = float(np.linalg.norm(np.ptp(centres, axis=0)))
    distance = np.linalg.norm(centres[:, None] - centres[None], axis=2)
    distance[distance <= 1e-6 * extent] = np.inf
    nearest = distance.min(axis=1)
    apart = nearest[np.isfinite(nearest)]
    scale = 1.0 / float(np.median(apart)) if len(apart) else 1.0
    return scale, R, -scale * (R @ middle)
