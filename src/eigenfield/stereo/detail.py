"""Pictures for matching: local detail, which moves with the surface, is amplified over shading, which may not."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.taps import OUTSIDE_PIXEL
from eigenfield.stereo.views import Pictures, pack_pictures, unpack_pictures

DETAIL_DIAMETER_PIXELS, DETAIL_RANGE_SIGMA_LEVELS, DETAIL_SPACE_SIGMA_PIXELS = 9, 20.0, 3.0  # of the bilateral filter
DETAIL_GAIN, DETAIL_BASE_GAIN = 4.0, 0.5
DETAIL_BLUR_SIGMA_PIXELS = 0.6
DETAIL_MID_LEVEL = 128


def detail_pictures(
    pictures: Pictures,
    gain: float = DETAIL_GAIN,
    blur_sigma: float = DETAIL_BLUR_SIGMA_PIXELS,
    base_gain: float = DETAIL_BASE_GAIN,
) -> NDArray[np.uint32]:
    """Packed pictures mid + gain (p - base) + base_gain (base - mid), with base the picture after a bilateral filter.

    Shading, gloss and light fall-off are smooth and move with the camera, not with the surface. In plain pictures they
    outweigh faint texture and put it at a wrong depth. The filter keeps edges, so that one side of an outline does not
    affect the other.

    Bilinear sampling smooths noise between pixels but not on them. Without a little blur, labels of a regular array
    that fall on whole pixels look worse than they are. Outlines are sharper without blur.

    Args:
        blur_sigma: Pixels by which the result is blurred; 0 for none.
        base_gain: Factor of the base; 0 where exposure or gloss may differ between the photographs.

    Returns:
        (V, H, W) packed pictures.
    """
    packed = pack_pictures(pictures)
    result = np.empty_like(packed)

    def work(index: int) -> None:
        colours = unpack_pictures(packed[index]).astype(np.float32)
        base = cv2.bilateralFilter(
            colours, DETAIL_DIAMETER_PIXELS, DETAIL_RANGE_SIGMA_LEVELS, DETAIL_SPACE_SIGMA_PIXELS
        )
        raised = DETAIL_MID_LEVEL + gain * (colours - base) + base_gain * (base - DETAIL_MID_LEVEL)
        if blur_sigma > 0:
            raised = cv2.GaussianBlur(raised, (0, 0), blur_sigma)
        codes = np.clip(np.rint(raised), 0, 255).astype(np.uint8)
        result[index] = pack_pictures(codes[None])[0] | (packed[index] & OUTSIDE_PIXEL)

    parallel_map(work, range(len(packed)))
    return result
