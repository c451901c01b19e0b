"""Means, eigen textures and weights fitted to the photographs through the exact drawing, and coded in a closed loop."""

from __future__ import annotations

from eigenfield.fitting.colour import split_matrix, to_rgb
from eigenfield.fitting.fit import Coded, Pixels, PlaneSettings, Rate, code_plane, fit_plane
from eigenfield.fitting.planes import PRESETS, Fits, byte_price, fitted_textures, open_fits
from eigenfield.fitting.shots import Shots, open_shots, thinned
from eigenfield.fitting.target import Target, reach, reached

__all__ = [
    "PRESETS",
    "Coded",
    "Fits",
    "Pixels",
    "PlaneSettings",
    "Rate",
    "Shots",
    "Target",
    "byte_price",
    "code_plane",
    "fit_plane",
    "fitted_textures",
    "open_fits",
    "open_shots",
    "reach",
    "reached",
    "split_matrix",
    "thinned",
    "to_rgb",
]
