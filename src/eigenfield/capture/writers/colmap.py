"""Writing COLMAP's sparse models, binary (https://colmap.github.io/format.html): what `colmap.py` reads, and points.

COLMAP works on pixels as they are stored: cameras of photographs that EXIF turns are turned
back. Image names are relative to the light field's root: `colmap gui --image_path ROOT` finds them.
"""

from __future__ import annotations

import struct

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.points import SparsePoints
from eigenfield.capture.readers.colmap import COLMAP_MODELS
from eigenfield.capture.writers.stored import stored_pixels, stored_view
from eigenfield.capture.writers.transforms import relative_path
from eigenfield.core.camera import Camera

COLMAP_FULL_COEFFICIENTS = 8  # of OpenCV's rational lens that COLMAP's FULL_OPENCV has


def colmap_camera(camera: Camera, lens: Lens | None) -> tuple[str, tuple[float, ...]] | None:
    """The name of the simplest of COLMAP's models and its parameters; None where none describes the lens."""
    K = camera.K
    fx, fy, cx, cy = (float(v) for v in (K[0, 0], K[1, 1], K[0, 2], K[1, 2]))
    if K[0, 1] != 0:
        return None
    if lens is None:
        return "PINHOLE", (fx, fy, cx, cy)
    c = tuple(float(v) for v in lens.coefficients)
    if lens.model == "fisheye":
        return "OPENCV_FISHEYE", (fx, fy, cx, cy, *c)
    if lens.model == "rational" and not any(c[COLMAP_FULL_COEFFICIENTS:]):
        return "FULL_OPENCV", (fx, fy, cx, cy, *c[:COLMAP_FULL_COEFFICIENTS])
    if lens.model != "brown":
        return None
    if c[4]:
        return "FULL_OPENCV", (fx, fy, cx, cy, *c, 0.0, 0.0, 0.0)
    if fx == fy and not any(c[1:]):
        return "SIMPLE_RADIAL", (fx, cx, cy, c[0])
    return "OPENCV", (fx, fy, cx, cy, *c[:4])


def colmap_model(light_field: LightField, points: SparsePoints | None) -> dict[str, bytes] | None:
    """`cameras.bin`, `images.bin` and `points3D.bin`; None where COLMAP has no model for one of the lenses, or EXIF
    mirrors a photograph."""
    numbers: dict[tuple[object, ...], int] = {}
    records, owner, views = [], [], []
    for upright in light_field.views:
        view = stored_view(upright)
        described = None if view is None else colmap_camera(view.camera, view.lens)
        if view is None or described is None:
            return None
        views.append(view)
        key = (*described, view.camera.width, view.camera.height)
        if key not in numbers:
            numbers[key] = len(numbers) + 1
            model, parameters = described
            head = struct.pack("<IiQQ", numbers[key], COLMAP_MODELS[model][0], view.camera.width, view.camera.height)
            records.append(head + struct.pack(f"<{len(parameters)}d", *parameters))
        owner.append(numbers[key])
    return {
        "cameras.bin": struct.pack("<Q", len(records)) + b"".join(records),
        "images.bin": _pack_images(light_field, views, owner, points),
        "points3D.bin": _pack_points(light_field, points),
    }


def _pack_images(light_field: LightField, stored: list[View], owner: list[int], points: SparsePoints | None) -> bytes:
    records = [struct.pack("<Q", len(light_field))]
    for index, (view, camera) in enumerate(zip(stored, owner, strict=True)):
        record = np.zeros(0, np.dtype([("x", "<f8"), ("y", "<f8"), ("point", "<u8")]))
        if points is not None:
            here = np.flatnonzero(points.view == index)
            record = np.zeros(len(here), record.dtype)
            moved = stored_pixels(light_field.views[index])
            assert moved is not None, "such a view has no model"
            record["x"], record["y"] = moved[:2, :2] @ points.pixels[here].T + moved[:2, 2:]
            record["point"] = points.point[here] + 1
        pose = struct.pack("<I7dI", index + 1, *quaternion(view.camera.R), *view.camera.t, camera)
        name = relative_path(view.path, light_field.root).encode("utf-8", "surrogateescape") + b"\0"
        records.append(pose + name + struct.pack("<Q", len(record)) + record.tobytes())
    return b"".join(records)


def _pack_points(light_field: LightField, points: SparsePoints | None) -> bytes:
    if points is None:
        return struct.pack("<Q", 0)
    place = np.zeros(len(points.view), np.int64)  # of each observation in its image's list
    for index in range(len(light_field)):
        here = np.flatnonzero(points.view == index)
        place[here] = np.arange(len(here))
    order = np.argsort(points.point, kind="stable")
    lengths = points.track_lengths
    ends = np.cumsum(lengths)
    records = [struct.pack("<Q", len(points))]
    for row, (position, colour, error) in enumerate(zip(points.positions, points.colours, points.errors, strict=True)):
        seen = order[ends[row] - lengths[row] : ends[row]]
        track = np.column_stack([points.view[seen] + 1, place[seen]]).astype("<u4")
        head = struct.pack("<Q3d3BdQ", row + 1, *position, *colour.tolist(), float(error), len(seen))
        records.append(head + track.tobytes())
    return b"".join(records)


def quaternion(R: NDArray[np.float64]) -> tuple[float, float, float, float]:
    """(w, x, y, z), w >= 0, of a rotation matrix."""
    x, y, z, w = Rotation.from_matrix(R).as_quat(canonical=True).tolist()
    return w, x, y, z
