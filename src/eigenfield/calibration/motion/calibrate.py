"""Cameras of photographs by structure from motion, written for eigenfield and other tools."""

from __future__ import annotations

import json
import os
from pathlib import Path

from eigenfield.calibration.known import read_known_lenses
from eigenfield.calibration.motion.report import describe_motion
from eigenfield.calibration.motion.sfm import SfmResult, structure_from_motion
from eigenfield.capture import PhotoSet, open_photographs
from eigenfield.capture.archive import is_zip
from eigenfield.capture.writers.save import refuse_folder, save_calibration
from eigenfield.core.arguments import checked
from eigenfield.core.errors import OptionError
from eigenfield.core.notebook import notebook_progress
from eigenfield.core.progress import Progress

MOTION_REPORT_FILE = "report.json"


@checked
def calibrate(
    photographs: str | os.PathLike[str] | PhotoSet,
    output: str | os.PathLike[str] | None = None,
    *,
    intrinsics: str | os.PathLike[str] | None = None,
    camera_per_photo: bool = False,
    matching: str = "auto",
    work: str | os.PathLike[str] | None = None,
    seed: int = 0,
    overwrite: bool = False,
    progress: Progress | None = notebook_progress,
) -> SfmResult:
    """Find the cameras of photographs by structure from motion, as `eigenfield calibrate` does without a chart.

    Args:
        photographs: Their folder, or what `open_photographs` returns; a calibration beside them is not read.
        output: Folder for transforms.json, a COLMAP model, points and report.json; None: nothing is written.
        intrinsics: A file of known lenses, which are kept as they are.
        camera_per_photo: Estimate each photograph's lens alone.
        matching: Which photographs are compared: "auto", "exhaustive", "similar", "grid" or "positions".
        work: Folder that keeps features and matches, so that the next run goes on from them.
        seed: Of all random choices.
        overwrite: Whether an earlier calibration in `output` is replaced.
        progress: Called in every stage; by default bars in a notebook.

    Returns:
        Cameras, points, and what became of each photograph.

    Raises:
        CaptureError: The photographs cannot be read, or no cameras explain them.
        OptionError: An option is impossible. `video-work`: a calibration would name files that do not stay.
        OutputError: The folder may not or cannot be written.
    """
    place, folder = (None if each is None else Path(each) for each in (output, work))
    if place is not None:
        refuse_folder(place, overwrite)
    if isinstance(photographs, PhotoSet):
        photos = photographs
    else:
        photos = open_photographs(photographs, strict=False, work=work)
        if place is not None:
            refuse_passing(photos, Path(photographs), folder)
    motion = structure_from_motion(
        photos,
        intrinsics=None if intrinsics is None else read_known_lenses(Path(intrinsics), photos),
        camera_per_photo=camera_per_photo,
        matching=matching,  # type: ignore[arg-type]
        work=folder,
        seed=seed,
        progress=progress,
    )
    if place is not None:
        text = json.dumps(describe_motion(motion), indent=1, allow_nan=False) + "\n"
        more = {MOTION_REPORT_FILE: text.encode()}
        save_calibration(motion.light_field, place, motion.points, overwrite=overwrite, more=more)
    return motion


def refuse_passing(photos: PhotoSet, source: Path, work: Path | None) -> None:
    """Refuse a calibration that would name files which last as long as the process.

    Args:
        photos: The photographs.
        source: The file or folder that they were opened from.
        work: Folder that keeps frames and what a zip holds.

    Raises:
        OptionError: `video-work`.
    """
    if work is None and (photos.format in ("video", "walk") or is_zip(source)):
        message = "what is taken out of a video or a zip must stay for the calibration to name it"
        raise OptionError("video-work", message, remedy="add --work DIR")
