"""Consistency between depth maps: how many other maps confirm each point."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.consistency_kernels import count_consistent_rows
from eigenfield.stereo.reference_view import ReferenceView

CONSISTENCY_ROWS_PER_TASK = 16
CONSISTENCY_TOLERANCE_LABELS = 0.5  # half a pixel in the neighbouring view


def count_consistent_views(
    depths: Sequence[NDArray[np.float32]],
    references: Sequence[ReferenceView],
    tolerance: float = CONSISTENCY_TOLERANCE_LABELS,
    valid: Sequence[NDArray[np.bool_]] | None = None,
    neighbours: Sequence[Sequence[int]] | None = None,
) -> list[NDArray[np.int32]]:
    """How many of the other depth maps agree with each point of each map.

    Args:
        depths: The label map of each reference view, (h, w) float32. Maps may differ in size.
        references: The reference view of each map.
        tolerance: Largest difference of agreeing labels, in labels of the map that is judged.
        valid: (h, w) masks of the points that may confirm others. Default: all finite points.
        neighbours: For each map, the indices of the maps it is compared with. Default: all others.

    Returns:
        For each map, (h, w) int32: the number of maps that agree.
    """
    counts = []
    for index, (d, reference) in enumerate(zip(depths, references, strict=True)):
        others = neighbours[index] if neighbours is not None else [k for k in range(len(depths)) if k != index]
        count = np.zeros(d.shape, np.int32)
        labels = np.ascontiguousarray(d, np.float32)
        for other in others:
            mask = np.isfinite(depths[other]) if valid is None else valid[other] & np.isfinite(depths[other])
            fixed = (
                labels, transfer_matrix(reference, references[other])[None],
                np.ascontiguousarray(depths[other], np.float32)[None], np.ascontiguousarray(mask)[None],
                float(tolerance), count,
            )  # fmt: skip
            parallel_map(partial(_count_rows, fixed), pieces(d.shape[0], CONSISTENCY_ROWS_PER_TASK))
        counts.append(count)
    return counts


def _count_rows(fixed: tuple[Any, ...], rows: tuple[int, int]) -> None:
    count_consistent_rows(*rows, *fixed)


def transfer_matrix(source: ReferenceView, target: ReferenceView) -> NDArray[np.float64]:
    """The matrix from (x, y, d, 1) of one reference view to homogeneous (x, y, d, 1) of another.

    With w = offset + scale d, a world point times w is affine in (x, y, d). So is its image in the other camera, times
    w.

    Args:
        source: The view whose points are transferred.
        target: The view they are transferred to.

    Returns:
        (4, 4) matrix.
    """
    return np.linalg.inv(_to_world(target)) @ _to_world(source)


def _to_world(reference: ReferenceView) -> NDArray[np.float64]:
    """(4, 4) from (x, y, d, 1) to (w X, w), with X the world point and w = offset + scale d."""
    camera = reference.camera
    unproject = np.linalg.inv(camera.K) @ np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1.0]])
    result = np.zeros((4, 4))
    result[:3, :2] = camera.R.T @ unproject[:, :2]
    result[:3, 2] = reference.scale * camera.centre
    result[:3, 3] = camera.R.T @ unproject[:, 2] + reference.offset * camera.centre
    result[3] = [0, 0, reference.scale, reference.offset]
    return result
