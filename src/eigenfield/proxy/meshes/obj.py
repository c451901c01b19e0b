"""Wavefront OBJ: geometry and texture coordinates, nothing else.

trimesh (5.2) is not used here. It takes index 0 for the first vertex, counts relative indices from the end of the file,
silently drops UVs if one index is out of range, and splits the mesh where the material changes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import ProxyError
from eigenfield.proxy.meshes.polygons import Polygons, split_seams, triangulate_polygons


def read_obj(data: bytes) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64] | None]:
    """Geometry and texture coordinates of an OBJ file.

    Args:
        data: The file.

    Returns:
        (n, 3) positions, (m, 3) faces and, if every corner has one, (n, 2) UVs with v down.

    Raises:
        ProxyError: `proxy-index-range`, with the number of the line.
        ValueError: Damaged data, with the number of the line.
    """
    positions: list[tuple[float, float, float]] = []
    texels: list[tuple[float, float]] = []
    corners: list[tuple[int, int]] = []  # vertex and texture coordinate, counted from 0; -1: none
    sizes: list[int] = []
    largest = [(0, 0), (0, 0)]  # the highest vertex and texture coordinate index, and its line
    if b"\0" in data:
        raise ValueError("binary data")
    lines = enumerate(data.decode("utf-8", errors="replace").splitlines(), 1)
    for number, text in lines:
        line = text
        while line.endswith("\\"):  # a statement that continues in the next line
            line = line[:-1] + next(lines, (0, ""))[1]
        words = line.split()
        try:
            match words:
                case ["v", x, y, z, *_]:
                    positions.append((float(x), float(y), float(z)))
                case ["vt", u, *rest] if not rest or rest[0].startswith("#"):
                    texels.append((float(u), 0.0))
                case ["vt", u, v, *_]:
                    texels.append((float(u), 1.0 - float(v)))
                case ["v", *_] | ["vt"]:
                    raise ValueError("numbers are missing")
                case ["f", *tokens]:
                    sizes.append(0)
                    for token in tokens:
                        if token.startswith("#"):
                            break
                        fields = token.split("/")
                        vertex = _index(fields[0], len(positions))
                        texel = _index(fields[1], len(texels)) if len(fields) > 1 and fields[1] else -1
                        largest = [max(largest[0], (vertex, number)), max(largest[1], (texel, number))]
                        corners.append((vertex, texel))
                        sizes[-1] += 1
                case _:
                    pass
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
        return vertices, triangulate_polygons(polygons, None)[0], None
    origin, faces, uv = split_seams(*triangulate_polygons(polygons, np.array(texels, np.float64)[table[:, 1]]))
    return vertices[origin], faces, uv


def _index(word: str, count: int) -> int:
    """An index counted from 0: positive ones count from 1, negative ones back from the latest."""
    index = int(word)
    if index > 0:
        return index - 1
    if index == 0 or -index > count:
        raise IndexError(f"index {index} names nothing")
    return count + index
