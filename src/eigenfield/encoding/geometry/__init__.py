"""A proxy in few bytes: simplified and rounded by rate and distortion in the photographs."""

from eigenfield.encoding.geometry.distortion import DistortionMap, depth_distortion, spread_cameras, texels_of
from eigenfield.encoding.geometry.simplify import simplify_proxy_rd
from eigenfield.encoding.geometry.simplify_relief import CodedRelief, simplify_relief_rd
from eigenfield.encoding.geometry.triangle_count import triangle_count_rd

__all__ = [
    "CodedRelief",
    "DistortionMap",
    "depth_distortion",
    "simplify_proxy_rd",
    "simplify_relief_rd",
    "spread_cameras",
    "texels_of",
    "triangle_count_rd",
]
