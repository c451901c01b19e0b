"""Depth from many photographs: plane sweep, semi-global matching and refinement over all views."""

from eigenfield.stereo.estimate import estimate_depth
from eigenfield.stereo.label_range import depth_range
from eigenfield.stereo.reference_view import ReferenceView, view_matrices
from eigenfield.stereo.visibility import depth_buffers, mean_texture

__all__ = ["ReferenceView", "depth_buffers", "depth_range", "estimate_depth", "mean_texture", "view_matrices"]
