"""Calibration of a multi-camera rig from pictures of a board: intrinsics of each camera, then the rig as a whole.

World: the axes of the rig's first camera in natural order of names, in the unit of the board's square.
"""

from __future__ import annotations

import contextlib
import logging
import math
import os
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.charts.board import Board
from eigenfield.calibration.charts.bundle import BoardObservation, RigEstimate
from eigenfield.calibration.charts.detection import BoardDetections, detect_boards
from eigenfield.calibration.charts.intrinsics import INTRINSICS_MIN_BOARDS, IntrinsicsEstimate, estimate_intrinsics
from eigenfield.calibration.charts.lens_models import LENS_INTRINSICS, brown_lens, camera_matrix
from eigenfield.calibration.charts.pictures import ChartCamera, ChartPictures, find_charts
from eigenfield.calibration.charts.rig import RigSolution, solve_rig
from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.photographs.lens import Lens
from eigenfield.core.brief import brief_repr
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError
from eigenfield.core.progress import Progress
from eigenfield.imaging.graph import components
from eigenfield.runtime.parallel import tracked_map

log = logging.getLogger("eigenfield.calibration")

CHART_REPORT_SCHEMA = "eigenfield.calibration.charts/1"
CHART_WARN_RMS_PIXELS = 2.0  # a rig that fits worse gets a warning
CHART_WARN_FOCAL_DEVIATION = 0.02  # relative standard deviation of a focal length that gets a warning
CHART_WARN_OUTLIER_FRACTION = 0.5  # of a camera's observations


@dataclass(frozen=True, eq=False)
class CameraReport:
    """How well one camera is calibrated.

    Attributes:
        name: The camera's name.
        size: (width, height) of its pictures.
        camera: As in `View`; None if the camera was left out.
        lens: As in `View`; None without distortion.
        pictures: Pictures that were searched.
        boards: Boards found in them.
        corners: Corners found in them.
        used: Boards that the rig was fitted to.
        shared: Those of them that another camera saw at the same moment.
        inverted: The board was seen white on black; None if it was not seen.
        mirrored: Boards seen from behind.
        rms: Root mean square reprojection error of the boards in use, pixels; NaN if left out.
        median: Median reprojection error, pixels; NaN if left out.
        model: The free intrinsics, such as "fx fy cx cy k1 k2".
        focal_deviation: Standard deviation of fx, pixels.
        reason: Why the camera was left out.
    """

    name: str
    size: tuple[int, int]
    camera: Camera | None
    lens: Lens | None
    pictures: int
    boards: int
    corners: int
    used: int
    shared: int
    inverted: bool | None
    mirrored: int
    rms: float
    median: float
    model: str
    focal_deviation: float
    reason: str | None = None

    __repr__ = brief_repr


@dataclass(frozen=True, eq=False)
class ChartCalibration:
    """A rig calibrated from charts.

    Attributes:
        root: The folder of the charts.
        board: What was detected.
        unit: Of the world, "" if unknown.
        reports: One for each camera of the charts.
        rms: Root mean square reprojection error over all corners in use, pixels.
        median: Median reprojection error, pixels.
        problems: One line each, for people.
    """

    root: Path
    board: Board
    unit: str
    reports: tuple[CameraReport, ...]
    rms: float
    median: float
    problems: tuple[str, ...]

    __repr__ = brief_repr

    def light_field(self, folder: str | os.PathLike[str]) -> LightField:
        """The cameras as views of photographs to come, one a camera.

        Each view is named after its camera. Its `path` is that name in `folder`, without an extension, so that a
        photograph of any kind is found for it later.
        """
        root = Path(folder)
        views = tuple(
            View(report.name, root / report.name, report.camera, report.lens)
            for report in self.reports
            if report.camera is not None
        )
        return LightField(root, views, self.problems, "charts")

    def describe(self) -> dict[str, Any]:
        """JSON-able report.

        Its keys are `schema`, `board`, `unit`, `reprojection` (rms and median, pixels), `problems`, and `cameras`: the
        fields of `CameraReport` without camera and lens. Numbers of cameras that were left out are null.
        """
        return {
            "schema": CHART_REPORT_SCHEMA,
            "board": asdict(self.board),
            "unit": self.unit,
            "reprojection": {"rms": self.rms, "median": self.median},
            "problems": list(self.problems),
            "cameras": [_describe_camera(report) for report in self.reports],
        }


def _describe_camera(report: CameraReport) -> dict[str, Any]:
    entry = {name: value for name, value in vars(report).items() if name not in ("camera", "lens")}
    entry["size"] = list(report.size)
    return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in entry.items()}


def calibrate_charts(
    folder: str | os.PathLike[str], board: Board, *, progress: Progress | None = None
) -> ChartCalibration:
    """Calibrate the rig whose chart pictures or videos lie in a folder.

    `docs/calibration.md` describes how files are named. Cameras that cannot be connected to the others are left out and
    listed in `problems`.

    Raises:
        CaptureError: `capture-missing`, `charts-empty`, `charts-one-camera`, `board-unseen`, `board-size`, or
            `rig-apart`: no two cameras can be connected.
    """
    with _one_opencv_thread():
        return _calibrate(Path(folder), board, progress)


@contextlib.contextmanager
def _one_opencv_thread() -> Iterator[None]:
    """Let OpenCV use one thread.

    `cv2.calibrateCamera` sums in the order in which its threads finish, which changes the last digits from run to run.
    Pictures are processed on our own threads.
    """
    count = cv2.getNumThreads()
    cv2.setNumThreads(0)  # serial; 1 would wait for ever in a forked child
    try:
        yield
    finally:
        cv2.setNumThreads(count)


def _calibrate(folder: Path, board: Board, progress: Progress | None) -> ChartCalibration:
    charts = find_charts(folder)
    if len(charts.cameras) < 2:
        only = charts.cameras[0]
        raise CaptureError(
            "charts-one-camera",
            f"all of its {len(only.moments)} pictures are of one camera ({only.name})"
            + (f", others cannot be read ({charts.problems[0]})" if charts.problems else ""),
            path=charts.root,
            remedy="name pictures CAMERA + number (left01.jpg, right01.jpg), or give each camera a folder or a video",
        )
    detections = detect_boards(charts, board, progress)
    estimates = _estimate_all_intrinsics(board.points, charts.cameras, detections.observations, progress)
    solution = _solve(charts, board, detections, estimates)
    rig, joined = (None, ()) if solution is None else _rebase_to_first(solution)
    if solution is None or rig is None or len(joined) < 2:
        raise _disconnected_error(charts, detections, estimates)
    solved = _SolvedRig(board.points, charts, detections, estimates, solution, rig, joined)
    reports = tuple(_report_camera(solved, c) for c in range(len(charts.cameras)))
    residuals = _reprojection_distances(solved, [s for s in solution.inliers if s.camera in joined])
    rms, median = float(np.sqrt(np.mean(residuals**2))), float(np.median(residuals))
    problems = (*charts.problems, *detections.problems, *_warnings(reports, solution, rms))
    for problem in problems:
        log.info("%s", problem)
    return ChartCalibration(charts.root, board, board.unit, reports, rms, median, problems)


@dataclass(frozen=True, eq=False)
class _SolvedRig:
    """Everything that is known once the rig is solved."""

    points: NDArray[np.float64]
    charts: ChartPictures
    detections: BoardDetections
    estimates: list[IntrinsicsEstimate | None]
    solution: RigSolution
    rig: RigEstimate
    joined: tuple[int, ...]


def _solve(
    charts: ChartPictures, board: Board, detections: BoardDetections, estimates: Sequence[IntrinsicsEstimate | None]
) -> RigSolution | None:
    """The rig from the observations that are inliers of their own camera; None if only one camera has any."""
    usable: list[BoardObservation] = []
    for c, estimate in enumerate(estimates):
        mine = [s for s in detections.observations if s.camera == c]
        usable += [mine[k] for k in (estimate.inliers if estimate else ())]
    if len({s.camera for s in usable}) < 2:
        return None
    intrinsics = np.array([s.intrinsics if s else np.full(LENS_INTRINSICS, np.nan) for s in estimates])
    bases = [s.model.basis if s else np.zeros((LENS_INTRINSICS, 0)) for s in estimates]
    sizes = [camera.size for camera in charts.cameras]
    return solve_rig(board.points, board.symmetries(), usable, intrinsics, bases, sizes, len(charts.moments))


def _estimate_all_intrinsics(
    points: NDArray[np.float64],
    cameras: Sequence[ChartCamera],
    observations: Sequence[BoardObservation],
    progress: Progress | None,
) -> list[IntrinsicsEstimate | None]:
    def estimate(c: int) -> IntrinsicsEstimate | None:
        return estimate_intrinsics(points, [s.corners for s in observations if s.camera == c], cameras[c].size)

    return tracked_map(estimate, range(len(cameras)), "lenses", progress)


def _rebase_to_first(solution: RigSolution) -> tuple[RigEstimate, tuple[int, ...]]:
    """The rig in the axes of its first camera, and the cameras that the inliers still connect."""
    rig = solution.rig
    first: dict[int, int] = {}
    links = [(s.camera, first.setdefault(s.moment, s.camera)) for s in solution.inliers]
    group = components(len(rig.R), *np.array(links, np.int64).reshape(-1, 2).T)
    groups = [tuple(c for c in solution.joined if group[c] == g) for g in set(group[list(solution.joined)].tolist())]
    joined = max(groups, key=lambda g: (len(g), -g[0]))
    base = joined[0]
    R, t = rig.R[base], rig.t[base]
    return RigEstimate(
        rig.intrinsics, rig.R @ R.T, rig.t - rig.R @ R.T @ t, R @ rig.board_rotation, rig.board_shift @ R.T + t
    ), joined  # fmt: skip


def _reprojection_distances(solved: _SolvedRig, observations: Sequence[BoardObservation]) -> NDArray[np.float64]:
    residuals = [solved.rig.residuals(solved.points, s) for s in observations]
    return np.linalg.norm(np.concatenate(residuals), axis=1) if residuals else np.array([np.nan])


def _report_camera(solved: _SolvedRig, index: int) -> CameraReport:
    chart_camera, estimate = solved.charts.cameras[index], solved.estimates[index]
    variant = solved.detections.variants[index]
    seen = [s for s in solved.detections.observations if s.camera == index]
    known = index in solved.joined
    used = [s for s in solved.solution.inliers if s.camera == index] if known else []
    others = {s.moment for s in solved.solution.inliers if s.camera != index}
    away = _reprojection_distances(solved, used)
    row, R, t = solved.rig.intrinsics[index], solved.rig.R[index], solved.rig.t[index]
    return CameraReport(
        name=chart_camera.name,
        size=chart_camera.size,
        camera=Camera.from_matrices(camera_matrix(row), R, t, *chart_camera.size, chart_camera.name) if known else None,
        lens=brown_lens(row) if known else None,
        pictures=len(chart_camera.moments),
        boards=len(seen),
        corners=sum(len(s.corners.ids) for s in seen),
        used=len(used),
        shared=sum(s.moment in others for s in used),
        inverted=None if variant is None else variant.inverted,
        mirrored=sum(s.corners.mirrored for s in seen),
        rms=float(np.sqrt(np.mean(away**2))),
        median=float(np.median(away)),
        model=str(estimate.model) if estimate else "",
        focal_deviation=float(solved.solution.focal_deviations[index]) if known else float("nan"),
        reason=None if known else _reason_left_out(solved, index, len(seen)),
    )


def _reason_left_out(solved: _SolvedRig, index: int, boards: int) -> str:
    """Why a camera is not in the rig."""
    pictures = len(solved.charts.cameras[index].moments)
    if not boards:
        return f"it sees no board in its {pictures} pictures"
    if solved.estimates[index] is None and boards < INTRINSICS_MIN_BOARDS:
        return f"it sees the board in {boards} of its {pictures} pictures, {INTRINSICS_MIN_BOARDS} are needed"
    if solved.estimates[index] is None:
        return f"no lens fits its {boards} boards"
    if index not in solved.solution.joined:
        return "it never sees the board at the same moment as the others"
    return f"its {boards} boards agree with no other camera's: did it move?"


def _disconnected_error(
    charts: ChartPictures, detections: BoardDetections, estimates: Sequence[IntrinsicsEstimate | None]
) -> CaptureError:
    counts = Counter(s.camera for s in detections.observations)
    counted = []
    for c, (camera, estimate) in enumerate(zip(charts.cameras, estimates, strict=True)):
        boards = "board" if counts[c] == 1 else "boards"
        counted.append(f"{camera.name}: {counts[c]} {boards}{'' if estimate else ', too few or too alike for a lens'}")
    return CaptureError(
        "rig-apart",
        f"no two cameras can be joined ({'; '.join(counted)})",
        path=charts.root,
        remedy="show the board to two cameras at a time, in pictures with the same number (frame i of every video)",
    )


def _warnings(reports: Sequence[CameraReport], solution: RigSolution, rms: float) -> list[str]:
    """What a person should know about the result."""
    lines = [f"camera {report.name} is left out: {report.reason}" for report in reports if report.reason]
    for index, report in enumerate(reports):
        if report.camera is None:
            continue
        out = sum(s.camera == index for s in solution.outliers)
        if out > CHART_WARN_OUTLIER_FRACTION * (out + report.used):
            lines.append(
                f"camera {report.name}: {out} of {out + report.used} boards disagree with the rest of the rig and were "
                "not used: did it move, or do its moments differ from the others'?"
            )
        focal = report.camera.K[0, 0]
        vague = report.focal_deviation / focal
        if vague > CHART_WARN_FOCAL_DEVIATION:
            lines.append(
                f"camera {report.name}: its focal length is only known to {100 * vague:.0f} %: "
                "take more pictures of the board, near, tilted and in the corners"
            )
    if rms > CHART_WARN_RMS_PIXELS:
        lines.append(
            f"corners are {rms:.1f} px (rms) from where they should be: are the squares' size, the pairs of pictures "
            "and the board's flatness right?"
        )
    return lines
