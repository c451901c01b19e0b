"""A capture in a zip: unpacked once into a work folder, within limits, and nowhere else."""

from __future__ import annotations

import lzma
import os
import re
import shutil
import stat
import sys
import zipfile
import zlib
from pathlib import Path, PurePosixPath

from eigenfield.capture.readers.video import frames_stage, video_identity
from eigenfield.core.errors import CaptureError, OutputError, one_line
from eigenfield.runtime.stages import stage_key

ZIP_EXTENSION = ".zip"
ZIP_MAX_FILES = 100_000
ZIP_MAX_BYTES = 100 * 10**9  # of all files, unpacked
ZIP_MAX_RATIO = 100  # of all files, unpacked, to the zip; photographs are hardly packed at all
ZIP_FREE_BYTES = 10**8  # for which the ratio does not matter
ZIP_MAX_NAME_BYTES = 255  # of a folder or a file
ZIP_BLOCK_BYTES = 1 << 20
ZIP_ENCRYPTED_FLAG = 0x1
ZIP_BAD_CHARACTERS = re.compile(r"[\0-\x1f\x7f]")
ZIP_WINDOWS_FORBIDDEN = re.compile(r'[<>:"|?*]|[. ]$|^(con|prn|aux|nul|com[0-9]|lpt[0-9])(\.|$)', re.IGNORECASE)
ZIP_IGNORED = re.compile(r"__MACOSX|\.DS_Store|Thumbs\.db|desktop\.ini|\._.*", re.IGNORECASE)  # of file managers
ZIP_REMEDY = "unpack it yourself, and name the folder"
ZIP_ERRORS = zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, NotImplementedError, RuntimeError, ValueError


def is_zip(path: Path) -> bool:
    """Whether a path is a file that is named as a zip."""
    return path.suffix.lower() == ZIP_EXTENSION and path.is_file()


def unpack(path: Path, work: str | os.PathLike[str] | None) -> Path:
    """The folder with what a zip holds; folders around all of it are passed over.

    Args:
        work: A folder that keeps what is unpacked (reused if it is there); None for a temporary one.

    Raises:
        CaptureError: `zip-damaged`, `zip-encrypted`, `zip-path` (a path that leaves the folder, a link), `zip-large`,
            `zip-empty`.
        OutputError: There is no room.
    """
    stages = frames_stage(work)

    def build(place: Path) -> None:
        try:
            with zipfile.ZipFile(path) as archive:
                files = _check(archive, path)
                needed = sum(info.file_size for info in files.values())
                if shutil.disk_usage(place).free < needed:
                    message = f"no room for the {needed / 1e9:.1f} GB of {path.name}"
                    raise OutputError(
                        "disk-full", message, path=place.parent, remedy="free some, or name another --work"
                    )
                for name, info in files.items():
                    _write(archive, info, place / name)
        except ZIP_ERRORS as error:
            why = (str(error) or type(error).__name__).splitlines()[0][:120]
            raise _error("damaged", f"is damaged ({why})", path, "copy it again, or unpack it yourself") from error

    folder = stages.run("zip", stage_key([video_identity(path)]), build)
    while len(inner := list(folder.iterdir())) == 1 and inner[0].is_dir():
        folder = inner[0]
    return folder


def _error(code: str, message: str, path: Path, remedy: str = ZIP_REMEDY) -> CaptureError:
    return CaptureError(f"zip-{code}", message, path=path, remedy=remedy)


def _check(archive: zipfile.ZipFile, path: Path) -> dict[PurePosixPath, zipfile.ZipInfo]:
    """The files by their paths in the folder; nothing is unpacked yet."""
    infos = archive.infolist()
    if len(infos) > ZIP_MAX_FILES:
        raise _error("large", f"holds {len(infos)} files, more than the {ZIP_MAX_FILES} that are read", path)
    files: dict[PurePosixPath, zipfile.ZipInfo] = {}
    for info in infos:
        name = _safe_path(info, path)
        if name is None or any(ZIP_IGNORED.fullmatch(part) for part in name.parts):
            continue
        if name in files:
            raise _error("damaged", f"holds {one_line(str(name))} twice", path)
        if info.flag_bits & ZIP_ENCRYPTED_FLAG:
            raise _error("encrypted", "is encrypted", path)
        files[name] = info
    if not files:
        raise _error("empty", "holds no files", path, "name another")
    if any(parent in files for name in files for parent in name.parents):
        raise _error("damaged", "holds a file and a folder of one name", path)
    total, packed = (sum(getattr(i, size) for i in files.values()) for size in ("file_size", "compress_size"))
    size = path.stat().st_size
    if total > ZIP_MAX_BYTES or total > max(ZIP_FREE_BYTES, ZIP_MAX_RATIO * size) or packed > size:
        raise _error("large", f"would become {total / 1e9:.3g} GB, {total / size:.0f} times its size", path)
    return files


def _safe_path(info: zipfile.ZipInfo, path: Path) -> PurePosixPath | None:
    """Where a file goes below the folder; None for a folder."""
    name = info.orig_filename.replace("\\", "/")  # some programs write these
    shown = one_line(info.orig_filename[:80])
    kind = stat.S_IFMT(info.external_attr >> 16)
    if kind not in (0, stat.S_IFREG, stat.S_IFDIR):
        raise _error("path", f"holds a link or device ({shown})", path)
    parts = name.split("/")
    if name.startswith("/") or ".." in parts or ":" in parts[0] or ZIP_BAD_CHARACTERS.search(name):
        raise _error("path", f"holds a path that leaves its folder or is none ({shown})", path)
    if sys.platform == "win32" and any(ZIP_WINDOWS_FORBIDDEN.search(part) for part in parts):
        raise _error("path", f"holds a name that Windows does not allow ({shown})", path)
    if any(len(part.encode("utf-8", "surrogateescape")) > ZIP_MAX_NAME_BYTES for part in parts):
        raise _error("path", f"holds a name that is too long ({shown})", path)
    return None if name.endswith("/") or kind == stat.S_IFDIR else PurePosixPath(name)


def _write(archive: zipfile.ZipFile, info: zipfile.ZipInfo, target: Path) -> None:
    """One file. `zipfile` gives no more bytes than the file states, and checks them."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        out = target.open("xb")
    except FileExistsError as error:  # on Windows and macOS, where case does not count
        shown = one_line(target.name)
        raise _error(
            "path", f"holds two names that are one file here ({shown})", Path(str(archive.filename))
        ) from error
    with out, archive.open(info) as packed:
        while block := packed.read(ZIP_BLOCK_BYTES):
            out.write(block)
