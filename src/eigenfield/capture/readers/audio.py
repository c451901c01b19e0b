"""Sound for a clip: Opus in Ogg, which is kept as it is."""

from __future__ import annotations

import os
from pathlib import Path

from eigenfield.coding import limits
from eigenfield.coding.opus import is_opus
from eigenfield.core.errors import CaptureError


def read_opus(path: str | os.PathLike[str]) -> bytes:
    """The bytes of an Ogg file of Opus.

    Raises:
        CaptureError: `audio-unreadable`; `audio-unknown`, it is another kind of file; `audio-size`.
    """
    path = Path(path)
    try:
        size = path.stat().st_size
        if size > limits.MAX_AUDIO:
            remedy = "cut it to the clip, or encode it at a lower rate"
            message = f"{size} bytes of sound, {limits.MAX_AUDIO} are allowed"
            raise CaptureError("audio-size", message, path=path, remedy=remedy)
        data = path.read_bytes()
    except OSError as error:
        message = f"cannot be read: {error.strerror or error}"
        raise CaptureError("audio-unreadable", message, path=path, remedy="check the name") from error
    if not is_opus(data):
        remedy = "make it by: ffmpeg -i FILE -c:a libopus sound.opus"
        raise CaptureError("audio-unknown", "is no Ogg file of Opus", path=path, remedy=remedy)
    return data
