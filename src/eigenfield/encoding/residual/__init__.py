"""The residual layer, for archives: captured views as they were photographed. No other view has anything of it."""

from __future__ import annotations

from eigenfield.encoding.residual.make import RESIDUAL_DEFAULT_QUALITY, check_residual, with_residual
from eigenfield.encoding.residual.views import (
    captured_pixels,
    captured_samples,
    corrected_picture,
    difference_of,
    differences,
    with_differences,
)

__all__ = [
    "RESIDUAL_DEFAULT_QUALITY",
    "captured_pixels",
    "captured_samples",
    "check_residual",
    "corrected_picture",
    "difference_of",
    "differences",
    "with_differences",
    "with_residual",
]
