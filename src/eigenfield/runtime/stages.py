"""Finished stages of long work in a folder, so that the same command resumes after a crash.

The name of a stage's folder has a digest of everything that its result depends on: with another option, photograph or
program, the stage is built again. It is built beside its place and renamed: a folder that exists is whole.
In an object store, which has no rename, a stage is whole with its last object (`runtime.objects`).
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import logging
import shutil
import weakref
from collections.abc import Callable, Iterable
from functools import cache
from pathlib import Path
from typing import Any

from eigenfield.core.errors import OptionError, OutputError
from eigenfield.runtime.files import flush_folder, output_errors, rename
from eigenfield.runtime.objects import find_objects, local_folder
from eigenfield.runtime.temporary import temporary_folder

log = logging.getLogger("eigenfield.stages")

DIGEST_BLOCK_BYTES = 1 << 20
PACKAGE_FOLDER = Path(__file__).parents[1]
# What makes stages of cameras and surfaces. A change of how scenes are coded, which comes after them, keeps them
SURFACE_ROOMS = "core", "runtime", "imaging", "capture", "stereo", "calibration", "proxy", "reconstruction"
SCENE_ROOMS = (*SURFACE_ROOMS, "coding", "gltf", "rendering", "encoding")  # what makes stages of encoded scenes


@cache
def code_version(rooms: tuple[str, ...] = SURFACE_ROOMS, root: Path = PACKAGE_FOLDER) -> str:
    """A digest of the sources of rooms of a package: a stage built by another version of them is not reused."""
    digest = hashlib.sha256()
    for source in sorted(path for room in rooms for path in (root / room).rglob("*.py")):
        digest.update(f"{source.relative_to(root).as_posix()}\n".encode() + source.read_bytes())
    return digest.hexdigest()


def file_digest(path: Path) -> str:
    """The SHA-256 of a file's bytes."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while block := file.read(DIGEST_BLOCK_BYTES):
            digest.update(block)
    return digest.hexdigest()


def stage_key(inputs: Iterable[Any], rooms: tuple[str, ...] = SURFACE_ROOMS) -> str:
    """A digest of JSON-able `inputs` (file digests, options, the keys of earlier stages), and of the rooms whose code
    makes the stage."""
    text = json.dumps([code_version(rooms), *inputs], sort_keys=True, default=str)
    return hashlib.sha256(text.encode()).hexdigest()[:16]


class Stages:
    """Finished stages in a folder, or in an object store with copies in a folder of this machine."""

    def __init__(self, folder: Path | None) -> None:
        """Make the folder; None keeps nothing: every stage is built in a temporary folder."""
        opened = contextlib.ExitStack()
        self.close = weakref.finalize(self, opened.close)  # removes the folder if it is temporary
        self.objects = None if folder is None else find_objects(folder)
        if self.objects is not None:
            self.objects.check_bucket()
            self.folder = local_folder(self.objects)
        else:
            self.folder = opened.enter_context(temporary_folder()) if folder is None else Path(folder)
        if self.folder.exists() and not self.folder.is_dir():
            raise OutputError("work-is-file", "is a file", path=self.folder, remedy="name a folder as --work")
        with output_errors(self.folder):
            self.folder.mkdir(parents=True, exist_ok=True)

    def find(self, name: str, key: str) -> Path | None:
        """The folder of a finished stage, copied from the object store if need be; None if it is not finished."""
        place = self.folder / f"{name}-{key}"
        if not place.is_dir() and self.objects is not None:
            with output_errors(self.folder), temporary_folder(name, self.folder) as part:
                if self.objects.fetch_stage(place.name, part):
                    self._appear(part, place)
        return place if place.is_dir() else None

    def run(self, name: str, key: str, build: Callable[[Path], None]) -> Path:
        """The folder of a stage: the finished one, otherwise a new one.

        Args:
            key: Digest of everything that its result depends on (`stage_key`).
            build: Writes the stage's files into the folder that it is given.

        Raises:
            OutputError: The folder cannot be written. Errors of `build` pass through; nothing of the stage is left.
        """
        found = self.find(name, key)
        if found is not None:
            log.info("%s: taken up from %s", name, found)
            return found
        place = self.folder / f"{name}-{key}"
        with output_errors(self.folder), temporary_folder(name, self.folder) as part:
            build(part)
            if self.objects is not None:
                self.objects.put_stage(place.name, part)
            self._appear(part, place)
        return place

    @property
    def place(self) -> Path:
        """The folder, or the address of the object store: where workers find and leave stages."""
        return self.folder if self.objects is None else Path(self.objects.address)

    def remove(self, folder: Path) -> None:
        """Remove a stage that is needed no more. What cannot be removed stays."""
        shutil.rmtree(folder, ignore_errors=True)
        if self.objects is not None:
            with contextlib.suppress(OptionError):  # credentials that may write need not be allowed to remove
                self.objects.remove_stage(folder.name)

    @staticmethod
    def _appear(part: Path, place: Path) -> None:
        part.chmod(0o755)
        flush_folder(part)
        try:
            rename(part, place)
        except OSError:
            if not place.is_dir():  # another run may have finished the same stage meanwhile
                raise

    def __enter__(self) -> Stages:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
