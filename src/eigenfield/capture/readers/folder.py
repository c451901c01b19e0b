"""A plain folder of photographs: nothing is known of how the cameras stood."""

from __future__ import annotations

import math
from pathlib import Path

from eigenfield.capture.arrangement import FEWEST_NAMED, Arrangement, Wanted, photographs_of, refuse_nothing
from eigenfield.capture.readers.grid_names import alike
from eigenfield.capture.readers.video import find_videos

SMALLEST_SQUARE = 5


def find_photographs(folder: Path) -> Path | None:
    """The folder, if it or its `images/` holds photographs; a few beside videos (a poster, a chart) do not count."""
    found = photographs_of(folder)
    return folder if len(found) >= FEWEST_NAMED or (found and not find_videos(folder)) else None


def read_photographs(folder: Path, wanted: Wanted) -> Arrangement:
    """All photographs of a folder. Raises CaptureError `names-unknown` where there is none."""
    files = photographs_of(folder)
    refuse_nothing(files, folder, "like one (.png, .jpg, .webp, .tif, .avif)")
    return Arrangement("folder", tuple(files), problems=tuple(_perhaps_a_grid(folder)))


def _perhaps_a_grid(folder: Path) -> list[str]:
    """A line where photographs are numbered without a gap and fill a square: structure from motion fails on a rectified
    grid, and nothing else would tell that it is one."""
    files, others, fields = alike(folder)
    varying = [i for i in range(1, len(fields[0]), 2) if len({int(f[i]) for f in fields}) > 1]
    side = math.isqrt(len(files))
    if others or len(varying) != 1 or side < SMALLEST_SQUARE or side * side != len(files):
        return []
    numbers = {int(f[varying[0]]) for f in fields}
    if len(numbers) < len(files) or max(numbers) - min(numbers) + 1 != len(files):
        return []
    return [f"numbered from {min(numbers)} to {max(numbers)}: if they are a grid, say --grid {side}x{side}"]
