"""Screened Poisson surface reconstruction (Kazhdan and Hoppe, 2013), by the implementation in pycolmap."""

from __future__ import annotations

import io
import logging
from pathlib import Path

import numpy as np

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.proxy.child import run_child
from eigenfield.proxy.surface.fusion import OrientedPoints
from eigenfield.runtime.temporary import temporary_folder

log = logging.getLogger("eigenfield.proxy")

POISSON_MIN_DEPTH, POISSON_MAX_DEPTH = 5, 11
POISSON_MIN_POINTS = 50
POISSON_CELL_SPACINGS = 2.0  # width of a cell in spacings of the points: less follows the noise of depth
POISSON_BOX_MARGIN = 1.1  # size of the octree's cube relative to the points' box


def poisson_surface(points: OrientedPoints, *, progress: Progress | None = None) -> Mesh:
    """The watertight (or box-bounded) surface through oriented points; trim it with `trim_surface`.

    It runs in one thread of a child process: with more threads, the library's result differs from run to run.

    Raises:
        ProxyError: `surface-no-points`: too few points. `surface-poisson`: the library fails.
    """
    if len(points) < POISSON_MIN_POINTS:
        raise ProxyError(
            "surface-no-points",
            f"{len(points)} points are no surface",
            remedy="check the calibration (`eigenfield inspect CAPTURE`); photographs must overlap and have texture",
        )
    low, high = points.positions.min(axis=0), points.positions.max(axis=0)
    centre, scale = (low + high) / 2, float((high - low).max()) or 1.0
    depth = _octree_depth(points, scale)
    table = np.hstack([(points.positions - centre) / scale, points.normals]).astype(np.float32)
    report = progress or (lambda stage, done, total: None)
    report("surface", 0, 1)
    with temporary_folder() as folder:  # a child that is killed removes nothing
        answer = run_child(
            Path(__file__).with_name("poisson_process.py"), [table, np.array([depth])], lambda: report("surface", 0, 1),
            "surface-poisson", "the Poisson reconstruction",
            "ask for smaller photographs if memory ran out; else report it with these photographs", [str(folder)],
        )  # fmt: skip
    report("surface", 1, 1)
    written = io.BytesIO(answer)
    vertices, faces = (np.load(written, allow_pickle=False) for _ in range(2))
    log.info("Poisson: depth %d, %d triangles from %d points", depth, len(faces), len(points))
    mesh = Mesh((vertices.astype(np.float64) * scale + centre).astype(np.float32), faces)
    return _orient_like_points(mesh, points)


def _octree_depth(points: OrientedPoints, scale: float) -> int:
    """The depth at which a cell is about POISSON_CELL_SPACINGS of the points' median spacing wide."""
    cells = POISSON_BOX_MARGIN * scale / (POISSON_CELL_SPACINGS * float(np.median(points.spacing)))
    return int(np.clip(np.rint(np.log2(max(cells, 1.0))), POISSON_MIN_DEPTH, POISSON_MAX_DEPTH))


def _orient_like_points(mesh: Mesh, points: OrientedPoints) -> Mesh:
    """The mesh, inverted unless most triangles face as the points near them do."""
    from scipy.spatial import KDTree

    sample = np.linspace(0, len(mesh.faces) - 1, min(len(mesh.faces), 2000)).astype(np.int64)
    some = Mesh(mesh.vertices, mesh.faces[sample])
    middles = mesh.vertices[some.faces].astype(np.float64).mean(axis=1)
    nearest = KDTree(points.positions).query(middles)[1]
    if (some.face_normals() * points.normals[nearest]).sum() < 0:
        return Mesh(mesh.vertices, np.ascontiguousarray(mesh.faces[:, ::-1]))
    return mesh
