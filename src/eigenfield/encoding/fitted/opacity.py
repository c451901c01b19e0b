"""The opacity of sheets, fitted to the photographs on the mesh that draws them.

The colour of a pixel is affine in the opacity of each point that it shows (`kernels.opacity_steps`). Rounds alternate:
the mean of luma for the opacity, then a damped Gauss-Newton step of the opacity, by the diagonal of its normal matrix.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import logging
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from eigenfield.core.camera import Camera
from eigenfield.core.observations import Observations, select_cameras
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.fitted.colour import split_matrix
from eigenfield.encoding.fitted.fit import MEAN_WANTED, NOTHING_WANTED
from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.observations import FitData, open_fit_data, open_on_proxy
from eigenfield.encoding.fitted.passes import PASS_TASKS, psnr_of
from eigenfield.encoding.fitted.sheet_kernels import opacity_steps
from eigenfield.encoding.fitted.solve import fit_textures, measure_scales, residual
from eigenfield.encoding.fitted.start import residual_image
from eigenfield.encoding.geometry.distortion import spread_cameras
from eigenfield.runtime.parallel import even_pieces, parallel_map

log = logging.getLogger("eigenfield.encode")


@dataclass(frozen=True)
class OpacityTuning:
    """Constants of `fit_opacity`, chosen on Fern and tried on Boxes.

    Attributes:
        rounds: Steps of the opacity.
        max_cameras: Cameras that take part.
        first_iterations: Of conjugate gradients for the first mean.
        iterations: Of those for each later one.
        step_ratio: Of a whole Gauss-Newton step.
        ridge: Cost of an opacity that differs from the one given, in median diagonal entries.
        damping: Added to the diagonal, likewise.
        sigma_texels: Standard deviation of the window in which texels step together.
        max_step: Of an opacity in a round.
        opaque: From here on an opacity stays: nothing is known of what is behind.
    """

    rounds: int = 4
    max_cameras: int = 49
    first_iterations: int = 8
    iterations: int = 4
    step_ratio: float = 0.5
    ridge: float = 1.0
    damping: float = 0.1
    sigma_texels: float = 0.7
    max_step: float = 0.15
    opaque: float = 0.999


OPACITY_TUNING = OpacityTuning()


def fit_opacity(
    proxy: Proxy,
    cameras: Sequence[Camera],
    observations: Observations,
    work: Path | None = None,
    progress: Progress | None = None,
) -> Proxy:
    """The proxy with the opacity of its sheets as the photographs ask for it.

    Args:
        proxy: With sheets.
        cameras: Of the observations.
        observations: Those of `max_cameras` cameras, spread over the array, are decoded.
        work: Folder for scratch files.
        progress: Reports the rounds.

    Raises:
        CaptureError: A photograph cannot be read.
        OutputError: `disk-full`.
    """
    chosen = spread_cameras(cameras, OPACITY_TUNING.max_cameras)
    some, used = select_cameras(observations, chosen), [cameras[index] for index in chosen]
    assert proxy.sheets is not None
    given, opacity = proxy.sheets.opacity, proxy.sheets.opacity
    size = given.shape[0], given.shape[1]
    model = PlaneModel.grey(split_matrix()[0], size)
    with open_fit_data(used, some, proxy, size, work) as every:
        for number in range(OPACITY_TUNING.rounds):
            if progress is not None:
                progress("fit opacity", number, OPACITY_TUNING.rounds)
            with open_on_proxy(every, used, proxy, work) if number else nullcontext(every) as data:
                scales = measure_scales(data, model)
                iterations = OPACITY_TUNING.iterations if number else OPACITY_TUNING.first_iterations
                fit_textures(data, model, scales, residual(data, model, MEAN_WANTED), iterations, mean_only=True)
                left = residual(data, model, NOTHING_WANTED)
                reached = psnr_of(left.squares, left.pixels)
                log.info("opacity, before round %d: %.2f dB by the mean alone", number, reached)
                opacity = _stepped(opacity, given, *_sums(data, model))
            proxy = replace(proxy, sheets=replace(proxy.sheets, opacity=opacity))
    if progress is not None:
        progress("fit opacity", OPACITY_TUNING.rounds, OPACITY_TUNING.rounds)
    return proxy


def _sums(data: FitData, model: PlaneModel) -> NDArray[np.float32]:
    """(2, H, W) of all observations: see `opacity_steps`."""
    total = np.zeros((2, *model.mean.shape[1:]), np.float32)

    def piece(part: tuple[int, int]) -> NDArray[np.float32]:
        added = np.zeros_like(total)
        for index in range(*part):
            image, weight = residual_image(data, model, index), data.observations.weights(index)
            opacity_steps(*data.footprint(index), model.mean, image, weight, added)
        return added

    for added in parallel_map(piece, even_pieces(len(data), PASS_TASKS)):
        total += added
    return total


def _stepped(
    opacity: NDArray[np.float32], given: NDArray[np.float32], asked: NDArray[np.float32], diagonal: NDArray[np.float32]
) -> NDArray[np.float32]:
    """(H, W) the opacity after a step."""
    tuning, seen = OPACITY_TUNING, diagonal[diagonal > 0]
    unit = np.float32(np.median(seen) if len(seen) else 1)
    pull = asked - np.float32(tuning.ridge) * unit * (opacity - given)
    along, across = (gaussian_filter(values, tuning.sigma_texels) for values in (pull, diagonal))
    step = tuning.step_ratio * along / (across + (tuning.ridge + tuning.damping) * unit)
    moved = np.clip(opacity + np.clip(step, -tuning.max_step, tuning.max_step), 0, 1)
    return np.where(opacity < tuning.opaque, moved, opacity).astype(np.float32)
