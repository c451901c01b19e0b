"""The image measure: photographs against the pictures drawn from their own cameras."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.evaluation.exclusion import Circle
from eigenfield.metrics import psnr, psnr_luma, ssim, to_codes

Figures = dict[str, float | None]
KEYS = ("psnr", "ssim", "psnr_full", "ssim_full", "psnr_luma", "coverage")
OUTSIDE_KEYS = ("psnr", "ssim", "psnr_luma")


def measure_picture(
    drawn: NDArray[np.float32],
    surface: NDArray[np.bool_],
    photograph: NDArray[np.float32],
    mask: NDArray[np.float32] | None = None,
) -> Figures:
    """All of KEYS for one camera.

    drawn, photograph: (H, W, 3), 0..1. surface: (H, W), where the proxy puts surface. mask: (H, W), what of the
    photograph counts; the full figures are of the whole frame all the same. None where no pixel is covered.
    """
    a, b = to_codes(drawn), to_codes(photograph)
    covered = covered_pixels(surface, mask)
    counted = covered.size if mask is None else int(np.count_nonzero(mask > 0.5))
    return {
        "psnr": psnr(a, b, covered),
        "ssim": ssim(a, b, covered),
        "psnr_full": psnr(a, b),
        "ssim_full": ssim(a, b),
        "psnr_luma": psnr_luma(a, b, covered),
        "coverage": int(np.count_nonzero(covered)) / counted if counted else None,
    }


def measure_outside(
    drawn: NDArray[np.float32],
    surface: NDArray[np.bool_],
    photograph: NDArray[np.float32],
    mask: NDArray[np.float32] | None,
    circle: Circle | None,
) -> Figures:
    """OUTSIDE_KEYS over the covered pixels outside a circle; a camera without one counts whole."""
    a, b = to_codes(drawn), to_codes(photograph)
    counted = covered_pixels(surface, mask)
    if circle is not None:
        counted = counted & circle.outside(a.shape[1], a.shape[0])
    return {"psnr": psnr(a, b, counted), "ssim": ssim(a, b, counted), "psnr_luma": psnr_luma(a, b, counted)}


def covered_pixels(surface: NDArray[np.bool_], mask: NDArray[np.float32] | None) -> NDArray[np.bool_]:
    """(H, W) bool: surface, within the mask where there is one."""
    return surface if mask is None else surface & (mask > 0.5)


def summary(figures: Sequence[Mapping[str, float | None]], names: Sequence[str]) -> dict[str, object]:
    """The mean of each key over the cameras that have it, and under "worst" its lowest value with that camera's name.

    The first of equals is the worst. A key that no camera has is None, in both places.
    """
    means: dict[str, object] = {}
    worst: dict[str, object] = {}
    for key in figures[0]:
        values = [(value, name) for one, name in zip(figures, names, strict=True) if (value := one[key]) is not None]
        means[key] = sum(value for value, _ in values) / len(values) if values else None
        lowest = min(values, key=lambda pair: pair[0], default=None)
        worst[key] = None if lowest is None else {"value": lowest[0], "camera": lowest[1]}
    return {**means, "worst": worst}
