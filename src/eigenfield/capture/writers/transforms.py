"""Writing `transforms.json` as nerfstudio and instant-ngp read it (see `transforms.py` for the conventions)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.photographs.lens import Lens
from eigenfield.capture.readers.transforms import OPENGL_TO_OPENCV_AXES, TRANSFORMS_OWN_MODEL, TRANSFORMS_TURNED_KEY
from eigenfield.capture.writers.stored import turned_orientation

NERFSTUDIO_LENSES = ("brown", "fisheye")  # lenses that nerfstudio's keys describe


def transforms_document(light_field: LightField, folder: Path, points: str | None) -> dict[str, Any]:
    """The JSON of a calibration.

    Intrinsics stand at the top where all views share them, which some readers need, else in every frame.

    Args:
        folder: Of the file; paths are relative to it.
        points: Name of a PLY of the sparse points in the same folder; None for none.
    """
    intrinsics = [_intrinsics(view) for view in light_field.views]
    common = intrinsics[0] if all(entry == intrinsics[0] for entry in intrinsics) else None
    top: dict[str, Any] = {} if common is None else dict(common)
    if points is not None:
        top["ply_file_path"] = points
    top["frames"] = [
        {**_frame(view, folder), **({} if common is not None else entry)}
        for view, entry in zip(light_field.views, intrinsics, strict=True)
    ]
    return top


def _intrinsics(view: View) -> dict[str, Any]:
    camera = view.camera
    K = camera.K
    return {
        "camera_model": "OPENCV" if view.lens is None else _model(view.lens),
        "w": camera.width, "h": camera.height,
        "fl_x": float(K[0, 0]), "fl_y": float(K[1, 1]), "cx": float(K[0, 2]), "cy": float(K[1, 2]),
        **_coefficients(view.lens),
    }  # fmt: skip


def _model(lens: Lens) -> str:
    if lens.model not in NERFSTUDIO_LENSES:
        return TRANSFORMS_OWN_MODEL
    return "OPENCV" if lens.model == "brown" else "OPENCV_FISHEYE"


def _coefficients(lens: Lens | None) -> dict[str, Any]:
    if lens is None:
        return {}
    if lens.model not in NERFSTUDIO_LENSES:
        return {"lens": {"model": lens.model, "coefficients": [float(c) for c in lens.coefficients]}}
    names = ("k1", "k2", "p1", "p2", "k3") if lens.model == "brown" else ("k1", "k2", "k3", "k4")
    found = dict(zip(names, (float(c) for c in lens.coefficients), strict=True))
    if found.get("k3") == 0 and lens.model == "brown":
        del found["k3"]  # instant-ngp takes it for a fisheye's
    return found


def _frame(view: View, folder: Path) -> dict[str, Any]:
    camera = view.camera
    pose = np.eye(4)
    pose[:3, :3] = (OPENGL_TO_OPENCV_AXES @ camera.R).T
    pose[:3, 3] = camera.centre
    frame: dict[str, Any] = {"file_path": relative_path(view.path, folder), "transform_matrix": pose.tolist()}
    if view.mask is not None:
        frame["mask_path"] = relative_path(view.mask, folder)
    if turned_orientation(view) != 1:
        frame[TRANSFORMS_TURNED_KEY] = True
    return frame


def relative_path(path: Path, folder: Path) -> str:
    """A path relative to a folder, with forward slashes; the whole path where it is on another drive (Windows)."""
    try:
        return Path(os.path.relpath(path.absolute(), folder.absolute())).as_posix()
    except ValueError:
        return path.absolute().as_posix()
