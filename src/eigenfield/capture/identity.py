"""What a result that was made from a capture depends on."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield.capture.photographs.decoded import PhotographSource, size_on_disk
from eigenfield.capture.photoset import Capture
from eigenfield.runtime.parallel import parallel_map
from eigenfield.runtime.stages import file_digest

KEPT_DIGESTS = 1 << 18  # of files, 0.3 kB each


def capture_identity(capture: Capture, of_file: Callable[[Path], Any] = file_digest) -> list[Any]:
    """Everything that a result depends on: every file, cameras, lenses, layout.

    Args:
        of_file: What stands for a file. Default: a digest of its bytes.
    """
    if capture.light_field is None:
        layout = {} if capture.layout is None else vars(capture.layout)
        arrangement: list[Any] = [v.tolist() if isinstance(v, np.ndarray) else v for _, v in sorted(layout.items())]
        arrangement += [[shot.focal, shot.width, shot.height] for shot in capture.shots]
    else:
        arrangement = [
            [view.camera.K.tolist(), view.camera.R.tolist(), view.camera.t.tolist(), str(view.lens)]
            for view in capture.views
        ] + ([capture.origin.tolist()] if capture.origin.any() else [])

    def digest(source: PhotographSource) -> list[Any]:
        mask = None if source.mask is None else of_file(source.mask)
        which = [] if source.picture is None else source.picture.identity()
        return [source.name, of_file(source.path), mask, source.upright, source.exposure, *which]

    return [parallel_map(digest, capture.sources), arrangement]


def content_digest(path: Path) -> str:
    """The SHA-256 of a file's bytes, which this process reads once while size and time of the file stay. CaptureError
    `image-missing`."""
    return _content_digest(path, size_on_disk(path), path.stat().st_mtime_ns)


@lru_cache(maxsize=KEPT_DIGESTS)
def _content_digest(path: Path, size: int, changed: int) -> str:
    return file_digest(path)
