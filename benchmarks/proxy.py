"""How good the cameras and the geometry are that photographs alone give.

    EIGENFIELD_DATA=captures python benchmarks/proxy.py [CASE ...]

Depth maps, surfaces and calibrations stand beside true ones; a whole capture is one `eigenfield encode --fit none` from
a folder of photographs to a scene, and what that is worth. Results go to benchmarks/results/proxy-NAME.json.
"""

from __future__ import annotations

import argparse
import functools
import json
import os
import tempfile
import time
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

import measure
from eigenfield.calibration import align_similarity, calibration_error, triangulate_points
from eigenfield.capture import open_capture
from eigenfield.capture.holdout import held_out_cameras
from eigenfield.capture.photographs.read import decode
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import read_mesh, surface_from_views
from eigenfield.proxy.background import fill_background
from eigenfield.stereo import depth_range, estimate_depth

BORDER = 15  # pixels that the HCI benchmark leaves out on every side
WIDE = (-12.0, 12.0)  # labels of the coarse sweep: pixels a step of the array


@dataclass(frozen=True)
class Case:
    """One capture. options: of `encode`; circles: file for `evaluate --exclude-circles`; uncoded: measure the lossless
    file too, which says what the geometry allows."""

    folder: str
    options: tuple[str, ...]
    circles: str | None = None
    uncoded: bool = False


WAY = ("--fit", "none")  # what a mesh is worth: pictures are drawn through it as they were projected onto it
SCENES = {
    "tarot": Case("tarot_17x17_512", ("--hold-out", "odd", "--density", "1"), "ball.json", uncoded=True),
    "tarot-blind": Case("tarot_17x17_512", ("--hold-out", "odd", "--density", "1", "--blind"), "ball.json"),
    "tarot-all": Case("tarot_17x17_512", (), "ball.json"),
    "tarot-5x4": Case("tarot_5x4_1024", ("--hold-out", "every:5", "--textures", "7")),
    "amethyst": Case("amethyst_17x17_512", ("--hold-out", "odd")),
    "jellybeans": Case("jellybeans_17x17_768x384", ("--hold-out", "odd")),
    "shop": Case("shop_9x9", ("--hold-out", "odd")),
    "boxes": Case("hci_boxes_9x9", ("--hold-out", "odd")),
    "antinous": Case("hci_antinous_9x9", ("--hold-out", "odd")),
    "fern": Case("llff_fern", ("--hold-out", "every:5", "--textures", "7", "--blind")),
    "cube": Case("cube_colmap_mesh", ("--hold-out", "every:4", "--textures", "5", "--blind")),
    "fountain": Case("fountain_P11_half", ("--hold-out", "every:4", "--textures", "5", "--blind")),
    "fox": Case("fox_transforms_half", ("--hold-out", "every:8", "--blind")),
    "temple": Case("temple_ring16", ("--hold-out", "every:5", "--textures", "7", "--blind")),
}


def hci_antinous(data: Path) -> dict[str, Any]:
    """Disparity of the centre view against the truth: BadPix in per cent, MSE times 100, as the benchmark counts."""
    folder = data / "hci_antinous_9x9"
    truth = np.asarray(cv2.imread(str(folder / "gt_disp_lowres.pfm"), cv2.IMREAD_UNCHANGED))
    pictures, matrices = _hci_views(folder)
    started, work = time.perf_counter(), time.process_time()
    span = depth_range(pictures, matrices, truth.shape, WIDE)
    if span is None:
        raise SystemExit("no depth range was found")
    depth = estimate_depth(pictures, matrices, truth.shape, span)
    error = np.abs(depth - truth)[BORDER:-BORDER, BORDER:-BORDER]
    return {
        "range": [round(value, 2) for value in span],
        "bad_pixels_0.07": round(100 * float((error > 0.07).mean()), 2),
        "bad_pixels_0.1": round(100 * float((error > 0.1).mean()), 2),
        "bad_pixels_0.03": round(100 * float((error > 0.03).mean()), 2),
        "mse_x100": round(100 * float((error.astype(np.float64) ** 2).mean()), 2),
        "median_error": round(float(np.median(error)), 4),
        "seconds": round(time.perf_counter() - started, 1),
        "cpu_seconds": round(time.process_time() - work, 1),
    }


def _hci_views(folder: Path) -> tuple[NDArray[np.uint8], NDArray[np.float64]]:
    """Photographs and matrices of an HCI array: a step to the right or down moves a point by -d pixels."""
    side = 9
    paths = [next(folder.glob(f"input_Cam{index:03d}.*")) for index in range(side * side)]
    pictures = np.stack([np.rint(decode(path)[0] * 255).astype(np.uint8) for path in paths])
    rows, columns = np.divmod(np.arange(side * side), side)
    matrices = np.zeros((side * side, 3, 4))
    matrices[:, 0, 0] = matrices[:, 1, 1] = matrices[:, 2, 3] = 1
    matrices[:, 0, 2], matrices[:, 1, 2] = side // 2 - columns, side // 2 - rows
    return pictures, matrices


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


def surface_cube(data: Path) -> dict[str, Any]:
    """The surface of the cube beside COLMAP's mesh, in all photographs' cameras at half their size.

    Fractions of the pixels that COLMAP's mesh shows: those that our surface covers without its background, and those
    in which the whole surface's depth differs by less than 1 and 2 %, or by more than a tenth.
    """
    capture = open_capture(data / "cube_colmap_mesh")
    theirs = read_mesh(data / "cube_colmap_mesh" / "proxy.obj")
    cameras = [camera.resize(camera.width // 2, camera.height // 2) for camera in capture.cameras]
    true = [rasterise_view(theirs, camera).inverse_depth for camera in cameras]
    result: dict[str, Any] = {}
    for name, rule in (("all", None), ("every_4", "every:4")):
        held = held_out_cameras(rule, capture.names, np.zeros((len(cameras), 2)))
        field = capture.subset(np.flatnonzero(~held).tolist())
        started, work = time.perf_counter(), _cpu_seconds()
        mesh = surface_from_views(field, triangulate_points(field), background=False).mesh
        taken = time.perf_counter() - started, _cpu_seconds() - work
        whole = fill_background(mesh, field.cameras)
        parts = [_beside(mesh, whole, camera, depth) for camera, depth in zip(cameras, true, strict=True)]
        result[name] = {key: round(float(np.mean([part[key] for part in parts])), 4) for key in parts[0]}
        result[name] |= {"seconds": round(taken[0], 1), "cpu_seconds": round(taken[1], 1)}
    return result


def _beside(mesh: Mesh, whole: Mesh, camera: Camera, true: NDArray[np.float32]) -> dict[str, float]:
    shown = true > 0
    drawn = rasterise_view(whole, camera).inverse_depth[shown]
    off = np.abs(true[shown] / np.maximum(drawn, 1e-12) - 1)
    return {
        "covered": float((rasterise_view(mesh, camera).face[shown] >= 0).mean()),
        "within_1_percent": float((off < 0.01).mean()),
        "within_2_percent": float((off < 0.02).mean()),
        "off_by_a_tenth": float(((drawn > 0) & (off > 0.1)).mean()),
    }


def _cpu_seconds() -> float:
    used = os.times()
    return used.user + used.system + used.children_user + used.children_system


def _centre(camera: dict[str, Any]) -> np.ndarray:
    return -np.array(camera["rotation"]).T @ np.array(camera["translation"])


def scene(data: Path, case: Case) -> dict[str, Any]:
    """`eigenfield encode FOLDER --fit none` and `eigenfield evaluate`: seconds, memory, coverage, quality."""
    folder = data / case.folder
    with tempfile.TemporaryDirectory() as place:
        output = Path(place) / "scene.glb"
        encode = ["-m", "eigenfield", "encode", str(folder), "-o", str(output), *WAY, *case.options]
        made = measure.run(encode)
        figures = {
            "capture": case.folder,
            "encode": f"eigenfield encode {' '.join((case.folder, *WAY, *case.options))}",
            "seconds": made["seconds"],
            "peak_anonymous_mb": made["peak_anonymous_mb"],
            "bytes": output.stat().st_size,
            "summary": made["output"].strip().replace(str(output), "scene.glb"),
            **_measured(output, folder, case.circles),
        }
        if case.uncoded:
            measure.run([*encode, "--codec", "png", "--overwrite"])
            figures["uncoded"] = _measured(output, folder, case.circles)
    return figures


def _measured(output: Path, folder: Path, circles: str | None) -> dict[str, Any]:
    """The means over encoded and over held-out cameras."""
    evaluate = ["-m", "eigenfield", "evaluate", str(output), str(folder), "--json"]
    if circles is not None:
        evaluate += ["--exclude-circles", str(folder / circles)]
    image = json.loads(measure.run(evaluate)["output"])["image"]
    result: dict[str, Any] = {}
    for part in ("encoded", "held_out"):
        values = image[part]
        if values is None:
            continue
        result[part] = {key: values[key] for key in ("cameras", "psnr", "ssim", "psnr_full", "coverage")}
        if "outside" in values:
            result[part]["psnr_outside"] = values["outside"]["psnr"]
    return result


CASES: dict[str, Callable[[Path], dict[str, Any]]] = {
    "hci-antinous": hci_antinous,
    "cameras-fountain": lambda data: against_truth(data / "fountain_P11_half"),
    "cameras-temple": lambda data: against_truth(data / "temple_ring16"),
    "cameras-stereo-chart": stereo_chart,
    "cameras-caliscope": caliscope,
    "surface-cube": surface_cube,
    **{f"scene-{name}": functools.partial(scene, case=case) for name, case in SCENES.items()},
}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", help=f"of {', '.join(CASES)}; default: all")
    cases = parser.parse_args().cases or list(CASES)
    if unknown := set(cases) - set(CASES):
        parser.error(f"no such case: {', '.join(sorted(unknown))}")
    folder = measure.data()
    for name in cases:
        figures = {"case": name, **CASES[name](folder)}
        print(json.dumps(figures, indent=1), flush=True)
        measure.store(f"proxy-{name}", figures)


if __name__ == "__main__":
    main()
