"""Kinds of files that people have: photographs that are read, those that need another wheel, and what is none."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from eigenfield.core.camera_names import name_key

PHOTOGRAPH_EXTENSIONS = (".png", ".jpg", ".jpeg", ".webp", ".tif", ".tiff", ".avif")
VIDEO_EXTENSIONS = (".mp4", ".mov", ".mkv", ".avi", ".webm", ".m4v", ".mpg", ".mpeg", ".mts", ".m2ts")


@dataclass(frozen=True)
class Kind:
    """Files of some endings that are not read as they are.

    Attributes:
        endings: Of their names.
        what: One of them is, with its article.
        remedy: What to do about one, an imperative.
        module: With which they are read as photographs; None for what no module reads.
    """

    endings: tuple[str, ...]
    what: str
    remedy: str
    module: str | None = None


PHOTOS_REMEDY = "pip install 'eigenfield[photos]'"
RAW_REMEDY = "pip install 'eigenfield[raw]'"
RENDERS_REMEDY = "pip install 'eigenfield[renders]'"
RAW_EXTENSIONS = (
    ".dng", ".nef", ".nrw", ".cr2", ".cr3", ".crw", ".arw", ".sr2", ".raf", ".rw2", ".orf", ".pef", ".srw", ".3fr",
    ".iiq", ".rwl",
)  # fmt: skip
LINEAR_EXTENSIONS = (".exr",)  # of photographs whose values are linear light
# the earlier of two with the same stem is the photograph, and the later a copy of it
OPTIONAL_KINDS = (
    Kind((".heic", ".heif", ".hif"), "HEIC", PHOTOS_REMEDY, "pi_heif"),
    Kind((".jxl",), "JPEG XL", PHOTOS_REMEDY, "pillow_jxl"),
    Kind(RAW_EXTENSIONS, "a camera's RAW", RAW_REMEDY, "rawpy"),
    Kind(LINEAR_EXTENSIONS, "OpenEXR", RENDERS_REMEDY, "OpenEXR"),
)
ALL_EXTENSIONS = (*PHOTOGRAPH_EXTENSIONS, *(ending for kind in OPTIONAL_KINDS for ending in kind.endings))
OTHER_KINDS = (
    Kind((".gif", ".bmp", ".jp2", ".j2k", ".psd", ".ppm", ".pgm", ".tga", ".hdr", ".jfif", ".mpo", ".heics", ".avifs"),
         "a picture of another format", "convert it to PNG or JPEG"),
    Kind((".insp", ".insv", ".360"), "a panorama", "cut it into perspective views"),
    Kind(VIDEO_EXTENSIONS, "a video", "name it alone, or take frames out of it"),
    Kind((".zip",), "an archive", "name it alone, or unpack it"),
    Kind((".7z", ".rar", ".tar", ".tgz", ".gz", ".bz2", ".xz"), "an archive",
         "unpack it, and name the folder"),
)  # fmt: skip
MESH_KIND = Kind((".ply", ".obj", ".glb", ".gltf", ".stl", ".off"), "a mesh", "name it with --proxy")


@cache
def is_installed(module: str) -> bool:
    """Whether a module is there, which is not imported."""
    return importlib.util.find_spec(module) is not None


def read_extensions() -> tuple[str, ...]:
    """Endings of the photographs that are read with what is installed."""
    more = (kind for kind in OPTIONAL_KINDS if kind.module is not None and is_installed(kind.module))
    return (*PHOTOGRAPH_EXTENSIONS, *(ending for kind in more for ending in kind.endings))


def unread_kind(name: str) -> Kind | None:
    """The kind of a file that is not read as a photograph here; None for those that are, and for any other file."""
    lower = name.lower()
    if lower.endswith(read_extensions()):
        return None
    return next((kind for kind in (*OPTIONAL_KINDS, *OTHER_KINDS) if lower.endswith(kind.endings)), None)


def is_linear(path: Path) -> bool:
    """Whether a photograph's name says that its values are linear light."""
    return path.suffix.lower() in LINEAR_EXTENSIONS


def without_copies(files: Iterable[Path]) -> list[Path]:
    """Photographs without those that another of the same stem is a copy of: a camera's JPEG beside its RAW."""
    files = list(files)
    ranks = [_rank(file.name) for file in files]
    best: dict[str, int] = {}
    for file, rank in zip(files, ranks, strict=True):
        stem = name_key(file.stem)
        best[stem] = min(rank, best.get(stem, rank))
    return [file for file, rank in zip(files, ranks, strict=True) if rank == best[name_key(file.stem)]]


def _rank(name: str) -> int:
    lower = name.lower()
    return next((rank for rank, kind in enumerate(OPTIONAL_KINDS, start=1) if lower.endswith(kind.endings)), 0)
