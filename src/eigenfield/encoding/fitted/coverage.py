"""Texels that few observations show are coded coarsely, and those that none shows are filled smoothly."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.solve import Scales
from eigenfield.encoding.spread import push_pull
from eigenfield.imaging.raster import rasterise
from eigenfield.proxy.topology import face_components
from eigenfield.rendering.software.drawing import Surface
from eigenfield.runtime.parallel import even_pieces, parallel_map

PRECISION_CELL_TEXELS = 64  # side of a cell of the mean that has one precision
PRECISION_MIN_FACTOR = 2**-1.5  # lower ones gain nothing (Tarot, Shop), and show where few cameras look
SHEET_CELL_TEXELS, SHEET_MIN_FACTOR = 32, 2**-5  # of sheets, which may show next to nothing; chosen on Fern
PRECISION_LEVELS_PER_OCTAVE = 4  # fewer numbers, fewer bytes
PRECISION_MAX_MEAN_FACTOR = 0.97  # mean precision, above which the map saves fewer bytes than it takes
OBSERVED_MIN_SHARE_RATIO = 0.3  # of the median share: less beside a chart counts as unseen
# Beside what no photograph sees: the nearer a texel is, the less is filled from it, for it holds colours of what hides
# the rest. Chosen on Temple
OUTLINE_TEXELS = 16.0
FILL_TASKS = 4  # into which a block's textures are divided: there may be hundreds of charts, each with work of its own


@dataclass(frozen=True, eq=False)
class _Filling:
    """Which texels of a picture are filled, and from which others.

    Attributes:
        observed: (h, w) 1 where the photographs determine a texel; 0 where it is filled.
        charts: Of each chart that is seen in part: its window, and there (h', w') which of its texels are filled, and
            (h', w') from which others, by weights up to 1.
    """

    observed: NDArray[np.float32]
    charts: tuple[tuple[tuple[slice, ...], NDArray[np.bool_], NDArray[np.float32]], ...]

    def fill(self, picture: NDArray[np.float32]) -> NDArray[np.float32]:
        """(C, h, w) with what is not observed filled: a chart from itself, all else from around it."""
        result, known = picture.copy(), self.observed.copy()
        for window, unseen, source in self.charts:
            part = (slice(None), *window)
            result[part][:, unseen] = _continue(picture[part], source)[:, unseen]
            known[window][unseen] = 1
        return np.where(known > 0, result, _continue(result, known))


def fill_unseen(model: PlaneModel, scales: Scales, surface: Surface, outline: float = OUTLINE_TEXELS) -> None:
    """Continue mean and textures smoothly where no photograph sees them, or next to none beside a chart.

    A step there would cost bytes, and ring into the chart. Views between the cameras see a part of what no photograph
    sees, such as a background behind the scene: it continues its own chart, not what lies beside it in the atlas.

    Args:
        model: Is changed in place.
        scales: Of the data that it was fitted to.
        outline: Texels beside what is not seen, from which the less is filled the nearer they are.
    """
    whole = slice(None), slice(None)
    model.mean = _filling(scales.mean, surface, whole, outline).fill(model.mean)
    for block in model.blocks:
        filling = _filling(scales.coarse, surface, block.window, outline)
        pictures = block.textures.reshape(-1, *block.textures.shape[2:])

        def fill(part: tuple[int, int], pictures: NDArray[np.float32] = pictures, filling: _Filling = filling) -> None:
            pictures[slice(*part)] = filling.fill(pictures[slice(*part)])

        parallel_map(fill, even_pieces(len(pictures), FILL_TASKS))


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


def _filling(share: NDArray[np.float32], surface: Surface, window: tuple[slice, slice], outline: float) -> _Filling:
    """What of a window of a picture is filled.

    A texel is observed if it is seen, and its middle is in a chart or its share is OBSERVED_MIN_SHARE_RATIO of the
    median.

    Args:
        share: (h, w) of the whole picture, what each texel answers for.
        outline: As of `fill_unseen`.
    """
    (height, width), (rows, columns) = surface.size, share.shape
    corners = np.ones((len(surface.texels), 3))
    corners[:, :2] = (surface.texels + 0.5) * (columns / width, rows / height)
    face = rasterise(corners, surface.faces, columns, rows).face[window]
    chart = np.where(face >= 0, face_components(surface.faces, len(surface.texels))[face], -1)
    usual = float(np.median(share[share > 0])) if (share > 0).any() else 0.0
    share = share[window]
    seen, inside = share > 0, chart >= 0
    observed = seen & (inside | (share > OBSERVED_MIN_SHARE_RATIO * usual))
    charts = []
    for number, place in enumerate(ndimage.find_objects(chart + 1)):
        if place is None:
            continue
        own = chart[place] == number
        unseen, known = own & ~seen[place], own & seen[place]
        if unseen.any() and known.any():
            near = np.minimum(ndimage.distance_transform_edt(~unseen) / outline, 1)
            source = np.where(known, np.square(near), 0).astype(np.float32)
            charts.append((place, unseen, source))
    return _Filling(observed.astype(np.float32), tuple(charts))


def _continue(picture: NDArray[np.float32], known: NDArray[np.float32]) -> NDArray[np.float32]:
    """(C, h, w) as it is where `known` is 1, smoothly continued where it is less."""
    shown = np.ascontiguousarray((picture * known).transpose(1, 2, 0))
    return np.ascontiguousarray(push_pull(shown, known).transpose(2, 0, 1))
