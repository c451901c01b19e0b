"""Clips: whether a file is one, and which frame is that of a time. Nothing here needs Blender."""

import json
import struct
from typing import NamedTuple

from .program import Job, RefusalError

MAGIC, GROUPS_CHUNK = b"glTF", b"EFTL"


class Timeline(NamedTuple):
    """Frames a second, and how many there are. Times are seconds from the first frame on: Blender's numbers of single
    precision cannot tell the frames of a clip that counts from 1970."""

    rate: float
    frames: int

    def frame_at(self, time):
        """The number of the frame that is nearest to a time."""
        return min(max(round(time * self.rate), 0), self.frames - 1)

    def time_of(self, frame):
        return frame / self.rate


def is_clip(path):
    """Whether a .glb has a chunk of groups. Of a damaged file too, which the program refuses in its own words."""
    with path.open("rb") as file:
        if file.read(12)[:4] != MAGIC:
            return False
        while len(head := file.read(8)) == 8:
            length, kind = struct.unpack("<I4s", head)
            if kind == GROUPS_CHUNK:
                return True
            file.seek(length, 1)
    return False


def timeline_steps(path, found):
    """Have the program say when a clip's frames are shown; yields how far it is, and returns the Timeline."""
    job = yield from Job(found, "info", path, "--json").steps()
    try:
        clip = json.loads("\n".join(job.output))["clip"]
        (over, under), frames = clip["rate"], int(clip["frames"])
    except (ValueError, KeyError, TypeError):
        raise RefusalError(f"{found} does not say what {path} is: it is another version, or another program") from None
    return Timeline(over / under, frames)
