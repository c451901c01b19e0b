"""Means, eigen textures and weights fitted to the photographs through the exact drawing, and coded in a closed loop."""

from __future__ import annotations

from eigenfield.encoding.fitted.colour import split_matrix, to_rgb
from eigenfield.encoding.fitted.fit import Pixels, PlaneSettings, code_plane, coded_psnr, fit_plane
from eigenfield.encoding.fitted.observations import FitData, open_fit_data, open_subsampled
from eigenfield.encoding.fitted.planes import PLANE_PRESETS, Fits, byte_lambda, fitted_textures, open_fits
from eigenfield.encoding.fitted.rate import Rate
from eigenfield.encoding.fitted.surface import fit_surface

__all__ = [
    "PLANE_PRESETS",
    "FitData",
    "Fits",
    "Pixels",
    "PlaneSettings",
    "Rate",
    "byte_lambda",
    "code_plane",
    "coded_psnr",
    "fit_plane",
    "fit_surface",
    "fitted_textures",
    "open_fit_data",
    "open_fits",
    "open_subsampled",
    "split_matrix",
    "to_rgb",
]
