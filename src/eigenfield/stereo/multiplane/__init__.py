"""Layers with colour and opacity, fitted to photographs by descent: on planes, and on a few height fields."""

from eigenfield.stereo.multiplane.fit import (
    MULTIPLANE_TUNING,
    SHEET_TUNING,
    MultiplaneTuning,
    SheetTuning,
    fit_multiplane,
    fit_sheets,
)
from eigenfield.stereo.multiplane.image import MultiplaneImage
from eigenfield.stereo.multiplane.sheets import SoftSheets

__all__ = [
    "MULTIPLANE_TUNING",
    "SHEET_TUNING",
    "MultiplaneImage",
    "MultiplaneTuning",
    "SheetTuning",
    "SoftSheets",
    "fit_multiplane",
    "fit_sheets",
]
