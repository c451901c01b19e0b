"""Which views see a point, by splatted depth buffers, and the mean colour of these views."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.views import Pictures, check_matrices, pack_pictures
from eigenfield.stereo.visibility_kernels import mean_rows, splat_labels

VISIBILITY_ROWS_PER_TASK = 8
VISIBILITY_BIAS_LABELS = 0.12  # a point this far behind the depth buffer still counts as on the surface


def depth_buffers(
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    shape: tuple[int, int],
    valid: NDArray[np.bool_] | None = None,
    out: NDArray[np.float32] | None = None,
) -> NDArray[np.float32]:
    """The largest label of the reference view's points on each pixel of each view.

    Args:
        shape: (H, W) of the views.
        valid: (h, w) points that count. Default: all finite ones.
        out: Where the result is written. Default: a new array.

    Returns:
        (V, H, W) float32; -1e9 where no point falls.
    """
    checked = check_matrices(matrices, len(matrices))
    labels = np.ascontiguousarray(d, np.float32)
    counts = np.isfinite(labels) if valid is None else np.isfinite(labels) & valid
    buffers = np.empty((len(checked), *shape), np.float32) if out is None else out
    if buffers.shape != (len(checked), *shape):
        raise ValueError(f"the buffers have the shape {buffers.shape}, not {(len(checked), *shape)}")
    parallel_map(lambda v: splat_labels(checked[v], labels, counts, buffers[v]), range(len(checked)))
    return buffers


def mean_texture(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    buffers: NDArray[np.float32] | None = None,
    bias: float = VISIBILITY_BIAS_LABELS,
) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """The mean colour over the views that see each point (x, y, d).

    Returns:
        (h, w, 3) float32 texture in grey levels, 0 where no view looks, and (h, w) int32 number of views.
    """
    packed = pack_pictures(pictures)
    count, height, width = packed.shape
    checked = check_matrices(matrices, count)
    labels = np.ascontiguousarray(d, np.float32)
    texture, seen = np.zeros((*labels.shape, 3), np.float32), np.zeros(labels.shape, np.int32)
    views = packed.reshape(count, -1), flatten_buffers(buffers, count), checked, height, width
    fixed = (*views, labels, np.float32(bias), texture, seen)
    parallel_map(lambda rows: mean_rows(*rows, *fixed), pieces(labels.shape[0], VISIBILITY_ROWS_PER_TASK))
    return texture, seen


def flatten_buffers(buffers: NDArray[np.float32] | None, count: int) -> NDArray[np.float32]:
    """Depth buffers as kernels read them.

    Returns:
        (V, H W) float32, or (V, 0) for none.
    """
    if buffers is None:
        return np.zeros((count, 0), np.float32)
    return np.ascontiguousarray(buffers, np.float32).reshape(count, -1)
