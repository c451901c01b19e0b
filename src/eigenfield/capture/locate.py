"""Which files belong together: the photograph of an entry, the mask of a photograph."""

from __future__ import annotations

import os
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import TypeVar

from eigenfield.capture.lightfield import View
from eigenfield.capture.messages import describe
from eigenfield.capture.photographs.kinds import (
    ALL_EXTENSIONS,
    VIDEO_EXTENSIONS,
    may_be_renamed,
    read_extensions,
    without_copies,
)
from eigenfield.capture.photographs.read import FORMAT_HEAD_BYTES, decode_mask, format_of
from eigenfield.capture.photoset import Shot
from eigenfield.core.camera_names import name_key
from eigenfield.core.errors import CaptureError

T = TypeVar("T", View, Shot)

IMAGES_FOLDER = "images"
RENAMED_FORMATS = ("JPEG", "PNG", "WebP", "AVIF")  # TIFF may be a RAW with a small picture
SEARCH_MAX_FILES = 1_000_000  # files looked at below images/


def photograph_root(path: Path, found: Path) -> Path:
    """The folder of the photographs, for a `path` that may be the calibration itself."""
    if path.is_file():
        path = path.parent
    if found.is_dir() and found.resolve() == path.resolve():  # the model itself was named
        path = path.resolve()
        if path.name.isdigit() and path.parent.name == "sparse":
            path = path.parent
        if path.name == "sparse":
            path = path.parent
    if found.is_dir() and found.resolve() == path.resolve() and not _holds_any(path):
        above = path.resolve().parent
        path = above if _holds_photographs(above) else path
    return path


def _holds_photographs(folder: Path) -> bool:
    return bool(photographs_in(folder) or photographs_in(folder / IMAGES_FOLDER))


def _holds_any(folder: Path) -> bool:
    """Whether a folder, or one directly in it (`train/`, `val/`), holds photographs."""
    if _holds_photographs(folder):
        return True
    with os.scandir(folder) as entries:
        return any(entry.is_dir() and bool(photographs_in(Path(entry.path))) for entry in entries)


def is_file(path: Path) -> bool:
    """Path.is_file for names from outside: False, not an error, where a name is too long or holds a NUL."""
    return os.path.isfile(path)  # noqa: PTH113


def _with_extensions(path: Path) -> Iterator[Path]:
    """The path, and with each extension if it has none: original NeRF sets leave it out."""
    yield path
    extensions = read_extensions()
    if not path.name.lower().endswith(extensions):
        for extension in (*extensions, *(e.upper() for e in extensions)):
            yield path.with_name(path.name + extension)


class PhotographFinder:
    """Finds the photographs of calibration entries below `root`."""

    def __init__(self, root: Path, base: Path, apart: bool) -> None:
        """Nothing is read yet.

        Args:
            base: Folder that paths in the calibration are relative to, tried beside `root`.
            apart: The calibration was named apart from the photographs: `base` counts only for files below `root`.
        """
        self.root, self.base, self.apart = root, base, apart
        self._resolved = root.resolve()
        self._by_name: dict[str, list[Path]] | None = None
        self._listed: dict[Path, dict[str, list[Path]]] = {}

    def find(self, file: str) -> Path | None:
        """By the path relative to root, to the calibration, to root/images, then by the file's name alone."""
        return self.find_exactly(file) or self._by_file_name(file)

    def find_exactly(self, file: str) -> Path | None:
        """By relative path only: for masks, which often have the names of their photographs. Where no path is spelled
        so, folders and file are compared by `name_key`."""
        if not file.strip("./"):
            return None
        folders = (self.root, self.base, self.root / IMAGES_FOLDER)
        for folder in folders:
            for candidate in _with_extensions(folder / file):
                if is_file(candidate) and (not self.apart or self._is_below(candidate)):
                    short = Path(os.path.normpath(candidate))
                    return short if is_file(short) else candidate  # behind a link to a folder, .. is another folder
        spelled = (self._spelled_otherwise(folder, file) for folder in folders)
        return next((path for path in spelled if path and (not self.apart or self._is_below(path))), None)

    def _spelled_otherwise(self, folder: Path, file: str) -> Path | None:
        """The only file whose path below a folder has the same `name_key` in every part."""
        *inner, last = PurePosixPath(file).parts
        if last == ".." or PurePosixPath(file).is_absolute():
            return None
        places = [folder]
        for part in inner:
            if part == "..":
                places = [Path(os.path.normpath(place / part)) for place in places]
            else:
                places = [path for place in places for path in self._list(place).get(name_key(part), ())]
        for name in _with_extensions(Path(last)):
            found = [path for place in places for path in self._list(place).get(name_key(name.name), ())]
            files = [path for path in found if is_file(path)]
            if files:
                return files[0] if len(files) == 1 else None
        return None

    def _list(self, folder: Path) -> dict[str, list[Path]]:
        """What is in a folder, by `name_key`; nothing where it is none."""
        if folder not in self._listed:
            listed: dict[str, list[Path]] = defaultdict(list)
            try:
                for name in sorted(os.listdir(folder)):  # noqa: PTH208
                    listed[name_key(name)].append(folder / name)
            except (OSError, ValueError):
                listed.clear()
            self._listed[folder] = dict(listed)
        return self._listed[folder]

    def _is_below(self, path: Path) -> bool:
        # the folder, not the file: photographs themselves may be links to elsewhere
        return path.parent.resolve().is_relative_to(self._resolved)

    def _by_file_name(self, file: str) -> Path | None:
        if self._by_name is None:
            self._by_name = defaultdict(list)
            for path in _candidate_files(self.root):
                for key in {name_key(path.name), name_key(path.stem)}:
                    self._by_name[key].append(path)
        name = file.rsplit("/", 1)[-1]
        matches = self._by_name.get(name_key(name), []) if name else []
        return matches[0] if len(matches) == 1 else None


def _candidate_files(root: Path) -> Iterator[Path]:
    """Photographs directly in root and anywhere below root/images, in a fixed order."""
    yield from photographs_in(root)
    count = 0
    for folder, inner, _ in os.walk(root / IMAGES_FOLDER):
        inner.sort()
        for path in photographs_in(Path(folder)):
            yield path
            count += 1
            if count > SEARCH_MAX_FILES:
                return


def photographs_in(folder: Path) -> list[Path]:
    """The photographs of one folder that are read, sorted, each once.

    They are named like photographs, or have other endings and are JPEG, PNG, WebP or AVIF by their content. The latter
    are none beside videos alone, whose posters they may be.
    """
    named = files_named(folder, read_extensions())
    others = [path for path in _files_in(folder, may_be_renamed) if content_format(path) in RENAMED_FORMATS]
    if others and not named and files_named(folder, VIDEO_EXTENSIONS):
        others = []
    return without_copies(sorted(named + others))


def is_photograph_file(path: Path) -> bool:
    """Whether a path is a file that is named like a photograph, or may be one of another name and is by its content."""
    if not is_file(path):
        return False
    return path.name.lower().endswith(ALL_EXTENSIONS) or (
        may_be_renamed(path.name) and content_format(path) in RENAMED_FORMATS
    )


def files_named(folder: Path, endings: tuple[str, ...]) -> list[Path]:
    """The files of one folder whose names end so, sorted, hidden ones left out; none where it is no folder."""
    return _files_in(folder, lambda name: name.lower().endswith(endings))


def _files_in(folder: Path, fits: Callable[[str], bool]) -> list[Path]:
    if not folder.is_dir():
        return []
    with os.scandir(folder) as entries:
        fitting = (e for e in entries if not e.name.startswith(".") and fits(e.name))
        return sorted(Path(e.path) for e in fitting if e.is_file())


def content_format(path: Path) -> str | None:
    """The format of a photograph by its first bytes; None for other files, and for those that cannot be read."""
    try:
        known = path.stat()
        return _content_format(path, known.st_size, known.st_mtime_ns)
    except OSError:
        return None


@lru_cache(maxsize=1 << 16)
def _content_format(path: Path, size: int, modified: int) -> str | None:
    with path.open("rb") as file:
        return format_of(path, file.read(FORMAT_HEAD_BYTES))


class MaskFinder:
    """Finds masks in a folder, named as the photograph but for the extension, or with one more (`a.jpg.png`)."""

    def __init__(self, folder: Path) -> None:
        if not folder.is_dir():
            raise CaptureError("masks-missing", "is no folder of masks", path=folder, remedy="check --masks")
        self.folder = folder
        self._stems: dict[tuple[str, str], list[Path]] = defaultdict(list)
        for inside, inner, _ in os.walk(folder):
            inner.sort()
            relative = Path(inside).relative_to(folder).as_posix()
            for path in photographs_in(Path(inside)):
                self._stems[name_key(relative), name_key(path.stem)].append(path)

    def find(self, photograph: Path, folders: Iterable[str]) -> Path | None:
        """The mask of a photograph, looked for in `folders` below the masks' own, "." among them or not."""
        for folder in folders:
            for stem in (photograph.name, photograph.stem):  # a.jpg.png before a.png
                matches = self._stems.get((name_key(folder), name_key(stem)), [])
                if len(matches) == 1:
                    return matches[0]
                if matches:
                    raise CaptureError(
                        "mask-twice",
                        f"two masks fit {photograph.name}: {matches[0].name} and {matches[1].name}",
                        path=self.folder,
                        remedy="leave one",
                    )
        return None


def with_masks(views: Sequence[T], folder: Path | None, root: Path, strict: bool) -> tuple[list[T], list[str]]:
    """Views or shots with the masks of a folder, and a line that names those without one.

    Args:
        folder: Folder of the masks; None for none.
        root: Folder of the photographs, whose subfolders the masks' folder may have too.
        strict: Refuse masks that hide everything.

    Raises:
        CaptureError: `masks-missing` where no mask fits, `mask-twice`, `masks-black`.
    """
    if folder is None:
        return list(views), []
    finder = MaskFinder(folder)
    masked, missing = [], []
    for view in views:
        mask = finder.find(view.path, _mask_folders(view.path, root))
        if mask is None:
            missing.append(view.path.name)
        masked.append(replace(view, mask=mask) if mask is not None else view)
    if views and len(missing) == len(views):
        raise CaptureError(
            "masks-missing",
            f"holds no mask for any photograph (looked for {views[0].path.stem}.png and the like)",
            path=folder,
            remedy="name masks as their photographs",
        )
    if strict:
        _refuse_black_masks([view.mask for view in masked], folder)
    return masked, describe(missing, "photograph has", "photographs have", f"no mask in {folder}")


def _refuse_black_masks(masks: Sequence[Path | None], folder: Path) -> None:
    """Raise CaptureError `masks-black` where every photograph has a mask and all hide everything; the first mask that
    shows something ends the search."""
    paths = [mask for mask in masks if mask is not None]
    if paths and len(paths) == len(masks) and not any(decode_mask(path).any() for path in paths):
        raise CaptureError(
            "masks-black",
            f"its {len(paths)} masks hide every pixel",
            path=folder,
            remedy="white counts, black is left out: invert the masks?",
        )


def _mask_folders(path: Path, root: Path) -> list[str]:
    """Where below a folder of masks a photograph's mask may lie: its own relative folder, shortened from the front."""
    try:
        parts = path.parent.resolve().relative_to(root.resolve()).parts
    except ValueError:
        parts = ()
    return ["/".join(parts[i:]) or "." for i in range(len(parts) + 1)]
