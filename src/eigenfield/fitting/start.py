"""Where a fit begins: the paper's decomposition, of what the mean leaves of each photograph, on the coarse grid."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.files import scratch_array
from eigenfield.fitting.kernels import draw_back
from eigenfield.fitting.model import Block, Finers, Model, Rectangle
from eigenfield.fitting.passes import NONE
from eigenfield.fitting.shots import Shots
from eigenfield.fitting.solve import Scales
from eigenfield.parallel import parallel_map, pieces

FLOOR = 0.2  # of a texel's median part in one picture, below which a camera is taken to see less of it
COLUMNS = 1 << 16  # numbers of a map that are summed at a time


def principal_block(
    shots: Shots,
    model: Model,
    finers: Finers,
    scales: Scales,
    count: int,
    rectangle: Rectangle,
    work: Path | None = None,
) -> Block:
    """`count` eigen textures of a rectangle of the grid, of what the model leaves of the photographs.

    Each camera's residual is put into the texture by the transpose of drawing, divided by what the camera has there
    (not seen: zero, which is the mean, as equation 2 fills it). Needs a scratch file of 4 bytes a camera and number.
    """
    top, bottom, left, right = rectangle
    shape = (model.channels, bottom - top, right - left)
    size = int(np.prod(shape))
    seen = scales.coarse[scales.coarse > 0]
    floor = np.float32(FLOOR * (float(np.median(seen)) if len(seen) else 1.0) / len(shots))
    fine_mean = finers.fine_mean(model.mean)
    fine_mean = finers.fine_mean(model.mean)
    with scratch_array((len(shots), size), np.float32, work) as maps:

        def put(index: int) -> None:
            found = _residual_map(shots, model, finers, fine_mean, index, floor)
            maps[index] = found[:, top:bottom, left:right].reshape(-1)

        parallel_map(put, range(len(shots)))
        share = np.sqrt(scales.coarse[top:bottom, left:right]).reshape(-1)
        weight = np.tile(share, model.channels)
        gram = np.zeros((len(shots), len(shots)))
        for first, last in pieces(size, COLUMNS):
            part = maps[:, first:last] * weight[first:last]
            gram += part.astype(np.float64) @ part.T.astype(np.float64)
        _, vectors = np.linalg.eigh(gram)
        weights = vectors[:, ::-1][:, :count] * np.sqrt(len(shots))
        textures = np.zeros((weights.shape[1], size), np.float32)
        for first, last in pieces(size, COLUMNS):
            textures[:, first:last] = (weights.T / len(shots)).astype(np.float32) @ maps[:, first:last]
    return Block(rectangle, textures.reshape(-1, *shape), weights.astype(np.float32))


def _residual_map(
    shots: Shots, model: Model, finers: Finers, fine_mean: NDArray[np.float32], index: int, floor: np.float32
) -> NDArray[np.float32]:
    """(C, h, w): what is left of a photograph, on the grid."""
    drawn = np.zeros((model.channels, *finers.fine), np.float32)
    if any(block.count for block in model.blocks):
        finers.grid.up(model.sums(slice(index, index + 1))[0], drawn)
    drawn += fine_mean
    back, ones = np.zeros_like(drawn), np.zeros((1, *finers.fine), np.float32)
    matrix = (model.matrix / np.float32(255)).astype(np.float32)
    draw_back(shots.places(index), drawn, shots.photograph(index), matrix, shots.weight(index), 0, 1, back)
    draw_back(shots.places(index), np.ones_like(ones), NONE, matrix[:1], shots.weight(index), 0, 1, ones)
    coarse, part = np.zeros((model.channels, *model.grid), np.float32), np.zeros((1, *model.grid), np.float32)
    finers.grid.down(back, coarse)
    finers.grid.down(ones, part)
    return np.asarray(coarse / np.maximum(part, floor), np.float32)
