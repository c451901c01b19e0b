"""Cross-view consistency: a point of one depth map counts for as much as the other maps confirm."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.canvas import Canvas
from eigenfield.stereo.consistency_kernels import count_agreeing

BAND = 16
TOLERANCE = 0.5  # labels: half a pixel in the neighbouring view


def consistent(
    depths: Sequence[NDArray[np.float32]],
    canvases: Sequence[Canvas],
    tolerance: float = TOLERANCE,
    valid: Sequence[NDArray[np.bool_]] | None = None,
    neighbours: Sequence[Sequence[int]] | None = None,
) -> list[NDArray[np.int32]]:
    """For each view's depth map, (h, w) int32: how many of the other maps agree with each of its points.

    depths: labels of each canvas; maps may differ in size. tolerance: in labels of the map that is judged. valid:
    points that may confirm others. neighbours: which maps are asked for each; default all others.
    """
    counts = []
    for index, (d, canvas) in enumerate(zip(depths, canvases, strict=True)):
        asked = neighbours[index] if neighbours is not None else [k for k in range(len(depths)) if k != index]
        count = np.zeros(d.shape, np.int32)
        labels = np.ascontiguousarray(d, np.float32)
        for other in asked:
            mask = np.isfinite(depths[other]) if valid is None else valid[other] & np.isfinite(depths[other])
            fixed = (
                labels, between(canvas, canvases[other])[None], np.ascontiguousarray(depths[other], np.float32)[None],
                np.ascontiguousarray(mask)[None], float(tolerance), count,
            )  # fmt: skip
            parallel_map(partial(_count_rows, fixed), pieces(d.shape[0], BAND))
        counts.append(count)
    return counts


def _count_rows(fixed: tuple[Any, ...], rows: tuple[int, int]) -> None:
    count_agreeing(*rows, *fixed)


def between(canvas: Canvas, other: Canvas) -> NDArray[np.float64]:
    """(4, 4) from (x, y, d, 1) of one canvas to homogeneous (x, y, d, 1) of another.

    With w = offset + scale d, a world point times w is affine in (x, y, d): so is its image in the other camera, times
    w.
    """
    return np.linalg.inv(_to_world(other)) @ _to_world(canvas)


def _to_world(canvas: Canvas) -> NDArray[np.float64]:
    """(4, 4) from (x, y, d, 1) to (w X, w), X in the world and w = offset + scale d."""
    camera = canvas.camera
    lift = np.linalg.inv(camera.K) @ np.array([[1, 0, 0.5], [0, 1, 0.5], [0, 0, 1.0]])
    result = np.zeros((4, 4))
    result[:3, :2] = camera.R.T @ lift[:, :2]
    result[:3, 2] = canvas.scale * camera.centre
    result[:3, 3] = camera.R.T @ lift[:, 2] + canvas.offset * camera.centre
    result[3] = [0, 0, canvas.scale, canvas.offset]
    return result
