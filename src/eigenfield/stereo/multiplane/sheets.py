"""Soft sheets: a few height fields with colour and opacity, in place of a multiplane image's many planes."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.stereo.multiplane.drawing import draw_picture
from eigenfield.stereo.multiplane.image import MultiplaneImage

UNSEEN_WEIGHT = 0.1  # of an opaque texel that others hide from the reference view, when planes are shared out
MIN_OPACITY = 0.02  # a texel with less has no colour or label of its own
SMOOTHING_TEXELS = 3.0  # standard deviation of the window in which labels are first averaged
SMOOTHING_MIN_WEIGHT = 0.02  # of a window, with less of which a wider one decides
COLOUR_FILL_TEXELS = 8.0  # standard deviation of the window that gives empty texels a colour


@dataclass(frozen=True, eq=False)
class SoftSheets:
    """Height fields over a `ReferenceView`, each composited over those before it.

    Attributes:
        labels: (K, h, w) float32 of each texel; a label is affine in inverse depth.
        layers: (K, h, w, 4) float32 R, G, B in the photographs' own values and opacity, 0..1.
    """

    labels: NDArray[np.float32]
    layers: NDArray[np.float32]

    def draw(self, matrix: NDArray[np.float64], shape: tuple[int, int]) -> NDArray[np.float32]:
        """As `draw_picture`."""
        return draw_picture(self.labels, self.layers, matrix, shape)


def sheets_of(image: MultiplaneImage, count: int) -> SoftSheets:
    """Sheets that stand for the planes of a multiplane image, each for some in a row.

    Planes are shared out so that their texels lie as near as possible to the sheets: least squares of labels, weighted
    by opacity, by dynamic programming. Within a sheet the label of a texel is the mean of its planes, smoothed.

    Args:
        count: K, at most the number of planes.
    """
    labels, layers = image.labels, image.layers
    opacity = layers[..., 3]
    weight = opacity * (_transmittance(opacity) + UNSEEN_WEIGHT)
    cuts = _share_out(labels, weight, count)
    made = [_sheet(labels[a:b], layers[a:b], weight[a:b]) for a, b in pairwise(cuts)]
    return SoftSheets(np.stack([one for one, _ in made]), np.stack([one for _, one in made]))


def _transmittance(opacity: NDArray[np.float32]) -> NDArray[np.float32]:
    """(D, h, w): the part of the light from each plane that those in front let through to the reference view."""
    through = np.ones_like(opacity)
    for d in range(len(opacity) - 2, -1, -1):
        through[d] = through[d + 1] * (1 - opacity[d + 1])
    return through


def _share_out(labels: NDArray[np.float64], weight: NDArray[np.float32], count: int) -> list[int]:
    """(K + 1,) the first plane of each sheet, and the number of planes."""
    planes = len(labels)
    place = (labels - labels.mean())[:, None, None]
    start = np.zeros((1, *weight.shape[1:]))
    sums = [np.concatenate([start, np.cumsum(weight * place**power, axis=0)]) for power in range(3)]
    cost = np.full((planes + 1, planes + 1), np.inf)
    for a in range(planes):
        for b in range(a + 1, planes + 1):
            zero, one, two = (total[b] - total[a] for total in sums)
            cost[a, b] = np.maximum(two - one * one / np.maximum(zero, 1e-9), 0).sum()
    best, first = cost[0], np.zeros((count + 1, planes + 1), np.int64)
    for k in range(2, count + 1):
        each = best[:, None] + cost
        first[k], best = each.argmin(axis=0), each.min(axis=0)
    cuts = [planes]
    for k in range(count, 0, -1):
        cuts.append(int(first[k, cuts[-1]]))
    return cuts[::-1]


def _sheet(
    labels: NDArray[np.float64], layers: NDArray[np.float32], weight: NDArray[np.float32]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """(h, w) labels and the (h, w, 4) layer of one sheet."""
    total = weight.sum(axis=0)
    mean = np.einsum("d,dhw->hw", labels, weight) / np.maximum(total, 1e-9)
    height = _smoothed(mean.astype(np.float32), total.astype(np.float32))
    colour, through = np.zeros((*layers.shape[1:3], 3), np.float32), np.ones(layers.shape[1:3], np.float32)
    for layer in layers:
        part = layer[..., 3:]
        colour += part * (layer[..., :3] - colour)
        through *= 1 - layer[..., 3]
    opacity = 1 - through
    wide = (0, 0), COLOUR_FILL_TEXELS
    around = cv2.GaussianBlur(colour, *wide) / np.maximum(cv2.GaussianBlur(opacity, *wide), 1e-4)[..., None]
    share = np.minimum(opacity / MIN_OPACITY, 1)[..., None]
    own_colour = colour / np.maximum(opacity, MIN_OPACITY)[..., None]
    return height, np.concatenate([share * own_colour + (1 - share) * around, opacity[..., None]], axis=2)


def _smoothed(values: NDArray[np.float32], weight: NDArray[np.float32]) -> NDArray[np.float32]:
    """The weighted mean around each texel, in a window that is as wide as it must be to weigh enough."""
    result, missing = np.zeros_like(values), np.ones_like(values)
    sigma = SMOOTHING_TEXELS
    while sigma < max(values.shape) and missing.any():
        within = cv2.GaussianBlur(weight, (0, 0), sigma)
        mean = cv2.GaussianBlur(values * weight, (0, 0), sigma) / np.maximum(within, 1e-9)
        part = np.minimum(within / SMOOTHING_MIN_WEIGHT, 1) * missing
        result += part * mean
        missing -= part
        sigma *= 2
    overall = float((values * weight).sum() / max(float(weight.sum()), 1e-9))
    return np.asarray(result + missing * overall, np.float32)
