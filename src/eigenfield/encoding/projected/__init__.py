"""The paper's way: photographs projected into texture maps (its section 3.2), their mean and eigen textures (3.3)."""

from __future__ import annotations

from eigenfield.encoding.projected.agreement import disagreement_of, warn_of_disagreement
from eigenfield.encoding.projected.align import ALIGN_METHODS, align_map, align_maps
from eigenfield.encoding.projected.atlas import (
    ATLAS_SIDE_CAP_TEXELS,
    ATLAS_SIDE_STEP_TEXELS,
    Atlas,
    atlas_side,
    make_atlas,
    texels_per_pixel,
)
from eigenfield.encoding.projected.eigen import (
    Spectrum,
    component_count,
    eigen_textures,
    gram_matrix,
    spectrum,
    weights_of,
)
from eigenfield.encoding.projected.harmonise import fit_colours, harmonise_maps, harmonised_map
from eigenfield.encoding.projected.mean import Mean, filled_map, mean_map
from eigenfield.encoding.projected.project import RESAMPLING_FILTERS, TextureMaps, texture_map, texture_maps
from eigenfield.encoding.projected.spread import Spreader, make_spreader, push_pull
from eigenfield.encoding.projected.uv_measure import measure_map, smallest_count
from eigenfield.encoding.projected.write_maps import write_maps

__all__ = [
    "ALIGN_METHODS",
    "ATLAS_SIDE_CAP_TEXELS",
    "ATLAS_SIDE_STEP_TEXELS",
    "RESAMPLING_FILTERS",
    "Atlas",
    "Mean",
    "Spectrum",
    "Spreader",
    "TextureMaps",
    "align_map",
    "align_maps",
    "atlas_side",
    "component_count",
    "disagreement_of",
    "eigen_textures",
    "filled_map",
    "fit_colours",
    "gram_matrix",
    "harmonise_maps",
    "harmonised_map",
    "make_atlas",
    "make_spreader",
    "mean_map",
    "measure_map",
    "push_pull",
    "smallest_count",
    "spectrum",
    "texels_per_pixel",
    "texture_map",
    "texture_maps",
    "warn_of_disagreement",
    "weights_of",
    "write_maps",
]
