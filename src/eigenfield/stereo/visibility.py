"""Which views see a point: splatted depth buffers; and the mean of what they see."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.views import Pictures, check_matrices, pack
from eigenfield.stereo.visibility_kernels import cubic_mean_rows, mean_rows, splat

BAND = 8
BIAS = 0.12  # label units: a point this far behind the depth buffer still counts as on the surface


def depth_buffers(
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    shape: tuple[int, int],
    valid: NDArray[np.bool_] | None = None,
    out: NDArray[np.float32] | None = None,
) -> NDArray[np.float32]:
    """(V, H, W) float32: the largest d of the canvas's points on each pixel of each view; -1e9 where none falls.

    d: (h, w) the canvas's labels, `valid` (h, w) those that count. shape: (H, W) of the views. out: to be written into.
    """
    checked = check_matrices(matrices, len(matrices))
    labels = np.ascontiguousarray(d, np.float32)
    counts = np.isfinite(labels) if valid is None else np.isfinite(labels) & valid
    buffers = np.empty((len(checked), *shape), np.float32) if out is None else out
    if buffers.shape != (len(checked), *shape):
        raise ValueError(f"the buffers have the shape {buffers.shape}, not {(len(checked), *shape)}")
    parallel_map(lambda v: splat(checked[v], labels, counts, buffers[v]), range(len(checked)))
    return buffers


def mean_texture(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    buffers: NDArray[np.float32] | None = None,
    bias: float = BIAS,
    *,
    cubic: bool = False,
) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    """The mean over the views that see each point (x, y, d): (texture (h, w, 3) float32 in grey levels, count (h, w)).

    buffers: of `depth_buffers`; None: nothing hides anything. cubic: Catmull-Rom instead of bilinear interpolation.
    Where nobody looks the texture is 0.
    """
    packed = pack(pictures)
    count, height, width = packed.shape
    checked = check_matrices(matrices, count)
    labels = np.ascontiguousarray(d, np.float32)
    texture, seen = np.zeros((*labels.shape, 3), np.float32), np.zeros(labels.shape, np.int32)
    fixed = (packed.reshape(count, -1), flat(buffers, count), checked, height, width, labels, np.float32(bias))
    work = cubic_mean_rows if cubic else mean_rows
    parallel_map(lambda rows: work(rows[0], rows[1], *fixed, texture, seen), pieces(labels.shape[0], BAND))
    return texture, seen


def flat(buffers: NDArray[np.float32] | None, count: int) -> NDArray[np.float32]:
    """Depth buffers as kernels read them: (V, H W), or (V, 0) for none."""
    if buffers is None:
        return np.zeros((count, 0), np.float32)
    return np.ascontiguousarray(buffers, np.float32).reshape(count, -1)
