"""Texels that few observations show are coded coarsely, and those that none shows are filled smoothly."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.encoding.fitted.model import Block, PlaneModel
from eigenfield.encoding.fitted.solve import Scales
from eigenfield.encoding.spread import push_pull
from eigenfield.imaging.raster import rasterise
from eigenfield.rendering.software.drawing import Surface
from eigenfield.runtime.parallel import parallel_map

PRECISION_CELL_TEXELS = 64  # side of a cell of the mean that has one precision
PRECISION_MIN_FACTOR = 2**-1.5  # lower ones gain nothing (Tarot, Shop), and show where few cameras look
SHEET_CELL_TEXELS, SHEET_MIN_FACTOR = 32, 2**-5  # of sheets, which may show next to nothing; chosen on Fern
PRECISION_LEVELS_PER_OCTAVE = 4  # fewer numbers, fewer bytes
PRECISION_MAX_MEAN_FACTOR = 0.97  # mean precision, above which the map saves fewer bytes than it takes
OBSERVED_MIN_SHARE_RATIO = 0.3  # of the median share: less beside a chart counts as unseen


def fill_unseen(model: PlaneModel, scales: Scales, surface: Surface) -> None:
    """Continue mean and textures smoothly where no photograph sees them, or next to none beside a chart.

    A step there would cost bytes, and ring into the chart.

    Args:
        model: Is changed in place.
        scales: Of the data that it was fitted to.
    """
    model.mean = _fill_smoothly(model.mean, _observed_mask(scales.mean, surface))
    coarse = _observed_mask(scales.coarse, surface)
    for block in model.blocks:
        observed = np.ascontiguousarray(coarse[block.window])

        def fill(index: int, block: Block = block, observed: NDArray[np.float32] = observed) -> None:
            block.textures[index] = _fill_smoothly(block.textures[index], observed)

        parallel_map(fill, range(block.count))


def mean_precision(scales: Scales) -> NDArray[np.float32] | None:
    """(h, w) up to 1: how finely each place of a mean is to be coded, None where all of it alike.

    Least squared error over all pictures for a number of bits has steps in inverse proportion to the root of the
    pixels that a texel answers for (reverse water-filling); what is seen as often as most is the measure.
    """
    known = (scales.mean > 0).astype(np.float32)
    if not known.any():
        return None
    share = np.minimum(scales.mean_noise / scales.usual, 1).astype(np.float32)
    cell, least = PRECISION_CELL_TEXELS, PRECISION_MIN_FACTOR
    if scales.soft:
        cell, least = SHEET_CELL_TEXELS, SHEET_MIN_FACTOR
    rows, columns = (max(1, round(side / cell)) for side in share.shape)
    covered = cv2.resize(known, (columns, rows), interpolation=cv2.INTER_AREA)
    cells = cv2.resize(share * known, (columns, rows), interpolation=cv2.INTER_AREA) / np.maximum(covered, 1e-6)
    level = np.rint(-PRECISION_LEVELS_PER_OCTAVE / 2 * np.log2(np.maximum(cells, least**2)))
    precision = np.exp2(-level / PRECISION_LEVELS_PER_OCTAVE)
    if np.average(precision, weights=covered) > PRECISION_MAX_MEAN_FACTOR:
        return None
    return np.asarray(precision, np.float32)


def _observed_mask(share: NDArray[np.float32], surface: Surface) -> NDArray[np.float32]:
    """(h, w) 1 where the photographs determine a texel: it is seen, and its middle is in a chart or its share is
    OBSERVED_MIN_SHARE_RATIO of the median."""
    (height, width), (rows, columns) = surface.size, share.shape
    corners = np.ones((len(surface.texels), 3))
    corners[:, :2] = (surface.texels + 0.5) * (columns / width, rows / height)
    inside = rasterise(corners, surface.faces, columns, rows).face >= 0
    usual = float(np.median(share[share > 0])) if (share > 0).any() else 0.0
    return ((share > 0) & (inside | (share > OBSERVED_MIN_SHARE_RATIO * usual))).astype(np.float32)


def _fill_smoothly(picture: NDArray[np.float32], observed: NDArray[np.float32]) -> NDArray[np.float32]:
    """(C, rows, columns) as it is where `observed` is 1, filled where it is 0."""
    known = np.ascontiguousarray((picture * observed).transpose(1, 2, 0))
    return np.ascontiguousarray(push_pull(known, observed).transpose(2, 0, 1))
