"""nerfstudio's and instant-ngp's `transforms.json`, and the original NeRF's.

World: the file's own, unless it names an `applied_transform` (nerfstudio): then that is undone, and the world is the
one from before, in which COLMAP and Metashape write their meshes.
Camera axes: OpenGL (x right, y up, z back), camera-to-world; pixel centres at +0.5.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, read_each
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.lens_keys import lens_keys, letters
from eigenfield.capture.readers.text import CALIBRATION_MAX_SIDE_PIXELS, excerpt, read_contents, read_head
from eigenfield.core.errors import CaptureError, one_line

TRANSFORMS_FILE = "transforms.json"
TRANSFORMS_SPLIT_FILES = tuple(f"transforms_{split}.json" for split in ("train", "val", "test"))  # of NeRF's sets
TRANSFORMS_HEAD_BYTES = 64 * 1024  # in which the first pose must stand
TRANSFORMS_MAX_BYTES = 256 * 2**20
TRANSFORMS_RATIONAL_MODEL = "FULL_OPENCV"
TRANSFORMS_PERSPECTIVE_MODELS = (
    "PINHOLE", "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "OPENCV", TRANSFORMS_RATIONAL_MODEL, "PERSPECTIVE"
)  # fmt: skip
TRANSFORMS_FISHEYE_MODELS = ("OPENCV_FISHEYE", "SIMPLE_RADIAL_FISHEYE", "RADIAL_FISHEYE")
TRANSFORMS_LENS_KEYS = ("k1", "k2", "k3", "k4", "p1", "p2")  # in the order of nerfstudio's distortion_params
TRANSFORMS_READ_LENS_KEYS = {
    *TRANSFORMS_LENS_KEYS, "k5", "k6", "distortion_params", "is_fisheye", "camera_model", "frames"
}  # fmt: skip
# a lens that no other reader of this format knows: they refuse the name, as they should
TRANSFORMS_OWN_MODEL = "EIGENFIELD"
TRANSFORMS_MODELS_BY_LETTERS = {
    letters(model): model
    for model in (*TRANSFORMS_PERSPECTIVE_MODELS, *TRANSFORMS_FISHEYE_MODELS, TRANSFORMS_OWN_MODEL)
}
TRANSFORMS_OWN_COEFFICIENTS = {
    "rational": (8, 12, 14), "metashape": (9,), "metashape-equidistant": (9,), "metashape-equisolid": (9,)
}  # fmt: skip
TRANSFORMS_TURNED_KEY = "exif_orientation_applied"  # of a frame, our own: its photograph was turned upright
Similarity = tuple[NDArray[np.float64], NDArray[np.float64], float]  # rotation, shift, scale
OPENGL_TO_OPENCV_AXES = np.diag([1.0, -1.0, -1.0])  # OpenGL axes to OpenCV axes


def find_transforms(folder: Path) -> Path | None:
    """The transforms.json of a folder; the folder itself where it has the files of NeRF's splits instead."""
    if (folder / TRANSFORMS_FILE).is_file():
        return folder / TRANSFORMS_FILE
    return folder if _split_files(folder) else None


def is_transforms(path: Path) -> bool:
    """Whether a file begins as a transforms.json with poses."""
    return b'"transform_matrix"' in read_head(path, TRANSFORMS_HEAD_BYTES)


def _split_files(folder: Path) -> list[Path]:
    return [folder / name for name in TRANSFORMS_SPLIT_FILES if is_transforms(folder / name)]


def read_transforms(path: Path) -> Calibration:
    """Every frame of a transforms.json as an entry; frames that cannot be used become errors of their own. Of a folder,
    the frames of all its splits, each photograph once.

    Raises CaptureError (`calibration-missing`, `calibration-too-large`, `calibration-json`, `calibration-empty`,
    `applied-transform`) where the file as a whole cannot be used.
    """
    if path.is_dir():
        return _read_splits(path)
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
    strange = tuple(lens_keys(top, TRANSFORMS_READ_LENS_KEYS))

    def make(item: tuple[int, Any]) -> Entry:
        number, own = item
        inside = own if isinstance(own, dict) else {}
        frame = _Frame(inside, top, f"frame {number}", path, tuple(key for key in strange if key not in inside))
        return _make_entry(frame, own, undo)

    entries, errors = read_each(make, enumerate(frames))
    return Calibration(path, "transforms", entries, errors)


def _read_splits(folder: Path) -> Calibration:
    files = _split_files(folder)
    read = [read_transforms(path) for path in files]
    entries: dict[str, Entry] = {}
    for calibration in read:
        for entry in calibration.entries:
            entries.setdefault(entry.file, entry)
    errors = tuple(error for calibration in read for error in calibration.errors)
    names = ", ".join(path.name for path in files)
    lines = (f"{names} are read together; name one of them to read it alone",) if len(files) > 1 else ()
    return Calibration(folder, "transforms", tuple(entries.values()), errors, lines)


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


@dataclass(frozen=True)
class _Frame:
    """One frame, with what it inherits from the top of the file.

    Attributes:
        own: The frame's own values.
        top: Those of the file, where the frame has none.
        top_lens_keys: Of those of the file, what looks like a lens and is not read.
    """

    own: Mapping[str, Any]
    top: Mapping[str, Any]
    label: str
    path: Path
    top_lens_keys: tuple[str, ...] = ()

    def get(self, key: str, default: Any = None) -> Any:
        return self.own[key] if key in self.own else self.top.get(key, default)

    def number(self, key: str) -> float | None:
        value = self.get(key)
        if value is None:
            return None
        if not _is_number(value):
            raise self.error("frame-number", f"{key} of {self.label} is not a number")
        return _as_float(value)

    def length(self, key: str) -> int | None:
        value = self.number(key)
        if value is None:
            return None
        if not (1 <= value <= CALIBRATION_MAX_SIDE_PIXELS and value == round(value)):
            message = f"{key} of {self.label} is {value:g}"
            raise self.error("frame-size", message, "a size is a whole number of pixels")
        return int(value)

    def pose(self, key: str, what: str) -> NDArray[np.float64]:
        """(3, 4) from nested lists of three or four rows."""
        value = self.own.get(key)
        rows = value if isinstance(value, list) else []
        numbers = all(isinstance(row, list) and len(row) == 4 and all(map(_is_number, row)) for row in rows)
        if len(rows) not in (3, 4) or not numbers:
            raise self.error("frame-pose", f"{what} is not 3 or 4 rows of 4 numbers")
        matrix = np.array([[_as_float(v) for v in row] for row in rows])
        if len(rows) == 4 and not np.allclose(matrix[3], [0, 0, 0, 1], atol=1e-6):
            message = f"the last row of the {what} is not 0 0 0 1"
            raise self.error("frame-pose", message, "poses are camera-to-world: mend it")
        return matrix[:3]

    def error(self, code: str, message: str, remedy: str = "mend or remove the entry") -> CaptureError:
        return CaptureError(code, message, path=self.path, remedy=remedy)


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _as_float(value: float) -> float:
    try:
        return float(value)
    except OverflowError:  # an integer beyond the range of a double
        return math.inf


def _make_entry(frame: _Frame, own: Any, undo: Similarity) -> Entry:
    if not isinstance(own, dict):
        raise frame.error("frame-not-object", f"{frame.label} is not an object", "mend or remove it")
    file = own.get("file_path")
    if not isinstance(file, str) or not file or "\0" in file:
        raise frame.error("frame-file", f"{frame.label} has no usable file_path", "mend or remove it")
    frame = replace(frame, label=f"{frame.label} ({one_line(file)})")
    mask = own.get("mask_path")
    if mask is not None and (not isinstance(mask, str) or "\0" in mask):
        raise frame.error("frame-mask", f"{frame.label} has a mask_path that is no text", "mend or remove it")
    pose = frame.pose("transform_matrix", f"transform_matrix of {frame.label}")
    intrinsics, lens = _read_intrinsics(frame), _read_lens(frame)
    rotation, shift, scale = undo
    with np.errstate(invalid="ignore", over="ignore"):
        axes = OPENGL_TO_OPENCV_AXES @ (rotation.T @ pose[:, :3]).T
        centre = rotation.T @ (pose[:, 3] / scale - shift)
    mask = mask and mask.replace("\\", "/")
    stored = frame.get(TRANSFORMS_TURNED_KEY) is not True
    return Entry(file.replace("\\", "/"), frame.label, intrinsics, axes, centre, lens, mask, stored=stored)


def _read_applied_transform(top: Mapping[str, Any], path: Path) -> Similarity:
    """`applied_transform` and `applied_scale` as rotation Q, shift a and scale s: x_file = s (Q x_world + a)."""
    file = _Frame(top, {}, "the file", path)
    scale = file.number("applied_scale")
    is_given = top.get("applied_transform") is not None
    matrix = file.pose("applied_transform", "applied_transform") if is_given else np.eye(3, 4)
    total = 1.0 if scale is None else scale
    grown = np.cbrt(np.linalg.det(matrix[:, :3])) if np.isfinite(matrix).all() else 0.0
    if not (grown > 0 and math.isfinite(total) and total > 0) or not np.allclose(
        matrix[:, :3] @ matrix[:, :3].T, grown**2 * np.eye(3), atol=1e-4 * grown**2
    ):
        message = "applied_transform and applied_scale are not a rotation, a shift and a positive scale"
        raise file.error("applied-transform", message, "mend or remove them")
    return matrix[:, :3] / grown, matrix[:, 3] / grown, total * float(grown)


def _read_intrinsics(frame: _Frame) -> Intrinsics:
    # focal length and angle come from the frame if it has any of them, and are not mixed with those of the file
    own = any(key in frame.own for key in ("fl_x", "fl_y", "camera_angle_x", "x_fov"))
    owner = _Frame(frame.own if own else frame.top, {}, frame.label, frame.path)
    fx, fy = owner.number("fl_x"), owner.number("fl_y")
    focal = None
    if fx is not None or fy is not None:
        focal = (fx if fx is not None else fy, fy if fy is not None else fx)
    angle = _read_angle(owner, focal is None)
    if focal is None and angle is None:
        message = f"{frame.label} has neither fl_x nor camera_angle_x"
        raise frame.error("frame-focal", message, "add the focal length, in pixels")
    size, principal = (frame.length("w"), frame.length("h")), (frame.number("cx"), frame.number("cy"))
    return Intrinsics(*size, focal, angle, principal)  # type: ignore[arg-type]


def _read_angle(owner: _Frame, required: bool) -> tuple[float, float | None] | None:
    """Full angles of view, radians; None where the horizontal one is not stated.

    Those that are none are an error where they are `required`, and else left out: the focal length is there too.
    """
    for keys, unit in ((("camera_angle_x", "camera_angle_y"), 1.0), (("x_fov", "y_fov"), math.pi / 180)):
        x, y = (None if angle is None else angle * unit for angle in map(owner.number, keys))
        if x is None:
            continue
        if all(0 < angle < math.pi for angle in (x, y) if angle is not None):
            return x, y
        if required:
            message = f"the camera angles of {owner.label} are not between 0 and 180 degrees"
            raise owner.error("frame-angle", message, "mend them")
    return None


def _read_lens(frame: _Frame) -> Lens | None:
    given = frame.own.get("camera_model") or frame.top.get("camera_model") or "OPENCV"  # null is no model
    model = TRANSFORMS_MODELS_BY_LETTERS.get(letters(given)) if isinstance(given, str) else None
    if model == TRANSFORMS_OWN_MODEL:
        return _read_own_lens(frame)
    fisheye = model in TRANSFORMS_FISHEYE_MODELS or bool(frame.get("is_fisheye", False))
    if not fisheye and model not in TRANSFORMS_PERSPECTIVE_MODELS:
        raise frame.error(
            "camera-model",
            f"{frame.label} has the camera model {excerpt(given)!r}, which is not read",
            f"undistort it to {', '.join(TRANSFORMS_PERSPECTIVE_MODELS[:5])} or {TRANSFORMS_FISHEYE_MODELS[0]}",
        )
    unread = [*lens_keys(frame.own, TRANSFORMS_READ_LENS_KEYS), *frame.top_lens_keys]
    k1, k2, k3, k4, p1, p2 = _read_coefficients(frame)
    k5, k6 = (frame.number(key) or 0.0 for key in ("k5", "k6"))
    if not all(map(math.isfinite, (k1, k2, k3, k4, k5, k6, p1, p2))):
        raise frame.error("lens", f"{frame.label} has lens coefficients that are not finite", "mend them")
    if fisheye:
        unread += [key for key, value in (("k5", k5), ("k6", k6), ("p1", p1), ("p2", p2)) if value]
    if unread:
        raise frame.error(
            "camera-model",
            f"{frame.label} has the lens parameter {unread[0]}, which is not read with the camera model {model!r}",
            "undistort the photographs, or remove it if it means nothing",
        )
    if fisheye:
        return Lens("fisheye", (k1, k2, k3, k4))
    if k5 or k6 or (k4 and model == TRANSFORMS_RATIONAL_MODEL):
        return Lens("rational", (k1, k2, p1, p2, k3, k4, k5, k6))
    if k4:
        message = f"{frame.label} has k4, but its camera_model is neither OPENCV_FISHEYE nor FULL_OPENCV"
        raise frame.error("camera-model", message, "name the camera model, or undistort")
    lens = Lens("brown", (k1, k2, p1, p2, k3))
    return None if lens.is_identity else lens


def _read_coefficients(frame: _Frame) -> list[float]:
    """k1, k2, k3, k4, p1, p2: each by its name, or all from a list; a frame's own go before the file's.

    Raises CaptureError `lens` for a list that is none, or that names contradict.
    """
    named = [frame.number(key) or 0.0 for key in TRANSFORMS_LENS_KEYS]
    for level in (frame.own, frame.top):
        given = level.get("distortion_params")
        if given is None:
            if any(level.get(key) is not None for key in TRANSFORMS_LENS_KEYS):
                break
            continue
        beside = [level.get(key) for key in TRANSFORMS_LENS_KEYS]
        if not isinstance(given, list) or len(given) != len(named) or not all(map(_is_number, given)):
            message = f"distortion_params of {frame.label} is not the six numbers {' '.join(TRANSFORMS_LENS_KEYS)}"
            raise frame.error("lens", message, "give them in this order, or each by its name")
        if any(beside) and any(value is not None and value != one for value, one in zip(beside, given, strict=True)):
            message = f"distortion_params of {frame.label} contradicts its {', '.join(TRANSFORMS_LENS_KEYS)}"
            raise frame.error("lens", message, "remove one of the two")
        return [_as_float(number) for number in given]
    return named


def _read_own_lens(frame: _Frame) -> Lens:
    """A lens as `writers.transforms` writes it."""
    value = frame.get("lens")
    model, numbers = (value.get("model"), value.get("coefficients")) if isinstance(value, dict) else (None, None)
    if model not in TRANSFORMS_OWN_COEFFICIENTS or not isinstance(numbers, list) or not all(map(_is_number, numbers)):
        raise frame.error("lens", f"{frame.label} has no lens that is known", "mend or remove its entry")
    coefficients = tuple(_as_float(number) for number in numbers)
    if len(coefficients) not in TRANSFORMS_OWN_COEFFICIENTS[model] or not all(map(math.isfinite, coefficients)):
        message = f"{frame.label} has lens coefficients that are not finite or not as many as needed"
        raise frame.error("lens", message, "mend them")
    return Lens(model, coefficients)
