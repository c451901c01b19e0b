"""A mesh with an atlas: its own if it is valid, else a new one.

xatlas cuts charts by the planarity and compactness of groups of triangles. They are laid out by least-squares conformal
maps (`lscm`), scaled by the resolution of the photographs (`lscm_charts`), and packed by xatlas.
"""

from __future__ import annotations

import io
import logging
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError, ProxyError
from eigenfield.core.mesh import Mesh, triangle_areas
from eigenfield.core.progress import Progress
from eigenfield.proxy.atlas.layout import ATLAS_MAX_OVERLAP_FRACTION, atlas_fault, atlas_statistics, chart_labels
from eigenfield.proxy.atlas.lscm_charts import chart_scales, conformal_charts
from eigenfield.proxy.child import run_child
from eigenfield.proxy.simplify import PROXY_DEFAULT_TRIANGLES, normalisation, simplify_mesh, weld_vertices
from eigenfield.proxy.topology import remove_unused_vertices

log = logging.getLogger("eigenfield.proxy")

UNWRAP_MIN_TRIANGLES = 4
UNWRAP_MAX_LOST_FRACTION = 0.01  # of the surface, in no chart
UNWRAP_WORTH_SAYING = 1e-3  # of the surface in no chart, from which on a person is told


def unwrap_mesh(
    mesh: Mesh,
    *,
    triangles: int | None = None,
    cameras: Sequence[Camera] | None = None,
    progress: Progress | None = None,
) -> Mesh:
    """The mesh with a valid atlas (see `atlas_fault`), one UV a vertex.

    Args:
        triangles: Simplify to at most this many. None keeps a mesh with an atlas as it is, and simplifies others to
            PROXY_DEFAULT_TRIANGLES. A simplified mesh gets new charts.
        cameras: Give each new chart an area in proportion to their resolution (`chart_scales`), and give up an atlas
            that leaves hardly any texels to what they see. None: all charts alike.

    Raises:
        OptionError: `triangles`: too few.
        ProxyError: `proxy-unwrap`: the mesh cannot be unwrapped.
    """
    if triangles is not None and triangles < UNWRAP_MIN_TRIANGLES:
        raise OptionError(
            "triangles", f"{triangles} triangles were asked for", remedy=f"ask for {UNWRAP_MIN_TRIANGLES} or more"
        )
    fault = atlas_fault(mesh, cameras)
    if fault is None and (triangles is None or len(mesh.faces) <= triangles):
        assert mesh.uv is not None
        return Mesh(mesh.vertices, mesh.faces, np.clip(mesh.uv, 0, 1))
    if fault is None:
        log.info("the mesh's own atlas is given up for fewer triangles")
    elif mesh.uv is not None:
        log.warning("the mesh's own texture coordinates are no atlas: %s; new charts are cut", fault)
    plain = weld_vertices(mesh)
    if len(plain.vertices) < len(mesh.vertices):
        log.info("%d vertices at the places of others are joined", len(mesh.vertices) - len(plain.vertices))
    limit = PROXY_DEFAULT_TRIANGLES if triangles is None else triangles
    if len(plain.faces) > limit:
        plain = simplify_mesh(plain, limit)
        log.info("the mesh is simplified from %d to %d triangles", len(mesh.faces), len(plain.faces))
    result = _make_atlas(plain, cameras, progress)
    statistics = atlas_statistics(result)
    log.info("atlas: %s", statistics)
    if statistics.overlap > ATLAS_MAX_OVERLAP_FRACTION:
        log.warning("the new charts overlap by %.1f%%: expect ghosts there", 100 * statistics.overlap)
    return result


def _make_atlas(mesh: Mesh, cameras: Sequence[Camera] | None, progress: Progress | None) -> Mesh:
    report = progress or (lambda stage, done, total: None)
    report("atlas", 0, 3)
    centre, scale = normalisation(mesh)
    cut = _apply_xatlas(mesh, _run_xatlas((mesh.vertices - centre) / scale, mesh.faces, None, report, 0))
    report("atlas", 1, 3)
    laid = conformal_charts(cut)
    assert laid.uv is not None
    label = chart_labels(laid)
    uv = laid.uv.astype(np.float64) / scale
    if cameras:
        chart = np.zeros(len(uv), np.int32)
        chart[laid.faces] = label[:, None]
        uv *= chart_scales(laid, cameras)[chart][:, None]
    report("atlas", 2, 3)
    packed = _apply_xatlas(laid, _run_xatlas(uv, laid.faces, label, report, 2))
    report("atlas", 3, 3)
    return packed


def _apply_xatlas(mesh: Mesh, answer: bytes) -> Mesh:
    """The mesh as xatlas returns it: vertices duplicated along seams, UVs in 0..1 at one scale along both axes."""
    stream = io.BytesIO(answer)
    origin, corners, texels, laid_out, size = (np.load(stream, allow_pickle=False) for _ in range(5))
    uv = (texels * (size / size.max())).astype(np.float32)  # xatlas divides each axis by its own size
    faces = corners.reshape(-1, 3).astype(np.int32)
    held = laid_out[faces].all(axis=1)
    if not held.all():
        area = triangle_areas(mesh.vertices[origin][faces].astype(np.float64))
        lost, whole = area[~held].sum(), area.sum()
        if not held.any() or lost > UNWRAP_MAX_LOST_FRACTION * whole:
            raise ProxyError(
                "proxy-unwrap",
                f"no chart could be found for {int((~held).sum())} of {len(faces)} triangles",
                remedy="clean the mesh (double faces, edges with more than two triangles) or give it UVs elsewhere",
            )
        level = logging.WARNING if lost > UNWRAP_WORTH_SAYING * whole else logging.INFO
        log.log(level, "%d of %d triangles could not be laid out: dropped", int((~held).sum()), len(faces))
        faces = faces[held]
    return remove_unused_vertices(Mesh(mesh.vertices[origin], faces, np.clip(uv, 0, 1)))


def _run_xatlas(
    points: NDArray[np.float64],
    faces: NDArray[np.int32],
    chart: NDArray[np.int32] | None,
    report: Progress,
    done: int,
) -> bytes:
    """The answer of `xatlas_process.py` to (n, 3) positions or (n, 2) layouts of charts.

    Ctrl-C or an exception from `report`, which meanwhile reports `done` steps of three, ends the process.
    """
    labels = np.zeros(len(faces), np.uint32) if chart is None else chart.astype(np.uint32)
    return run_child(
        Path(__file__).with_name("xatlas_process.py"), [points.astype(np.float32), faces.astype(np.uint32), labels],
        lambda: report("atlas", done, 3), "proxy-unwrap", "xatlas",
        "clean the mesh, ask for fewer --triangles, or give it UVs elsewhere",
    )  # fmt: skip
