"""The result of structure from motion, as data for `report.json` and as lines for people."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from eigenfield.calibration.motion.result import SfmResult
from eigenfield.core.errors import one_line

MOTION_REPORT_SCHEMA = "eigenfield.calibration/1"


def describe_motion(motion: SfmResult) -> dict[str, Any]:
    """JSON-able report.

    Its keys are `schema`, `registered` of `photographs`, `points`, `observations`, `reprojection` (mean and median over
    the points, pixels), `lenses` (one for each that differs) and `views`, as `ViewReport`.
    """
    errors = motion.points.errors
    lenses: dict[str, dict[str, Any]] = {}
    for view in motion.light_field.views:
        K = view.camera.K
        entry = {
            "width": view.camera.width, "height": view.camera.height, "focal": [K[0, 0], K[1, 1]],
            "principal": [K[0, 2], K[1, 2]], "model": None if view.lens is None else view.lens.model,
            "coefficients": [] if view.lens is None else list(view.lens.coefficients),
        }  # fmt: skip
        lenses.setdefault(repr(entry), {**entry, "views": 0})["views"] += 1
    return {
        "schema": MOTION_REPORT_SCHEMA,
        "photographs": len(motion.report),
        "registered": len(motion.light_field),
        "points": len(motion.points),
        "observations": len(motion.points.view),
        "reprojection": {"mean": float(errors.mean()), "median": float(np.median(errors))},
        "lenses": list(lenses.values()),
        "views": [asdict(entry) for entry in motion.report],
    }


def report_lines(report: dict[str, Any]) -> list[str]:
    """One line a camera, then the photographs without a camera and why, then the summary."""
    views = report["views"]
    found = [view for view in views if view["registered"]]
    rows = [("camera", "features", "points", "error")]
    rows += [(one_line(v["name"]), str(v["features"]), str(v["observations"]), f"{v['error']:.3f} px") for v in found]
    widths = [max(len(row[i]) for row in rows) for i in range(4)]
    lines = [
        f"{row[0]:{widths[0]}}" + "".join(f"  {cell:>{width}}" for cell, width in zip(row[1:], widths[1:], strict=True))
        for row in rows
    ]
    lost = [view for view in views if not view["registered"]]
    if lost:
        lines.append(f"without a camera: {len(lost)}")
        lines += [f"  {one_line(view['name'])}: {view['reason']}" for view in lost]
    lines += [f"lens of {lens['views']}: {_lens_line(lens)}" for lens in report["lenses"]]
    lines.append(
        f"{report['registered']} of {report['photographs']} photographs registered, {report['points']:,} points, "
        f"reprojection {report['reprojection']['mean']:.3f} px"
    )
    return lines


def _lens_line(lens: dict[str, Any]) -> str:
    fx, fy = lens["focal"]
    focal = f"focal {fx:.2f}" if fx == fy else f"focal {fx:.2f} x {fy:.2f}"
    text = f"{lens['width']}x{lens['height']}, {focal}, centre {lens['principal'][0]:.2f}, {lens['principal'][1]:.2f}"
    if lens["model"] is None:
        return text
    return f"{text}, {lens['model']} {' '.join(f'{c:.4g}' for c in lens['coefficients'])}"
