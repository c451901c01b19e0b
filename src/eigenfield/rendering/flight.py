"""A flight through the array as files: a film, or numbered pictures."""

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
    """Draw (n, 2) viewpoints into `output`: an .mp4 of `fps` pictures a second, or a .png each where its name has a
    %04d. All of it appears at the end, or nothing.

    Raises OutputError, and OptionError as `Renderer.draw` does.
    """
    if not is_numbered(output):
        write_video(output, job.film_along(points, progress), fps, overwrite=overwrite)
        return
    with atomic_files(numbered_files(output, len(points)), overwrite=overwrite) as places:
        for place, data in zip(places, job.pngs_along(points, progress), strict=True):
            place.write_bytes(data)


def refuse_flight(output: Path, count: int, overwrite: bool) -> None:
    """Before any work: raise OutputError where one of the files may not or cannot be written."""
    for path in numbered_files(output, count) if is_numbered(output) else [output]:
        refuse_existing(path, overwrite)
