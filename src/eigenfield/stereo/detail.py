"""Pictures made for comparing: local detail, which moves with the surface, over shading, which need not."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.views import Pictures, pack, unpack

DIAMETER, RANGE, SPACE = 9, 20.0, 3.0  # of the bilateral filter: pixels, grey levels, pixels
GAIN, REST = 4.0, 0.5
SOFT = 0.6  # pixels
MIDDLE = 128


def detail_pictures(
    pictures: Pictures, gain: float = GAIN, rest: float = REST, soft: float = SOFT
) -> NDArray[np.uint32]:
    """Packed pictures 128 + gain (p - base) + rest (base - 128), base being
    the picture after a bilateral filter.

    Shading, gloss and fall-off of light are smooth and move with the camera, not with the surface: compared as they
    are, they outweigh faint texture and put it at a wrong depth. The filter keeps edges, so that what lies on one side
    of an outline says nothing of the other.

    soft: pixels by which the result is blurred. Bilinear reading smooths noise between pixels but not on them: without
    a little blur, labels of a regular array that fall on whole pixels look worse than they are. Outlines want none.
    """
    packed = pack(pictures)
    result = np.empty_like(packed)

    def work(index: int) -> None:
        colours = unpack(packed[index]).astype(np.float32)
        base = cv2.bilateralFilter(colours, DIAMETER, RANGE, SPACE)
        raised = MIDDLE + gain * (colours - base) + rest * (base - MIDDLE)
        if soft > 0:
            raised = cv2.GaussianBlur(raised, (0, 0), soft)
        result[index] = pack(np.clip(np.rint(raised), 0, 255).astype(np.uint8)[None])[0]

    parallel_map(work, range(len(packed)))
    return result
