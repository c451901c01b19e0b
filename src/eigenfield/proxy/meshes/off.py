"""OFF, as text (Geomview's Object File Format): positions and polygons, colours and normals left out."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.proxy.meshes.formats import MeshFormat, RawMesh, parse_numbers
from eigenfield.proxy.meshes.polygons import Polygons, triangulate_polygons


def read_off(data: bytes, path: Path) -> RawMesh:
    """The triangles of an OFF file.

    Raises:
        ProxyError: `proxy-index-range`, `proxy-polygon`.
        ValueError: Damaged data, or a kind of OFF that is not read.
    """
    text = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    lines = [stripped for line in text.split(b"\n") if (stripped := line.split(b"#")[0].strip())]
    head = lines[0].split() if lines else []
    kind = head[0].upper() if head else b""
    if kind.endswith(b"OFF"):
        if (
            kind.strip(b"STCN") != b"OFF"
            or head[0].startswith(b"n")
            or b"BINARY" in (word.upper() for word in head[1:])
        ):
            raise ValueError(f"{lines[0].decode('latin-1')[:40]} is not read, only text with three coordinates")
        lines = ([b" ".join(head[1:])] if head[1:] else []) + lines[1:]
    if not lines or len(lines[0].split()) < 2:
        raise ValueError("no numbers of vertices and faces")
    count, polygons = (int(word) for word in lines[0].split()[:2])
    if count < 0 or polygons < 0 or 1 + count + polygons > len(lines):
        raise ValueError(f"{count} vertices and {polygons} faces announced, {len(lines) - 1} lines found")
    vertices = _first_numbers(lines[1 : 1 + count], 3)
    rows = lines[1 + count : 1 + count + polygons]
    return RawMesh(vertices, triangulate_polygons(_read_faces(rows), None, vertices)[0], None)


def _read_faces(lines: list[bytes]) -> Polygons:
    if lines and all(line.startswith(b"3 ") for line in lines):
        return Polygons(_first_numbers(lines, 4)[:, 1:].astype(np.int64).reshape(-1), np.full(len(lines), 3, np.int64))
    corners, sizes = list[int](), list[int]()
    for line in lines:
        words = line.split()
        size = int(words[0])
        if size < 0 or len(words) < 1 + size:
            raise ValueError(f"{size} corners announced in {line.decode('latin-1')[:40]!r}")
        sizes.append(size)
        corners += map(int, words[1 : 1 + size])
    return Polygons(np.array(corners, np.int64), np.array(sizes, np.int64))


def _first_numbers(lines: list[bytes], width: int) -> NDArray[np.float64]:
    """(n, width) the first numbers of each line."""
    columns = {len(line.split()) for line in lines}
    if min(columns, default=width) < width:
        short = next(line for line in lines if len(line.split()) < width)
        raise ValueError(f"{width} numbers expected in {short.decode('latin-1')[:40]!r}")
    if len(columns) == 1:
        try:
            return parse_numbers(b"\n".join(lines)).reshape(len(lines), -1)[:, :width]
        except ValueError:
            pass  # words among the numbers, perhaps behind those that count
    return np.array([line.split()[:width] for line in lines], np.float64).reshape(-1, width)


OFF = MeshFormat(
    "OFF", (".off",), read_off,
    "text with three coordinates a vertex (`OFF`, `COFF`, `NOFF`, `STOFF`, or no word), polygons, comments",
    "`OFF BINARY`, `4OFF`, `nOFF`",
    "colours, normals, texture coordinates",
    "trimesh 5.2, MeshLab (pymeshlab 2025.7)",
)  # fmt: skip
