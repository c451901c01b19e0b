"""`models.json` of DeepView's light-field videos (https://github.com/augmentedperception/deepview_video_dataset).

A list of cameras, each with the name of its video. `position` is the camera's centre, `orientation` the axis-angle
vector of the world-to-camera rotation with OpenCV axes; fx = focal_length, fy = focal_length pixel_aspect_ratio.
`projection_type` is "fisheye", theta' = theta (1 + k1 theta^2 + k2 theta^4), or "perspective", where the same
polynomial is of the tangent. The position of pixel centres is not documented.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield.capture.calibration import CALIBRATION_MAX_MAGNITUDE, Calibration, Entry, Intrinsics, read_each
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.lens_keys import letters, refuse_lens_keys
from eigenfield.capture.readers.text import (
    check_finite,
    check_lens,
    check_rotation_vector,
    check_size,
    damaged_error,
    excerpt,
    longest_vector,
    read_contents,
    read_head,
)
from eigenfield.core.errors import CaptureError, one_line

DEEPVIEW_FILE = "models.json"
DEEPVIEW_HEAD_BYTES = 4096  # in which the keys of the first camera must stand
DEEPVIEW_MARKS = (b'"orientation"', b'"position"', b'"focal_length"')
DEEPVIEW_MAX_RADIAL = 4  # coefficients that a fisheye's polynomial has here


def find_deepview(folder: Path) -> Path | None:
    """The models.json of a folder, if it begins as one of cameras."""
    head = read_head(folder / DEEPVIEW_FILE, DEEPVIEW_HEAD_BYTES)
    return folder / DEEPVIEW_FILE if all(mark in head for mark in DEEPVIEW_MARKS) else None


def read_deepview(path: Path) -> Calibration:
    """Every camera of a models.json as an entry; those that cannot be used become errors of their own.

    Raises CaptureError (`calibration-missing`, `calibration-too-large`, `calibration-json`, `calibration-empty`) where
    the file as a whole cannot be used.
    """
    try:
        cameras = json.loads(read_contents(path).decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise CaptureError(
            "calibration-json", f"is no valid JSON ({str(error)[:80]})", path=path, remedy="copy it again"
        ) from error
    if not isinstance(cameras, list) or not cameras:
        raise CaptureError("calibration-empty", "lists no camera", path=path, remedy="name another calibration")
    turns: list[Any] = [camera.get("orientation") for camera in cameras if isinstance(camera, dict)]
    longest = longest_vector(turn for turn in turns if _are_numbers(turn))
    entries, errors = read_each(lambda item: _make_entry(item[1], item[0], longest, path), enumerate(cameras))
    return Calibration(path, "deepview", entries, errors)


def _are_numbers(values: Any) -> bool:
    numbers = isinstance(values, list) and all(type(v) in (int, float) for v in values)
    return numbers and all(abs(v) <= CALIBRATION_MAX_MAGNITUDE for v in values)


def _make_entry(camera: Any, number: int, longest: float, path: Path) -> Entry:
    from scipy.spatial.transform import Rotation  # not where another format is read

    name = camera.get("name") if isinstance(camera, dict) else None
    if not isinstance(name, str) or not name.strip("./") or "\0" in name:
        raise damaged_error(path, f"camera {number} has no name", "mend or remove its entry")
    label = f"camera {one_line(name)}"

    def numbers(key: str, least: int, most: int, otherwise: Any = None) -> list[float]:
        given = camera.get(key, otherwise)
        values = given if isinstance(given, list) else [given]
        if not (least <= len(values) <= most and all(type(v) in (int, float) for v in values)):
            raise damaged_error(path, f"{key} of {label} is not {least} numbers", "mend or remove its entry")
        array = np.array([float(v) if abs(v) < 1e300 else np.inf for v in values])
        check_finite([array], label, path)
        return array.tolist()

    (focal,), (aspect,) = numbers("focal_length", 1, 1), numbers("pixel_aspect_ratio", 1, 1, 1.0)
    centre, turn = np.array(numbers("position", 3, 3)), np.array(numbers("orientation", 3, 3))
    cx, cy = numbers("principal_point", 2, 2)
    (width,), (height,) = numbers("width", 1, 1), numbers("height", 1, 1)
    radial = numbers("radial_distortion", 0, DEEPVIEW_MAX_RADIAL, [])
    check_lens(radial, label, path)
    refuse_lens_keys(camera, ("radial_distortion", "projection_type"), label, path)
    lens = _make_lens(camera.get("projection_type") or "perspective", radial, label, path)
    intrinsics = Intrinsics(*check_size(width, height, label, path), (focal, focal * aspect), None, (cx, cy))
    check_rotation_vector(longest, label, path)
    R = Rotation.from_rotvec(turn).as_matrix()
    return Entry(name.replace("\\", "/"), label, intrinsics, R, centre, lens)


def _make_lens(kind: Any, radial: list[float], label: str, path: Path) -> Lens | None:
    k1, k2, k3, k4 = (*radial, 0.0, 0.0, 0.0, 0.0)[:4]
    word = letters(kind) if isinstance(kind, str) else ""
    if word == "fisheye":
        return Lens("fisheye", (k1, k2, k3, k4))
    lens = Lens("brown", (k1, k2, 0.0, 0.0, k3))
    if word != "perspective" or k4:
        what = f"the projection_type {excerpt(kind)!r}" if word != "perspective" else "four radial coefficients"
        raise CaptureError(
            "camera-model",
            f"{label} has {what}, which is not read",
            path=path,
            remedy="undistort the videos, or leave the camera out",
        )
    return None if lens.is_identity else lens
