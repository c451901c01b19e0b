"""Calibrations in OpenCV's FileStorage files (YAML, XML, JSON). Names are not fixed: those in common use are known.

Camera matrix `camera_matrix`, `K`, `M`, distortion `distortion_coefficients`, `dist`, `D`, pose `R` or `rvec` with `T`
or `tvec` (world-to-camera, X_camera = R X + T), or a 3 x 4 `extrinsic_matrix`; several cameras by an ending (`K_01`,
`M1`) or by a mapping each; one file for all, intrinsics and extrinsics apart (`intri.yml` and `extri.yml` of EasyMocap;
OpenCV's stereo sample), or a file a camera, named as its photograph. OpenCV counts pixel centres from 0: half a pixel
is added to the principal point.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, escape_name
from eigenfield.capture.messages import describe
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.by_order import photographs_in_order
from eigenfield.capture.readers.filestorage import STORAGE_EXTENSIONS, Tree, is_storage, load_storage
from eigenfield.capture.readers.skew import remove_skew
from eigenfield.capture.readers.text import (
    camera_centre,
    check_finite,
    check_lens,
    check_size,
    damaged_error,
    excerpt,
    files_in,
)
from eigenfield.core.errors import CaptureError

OPENCV_FOLDERS = ("", "calibration", "calib", "cameras", "intri_extri")
OPENCV_ROLES = {
    "matrix": ("camera_matrix", "cameramatrix", "intrinsic_matrix", "intrinsics", "intrinsic", "mtx", "k", "m"),
    "distortion": ("distortion_coefficients", "distortion_coeffs", "distcoeffs", "dist_coeffs", "dist", "d"),
    "rotation": ("rotation_matrix", "rotation_vector", "rotation", "rvec", "rot", "r"),
    "translation": ("translation_vector", "translation", "tvec", "t"),
    "extrinsic": ("extrinsic_matrix", "extrinsics", "extrinsic", "rt"),
    "views": ("extrinsic_parameters",),
    "width": ("image_width", "width", "w"),
    "height": ("image_height", "height", "h"),
    "size": ("image_size", "imagesize", "img_size", "resolution"),
    "model": ("distortion_model", "camera_model", "fisheye_model", "fisheye"),
}  # fmt: skip
OPENCV_WORDS = sorted(
    ((word, role) for role, words in OPENCV_ROLES.items() for word in words), key=lambda pair: -len(pair[0])
)
OPENCV_STEREO_PAIRS = ({"1", "2"}, {"0", "1"}, {"left", "right"}, {"l", "r"})
OPENCV_BROWN_MODELS = (
    "plumb_bob",
    "brown",
    "radtan",
    "pinhole",
    "rational_polynomial",
    "rational",
    "opencv",
    "perspective",
)
OPENCV_FISHEYE_MODELS = ("equidistant", "fisheye", "kannala_brandt", "kannala_brandt4", "opencv_fisheye")
OPENCV_POSE_ROLES = ("rotation", "translation", "extrinsic")
OPENCV_MAX_FILES = 2000


Values = dict[str, Any]  # of one camera in a file, by role, as they stand


def _has_pose(values: Values) -> bool:
    return "extrinsic" in values or {"rotation", "translation"} <= values.keys()


def find_opencv(folder: Path) -> Path | None:
    """An OpenCV file in a folder (or `calibration/`, `calib/`, `cameras/`) that holds cameras *with poses* and names:
    one file, one of intrinsics with its extrinsics beside it, or the folder where each camera has a file."""
    for name in OPENCV_FOLDERS:
        alone = []
        for path in _find_storages(folder / name):
            try:
                cameras = _load_cameras(path)
            except CaptureError:
                continue
            posed = [key for key, found in cameras.items() if _has_pose(found) and "matrix" in found]
            if len(posed) > 1 and not _is_stereo(cameras):
                return path
            if posed == [""] or (posed and len(cameras) == 1):
                alone.append(path)
        if alone:
            return folder / name if len(alone) > 1 else alone[0]
    return None


def _find_storages(folder: Path) -> list[Path]:
    paths = [path for path in files_in(folder) if path.suffix.lower() in STORAGE_EXTENSIONS][:OPENCV_MAX_FILES]
    return [path for path in paths if is_storage(path)]


def read_opencv(path: Path, photographs: Path | None = None) -> Calibration:
    """Every camera with a pose as an entry, named by its ending or mapping; without a name, as its file.

    The two cameras of a stereo pair and the views of one camera before a chart (`extrinsic_parameters`) have no names:
    they go with the photographs in name order. Cameras that cannot be used become errors of their own.

    Args:
        path: A file, or a folder with a file a camera.
        photographs: Folder of the photographs; by default the file's own.

    Raises:
        CaptureError: `calibration-missing`, `calibration-too-large`, `calibration-damaged`, `xml-doctype`,
            `calibration-empty`, `calibration-count`, `opencv-poses` (intrinsics only).
    """
    files = _without_companions(_find_storages(path)) if path.is_dir() else [path]
    if not files:
        raise CaptureError("calibration-empty", "holds no OpenCV file", path=path, remedy="name another calibration")
    entries: list[Entry] = []
    errors: list[CaptureError] = []
    problems: list[str] = []
    posed = 0
    for file in files:
        try:
            cameras = _load_cameras(file)
            posed += sum("views" in found or _has_pose(found) for found in cameras.values())
            root = photographs or (path if path.is_dir() else path.parent)
            poses = list(_posed_cameras(cameras, file, root))
        except CaptureError as error:
            if len(files) == 1:
                raise
            errors.append(error)
            continue
        for name, found in poses:
            try:
                entries.append(_make_entry(name, found, file))
            except CaptureError as error:
                errors.append(error)
        without = [key for key, found in cameras.items() if not _has_pose(found) and "matrix" in found]
        if poses and not _is_stereo(cameras) and not any("views" in found for found in cameras.values()):
            problems += describe(without, "camera has", "cameras have", f"no pose in {file.name}")
    if not entries and not errors and not posed:
        raise CaptureError(
            "opencv-poses",
            "has no camera with a pose (R and T)",
            path=path,
            remedy="use it as --intrinsics of `eigenfield calibrate CAPTURE`, or add the extrinsics",
        )
    return Calibration(path, "opencv", tuple(entries), tuple(errors), tuple(problems))


def read_opencv_intrinsics(path: Path) -> dict[str, tuple[Intrinsics, Lens | None]]:
    """Intrinsics and distortion of every camera of a file, by name; "" where it has one camera without a name.

    Pixel centres at +0.5. Raises CaptureError: as `read_opencv` for a file that is damaged, `calibration-empty` where
    it holds no camera matrix, and `camera-...` and `lens` for a camera that cannot be.
    """
    cameras = _load_cameras(path)
    found = {name: camera for name, camera in cameras.items() if "matrix" in camera}
    if not found:
        raise CaptureError(
            "calibration-empty",
            "holds no camera matrix (camera_matrix, K or M1)",
            path=path,
            remedy="name the file of a calibration",
        )
    return {
        name: _read_intrinsics(camera, f"camera {escape_name(name) or path.stem}", path)
        for name, camera in found.items()
    }


# what belongs together


def _without_companions(files: list[Path]) -> list[Path]:
    """Without those that another one is read together with."""
    kept: list[Path] = []
    for file in files:
        if _find_companion(file) not in kept:
            kept.append(file)
    return kept


def _load_cameras(path: Path) -> dict[str, Values]:
    """By name, in the file's order; of the file itself and the one that holds the other half (intri and extri)."""
    cameras = _cameras_by_name(load_storage(path))
    other = _find_companion(path)
    if other is not None and not (cameras and all(_has_pose(c) and "matrix" in c for c in cameras.values())):
        for name, found in _cameras_by_name(load_storage(other)).items():
            cameras[name] = {**found, **cameras.get(name, {})}
    return cameras


def _find_companion(path: Path) -> Path | None:
    for one, two in (("intri", "extri"), ("extri", "intri"), ("Intri", "Extri"), ("Extri", "Intri")):
        if one in path.stem:
            other = path.with_name(path.name.replace(one, two, 1))
            return other if other.is_file() else None
    return None


def _cameras_by_name(tree: Tree) -> dict[str, Values]:
    cameras: dict[str, Values] = {}
    for name, mapping in _walk_mappings(tree, ""):
        for key, value in mapping.items():
            role, ending = _match_role(key, value)
            if role is not None:
                place = f"{name}_{ending}" if name and ending else name or ending
                cameras.setdefault(place, {}).setdefault(role, value)
    shared = {r: v for r, v in cameras.get("", {}).items() if r in ("width", "height", "size", "model")}
    telling = {"matrix", "rotation", "translation", "extrinsic", "views"}
    return {name: {**shared, **found} for name, found in cameras.items() if telling & found.keys()}


def _walk_mappings(node: Any, name: str, depth: int = 0) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Every mapping of the tree, with the name of its camera."""
    if isinstance(node, dict):
        own = next((node[k] for k in ("name", "camera_name", "image", "file") if isinstance(node.get(k), str)), None)
        yield (own if own and depth else name), node
        for key, value in node.items():
            yield from _walk_mappings(value, key, depth + 1)
    elif isinstance(node, list) and not all(isinstance(v, float) for v in node):
        for i, value in enumerate(node):
            yield from _walk_mappings(value, f"{i}", depth + 1)


def _match_role(key: str, value: Any) -> tuple[str | None, str]:
    """The role of a name, and the camera that its ending names; None where name or value do not fit."""
    low = key.lower()
    for word, role in OPENCV_WORDS:
        ending = key[len(word) :]
        if not low.startswith(word) or not (not ending or ending[0] == "_" or ending.isdigit()):
            continue
        if role in ("matrix", "distortion", "rotation", "translation", "extrinsic", "views"):
            shape = _as_array(value)
            if shape is None or not _has_role_shape(role, shape):
                continue
            return role, ending.removeprefix("_")
        return (role, ending.removeprefix("_")) if _is_plain(role, value) else (None, "")
    return None, ""


def _is_plain(role: str, value: Any) -> bool:
    if role in ("width", "height"):
        return isinstance(value, float)
    if role == "size":
        array = _as_array(value)
        return array is not None and array.size == 2
    return isinstance(value, (float, str, bool))


def _as_array(value: Any) -> NDArray[np.float64] | None:
    """A matrix, or numbers in (nested) lists."""
    if isinstance(value, np.ndarray):
        return value[..., 0] if value.ndim == 3 and value.shape[2] == 1 else value
    if not isinstance(value, list) or not value:
        return None
    if all(isinstance(v, float) for v in value):
        return np.array(value)
    rows = [_as_array(v) for v in value]
    if any(row is None or row.ndim != 1 or row.shape != rows[0].shape for row in rows):  # type: ignore[union-attr]
        return None
    return np.array(rows)


def _has_role_shape(role: str, array: NDArray[np.float64]) -> bool:
    if role == "matrix":
        return array.shape == (3, 3) or array.size == 9
    if role == "rotation":
        return array.size in (3, 9)
    if role == "translation":
        return array.size == 3
    if role == "extrinsic":
        return array.shape in ((3, 4), (4, 4))
    if role == "views":
        return array.ndim == 2 and array.shape[1] == 6
    return array.size in (0, 4, 5, 8, 12, 14)


def _is_stereo(cameras: Mapping[str, Values]) -> bool:
    """Two camera matrices and one R, T from the first to the second (whose own R1, R2 are rectifying rotations)."""
    matrices = {name.lower() for name, found in cameras.items() if "matrix" in found}
    return matrices in OPENCV_STEREO_PAIRS and _has_pose(cameras.get("", {}))


def _posed_cameras(cameras: dict[str, Values], path: Path, root: Path) -> Iterator[tuple[str, Values]]:
    """The photograph's name and the camera, for each that has a pose."""
    if _is_stereo(cameras):
        pair = sorted((name for name in cameras if name), key=str.lower)
        names = photographs_in_order(root, 2, path)
        still = {"rotation": np.eye(3), "translation": np.zeros(3)}
        for name, file, pose in zip(pair, names, (still, cameras[""]), strict=True):
            intrinsics = {role: value for role, value in cameras[name].items() if role not in OPENCV_POSE_ROLES}
            yield file, intrinsics | {role: value for role, value in pose.items() if role in OPENCV_POSE_ROLES}
        return
    for name, found in cameras.items():
        if "views" in found and not _has_pose(found) and "matrix" in found:
            views = _as_array(found["views"])
            assert views is not None
            for file, row in zip(photographs_in_order(root, len(views), path), views, strict=True):
                yield file, {**found, "rotation": row[:3], "translation": row[3:]}
        elif _has_pose(found) and "matrix" in found:
            yield name or path.stem, found


# one camera


def _make_entry(name: str, found: Values, path: Path) -> Entry:
    label = f"camera {escape_name(name)}"
    if "\0" in name:
        raise damaged_error(path, f"{label} is no name of a file", "mend or remove it")
    intrinsics, lens = _read_intrinsics(found, label, path)
    R, t = _read_pose(found, label, path)
    check_finite([R, t], label, path)
    centre = camera_centre(R, t, label, path)
    return Entry(name.replace("\\", "/"), label, intrinsics, R, centre, lens)


def _read_pose(found: Values, label: str, path: Path) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    if {"rotation", "translation"} <= found.keys():
        rotation, translation = _as_array(found["rotation"]), _as_array(found["translation"])
        assert rotation is not None and translation is not None
        check_finite([rotation, translation], label, path)
        if rotation.size == 3:
            rotation = np.asarray(cv2.Rodrigues(rotation.reshape(3))[0], np.float64)
        return rotation.reshape(3, 3), translation.reshape(3)
    extrinsic = _as_array(found["extrinsic"])
    assert extrinsic is not None
    if len(extrinsic) == 4 and not np.allclose(extrinsic[3], [0, 0, 0, 1], atol=1e-6):
        message = f"the last row of the extrinsic matrix of {label} is not 0 0 0 1"
        raise damaged_error(path, message, "mend or remove it")
    return extrinsic[:3, :3], extrinsic[:3, 3]


def _read_intrinsics(found: Values, label: str, path: Path) -> tuple[Intrinsics, Lens | None]:
    matrix = _as_array(found["matrix"])
    assert matrix is not None
    K = matrix.reshape(3, 3)
    check_finite([K], label, path)
    K, skewed = remove_skew(K, label, path)
    lens = _make_lens(found, label, path)
    if skewed is not None and lens is not None:
        raise CaptureError(
            "camera-skew",
            f"{label} has skew and distortion, which OpenCV does not combine",
            path=path,
            remedy="mend it",
        )
    K[:2, 2] += 0.5
    return Intrinsics.of_matrix(K, *_read_size(found, label, path)), lens or skewed


def _read_size(values: Values, label: str, path: Path) -> tuple[int | None, int | None]:
    if "width" in values and "height" in values:
        return check_size(values["width"], values["height"], label, path)
    if "size" in values:
        size = _as_array(values["size"])
        assert size is not None
        width, height = size.reshape(2).tolist()
        return check_size(width, height, label, path)
    return None, None


def _make_lens(found: Values, label: str, path: Path) -> Lens | None:
    array = _as_array(found["distortion"]) if "distortion" in found else None
    c = () if array is None else tuple(array.reshape(-1).tolist())
    check_lens(c, label, path)
    if _is_fisheye(found.get("model"), label, path):
        if len(c) not in (0, 4):
            raise CaptureError("lens", f"{label} is a fisheye with {len(c)} coefficients", path=path, remedy="mend it")
        return Lens("fisheye", c or (0.0,) * 4)
    if not any(c):
        return None
    if len(c) <= 5:
        return Lens("brown", (*c, 0.0)[:5])
    return Lens("rational", c)


def _is_fisheye(model: Any, label: str, path: Path) -> bool:
    if model is None or isinstance(model, (float, bool)):
        return bool(model)
    word = re.sub(r"[\s-]+", "_", str(model).strip().lower())
    if word in OPENCV_FISHEYE_MODELS:
        return True
    if word not in OPENCV_BROWN_MODELS:
        raise CaptureError(
            "camera-model",
            f"{label} has the distortion model {excerpt(model)!r}, which is not read",
            path=path,
            remedy=f"use one of {', '.join((*OPENCV_BROWN_MODELS[:3], *OPENCV_FISHEYE_MODELS[:2]))}, "
            "or undistort the photographs",
        )
    return False
