"""Depth from many photographs: plane sweep, semi-global optimisation, refinement over all views."""

from eigenfield.stereo.canvas import Canvas, view_matrices
from eigenfield.stereo.consistency import consistent
from eigenfield.stereo.detail import detail_pictures
from eigenfield.stereo.estimate import Depth, estimate_depth
from eigenfield.stereo.label_range import depth_range
from eigenfield.stereo.refine import refine_depth
from eigenfield.stereo.semiglobal import semi_global
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.sweep import sweep
from eigenfield.stereo.views import halve, halved_matrices, pack
from eigenfield.stereo.visibility import depth_buffers, mean_texture

__all__ = [
    "Canvas",
    "Depth",
    "consistent",
    "depth_buffers",
    "depth_range",
    "detail_pictures",
    "estimate_depth",
    "halve",
    "halved_matrices",
    "mean_texture",
    "pack",
    "refine_depth",
    "semi_global",
    "smooth_depth",
    "sweep",
    "view_matrices",
]
