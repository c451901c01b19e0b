"""Pictures as PNG."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.metrics import to_codes


def png_bytes(picture: NDArray[np.float32] | NDArray[np.uint8]) -> bytes:
    """An (H, W), (H, W, 1), (H, W, 3) or, with alpha, (H, W, 4) picture, float 0..1 or uint8, as 8-bit PNG."""
    codes = to_codes(picture)
    turned = {3: [2, 1, 0], 4: [2, 1, 0, 3]}.get(codes.shape[2] if codes.ndim == 3 else 1)
    ok, data = cv2.imencode(".png", codes if turned is None else codes[..., turned])
    assert ok
    return data.tobytes()
