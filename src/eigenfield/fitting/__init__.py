"""Means, eigen textures and weights fitted to the photographs through the exact drawing, and coded in a closed loop."""

from __future__ import annotations

from eigenfield.fitting.fit import Fitted, PlaneSettings, fit_plane
from eigenfield.fitting.planes import FIT_QUALITY, fit_planes, fitted_textures
from eigenfield.fitting.shots import Shots, open_shots

__all__ = [
    "FIT_QUALITY",
    "Fitted",
    "PlaneSettings",
    "Shots",
    "fit_plane",
    "fit_planes",
    "fitted_textures",
    "open_shots",
]
