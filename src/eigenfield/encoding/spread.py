"""From chart texels to a whole picture: unseen texels filled smoothly, gutters dilated."""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from eigenfield.encoding.atlas import Atlas
from eigenfield.imaging.sampling import halve_picture

GUTTER_TEXELS = 4.0  # round each chart that repeat the nearest chart texel: bicubic taps reach 2


@dataclass(frozen=True, eq=False)
class Spreader:
    """Fills an atlas from the texels that are seen. The filling is linear, the same for mean and textures, so
    a sum of filled pictures is the filled sum.

    Attributes:
        atlas: The atlas of n chart texels.
        seen: (n,) bool, chart texels that at least one observation shows.
        known: (H, W) bool, texels with a value of their own.
        gutter: Flat indices of gutter texels.
        nearest: Flat indices of the chart texel that each of these repeats.
    """

    atlas: Atlas
    seen: NDArray[np.bool_]
    known: NDArray[np.bool_]
    gutter: NDArray[np.int64]
    nearest: NDArray[np.int64]

    def __call__(self, values: NDArray[np.float32]) -> NDArray[np.float32]:
        """(n, C) values at the chart texels (those never seen are ignored) to an (H, W, C) picture without holes."""
        picture = self.atlas.image(np.where(self.seen[:, None], values, np.float32(0)))
        filled = push_pull(picture, self.known.astype(np.float32))
        flat = filled.reshape(-1, values.shape[1])
        flat[self.gutter] = flat[self.nearest]
        return filled


def make_spreader(atlas: Atlas, seen: NDArray[np.bool_]) -> Spreader:
    """The spreader of an atlas; seen: (n,) bool, chart texels that at least one observation shows."""
    shape = (atlas.height, atlas.width)
    chart = np.zeros(shape, bool)
    chart.reshape(-1)[atlas.texel] = True
    known = np.zeros(shape, bool)
    known.reshape(-1)[atlas.texel[seen]] = True
    distance, (rows, columns) = ndimage.distance_transform_edt(~chart, return_indices=True)
    gutter = np.flatnonzero((distance > 0) & (distance <= GUTTER_TEXELS))
    nearest = (rows.astype(np.int64) * atlas.width + columns).reshape(-1)[gutter]
    return Spreader(atlas, seen, known, gutter, nearest)


def push_pull(picture: NDArray[np.float32], weight: NDArray[np.float32]) -> NDArray[np.float32]:
    """Fill the texels of weight 0 from those of weight 1, smoothly (Gortler et al., "The Lumigraph", 1996).

    Pull: halve until one texel is left, averaging what is known. Push: on the way back, unknown texels take the
    bilinear enlargement of the coarser level.

    Args:
        picture: (H, W, C), times the weight.
        weight: (H, W), 0 to 1; what has less than 1 takes the rest from around.
    """
    height, width = picture.shape[:2]
    if min(height, width) == 1 or (weight >= 1).all():
        average = picture.sum(axis=(0, 1)) / max(float(weight.sum()), 1e-12)
        shown = picture / np.maximum(weight, 1e-12)[..., None]
        return np.where(weight[..., None] > 0, shown, average).astype(np.float32)
    even = np.pad(picture, ((0, height % 2), (0, width % 2), (0, 0)))
    even_weight = np.pad(weight, ((0, height % 2), (0, width % 2)))
    half_weight = halve_picture(even_weight[..., None])[..., 0]
    half = halve_picture(even)
    scale = np.minimum(half_weight * 4, 1.0) / np.maximum(half_weight, 1e-12)  # confidence grows as levels fill
    coarse = push_pull((half * scale[..., None]).astype(np.float32), (half_weight * scale).astype(np.float32))
    large = cv2.resize(coarse, (even.shape[1], even.shape[0]), interpolation=cv2.INTER_LINEAR)
    large = large.reshape(*even.shape)[:height, :width]
    w = weight[..., None]
    return np.asarray(picture + (1 - w) * large, np.float32)
