"""nerfstudio's and instant-ngp's `transforms.json`, and the original NeRF's.

World: the file's own, unless it names an `applied_transform` (nerfstudio): then that is undone, and the world is the
one from before, in which COLMAP and Metashape write their meshes.
Camera axes: OpenGL (x right, y up, z back), camera-to-world; pixel centres at +0.5.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, escape_name, read_each
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.text import CALIBRATION_MAX_SIDE_PIXELS, read_contents
from eigenfield.core.errors import CaptureError

TRANSFORMS_FILE = "transforms.json"
TRANSFORMS_MAX_BYTES = 256 * 2**20
TRANSFORMS_PERSPECTIVE_MODELS = ("PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV", "PERSPECTIVE")
TRANSFORMS_FISHEYE_MODELS = ("OPENCV_FISHEYE",)
# a lens that no other reader of this format knows: they refuse the name, as they should
TRANSFORMS_OWN_MODEL = "EIGENFIELD"
TRANSFORMS_OWN_COEFFICIENTS = {
    "rational": (8, 12, 14), "metashape": (9,), "metashape-equidistant": (9,), "metashape-equisolid": (9,)
}  # fmt: skip
OPENGL_TO_OPENCV_AXES = np.diag([1.0, -1.0, -1.0])  # OpenGL axes to OpenCV axes


def find_transforms(folder: Path) -> Path | None:
    """The transforms.json of a folder, if it has one."""
    return folder / TRANSFORMS_FILE if (folder / TRANSFORMS_FILE).is_file() else None


def read_transforms(path: Path) -> Calibration:
    """Every frame of a transforms.json as an entry; frames that cannot be used become errors of their own.

    Raises CaptureError (`calibration-missing`, `calibration-too-large`, `calibration-json`, `calibration-empty`,
    `applied-transform`) where the file as a whole cannot be used.
    """
    top = _load_object(path)
    frames = top.get("frames")
    if not isinstance(frames, list):
        raise CaptureError(
            "calibration-json",
            "has no list of frames",
            path=path,
            remedy="name a transforms.json as nerfstudio writes it",
        )
    if not frames:
        raise CaptureError("calibration-empty", "lists no frame", path=path, remedy="name another calibration")
    undo = _read_applied_transform(top, path)
    entries, errors = read_each(lambda item: _make_entry(top, item[1], item[0], path, undo), enumerate(frames))
    return Calibration(path, "transforms", entries, errors)


def _load_object(path: Path) -> dict[str, Any]:
    data = read_contents(path, TRANSFORMS_MAX_BYTES)
    try:
        top = json.loads(data.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:  # broken JSON, broken UTF-8, nested without end
        raise CaptureError(
            "calibration-json", f"is no valid JSON ({_one_line(error)})", path=path, remedy="mend it or export it again"
        ) from error
    if not isinstance(top, dict):
        raise CaptureError(
            "calibration-json",
            "is JSON, but not an object",
            path=path,
            remedy="name a transforms.json as nerfstudio writes it",
        )
    return top


def _one_line(error: Exception) -> str:
    return str(error).splitlines()[0][:120] if str(error) else type(error).__name__


def _make_entry(
    top: Mapping[str, Any],
    frame: Any,
    number: int,
    path: Path,
    undo: tuple[NDArray[np.float64], NDArray[np.float64], float],
) -> Entry:
    label = f"frame {number}"
    if not isinstance(frame, dict):
        raise CaptureError("frame-not-object", f"{label} is not an object", path=path, remedy="mend or remove it")
    file = frame.get("file_path")
    if not isinstance(file, str) or not file or "\0" in file:
        raise CaptureError("frame-file", f"{label} has no usable file_path", path=path, remedy="mend or remove it")
    label = f"frame {number} ({escape_name(file)})"
    mask = frame.get("mask_path")
    if mask is not None and (not isinstance(mask, str) or "\0" in mask):
        raise CaptureError(
            "frame-mask", f"{label} has a mask_path that is no text", path=path, remedy="mend or remove it"
        )
    pose = _parse_pose(frame.get("transform_matrix"), f"transform_matrix of {label}", path)
    intrinsics, lens = _read_intrinsics(top, frame, label, path)
    rotation, shift, scale = undo
    with np.errstate(invalid="ignore", over="ignore"):
        axes = OPENGL_TO_OPENCV_AXES @ (rotation.T @ pose[:, :3]).T
        centre = rotation.T @ (pose[:, 3] / scale - shift)
    return Entry(file.replace("\\", "/"), label, intrinsics, axes, centre, lens, mask and mask.replace("\\", "/"))


def _parse_pose(value: Any, what: str, path: Path) -> NDArray[np.float64]:
    """(3, 4) from nested lists of three or four rows."""
    rows = value if isinstance(value, list) else []
    numbers = all(isinstance(row, list) and len(row) == 4 and all(map(_is_number, row)) for row in rows)
    if len(rows) not in (3, 4) or not numbers:
        raise CaptureError(
            "frame-pose", f"{what} is not 3 or 4 rows of 4 numbers", path=path, remedy="mend or remove the entry"
        )
    matrix = np.array([[_as_float(v) for v in row] for row in rows])
    if len(rows) == 4 and not np.allclose(matrix[3], [0, 0, 0, 1], atol=1e-6):
        raise CaptureError(
            "frame-pose",
            f"the last row of the {what} is not 0 0 0 1",
            path=path,
            remedy="poses are camera-to-world: mend it",
        )
    return matrix[:3]


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _as_float(value: float) -> float:
    try:
        return float(value)
    except OverflowError:  # an integer beyond the range of a double
        return math.inf


def _read_applied_transform(
    top: Mapping[str, Any], path: Path
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """`applied_transform` and `applied_scale` as rotation Q, shift a and scale s: x_file = s (Q x_world + a)."""
    scale = _read_number(top, {}, "applied_scale", "the file", path)
    value = top.get("applied_transform")
    matrix = np.eye(3, 4) if value is None else _parse_pose(value, "applied_transform", path)
    total = 1.0 if scale is None else scale
    grown = np.cbrt(np.linalg.det(matrix[:, :3])) if np.isfinite(matrix).all() else 0.0
    if not (grown > 0 and math.isfinite(total) and total > 0) or not np.allclose(
        matrix[:, :3] @ matrix[:, :3].T, grown**2 * np.eye(3), atol=1e-4 * grown**2
    ):
        raise CaptureError(
            "applied-transform",
            "applied_transform and applied_scale are not a rotation, a shift and a positive scale",
            path=path,
            remedy="mend or remove them",
        )
    return matrix[:, :3] / grown, matrix[:, 3] / grown, total * float(grown)


def _read_number(top: Mapping[str, Any], frame: Mapping[str, Any], key: str, label: str, path: Path) -> float | None:
    value = frame.get(key, top.get(key))
    if value is None:
        return None
    if not _is_number(value):
        raise CaptureError(
            "frame-number", f"{key} of {label} is not a number", path=path, remedy="mend or remove the entry"
        )
    return _as_float(value)


def _read_intrinsics(
    top: Mapping[str, Any], frame: Mapping[str, Any], label: str, path: Path
) -> tuple[Intrinsics, Lens | None]:
    def number(key: str) -> float | None:
        return _read_number(top, frame, key, label, path)

    def length(key: str) -> int | None:
        value = number(key)
        if value is None:
            return None
        if not (1 <= value <= CALIBRATION_MAX_SIDE_PIXELS and value == round(value)):
            raise CaptureError(
                "frame-size", f"{key} of {label} is {value:g}", path=path, remedy="a size is a whole number of pixels"
            )
        return int(value)

    owner: Mapping[str, Any] = frame if {"fl_x", "fl_y", "camera_angle_x"} & frame.keys() else top
    fx, fy = (_read_number({}, owner, key, label, path) for key in ("fl_x", "fl_y"))
    angles = tuple(_read_number({}, owner, key, label, path) for key in ("camera_angle_x", "camera_angle_y"))
    focal, angle = None, None
    if fx is not None or fy is not None:
        focal = (fx if fx is not None else fy, fy if fy is not None else fx)
    elif angles[0] is not None:
        if not all(0 < a < math.pi for a in angles if a is not None):
            raise CaptureError(
                "frame-angle", f"the camera angles of {label} are not between 0 and pi", path=path, remedy="mend them"
            )
        angle = (angles[0], angles[1])
    else:
        raise CaptureError(
            "frame-focal",
            f"{label} has neither fl_x nor camera_angle_x",
            path=path,
            remedy="add the focal length, in pixels",
        )
    size = (length("w"), length("h"))
    intrinsics = Intrinsics(*size, focal, angle, (number("cx"), number("cy")))  # type: ignore[arg-type]
    return intrinsics, _read_lens(top, frame, label, path)


def _read_lens(top: Mapping[str, Any], frame: Mapping[str, Any], label: str, path: Path) -> Lens | None:
    model = frame.get("camera_model", top.get("camera_model", "OPENCV"))
    if model == TRANSFORMS_OWN_MODEL:
        return _read_own_lens(frame.get("lens", top.get("lens")), label, path)
    fisheye = model in TRANSFORMS_FISHEYE_MODELS or bool(frame.get("is_fisheye", top.get("is_fisheye", False)))
    if not fisheye and model not in TRANSFORMS_PERSPECTIVE_MODELS:
        raise CaptureError(
            "camera-model",
            f"{label} has the camera model {model!r}, which is not read",
            path=path,
            remedy=f"undistort it to {', '.join(TRANSFORMS_PERSPECTIVE_MODELS[:5])} or {TRANSFORMS_FISHEYE_MODELS[0]}",
        )
    k1, k2, k3, k4, p1, p2 = (
        _read_number(top, frame, key, label, path) or 0.0 for key in ("k1", "k2", "k3", "k4", "p1", "p2")
    )
    if not all(map(math.isfinite, (k1, k2, k3, k4, p1, p2))):
        raise CaptureError("lens", f"{label} has lens coefficients that are not finite", path=path, remedy="mend them")
    if fisheye:
        return Lens("fisheye", (k1, k2, k3, k4))
    if k4:
        raise CaptureError(
            "camera-model",
            f"{label} has k4 without camera_model OPENCV_FISHEYE",
            path=path,
            remedy="name the camera model, or undistort",
        )
    lens = Lens("brown", (k1, k2, p1, p2, k3))
    return None if lens.is_identity else lens


def _read_own_lens(value: Any, label: str, path: Path) -> Lens:
    """A lens as `writers.transforms` writes it."""
    model, numbers = (value.get("model"), value.get("coefficients")) if isinstance(value, dict) else (None, None)
    if model not in TRANSFORMS_OWN_COEFFICIENTS or not isinstance(numbers, list) or not all(map(_is_number, numbers)):
        raise CaptureError("lens", f"{label} has no lens that is known", path=path, remedy="mend or remove its entry")
    coefficients = tuple(_as_float(number) for number in numbers)
    if len(coefficients) not in TRANSFORMS_OWN_COEFFICIENTS[model] or not all(map(math.isfinite, coefficients)):
        raise CaptureError(
            "lens", f"{label} has lens coefficients that are not finite or not as many as needed", path=path,
            remedy="mend them",
        )  # fmt: skip
    return Lens(model, coefficients)
