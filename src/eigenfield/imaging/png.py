"""Pictures as PNG."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.metrics import to_codes


def png_bytes(picture: NDArray[np.float32] | NDArray[np.uint8]) -> bytes:
    """An (H, W), (H, W, 1) or (H, W, 3) picture, float 0..1 or uint8, as 8-bit PNG."""
    codes = to_codes(picture)
    ok, data = cv2.imencode(".png", codes[..., ::-1] if codes.ndim == 3 and codes.shape[2] == 3 else codes)
    assert ok
    return data.tobytes()
