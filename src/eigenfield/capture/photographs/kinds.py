"""Kinds of files that people have: photographs that are read, those that need another wheel, and what is none."""

from __future__ import annotations

import importlib.util
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from eigenfield.core.camera_names import name_key

PHOTOGRAPH_EXTENSIONS = (".png", ".jpg", ".jpeg", ".webp", ".tif", ".tiff", ".avif")
# other endings of photographs, which browsers, phones and programs write; their content says whether they are any
OTHER_JPEG_EXTENSIONS = (".jpe", ".jfif", ".jif", ".jfi", ".pjpeg", ".pjp", ".mpo")
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
    Kind((".gif", ".bmp", ".dib", ".jp2", ".j2k", ".jpx", ".jxr", ".psd", ".psb", ".xcf", ".ppm", ".pgm", ".pnm",
          ".tga", ".hdr", ".dpx", ".qoi", ".heics", ".avifs"),
         "a picture of another format", "convert it to PNG or JPEG"),
    Kind(OTHER_JPEG_EXTENSIONS, "no picture that is read, whatever its name says", "copy it again"),
    Kind((".jps", ".pns"), "two pictures side by side", "cut it into the two"),
    Kind((".gpr", ".raw", ".mrw", ".x3f", ".kdc", ".dcr", ".erf", ".mef", ".mos", ".srf", ".fff", ".cap", ".eip"),
         "a camera's RAW of another format", "convert it to DNG or JPEG"),
    Kind((".insp", ".insv", ".360"), "a panorama", "cut it into perspective views"),
    Kind(VIDEO_EXTENSIONS, "a video", "name it alone, or take frames out of it"),
    Kind((".3gp", ".3g2", ".wmv", ".asf", ".flv", ".mxf", ".ogv", ".vob", ".mod", ".tod"), "a video of another format",
         "convert it to MP4"),
    Kind((".zip",), "an archive", "name it alone, or unpack it"),
    Kind((".7z", ".rar", ".tar", ".tgz", ".gz", ".bz2", ".xz"), "an archive",
         "unpack it, and name the folder"),
)  # fmt: skip
# added to the name of a file whose content is elsewhere: by iCloud Drive, Nextcloud, ownCloud, odrive, Resilio Sync and
# downloads that have not ended
PLACEHOLDER_KIND = Kind(
    (".icloud", ".nextcloud", ".owncloud", ".cloud", ".rsls", ".crdownload", ".part", ".partial", ".download"),
    "not on this machine", "download them first",
)  # fmt: skip
PASSED_OVER_EXTENSIONS = (".thm", ".ctg", ".bak", ".tmp", ".db")  # may hold pictures that are none of the scene
MESH_KIND = Kind((".ply", ".obj", ".glb", ".gltf", ".stl", ".off"), "a mesh", "name it with --proxy")


# no ending, one of those above, or a photograph's with more behind: .jpg_large, .jpg!d, .png?width=900
_RENAMED = re.compile(
    rf"[^.]+|.*({'|'.join(map(re.escape, OTHER_JPEG_EXTENSIONS))}|\.(jpe?g|png|webp|avif)[^a-z0-9.].*)", re.DOTALL
)


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


def may_be_renamed(name: str) -> bool:
    """Whether a name may be that of a photograph although it does not end like one: its content decides."""
    lower = name.lower()
    return _RENAMED.fullmatch(lower) is not None and not lower.endswith(ALL_EXTENSIONS)


def placeholder_of(name: str) -> str | None:
    """The name of the file that a placeholder stands for; None for the names of other files."""
    lower = name.lower()
    ending = next((ending for ending in PLACEHOLDER_KIND.endings if lower.endswith(ending)), None)
    return None if ending is None else name.removeprefix(".")[: -len(ending)]


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
    if lower.endswith(PHOTOGRAPH_EXTENSIONS):
        return 0
    last = len(OPTIONAL_KINDS) + 1  # of those with other endings
    return next((rank for rank, kind in enumerate(OPTIONAL_KINDS, start=1) if lower.endswith(kind.endings)), last)
