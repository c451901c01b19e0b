"""Cameras from photographs: structure from motion, calibration boards, and planar arrays."""

from __future__ import annotations

from eigenfield.calibration.align import align_similarity, calibration_error
from eigenfield.calibration.known import read_known_lenses
from eigenfield.calibration.lenses import KnownLens
from eigenfield.calibration.motion.result import SfmResult
from eigenfield.calibration.motion.sfm import structure_from_motion
from eigenfield.calibration.motion.triangulate import triangulate_points
from eigenfield.calibration.neighbours import NeighbourPair, measure_neighbours
from eigenfield.calibration.planar.joint import PlanarArray, refine_planar
from eigenfield.calibration.planar.register import register_views
from eigenfield.calibration.planar.start import PlanarStart, start_given, start_planar
from eigenfield.calibration.whole import calibrate

__all__ = [
    "KnownLens",
    "NeighbourPair",
    "PlanarArray",
    "PlanarStart",
    "SfmResult",
    "align_similarity",
    "calibrate",
    "calibration_error",
    "measure_neighbours",
    "read_known_lenses",
    "refine_planar",
    "register_views",
    "start_given",
    "start_planar",
    "structure_from_motion",
    "triangulate_points",
]
