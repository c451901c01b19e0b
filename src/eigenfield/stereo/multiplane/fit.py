"""A multiplane image fitted to photographs by descent, small first.

What is minimised, over all layers at once, is the mean squared error of the photographs, plus the total variation of
colour and opacity, plus a price for opacity, which empties what no photograph asks for. One step takes one photograph.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.progress import Progress
from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.multiplane.image import MultiplaneImage, backpropagate, draw_layers, plane_homographies
from eigenfield.stereo.multiplane.kernels import add_priors, move
from eigenfield.stereo.multiplane.pyramid import Pyramid
from eigenfield.stereo.views import (
    Pictures,
    check_matrices,
    halve_pictures,
    halved_matrices,
    pack_pictures,
    unpack_pictures,
)

log = logging.getLogger("eigenfield.stereo")


@dataclass(frozen=True)
class MultiplaneTuning:
    """Constants of `fit_multiplane`, found on Fern.

    Attributes:
        small_steps: Steps at half the size.
        steps: Steps at full size.
        small_levels: Grids of the pyramid at half the size.
        levels: Grids of the pyramid at full size, where regions are in place.
        small_rate: Movement of a colour in the first step at half the size.
        rate: The same at full size.
        opacity_rate_ratio: Movement of an opacity to that of a colour.
        last_rate_ratio: Of the last step to the first; it falls exponentially.
        colour_variation: Weight of the mean difference of neighbouring colours beside the mean squared error.
        opacity_variation: The same of opacities.
        small_variation_ratio: Both of these at half the size: neighbours there are twice as far apart.
        opacity_price: Weight of the mean opacity.
        huber_width: Difference of neighbours up to which its cost is quadratic.
        colour_margin: By which colours may leave 0..1.
        start_error_ratio: A layer starts opaque where its photographs differ by so many times the least difference.
        start_opacity: Opacity there.
        start_haze: Opacity elsewhere.
        start_window_pixels: Window in which photographs are compared.
    """

    small_steps: int = 480
    steps: int = 240
    small_levels: int = 7
    levels: int = 5
    small_rate: float = 0.02
    rate: float = 0.01
    opacity_rate_ratio: float = 0.5
    last_rate_ratio: float = 0.1
    colour_variation: float = 0.02
    opacity_variation: float = 0.06
    small_variation_ratio: float = 0.75
    opacity_price: float = 0.002
    huber_width: float = 0.01
    colour_margin: float = 0.2
    start_error_ratio: float = 1.15
    start_opacity: float = 0.9
    start_haze: float = 0.02
    start_window_pixels: int = 5


MULTIPLANE_TUNING = MultiplaneTuning()


def fit_multiplane(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    labels: NDArray[np.float64],
    *,
    tuning: MultiplaneTuning = MULTIPLANE_TUNING,
    progress: Progress | None = None,
) -> MultiplaneImage:
    """The multiplane image that draws V photographs best. Its farthest layer is opaque.

    Memory is about 90 bytes for a texel of each layer, and 16 for a pixel of each.

    Args:
        pictures: (V, H, W, 3) uint8 or packed.
        matrices: (V, 3, 4) of the views, see `view_matrices`.
        shape: (h, w) of the reference view.
        labels: (D,) at least two, ascending: the planes, back to front.
        tuning: Constants.
        progress: Reports the steps.

    Raises:
        ValueError: Pictures, matrices or labels are malformed.
    """
    packed, labels = pack_pictures(pictures), np.asarray(labels, np.float64)
    matrices = check_matrices(matrices, len(packed))
    if labels.ndim != 1 or len(labels) < 2 or not (np.diff(labels) > 0).all():
        raise ValueError("labels must be at least two, ascending")
    total = tuning.small_steps + tuning.steps

    def tick(done: int) -> None:
        if progress is not None:
            progress("multiplane image", done, total)

    small, fewer = halve_pictures(packed), halved_matrices(matrices)
    half = (shape[0] + 1) // 2, (shape[1] + 1) // 2
    layers = start_layers(small, fewer, half, labels, tuning)
    ratio = tuning.small_variation_ratio
    first = _Descent(layers, labels, tuning.small_levels, tuning.small_rate, ratio, tuning)
    first.run(small, fewer, tuning.small_steps, tick)
    layers = np.stack([cv2.resize(layer, shape[::-1], interpolation=cv2.INTER_LINEAR) for layer in layers])
    second = _Descent(layers, labels, tuning.levels, tuning.rate, 1.0, tuning)
    second.run(packed, matrices, tuning.steps, lambda done: tick(tuning.small_steps + done))
    return MultiplaneImage(labels, layers)


class _Descent:
    """Steps of all layers, which are changed in place."""

    def __init__(
        self,
        layers: NDArray[np.float32],
        labels: NDArray[np.float64],
        levels: int,
        rate: float,
        variation_ratio: float,
        tuning: MultiplaneTuning,
    ) -> None:
        self._layers, self._labels, self._rate, self._tuning = layers, labels, rate, tuning
        self._pyramids = [Pyramid(layers.shape[1:3], levels) for _ in layers]
        texels, width = layers[..., 0].size, layers.shape[2]
        colour, opacity = tuning.colour_variation / (3 * texels), tuning.opacity_variation / texels
        self._variation = _columns(variation_ratio * colour, variation_ratio * opacity, width)
        self._price = _columns(0, tuning.opacity_price / texels, width)
        self._low, self._high = _columns(-tuning.colour_margin, 0, width), _columns(1 + tuning.colour_margin, 1, width)
        self._backdrop = self._low.copy()
        self._backdrop[3::4] = 1  # the farthest layer is opaque
        layers[0, ..., 3] = 1

    def run(
        self, pictures: NDArray[np.uint32], matrices: NDArray[np.float64], steps: int, tick: Callable[[int], None]
    ) -> None:
        """Take steps, each by one photograph, in an order that is drawn anew when all had their turn."""
        order, waiting = np.random.default_rng(0), np.zeros(0, np.int64)
        drawn = np.empty((len(self._layers), *pictures.shape[1:], 4), np.float32)
        for number in range(1, steps + 1):
            if not len(waiting):
                waiting = order.permutation(len(pictures))
            view, waiting = int(waiting[-1]), waiting[:-1]
            homographies = plane_homographies(matrices[view], self._labels)
            draw_layers(self._layers, homographies, drawn)
            gradient = [pyramid.gradient for pyramid in self._pyramids]
            error = backpropagate(unpack_pictures(pictures[view]), homographies, drawn, gradient)
            falling = self._tuning.last_rate_ratio ** ((number - 1) / steps)
            self._move(number, self._rate * falling, 1 / (3 * drawn[0, ..., 0].size))
            tick(number)
            if number % 60 == 0:
                log.debug("step %d: %.2f dB", number, -10 * np.log10(error / (3 * drawn[0, ..., 0].size)))

    def _move(self, number: int, rate: float, scale: float) -> None:
        width = self._layers.shape[2]
        rates = _columns(rate, rate * self._tuning.opacity_rate_ratio, width)
        narrow = np.float32(1 / self._tuning.huber_width)

        def one(index: int) -> None:
            layer, pyramid = self._layers[index].reshape(-1, 4 * width), self._pyramids[index]
            step = pyramid.gradient.reshape(-1, 4 * width)
            add_priors(layer, np.float32(scale), self._variation, self._price, narrow, step)
            pyramid.step(number)
            move(layer, step, rates, self._low if index else self._backdrop, self._high)
            step[:] = 0

        parallel_map(one, range(len(self._layers)))


def _columns(colour: float, opacity: float, width: int) -> NDArray[np.float32]:
    """(4 width,) float32: one number for each of a texel's four, along a row."""
    return np.tile(np.array([colour, colour, colour, opacity], np.float32), width)


def start_layers(
    pictures: NDArray[np.uint32],
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    labels: NDArray[np.float64],
    tuning: MultiplaneTuning,
) -> NDArray[np.float32]:
    """(D, h, w, 4): the mean of the photographs on each plane, opaque where they differ least among all planes.

    Args:
        pictures: (V, H, W) packed.
        matrices: (V, 3, 4) of the views.
        shape: (h, w) of the layers.
        labels: (D,) of the planes.
        tuning: Constants.
    """
    codes = unpack_pictures(pictures)
    homographies = np.stack([plane_homographies(matrix, labels) for matrix in matrices])

    def sweep(index: int) -> tuple[NDArray[np.floating], NDArray[np.floating]]:
        total, squares = np.zeros((2, *shape, 3), np.float32)
        count = np.zeros(shape, np.float32)
        for view, homography in zip(codes, homographies[:, index], strict=True):
            size = shape[::-1]
            picture = cv2.warpPerspective(view, homography, size).astype(np.float32) / 255
            inside = cv2.warpPerspective(np.ones(view.shape[:2], np.uint8), homography, size, flags=cv2.INTER_NEAREST)
            picture *= inside[..., None]
            total += picture
            squares += picture * picture
            count += inside
        mean = total / np.maximum(count, 1)[..., None]
        spread = np.maximum(squares / np.maximum(count, 1)[..., None] - mean * mean, 0).sum(axis=2)
        window = (tuning.start_window_pixels,) * 2
        return mean, np.asarray(cv2.blur(spread, window), np.float32) + (count < 2)

    layers, errors = np.empty((len(labels), *shape, 4), np.float32), np.empty((len(labels), *shape), np.float32)
    for index, (mean, error) in enumerate(parallel_map(sweep, range(len(labels)))):
        layers[index, ..., :3], errors[index] = mean, error
    near = errors <= tuning.start_error_ratio * errors.min(axis=0) + 1e-5
    layers[..., 3] = np.where(near, tuning.start_opacity, tuning.start_haze)
    return layers
