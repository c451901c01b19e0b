"""What readers of calibrations return: an entry for each camera, before any photograph is searched."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.photographs.lens import Lens
from eigenfield.core.camera import CAMERA_ROTATION_TOLERANCE, Camera
from eigenfield.core.errors import CaptureError

T = TypeVar("T")
Made = TypeVar("Made")

# of focal lengths in pixels and positions in world units: products of two of them stay finite, and a file keeps float32
CALIBRATION_MAX_MAGNITUDE = 1e30
CALIBRATION_FOCAL_TOLERANCE = 0.02  # by which a focal length and an angle of view may differ
# of singular values: three decimals move nine entries by 0.0005 each, singular values by 0.0015 and axes by 0.1 degrees
CALIBRATION_ROTATION_TOLERANCE = 2e-3


def split_scale(matrix: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """The rotation nearest to a matrix of a uniform scale or of three decimals, and the scale.

    Args:
        matrix: (3, 3).

    Returns:
        (3, 3), and the positive scale. The matrix itself and 1 where it is a rotation already, and where it is
        mirrored, sheared or no matrix at all, which `Camera.from_matrices` refuses.
    """
    if not np.isfinite(matrix).all():
        return matrix, 1.0
    with np.errstate(all="ignore"):
        u, s, vt = np.linalg.svd(matrix)
        scale = float(np.cbrt(s.prod()))
        uneven = np.abs(s / scale - 1).max()
        mirrored = np.linalg.det(u @ vt) < 0
    if np.abs(s - 1).max() <= CAMERA_ROTATION_TOLERANCE or mirrored or not uneven <= CALIBRATION_ROTATION_TOLERANCE:
        return matrix, 1.0
    return u @ vt, 1.0 if abs(scale - 1) <= CALIBRATION_ROTATION_TOLERANCE else scale


@dataclass(frozen=True)
class Intrinsics:
    """Intrinsics as far as a calibration states them.

    Attributes:
        width: Of the photograph they are for, pixels; None where the calibration does not state it.
        focal: (fx, fy) pixels, or None where `angle` gives it.
        angle: (horizontal, vertical or None) full field of view, radians; beside a focal length a second statement.
        principal: (cx, cy) pixels, each None for the middle.
    """

    width: int | None
    height: int | None
    focal: tuple[float, float] | None
    angle: tuple[float, float | None] | None
    principal: tuple[float | None, float | None]

    @staticmethod
    def of_matrix(K: NDArray[np.float64], width: int | None = None, height: int | None = None) -> Intrinsics:
        """Those of a (3, 3) camera matrix without skew."""
        focal, principal = (float(K[0, 0]), float(K[1, 1])), (float(K[0, 2]), float(K[1, 2]))
        return Intrinsics(width, height, focal, None, principal)

    def contradiction(self, width: int, height: int) -> tuple[float, float] | None:
        """A focal length as stated and as the angle has it, pixels, where both are stated and differ."""
        if self.focal is None or self.angle is None:
            return None
        axes = zip(self.focal, self._focal_of_angle(width, height), self.angle, strict=True)
        stated = ((one, other) for one, other, angle in axes if angle is not None)
        return next((p for p in stated if not math.isclose(*p, rel_tol=CALIBRATION_FOCAL_TOLERANCE)), None)

    def _focal_of_angle(self, width: int, height: int) -> tuple[float, float]:
        assert self.angle is not None
        fx = width / (2 * math.tan(self.angle[0] / 2))
        return fx, fx if self.angle[1] is None else height / (2 * math.tan(self.angle[1] / 2))

    def matrix(self, width: int, height: int) -> NDArray[np.float64]:
        """(3, 3) K at the size that the calibration is for."""
        fx, fy = self._focal_of_angle(width, height) if self.focal is None else self.focal
        cx = width / 2 if self.principal[0] is None else self.principal[0]
        cy = height / 2 if self.principal[1] is None else self.principal[1]
        return np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])


@dataclass(frozen=True, eq=False)
class Entry:
    """One camera of a calibration, not yet checked.

    Attributes:
        file: The photograph's path as the calibration writes it, with forward slashes.
        R: (3, 3) world-to-camera rotation, OpenCV axes; possibly with a scale or few digits, as `split_scale` takes it.
        centre: (3,) the camera's centre in the world.
        lens: The photograph's distortion; None if there is none.
        mask: The mask's path as the calibration writes it.
        bounds: Nearest and farthest depth of the scene from this camera, where the calibration states them.
        stored: The program that wrote the entry works on pixels as they are stored. Otherwise the camera is of the
            photograph that its EXIF orientation turns upright. Sizes that fit one of the two alone decide first.
        time: When the photograph was taken, seconds; None where the calibration does not state it.
    """

    file: str
    label: str
    intrinsics: Intrinsics
    R: NDArray[np.float64]
    centre: NDArray[np.float64]
    lens: Lens | None = None
    mask: str | None = None
    bounds: tuple[float, float] | None = None
    stored: bool = False
    time: float | None = None

    def camera(self, width: int, height: int, path: Path) -> Camera:
        """The camera at the calibration's own size; CaptureError naming `path`, the calibration, if it cannot be."""
        K = self.intrinsics.matrix(width, height)
        # False for NaN: `from_matrices` finds those
        if max(np.abs(K).max(), np.abs(self.centre).max()) > CALIBRATION_MAX_MAGNITUDE:
            raise CaptureError(
                "camera-not-finite",
                f"camera {self.label} has entries beyond {CALIBRATION_MAX_MAGNITUDE:g}",
                path=path,
                remedy="mend or remove its entry",
            )
        try:
            with np.errstate(all="ignore"):  # NaN, infinities and singular matrices are what `from_matrices` looks for
                R, _ = split_scale(self.R)
                camera = Camera.from_matrices(K, R, -(R @ self.centre), width, height, self.label)
        except CaptureError as error:
            raise CaptureError(error.code, error.message, path=path, remedy=error.remedy) from None
        # the centre is what a calibration knows well: keep it where checking snapped a rotation of few digits
        return replace(camera, t=-(camera.R @ self.centre))


@dataclass(frozen=True)
class Calibration:
    """All entries of one calibration.

    Attributes:
        entries: One for each camera that can be used.
        errors: One for each entry that cannot be used.
        rate: Frames a second of entries that state a time; None where the calibration does not state it.
    """

    path: Path
    format: str
    entries: tuple[Entry, ...]
    errors: tuple[CaptureError, ...] = ()
    problems: tuple[str, ...] = ()
    rate: float | None = None


def read_each(read: Callable[[T], Entry], items: Iterable[T]) -> tuple[tuple[Entry, ...], tuple[CaptureError, ...]]:
    """The entries that `read` makes of items, and the errors that it raises for others, which stop nothing."""
    outcomes = list(map(or_error(read), items))
    entries = tuple(outcome for outcome in outcomes if isinstance(outcome, Entry))
    return entries, tuple(outcome for outcome in outcomes if isinstance(outcome, CaptureError))


def or_error(read: Callable[[T], Made]) -> Callable[[T], Made | CaptureError]:
    """`read`, but a CaptureError is returned and not raised."""

    def attempt(item: T) -> Made | CaptureError:
        try:
            return read(item)
        except CaptureError as error:
            return error

    return attempt
