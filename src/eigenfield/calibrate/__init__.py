"""Cameras from photographs: structure from motion, charts, and planar arrays."""

from __future__ import annotations

from eigenfield.calibrate.align import CalibrationError, align_similarity, calibration_error
from eigenfield.calibrate.known import read_known_lenses
from eigenfield.calibrate.lenses import KnownLens
from eigenfield.calibrate.motion.sfm import Motion, ViewReport, structure_from_motion
from eigenfield.calibrate.motion.triangulate import triangulated_points
from eigenfield.calibrate.planar.joint import Planar, refine_planar, register_views
from eigenfield.calibrate.planar.start import PlanarStart, start_given, start_planar

__all__ = [
    "CalibrationError",
    "KnownLens",
    "Motion",
    "Planar",
    "PlanarStart",
    "ViewReport",
    "align_similarity",
    "calibration_error",
    "read_known_lenses",
    "refine_planar",
    "register_views",
    "start_given",
    "start_planar",
    "structure_from_motion",
    "triangulated_points",
]
