"""Wavefront OBJ: geometry and texture coordinates, nothing else.

Relative indices count from where they stand, and a material or a group does not cut the mesh.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eigenfield.core.errors import ProxyError
from eigenfield.proxy.meshes.formats import MeshFormat, RawMesh
from eigenfield.proxy.meshes.polygons import Polygons, split_seams, triangulate_polygons


def read_obj(data: bytes, path: Path) -> RawMesh:
    """Geometry and texture coordinates of an OBJ file.

    Raises:
        ProxyError: `proxy-index-range`, with the number of the line; `proxy-polygon`.
        ValueError: Damaged data, with the number of the line.
    """
    positions: list[tuple[float, float, float]] = []
    texels: list[tuple[float, float]] = []
    corners: list[tuple[int, int]] = []  # vertex and texture coordinate, counted from 0; -1: none
    sizes: list[int] = []
    largest = [(-1, 0), (-1, 0)]  # the highest vertex and texture coordinate index, and its line
    if b"\0" in data:
        raise ValueError("binary data")
    lines = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n").split(b"\n")
    for number, line in enumerate(lines, 1):
        words = line.split()
        if not words or words[0] not in (b"v", b"vt", b"f"):
            continue
        following = number
        while b"#" not in line and line.rstrip().endswith(b"\\"):  # a statement goes on in a line of numbers
            line = line.rstrip()[:-1]
            if following == len(lines) or lines[following].strip()[:1].isalpha():
                break
            line += b" " + lines[following]
            following += 1
        if following > number or b"#" in line:
            words = line.split(b"#")[0].split()
        try:
            match words:
                case [b"v", x, y, z, *_]:
                    positions.append((float(x), float(y), float(z)))
                case [b"vt", u]:
                    texels.append((float(u), 0.0))
                case [b"vt", u, v, *_]:
                    texels.append((float(u), 1.0 - float(v)))
                case [b"v", *_] | [b"vt"]:
                    raise ValueError("numbers are missing")
                case [b"f", *tokens]:
                    sizes.append(0)
                    for token in tokens:
                        fields = token.split(b"/")
                        vertex = _index(fields[0], len(positions))
                        texel = _index(fields[1], len(texels)) if len(fields) > 1 and fields[1] else -1
                        if vertex > largest[0][0]:
                            largest[0] = vertex, number
                        if texel > largest[1][0]:
                            largest[1] = texel, number
                        corners.append((vertex, texel))
                        sizes[-1] += 1
        except ValueError as error:
            raise ValueError(f"line {number}: {error}") from error
        except IndexError as error:
            raise ProxyError("proxy-index-range", f"line {number}: {error}", remedy="export it again") from error
    for what, (index, number), count in (
        ("vertex", largest[0], len(positions)),
        ("texture coordinate", largest[1], len(texels)),
    ):
        if index >= max(count, 1):
            raise ProxyError(
                "proxy-index-range", f"line {number}: {what} {index + 1} of {count}", remedy="export it again"
            )
    vertices = np.array(positions, np.float64).reshape(-1, 3)
    table = np.array(corners, np.int64).reshape(-1, 2)
    polygons = Polygons(table[:, 0], np.array(sizes, np.int64))
    if len(table) == 0 or (table[:, 1] < 0).any():
        return RawMesh(vertices, triangulate_polygons(polygons, None, vertices)[0], None)
    uv = np.array(texels, np.float64)[table[:, 1]]
    origin, faces, uv = split_seams(*triangulate_polygons(polygons, uv, vertices))
    return RawMesh(vertices[origin], faces, uv)


def _index(word: bytes, count: int) -> int:
    """An index counted from 0: positive ones count from 1, negative ones back from the latest."""
    index = int(word)
    if index > 0:
        return index - 1
    if index == 0 or -index > count:
        raise IndexError(f"index {index} names nothing")
    return count + index


OBJ = MeshFormat(
    "Wavefront OBJ", (".obj",), read_obj,
    "`v`, `vt` and `f` with indices of every form, polygons, statements that a backslash continues; UVs if every "
    "corner has them",
    "indices that name nothing and lines that make no sense, with their numbers",
    "materials, groups, normals, colours, lines, curves",
    "trimesh 5.2, Blender 5.0 (bpy), MeshLab (pymeshlab 2025.7), eigenfield",
)  # fmt: skip
