"""A multiplane image: layers with colour and opacity on planes before a reference view, and how photographs see it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.multiplane.kernels import add_layer_gradient, composite, composite_gradient, draw_layer

BAND_ROWS = 32  # of a picture, composited at a time


@dataclass(frozen=True, eq=False)
class MultiplaneImage:
    """Layers of one size, each on the plane of one label of a `ReferenceView`.

    Attributes:
        labels: (D,) float64 ascending, so that the farthest layer is the first.
        layers: (D, h, w, 4) float32 R, G, B in the photographs' own values and opacity, 0..1.
    """

    labels: NDArray[np.float64]
    layers: NDArray[np.float32]

    def draw(self, matrix: NDArray[np.float64], shape: tuple[int, int]) -> NDArray[np.float32]:
        """(H, W, 3) what a view sees; black where no layer is.

        Args:
            matrix: (3, 4) of the view, see `view_matrices`.
            shape: (H, W) of its picture.
        """
        drawn = np.empty((len(self.labels), *shape, 4), np.float32)
        draw_layers(self.layers, plane_homographies(matrix, self.labels), drawn)
        picture = np.empty((*shape, 3), np.float32)
        parallel_map(lambda band: composite(drawn, *band, picture), pieces(shape[0], BAND_ROWS))
        return picture


def plane_homographies(matrix: NDArray[np.float64], labels: NDArray[np.float64]) -> NDArray[np.float64]:
    """(D, 3, 3) from a view's index coordinates to those of the reference view, by the plane of each label.

    Args:
        matrix: (3, 4) of the view, see `view_matrices`.
        labels: (D,).
    """
    forward = np.repeat(matrix[None, :, [0, 1, 3]], len(labels), axis=0)
    forward[:, :, 2] += labels[:, None] * matrix[:, 2]
    return np.asarray(np.linalg.inv(forward), np.float64)


def draw_layers(layers: NDArray[np.float32], homographies: NDArray[np.float64], drawn: NDArray[np.float32]) -> None:
    """drawn (D, H, W, 4) = each layer as a view sees it.

    Args:
        layers: (D, h, w, 4).
        homographies: (D, 3, 3) of `plane_homographies`.
        drawn: Written.
    """
    parallel_map(lambda d: draw_layer(layers[d], homographies[d], drawn[d]), range(len(layers)))


def composite_error(drawn: NDArray[np.float32], codes: NDArray[np.uint8]) -> float:
    """The squared error of a photograph, whose gradient takes the place of the drawn layers.

    Args:
        drawn: (D, H, W, 4), overwritten.
        codes: (H, W, 3) the photograph.
    """

    def band(rows: tuple[int, int]) -> float:
        return float(composite_gradient(drawn, codes, *rows, np.empty((len(drawn), 3), np.float32)))

    return sum(parallel_map(band, pieces(len(codes), BAND_ROWS)))


def backpropagate(
    codes: NDArray[np.uint8],
    homographies: NDArray[np.float64],
    drawn: NDArray[np.float32],
    gradients: Sequence[NDArray[np.float32]],
) -> float:
    """Add the gradient of a photograph's squared error to that of the layers; returns this error.

    Args:
        codes: (H, W, 3) the photograph.
        homographies: (D, 3, 3) of the photograph.
        drawn: (D, H, W, 4) of `draw_layers`, overwritten.
        gradients: D of (h, w, 4), added to.
    """
    error = composite_error(drawn, codes)
    parallel_map(lambda d: add_layer_gradient(drawn[d], homographies[d], gradients[d]), range(len(drawn)))
    return error
