"""Calibrations in OpenCV's terms (YAML, XML, JSON, TOML). Names are not fixed: those in common use are known.

Camera matrix `camera_matrix`, `K`, `M`, or `fx`, `fy`, `cx`, `cy`; distortion `distortion_coefficients`, `dist`, `D`,
or `k1`, `k2`, `p1`, `p2` ...; pose `R` or `rvec` with `T` or `tvec` (world-to-camera, X_camera = R X + T), or a 3 x 4
`extrinsic_matrix`; several cameras by an ending (`K_01`, `M1`) or by a mapping each; one file for all (CMU Panoptic;
the TOML of Caliscope and Anipose), intrinsics and extrinsics apart (`intri.yml` and `extri.yml` of EasyMocap; OpenCV's
stereo sample), or a file a camera, named as its photograph. Another key that looks like a lens is an error
(`lens_keys`). OpenCV counts pixel centres from 0: half a pixel is added to the principal point.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import CALIBRATION_MAX_MAGNITUDE, Calibration, Entry, Intrinsics
from eigenfield.capture.locate import IMAGES_FOLDER, photographs_in
from eigenfield.capture.messages import describe
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.by_order import photographs_in_order
from eigenfield.capture.readers.filestorage import STORAGE_EXTENSIONS, Tree, is_storage, load_storage
from eigenfield.capture.readers.lens_keys import (
    LENS_MAX_KEY_CHARACTERS,
    has_numbers,
    is_lens,
    letters,
    refuse_lens_key,
)
from eigenfield.capture.readers.skew import remove_skew
from eigenfield.capture.readers.text import (
    camera_centre,
    check_finite,
    check_lens,
    check_rotation_vector,
    check_size,
    damaged_error,
    excerpt,
    files_in,
    longest_vector,
)
from eigenfield.core.camera_names import name_key
from eigenfield.core.errors import CaptureError, one_line

OPENCV_FOLDERS = ("", "calibration", "calib", "cameras", "intri_extri")
OPENCV_ROLES = {
    "matrix": ("camera_matrix", "cameramatrix", "intrinsic_matrix", "intrinsics", "intrinsic", "mtx", "k", "m"),
    "plain_matrix": ("matrix",),  # the camera matrix where there is no other
    "fx": ("fx", "f_x", "focal_x"), "fy": ("fy", "f_y", "focal_y"),
    "focal": ("focal_length", "focallength", "focal", "f"),
    "cx": ("cx", "c_x", "ppx"), "cy": ("cy", "c_y", "ppy"), "principal": ("principal_point", "principalpoint", "pp"),
    "distortion": (
        *(
            f"{first}{joint}{last}"
            for first in ("dist", "distortion") for joint in ("_", "") for last in (
                "coef", "coefs", "coeff", "coeffs", "coefficient", "coefficients", "params", "parameters", "vector")
        ),
        "lens_distortion", "lensdistortion", "distortions", "distortion", "dist", "d",
    ),
    "radial": ("radial_distortion", "radialdistortion", "radial"),
    "tangential": ("tangential_distortion", "tangentialdistortion", "tangential"),
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
# in OpenCV's order, where each has a key of its own
OPENCV_COEFFICIENTS = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4", "taux", "tauy")
OPENCV_COEFFICIENT_COUNTS = (0, 4, 5, 8, 12, 14)
OPENCV_LENS_ROLES = ("distortion", "radial", "tangential", *OPENCV_COEFFICIENTS)
OPENCV_ARRAY_ROLES = ("matrix", "plain_matrix", "rotation", "translation", "extrinsic", "views")
OPENCV_SHARED_ROLES = ("width", "height", "size", "model")
OPENCV_INTRINSIC_ROLES = ("matrix", "fx", "fy", "focal", "cx", "cy", "principal", *OPENCV_LENS_ROLES, "unread")
# mappings that are a part of a camera and not a camera of this name
OPENCV_PARTS = {
    "intrinsics", "intrinsic", "extrinsics", "extrinsic", "pose", "distortion", "lens", "calibration", "parameters",
    "params",
}  # fmt: skip
OPENCV_LENS_PARTS = ("coefficients", "coeffs", "coefs", "params", "parameters", "values")  # keys in its mapping
OPENCV_MIN_FOCAL = 10.0  # pixels, of four numbers that are a camera matrix and no lens
OPENCV_ANGLES_KEY = re.compile(r"euler|rpy$|(rot|rvec|angle).*deg|ypr$|(yaw|pitch|roll)(deg|degrees)?$")
OPENCV_NAME_BEGINNINGS = ("cam_", "cam", "camera_", "camera", "port_")  # where a file numbers its cameras
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


def _has_matrix(values: Values) -> bool:
    return not values.keys().isdisjoint(("matrix", "fx", "focal"))


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
            posed = [key for key, found in cameras.items() if _has_pose(found) and _has_matrix(found)]
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


def opencv_content(path: Path) -> str | None:
    """ "poses" where a file holds cameras with poses, "intrinsics" where it holds camera matrices alone; else None."""
    if path.suffix.lower() not in STORAGE_EXTENSIONS:
        return None
    try:
        cameras = _load_cameras(path).values()
    except CaptureError:
        return None
    known = [found for found in cameras if _has_matrix(found)]
    return ("poses" if any(map(_has_pose, known)) else "intrinsics") if known else None


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
        longest = longest_vector(vector for _, found in poses if (vector := _rotation_vector(found)) is not None)
        for name, found in poses:
            try:
                entries.append(_make_entry(name, found, longest, file))
            except CaptureError as error:
                errors.append(error)
        without = [key for key, found in cameras.items() if not _has_pose(found) and _has_matrix(found)]
        errors += [_angles_error(key, cameras[key]["angles"], file) for key in without if "angles" in cameras[key]]
        blind = [key for key, found in cameras.items() if _has_pose(found) and not _has_matrix(found)]
        if not _is_stereo(cameras):
            problems += describe(blind, "camera has", "cameras have", f"a pose and no camera matrix in {file.name}")
        if poses and not _is_stereo(cameras) and not any("views" in found for found in cameras.values()):
            problems += describe(without, "camera has", "cameras have", f"no pose in {file.name}")
    if not entries and not errors and posed:
        raise CaptureError(
            "opencv-matrix",
            "has poses, but no camera has a camera matrix (camera_matrix, K, or fx, fy, cx, cy)",
            path=path,
            remedy="add the intrinsics",
        )
    if not entries and not errors:
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
    found = {name: camera for name, camera in cameras.items() if _has_matrix(camera)}
    if not found:
        raise CaptureError(
            "calibration-empty",
            "holds no camera matrix (camera_matrix, K or M1)",
            path=path,
            remedy="name the file of a calibration",
        )
    return {
        name: _read_intrinsics(camera, f"camera {one_line(name) or path.stem}", path) for name, camera in found.items()
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
    if other is not None and not (cameras and all(_has_pose(c) and _has_matrix(c) for c in cameras.values())):
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
    owners: dict[str, str] = {}  # of a camera that an ending names, the mapping that it stands in
    for name, mapping, lens in _walk_mappings(tree, ""):
        for key, value in mapping.items():
            role, ending = _match_role(key, value, lens is not None)
            place = f"{name}_{ending}" if name and ending else name or ending
            values = cameras.setdefault(place, {})
            owners[place] = name
            if role is None:
                if lens is not None and not isinstance(value, (dict, list)) and has_numbers(value):
                    values.setdefault("unread", lens)
                elif not isinstance(value, dict) and is_lens(key, value):
                    values.setdefault("unread", key)
            elif role in OPENCV_LENS_ROLES and role in values and not _is_same(values[role], value):
                values.setdefault("unread", key)
            else:
                values.setdefault(role, key if role == "angles" else value)
                if role in OPENCV_LENS_ROLES:
                    values.setdefault("lens_key", key)
    for found in cameras.values():
        if "plain_matrix" in found:
            found.setdefault("matrix", found.pop("plain_matrix"))
    telling = {"matrix", "fx", "focal", "rotation", "translation", "extrinsic", "views"}
    known = {name: found for name, found in cameras.items() if telling & found.keys()}
    for name, found in cameras.items():
        if name not in known and not found.keys().isdisjoint((*OPENCV_LENS_ROLES, "unread")):
            _pass_on(found, owners[name], name, known)
    return _with_shared(cameras.get("", {}), known)


def _pass_on(found: Values, owner: str, name: str, known: dict[str, Values]) -> None:
    """Hand a lens that no camera has to the cameras that it may be of: as what is not read, under its own key."""
    if not name:
        return  # all cameras share it
    key = found.get("unread", found.get("lens_key"))
    for values in [known[owner]] if owner in known else known.values():
        values.setdefault("unread", key)


def _with_shared(top: Values, known: dict[str, Values]) -> dict[str, Values]:
    """The cameras with what the file says of all of them."""
    roles: tuple[str, ...] = OPENCV_SHARED_ROLES
    others = {name: found for name, found in known.items() if name}
    if others and not _has_pose(top) and not any(_has_matrix(found) for found in others.values()):
        roles, known = (*roles, *OPENCV_INTRINSIC_ROLES), others
    elif others and not _has_pose(top) and not _has_matrix(top):
        roles = (*roles, *OPENCV_LENS_ROLES, "unread")
    shared = {role: value for role, value in top.items() if role in roles}
    return {name: {**shared, **found} for name, found in known.items()}


def _is_same(one: Any, other: Any) -> bool:
    return _as_numbers(one) == _as_numbers(other)


def _walk_mappings(
    node: Any, name: str, lens: str | None = None, depth: int = 0
) -> Iterator[tuple[str, Mapping[str, Any], str | None]]:
    """Every mapping of the tree, with the name of its camera, and the key that makes it a part of a lens."""
    if isinstance(node, dict):
        stated = next((node[k] for k in ("name", "camera_name", "image", "file") if isinstance(node.get(k), str)), None)
        name = stated if stated and depth else name
        yield name, node, lens
        for key, value in node.items():
            part = key.lower() in OPENCV_PARTS
            inner = lens or (key if isinstance(value, dict) and is_lens(key, value) else None)
            yield from _walk_mappings(value, name if part or inner else key, inner, depth + 1)
    elif isinstance(node, list) and not all(isinstance(v, float) for v in node):
        for i, value in enumerate(node):
            yield from _walk_mappings(value, f"{i}", lens, depth + 1)


def _match_role(key: str, value: Any, inside_lens: bool = False) -> tuple[str | None, str]:
    """The role of a name, and the camera that its ending names; None where name or value do not fit."""
    low = key.lower().replace("-", "_").replace(" ", "_")
    if low.replace("_", "") in OPENCV_COEFFICIENTS and isinstance(value, float):
        return low.replace("_", ""), ""
    if OPENCV_ANGLES_KEY.search(letters(low[:LENS_MAX_KEY_CHARACTERS])) and has_numbers(value):
        return "angles", ""
    if inside_lens and low in OPENCV_LENS_PARTS and _as_numbers(value):
        return "distortion", ""
    if inside_lens and low in ("model", "type") and isinstance(value, str):
        return "model", ""
    for word, role in OPENCV_WORDS:
        ending = key[len(word) :]
        if not low.startswith(word) or not (not ending or ending[0] in "_- " or ending.isdigit()):
            continue
        array = _as_array(value)
        if role in OPENCV_ARRAY_ROLES:
            if array is None or not _has_role_shape(role, array, word):
                continue
        elif role in ("distortion", "radial", "tangential"):
            if isinstance(value, float) and word != "d" and not ending:
                array = np.array([value])
            if array is None or array.size != max(array.shape, default=0):
                continue
        elif not _is_plain(role, value):
            return None, ""
        return role, ending[1:] if ending and ending[0] in "_- " else ending
    return None, ""


def _is_plain(role: str, value: Any) -> bool:
    if role in ("width", "height", "fx", "fy", "cx", "cy"):
        return isinstance(value, float)
    if role == "focal" and isinstance(value, float):
        return True
    if role in ("size", "focal", "principal"):
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


def _has_role_shape(role: str, array: NDArray[np.float64], word: str) -> bool:
    if role == "matrix" and word in ("intrinsics", "intrinsic", "k") and array.shape == (4,):  # fx, fy, cx, cy
        return bool(OPENCV_MIN_FOCAL < array[1] <= 2 * array[0] <= 4 * array[1])
    if role in ("matrix", "plain_matrix"):
        return array.shape == (3, 3) or array.size == 9
    if role == "rotation":
        return array.size in (3, 9)
    if role == "translation":
        return array.size == 3
    if role == "extrinsic":
        return array.shape in ((3, 4), (4, 4))
    return array.ndim == 2 and array.shape[1] == 6


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
    stems = {name_key(file.stem) for folder in (root, root / IMAGES_FOLDER) for file in photographs_in(folder)}
    for name, found in cameras.items():
        if "views" in found and not _has_pose(found) and _has_matrix(found):
            views = _as_array(found["views"])
            assert views is not None
            for file, row in zip(photographs_in_order(root, len(views), path), views, strict=True):
                yield file, {**found, "rotation": row[:3], "translation": row[3:]}
        elif _has_pose(found) and _has_matrix(found):
            yield _photograph_name(name or path.stem, stems), found


def _photograph_name(name: str, stems: set[str]) -> str:
    """The name of a camera as photographs or videos have it: camera 0 of a file is their cam_0."""
    names = (name, *(f"{beginning}{name}" for beginning in OPENCV_NAME_BEGINNINGS))
    return next((one for one in names if name_key(one) in stems), name)


# one camera


def _make_entry(name: str, found: Values, longest: float, path: Path) -> Entry:
    label = f"camera {one_line(name)}"
    if "\0" in name:
        raise damaged_error(path, f"{label} is no name of a file", "mend or remove it")
    intrinsics, lens = _read_intrinsics(found, label, path)
    if _rotation_vector(found) is not None:
        check_rotation_vector(longest, label, path)
    R, t = _read_pose(found, label, path)
    check_finite([R, t], label, path)
    centre = camera_centre(R, t, label, path)
    return Entry(name.replace("\\", "/"), label, intrinsics, R, centre, lens)


def _rotation_vector(found: Values) -> NDArray[np.float64] | None:
    """A pose's rotation of three numbers; None for others, and where it is not finite, which `_read_pose` refuses."""
    array = _as_array(found["rotation"]) if {"rotation", "translation"} <= found.keys() else None
    return array if array is not None and array.size == 3 and np.abs(array).max() < CALIBRATION_MAX_MAGNITUDE else None


def _angles_error(name: str, key: str, path: Path) -> CaptureError:
    return CaptureError(
        "camera-rotation-vector",
        f"camera {one_line(name) or path.stem} has its rotation in {key!r}: degrees and Euler angles are not read",
        path=path,
        remedy="give rotation vectors in radians, as cv2.Rodrigues makes them, or 3x3 matrices",
    )


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
    lens = _make_lens(found, label, path)
    size = _read_size(found, label, path)
    matrix = _as_array(found["matrix"]) if "matrix" in found else None
    if matrix is None or matrix.size == 4:  # fx, fy, cx, cy
        focal, principal = _read_named(found) if matrix is None else (tuple(matrix[:2]), tuple(matrix[2:]))
        check_finite([focal, [v for v in principal if v is not None]], label, path)
        cx, cy = (None if value is None else float(value) + 0.5 for value in principal)
        return Intrinsics(*size, (float(focal[0]), float(focal[1])), None, (cx, cy)), lens
    K = matrix.reshape(3, 3)
    check_finite([K], label, path)
    K, skewed = remove_skew(K, label, path)
    if skewed is not None and lens is not None:
        raise CaptureError(
            "camera-skew",
            f"{label} has skew and distortion, which OpenCV does not combine",
            path=path,
            remedy="mend it",
        )
    K[:2, 2] += 0.5
    return Intrinsics.of_matrix(K, *size), lens or skewed


def _read_named(found: Values) -> tuple[tuple[Any, Any], tuple[float | None, ...]]:
    """Focal lengths, and the principal point, None where it is not stated."""
    both, middle = _as_numbers(found.get("focal")), _as_numbers(found.get("principal"))
    focal = found.get("fx", both[0] if both else None), found.get("fy", both[-1] if both else found.get("fx"))
    cx, cy = middle if middle else (None, None)
    return focal, (found.get("cx", cx), found.get("cy", cy))


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
    if "unread" in found:
        refuse_lens_key(found["unread"], label, path)
    fisheye = _is_fisheye(found.get("model"), label, path)
    c = _read_coefficients(found, fisheye, label, path)
    check_lens(c, label, path)
    if fisheye:
        if len(c) > 4:
            raise CaptureError("lens", f"{label} is a fisheye with {len(c)} coefficients", path=path, remedy="mend it")
        return Lens("fisheye", (*c, 0.0, 0.0, 0.0, 0.0)[:4])
    if not any(c):
        return None
    if len(c) <= 5:
        return Lens("brown", (*c, 0.0, 0.0, 0.0, 0.0)[:5])
    return Lens("rational", c)


def _read_coefficients(found: Values, fisheye: bool, label: str, path: Path) -> tuple[float, ...]:
    """Coefficients in OpenCV's order, as many as it knows or fewer; those of a fisheye are k1 to k4.

    Raises CaptureError `lens` where their order is not certain: of three or six numbers the third is p1 to OpenCV, and
    k3 to others.
    """
    ways = [role for role in ("distortion", "radial", "tangential") if role in found and has_numbers(found[role])]
    named = {key: found[key] for key in OPENCV_COEFFICIENTS if found.get(key)}
    problem = ""
    values: tuple[float, ...] = ()
    if named and ways:
        problem = f"{' and '.join(ways)} and {' '.join(named)}"
    elif named:
        order = ("k1", "k2", "k3", "k4") if fisheye else OPENCV_COEFFICIENTS
        strange = named.keys() - set(order)
        alone = not fisheye and "k4" in named and not {"k5", "k6"} & named.keys() and not _is_rational(found)
        if strange or alone:
            problem = f"{' '.join(sorted(strange) or ['k4'])} without a model that has them"
        values = tuple(float(named.get(key, 0.0)) for key in order)
        count = next(n for n in (*OPENCV_COEFFICIENT_COUNTS, len(values)) if not any(values[n:]))
        values = values[:count]
    elif ways == ["distortion"]:
        values = _as_numbers(found["distortion"])
        if not any(values[2:]):
            values = values[:2]
        elif len(values) not in OPENCV_COEFFICIENT_COUNTS and not (fisheye and len(values) < 4):
            problem = f"{len(values)} distortion coefficients, of which the order is not known"
    elif ways:
        radial, tangential = (_as_numbers(found.get(role, [])) for role in ("radial", "tangential"))
        if len(ways) == 3 or "distortion" in ways or any(radial[3:]) or any(tangential[2:]) or fisheye:
            problem = f"{' and '.join(ways)} coefficients of which the order is not known"
        k1, k2, k3, p1, p2 = (*(*radial, 0.0, 0.0, 0.0)[:3], *(*tangential, 0.0, 0.0)[:2])
        values = (k1, k2, p1, p2, k3)
    if problem:
        raise CaptureError(
            "lens",
            f"{label} has {problem}",
            path=path,
            remedy="give 1, 2, 4, 5, 8, 12 or 14 coefficients k1 k2 p1 p2 k3 ... in OpenCV's order",
        )
    return values


def _as_numbers(value: Any) -> tuple[float, ...]:
    array = np.array([value]) if isinstance(value, float) else _as_array(value)
    return () if array is None else tuple(array.reshape(-1).tolist())


def _is_rational(found: Values) -> bool:
    return str(found.get("model")).strip().lower().startswith("rational")


def _is_fisheye(model: Any, label: str, path: Path) -> bool:
    if model is None or isinstance(model, (float, bool)):
        return bool(model)
    word = letters(str(model))
    if word in map(letters, OPENCV_FISHEYE_MODELS):
        return True
    if word not in ("", "none", *map(letters, OPENCV_BROWN_MODELS)):
        raise CaptureError(
            "camera-model",
            f"{label} has the distortion model {excerpt(model)!r}, which is not read",
            path=path,
            remedy=f"use one of {', '.join((*OPENCV_BROWN_MODELS[:3], *OPENCV_FISHEYE_MODELS[:2]))}, "
            "or undistort the photographs",
        )
    return False
