"""A flight through the array as files: a video, or numbered pictures."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.progress import Progress
from eigenfield.rendering.render_jobs import RenderJob
from eigenfield.rendering.video import write_video
from eigenfield.runtime.files import atomic_files, is_numbered, numbered_files, refuse_existing


def write_flight(
    job: RenderJob,
    points: NDArray[np.float64],
    output: Path,
    fps: Fraction,
    *,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Draw viewpoints into a video, or into a .png each. All files appear at the end, or none.

    Args:
        job: What is drawn, and how.
        points: (n, 2) viewpoints.
        output: An .mp4, or a .png whose name has a %04d.
        fps: Pictures a second of the video.
        overwrite: Whether existing files are replaced.
        progress: Reports each picture.

    Raises:
        OptionError: As `Renderer.draw`.
        OutputError: A file cannot be written.
    """
    if not is_numbered(output):
        write_video(output, job.video_along(points, progress), fps, overwrite=overwrite)
        return
    with atomic_files(numbered_files(output, len(points)), overwrite=overwrite) as places:
        for place, data in zip(places, job.pngs_along(points, progress), strict=True):
            place.write_bytes(data)


def refuse_flight(output: Path, count: int, overwrite: bool) -> None:
    """Before any work: check that all files may be written.

    Args:
        output: As of `write_flight`.
        count: Number of pictures.
        overwrite: Whether existing files may be replaced.

    Raises:
        OutputError: One of the files may not or cannot be written.
    """
    for path in numbered_files(output, count) if is_numbered(output) else [output]:
        refuse_existing(path, overwrite)
