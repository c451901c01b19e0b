"""A proxy in as few bytes as its pictures are worth: simplified and rounded by what the photographs lose."""

from eigenfield.encoding.geometry.distortion import Effect, depth_effect, spread_cameras, texels_of
from eigenfield.encoding.geometry.simplify import slim_mesh
from eigenfield.encoding.geometry.simplify_relief import Form, slim_relief
from eigenfield.encoding.geometry.triangle_count import triangles_worth

__all__ = [
    "Effect",
    "Form",
    "depth_effect",
    "slim_mesh",
    "slim_relief",
    "spread_cameras",
    "texels_of",
    "triangles_worth",
]
