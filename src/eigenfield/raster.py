"""The one rasteriser: depth maps of cameras, texel positions in UV space, and drawing.

Two-dimensional homogeneous rasterisation (Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous
Coordinates", 1997): the edge functions come from the adjugate of the matrix of the three homogeneous corners, so
triangles that reach behind the camera need no clipping, and their values at a pixel are proportional to the
perspective-correct barycentric coordinates. Rows are drawn in fixed bands, each by one thread.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.camera import Camera
from eigenfield.jit import kernel
from eigenfield.mesh import Mesh
from eigenfield.parallel import parallel_map, pieces

BAND = 64  # rows a thread draws at a time
EDGE_SLACK = 1e-7  # of the sum of edge functions: a pixel centre on a shared edge belongs to both triangles


@dataclass(frozen=True, eq=False)
class Raster:
    """What is nearest at each pixel centre.

    face: (H, W) int32, the triangle, -1 where there is none.
    inverse_depth: (H, W) float32, 1 / depth along z, 0 where there is no surface.
    edges: (m, 3, 3) float64; row i of edges[f] at (x, y, 1) is proportional to corner i's barycentric coordinate,
        the three sum to 1 / depth.
    """

    face: NDArray[np.int32]
    inverse_depth: NDArray[np.float32]
    edges: NDArray[np.float64]


@kernel()
def edge_functions(corners, faces, edges):  # type: ignore[no-untyped-def]
    """corners (n, 3) homogeneous pixels (x w, y w, w); edges (m, 3, 3) out, zero for a triangle seen edge-on.

    With M = [c0 c1 c2], M b = (x, y, 1) / (1/w ...): b = M^-1 (x, y, 1) are barycentric coordinates over depth.
    """
    for f in range(faces.shape[0]):
        x0, y0, w0 = corners[faces[f, 0]]
        x1, y1, w1 = corners[faces[f, 1]]
        x2, y2, w2 = corners[faces[f, 2]]
        a00 = y1 * w2 - y2 * w1
        a01 = x2 * w1 - x1 * w2
        a02 = x1 * y2 - x2 * y1
        a10 = y2 * w0 - y0 * w2
        a11 = x0 * w2 - x2 * w0
        a12 = x2 * y0 - x0 * y2
        a20 = y0 * w1 - y1 * w0
        a21 = x1 * w0 - x0 * w1
        a22 = x0 * y1 - x1 * y0
        determinant = x0 * a00 + y0 * a01 + w0 * a02
        scale = 0.0 if determinant == 0 else 1.0 / determinant
        edges[f, 0, 0] = a00 * scale
        edges[f, 0, 1] = a01 * scale
        edges[f, 0, 2] = a02 * scale
        edges[f, 1, 0] = a10 * scale
        edges[f, 1, 1] = a11 * scale
        edges[f, 1, 2] = a12 * scale
        edges[f, 2, 0] = a20 * scale
        edges[f, 2, 1] = a21 * scale
        edges[f, 2, 2] = a22 * scale


@kernel()
def draw_band(corners, faces, edges, first, last, slack, face, inverse_depth):  # type: ignore[no-untyped-def]
    """Rows [first, last) of all triangles into face and inverse_depth (H, W), nearest first kept; ties go to the
    lower index. A triangle in front of the camera is bounded by its corners; one that reaches behind by the band."""
    width = face.shape[1]
    for f in range(faces.shape[0]):
        i0, i1, i2 = faces[f]
        w0, w1, w2 = corners[i0, 2], corners[i1, 2], corners[i2, 2]
        if w0 <= 0 and w1 <= 0 and w2 <= 0:
            continue
        e = edges[f]
        if e[0, 0] == 0 and e[0, 1] == 0 and e[0, 2] == 0:
            continue
        top, bottom, left, right = first, last, 0, width
        if w0 > 0 and w1 > 0 and w2 > 0:
            y0, y1, y2 = corners[i0, 1] / w0, corners[i1, 1] / w1, corners[i2, 1] / w2
            low, high = min(y0, y1, y2), max(y0, y1, y2)
            if high < first or low > last:
                continue
            top = max(top, int(np.ceil(low - 0.5 - 1e-6)))
            bottom = min(bottom, int(np.floor(high - 0.5 + 1e-6)) + 1)
            x0, x1, x2 = corners[i0, 0] / w0, corners[i1, 0] / w1, corners[i2, 0] / w2
            low, high = min(x0, x1, x2), max(x0, x1, x2)
            if high < 0 or low > width:
                continue
            left = max(left, int(np.ceil(low - 0.5 - 1e-6)))
            right = min(right, int(np.floor(high - 0.5 + 1e-6)) + 1)
        for row in range(top, bottom):
            y = row + 0.5
            c0 = e[0, 1] * y + e[0, 2]
            c1 = e[1, 1] * y + e[1, 2]
            c2 = e[2, 1] * y + e[2, 2]
            for column in range(left, right):
                x = column + 0.5
                b0 = e[0, 0] * x + c0
                b1 = e[1, 0] * x + c1
                b2 = e[2, 0] * x + c2
                q = b0 + b1 + b2
                limit = -slack * q
                if q > 0 and b0 >= limit and b1 >= limit and b2 >= limit and q > inverse_depth[row, column]:
                    inverse_depth[row, column] = q
                    face[row, column] = f


def homogeneous_corners(camera: Camera, vertices: NDArray[np.float32]) -> NDArray[np.float64]:
    """(n, 3) float64: vertices as homogeneous pixels of a camera, the third entry the depth along z."""
    matrix = camera.matrix
    return np.ascontiguousarray(vertices.astype(np.float64) @ matrix[:, :3].T + matrix[:, 3])


def rasterise(corners: NDArray[np.float64], faces: NDArray[np.int32], width: int, height: int) -> Raster:
    """Draw triangles given by (n, 3) homogeneous pixel corners; see `Raster` for what comes back."""
    edges = np.empty((len(faces), 3, 3))
    edge_functions(corners, faces, edges)
    face = np.full((height, width), -1, np.int32)
    inverse_depth = np.zeros((height, width), np.float32)
    parallel_map(
        lambda band: draw_band(corners, faces, edges, band[0], band[1], EDGE_SLACK, face, inverse_depth),
        pieces(height, BAND),
    )
    return Raster(face, inverse_depth, edges)


def rasterise_view(mesh: Mesh, camera: Camera) -> Raster:
    """The mesh as a camera sees it, at the camera's own size."""
    return rasterise(homogeneous_corners(camera, mesh.vertices), mesh.faces, camera.width, camera.height)


def rasterise_atlas(mesh: Mesh, width: int, height: int) -> Raster:
    """The mesh laid out in its atlas: texel (row, column) has its centre at ((column + 0.5) / W, (row + 0.5) / H)."""
    assert mesh.uv is not None
    corners = np.ones((len(mesh.uv), 3))
    corners[:, :2] = mesh.uv.astype(np.float64) * (width, height)
    return rasterise(corners, mesh.faces, width, height)
