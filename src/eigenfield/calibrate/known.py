"""Reading known intrinsics of photographs: any calibration that `capture` reads, an OpenCV file, or a text of K."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path, PurePosixPath

import numpy as np

from eigenfield.calibrate.lenses import KnownLens
from eigenfield.capture.arrangement import Wanted
from eigenfield.capture.calibration import Intrinsics, printable
from eigenfield.capture.formats import FORMATS, claim_of_file, detect
from eigenfield.capture.pairing import is_same_picture, scaled_camera
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.photoset import PhotoSet, Shot
from eigenfield.capture.readers.filestorage import is_storage
from eigenfield.capture.readers.opencv import read_opencv_intrinsics
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError

Described = tuple[Intrinsics, Lens | None]
MATRIX_LIMIT = 4096  # bytes of a text with nothing but a camera matrix


def read_known_lenses(path: Path, photos: PhotoSet) -> list[KnownLens]:
    """The intrinsics that `path` gives for each photograph, scaled where they are for another size of the same picture.

    path: a calibration of any format with cameras (its poses are not used), an OpenCV file of intrinsics, or a text
    with the nine numbers of K. Cameras are found by the photograph's name without extension (a video's or rig's
    camera by its own); a single camera serves for all.

    Raises CaptureError: as the readers do; `intrinsics-missing` where a photograph has none; `image-size`.
    """
    if not path.exists():
        raise CaptureError("calibration-missing", "does not exist", path=path, remedy="check --intrinsics")
    described = _plain_matrix(path) or _described(path, photos)
    distinct = list({_key(entry): entry for entry in described.values()}.values())
    known = []
    for shot in photos.shots:
        entry = described.get(_stem(shot.name)) or described.get(_stem(shot.path.name))
        if entry is None and len(distinct) == 1:
            entry = distinct[0]
        if entry is None:
            raise CaptureError(
                "intrinsics-missing",
                f"has {len(distinct)} cameras, none of them named {printable(shot.name)}",
                path=path,
                remedy="name its cameras as the photographs, or give a file of one camera",
            )
        known.append(_fitted(entry, shot, path))
    return known


def _stem(name: str) -> str:
    return PurePosixPath(name.replace("\\", "/")).stem.casefold()


def _key(entry: Described) -> str:
    return repr(entry)


def _plain_matrix(path: Path) -> Mapping[str, Described] | None:
    """K of a text file that holds nine numbers and nothing else."""
    try:
        if not path.is_file() or path.stat().st_size > MATRIX_LIMIT:
            return None
        values = np.array([float(word) for word in path.read_text(encoding="utf-8").replace(",", " ").split()])
    except (OSError, ValueError):
        return None
    if len(values) != 9:
        return None
    K = values.reshape(3, 3)
    Camera.checked(K, np.eye(3), np.zeros(3), 1, 1, path.name)
    return {"": (Intrinsics(None, None, (K[0, 0], K[1, 1]), None, (K[0, 2], K[1, 2])), None)}


def _described(path: Path, photos: PhotoSet) -> Mapping[str, Described]:
    if path.is_file() and is_storage(path):
        return {name.casefold(): entry for name, entry in read_opencv_intrinsics(path).items()}
    formats = tuple(row for row in FORMATS if row.read_cameras is not None)
    claim = claim_of_file(path, formats) if path.is_file() else detect(path, formats, Wanted(None, None))
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


def _fitted(entry: Described, shot: Shot, path: Path) -> KnownLens:
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
    camera = Camera.checked(intrinsics.matrix(*size), np.eye(3), np.zeros(3), *size, shot.name)
    if size != (shot.width, shot.height):
        camera = scaled_camera(camera, shot.width, shot.height)
    return KnownLens(camera.K, lens)
