"""Files in the folder of a stage, which restore their values exactly."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration import PlanarArray
from eigenfield.capture import Capture, Lens, LightField
from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.stereo import ReferenceView

STAGE_MESH_FILE, STAGE_ERROR_FILE = "mesh.ply", "error.json"
STAGE_CAMERAS_FILE, STAGE_DEPTH_FILE = "cameras.npz", "depth.npz"
STAGE_WIDE_FILE = "wide"  # empty: an array is too wide for a relief
STAGE_PROXY_FILE, STAGE_TRIAL_FILE = "proxy.npz", "trial.json"


def write_cameras(path: Path, capture: Capture, light_field: LightField, points: NDArray[np.float64]) -> None:
    """Write cameras, lenses, problems and points.

    Args:
        capture: All photographs.
        light_field: Those with a camera.
        points: (n, 3) points of structure from motion.
    """
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
    """The light field and points that `write_cameras` wrote."""
    with np.load(path) as data:
        kept = [int(i) for i in data["kept"]]
        cameras = [
            Camera(K, R, t, int(size[0]), int(size[1]))
            for K, R, t, size in zip(data["K"], data["R"], data["t"], data["sizes"], strict=True)
        ]
        known = [None if not text else json.loads(str(text)) for text in data["lenses"]]
        problems, points = tuple(map(str, data["problems"])), data["points"]
    lenses = [None if lens is None else Lens(lens[0], tuple(lens[1])) for lens in known]
    light_field = capture.subset(kept).with_cameras(cameras, lenses)
    return replace(light_field, problems=problems), points


def write_planar(path: Path, planar: PlanarArray) -> None:
    """Write the depth map of an array and the matrices of its views."""
    reference = planar.reference
    views = np.arange(len(planar.parameters))
    np.savez(
        path, d=planar.d, count=planar.count, K=reference.camera.K, R=reference.camera.R, t=reference.camera.t,
        reference=[reference.margin, reference.offset, reference.scale],
        matrices=planar.model.matrices(reference, views, planar.parameters),
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class ArrayDepth:
    """The depth map of an array, as `write_planar` wrote it.

    Attributes:
        d: (h, w) labels.
        count: (h, w) number of views that see each point.
        matrices: (n, 3, 4) of the views.
    """

    reference: ReferenceView
    d: NDArray[np.float32]
    count: NDArray[np.int32]
    matrices: NDArray[np.float64]


def read_planar(path: Path) -> ArrayDepth:
    """The depth map that `write_planar` wrote."""
    with np.load(path) as data:
        d = data["d"]
        margin, offset, scale = data["reference"].tolist()
        camera = Camera(data["K"], data["R"], data["t"], d.shape[1], d.shape[0])
        return ArrayDepth(ReferenceView(camera, int(margin), offset, scale), d, data["count"], data["matrices"])


def write_proxy(path: Path, proxy: Proxy) -> None:
    """Write a proxy with sheets.

    Args:
        proxy: With an atlas; with or without a lattice.
    """
    mesh, lattice, sheets = proxy.mesh, proxy.lattice, proxy.sheets
    assert mesh.uv is not None and sheets is not None
    arrays: dict[str, NDArray[Any]] = {
        "vertices": mesh.vertices,
        "faces": mesh.faces,
        "uv": mesh.uv,
        "opacity": sheets.opacity,
    }
    arrays["sheets"] = np.array(sheets.faces)
    if lattice is not None:
        arrays |= {"matrix": lattice.matrix, "flat": np.array(lattice.flat), "fine": np.array(lattice.fine)}
    with path.open("wb") as file:
        np.savez_compressed(file, allow_pickle=False, **arrays)


def read_proxy(path: Path) -> Proxy:
    """The proxy that `write_proxy` wrote."""
    with np.load(path) as data:
        lattice = None
        if "matrix" in data:
            lattice = Lattice(data["matrix"], bool(data["flat"]), int(data["fine"]))
        sheets = Sheets(tuple(data["sheets"].tolist()), data["opacity"])
        return Proxy(Mesh(data["vertices"], data["faces"], data["uv"]), lattice, sheets)
