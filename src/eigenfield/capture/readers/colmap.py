"""COLMAP's sparse models (https://colmap.github.io/format.html): `cameras` and `images`, binary or text.

Poses are world-to-camera with OpenCV axes, pixel centres at +0.5: ours. Points are passed over, rigs and frames not
looked at (COLMAP repeats each image's own pose in `images`).
"""

from __future__ import annotations

import math
import mmap
import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.calibration import Calibration, Entry, Intrinsics, read_each
from eigenfield.capture.messages import count_phrase, list_names
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.text import CALIBRATION_MAX_SIDE_PIXELS, excerpt, unreadable_error
from eigenfield.core.errors import CaptureError, one_line

COLMAP_FOLDERS = ("sparse/*", "sparse", ".", "colmap/sparse/*")  # * is a number: of several the one of most images
# name: (number in the binary format, number of parameters); from colmap/src/colmap/sensor/models.h
COLMAP_MODELS = {
    "SIMPLE_PINHOLE": (0, 3), "PINHOLE": (1, 4), "SIMPLE_RADIAL": (2, 4), "RADIAL": (3, 5), "OPENCV": (4, 8),
    "OPENCV_FISHEYE": (5, 8), "FULL_OPENCV": (6, 12), "SIMPLE_RADIAL_FISHEYE": (8, 4), "RADIAL_FISHEYE": (9, 5),
    "SIMPLE_FISHEYE": (14, 3), "FISHEYE": (15, 4),
}  # fmt: skip
COLMAP_UNREAD_MODELS = {
    "FOV": (7, 5), "THIN_PRISM_FISHEYE": (10, 12), "RAD_TAN_THIN_PRISM_FISHEYE": (11, 16), "SIMPLE_DIVISION": (12, 4),
    "DIVISION": (13, 5), "EUCM": (16, 6), "EQUIRECTANGULAR": (17, 2),
}  # fmt: skip
COLMAP_ALL_MODELS = COLMAP_MODELS | COLMAP_UNREAD_MODELS
COLMAP_MODEL_NAMES = {number: name for name, (number, _) in COLMAP_ALL_MODELS.items()}
COLMAP_FISHEYE_MODELS = ("OPENCV_FISHEYE", "SIMPLE_RADIAL_FISHEYE", "RADIAL_FISHEYE", "SIMPLE_FISHEYE", "FISHEYE")
COLMAP_ONE_FOCAL_MODELS = (
    "SIMPLE_PINHOLE", "SIMPLE_RADIAL", "RADIAL", "SIMPLE_RADIAL_FISHEYE", "RADIAL_FISHEYE", "SIMPLE_FISHEYE"
)  # fmt: skip
COLMAP_MAX_NAME_BYTES = 4096  # of an image's name
COLMAP_POINT_BYTES = 24  # of a 2D point: x, y, point id
COLMAP_QUATERNION_TOLERANCE = 1e-3


_ListedCamera = tuple[Intrinsics, Lens | None] | str  # or the name of its model, if that is not read


@dataclass(frozen=True)
class _ImageRecord:
    """One line of `images`, not yet checked.

    Attributes:
        quaternion: w, x, y, z, world to camera.
        translation: World to camera.
        camera: Its number in `cameras`.
    """

    quaternion: tuple[float, ...]
    translation: tuple[float, ...]
    camera: int
    name: str


def is_model(folder: Path) -> bool:
    """Whether a folder holds `cameras` and `images` of a COLMAP model, both binary or both text."""
    return any(
        (folder / f"cameras.{kind}").is_file() and (folder / f"images.{kind}").is_file() for kind in ("bin", "txt")
    )


def find_colmap(folder: Path) -> Path | None:
    """The model in a folder, where COLMAP and tools with its layout write it; of several beside each other the one of
    most images."""
    for inner in COLMAP_FOLDERS:
        found = _numbered_models(folder / inner[:-2]) if inner.endswith("/*") else [folder / inner]
        found = [model for model in found if is_model(model)]
        if found:
            return found[0] if len(found) == 1 else max(found, key=_count_images)
    return None


def _numbered_models(folder: Path) -> list[Path]:
    """The folders with a number for a name, as COLMAP calls the models of photographs that do not hang together."""
    if not folder.is_dir():
        return []
    numbered = (inner for inner in folder.iterdir() if inner.name.isdecimal() and inner.name.isascii())
    return sorted(numbered, key=lambda inner: (int(inner.name), inner.name))


def _count_images(folder: Path) -> int:
    """How many images a model has; -1 where it is damaged."""
    try:
        return sum(1 for _ in _read_images(folder))
    except CaptureError:
        return -1


def _count_text(images: int) -> str:
    return "damaged" if images < 0 else f"{images} images"


def _describe_others(folder: Path) -> list[str]:
    """A line that names the models beside this one."""
    beside = _numbered_models(folder.parent) if folder.name.isdecimal() else []
    others = [other for other in beside if other != folder and is_model(other)]
    if not others:
        return []
    counts = [f"{folder.parent.name}/{other.name} ({_count_text(_count_images(other))})" for other in others]
    return [
        f"{folder.parent.name}/{folder.name} is read, but not {list_names(counts)}: name its folder to read another"
    ]


def read_colmap(folder: Path) -> Calibration:
    """Every image of a COLMAP model as an entry, binary files preferred.

    Raises CaptureError (`colmap-truncated`, `colmap-damaged`, `colmap-line`, `camera-model`, `calibration-empty`)
    that names the file.
    """
    kind = _kind_of(folder)
    images, listed = folder / f"images.{kind}", folder / f"cameras.{kind}"
    cameras = (_read_cameras_binary if kind == "bin" else _read_cameras_text)(listed)
    shots = list(_read_images(folder))
    if not shots:
        raise CaptureError("calibration-empty", "lists no image", path=images, remedy="name another model")
    foreign: dict[int, list[str]] = {}
    for shot in shots:
        if isinstance(cameras.get(shot.camera), str):
            foreign.setdefault(shot.camera, []).append(shot.name)
    usable = [shot for shot in shots if shot.camera not in foreign]
    entries, errors = read_each(lambda shot: _make_entry(shot, cameras, images), usable)
    unread = [_unread_model_error(str(cameras[camera]), camera, listed, names) for camera, names in foreign.items()]
    return Calibration(folder, "colmap", entries, (*errors, *unread), tuple(_describe_others(folder)))


def _kind_of(folder: Path) -> str:
    return "bin" if (folder / "cameras.bin").is_file() and (folder / "images.bin").is_file() else "txt"


def _read_images(folder: Path) -> Iterator[_ImageRecord]:
    kind = _kind_of(folder)
    return (_read_images_binary if kind == "bin" else _read_images_text)(folder / f"images.{kind}")


def _make_entry(shot: _ImageRecord, cameras: Mapping[int, _ListedCamera], path: Path) -> Entry:
    label = f"image {one_line(shot.name)}"
    if shot.camera not in cameras:
        raise CaptureError(
            "colmap-camera",
            f"{label} names camera {shot.camera}, which is not listed",
            path=path,
            remedy="export the model again",
        )
    listed = cameras[shot.camera]
    assert not isinstance(listed, str), "images of cameras of unread models are left out"
    intrinsics, lens = listed
    q, t = np.array(shot.quaternion), np.array(shot.translation)
    length = math.hypot(*q)
    if not np.isfinite(t).all() or not math.isfinite(length):
        raise CaptureError(
            "camera-not-finite",
            f"camera {label} has NaN or infinite entries",
            path=path,
            remedy="mend or remove its entry",
        )
    if abs(length - 1) > COLMAP_QUATERNION_TOLERANCE:
        raise CaptureError(
            "camera-not-rotation",
            f"camera {label}: its quaternion has a length of {length:.4g}",
            path=path,
            remedy="mend or remove its entry",
        )
    R = _rotation_matrix(q / length)
    with np.errstate(over="ignore", invalid="ignore"):
        centre = -R.T @ t
    return Entry(shot.name.replace("\\", "/"), label, intrinsics, R, centre, lens, stored=True)


def _rotation_matrix(q: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3) from a unit quaternion w, x, y, z."""
    w, x, y, z = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip


def _make_intrinsics(
    model: str, width: int, height: int, p: tuple[float, ...], path: Path, camera: int
) -> tuple[Intrinsics, Lens | None]:
    if not all(map(math.isfinite, p)):
        raise CaptureError(
            "camera-not-finite", f"camera {camera} has NaN or infinite entries", path=path, remedy="mend its entry"
        )
    if not (1 <= width <= CALIBRATION_MAX_SIDE_PIXELS and 1 <= height <= CALIBRATION_MAX_SIDE_PIXELS):
        raise CaptureError(
            "camera-size", f"camera {camera} has a size of {width}x{height}", path=path, remedy="mend its entry"
        )
    if model in COLMAP_ONE_FOCAL_MODELS:
        focal, principal, rest = (p[0], p[0]), (p[1], p[2]), p[3:]
    else:
        focal, principal, rest = (p[0], p[1]), (p[2], p[3]), p[4:]
    intrinsics = Intrinsics(width, height, focal, None, principal)
    if model in COLMAP_FISHEYE_MODELS:
        return intrinsics, Lens("fisheye", (*rest, 0.0, 0.0, 0.0, 0.0)[:4])
    if model == "FULL_OPENCV" and any(rest[5:]):
        return intrinsics, Lens("rational", rest)
    k1, k2, p1, p2, k3 = (*rest, 0.0, 0.0, 0.0, 0.0, 0.0)[:5]
    lens = Lens("brown", (k1, k2, p1, p2, k3))
    return intrinsics, None if lens.is_identity else lens


def _unread_model_error(name: str, camera: int, path: Path, images: Sequence[str] = ()) -> CaptureError:
    used = f" ({count_phrase(images, 'image', 'images')}: {list_names(images)})" if images else ""
    return CaptureError(
        "camera-model",
        f"camera {camera}{used} has the camera model {name}, which is not read",
        path=path,
        remedy=f"undistort with `colmap image_undistorter`, or use one of {', '.join(COLMAP_MODELS)}",
    )


# binary: little endian, no padding


class _Bytes:
    """A file's bytes, taken from the front; asking for more than there is raises CaptureError."""

    def __init__(self, data: bytes | mmap.mmap, path: Path) -> None:
        self.data, self.path, self.at = data, path, 0

    def need(self, size: int) -> None:
        """Raise CaptureError `colmap-truncated` where fewer bytes are left."""
        if size > len(self.data) - self.at:
            raise CaptureError(
                "colmap-truncated",
                f"ends at byte {len(self.data)}, {size} more are needed from byte {self.at}",
                path=self.path,
                remedy="copy or export it again",
            )

    def take(self, layout: str) -> tuple[int | float, ...]:
        """The next numbers, in a layout of `struct`."""
        size = struct.calcsize(layout)
        self.need(size)
        values = struct.unpack(layout, self.data[self.at : self.at + size])
        self.at += size
        return values

    def name(self) -> str:
        """The next text, which ends with a NUL."""
        end = self.data.find(b"\0", self.at, self.at + COLMAP_MAX_NAME_BYTES)
        if end < 0:
            self.need(COLMAP_MAX_NAME_BYTES)
            raise CaptureError(
                "colmap-damaged", f"no end to the name at byte {self.at}", path=self.path, remedy="export it again"
            )
        raw = bytes(self.data[self.at : end])
        self.at = end + 1
        return raw.decode("utf-8", "surrogateescape")

    def count(self, smallest: int) -> int:
        """A count of records of at least `smallest` bytes each, which must fit into the remaining bytes."""
        count = int(self.take("<Q")[0])
        self.need(count * smallest)
        return count

    def end(self) -> None:
        """Raise CaptureError `colmap-damaged` where bytes are left."""
        if self.at != len(self.data):
            raise CaptureError(
                "colmap-damaged",
                f"{len(self.data) - self.at} bytes too many at the end",
                path=self.path,
                remedy="export it again",
            )


def _map_file(path: Path) -> bytes | mmap.mmap:
    try:
        with path.open("rb") as file:
            if path.stat().st_size == 0:
                return b""
            return mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    except OSError as error:
        raise unreadable_error(path, error) from error


def _read_cameras_binary(path: Path) -> dict[int, _ListedCamera]:
    source = _Bytes(_map_file(path), path)
    cameras: dict[int, _ListedCamera] = {}
    for _ in range(source.count(24)):
        camera, number, width, height = (int(v) for v in source.take("<IiQQ"))
        if number not in COLMAP_MODEL_NAMES:
            raise _unread_model_error(f"number {number}", camera, path)  # and it does not say where the next begins
        model = COLMAP_MODEL_NAMES[number]
        parameters = source.take(f"<{COLMAP_ALL_MODELS[model][1]}d")
        read = model in COLMAP_MODELS
        cameras[camera] = _make_intrinsics(model, width, height, parameters, path, camera) if read else model
    source.end()
    return cameras


def _read_images_binary(path: Path) -> Iterator[_ImageRecord]:
    source = _Bytes(_map_file(path), path)
    for _ in range(source.count(4 + 56 + 4 + 1 + 8)):
        values = source.take("<I7dI")
        name = source.name()
        points = source.count(COLMAP_POINT_BYTES)
        source.at += points * COLMAP_POINT_BYTES
        yield _ImageRecord(tuple(values[1:5]), tuple(values[5:8]), int(values[8]), name)
    source.end()


# text


def _read_lines(path: Path) -> Iterator[tuple[int, str]]:
    try:
        with path.open(encoding="utf-8-sig", errors="surrogateescape") as file:
            for number, line in enumerate(file, 1):
                yield number, line.strip()
    except OSError as error:
        raise unreadable_error(path, error) from error


def _line_error(path: Path, number: int, message: str) -> CaptureError:
    return CaptureError("colmap-line", f"line {number}: {message}", path=path, remedy="export the model again")


def _read_cameras_text(path: Path) -> dict[int, _ListedCamera]:
    cameras: dict[int, _ListedCamera] = {}
    for number, line in _read_lines(path):
        if not line or line.startswith("#"):
            continue
        words = line.split()
        try:
            camera, model = int(words[0]), words[1].upper()
            if model not in COLMAP_MODELS:
                cameras[camera] = excerpt(model)
                continue
            width, height = int(words[2]), int(words[3])
            parameters = tuple(float(word) for word in words[4:])
        except (ValueError, IndexError):
            raise _line_error(path, number, "expected CAMERA_ID MODEL WIDTH HEIGHT PARAMS") from None
        count = COLMAP_MODELS[model][1]
        if len(parameters) != count:
            raise _line_error(path, number, f"{model} has {count} parameters, not {len(parameters)}")
        cameras[camera] = _make_intrinsics(model, width, height, parameters, path, camera)
    return cameras


def _read_images_text(path: Path) -> Iterator[_ImageRecord]:
    """Two lines an image; of the second, its points, which may be empty, only the number of words is checked."""
    lines = _read_lines(path)
    for number, line in lines:
        if not line or line.startswith("#"):
            continue
        words = line.split(maxsplit=9)
        try:
            values = tuple(float(word) for word in words[1:8])
            camera = int(words[8])
            name = words[9]
        except (ValueError, IndexError):
            raise _line_error(path, number, "expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME") from None
        yield _ImageRecord(values[:4], values[4:], camera, name)
        number, line = next(lines, (number + 1, ""))
        if len(line.split()) % 3:
            expected = "expected POINTS2D of the image above, as X Y POINT3D_ID (an empty line if none)"
            raise _line_error(path, number, expected)
