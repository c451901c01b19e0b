"""Means, eigen textures and weights fitted to the photographs through the exact drawing, and coded in a closed loop."""

from __future__ import annotations

from eigenfield.encoding.fitted.colour import split_matrix, to_rgb
from eigenfield.encoding.fitted.fit import Pixels, PlaneSettings, code_plane, coded_psnr, fit_plane
from eigenfield.encoding.fitted.observations import Shots, open_shots, thinned
from eigenfield.encoding.fitted.planes import (
    KINDS,
    PRESETS,
    Fits,
    Preset,
    byte_price,
    density_of,
    fitted_textures,
    open_fits,
)
from eigenfield.encoding.fitted.rate import Rate
from eigenfield.encoding.fitted.surface import fit_surface
from eigenfield.encoding.target import Target, compared, reach, warn_of_miss

__all__ = [
    "KINDS",
    "PRESETS",
    "Fits",
    "Pixels",
    "PlaneSettings",
    "Preset",
    "Rate",
    "Shots",
    "Target",
    "byte_price",
    "code_plane",
    "coded_psnr",
    "compared",
    "density_of",
    "fit_plane",
    "fit_surface",
    "fitted_textures",
    "open_fits",
    "open_shots",
    "reach",
    "split_matrix",
    "thinned",
    "to_rgb",
    "warn_of_miss",
]
