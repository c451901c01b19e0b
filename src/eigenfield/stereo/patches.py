"""PatchMatch stereo: slanted patches, compared by correlation, in place of single pixels on planes of constant depth.

It works at half resolution, where a sweep with semi-global matching gives the start. Patches exchange their planes with
their neighbours (Bleyer, Rhemann, Rother, PatchMatch Stereo, BMVC 2011). Correlation ignores exposure and gloss, and
only the better half of the views counts, so that those that do not see a point have no say. A second pass also asks
that the maps of the other views agree (Xu and Tao, Multi-Scale Geometric Consistency Guided Multi-View Stereo, CVPR
2019).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.estimate import label_step, sweep_coarse
from eigenfield.stereo.patch_kernels import (
    PATCH_RADIUS_TAPS,
    PATCH_SPACING_PIXELS,
    exchange_planes,
    plane_costs,
)
from eigenfield.stereo.views import (
    Pictures,
    check_matrices,
    halve_pictures,
    halved_matrices,
    inside_pictures,
    pack_pictures,
    unpack_pictures,
)

PATCH_ROWS_PER_TASK = 4
PATCH_REACH_FRACTION = 0.02  # of the range of labels: largest random change
PATCH_AGREED_REACH_FRACTION = 0.005  # the same once the other views' maps are known
PATCH_MARGIN = 0.01  # of cost, by which a plane must be better: where nothing tells, the sweep's smooth map stays
PATCH_GEOMETRIC_COST = 0.3  # that a view adds whose own map shows another depth
PATCH_MAX_SLOPE_LABELS = 1.0  # a pixel at half resolution
_ACROSS = np.arange(-PATCH_RADIUS_TAPS, PATCH_RADIUS_TAPS + 1) * PATCH_SPACING_PIXELS
PATCH_OFFSETS = np.stack(np.meshgrid(_ACROSS, _ACROSS)).reshape(2, -1).astype(np.float32)  # of the taps of a patch


@dataclass(frozen=True, eq=False)
class OtherMaps:
    """What the maps of the other views say, at half resolution.

    Attributes:
        inverse_depth: (V, h, w) of the views but the reference, in their own frames; 0 where there is none.
        offset: Inverse depth of label 0 in the reference view.
        scale: Inverse depth of one label there.
        tolerance: Relative difference of inverse depth from which maps count as different altogether.
        labels: (N, h, w) labels of the reference view to try; NaN where there is none.
    """

    inverse_depth: NDArray[np.float32]
    offset: float
    scale: float
    tolerance: float
    labels: NDArray[np.float32]


def match_patches(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    high: float,
    *,
    planes: NDArray[np.float32] | None = None,
    others: OtherMaps | None = None,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Depth of a reference view as a plane a point, at half resolution (rounded up).

    Args:
        pictures: (V, H, W, 3) uint8 or packed; the first is the reference camera's own. Photographs smaller than the
            frame begin in its corner at the top left.
        shape: (h, w) of the reference view, at most (H, W).
        high: Highest label; the lowest is 0.
        planes: To begin with. None: those of a sweep.
        others: The maps of the other views, if they are known.

    Returns:
        (h / 2, w / 2, 3) labels and their slopes along x and y, a pixel at half resolution; and (h / 2, w / 2) costs.
    """
    packed = pack_pictures(pictures)
    matrices = check_matrices(matrices, len(packed))
    if planes is None:
        planes = _sweep_planes(packed, matrices, shape, high)
    planes = np.array(planes, np.float32, order="C")
    reference, views = _kernel_views(halve_pictures(packed), halved_matrices(matrices), planes.shape[:2], others)
    cost = np.empty(planes.shape[:2], np.float32)
    bands = pieces(len(planes), PATCH_ROWS_PER_TASK)
    parallel_map(lambda band: plane_costs(*band, reference, views, PATCH_OFFSETS, planes, cost), bands)
    fraction = PATCH_REACH_FRACTION if others is None else PATCH_AGREED_REACH_FRACTION
    labels = np.zeros((0, *cost.shape), np.float32) if others is None else np.nan_to_num(others.labels, nan=-1)
    limits = [np.float32(limit) for limit in (high, PATCH_MAX_SLOPE_LABELS, fraction * high, PATCH_MARGIN)]
    for colour in (0, 1):  # a point reads those of the other colour only: the order of the bands has no effect
        fixed = colour, reference, views, PATCH_OFFSETS, *limits, np.ascontiguousarray(labels, np.float32), planes, cost
        parallel_map(partial(_exchange_rows, fixed), bands)
    return planes, cost


def _exchange_rows(fixed: tuple[Any, ...], rows: tuple[int, int]) -> None:
    exchange_planes(*rows, *fixed)


def _kernel_views(
    packed: NDArray[np.uint32], matrices: NDArray[np.float64], shape: tuple[int, int], others: OtherMaps | None
) -> tuple[NDArray[np.float32], tuple[Any, ...]]:
    """The grey reference picture, and the views as `_plane_cost` reads them."""
    grey = unpack_pictures(packed).astype(np.float32).mean(axis=-1)
    count, inside = len(packed) - 1, inside_pictures(packed[1:])
    sizes = np.stack([inside.any(axis=axis).sum(axis=1) for axis in (2, 1)], axis=1)
    known = others or OtherMaps(np.zeros((count, 0), np.float32), 0, 1, 1, np.zeros((0, *shape), np.float32))
    depths = np.ascontiguousarray(known.inverse_depth, np.float32).reshape(count, -1)
    numbers = [np.float32(v) for v in (known.offset, known.scale, known.tolerance, PATCH_GEOMETRIC_COST)]
    views = matrices[1:].astype(np.float32), grey[1:].reshape(count, -1), sizes, grey.shape[2], depths, *numbers
    return np.ascontiguousarray(grey[0, : shape[0], : shape[1]]), views


def upsample_planes(planes: NDArray[np.float32], shape: tuple[int, int]) -> NDArray[np.float32]:
    """(h, w) labels at full resolution, each on the plane of the pixel of half the resolution that holds it.

    Args:
        planes: (ceil(h / 2), ceil(w / 2), 3) of `match_patches`.
    """
    result = np.empty(shape, np.float32)
    for row in (0, 1):
        for column in (0, 1):
            part = result[row::2, column::2]
            d, gx, gy = np.moveaxis(planes[: part.shape[0], : part.shape[1]], 2, 0)
            part[:] = d + (0.5 * column - 0.25) * gx + (0.5 * row - 0.25) * gy
    return result


def _sweep_planes(
    packed: NDArray[np.uint32], matrices: NDArray[np.float64], shape: tuple[int, int], high: float
) -> NDArray[np.float32]:
    """Planes of a sweep: it compares detail alone, since gloss and exposure belong to the photograph."""
    step = label_step(matrices, shape, 0.0, high)
    d = sweep_coarse(packed, matrices, shape, np.arange(len(packed)), 0.0, high, step, base_gain=0.0)
    smooth = cv2.GaussianBlur(cv2.medianBlur(d, 5), (0, 0), 2)
    down, right = np.gradient(smooth)
    return np.stack([d, right, down], axis=-1).astype(np.float32)
