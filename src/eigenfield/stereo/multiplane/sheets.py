"""Soft sheets: a few height fields with colour and opacity, in place of a multiplane image's many planes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.multiplane.image import BAND_ROWS, MultiplaneImage, composite_error
from eigenfield.stereo.multiplane.kernels import add_sheet_gradient, composite, draw_sheet, sheet_places

PLACE_ITERATIONS = 6
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
        """(H, W, 3) what a view sees; black where no sheet is.

        Args:
            matrix: (3, 4) of the view, see `view_matrices`.
            shape: (H, W) of its picture.
        """
        places = np.empty((len(self.labels), *shape, 2), np.float32)
        drawn = np.empty((len(self.labels), *shape, 4), np.float32)
        draw_sheets(self.labels, self.layers, matrix, places, drawn)
        picture = np.empty((*shape, 3), np.float32)
        parallel_map(lambda band: composite(drawn, *band, picture), pieces(shape[0], BAND_ROWS))
        return picture


def label_parallax_maps(matrix: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """`base` (3, 3) and `slope` (2, 3) of the kernels, for a view.

    The plane of label d maps the reference view to a photograph by H + d m e3', with m a column of the view's matrix.
    Its inverse, by Sherman and Morrison, is H^-1 + d (c_3 I - c e3') H^-1 but for a scale, with c = H^-1 m.

    Args:
        matrix: (3, 4) of the view, see `view_matrices`.
    """
    base = np.asarray(np.linalg.inv(matrix[:, [0, 1, 3]]), np.float64)
    centre = base @ matrix[:, 2]
    turn = centre[2] * np.eye(3) - np.outer(centre, [0, 0, 1])
    return base, np.ascontiguousarray((turn @ base)[:2])


def draw_sheets(
    labels: NDArray[np.float32],
    layers: NDArray[np.float32],
    matrix: NDArray[np.float64],
    places: NDArray[np.float32],
    drawn: NDArray[np.float32],
) -> None:
    """drawn (K, H, W, 4) = each sheet as a view sees it, and places (K, H, W, 2) where it reads them."""
    base, slope = label_parallax_maps(matrix)

    def one(k: int) -> None:
        sheet_places(labels[k], base, slope, np.float32(np.median(labels[k])), PLACE_ITERATIONS, places[k])
        draw_sheet(layers[k], places[k], drawn[k])

    parallel_map(one, range(len(labels)))


def backpropagate_sheets(
    codes: NDArray[np.uint8],
    layers: NDArray[np.float32],
    matrix: NDArray[np.float64],
    places: NDArray[np.float32],
    drawn: NDArray[np.float32],
    layer_gradients: Sequence[NDArray[np.float32]],
    label_gradients: Sequence[NDArray[np.float32]],
) -> float:
    """Add the gradient of a photograph's squared error to those of layers and labels; returns this error.

    Args:
        codes: (H, W, 3) the photograph.
        layers: (K, h, w, 4) as they were drawn.
        matrix: (3, 4) of the view.
        places: Of `draw_sheets`.
        drawn: Of `draw_sheets`, overwritten.
        layer_gradients: K of (h, w, 4), added to.
        label_gradients: K of (h, w), added to.
    """
    error = composite_error(drawn, codes)
    base, slope = label_parallax_maps(matrix)
    parallel_map(
        lambda k: add_sheet_gradient(
            drawn[k], places[k], layers[k], base, slope, layer_gradients[k], label_gradients[k]
        ),
        range(len(drawn)),
    )
    return error


def sheets_of(image: MultiplaneImage, count: int) -> SoftSheets:
    """Sheets that stand for the planes of a multiplane image, each for some in a row.

    Planes are shared out so that their texels lie as near as possible to the sheets: least squares of labels, weighted
    by opacity, by dynamic programming. Within a sheet the label of a texel is the mean of its planes, smoothed.

    Args:
        image: The planes.
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
    own = np.minimum(opacity / MIN_OPACITY, 1)[..., None]
    own_colour = colour / np.maximum(opacity, MIN_OPACITY)[..., None]
    return height, np.concatenate([own * own_colour + (1 - own) * around, opacity[..., None]], axis=2)


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
