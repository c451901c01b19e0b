"""Layers as a photograph's view sees them, and the way back from its error to their gradients."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.multiplane.kernels import (
    add_layer_gradient,
    composite,
    composite_gradient,
    draw_layer,
    field_places,
    pixel_rays,
    plane_places,
)

BAND_ROWS = 32  # of a picture, composited at a time
PLACE_ITERATIONS = 6
PLACE_TOLERANCE_PIXELS = np.float32(1e-3)  # of a layer

Labels = NDArray[np.float64] | NDArray[np.float32]  # (D,) of planes, or (D, h, w) of height fields


def inverse_view(matrix: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """`base` (3, 3) and `slope` (2, 3) of `pixel_rays`, for a view.

    The plane of label d maps the reference view to a photograph by H + d m e3', with m a column of the view's matrix.
    Its inverse, by Sherman and Morrison, is H^-1 + d (c_3 I - c e3') H^-1 but for a scale, with c = H^-1 m.
    """
    base = np.asarray(np.linalg.inv(matrix[:, [0, 1, 3]]), np.float64)
    centre = base @ matrix[:, 2]
    turn = centre[2] * np.eye(3) - np.outer(centre, [0, 0, 1])
    return base, np.ascontiguousarray((turn @ base)[:2])


def view_rays(matrix: NDArray[np.float64], shape: tuple[int, int]) -> NDArray[np.float32]:
    """(H, W, 4) of `pixel_rays`, for a view.

    Args:
        shape: (H, W) of its picture.
    """
    rays = np.empty((*shape, 4), np.float32)
    pixel_rays(*inverse_view(matrix), rays)
    return rays


def draw_layers(
    labels: Labels,
    layers: NDArray[np.float32],
    rays: NDArray[np.float32],
    places: NDArray[np.float32],
    drawn: NDArray[np.float32],
) -> None:
    """drawn = each layer as a view sees it.

    Args:
        labels: (D,) of planes, or (D, h, w) of height fields.
        layers: (D, h, w, 4).
        rays: (H, W, 4) of `view_rays`.
        places: (D, H, W, 2), written: where the view reads each layer.
        drawn: (D, H, W, 4), written.
    """
    size = layers.shape[1:3]

    def one(index: int) -> None:
        field = labels[index]
        start = np.float32(field.mean())
        if labels.ndim == 1:
            plane_places(*size, rays, start, places[index])
        else:
            field_places(field, rays, start, PLACE_ITERATIONS, PLACE_TOLERANCE_PIXELS, places[index])
        draw_layer(layers[index], places[index], drawn[index])

    parallel_map(one, range(len(layers)))


def draw_picture(
    labels: Labels, layers: NDArray[np.float32], matrix: NDArray[np.float64], shape: tuple[int, int]
) -> NDArray[np.float32]:
    """(H, W, 3) layers, one over the other, as a view sees them; black where none is."""
    places, drawn = (np.empty((len(layers), *shape, numbers), np.float32) for numbers in (2, 4))
    draw_layers(labels, layers, view_rays(matrix, shape), places, drawn)
    picture = np.empty((*shape, 3), np.float32)
    parallel_map(lambda band: composite(drawn, *band, picture), pieces(shape[0], BAND_ROWS))
    return picture


def backpropagate(
    codes: NDArray[np.uint8],
    places: NDArray[np.float32],
    drawn: NDArray[np.float32],
    gradients: Sequence[NDArray[np.float32]],
) -> float:
    """Add the gradient of a photograph's squared error to that of the layers; returns this error.

    Args:
        codes: (H, W, 3) the photograph.
        places: (D, H, W, 2) of `draw_layers`.
        drawn: (D, H, W, 4) of `draw_layers`; becomes the error's gradient.
        gradients: D of (h, w, 4), added to.
    """

    def band(rows: tuple[int, int]) -> float:
        return float(composite_gradient(drawn, codes, *rows, np.empty((len(drawn), 3), np.float32)))

    errors = parallel_map(band, pieces(len(codes), BAND_ROWS))
    parallel_map(lambda d: add_layer_gradient(drawn[d], places[d], gradients[d]), range(len(drawn)))
    return sum(errors)
