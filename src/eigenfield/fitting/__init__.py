"""Means, eigen textures and weights fitted to the photographs through the exact drawing, and coded in a closed loop."""

from __future__ import annotations

from eigenfield.fitting.colour import split_matrix, to_rgb
from eigenfield.fitting.fit import Pixels, PlaneSettings, code_plane, coded_psnr, fit_plane
from eigenfield.fitting.planes import (
    KINDS,
    PRESETS,
    Fits,
    Preset,
    byte_price,
    density_of,
    fitted_textures,
    open_fits,
)
from eigenfield.fitting.rate import Rate
from eigenfield.fitting.shots import Shots, open_shots, thinned
from eigenfield.fitting.surface import fit_surface
from eigenfield.fitting.target import Target, compared, reach, warn_of_miss

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
