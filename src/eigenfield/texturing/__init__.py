"""Photographs to texture maps: texel positions, visibility, resampling, gutters (the paper's section 3.2)."""

from eigenfield.texturing.atlas import (
    SIDE_CAP,
    SIDE_LIMIT,
    SIDE_STEP,
    Atlas,
    atlas_side,
    check_density,
    make_atlas,
    texels_per_pixel,
)
from eigenfield.texturing.harmonise import MODELS as COLOUR_MODELS
from eigenfield.texturing.harmonise import check_model, fit_colours, harmonise_maps, harmonised
from eigenfield.texturing.pictures import png_bytes, write_maps
from eigenfield.texturing.project import FILTERS, TextureMaps, texture_map, texture_maps
from eigenfield.texturing.spread import Spreader, make_spreader, push_pull

__all__ = [
    "COLOUR_MODELS",
    "FILTERS",
    "SIDE_CAP",
    "SIDE_LIMIT",
    "SIDE_STEP",
    "Atlas",
    "Spreader",
    "TextureMaps",
    "atlas_side",
    "check_density",
    "check_model",
    "fit_colours",
    "harmonise_maps",
    "harmonised",
    "make_atlas",
    "make_spreader",
    "png_bytes",
    "push_pull",
    "texels_per_pixel",
    "texture_map",
    "texture_maps",
    "write_maps",
]
