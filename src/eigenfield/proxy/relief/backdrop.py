"""The backdrop of a relief: a sheet close behind its layers, kept where a view would see past them.

With b the farthest label of the layers at each pixel of the canvas, the backdrop lies at

    min over a cell of (opening of b) - gap;

the opening takes out what stands before its surroundings and is small, so that these go on behind it. The backdrop has
no cuts and reaches as far as any view does: together with it the layers leave no pixel open.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress, track
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.relief.sheet import Sheet, joined, sheet_mesh, used_part
from eigenfield.runtime.parallel import parallel_stream
from eigenfield.stereo import ReferenceView

log = logging.getLogger("eigenfield.proxy")

CELLS = 160  # of the backdrop along the longer side of the canvas
OPENING = 1 / 24  # of the longer side: what is narrower stands before the backdrop
WIDEST = 0.5  # of the longer side, by which the backdrop reaches beyond the canvas at most
SPARSE = 100  # cameras; where there are fewer, views between them are closed too
BETWEEN = 3  # nearest cameras of each, half way to which such a view stands


def backdrop(
    canvas: ReferenceView,
    layers: Sequence[Sheet],
    cameras: Sequence[Camera],
    *,
    gap: float,
    limit: int,
    progress: Progress | None = None,
) -> Sheet | None:
    """The triangles of the backdrop that some camera sees past all layers, at most about `limit`; None where the layers
    close everything. gap: in d, by how much it stays behind them."""
    views = [*cameras, *(_between(cameras) if len(cameras) < SPARSE else [])]
    meshes = [sheet_mesh(canvas, layer) for layer in layers]
    mesh = sheet_mesh(canvas, joined(layers))
    open_views: list[tuple[Camera, NDArray[np.bool_]]] = []

    def look(camera: Camera) -> tuple[Camera, NDArray[np.bool_]]:
        return camera, rasterise_view(mesh, camera).face < 0

    for camera, free in track(parallel_stream(look, views), "what lies open", len(views), progress):
        if free.any():
            open_views.append((camera, free))
    if not open_views:
        return None
    wide = _widened(canvas, layers, cameras)
    farthest = _farthest(wide, meshes)
    cell = max(2, round(max(canvas.shape) / CELLS))
    while True:
        sheet = _grid(farthest, cell, gap)
        far = sheet_mesh(wide, sheet)
        kept = np.zeros(len(sheet.faces), np.bool_)
        for camera, free in open_views:
            face = rasterise_view(far, camera).face[free]
            kept[face[face >= 0]] = True
        if kept.sum() <= limit or 2 * cell > max(canvas.shape):
            break
        cell *= 2
    log.info("backdrop: %d triangles close %d views", kept.sum(), len(open_views))
    if not kept.any():
        return None
    shift = wide.margin - canvas.margin
    part = used_part(sheet, np.flatnonzero(kept))
    return replace(part, x=part.x - shift, y=part.y - shift)


def _between(cameras: Sequence[Camera]) -> list[Camera]:
    """Cameras half way from each to its nearest neighbours, looking as it does."""
    centres = np.array([camera.centre for camera in cameras])
    apart = np.linalg.norm(centres[:, None] - centres[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    nearest = np.argsort(apart, axis=1, kind="stable")[:, : min(BETWEEN, len(cameras) - 1)]
    pairs = sorted({(min(i, int(j)), max(i, int(j))) for i, row in enumerate(nearest) for j in row})
    return [replace(cameras[i], t=-cameras[i].R @ (centres[i] + centres[j]) / 2) for i, j in pairs]


def _widened(canvas: ReferenceView, layers: Sequence[Sheet], cameras: Sequence[Camera]) -> ReferenceView:
    """The canvas with a margin that holds every camera's frame at the depths of the layers."""
    labels = np.concatenate([layer.d for layer in layers])
    height, width = canvas.shape
    beyond = 0.0
    for camera in cameras:
        corners = np.array([(x, y, 1.0) for x in (0, camera.width) for y in (0, camera.height)])
        rays = corners @ np.linalg.inv(camera.K).T @ camera.R @ canvas.camera.R.T  # in the reference camera's frame
        start = canvas.camera.R @ camera.centre + canvas.camera.t
        for label in (labels.min(), labels.max()):
            inverse = canvas.offset + canvas.scale * label
            if inverse <= 0 or (rays[:, 2] <= 0).any():
                continue
            points = start + rays * ((1 / inverse - start[2]) / rays[:, 2])[:, None]
            pixels = (points @ canvas.camera.K.T)[:, :2] * inverse
            beyond = max(beyond, float(-pixels.min()), float((pixels - (width, height)).max()))
    pad = int(np.ceil(min(beyond, WIDEST * max(canvas.shape)))) + 2
    inner = canvas.camera.K.copy()
    inner[:2, 2] += pad
    camera = replace(canvas.camera, K=inner, width=width + 2 * pad, height=height + 2 * pad)
    return replace(canvas, camera=camera, margin=canvas.margin + pad)


def _farthest(canvas: ReferenceView, layers: Sequence[Mesh]) -> NDArray[np.float32]:
    """(h, w) the least d of the layers at each pixel, carried on where there is none."""
    result = np.full(canvas.shape, np.inf, np.float32)
    for layer in layers:
        raster = rasterise_view(layer, canvas.camera)
        label = (raster.inverse_depth - canvas.offset) / canvas.scale
        result = np.where(raster.face >= 0, np.minimum(result, label), result).astype(np.float32)
    row, column = distance_transform_edt(~np.isfinite(result), return_distances=False, return_indices=True)
    return np.asarray(result[row, column], np.float32)


def _grid(farthest: NDArray[np.float32], cell: int, gap: float) -> Sheet:
    """The backdrop everywhere, as a grid of cells."""
    size = 2 * round(OPENING * max(farthest.shape) / 2) + 1
    opened = cv2.morphologyEx(farthest, cv2.MORPH_OPEN, np.ones((size, size), np.uint8))
    behind = cv2.erode(opened, np.ones((2 * cell + 1, 2 * cell + 1), np.uint8)) - np.float32(gap)
    height, width = farthest.shape
    rows = np.unique(np.append(np.arange(0, height, cell), height - 1))
    columns = np.unique(np.append(np.arange(0, width, cell), width - 1))
    x, y = np.meshgrid(columns.astype(np.float64), rows.astype(np.float64))
    a = (np.arange(len(rows) - 1)[:, None] * len(columns) + np.arange(len(columns) - 1)).reshape(-1)
    b, c, d = a + 1, a + len(columns) + 1, a + len(columns)
    faces = np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3).astype(np.int32)
    return Sheet(x.reshape(-1), y.reshape(-1), behind[np.ix_(rows, columns)].reshape(-1).astype(np.float64), faces)
