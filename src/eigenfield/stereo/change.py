"""Which pixels of a photograph show something else than what stands still before its camera.

A change of light is no motion: a factor that varies slowly over the picture is found first.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

CHANGE_WINDOW_PIXELS = 3  # over which differences are averaged
CHANGE_MIN_LEVELS, CHANGE_MAX_LEVELS = 6.0, 20.0  # grey levels that are a change, at least and at most
CHANGE_NOISE_RATIO = 4.0  # of a change to the median difference in the picture, which is noise
CHANGE_MARGIN_PIXELS = 3  # around what has changed, which counts as changed
LIGHT_DARK_LEVELS = 8.0  # added before logarithms: dark pixels say little about light
LIGHT_PICTURE_PIXELS = 64  # longer side at which light is compared, about
LIGHT_ROUNDS = 8  # of weighted least squares
LIGHT_SCALE = 0.03  # difference of logarithms at which a weight is a half


def changed_pixels(picture: NDArray[np.uint8], still: NDArray[np.uint8]) -> NDArray[np.bool_]:
    """(H, W) where a photograph differs from what stands still, more than noise and light explain.

    Args:
        picture: (H, W, 3) of a frame.
        still: (H, W, 3) of the same camera.
    """
    lit = in_light_of(picture, still)
    window = (CHANGE_WINDOW_PIXELS, CHANGE_WINDOW_PIXELS)
    difference = np.abs(cv2.blur(picture.astype(np.float32) - lit, window)).max(axis=2)
    usual = CHANGE_NOISE_RATIO * float(np.median(difference))
    changed = difference > min(max(usual, CHANGE_MIN_LEVELS), CHANGE_MAX_LEVELS)
    changed = cv2.morphologyEx(changed.astype(np.uint8), cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))  # specks are noise
    return cv2.dilate(changed, np.ones((CHANGE_MARGIN_PIXELS, CHANGE_MARGIN_PIXELS), np.uint8)) > 0


def in_light_of(picture: NDArray[np.uint8], still: NDArray[np.uint8]) -> NDArray[np.float32]:
    """(H, W, 3) float32 `still` in the light of `picture`.

    For each channel log((p + dark) / (s + dark)) is a + b x + c y where nothing has moved: least squares in which a
    residual e has the weight 1 / (1 + (e / scale)^2).
    """
    height, width = picture.shape[:2]
    scale = min(1.0, LIGHT_PICTURE_PIXELS / max(height, width))
    size = max(1, round(scale * width)), max(1, round(scale * height))
    small, base = (
        cv2.resize(one, size, interpolation=cv2.INTER_AREA).astype(np.float64).reshape(-1, 3)
        for one in (picture, still)
    )
    ratio = np.log((small + LIGHT_DARK_LEVELS) / (base + LIGHT_DARK_LEVELS))
    rows, columns = np.indices(size[::-1])
    x, y = 2 * (columns.ravel() + 0.5) / size[0] - 1, 2 * (rows.ravel() + 0.5) / size[1] - 1
    terms = np.stack([np.ones_like(x), x, y], axis=1)
    found = np.zeros((3, 3))
    found[0] = np.median(ratio, axis=0)
    for _ in range(LIGHT_ROUNDS):
        weight = 1 / (1 + ((ratio - terms @ found) / LIGHT_SCALE) ** 2)
        normal = np.einsum("nc,ni,nj->cij", weight, terms, terms) + 1e-6 * np.eye(3)
        found = np.linalg.solve(normal, np.einsum("nc,ni,nc->ci", weight, terms, ratio)[..., None])[..., 0].T
    across, down = (
        np.exp((2 * (np.arange(side) + 0.5) / side - 1)[:, None] * slope).astype(np.float32)
        for side, slope in ((width, found[1]), (height, found[2]))
    )
    factor = np.exp(found[0]).astype(np.float32) * across[None] * down[:, None]
    dark = np.float32(LIGHT_DARK_LEVELS)
    return np.asarray((still + dark) * factor - dark, np.float32)
