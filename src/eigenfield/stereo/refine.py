"""Refinement of a depth map over all views that see each point."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.refine_kernels import label_costs, settle
from eigenfield.stereo.views import Pictures, check_matrices, pack
from eigenfield.stereo.visibility import BIAS, flat

BAND = 4
TAU = 25.0  # grey levels at which a view's say is halved
ENERGY = 6.0  # squared gradient of the mean texture at which confidence is halved, and again
TEXTURED = 20.0  # confidence below which a point keeps its depth


def refine_depth(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    step: float,
    *,
    buffers: NDArray[np.float32] | None,
    texture: NDArray[np.float32],
    guide: NDArray[np.float32] | None = None,
    bias: float = BIAS,
    tau: float = TAU,
    fewest: int = 3,
    radius: int = 2,
    colour: float = 60.0,
    depth: float = 0.12,
    todo: NDArray[np.bool_] | None = None,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """One round: each point tries five labels `step` apart over all views that see it. (d, confidence), (h, w) float32.

    buffers: of `depth_buffers` for the present d. texture: (h, w, 3) mean of the same pictures (`mean_texture`).
    guide: (h, w, 3) colours that steer the aggregation over (2 radius + 1)^2 points, default the texture;
    colour, depth: its scales in grey levels (sum of three channels) and label units. fewest: views that must see a
    point. todo: points that may move. confidence: about 1 / variance of d (`refine_kernels.settle`), times what
    `texture_energy` says of the mean texture; 0 where a point cannot be judged.
    """
    packed = pack(pictures)
    count, height, width = packed.shape
    checked = check_matrices(matrices, count)
    d = np.ascontiguousarray(d, np.float32)
    texture = np.ascontiguousarray(texture, np.float32)
    steering = texture if guide is None else np.ascontiguousarray(guide, np.float32)
    offsets = (np.arange(-2, 3) * step).astype(np.float32)
    costs, seen = np.empty((*d.shape, len(offsets)), np.float32), np.empty(d.shape, np.float32)
    fixed = (
        packed.reshape(count, -1), flat(buffers, count), checked, height, width, d, texture, offsets, np.float32(bias),
        np.float32(tau), np.float32(fewest), costs, seen,
    )  # fmt: skip
    parallel_map(lambda rows: label_costs(rows[0], rows[1], *fixed), pieces(d.shape[0], BAND))
    shift, confidence = np.empty_like(d), np.empty_like(d)
    scales = [np.float32(scale) for scale in (colour, depth, step)]
    window = (costs, seen, steering, d, radius, *scales, shift, confidence)
    parallel_map(lambda rows: settle(rows[0], rows[1], *window), pieces(d.shape[0], BAND))
    confidence *= texture_energy(texture)
    moves = confidence > TEXTURED
    if todo is not None:
        moves &= todo
    return d + np.where(moves, shift, np.float32(0)), confidence


def texture_energy(texture: NDArray[np.float32], half: float = ENERGY) -> NDArray[np.float32]:
    """(h, w) in 0..1: (e / (e + half))^2, e the squared gradient of the mean texture, smoothed over 2 pixels.

    Compression blocks are fixed to each photograph's raster: they look like confident depth in flat paint, but not in
    the mean over many views.
    """
    grey = np.ascontiguousarray(texture.mean(axis=-1), np.float32)
    gx, gy = cv2.Sobel(grey, cv2.CV_32F, 1, 0), cv2.Sobel(grey, cv2.CV_32F, 0, 1)
    energy = cv2.GaussianBlur((gx * gx + gy * gy) / 64, (0, 0), 2.0)
    result: NDArray[np.float32] = (energy / (energy + np.float32(half))) ** 2
    return result
