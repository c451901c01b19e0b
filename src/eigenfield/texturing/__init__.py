"""Photographs to texture maps: texel positions, visibility, resampling, gutters (the paper's section 3.2)."""

from eigenfield.texturing.atlas import SIDE_CAP, SIDE_LIMIT, SIDE_STEP, Atlas, atlas_side, make_atlas, texels_per_pixel
from eigenfield.texturing.pictures import png_bytes, write_maps
from eigenfield.texturing.project import FILTERS, TextureMaps, texture_map, texture_maps
from eigenfield.texturing.spread import Spreader, make_spreader, push_pull

__all__ = [
    "FILTERS",
    "SIDE_CAP",
    "SIDE_LIMIT",
    "SIDE_STEP",
    "Atlas",
    "Spreader",
    "TextureMaps",
    "atlas_side",
    "make_atlas",
    "make_spreader",
    "png_bytes",
    "push_pull",
    "texels_per_pixel",
    "texture_map",
    "texture_maps",
    "write_maps",
]
