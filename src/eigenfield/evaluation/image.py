"""The image measure: photographs against the pictures drawn from their own cameras."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.evaluation.exclusion import Circle
from eigenfield.imaging.flip import flip
from eigenfield.imaging.metrics import Picture, psnr, psnr_luma, ssim, to_codes

Figures = dict[str, float | None]
KEYS = ("psnr", "ssim", "psnr_full", "ssim_full", "psnr_luma", "psnr_luma_full", "coverage", "flip")
OUTSIDE_KEYS = ("psnr", "ssim", "psnr_luma", "flip")
WORST_IS_HIGHEST = frozenset({"flip"})


def measure_picture(
    drawn: Picture,
    surface: NDArray[np.bool_],
    photograph: Picture,
    mask: NDArray[np.float32] | None = None,
    with_flip: bool = False,
) -> Figures:
    """All of KEYS for one camera, `flip` only when asked for.

    drawn, photograph: (H, W, 3), 0..1 or uint8. surface: (H, W), where the proxy puts surface. mask: (H, W), what of
    the photograph counts; the full figures are of the whole frame all the same. None where no pixel is covered.
    """
    a, b = to_codes(drawn), to_codes(photograph)
    covered = covered_pixels(surface, mask)
    counted = covered.size if mask is None else int(np.count_nonzero(mask > 0.5))
    figures: Figures = {
        "psnr": psnr(a, b, covered),
        "ssim": ssim(a, b, covered),
        "psnr_full": psnr(a, b),
        "ssim_full": ssim(a, b),
        "psnr_luma": psnr_luma(a, b, covered),
        "psnr_luma_full": psnr_luma(a, b),
        "coverage": int(np.count_nonzero(covered)) / counted if counted else None,
    }
    return figures | ({"flip": flip(a, b, covered)} if with_flip else {})


def measure_outside(
    drawn: NDArray[np.float32],
    surface: NDArray[np.bool_],
    photograph: NDArray[np.float32],
    mask: NDArray[np.float32] | None,
    circle: Circle | None,
    with_flip: bool = False,
) -> Figures:
    """OUTSIDE_KEYS over the covered pixels outside a circle, `flip` only when asked for; a camera without one counts
    whole."""
    a, b = to_codes(drawn), to_codes(photograph)
    counted = covered_pixels(surface, mask)
    if circle is not None:
        counted = counted & circle.outside(a.shape[1], a.shape[0])
    figures = {"psnr": psnr(a, b, counted), "ssim": ssim(a, b, counted), "psnr_luma": psnr_luma(a, b, counted)}
    return figures | ({"flip": flip(a, b, counted)} if with_flip else {})


def covered_pixels(surface: NDArray[np.bool_], mask: NDArray[np.float32] | None) -> NDArray[np.bool_]:
    """(H, W) bool: surface, within the mask where there is one."""
    return surface if mask is None else surface & (mask > 0.5)


def summary(figures: Sequence[Mapping[str, float | None]], names: Sequence[str]) -> dict[str, object]:
    """The mean of each key over the cameras that have it, and under "worst" its worst value with that camera's name.

    The worst is the lowest, of WORST_IS_HIGHEST the highest; the first of equals. A key that no camera has is None, in
    both places.
    """
    means: dict[str, object] = {}
    worst: dict[str, object] = {}
    for key in figures[0]:
        values = [(value, name) for one, name in zip(figures, names, strict=True) if (value := one[key]) is not None]
        means[key] = sum(value for value, _ in values) / len(values) if values else None
        pick = max if key in WORST_IS_HIGHEST else min
        found = pick(values, key=lambda pair: pair[0], default=None)
        worst[key] = None if found is None else {"value": found[0], "camera": found[1]}
    return {**means, "worst": worst}
