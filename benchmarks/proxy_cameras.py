"""Calibrations from photographs beside true ones, each from one `eigenfield calibrate`."""

from __future__ import annotations

import json
import tempfile
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import measure
from eigenfield.calibrate import align_similarity, calibration_error
from eigenfield.capture import open_capture


def calibrate(arguments: list[str], output: Path) -> tuple[dict[str, Any], dict[str, Any]]:
    """What the run took, and its report.json."""
    made = measure.run(["-m", "eigenfield", "calibrate", *arguments, "-o", str(output), "--quiet"])
    report = json.loads((output / "report.json").read_text(encoding="utf-8"))
    return {key: made[key] for key in ("seconds", "peak_anonymous_mb")}, report


def against_truth(folder: Path) -> dict[str, Any]:
    """Structure from motion with the true intrinsics, after a similarity fit to the true centres.

    folder: holds the true cameras, and the photographs in images/.
    """
    photographs = folder / "images"
    with tempfile.TemporaryDirectory() as place:
        output = Path(place) / "cameras"
        made, report = calibrate([str(photographs), "--intrinsics", str(folder)], output)
        field = open_capture(photographs, calibration=output / "transforms.json", strict=False)
    error = calibration_error(field, open_capture(folder))
    return {
        "photographs": report["photographs"],
        "registered": report["registered"],
        "rotation_degrees_worst": round(float(error.rotation.max()), 4),
        "position_percent_worst": round(100 * float(error.position.max()), 4),
        "reprojection_mean": round(report["reprojection"]["mean"], 3),
        **made,
    }


def chart_rig(*arguments: str) -> tuple[dict[str, Any], dict[str, Any], NDArray[np.float64]]:
    """What the calibration of a rig took, its report.json, and (n, 3) the centres of its cameras."""
    with tempfile.TemporaryDirectory() as place:
        output = Path(place) / "cameras"
        made, report = calibrate(list(arguments), output)
        frames = json.loads((output / "transforms.json").read_text(encoding="utf-8"))["frames"]
    return made, report, np.array([np.array(frame["transform_matrix"])[:3, 3] for frame in frames])


def stereo_chart(data: Path) -> dict[str, Any]:
    """OpenCV's 13 pairs of a checkerboard of 25 mm; the sample's own calibration has a baseline of 83.6 mm."""
    board = ["--chart", "checkerboard", "--board", "9x6", "--square", "25mm"]
    made, report, centres = chart_rig(str(data / "opencv_stereo_chart"), *board)
    return {
        "reprojection_rms": round(report["reprojection"]["rms"], 3),
        "baseline_mm": round(float(np.linalg.norm(centres[1] - centres[0])), 2),
        **made,
    }


def caliscope(data: Path) -> dict[str, Any]:
    """Four videos of an inverted ChArUco board, beside the cameras that caliscope found in them."""
    folder = data / "caliscope_charuco_rig4"
    made, report, ours = chart_rig(str(folder), "--chart", "charuco")
    cameras = tomllib.loads((folder / "camera_array.toml").read_text(encoding="utf-8"))["cameras"]
    theirs = np.array([_centre(camera) for camera in cameras.values()])
    scale, R, t = align_similarity(ours, theirs)
    extent = float(np.linalg.norm(theirs[:, None] - theirs, axis=2).max())
    away = np.linalg.norm(scale * ours @ R.T + t - theirs, axis=1) / extent
    return {
        "reprojection_median": round(report["reprojection"]["median"], 3),
        "position_percent_worst": round(100 * float(away.max()), 3),
        **made,
    }


def _centre(camera: dict[str, Any]) -> np.ndarray:
    return -np.array(camera["rotation"]).T @ np.array(camera["translation"])
