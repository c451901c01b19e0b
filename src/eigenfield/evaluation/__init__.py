"""Quality of a scene: PSNR and SSIM in UV and image space, FLIP, bytes by part, plots (docs/measures.md)."""

from eigenfield.evaluation.clip import evaluate_clip
from eigenfield.evaluation.exclusion import ExcludedCircle, read_circles
from eigenfield.evaluation.report import evaluate, stored_scores
from eigenfield.evaluation.uv import reconstruct_maps

__all__ = [
    "ExcludedCircle",
    "evaluate",
    "evaluate_clip",
    "read_circles",
    "reconstruct_maps",
    "stored_scores",
]
