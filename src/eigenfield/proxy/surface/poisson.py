"""Screened Poisson surface reconstruction (Kazhdan and Hoppe, 2013), by the implementation within pycolmap."""

from __future__ import annotations

import io
import logging
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.proxy.child import run_child
from eigenfield.proxy.surface.fusion import Points

log = logging.getLogger("eigenfield.proxy")

SHALLOWEST, DEEPEST = 5, 11
FEWEST_POINTS = 50
CELL = 2.0  # cells are about so many times as wide as points are apart: less follows the noise of depth
MARGIN = 1.1  # the octree's cube over the points' box


def poisson_surface(points: Points, *, depth: int | None = None, progress: Progress | None = None) -> Mesh:
    """The watertight (or box-bounded) surface through oriented points; trim it by what supports it (`trimmed`).

    depth: of the octree; None chooses it from the points' spacing. One thread, in a process of its own: with more, the
    library's result differs from run to run. Raises ProxyError `surface-no-points` for too few points,
    `surface-poisson` if the library fails.
    """
    if len(points) < FEWEST_POINTS:
        raise ProxyError(
            "surface-no-points",
            f"{len(points)} points are no surface",
            remedy="check the calibration (eigenfield inspect), and that the photographs overlap and have texture",
        )
    centre, scale = _frame(points.positions)
    chosen = octree_depth(points) if depth is None else depth
    table = np.hstack([(points.positions - centre) / scale, points.normals]).astype(np.float32)
    report = progress or (lambda stage, done, total: None)
    report("surface", 0, 1)
    answer = run_child(
        Path(__file__).with_name("poisson_process.py"), [table, np.array([chosen])], lambda: report("surface", 0, 1),
        "surface-poisson", "the Poisson reconstruction",
        "ask for smaller photographs if memory ran out; else report it with these photographs",
    )  # fmt: skip
    report("surface", 1, 1)
    written = io.BytesIO(answer)
    vertices, faces = (np.load(written, allow_pickle=False) for _ in range(2))
    log.info("Poisson: depth %d, %d triangles from %d points", chosen, len(faces), len(points))
    mesh = Mesh((vertices.astype(np.float64) * scale + centre).astype(np.float32), faces)
    return _facing(mesh, points)


def octree_depth(points: Points) -> int:
    """Such that a cell is about as wide as `CELL` of the points' median spacing."""
    _, scale = _frame(points.positions)
    cells = MARGIN * scale / (CELL * float(np.median(points.spacing)))
    return int(np.clip(np.rint(np.log2(max(cells, 1.0))), SHALLOWEST, DEEPEST))


def _frame(positions: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    low, high = positions.min(axis=0), positions.max(axis=0)
    return (low + high) / 2, float((high - low).max()) or 1.0


def _facing(mesh: Mesh, points: Points) -> Mesh:
    """Turned inside out unless most triangles face as the points near them do."""
    from scipy.spatial import KDTree

    sample = np.linspace(0, len(mesh.faces) - 1, min(len(mesh.faces), 2000)).astype(np.int64)
    some = Mesh(mesh.vertices, mesh.faces[sample])
    middles = mesh.vertices[some.faces].astype(np.float64).mean(axis=1)
    nearest = KDTree(points.positions).query(middles)[1]
    if (some.face_normals() * points.normals[nearest]).sum() < 0:
        return Mesh(mesh.vertices, np.ascontiguousarray(mesh.faces[:, ::-1]))
    return mesh
