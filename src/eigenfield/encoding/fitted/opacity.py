"""The opacity of sheets, fitted to the photographs on the mesh that draws them.

The colour of a pixel is affine in the opacity of each point that it shows (`kernels.opacity_steps`). Rounds alternate:
the mean of luma for the opacity, then a damped Gauss-Newton step of the opacity, by the diagonal of its normal matrix.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from eigenfield.core.camera import Camera
from eigenfield.core.observations import Observations, select_cameras
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.fitted.colour import split_matrix
from eigenfield.encoding.fitted.fit import fit_mean
from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.observations import FitData, open_fit_data, open_on_proxy
from eigenfield.encoding.fitted.passes import PASS_TASKS
from eigenfield.encoding.fitted.sheet_kernels import opacity_steps
from eigenfield.encoding.fitted.solve import measure_scales
from eigenfield.encoding.fitted.start import residual_image
from eigenfield.encoding.geometry.distortion import spread_cameras
from eigenfield.runtime.parallel import even_pieces, parallel_map

log = logging.getLogger("eigenfield.encode")

# Chosen on Fern and tried on Boxes
OPACITY_ROUNDS = 4
OPACITY_MAX_CAMERAS = 49  # that take part
OPACITY_FIRST_ITERATIONS = 8  # of conjugate gradients, for the first mean
OPACITY_ITERATIONS = 4  # of those for each later one
OPACITY_STEP_RATIO = 0.5  # of a whole Gauss-Newton step
OPACITY_RIDGE = 1.0  # cost of an opacity that differs from the one given, in median diagonal entries
OPACITY_DAMPING = 0.1  # likewise, added to the diagonal
OPACITY_SIGMA_TEXELS = 0.7  # standard deviation of the window in which texels step together
OPACITY_MAX_STEP = 0.15  # in a round
OPACITY_OPAQUE = 0.999  # from here on an opacity stays: nothing is known of what is behind


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
        observations: Those of OPACITY_MAX_CAMERAS cameras, spread over the array, are decoded.

    Raises:
        CaptureError: A photograph cannot be read.
        OutputError: `disk-full`.
    """
    chosen = spread_cameras(cameras, OPACITY_MAX_CAMERAS)
    some, used = select_cameras(observations, chosen), [cameras[index] for index in chosen]
    assert proxy.sheets is not None
    size = proxy.sheets.opacity.shape[0], proxy.sheets.opacity.shape[1]
    with open_fit_data(used, some, proxy, size, work) as every:
        return opacity_in_rounds(
            proxy,
            lambda now: nullcontext(every) if now is proxy else open_on_proxy(every, used, now, work),
            OPACITY_ROUNDS,
            progress,
        )


def opacity_in_rounds(
    proxy: Proxy,
    open_data: Callable[[Proxy], AbstractContextManager[FitData]],
    rounds: int,
    progress: Progress | None = None,
) -> Proxy:
    """The proxy with the opacity of its sheets fitted in so many rounds.

    Args:
        open_data: From a proxy, given or of a round, to what its opacity is fitted to, under an atlas of its size.
    """
    assert proxy.sheets is not None
    given, opacity = proxy.sheets.opacity, proxy.sheets.opacity
    model = PlaneModel.grey(split_matrix()[0], (given.shape[0], given.shape[1]))
    for number in range(rounds):
        if progress is not None:
            progress("fit opacity", number, rounds)
        with open_data(proxy) as data:
            iterations = OPACITY_ITERATIONS if number else OPACITY_FIRST_ITERATIONS
            mean_alone = fit_mean(data, model, measure_scales(data, model), iterations)
            log.info("opacity, before round %d: %.2f dB by the mean alone", number, mean_alone.psnr)
            opacity = _stepped(opacity, given, *_sums(data, model))
        proxy = replace(proxy, sheets=replace(proxy.sheets, opacity=opacity))
    if progress is not None:
        progress("fit opacity", rounds, rounds)
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
    seen = diagonal[diagonal > 0]
    unit = np.float32(np.median(seen) if len(seen) else 1)
    pull = asked - np.float32(OPACITY_RIDGE) * unit * (opacity - given)
    along, across = (gaussian_filter(values, OPACITY_SIGMA_TEXELS) for values in (pull, diagonal))
    step = OPACITY_STEP_RATIO * along / (across + (OPACITY_RIDGE + OPACITY_DAMPING) * unit)
    moved = np.clip(opacity + np.clip(step, -OPACITY_MAX_STEP, OPACITY_MAX_STEP), 0, 1)
    return np.where(opacity < OPACITY_OPAQUE, moved, opacity).astype(np.float32)
