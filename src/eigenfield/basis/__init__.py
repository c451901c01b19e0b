"""Texture maps to a mean and eigen textures with weights (the paper's section 3.3)."""

from eigenfield.basis.agreement import disagreement_of, warn_of_disagreement
from eigenfield.basis.align import METHODS, align_map, align_maps
from eigenfield.basis.eigen import Spectrum, component_count, eigen_textures, gram_matrix, spectrum, weights_of
from eigenfield.basis.mean import Mean, filled, mean_map
from eigenfield.basis.uv import measure_map, smallest_count

__all__ = [
    "METHODS",
    "Mean",
    "Spectrum",
    "align_map",
    "align_maps",
    "component_count",
    "disagreement_of",
    "eigen_textures",
    "filled",
    "gram_matrix",
    "mean_map",
    "measure_map",
    "smallest_count",
    "spectrum",
    "warn_of_disagreement",
    "weights_of",
]
