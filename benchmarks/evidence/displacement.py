"""How far a drawn picture stands beside its photograph, and what it would be worth if it stood in its place."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.colour import LUMA_BT709
from eigenfield.imaging.metrics import to_codes

LIMIT = 2.0  # pixels that a displacement may have
MEDIAN, SMOOTH = 5, 2.0  # side of the median window, σ of the Gaussian after it: what is one pixel's own is no shift


def displacement(drawn: NDArray[Any], photograph: NDArray[Any], covered: NDArray[np.bool_]) -> NDArray[np.float32]:
    """(H, W, 2) float32, right and down: where in `drawn` each pixel of the photograph is found, in pixels, at most
    LIMIT long; 0 where not covered. Dense inverse search (Kroeger et al., ECCV 2016) on luma, a median, a Gaussian.
    """
    fixed = _luma(photograph)
    moving = np.where(covered, _luma(drawn), fixed)
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)  # its stripes, and so its result, follow the number of threads
    try:
        method = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
        flow = np.asarray(method.calc(fixed, moving, np.zeros((*fixed.shape, 2), np.float32)), np.float32)
    finally:
        cv2.setNumThreads(threads)
    parts = [cv2.medianBlur(np.ascontiguousarray(flow[..., axis]), MEDIAN) for axis in range(2)]
    smooth = cv2.GaussianBlur(np.stack(parts, axis=-1), (0, 0), SMOOTH)
    length = np.linalg.norm(smooth, axis=2, keepdims=True)
    limited = np.asarray(smooth, np.float32) * np.minimum(1, LIMIT / np.maximum(length, 1e-9))
    return np.where(covered[..., None], limited, 0).astype(np.float32)


def moved_back(drawn: NDArray[np.uint8], flow: NDArray[np.float32], covered: NDArray[np.bool_]) -> NDArray[np.uint8]:
    """(H, W, 3) `drawn` sampled (bicubic) where `flow` says; as it was where that reaches beyond the covered pixels."""
    rows, columns = np.indices(covered.shape)
    x, y = (columns + flow[..., 0]).astype(np.float32), (rows + flow[..., 1]).astype(np.float32)
    moved = np.asarray(cv2.remap(drawn, x, y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE), np.uint8)
    whole = cv2.remap(covered.astype(np.float32), x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return np.where((np.asarray(whole) > 0.999)[..., None], moved, drawn)


def _luma(picture: NDArray[Any]) -> NDArray[np.uint8]:
    return np.rint(to_codes(picture) @ np.array(LUMA_BT709)).astype(np.uint8)
