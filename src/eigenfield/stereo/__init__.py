"""Depth from many photographs: plane sweep, semi-global matching and refinement over all views."""

from eigenfield.stereo.consistency import count_consistent_views
from eigenfield.stereo.detail import detail_pictures
from eigenfield.stereo.estimate import DepthMap, estimate_depth
from eigenfield.stereo.label_range import depth_range
from eigenfield.stereo.reference_view import ReferenceView, view_matrices
from eigenfield.stereo.refine import refine_depth
from eigenfield.stereo.semiglobal import semi_global_matching
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.sweep import plane_sweep
from eigenfield.stereo.views import halve_pictures, halved_matrices, pack_pictures
from eigenfield.stereo.visibility import depth_buffers, mean_texture

__all__ = [
    "DepthMap",
    "ReferenceView",
    "count_consistent_views",
    "depth_buffers",
    "depth_range",
    "detail_pictures",
    "estimate_depth",
    "halve_pictures",
    "halved_matrices",
    "mean_texture",
    "pack_pictures",
    "plane_sweep",
    "refine_depth",
    "semi_global_matching",
    "smooth_depth",
    "view_matrices",
]
