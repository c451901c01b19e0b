"""What a stage keeps in its folder, read back to the bit."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate import (
    PlanarArray,
)
from eigenfield.capture import Capture, Lens, LightField
from eigenfield.core.camera import Camera
from eigenfield.stereo import ReferenceView

MESH, ERROR, CAMERAS, DEPTH = "mesh.ply", "error.json", "cameras.npz", "depth.npz"


def write_cameras(path: Path, capture: Capture, light_field: LightField, points: NDArray[np.float64]) -> None:
    index = {name: i for i, name in enumerate(capture.names)}
    cameras = light_field.cameras
    lenses = [
        "" if view.lens is None else json.dumps([view.lens.model, list(view.lens.coefficients)])
        for view in light_field.views
    ]
    np.savez(
        path, kept=[index[name] for name in light_field.names], K=[c.K for c in cameras], R=[c.R for c in cameras],
        t=[c.t for c in cameras], sizes=[(c.width, c.height) for c in cameras], lenses=np.array(lenses),
        problems=np.array(light_field.problems, dtype=str), points=points,
    )  # fmt: skip


def read_cameras(path: Path, capture: Capture) -> tuple[LightField, NDArray[np.float64]]:
    with np.load(path) as data:
        kept = [int(i) for i in data["kept"]]
        cameras = [
            Camera(K, R, t, int(size[0]), int(size[1]))
            for K, R, t, size in zip(data["K"], data["R"], data["t"], data["sizes"], strict=True)
        ]
        known = [None if not text else json.loads(str(text)) for text in data["lenses"]]
        problems, points = tuple(map(str, data["problems"])), data["points"]
    lenses = [None if lens is None else Lens(lens[0], tuple(lens[1])) for lens in known]
    light_field = capture.subset(kept).calibrated(cameras, lenses)
    return replace(light_field, problems=problems), points


def write_planar(path: Path, planar: PlanarArray) -> None:
    canvas = planar.reference
    views = np.arange(len(planar.parameters))
    np.savez(
        path, d=planar.d, confidence=planar.confidence, texture=planar.texture, count=planar.count, K=canvas.camera.K,
        R=canvas.camera.R, t=canvas.camera.t, canvas=[canvas.margin, canvas.offset, canvas.scale],
        matrices=planar.model.matrices(canvas, views, planar.parameters), range=[planar.low, planar.high],
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class ArrayDepth:
    """What `write_planar` kept: the depth map of an array, and how its views look at it."""

    canvas: ReferenceView
    d: NDArray[np.float32]
    confidence: NDArray[np.float32]
    texture: NDArray[np.float32]
    count: NDArray[np.int32]
    matrices: NDArray[np.float64]
    low: float
    high: float


def read_planar(path: Path) -> ArrayDepth:
    with np.load(path) as data:
        d = data["d"]
        margin, offset, scale = data["canvas"].tolist()
        camera = Camera(data["K"], data["R"], data["t"], d.shape[1], d.shape[0])
        low, high = data["range"].tolist()
        return ArrayDepth(
            ReferenceView(camera, int(margin), offset, scale), d, data["confidence"], data["texture"], data["count"],
            data["matrices"], low, high,
        )  # fmt: skip
