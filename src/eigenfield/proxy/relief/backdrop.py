"""The backdrop of a relief: a surface close behind its layers, kept where a view would see past them.

With b the farthest label of the layers at each pixel of the reference view, the backdrop lies at

    min over a cell of (opening of b) - gap.

The opening removes small objects before their surroundings, and these continue behind them. The backdrop has no cuts
and reaches as far as any view does: together with it the layers leave no pixel open.
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
from eigenfield.proxy.relief.height_field import (
    HeightFieldMesh,
    extract_faces,
    height_field_to_world,
    join_height_fields,
)
from eigenfield.runtime.parallel import parallel_stream
from eigenfield.stereo import ReferenceView

log = logging.getLogger("eigenfield.proxy")

BACKDROP_SIDE_CELLS = 160  # along the longer side of the reference view
BACKDROP_OPENING_SIDES = 1 / 24  # of the longer side: narrower objects stand before the backdrop
BACKDROP_MAX_BORDER_SIDES = 0.5  # of the longer side, beyond the reference view
BACKDROP_SPARSE_CAMERAS = 100  # with fewer, views between them are closed too
BACKDROP_BETWEEN_NEIGHBOURS = 3  # nearest cameras of each, halfway to which such a view stands


def make_backdrop(
    reference: ReferenceView,
    layers: Sequence[HeightFieldMesh],
    cameras: Sequence[Camera],
    *,
    gap: float,
    limit: int,
    progress: Progress | None = None,
) -> HeightFieldMesh | None:
    """The triangles of the backdrop that some camera sees past all layers; None if the layers leave nothing open.

    Args:
        gap: Labels by which it stays behind the layers.
    """
    views = [*cameras, *(cameras_between(cameras) if len(cameras) < BACKDROP_SPARSE_CAMERAS else [])]
    meshes = [height_field_to_world(reference, layer) for layer in layers]
    mesh = height_field_to_world(reference, join_height_fields(layers))

    def find_open(camera: Camera) -> tuple[Camera, NDArray[np.bool_]]:
        return camera, rasterise_view(mesh, camera).face < 0

    found = track(parallel_stream(find_open, views), "what lies open", len(views), progress)
    open_views = [(camera, free) for camera, free in found if free.any()]
    if not open_views:
        return None
    wide = _widen_reference(reference, layers, cameras)
    farthest = _farthest_labels(wide, meshes)
    cell = max(2, round(max(reference.shape) / BACKDROP_SIDE_CELLS))
    while True:
        grid = _grid_mesh(farthest, cell, gap)
        far = height_field_to_world(wide, grid)
        kept = np.zeros(len(grid.faces), np.bool_)
        for camera, free in open_views:
            face = rasterise_view(far, camera).face[free]
            kept[face[face >= 0]] = True
        if kept.sum() <= limit or 2 * cell > max(reference.shape):
            break
        cell *= 2
    log.info("backdrop: %d triangles close %d views", kept.sum(), len(open_views))
    if not kept.any():
        return None
    shift = wide.margin - reference.margin
    part = extract_faces(grid, np.flatnonzero(kept))
    return replace(part, x=part.x - shift, y=part.y - shift)


def cameras_between(cameras: Sequence[Camera]) -> list[Camera]:
    """Cameras halfway from each to its nearest neighbours, with its direction.

    Args:
        cameras: At least two.
    """
    centres = np.array([camera.centre for camera in cameras])
    apart = np.linalg.norm(centres[:, None] - centres[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    nearest = np.argsort(apart, axis=1, kind="stable")[:, : min(BACKDROP_BETWEEN_NEIGHBOURS, len(cameras) - 1)]
    pairs = sorted({(min(i, int(j)), max(i, int(j))) for i, row in enumerate(nearest) for j in row})
    return [replace(cameras[i], t=-cameras[i].R @ (centres[i] + centres[j]) / 2) for i, j in pairs]


def _widen_reference(
    reference: ReferenceView, layers: Sequence[HeightFieldMesh], cameras: Sequence[Camera]
) -> ReferenceView:
    """The reference view with a margin that holds every camera's frame at the depths of the layers."""
    labels = np.concatenate([layer.d for layer in layers])
    height, width = reference.shape
    beyond = 0.0
    for camera in cameras:
        corners = np.array([(x, y, 1.0) for x in (0, camera.width) for y in (0, camera.height)])
        rays = corners @ np.linalg.inv(camera.K).T @ camera.R @ reference.camera.R.T  # in the reference camera's frame
        start = reference.camera.R @ camera.centre + reference.camera.t
        for label in (labels.min(), labels.max()):
            inverse = reference.offset + reference.scale * label
            if inverse <= 0 or (rays[:, 2] <= 0).any():
                continue
            points = start + rays * ((1 / inverse - start[2]) / rays[:, 2])[:, None]
            pixels = (points @ reference.camera.K.T)[:, :2] * inverse
            beyond = max(beyond, float(-pixels.min()), float((pixels - (width, height)).max()))
    pad = int(np.ceil(min(beyond, BACKDROP_MAX_BORDER_SIDES * max(reference.shape)))) + 2
    wide = ReferenceView.with_margin(reference.camera, pad, reference.offset, reference.scale)
    return replace(wide, margin=reference.margin + pad)


def _farthest_labels(reference: ReferenceView, layers: Sequence[Mesh]) -> NDArray[np.float32]:
    """(h, w) the smallest label of the layers at each pixel, extrapolated where there is none."""
    result = np.full(reference.shape, np.inf, np.float32)
    for layer in layers:
        raster = rasterise_view(layer, reference.camera)
        label = (raster.inverse_depth - reference.offset) / reference.scale
        result = np.where(raster.face >= 0, np.minimum(result, label), result).astype(np.float32)
    row, column = distance_transform_edt(~np.isfinite(result), return_distances=False, return_indices=True)
    return np.asarray(result[row, column], np.float32)


def _grid_mesh(farthest: NDArray[np.float32], cell: int, gap: float) -> HeightFieldMesh:
    """The whole backdrop, as a grid of cells."""
    size = 2 * round(BACKDROP_OPENING_SIDES * max(farthest.shape) / 2) + 1
    opened = cv2.morphologyEx(farthest, cv2.MORPH_OPEN, np.ones((size, size), np.uint8))
    behind = cv2.erode(opened, np.ones((2 * cell + 1, 2 * cell + 1), np.uint8)) - np.float32(gap)
    height, width = farthest.shape
    rows = np.unique(np.append(np.arange(0, height, cell), height - 1))
    columns = np.unique(np.append(np.arange(0, width, cell), width - 1))
    x, y = np.meshgrid(columns.astype(np.float64), rows.astype(np.float64))
    a = (np.arange(len(rows) - 1)[:, None] * len(columns) + np.arange(len(columns) - 1)).reshape(-1)
    b, c, d = a + 1, a + len(columns) + 1, a + len(columns)
    faces = np.stack([a, b, c, a, c, d], axis=1).reshape(-1, 3).astype(np.int32)
    depth = behind[np.ix_(rows, columns)].reshape(-1).astype(np.float64)
    return HeightFieldMesh(x.reshape(-1), y.reshape(-1), depth, faces)
