"""The proxy: the paper's {V, W, U}, a triangle mesh with one UV a vertex."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.brief import brief_repr


@dataclass(frozen=True, eq=False)
class Mesh:
    """A triangle mesh. Vertices on a seam are doubled: a vertex has one UV.

    Attributes:
        vertices: V, (n, 3) float32 world positions.
        faces: W, (m, 3) int32 indices into `vertices`; counter-clockwise seen from outside, if the outside is known.
        uv: U, (n, 2) float32 in [0, 1], origin at the top left of the atlas and v down (glTF); None before unwrapping.
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.int32]
    uv: NDArray[np.float32] | None = None

    __repr__ = brief_repr

    def part(self, faces: NDArray[np.bool_] | slice) -> Mesh:
        """Some of its faces, as NumPy picks them, with the vertices that they have."""
        used, corners = np.unique(self.faces[faces], return_inverse=True)
        uv = None if self.uv is None else self.uv[used]
        return Mesh(self.vertices[used], corners.reshape(-1, 3).astype(np.int32), uv)

    def face_normals(self) -> NDArray[np.float64]:
        """(m, 3) unit normals by the right-hand rule; zero for triangles without area."""
        return _unit(area_normals(self.vertices[self.faces].astype(np.float64)))

    def face_areas(self) -> NDArray[np.float64]:
        """(m,) areas of the triangles, squared world units."""
        return triangle_areas(self.vertices[self.faces].astype(np.float64))


def area_normals(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m, 3) normals of triangles by the right-hand rule, as long as twice the area, corners (m, 3, 3)."""
    return np.asarray(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))


def vertex_normals(vertices: NDArray[np.float64], faces: NDArray[np.signedinteger[Any]]) -> NDArray[np.float64]:
    """(n, 3) unit normals of vertices (n, 3): the means of those of their triangles (m, 3), weighted by area."""
    normals = np.zeros_like(vertices)
    by_area = area_normals(vertices[faces])
    for corner in range(3):
        np.add.at(normals, faces[:, corner], by_area)
    return _unit(normals)


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n, 3) vectors of length 1; zero where they are zero."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0)


def triangle_areas(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m,) areas of triangles in space, corners (m, 3, 3)."""
    return np.asarray(np.linalg.norm(area_normals(corners), axis=1) / 2)


def signed_areas(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """(m,) areas of triangles in the plane, corners (m, 3, 2): positive where they turn from x to y."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return np.asarray((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2)


def barycentric_coordinates(
    corners: NDArray[np.int64] | NDArray[np.float64], points: NDArray[np.int64]
) -> NDArray[np.float64]:
    """(n, 3) barycentric coordinates of points (n, 2) in triangles of the plane with area, corners (n, 3, 2)."""
    p = corners - points[:, None]
    one, other = np.roll(p, -1, axis=1), np.roll(p, -2, axis=1)
    area = (one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]).astype(np.float64)
    return np.asarray(area / area.sum(axis=1, keepdims=True))
