"""A mesh with an atlas: its own where it has one, else charts by xatlas.

xatlas cuts charts by the planarity and compactness of groups of triangles, lays them out by least-squares conformal
maps (Lévy et al., "Least Squares Conformal Maps for Automatic Texture Atlas Generation", 2002), flat ones by
projection, and packs them at even density.
"""

from __future__ import annotations

import io
import logging
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.errors import OptionError, ProxyError
from eigenfield.mesh import Mesh
from eigenfield.progress import Progress
from eigenfield.proxy.atlas import OVERLAP_TOLERANCE, atlas_fault, atlas_statistics
from eigenfield.proxy.read import is_sliver

log = logging.getLogger("eigenfield.proxy")

DEFAULT_TRIANGLES = 30_000
FEWEST_TRIANGLES = 4
TICK = 0.2  # seconds between two calls of `progress` while xatlas works
LOST_TOLERANCE = 0.01  # of the surface may be in no chart


def unwrapped(mesh: Mesh, *, triangles: int | None = None, progress: Progress | None = None) -> Mesh:
    """The mesh with a valid atlas (see `atlas_fault`), one UV a vertex.

    triangles: simplify to this many at most; None keeps a mesh that has an atlas as it is, and simplifies others to
    DEFAULT_TRIANGLES. A simplified mesh gets new charts. Raises OptionError `triangles`; ProxyError `proxy-unwrap`.
    """
    if triangles is not None and triangles < FEWEST_TRIANGLES:
        raise OptionError(
            "triangles", f"{triangles} triangles were asked for", remedy=f"ask for {FEWEST_TRIANGLES} or more"
        )
    fault = atlas_fault(mesh)
    if fault is None and (triangles is None or len(mesh.faces) <= triangles):
        assert mesh.uv is not None
        return Mesh(mesh.vertices, mesh.faces, np.clip(mesh.uv, 0, 1))
    if fault is None:
        log.info("the mesh's own atlas is given up for fewer triangles")
    elif mesh.uv is not None:
        log.warning("the mesh's own texture coordinates are no atlas: %s; new charts are cut", fault)
    plain = welded(mesh)
    limit = DEFAULT_TRIANGLES if triangles is None else triangles
    if len(plain.faces) > limit:
        plain = simplified(plain, limit)
        log.warning("the mesh is simplified from %d to %d triangles", len(mesh.faces), len(plain.faces))
    result = _charts(plain, progress)
    statistics = atlas_statistics(result)
    log.info("atlas: %s", statistics)
    if statistics.overlap > OVERLAP_TOLERANCE:
        log.warning("the new charts overlap by %.1f%%: expect ghosts there", 100 * statistics.overlap)
    return result


def welded(mesh: Mesh) -> Mesh:
    """Vertices at the same place to the bit made one, UVs dropped: undoes the doubling along the seams of an atlas."""
    vertices, first, index = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # in the order in which they came
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    faces = rank[index.reshape(-1)][mesh.faces].astype(np.int32)
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return Mesh(vertices[order], faces[whole])


def simplified(mesh: Mesh, triangles: int) -> Mesh:
    """At most about `triangles` of them, by quadric edge collapse (fast-simplification); without UVs."""
    from fast_simplification import simplify

    centre, scale = _frame(mesh)
    points, faces = simplify(
        (mesh.vertices.astype(np.float64) - centre) / scale, mesh.faces.astype(np.int64), target_count=triangles
    )
    vertices = (np.asarray(points, np.float64) * scale + centre).astype(np.float32)
    kept = np.asarray(faces, np.int64)
    kept = kept[~is_sliver(vertices, kept)]
    if len(kept) == 0:
        raise ProxyError(
            "proxy-degenerate",
            f"nothing is left of the mesh at {triangles} triangles",
            remedy="ask for more --triangles",
        )
    used, index = np.unique(kept, return_inverse=True)
    return Mesh(vertices[used], index.reshape(kept.shape).astype(np.int32))


def _frame(mesh: Mesh) -> tuple[NDArray[np.float64], float]:
    """Centre and mean edge length: thresholds of the libraries are absolute, meant for numbers near 1."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    low, high = mesh.vertices.min(axis=0).astype(np.float64), mesh.vertices.max(axis=0).astype(np.float64)
    return (low + high) / 2, float(edges.mean()) or 1.0


def _charts(mesh: Mesh, progress: Progress | None) -> Mesh:
    centre, scale = _frame(mesh)
    vertices = ((mesh.vertices - centre) / scale).astype(np.float32)
    message = io.BytesIO()
    np.save(message, vertices)
    np.save(message, mesh.faces.astype(np.uint32))
    answer = io.BytesIO(_run_xatlas(message.getvalue(), progress))
    origin, corners, texels, laid_out, size = (np.load(answer, allow_pickle=False) for _ in range(5))
    uv = (texels * (size / size.max())).astype(np.float32)  # xatlas divides each axis by its own size
    faces = corners.astype(np.int32)
    held = laid_out[faces].all(axis=1)
    if not held.all():
        area = _areas(mesh.vertices[origin], faces)
        if not held.any() or area[~held].sum() > LOST_TOLERANCE * area.sum():
            raise ProxyError(
                "proxy-unwrap",
                f"no chart could be found for {int((~held).sum())} of {len(faces)} triangles",
                remedy="clean the mesh (double faces, edges with more than two triangles) or give it UVs elsewhere",
            )
        log.warning("%d of %d triangles could not be laid out: dropped", int((~held).sum()), len(faces))
        faces = faces[held]
    used, index = np.unique(faces, return_inverse=True)
    return Mesh(
        np.ascontiguousarray(mesh.vertices[origin[used]]),
        index.reshape(faces.shape).astype(np.int32),
        np.clip(uv[used], 0, 1),
    )


def _areas(vertices: NDArray[np.float32], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    p = vertices[faces].astype(np.float64)
    return np.asarray(np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2)


def _run_xatlas(message: bytes, progress: Progress | None) -> bytes:
    """What `xatlas_process.py` answers; it is ended when the waiting is (Ctrl-C, or an exception from `progress`)."""
    command = [sys.executable, "-P", str(Path(__file__).with_name("xatlas_process.py"))]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(entry for entry in sys.path if entry)}
    if progress is not None:
        progress("atlas", 0, 1)
    process = subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment
    )
    pending: bytes | None = message
    try:
        while True:
            try:
                answer, complaint = process.communicate(pending, timeout=TICK)
                break
            except subprocess.TimeoutExpired:
                pending = None  # already on its way
                if progress is not None:
                    progress("atlas", 0, 1)
    except BaseException:
        process.kill()
        process.communicate()
        raise
    if process.returncode != 0:
        last = complaint.decode(errors="replace").strip().splitlines()[-1:]
        raise ProxyError(
            "proxy-unwrap",
            f"xatlas ended with {process.returncode}{': ' + last[0] if last else ''}",
            remedy="clean the mesh, ask for fewer --triangles, or give it UVs elsewhere",
        )
    if progress is not None:
        progress("atlas", 1, 1)
    return answer
