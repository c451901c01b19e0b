"""Which files belong together: the calibration in a folder, the photograph of an entry, the mask of a photograph."""

from __future__ import annotations

import os
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path

from eigenfield.capture.colmap import is_model
from eigenfield.capture.photographs import EXTENSIONS
from eigenfield.errors import CaptureError

MODEL_FOLDERS = ("sparse/0", "sparse", ".", "colmap/sparse/0")
TRANSFORMS = "transforms.json"
IMAGES = "images"
FILES_LIMIT = 1_000_000  # files looked at below images/


def find_calibration(path: Path) -> Path:
    """The transforms.json or the COLMAP model folder that `path` is or holds; a transforms.json goes first."""
    if not path.exists():
        raise CaptureError("capture-missing", "does not exist", path=path, remedy="check the path")
    if path.is_file():
        if path.suffix.lower() == ".json":
            return path
        if path.stem in ("cameras", "images") and is_model(path.parent):
            return path.parent
        raise CaptureError(
            "calibration-unknown",
            "is no calibration",
            path=path,
            remedy=f"name a {TRANSFORMS}, a COLMAP model, or a folder with one",
        )
    if (path / TRANSFORMS).is_file():
        return path / TRANSFORMS
    for folder in MODEL_FOLDERS:
        if is_model(path / folder):
            return path / folder
    others = sorted(p.name for p in path.glob("*.json"))
    hint = f"it holds {', '.join(others[:4])}: name one as the calibration" if others else "name one with --calibration"
    raise CaptureError(
        "calibration-missing", f"has no {TRANSFORMS} and no COLMAP model (sparse/0)", path=path, remedy=hint
    )


def root_of(path: Path, found: Path) -> Path:
    """The folder of the photographs, for a `path` that may be the calibration itself."""
    if path.is_file():
        path = path.parent
    if found.is_dir() and found.resolve() == path.resolve():  # the model itself was named
        path = path.resolve()
        if path.name.isdigit() and path.parent.name == "sparse":
            path = path.parent
        if path.name == "sparse":
            path = path.parent
    return path


def _key(name: str) -> str:
    """A file name as file systems compare them that know neither case nor one way to write an accent."""
    return unicodedata.normalize("NFC", name).casefold()


def is_file(path: Path) -> bool:
    """Path.is_file for names from outside: False, not an error, where a name is too long or holds a NUL."""
    return os.path.isfile(path)  # noqa: PTH113


def has_known_extension(name: str) -> bool:
    return name.lower().endswith(EXTENSIONS)


def _with_extensions(path: Path) -> Iterator[Path]:
    """The path, and with each extension if it has none: original NeRF sets leave it out."""
    yield path
    if not has_known_extension(path.name):
        for extension in (*EXTENSIONS, *(e.upper() for e in EXTENSIONS)):
            yield path.with_name(path.name + extension)


class PhotographFinder:
    """Finds the photographs of calibration entries below `root`.

    base: the folder that paths in the calibration are relative to, tried beside `root` (always where the calibration
        lies in the capture; only as far as it leads back into `root` where it was named apart).
    """

    def __init__(self, root: Path, base: Path, apart: bool) -> None:
        self.root, self.base, self.apart = root, base, apart
        self._resolved = root.resolve()
        self._by_name: dict[str, list[Path]] | None = None

    def find(self, file: str) -> Path | None:
        """By the path relative to root, to the calibration, to root/images, then by the file's name alone."""
        return self.find_exactly(file) or self._by_file_name(file)

    def find_exactly(self, file: str) -> Path | None:
        """By relative path only: for masks, which often have the names of their photographs."""
        if not file.strip("./"):
            return None
        for folder in (self.root, self.base, self.root / IMAGES):
            for candidate in _with_extensions(folder / file):
                if is_file(candidate) and (not self.apart or self._is_below(candidate)):
                    return Path(os.path.normpath(candidate))
        return None

    def _is_below(self, path: Path) -> bool:
        # the folder, not the file: photographs themselves may be links to elsewhere
        return path.parent.resolve().is_relative_to(self._resolved)

    def _by_file_name(self, file: str) -> Path | None:
        if self._by_name is None:
            self._by_name = defaultdict(list)
            for path in _files(self.root):
                for key in {_key(path.name), _key(path.stem)}:
                    self._by_name[key].append(path)
        name = file.rsplit("/", 1)[-1]
        matches = self._by_name.get(_key(name), []) if name else []
        return matches[0] if len(matches) == 1 else None


def _files(root: Path) -> Iterator[Path]:
    """Photographs directly in root and anywhere below root/images, in a fixed order."""
    yield from photographs_in(root)
    count = 0
    for folder, inner, _ in os.walk(root / IMAGES):
        inner.sort()
        for path in photographs_in(Path(folder)):
            yield path
            count += 1
            if count > FILES_LIMIT:
                return


def photographs_in(folder: Path) -> list[Path]:
    """The files of one folder that are named like photographs, sorted."""
    if not folder.is_dir():
        return []
    with os.scandir(folder) as entries:
        return sorted(
            Path(e.path) for e in entries if has_known_extension(e.name) and not e.name.startswith(".") and e.is_file()
        )


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
                self._stems[_key(relative), _key(path.stem)].append(path)

    def find(self, photograph: Path, folders: Iterable[str]) -> Path | None:
        """The mask of a photograph, looked for in `folders` below the masks' own, "." among them or not."""
        for folder in folders:
            for stem in (photograph.name, photograph.stem):  # a.jpg.png before a.png
                matches = self._stems.get((_key(folder), _key(stem)), [])
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
