"""The options with which a capture is opened: each stands here once, for Python and for the command line."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from eigenfield.core.errors import OptionError
from eigenfield.core.fields import Options, document_options, option

RATE_MAX = 1000  # frames a second


@document_options
@dataclass(frozen=True, kw_only=True)
class OpenOptions(Options):
    """How a capture is opened. Every option may be left out.

    An option that would change nothing raises OptionError when the capture is opened.
    """

    renamed: ClassVar = {"frames": "walk_frames"}

    calibration: str | os.PathLike[str] | None = option(
        "Cameras that lie elsewhere: transforms.json, a COLMAP model, Metashape's .xml ...", metavar="PATH"
    )
    masks: str | os.PathLike[str] | None = option(
        "Masks with the photographs' names: white is used, black is not.", metavar="FOLDER"
    )
    format: str | None = option(
        "Read the capture as this format, where several fit: "
        "transforms, colmap, llff, middlebury, strecha, bundler, nvm, metashape, opencv, "
        "realitycapture, deepview, projections, positions, hci, stanford, grid, numbered, quilt, "
        "eslf, array, video, walk or folder.",
        metavar="NAME",
    )
    grid: tuple[int, int] | None = option(
        "Numbered photographs: R rows of C columns; of a lenslet picture or an array: the middle R x C views.",
        metavar="RxC",
    )
    quilt: tuple[int, int] | None = option(
        "One picture is a quilt of C columns and R rows of views, where its name does not say it.", metavar="CxR"
    )
    pattern: str | None = option(
        "Where names have row and column: view_{row}_{col}.png; * is any text.", metavar="NAME"
    )
    frame: int | str | None = option("Frame to take of each video: a number from 0, or seconds (2.5s).", metavar="T")
    walk_frames: int | None = option(
        "Frames to take of the video of a walk.  [default: by how far the camera goes]", metavar="N"
    )
    clip: str | None = option(
        "Read footage: frames FIRST:END[:STEP] of videos or of folders of pictures, in frames (30:90) or seconds "
        "(1s:2.5s); alone, all that the cameras have in common.",
        metavar="A:B[:STEP]",
        bare=":",
    )
    offset: Sequence[str] = option(
        "Footage: the camera NAME films so many FRAMES before the others begin; once for each camera.",
        (),
        metavar="NAME=FRAMES",
    )
    rate: float | None = option("Footage: frames a second; for pictures, which do not state it.", metavar="FPS")
    also: Sequence[str | os.PathLike[str]] | None = option(
        "Further folders with photographs of the same capture, which has no calibration then.", offered=False
    )
    strict: bool = option(
        "Raise the first error. If False, leave out what is wrong and name it in `problems`.", True, offered=False
    )
    work: str | os.PathLike[str] | None = option(
        "A folder that keeps the frames of videos as PNG, and what a zip holds, so that they are unpacked once. None: "
        "they last as long as the process.",
        offered=False,
    )

    def __post_init__(self) -> None:
        self.check_types()
        if self.grid is not None and min(self.grid) < 1:
            raise OptionError("grid-unknown", f"{self.grid} is no grid", remedy="say rows and columns, both at least 1")
        if self.rate is not None and not 0 < self.rate <= RATE_MAX:
            raise OptionError("rate-unknown", f"--rate {self.rate:g} is none", remedy=f"say up to {RATE_MAX}")
        object.__setattr__(self, "offset", tuple(self.offset))
        if self.quilt is not None and min(self.quilt) < 1:
            remedy = "say columns and rows, both at least 1"
            raise OptionError("quilt", f"{self.quilt} is no quilt", remedy=remedy)
        for name in ("grid", "quilt"):
            pair = getattr(self, name)
            object.__setattr__(self, name, None if pair is None else (int(pair[0]), int(pair[1])))
