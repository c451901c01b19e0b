"""Fusion of the depth maps of many views into one set of oriented points.

A point stays if enough other views confirm it and no majority sees through it. Of the pixels that show one surface
element, the finest represents all of them. Merrell et al., "Real-Time Visibility-Based Fusion of Depth Maps", 2007.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.progress import Progress, track
from eigenfield.proxy.surface.fusion_kernels import (
    FUSION_LEVELS_PER_OCTAVE,
    confirm_points,
    estimate_normals,
    select_finest,
)
from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.reference_view import INDEX_FROM_PIXEL

log = logging.getLogger("eigenfield.proxy")

FUSION_ROWS_PER_TASK = 32
FUSION_MAX_POINTS = 1_500_000
FUSION_MIN_AGREEING_VIEWS = 2  # other views that must confirm a point
FUSION_CELL_GROWTH = 1.25  # of the cells in each step, until few enough points remain


@dataclass(frozen=True, eq=False)
class DepthView:
    """The depth map of one view.

    Attributes:
        camera: At the depth map's size.
        inverse_depth: (H, W) float32, 1 / depth along z at pixel centres; 0, negative or not finite where there is
            none.
        mask: (H, W) bool, True where the photograph is valid; None: everywhere.
    """

    camera: Camera
    inverse_depth: NDArray[np.float32]
    mask: NDArray[np.bool_] | None = None


@dataclass(frozen=True, eq=False)
class OrientedPoints:
    """Oriented points on surfaces.

    Attributes:
        positions: (n, 3) float64.
        normals: (n, 3) float32, unit, outwards.
        spacing: (n,) float32, world units: approximate distance to the next point, a pixel's width on the surface.
    """

    positions: NDArray[np.float64]
    normals: NDArray[np.float32]
    spacing: NDArray[np.float32]

    def __len__(self) -> int:
        return len(self.positions)

    def __getitem__(self, chosen: NDArray[np.bool_] | NDArray[np.int64]) -> OrientedPoints:
        return OrientedPoints(self.positions[chosen], self.normals[chosen], self.spacing[chosen])


@dataclass(frozen=True, eq=False)
class StackedViews:
    """All views, one after the other, as the kernels read them: see `fusion_kernels`."""

    layout: NDArray[np.int64]
    projections: NDArray[np.float64]
    unprojections: NDArray[np.float64]
    centres: NDArray[np.float64]
    inverse_depth: NDArray[np.float32]
    normals: NDArray[np.float32]
    level: NDArray[np.int16]
    inside: NDArray[np.uint8]

    def spacing(self, pixels: NDArray[np.int64]) -> NDArray[np.float64]:
        """(n,) widths of pixels on the surface, the middle of each level's range.

        Args:
            pixels: (n,) of all views' pixels.
        """
        return np.asarray(2.0 ** ((self.level[pixels] + 0.5) / FUSION_LEVELS_PER_OCTAVE))


def fuse_depth_maps(
    views: Sequence[DepthView],
    *,
    tolerance: float = 0.01,
    limit: int = FUSION_MAX_POINTS,
    progress: Progress | None = None,
) -> OrientedPoints:
    """One point a surface element, at the resolution of the finest view that shows it.

    The result does not depend on the number of threads.

    Args:
        tolerance: Relative difference of depth up to which two views agree.
        limit: Merge points into growing cells until at most so many remain.

    Raises:
        ProxyError: `surface-masked`: the masks leave nothing. `surface-no-points`: no views agree.
    """
    if not views:
        raise ProxyError("surface-no-points", "there are no depth maps", remedy="give at least three photographs")
    stack = stack_views(views)
    if not stack.inside.any():
        raise ProxyError(
            "surface-masked", "the masks hide every pixel", remedy="white counts, black is left out: invert the masks?"
        )
    total = len(stack.inverse_depth)
    mean, counts, keep = np.empty((total, 3)), np.zeros(total, np.int16), np.zeros(total, np.bool_)
    bands = [
        (v, *band)
        for v, (_, height, _) in enumerate(stack.layout)
        for band in pieces(int(height), FUSION_ROWS_PER_TASK)
    ]
    spans = [slice(start, start + height * width) for start, height, width in stack.layout.tolist()]

    def confirm(band: tuple[int, int, int]) -> None:
        confirm_points(
            *band, stack.layout, stack.projections, stack.unprojections, stack.centres, stack.inverse_depth,
            stack.normals, stack.inside, tolerance, FUSION_MIN_AGREEING_VIEWS, mean[spans[band[0]]],
            counts[spans[band[0]]],
        )  # fmt: skip

    def select(band: tuple[int, int, int]) -> None:
        select_finest(
            *band, stack.layout, stack.projections, mean, stack.normals, stack.level, counts, tolerance,
            keep[spans[band[0]]],
        )  # fmt: skip

    parts = pieces(len(bands), 64)
    for part in track(parts, "fusion", len(parts), progress):
        parallel_map(confirm, bands[slice(*part)])
    parallel_map(select, bands)
    chosen = np.flatnonzero(keep)
    if len(chosen) == 0:
        raise ProxyError(
            "surface-no-points",
            f"no point is confirmed by {FUSION_MIN_AGREEING_VIEWS + 1} of the {len(views)} views",
            remedy="check calibration and masks (`eigenfield inspect CAPTURE`); photographs must overlap, with texture",
        )
    points = OrientedPoints(mean[chosen], stack.normals[chosen], stack.spacing(chosen).astype(np.float32))
    log.info("fusion: %d points from %d views", len(points), len(views))
    return subsample_points(points, limit)


def subsample_points(points: OrientedPoints, limit: int) -> OrientedPoints:
    """Merge points in growing cells until few enough remain.

    The width of a cell is the spacing of its points times a factor that grows. Points whose normals lie in different
    octants stay apart, so that thin walls keep two sides.
    """
    factor, result = 1.0, points
    while len(result) > limit:
        result = _merge_cells(points, factor)
        factor *= FUSION_CELL_GROWTH
    return result


def join_points(*parts: OrientedPoints) -> OrientedPoints:
    """Several sets of points as one."""
    return OrientedPoints(
        np.concatenate([part.positions for part in parts]),
        np.concatenate([part.normals for part in parts]),
        np.concatenate([part.spacing for part in parts]),
    )


def sort_cells(
    positions: NDArray[np.float64], spacing: NDArray[np.floating[Any]], factor: float, *apart: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """The order (n,) that sorts points into cells, the start (c,) of each cell in it, and (n,) sizes.

    Args:
        spacing: (n,) of the points; a point's size is the next power of 2.
        factor: Width of a cell in units of its points' size.
        apart: (n,) integers: points that differ in one have different cells.
    """
    size = 2.0 ** np.ceil(np.log2(spacing.astype(np.float64)))
    cell = np.floor((positions - positions.min(axis=0)) / (factor * size)[:, None]).astype(np.int64)
    key = np.column_stack([np.log2(size).astype(np.int64), *apart, cell])
    order = np.lexsort(key.T[::-1])
    fresh = np.append(True, (np.diff(key[order], axis=0) != 0).any(axis=1))
    return order, np.flatnonzero(fresh), size


def _merge_cells(points: OrientedPoints, factor: float) -> OrientedPoints:
    octant = (points.normals > 0) @ np.array([1, 2, 4])
    order, starts, size = sort_cells(points.positions, points.spacing, factor, octant)
    count = np.diff(np.append(starts, len(order)))

    def average(values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.add.reduceat(values[order], starts, axis=0) / count.reshape(-1, *(1,) * (values.ndim - 1))

    normals = average(points.normals.astype(np.float64))
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    spacing = np.maximum(average(points.spacing.astype(np.float64)), factor * size[order][starts] / np.sqrt(2))
    return OrientedPoints(average(points.positions), normals.astype(np.float32), spacing.astype(np.float32))


def stack_views(views: Sequence[DepthView]) -> StackedViews:
    """Depth maps with the normals of their pixels, for the kernels."""
    layout = np.zeros((len(views), 3), np.int64)
    layout[:, 1:] = [view.inverse_depth.shape for view in views]
    layout[1:, 0] = np.cumsum(layout[:, 1] * layout[:, 2])[:-1]
    total = int((layout[:, 1] * layout[:, 2]).sum())
    stack = StackedViews(
        layout,
        np.stack([INDEX_FROM_PIXEL @ view.camera.matrix for view in views]),
        np.stack([view.camera.R.T @ np.linalg.inv(INDEX_FROM_PIXEL @ view.camera.K) for view in views]),
        np.stack([view.camera.centre for view in views]),
        np.zeros(total, np.float32),
        np.zeros((total, 3), np.float32),
        np.zeros(total, np.int16),
        np.ones(total, np.uint8),
    )

    def fill(number: int) -> None:
        view = views[number]
        start, height, width = layout[number]
        span = slice(start, start + height * width)
        depth = np.where(np.isfinite(view.inverse_depth), view.inverse_depth, 0)
        if view.mask is not None:
            stack.inside[span] = view.mask.reshape(-1)
            depth = np.where(view.mask, depth, 0)
        stack.inverse_depth[span] = np.maximum(depth, 0).reshape(-1)
        flat = stack.inverse_depth[span].reshape(height, width)
        normals, level = stack.normals[span].reshape(height, width, 3), stack.level[span].reshape(height, width)
        estimate_normals(flat, INDEX_FROM_PIXEL @ view.camera.K, view.camera.R, 0, height, normals, level)

    parallel_map(fill, range(len(views)))
    return stack
