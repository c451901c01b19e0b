"""Recognising what was given where a mesh, a capture or a scene is wanted: web addresses, and files by their bytes."""

from __future__ import annotations

import contextlib
import os
import re
from pathlib import Path

from eigenfield.core.errors import OptionError

SPLAT = "a Gaussian splat"
HEAD_BYTES = 4096  # from which a file is recognised
_BEGINNINGS = (
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"II*\0", "a TIFF picture"),
    (b"MM\0*", "a TIFF picture"),
    (b"PK\x03\x04", "a zip archive"),
    (b"%PDF", "a PDF document"),
)
_SPLAT_PROPERTIES = b" f_dc_0\n", b" scale_0\n", b" rot_0\n"  # Kerbl et al., "3D Gaussian Splatting", 2023
_ADDRESS = re.compile(r"([a-z][a-z0-9+.-]+):[/\\]{1,2}(.*)", re.IGNORECASE | re.DOTALL)


def recognise(head: bytes) -> str | None:
    """What a file is that is often given by mistake, by its first `HEAD_BYTES`, with an article; None for any other."""
    if head.startswith(b"ply"):
        text = head.replace(b"\r\n", b"\n")
        return SPLAT if all(name in text for name in _SPLAT_PROPERTIES) else None
    if head[:4] == b"RIFF" and head[8:12] == b"WEBP":
        return "a WebP picture"
    if re.match(rb"\s*<(!doctype html|html)", head, re.IGNORECASE):
        return "a web page"
    return next((what for mark, what in _BEGINNINGS if head.startswith(mark)), None)


def read_head(path: Path) -> bytes:
    """The first bytes of a file, for `recognise`; empty where it cannot be read."""
    with contextlib.suppress(OSError), path.open("rb") as file:
        return file.read(HEAD_BYTES)
    return b""


def split_address(path: str | os.PathLike[str]) -> tuple[str, str] | None:
    """The scheme, in lower case, and the rest of an address such as `s3://bucket/name`; None for every other path.

    Args:
        path: As it was given; a `Path` of an address keeps one slash of two.
    """
    found = _ADDRESS.fullmatch(os.fspath(path))
    return None if found is None else (found[1].lower(), found[2].replace("\\", "/"))


def refuse_address(path: str | os.PathLike[str]) -> None:
    """Refuse a web address where a file is wanted and none exists. OptionError `web-address`."""
    found = split_address(path)
    if found is not None:
        where = "://".join(found)
        remedy = "download it first, and name the file or folder"
        raise OptionError("web-address", "is a web address, and nothing is fetched", path=where, remedy=remedy)
