"""Texels that few observations show, and those that none shows: they are to cost as few bytes as they matter."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.solve import Scales
from eigenfield.encoding.projected import push_pull
from eigenfield.imaging.raster import rasterise
from eigenfield.rendering.software.drawing import Surface
from eigenfield.runtime.parallel import parallel_map

CELL = 64  # texels of the mean for one number of its precision
COARSEST = 2**-1.5  # precision; lower ones gain nothing (Tarot, Shop), and show where few cameras look
PRECISIONS = 4  # to a factor of two: fewer numbers, fewer bytes
GUTTER = 0.3  # of what a texel usually counts for: less beside a chart is as good as unseen
WORTHWHILE = 0.97  # mean precision, above which the map is not worth its own bytes


def fill_unseen(model: PlaneModel, scales: Scales, surface: Surface) -> None:
    """Mean and textures go on smoothly where no photograph sees them, or beside a chart next to none: a step there
    would be coded as one, and ring into the chart."""
    model.mean = _extended(model.mean, _observed(scales.mean, surface))
    coarse = _observed(scales.coarse, surface)
    for block in model.blocks:
        observed = np.ascontiguousarray(coarse[block.window])

        def fill(index: int, block: Block = block, observed: NDArray[np.float32] = observed) -> None:
            block.textures[index] = _extended(block.textures[index], observed)

        parallel_map(fill, range(block.count))


def mean_precision(scales: Scales) -> NDArray[np.float32] | None:
    """(h, w) in COARSEST to 1: how finely each place of a mean is to be coded, None where all of it alike.

    Least squared error over all pictures for a number of bits has steps in inverse proportion to the root of the
    pixels that a texel answers for (reverse water-filling); what is seen as often as most is the measure.
    """
    known = _known(scales.mean)
    if not known.any():
        return None
    share = np.minimum(scales.mean / np.median(scales.mean[known > 0]), 1).astype(np.float32)
    rows, columns = (max(1, round(side / CELL)) for side in share.shape)
    covered = cv2.resize(known, (columns, rows), interpolation=cv2.INTER_AREA)
    cells = cv2.resize(share * known, (columns, rows), interpolation=cv2.INTER_AREA) / np.maximum(covered, 1e-6)
    level = np.rint(-PRECISIONS / 2 * np.log2(np.maximum(cells, COARSEST**2)))
    precision = np.exp2(-level / PRECISIONS)
    if np.average(precision, weights=covered) > WORTHWHILE:
        return None
    return np.asarray(precision, np.float32)


def _observed(share: NDArray[np.float32], surface: Surface) -> NDArray[np.float32]:
    """(h, w) 1 where the photographs determine a texel: it is seen, and its middle is in a chart or it counts for
    GUTTER of what most do."""
    (height, width), (rows, columns) = surface.size, share.shape
    corners = np.ones((len(surface.texels), 3))
    corners[:, :2] = (surface.texels + 0.5) * (columns / width, rows / height)
    inside = rasterise(corners, surface.faces, columns, rows).face >= 0
    usual = float(np.median(share[share > 0])) if (share > 0).any() else 0.0
    return ((share > 0) & (inside | (share > GUTTER * usual))).astype(np.float32)


def _known(share: NDArray[np.float32]) -> NDArray[np.float32]:
    return (share > 0).astype(np.float32)


def _extended(picture: NDArray[np.float32], observed: NDArray[np.float32]) -> NDArray[np.float32]:
    """(C, rows, columns) as it is where `observed` is 1, filled where it is 0."""
    known = np.ascontiguousarray((picture * observed).transpose(1, 2, 0))
    return np.ascontiguousarray(push_pull(known, observed).transpose(2, 0, 1))
