"""Refinement of a depth map over all views that see each point."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.refine_kernels import aggregate_rows, label_costs
from eigenfield.stereo.views import Pictures, check_matrices, pack_pictures
from eigenfield.stereo.visibility import VISIBILITY_BIAS_LABELS, flatten_buffers

REFINE_ROWS_PER_TASK = 4
REFINE_TAU_LEVELS = 25.0  # difference at which a view's weight is halved
REFINE_HALF_ENERGY = 6.0  # squared gradient of the mean texture at which confidence falls to a quarter
REFINE_MIN_CONFIDENCE = 20.0  # a point below keeps its depth
REFINE_MIN_VIEWS = 3  # that must see a point
REFINE_WINDOW_RADIUS_PIXELS = 2  # costs are summed over (2 radius + 1)^2 points
REFINE_COLOUR_SCALE_LEVELS = 60.0  # summed over the channels: there the weight of a point of the window falls by e


def refine_depth(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    step: float,
    *,
    buffers: NDArray[np.float32] | None,
    texture: NDArray[np.float32],
    guide: NDArray[np.float32] | None = None,
    bias: float = VISIBILITY_BIAS_LABELS,
    depth_scale: float = 0.12,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """One round of refinement: each point tries five labels over all views that see it.

    Args:
        step: Distance of the five labels.
        texture: (h, w, 3) mean of the same pictures (`mean_texture`).
        guide: (h, w, 3) colours that weigh the aggregation window. Default: the texture.
        depth_scale: Difference of labels at which the weight of a point of the window falls by e.

    Returns:
        (h, w) float32 labels, and (h, w) float32 confidence: about 1 / variance of d (`aggregate_rows`) times
        the energy of the texture; 0 where a point cannot be judged.
    """
    packed = pack_pictures(pictures)
    count, height, width = packed.shape
    checked = check_matrices(matrices, count)
    d = np.ascontiguousarray(d, np.float32)
    texture = np.ascontiguousarray(texture, np.float32)
    steering = texture if guide is None else np.ascontiguousarray(guide, np.float32)
    offsets = (np.arange(-2, 3) * step).astype(np.float32)
    costs, seen = np.empty((*d.shape, len(offsets)), np.float32), np.empty(d.shape, np.float32)
    fixed = (
        packed.reshape(count, -1), flatten_buffers(buffers, count), checked, height, width, d, texture, offsets,
        np.float32(bias), np.float32(REFINE_TAU_LEVELS), np.float32(REFINE_MIN_VIEWS), costs, seen,
    )  # fmt: skip
    parallel_map(lambda rows: label_costs(*rows, *fixed), pieces(d.shape[0], REFINE_ROWS_PER_TASK))
    shift, confidence = np.empty_like(d), np.empty_like(d)
    scales = [np.float32(scale) for scale in (REFINE_COLOUR_SCALE_LEVELS, depth_scale, step)]
    window = (costs, seen, steering, d, REFINE_WINDOW_RADIUS_PIXELS, *scales, shift, confidence)
    parallel_map(lambda rows: aggregate_rows(*rows, *window), pieces(d.shape[0], REFINE_ROWS_PER_TASK))
    confidence *= _texture_energy(texture)
    return d + np.where(confidence > REFINE_MIN_CONFIDENCE, shift, np.float32(0)), confidence


def _texture_energy(texture: NDArray[np.float32]) -> NDArray[np.float32]:
    """A factor of confidence in 0..1, (e / (e + REFINE_HALF_ENERGY))^2, from the squared gradient e of the texture.

    Compression blocks are fixed to each photograph's pixel raster. In flat paint they look like confident depth, but
    the mean over many views does not show them.
    """
    grey = np.ascontiguousarray(texture.mean(axis=-1), np.float32)
    gx, gy = cv2.Sobel(grey, cv2.CV_32F, 1, 0), cv2.Sobel(grey, cv2.CV_32F, 0, 1)
    energy = cv2.GaussianBlur((gx * gx + gy * gy) / 64, (0, 0), 2.0)
    result: NDArray[np.float32] = (energy / (energy + np.float32(REFINE_HALF_ENERGY))) ** 2
    return result
