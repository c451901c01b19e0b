"""How good a scene is: PSNR and SSIM in UV and image space, FLIP, bytes by part, plots (docs/measures.md)."""

from eigenfield.evaluation.exclusion import Circle, read_circles
from eigenfield.evaluation.report import SCHEMA, evaluate, stored_scores
from eigenfield.evaluation.session import match_photographs, with_scene_cameras
from eigenfield.evaluation.uv import reconstructions
from eigenfield.imaging.flip import flip, flip_map
from eigenfield.imaging.metrics import PSNR_CAP, psnr, psnr_luma, ssim

__all__ = [
    "PSNR_CAP",
    "SCHEMA",
    "Circle",
    "evaluate",
    "flip",
    "flip_map",
    "match_photographs",
    "psnr",
    "psnr_luma",
    "read_circles",
    "reconstructions",
    "ssim",
    "stored_scores",
    "with_scene_cameras",
]
