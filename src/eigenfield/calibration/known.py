"""Known intrinsics of photographs: from any calibration that `capture` reads, an OpenCV file, or a text with K."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path, PurePosixPath

import numpy as np

from eigenfield.calibration.lenses import KnownLens
from eigenfield.capture.calibration import Intrinsics
from eigenfield.capture.formats import FORMATS, claim_of_file, detect_format
from eigenfield.capture.pairing import is_same_picture, scale_camera
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.capture.readers.filestorage import is_storage
from eigenfield.capture.readers.opencv import read_opencv_intrinsics
from eigenfield.core.camera import Camera
from eigenfield.core.camera_names import name_key
from eigenfield.core.errors import CaptureError, one_line
from eigenfield.core.open_options import OpenOptions

LensEntry = tuple[Intrinsics, Lens | None]
KNOWN_MAX_MATRIX_BYTES = 4096  # of a text with nothing but a camera matrix


def read_known_lenses(path: Path, photos: PhotoSet) -> list[KnownLens]:
    """The intrinsics that a file gives for each photograph, scaled if they are for another size of the same picture.

    Cameras are matched by the photograph's name without extension; the cameras of videos and rigs by their own names. A
    single camera serves for all photographs.

    Args:
        path: A calibration of any format with cameras (its poses are ignored), an OpenCV file of intrinsics, or a text
            with the nine numbers of K.

    Raises:
        CaptureError: As the readers do. `calibration-missing`: there is no such file. `intrinsics-missing`: a
            photograph has none. `image-size`: they are for another picture.
    """
    if not path.exists():
        raise CaptureError("calibration-missing", "does not exist", path=path, remedy="check --intrinsics")
    entries = _read_plain_matrix(path) or _read_entries(path, photos)
    distinct = list({repr(entry): entry for entry in entries.values()}.values())
    known = []
    for shot in photos.shots:
        entry = entries.get(_stem(shot.name)) or entries.get(_stem(shot.path.name))
        if entry is None and len(distinct) == 1:
            entry = distinct[0]
        if entry is None:
            raise CaptureError(
                "intrinsics-missing",
                f"has {len(distinct)} cameras, none of them named {one_line(shot.name)}",
                path=path,
                remedy="name its cameras as the photographs, or give a file of one camera",
            )
        known.append(_scale_to_photograph(entry, shot, path))
    return known


def _stem(name: str) -> str:
    return name_key(PurePosixPath(name.replace("\\", "/")).stem)


def _read_plain_matrix(path: Path) -> Mapping[str, LensEntry] | None:
    """K of a text file that holds nine numbers and nothing else."""
    try:
        if not path.is_file() or path.stat().st_size > KNOWN_MAX_MATRIX_BYTES:
            return None
        values = np.array([float(word) for word in path.read_text(encoding="utf-8").replace(",", " ").split()])
    except (OSError, ValueError):
        return None
    if len(values) != 9:
        return None
    K = values.reshape(3, 3)
    Camera.from_matrices(K, np.eye(3), np.zeros(3), 1, 1, path.name)
    return {"": (Intrinsics.of_matrix(K), None)}


def _read_entries(path: Path, photos: PhotoSet) -> Mapping[str, LensEntry]:
    if path.is_file() and is_storage(path):
        return {name_key(name): entry for name, entry in read_opencv_intrinsics(path).items()}
    formats = tuple(row for row in FORMATS if row.read_cameras is not None)
    find = claim_of_file if path.is_file() else detect_format
    claim = find(path, formats, OpenOptions())
    if claim is None or claim.format.read_cameras is None:
        raise CaptureError(
            "calibration-missing",
            "holds no calibration",
            path=path,
            remedy="name a transforms.json, a COLMAP model, an OpenCV file, or a text of K's nine numbers",
        )
    read = claim.format.read_cameras(claim.found, photos.root)
    if not read.entries:
        raise read.errors[0]
    return {_stem(entry.file): (entry.intrinsics, entry.lens) for entry in read.entries}


def _scale_to_photograph(entry: LensEntry, shot: Shot, path: Path) -> KnownLens:
    intrinsics, lens = entry
    size = intrinsics.width or shot.width, intrinsics.height or shot.height
    if size != (shot.width, shot.height) and not is_same_picture(*size, shot.width, shot.height):
        raise CaptureError(
            "image-size",
            f"is {shot.width}x{shot.height}, but the camera in {path.name} is for {size[0]}x{size[1]}: "
            "not the same picture at another scale",
            path=shot.path,
            remedy="give the intrinsics of these photographs",
        )
    camera = Camera.from_matrices(intrinsics.matrix(*size), np.eye(3), np.zeros(3), *size, shot.name)
    if size != (shot.width, shot.height):
        camera = scale_camera(camera, shot.width, shot.height)
    return KnownLens(camera.K, lens)
