"""A plain folder of photographs: nothing is known of how the cameras stood."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

from eigenfield.capture.arrangement import (
    NAMES_MIN_PHOTOGRAPHS,
    Arrangement,
    photographs_of,
    require_photographs,
)
from eigenfield.capture.locate import is_photograph_file
from eigenfield.capture.messages import list_names
from eigenfield.capture.readers.grid_names import largest_name_group
from eigenfield.capture.readers.video import find_videos
from eigenfield.core.errors import CaptureError, OptionError
from eigenfield.core.open_options import OpenOptions
from eigenfield.core.shell import shell_word

FOLDER_WORDS = "like one (.png, .jpg, .webp, .tif, .avif)"
FOLDER_MIN_SQUARE_SIDE_PHOTOGRAPHS = 5


def find_photographs(folder: Path) -> Path | None:
    """The folder, if it or its `images/` holds photographs; a few beside videos (a poster, a chart) do not count."""
    found = photographs_of(folder)
    return folder if len(found) >= NAMES_MIN_PHOTOGRAPHS or (found and not find_videos(folder)) else None


def read_photographs(folder: Path, options: OpenOptions) -> Arrangement:
    """All photographs of a folder. Raises CaptureError `names-unknown` where there is none."""
    files = photographs_of(folder)
    require_photographs(files, folder, FOLDER_WORDS)
    return Arrangement("folder", tuple(files), problems=tuple(_suggest_grid(folder)))


def read_folders(folders: Sequence[Path]) -> Arrangement:
    """All photographs of several folders, which are one capture.

    Raises CaptureError: `capture-missing`, `names-unknown` where one holds none; OptionError `folders-twice`.
    """
    files: list[Path] = []
    for folder in folders:
        if not folder.is_dir():
            message = "is no folder of photographs" if folder.exists() else "does not exist"
            raise CaptureError("capture-missing", message, path=folder, remedy="name folders of photographs")
        found = photographs_of(folder)
        require_photographs(found, folder, FOLDER_WORDS)
        files += found
    if len({path.resolve() for path in files}) < len(files):
        raise OptionError("folders-twice", "a folder is named twice", remedy="name each once")
    return Arrangement("folder", tuple(files))


def refuse_photograph_files(paths: Sequence[Path]) -> None:
    """Raise CaptureError `capture-missing` where photographs are named one by one, as `photos/*.jpg` does."""
    files = [path for path in paths if is_photograph_file(path)]
    if files:
        folders = [shell_word(folder) for folder in dict.fromkeys(path.parent for path in files)]
        remedy = f"name their {'folder' if len(folders) == 1 else 'folders'}: {list_names(folders)}"
        raise CaptureError("capture-missing", "is one photograph, and no folder of them", path=files[0], remedy=remedy)


def _suggest_grid(folder: Path) -> list[str]:
    """A line where photographs are numbered without a gap and fill a square: structure from motion fails on a rectified
    grid, and nothing else would show that it is one."""
    files, others, fields = largest_name_group(folder)
    varying = [i for i in range(1, len(fields[0]), 2) if len({int(f[i]) for f in fields}) > 1]
    side = math.isqrt(len(files))
    if others or len(varying) != 1 or side < FOLDER_MIN_SQUARE_SIDE_PHOTOGRAPHS or side * side != len(files):
        return []
    numbers = {int(f[varying[0]]) for f in fields}
    if len(numbers) < len(files) or max(numbers) - min(numbers) + 1 != len(files):
        return []
    return [f"numbered from {min(numbers)} to {max(numbers)}: if they are a grid, say --grid {side}x{side}"]
