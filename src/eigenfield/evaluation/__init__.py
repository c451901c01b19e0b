"""Quality of a scene: PSNR and SSIM in UV and image space, FLIP, bytes by part, plots (docs/measures.md)."""

from eigenfield.evaluation.exclusion import ExcludedCircle, read_circles
from eigenfield.evaluation.report import EVALUATION_SCHEMA, evaluate, stored_scores
from eigenfield.evaluation.session import match_photographs, with_scene_cameras
from eigenfield.evaluation.uv import reconstruct_maps
from eigenfield.imaging.flip import flip, flip_map
from eigenfield.imaging.metrics import PSNR_MAX_DECIBELS, psnr, psnr_luma, ssim

__all__ = [
    "EVALUATION_SCHEMA",
    "PSNR_MAX_DECIBELS",
    "ExcludedCircle",
    "evaluate",
    "flip",
    "flip_map",
    "match_photographs",
    "psnr",
    "psnr_luma",
    "read_circles",
    "reconstruct_maps",
    "ssim",
    "stored_scores",
    "with_scene_cameras",
]
