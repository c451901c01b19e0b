"""Multiplane images: layers with colour and opacity on planes before a view, fitted to photographs by descent."""

from eigenfield.stereo.multiplane.fit import MULTIPLANE_TUNING, MultiplaneTuning, fit_multiplane
from eigenfield.stereo.multiplane.image import MultiplaneImage

__all__ = ["MULTIPLANE_TUNING", "MultiplaneImage", "MultiplaneTuning", "fit_multiplane"]
