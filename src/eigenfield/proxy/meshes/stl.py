"""STL, binary or ASCII with any number of solids. Corners at one place are joined."""

from __future__ import annotations

import logging
import re
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.proxy.meshes.formats import MeshFormat, RawMesh, parse_numbers

log = logging.getLogger("eigenfield.proxy")

_HEAD_BYTES = 84
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"^[ \t]*vertex[ \t]+(\S+[ \t]+\S+[ \t]+\S+)", re.MULTILINE | re.IGNORECASE)
_FACET = re.compile(rb"^[ \t]*facet\b", re.MULTILINE | re.IGNORECASE)
_SOLID = re.compile(rb"^[ \t]*solid\b", re.MULTILINE | re.IGNORECASE)
_END = re.compile(rb"^[ \t]*end[ \t]*solid\b", re.MULTILINE | re.IGNORECASE)


def read_stl(data: bytes, path: Path) -> RawMesh:
    """The triangles of an STL file.

    Raises:
        ValueError: Damaged data.
    """
    count = int.from_bytes(data[_HEAD_BYTES - 4 : _HEAD_BYTES], "little") if len(data) >= _HEAD_BYTES else -1
    length = _HEAD_BYTES + count * _TRIANGLE.itemsize
    if len(data) != length and data.lstrip()[:5].lower() == b"solid" and (count < 0 or b"facet" in data[:4096].lower()):
        corners = _read_ascii(data)
    elif count >= 0 and length <= len(data):
        corners = np.frombuffer(data, _TRIANGLE, count, _HEAD_BYTES)["corners"].astype(np.float64)
        if length < len(data):
            log.info("%d bytes behind the last triangle are ignored", len(data) - length)
    else:
        found = max(len(data) - _HEAD_BYTES, 0) // _TRIANGLE.itemsize
        raise ValueError(f"{max(count, 0)} triangles announced, {found} found")
    vertices, index = np.unique(corners.reshape(-1, 3), axis=0, return_inverse=True)
    return RawMesh(vertices, index.reshape(-1, 3), None)


def _read_ascii(data: bytes) -> NDArray[np.float64]:
    """(m, 3, 3) corners."""
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    solids, ends, facets = (len(pattern.findall(text)) for pattern in (_SOLID, _END, _FACET))
    if ends < solids:
        raise ValueError(f"{solids} solids begin and {ends} end")
    corners = parse_numbers(b" ".join(_VERTEX.findall(text))).reshape(-1, 3)
    if len(corners) != 3 * facets:
        raise ValueError(f"{facets} triangles have {len(corners)} corners")
    return corners.reshape(-1, 3, 3)


STL = MeshFormat(
    "STL", (".stl",), read_stl,
    "binary, and text with any number of solids; corners at one place are joined",
    "fewer triangles than are announced, a solid without an end",
    "normals, attributes, what follows the last triangle",
    "trimesh 5.2, Blender 5.0 (bpy), MeshLab (pymeshlab 2025.7)",
)  # fmt: skip
