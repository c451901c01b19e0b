"""Descent of layers with colour and opacity, one photograph a step.

What is minimised is the mean squared error of the photographs, plus the total variation of colour and opacity, plus a
price for opacity, which empties what no photograph asks for. Of few photographs, the total variation weighs more, as it
would beside the sum of their errors.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.multiplane.drawing import Labels, backpropagate, draw_layers, view_rays
from eigenfield.stereo.multiplane.kernels import add_priors, move
from eigenfield.stereo.multiplane.pyramid import Pyramid
from eigenfield.stereo.taps import OUTSIDE_PIXEL
from eigenfield.stereo.views import unpack_pictures

log = logging.getLogger("eigenfield.stereo")

CHANNELS = 4
LOG_STEPS = 60
FEW_VIEWS = 16  # number of photographs from which on the total variation weighs as its constants say


@dataclass(frozen=True)
class DescentTuning:
    """Constants of a descent.

    Attributes:
        levels: Grids of the pyramid of corrections.
        rate: Movement of a colour in the first step.
        opacity_rate_ratio: Movement of an opacity to that of a colour.
        last_rate_ratio: Of the last step to the first; it falls exponentially.
        colour_variation: Weight of the mean difference of neighbouring colours in a layer, summed over layers.
        opacity_variation: The same of opacities.
        opacity_price: Weight of a layer's mean opacity a, summed over layers.
        doubt_price: Weight of the mean of a (1 - a) in the last step, summed over layers; it grows from 0.
        huber_width: Difference of neighbours up to which its cost is quadratic.
        colour_margin: By which colours may leave 0..1.
    """

    steps: int
    levels: int
    rate: float
    opacity_rate_ratio: float = 0.5
    last_rate_ratio: float = 0.1
    colour_variation: float = 0.0006
    opacity_variation: float = 0.0019
    opacity_price: float = 0.00006
    doubt_price: float = 0.0
    huber_width: float = 0.01
    colour_margin: float = 0.2


class Descent:
    """Steps of all layers, which are changed in place. The first is the farthest, and is kept opaque.

    Attributes:
        labels: (D,) of planes, or (D, h, w) of height fields.
        layers: (D, h, w, 4) float32.
    """

    def __init__(self, labels: Labels, layers: NDArray[np.float32], tuning: DescentTuning, views: int) -> None:
        """Prepare the first step.

        Args:
            layers: (D, h, w, 4) float32, contiguous.
        """
        self.labels, self.layers, self.tuning = labels, layers, tuning
        _, height, width, channels = layers.shape
        self._pyramids = [Pyramid((height, width), channels, tuning.levels) for _ in layers]
        texels = height * width
        smooth = max(FEW_VIEWS / views, 1.0) / texels
        self._variation = _columns(tuning.colour_variation / 3 * smooth, tuning.opacity_variation * smooth, width)
        self._price, self._doubt = (_columns(0, x / texels, width) for x in (tuning.opacity_price, tuning.doubt_price))
        low, high = -tuning.colour_margin, 1 + tuning.colour_margin
        self._low, self._opaque, self._high = (_columns(*pair, width) for pair in ((low, 0), (low, 1), (high, 1)))
        layers[0, ..., 3] = 1

    def run(
        self, pictures: NDArray[np.uint32], matrices: NDArray[np.float64], tick: Callable[[int], None] | None = None
    ) -> None:
        """Take all steps, in an order of photographs that is drawn anew when all had their turn.

        Args:
            tick: Is called after each step with its number, from 1 on.
        """
        order, waiting, tuning = np.random.default_rng(0), np.zeros(0, np.int64), self.tuning
        shape = len(self.layers), *pictures.shape[1:3]
        places, drawn = np.empty((*shape, 2), np.float32), np.empty((*shape, CHANNELS), np.float32)
        gradients, numbers = [pyramid.gradient for pyramid in self._pyramids], 3 * pictures[0].size
        for number in range(1, tuning.steps + 1):
            if not len(waiting):
                waiting = order.permutation(len(pictures))
            view, waiting = int(waiting[-1]), waiting[:-1]
            rays = view_rays(matrices[view], shape[1:])
            rays[pictures[view] >= OUTSIDE_PIXEL, 0] = np.nan  # nothing is drawn there, so that nothing follows from it
            draw_layers(self.labels, self.layers, rays, places, drawn)
            error = backpropagate(unpack_pictures(pictures[view]), places, drawn, gradients)
            falling = tuning.last_rate_ratio ** ((number - 1) / tuning.steps)
            parallel_map(
                partial(self._move, number, falling, np.float32(1 / numbers), rays, places, drawn),
                range(len(self.layers)),
            )
            if number % LOG_STEPS == 0:
                log.debug("step %d: %.2f dB", number, -10 * np.log10(max(error / numbers, 1e-12)))
            if tick is not None:
                tick(number)

    def _move(
        self,
        number: int,
        falling: float,
        scale: np.float32,
        rays: NDArray[np.float32],
        places: NDArray[np.float32],
        drawn: NDArray[np.float32],
        index: int,
    ) -> None:
        """Turn a layer's gradient into a step, and take it.

        Args:
            falling: Part of the rates that is left.
            rays: (H, W, 4) of the photograph's view.
            places: Of `draw_layers`.
            drawn: The gradient of the drawn layers, see `backpropagate`.
        """
        tuning, width = self.tuning, self.layers.shape[2]
        layer, pyramid = self.layers[index].reshape(-1, CHANNELS * width), self._pyramids[index]
        step = pyramid.gradient.reshape(layer.shape)
        narrow = np.float32(1 / tuning.huber_width)
        doubt = self._doubt * np.float32(number / tuning.steps)
        add_priors(layer, CHANNELS, scale, self._variation, self._price, doubt, narrow, step)
        pyramid.step(number)
        rate = tuning.rate * falling
        rates = _columns(rate, rate * tuning.opacity_rate_ratio, width)
        move(layer, step, rates, self._low if index else self._opaque, self._high)
        step[:] = 0


def _columns(colour: float, opacity: float, width: int) -> NDArray[np.float32]:
    """(4 width,) float32: one number for each of a texel's four, along a row."""
    return np.tile(np.array([colour, colour, colour, opacity], np.float32), width)
