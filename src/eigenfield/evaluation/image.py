"""The image scores: photographs against the pictures drawn from their own cameras."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.evaluation.exclusion import ExcludedCircle
from eigenfield.imaging.flip import flip
from eigenfield.imaging.metrics import PictureArray, psnr, psnr_luma, ssim, to_codes

ImageScores = dict[str, float | None]
HIGHER_IS_WORSE = frozenset({"flip"})


def measure_picture(
    drawn: PictureArray,
    surface: NDArray[np.bool_],
    photograph: PictureArray,
    mask: NDArray[np.float32] | None = None,
    with_flip: bool = False,
) -> ImageScores:
    """The scores of a picture that docs/measures.md defines, for one camera; None where no pixel is covered.

    Args:
        drawn: (H, W, 3), 0..1 or uint8.
        photograph: (H, W, 3), 0..1 or uint8.
        mask: (H, W) valid pixels of the photograph. The full scores are of the whole frame anyway.
    """
    a, b = to_codes(drawn), to_codes(photograph)
    covered = covered_pixels(surface, mask)
    counted = covered.size if mask is None else int(np.count_nonzero(mask > 0.5))
    scores: ImageScores = {
        "psnr": psnr(a, b, covered),
        "ssim": ssim(a, b, covered),
        "psnr_full": psnr(a, b),
        "ssim_full": ssim(a, b),
        "psnr_luma": psnr_luma(a, b, covered),
        "psnr_luma_full": psnr_luma(a, b),
        "coverage": int(np.count_nonzero(covered)) / counted if counted else None,
    }
    return scores | ({"flip": flip(a, b, covered)} if with_flip else {})


def measure_outside(
    drawn: NDArray[np.float32],
    surface: NDArray[np.bool_],
    photograph: NDArray[np.float32],
    mask: NDArray[np.float32] | None,
    circle: ExcludedCircle | None,
    with_flip: bool = False,
) -> ImageScores:
    """Scores over the covered pixels outside a circle.

    Args:
        drawn: (H, W, 3), 0..1 or uint8.
        photograph: (H, W, 3), 0..1 or uint8.
        circle: Of the camera; None: all covered pixels count.
    """
    a, b = to_codes(drawn), to_codes(photograph)
    counted = covered_pixels(surface, mask)
    if circle is not None:
        counted = counted & circle.outside(a.shape[1], a.shape[0])
    scores = {"psnr": psnr(a, b, counted), "ssim": ssim(a, b, counted), "psnr_luma": psnr_luma(a, b, counted)}
    return scores | ({"flip": flip(a, b, counted)} if with_flip else {})


def covered_pixels(surface: NDArray[np.bool_], mask: NDArray[np.float32] | None) -> NDArray[np.bool_]:
    """(H, W) bool: the pixels of the surface, within the mask of valid ones if there is one."""
    return surface if mask is None else surface & (mask > 0.5)


def summarise_scores(scores: Sequence[Mapping[str, float | None]], names: Sequence[str]) -> dict[str, object]:
    """The mean of each key over the cameras that have it, and under "worst" the worst value and its camera.

    The worst is the lowest, for HIGHER_IS_WORSE the highest; the first of equals. A key that no camera has is None in
    both."""
    means: dict[str, object] = {}
    worst: dict[str, object] = {}
    for key in scores[0]:
        values = [(value, name) for one, name in zip(scores, names, strict=True) if (value := one[key]) is not None]
        means[key] = sum(value for value, _ in values) / len(values) if values else None
        pick = max if key in HIGHER_IS_WORSE else min
        found = pick(values, key=lambda pair: pair[0], default=None)
        worst[key] = None if found is None else {"value": found[0], "camera": found[1]}
    return {**means, "worst": worst}
