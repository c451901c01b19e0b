"""A film whose pictures are quilts: of a scene along a path, or of a clip over time."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.clip import Clip
from eigenfield.core.progress import Progress, track
from eigenfield.imaging.colour import as_rgb
from eigenfield.rendering import RenderJob, path_points
from eigenfield.rendering.parallel_cameras import ParallelCameras
from eigenfield.rendering.video import write_video
from eigenfield.runtime.files import refuse_existing
from eigenfield.viewer.exports.quilt import Quilt, draw_quilt, quilt_cameras, quilt_file, quilt_of, quilt_views


def write_quilt_film(
    frames: Iterable[tuple[RenderJob, tuple[float, float]]],
    count: int,
    quilt: Quilt,
    output: Path,
    fps: Fraction,
    *,
    sound: tuple[bytes, float] | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Draw and write a film whose pictures are quilts; returns the file's path, which has the suffix.

    Tiles of odd sides lose a column or row, since films have even ones. The plane of the display is that of the first
    picture throughout.

    Args:
        frames: What each picture is drawn of, and the viewpoint around which its views stand.
        count: Of the frames.
        sound: As of `write_video`.

    Raises:
        OptionError: `array-side`, `quilt-name`; as `Renderer.draw`.
        OutputError: The file cannot be written.
    """
    even = replace(quilt, width=quilt.width & ~1, height=quilt.height & ~1, display=quilt.aspect)
    path = quilt_file(output, even)
    refuse_existing(path, overwrite)
    cameras: list[ParallelCameras] = []

    def draw(job: RenderJob, at: tuple[float, float]) -> NDArray[np.uint8]:
        if not cameras:
            cameras.append(quilt_cameras(job.scene, even))
        return as_rgb(draw_quilt(job, even, quilt_views(job, even, at, cameras[0])))

    pictures = track((draw(job, at) for job, at in frames), "quilts", count, progress)
    write_video(path, pictures, fps, sound=sound, overwrite=overwrite)
    return path


def write_quilt_clip(
    clip: Clip,
    output: Path,
    *,
    quilt: tuple[int, int] | str | None = None,
    spread: float = 1.0,
    path: str | None = None,
    fps: Fraction | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
    **picture: Any,
) -> tuple[Path, str]:
    """Write a clip over time as a film of quilts; where, and what was written.

    Args:
        quilt: As `grid` of `quilt_of`.
        path: A path along which the views move meanwhile; None: they stand around the array's middle.
        fps: Pictures a second; None: the clip's own, and its sound is kept.
        picture: Fields of `RenderJob`.

    Raises:
        OptionError, OutputError: As `write_quilt_film`.
    """
    timeline = clip.timeline
    points = [(0.0, 0.0)] * timeline.frames
    if path is not None:
        points = [(float(x), float(y)) for x, y in path_points(path, timeline.frames)]
    rate, sound = timeline.rate if fps is None else Fraction(fps), None
    if clip.audio is not None and rate == timeline.rate:
        sound = clip.audio.data, timeline.first - clip.audio.first
    shape = quilt_of(clip.scene(timeline.first), quilt, picture.get("resolution"), spread)
    jobs = (RenderJob(clip.scene(float(time)), **picture) for time in timeline.times)
    frames = zip(jobs, points, strict=True)
    how: dict[str, Any] = {"sound": sound, "overwrite": overwrite, "progress": progress}
    made = write_quilt_film(frames, timeline.frames, shape, output, rate, **how)
    return made, f"{timeline.frames} quilts of {shape.columns * shape.rows} views"
