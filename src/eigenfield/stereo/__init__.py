"""Depth from many photographs: plane sweep, semi-global matching and refinement over all views.

What arguments are throughout, unless a function says otherwise:

    pictures    (V, H, W, 3) uint8 photographs, or (V, H, W) uint32 of `pack_pictures`
    matrices    (V, 3, 4) of the views (`view_matrices`); matrix: (3, 4) of one
    shape       (h, w) of the reference view
    d           (h, w) labels of the reference view
    labels      (L,) ascending; low and high: the first and the last
    buffers     (V, H, W) of `depth_buffers`; None: nothing is hidden
    bias        labels behind the depth buffer at which a point still counts as visible
"""

from eigenfield.stereo.estimate import estimate_depth
from eigenfield.stereo.label_range import depth_range
from eigenfield.stereo.reference_view import ReferenceView, view_matrices
from eigenfield.stereo.visibility import depth_buffers, mean_texture

__all__ = ["ReferenceView", "depth_buffers", "depth_range", "estimate_depth", "mean_texture", "view_matrices"]
