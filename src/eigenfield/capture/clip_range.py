"""Which frames of footage are meant, and by how many a camera is late, as people write it."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from eigenfield.core.camera_names import named_camera
from eigenfield.core.errors import OptionError, one_line

CLIP_MOMENT = r"(?:(\d{1,9})|(\d{1,9}(?:\.\d*)?|\.\d+)s)?"  # a frame, or seconds
CLIP_PATTERN = re.compile(rf"{CLIP_MOMENT}:{CLIP_MOMENT}(?::(\d{{1,9}}))?")
OFFSET_PATTERN = re.compile(r"(.+)=([+-]?\d{1,9})", re.DOTALL)


@dataclass(frozen=True)
class ClipRange:
    """Frames from `first` up to, and without, `last`.

    Attributes:
        first: A frame (int) or seconds (float); None: from where all cameras have frames.
        last: None: as long as all cameras have frames.
        step: Every so many of them, at least 1.
    """

    first: int | float | None = None
    last: int | float | None = None
    step: int = 1

    def frames(self, rate: Fraction) -> tuple[int | None, int | None]:
        """First and last in frames of a clock."""
        first, last = (round(v * rate) if isinstance(v, float) else v for v in (self.first, self.last))
        return first, last


def parse_clip(text: str) -> ClipRange:
    """A:B[:STEP] in frames or seconds (1.5s), any of them left out; OptionError `clip-unknown`."""
    match = CLIP_PATTERN.fullmatch(text.strip() or ":")
    if match is None or match[5] == "0":
        raise OptionError(
            "clip-unknown",
            f"--clip {one_line(text[:40])} is no range of frames",
            remedy="say FIRST:END or FIRST:END:STEP in frames (30:90) or seconds (1s:2.5s)",
        )
    first, last = (
        int(frame) if frame else float(time) if time else None for frame, time in (match.group(1, 2), match.group(3, 4))
    )
    return ClipRange(first, last, int(match[5] or 1))


def parse_offsets(texts: Sequence[str]) -> dict[str, int]:
    """Frames by camera of texts such as cam_2=-3; OptionError `offset-unknown`."""
    offsets: dict[str, int] = {}
    for text in texts:
        match = OFFSET_PATTERN.fullmatch(text.strip())
        if match is None or match[1] in offsets:
            why = "is no NAME=FRAMES" if match is None else "names a camera for the second time"
            message = f"--offset {one_line(text[:80])} {why}"
            raise OptionError("offset-unknown", message, remedy="say it once a camera, as cam_2=-3")
        offsets[match[1]] = int(match[2])
    return offsets


def offsets_by_camera(offsets: Mapping[str, int], names: Sequence[str]) -> list[int]:
    """The offset of each camera, 0 where none is given. OptionError `offset-unknown` for a name that no camera has."""
    by_camera = [0] * len(names)
    for name, frames in offsets.items():
        by_camera[named_camera(name, names, "offset-unknown")] = frames
    return by_camera
