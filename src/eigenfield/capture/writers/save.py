"""Saving a calibration as other tools read it: `transforms.json` and a COLMAP model in one folder, or nothing."""

from __future__ import annotations

import json
import logging
import os
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from eigenfield.capture.lightfield import LightField
from eigenfield.capture.points import SparsePoints
from eigenfield.capture.readers.transforms import TRANSFORMS_FILE
from eigenfield.capture.writers.colmap import colmap_model
from eigenfield.capture.writers.transforms import transforms_document
from eigenfield.core.errors import OutputError
from eigenfield.runtime.files import current_umask, flush_folder, output_errors, rename
from eigenfield.runtime.objects import refuse_objects
from eigenfield.runtime.signals import hold_signals
from eigenfield.runtime.temporary import temporary_folder

log = logging.getLogger("eigenfield.capture")

COLMAP_MODEL_FOLDER = "sparse/0"
POINTS_FILE = "points.ply"


def save_calibration(
    light_field: LightField,
    folder: str | os.PathLike[str],
    points: SparsePoints | None = None,
    *,
    overwrite: bool = False,
    more: Mapping[str, bytes] | None = None,
) -> None:
    """Write cameras into a folder: `transforms.json` (nerfstudio, instant-ngp) and `sparse/0` (COLMAP, binary).

    They are written in the world of the capture's own calibration, where that stands far from its origin, points too.
    `open_capture` reads both forms back to the same cameras. If COLMAP has no model for a lens, or EXIF mirrors a
    photograph, `sparse` is left out, with a warning. Skew is refused.

    Args:
        folder: Made if it does not exist.
        points: Sparse points, written to `sparse/0` and to `points.ply`.
        overwrite: Replace what an earlier calibration wrote there; other files in the folder stay as they are.
        more: Further files by name, written with them.

    Raises:
        OutputError: `output-exists` (the folder is not empty), `output-is-file`, `camera-skew`, `disk-full`,
            `not-writable`.
    """
    place = Path(folder)
    refuse_folder(place, overwrite)
    for view in light_field.views:
        if view.camera.K[0, 1] != 0:
            raise OutputError(
                "camera-skew",
                f"camera {view.name} has skew, which neither transforms.json nor COLMAP can say",
                path=place,
                remedy="remove it from the photographs",
            )
    files = _make_files(light_field, place, points) | dict(more or {})
    parent = place.absolute().parent
    with output_errors(place):
        parent.mkdir(parents=True, exist_ok=True)
        with temporary_folder(place.name, parent) as part:
            for name, data in files.items():
                (part / name).parent.mkdir(parents=True, exist_ok=True)
                (part / name).write_bytes(data)
            flush_folder(part)
            with hold_signals():
                _move_into_place(part, place)


def refuse_folder(folder: Path, overwrite: bool) -> None:
    """Before any work: raise OutputError where a calibration may not or cannot be written to `folder`."""
    refuse_objects(folder)
    if folder.exists() and not folder.is_dir():
        raise OutputError("output-is-file", "is a file", path=folder, remedy="name a folder")
    with output_errors(folder):
        if folder.is_dir() and not overwrite and any(folder.iterdir()):
            remedy = "use --overwrite or another name"
            raise OutputError("output-exists", "exists and is not empty", path=folder, remedy=remedy)
    parent = folder.absolute().parent
    while not parent.exists():
        parent = parent.parent
    if not parent.is_dir() or not os.access(parent, os.W_OK):
        raise OutputError("not-writable", "cannot be made here", path=folder, remedy="name another place")


def _make_files(light_field: LightField, place: Path, points: SparsePoints | None) -> dict[str, bytes]:
    is_far = bool(light_field.origin.any())
    if points is not None and is_far:
        points = points.transform(1.0, np.eye(3), light_field.origin)
    light_field = light_field.where_it_stood()
    document = transforms_document(light_field, place, POINTS_FILE if points is not None else None)
    files = {TRANSFORMS_FILE: (json.dumps(document, indent=1, allow_nan=False) + "\n").encode()}
    model = colmap_model(light_field, points)
    if model is None:
        log.warning(
            "%s: COLMAP has no model for the lens, or for photographs that EXIF mirrors: only %s is written",
            place, TRANSFORMS_FILE,
        )  # fmt: skip
    else:
        files |= {f"{COLMAP_MODEL_FOLDER}/{name}": data for name, data in model.items()}
    if points is not None:
        files[POINTS_FILE] = _pack_ply(points, is_far)
    return files


def _pack_ply(points: SparsePoints, is_far: bool) -> bytes:
    record = np.zeros(len(points), [("position", "<f8" if is_far else "<f4", 3), ("colour", "u1", 3)])
    record["position"], record["colour"] = points.positions, points.colours
    lines = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    lines += [f"property {'double' if is_far else 'float'} {axis}" for axis in "xyz"]
    lines += [f"property uchar {name}" for name in ("red", "green", "blue")]
    return ("\n".join([*lines, "end_header"]) + "\n").encode() + record.tobytes()


def _move_into_place(part: Path, place: Path) -> None:
    """`part` as `place` by rename; entry by entry where `place` holds something that is to stay."""
    mode = place.stat().st_mode & 0o7777 if place.is_dir() else 0o777 & ~current_umask()
    part.chmod(mode)
    if not place.exists() or not any(place.iterdir()):
        if place.exists():
            place.rmdir()
        rename(part, place)
        return
    for entry in sorted(part.iterdir()):
        target = place / entry.name
        if target.is_dir() and not target.is_symlink():
            rename(target, part / f"old-{entry.name}")  # goes with `part`
        rename(entry, target)
