"""Cameras from photographs: structure from motion, calibration boards, and planar arrays."""

from __future__ import annotations

from eigenfield.calibrate.align import align_similarity, calibration_error
from eigenfield.calibrate.known import read_known_lenses
from eigenfield.calibrate.lenses import KnownLens
from eigenfield.calibrate.motion.sfm import SfmResult, structure_from_motion
from eigenfield.calibrate.motion.triangulate import triangulate_points
from eigenfield.calibrate.planar.joint import PlanarArray, refine_planar, register_views
from eigenfield.calibrate.planar.start import PlanarStart, start_given, start_planar

__all__ = [
    "KnownLens",
    "PlanarArray",
    "PlanarStart",
    "SfmResult",
    "align_similarity",
    "calibration_error",
    "read_known_lenses",
    "refine_planar",
    "register_views",
    "start_given",
    "start_planar",
    "structure_from_motion",
    "triangulate_points",
]
