"""Calibration of a multi-camera rig from pictures of a board: intrinsics of each camera, then the rig as a whole.

World: the axes of the first camera of the rig in the natural order of names, in the unit of the board's square.
"""

from __future__ import annotations

import contextlib
import logging
import math
import os
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.charts.board import Board
from eigenfield.calibrate.charts.bundle import Rig, Sighting
from eigenfield.calibrate.charts.detection import Detection, detect
from eigenfield.calibrate.charts.intrinsics import FEWEST, Start, start_intrinsics
from eigenfield.calibrate.charts.lens_models import COUNT, lens, matrix
from eigenfield.calibrate.charts.pictures import ChartCamera, Charts, find_charts
from eigenfield.calibrate.charts.rig import Solution, solve_rig
from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.photographs.lens import Lens
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError
from eigenfield.core.progress import Progress
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.calibrate")

SCHEMA = "eigenfield.calibrate.charts/1"
BAD_RMS = 2.0  # pixels: a rig that fits worse than that deserves a word
VAGUE_FOCAL = 0.02  # standard deviation of a focal length, as a part of it, that deserves a word
MOVED = 0.5  # of a camera's sightings that disagree with the rig


@dataclass(frozen=True, eq=False)
class CameraReport:
    """How well one camera is known.

    camera, lens: as View has them; None where the camera was left out, and `reason` says why.
    pictures: looked at; boards, corners: found in them; used: boards that the rig was fitted to; shared: those of them
        that another camera saw at the same moment.
    inverted: the board was seen white on black; mirrored: boards seen from behind; None and 0 where none was seen.
    rms, median: pixels from the corners of the boards in use to where they should be; NaN where left out.
    model: the intrinsics that were free, "fx fy cx cy k1 k2"; focal_deviation: standard deviation of fx, pixels.
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


@dataclass(frozen=True, eq=False)
class ChartCalibration:
    """A rig calibrated from charts.

    root: the folder of the charts. unit: of the world, "" where nobody said. board: what was looked for.
    reports: one for each camera of the charts. rms, median: pixels over all corners in use.
    problems: one line each, for people.
    """

    root: Path
    board: Board
    unit: str
    reports: tuple[CameraReport, ...]
    rms: float
    median: float
    problems: tuple[str, ...]

    def light_field(self, folder: str | os.PathLike[str]) -> LightField:
        """The cameras as views of photographs to come, one a camera: each is named after its camera and its `path` is
        that name in `folder`, without an extension, so that a photograph of any kind is found for it later."""
        root = Path(folder)
        views = tuple(
            View(report.name, root / report.name, report.camera, report.lens)
            for report in self.reports
            if report.camera is not None
        )
        return LightField(root, views, self.problems, "charts")

    def describe(self) -> dict[str, Any]:
        """JSON-able: `schema`, `board`, `unit`, `reprojection` (rms and median, pixels), `problems`, and `cameras`, as
        `CameraReport` but for cameras and lenses; null for figures of cameras that were left out."""
        return {
            "schema": SCHEMA,
            "board": asdict(self.board),
            "unit": self.unit,
            "reprojection": {"rms": self.rms, "median": self.median},
            "problems": list(self.problems),
            "cameras": [_described(report) for report in self.reports],
        }


def _described(report: CameraReport) -> dict[str, Any]:
    entry = {
        field.name: getattr(report, field.name) for field in fields(report) if field.name not in ("camera", "lens")
    }
    entry["size"] = list(report.size)
    return {k: None if isinstance(v, float) and not math.isfinite(v) else v for k, v in entry.items()}


def calibrate_charts(
    folder: str | os.PathLike[str], board: Board, *, progress: Progress | None = None
) -> ChartCalibration:
    """Calibrate the rig whose chart pictures or videos lie in `folder`; `docs/calibration.md` says how they are named.

    Cameras that cannot be joined to the others are left out, and named in `problems`. Raises CaptureError:
    `capture-missing`, `charts-empty`, `charts-one-camera`, `board-unseen`, `board-size`, `rig-apart` (no two cameras
    can be joined).
    """
    with _one_opencv_thread():
        return _calibrate(Path(folder), board, progress)


@contextlib.contextmanager
def _one_opencv_thread() -> Iterator[None]:
    """`cv2.calibrateCamera` sums in the order in which its threads finish, so that the last digits would differ from
    run to run; and pictures are looked at on our own threads."""
    count = cv2.getNumThreads()
    cv2.setNumThreads(1)
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
    found = detect(charts, board, progress)
    starts = _starts(board.points, charts.cameras, found.sightings, progress)
    solution = _solved(charts, board, found, starts)
    rig, joined = (None, ()) if solution is None else _based(solution)
    if solution is None or rig is None or len(joined) < 2:
        raise _apart(charts, found, starts)
    evidence = _Evidence(board.points, charts, found, starts, solution, rig, joined)
    reports = tuple(_report(evidence, c) for c in range(len(charts.cameras)))
    residuals = _distances(evidence, [s for s in solution.kept if s.camera in joined])
    rms, median = float(np.sqrt(np.mean(residuals**2))), float(np.median(residuals))
    problems = (*charts.problems, *found.problems, *_remarks(reports, solution, rms))
    for problem in problems:
        log.info("%s", problem)
    return ChartCalibration(charts.root, board, board.unit, reports, rms, median, problems)


@dataclass(frozen=True, eq=False)
class _Evidence:
    """All that is known once the rig is solved."""

    points: NDArray[np.float64]
    charts: Charts
    found: Detection
    starts: list[Start | None]
    solution: Solution
    rig: Rig
    joined: tuple[int, ...]


def _solved(charts: Charts, board: Board, found: Detection, starts: Sequence[Start | None]) -> Solution | None:
    """The rig from the sightings that are no outliers of their own camera; None where only one camera has any."""
    usable: list[Sighting] = []
    for c, start in enumerate(starts):
        mine = [s for s in found.sightings if s.camera == c]
        usable += [mine[k] for k in (start.kept if start else ())]
    if len({s.camera for s in usable}) < 2:
        return None
    intrinsics = np.array([s.intrinsics if s else np.full(COUNT, np.nan) for s in starts])
    bases = [s.freedom.basis if s else np.zeros((COUNT, 0)) for s in starts]
    sizes = [camera.size for camera in charts.cameras]
    return solve_rig(board.points, board.symmetries(), usable, intrinsics, bases, sizes, len(charts.moments))


def _starts(
    points: NDArray[np.float64],
    cameras: Sequence[ChartCamera],
    sightings: Sequence[Sighting],
    progress: Progress | None,
) -> list[Start | None]:
    if progress is not None:
        progress("lenses", 0, len(cameras))
    starts = parallel_map(
        lambda c: start_intrinsics(points, [s.corners for s in sightings if s.camera == c], cameras[c].size),
        range(len(cameras)),
    )
    if progress is not None:
        progress("lenses", len(cameras), len(cameras))
    return starts


def _based(solution: Solution) -> tuple[Rig, tuple[int, ...]]:
    """The rig in the axes of its first camera, and the cameras that the sightings in use still hold together."""
    parent = {c: c for c in solution.joined}

    def root(camera: int) -> int:
        while parent[camera] != camera:
            camera = parent[camera]
        return camera

    first: dict[int, int] = {}
    for sighting in solution.kept:
        parent[root(sighting.camera)] = root(first.setdefault(sighting.moment, sighting.camera))
    groups = [tuple(c for c in solution.joined if root(c) == r) for r in sorted({root(c) for c in solution.joined})]
    joined = max(groups, key=lambda g: (len(g), -g[0]))
    rig, base = solution.rig, joined[0]
    R, t = rig.R[base], rig.t[base]
    return Rig(
        rig.intrinsics, rig.R @ R.T, rig.t - rig.R @ R.T @ t, R @ rig.board_rotation, rig.board_shift @ R.T + t
    ), joined  # fmt: skip


def _distances(evidence: _Evidence, sightings: Sequence[Sighting]) -> NDArray[np.float64]:
    residuals = [evidence.rig.residuals(evidence.points, s) for s in sightings]
    return np.linalg.norm(np.concatenate(residuals), axis=1) if residuals else np.array([np.nan])


def _report(evidence: _Evidence, index: int) -> CameraReport:
    chart_camera, start, look = evidence.charts.cameras[index], evidence.starts[index], evidence.found.looks[index]
    seen = [s for s in evidence.found.sightings if s.camera == index]
    known = index in evidence.joined
    used = [s for s in evidence.solution.kept if s.camera == index] if known else []
    others = {s.moment for s in evidence.solution.kept if s.camera != index}
    away = _distances(evidence, used)
    row, R, t = evidence.rig.intrinsics[index], evidence.rig.R[index], evidence.rig.t[index]
    return CameraReport(
        name=chart_camera.name,
        size=chart_camera.size,
        camera=Camera.checked(matrix(row), R, t, *chart_camera.size, chart_camera.name) if known else None,
        lens=lens(row) if known else None,
        pictures=len(chart_camera.moments),
        boards=len(seen),
        corners=sum(len(s.corners.ids) for s in seen),
        used=len(used),
        shared=sum(s.moment in others for s in used),
        inverted=None if look is None else look.inverted,
        mirrored=sum(s.corners.mirrored for s in seen),
        rms=float(np.sqrt(np.mean(away**2))),
        median=float(np.median(away)),
        model=str(start.freedom) if start else "",
        focal_deviation=float(evidence.solution.focal_deviations[index]) if known else float("nan"),
        reason=None if known else _reason(evidence, index, len(seen)),
    )


def _reason(evidence: _Evidence, index: int, boards: int) -> str:
    """Why a camera is not in the rig."""
    pictures = len(evidence.charts.cameras[index].moments)
    if not boards:
        return f"it sees no board in its {pictures} pictures"
    if evidence.starts[index] is None and boards < FEWEST:
        return f"it sees the board in {boards} of its {pictures} pictures, {FEWEST} are needed"
    if evidence.starts[index] is None:
        return f"no lens fits its {boards} boards"
    if index not in evidence.solution.joined:
        return "it never sees the board at the same moment as the others"
    return f"its {boards} boards agree with no other camera's: did it move?"


def _apart(charts: Charts, found: Detection, starts: Sequence[Start | None]) -> CaptureError:
    counts = Counter(s.camera for s in found.sightings)
    said = []
    for c, (camera, start) in enumerate(zip(charts.cameras, starts, strict=True)):
        boards = "board" if counts[c] == 1 else "boards"
        said.append(f"{camera.name}: {counts[c]} {boards}" + ("" if start else ", too few or too alike for a lens"))
    return CaptureError(
        "rig-apart",
        f"no two cameras can be joined ({'; '.join(said)})",
        path=charts.root,
        remedy="show the board to two cameras at a time, in pictures with the same number (frame i of every video)",
    )


def _remarks(reports: Sequence[CameraReport], solution: Solution, rms: float) -> list[str]:
    """What a person should know of the result."""
    lines = [f"camera {report.name} is left out: {report.reason}" for report in reports if report.reason]
    for index, report in enumerate(reports):
        if report.camera is None:
            continue
        out = sum(s.camera == index for s in solution.dropped)
        if out > MOVED * (out + report.used):
            lines.append(
                f"camera {report.name}: {out} of {out + report.used} boards disagree with the rest of the rig and were "
                "not used: did it move, or do its moments differ from the others'?"
            )
        focal = report.camera.K[0, 0]
        vague = report.focal_deviation / focal
        if vague > VAGUE_FOCAL:
            lines.append(
                f"camera {report.name}: its focal length is only known to {100 * vague:.0f} %: "
                "take more pictures of the board, near, tilted and in the corners"
            )
    if rms > BAD_RMS:
        lines.append(
            f"corners are {rms:.1f} px (rms) from where they should be: are the squares' size, the pairs of pictures "
            "and the board's flatness right?"
        )
    return lines
