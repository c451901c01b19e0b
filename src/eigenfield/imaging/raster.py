"""The one rasteriser: depth maps of cameras, texel positions in UV space, and drawing.

Two-dimensional homogeneous rasterisation (Olano and Greer, "Triangle Scan Conversion using 2D Homogeneous
Coordinates", 1997): the edge functions come from the adjugate of the matrix of the three homogeneous corners, so
triangles that reach behind the camera need no clipping, and their values at a pixel are proportional to the
perspective-correct barycentric coordinates. Triangles are sorted into fixed bands of rows, each drawn by one thread;
within a row an edge is crossed once, so the pixels of a triangle are a span whose ends are solved for, not searched.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.runtime.jit import kernel
from eigenfield.runtime.parallel import parallel_map, pieces

RASTER_BAND_ROWS = 64  # that a thread draws at a time
RASTER_SET_UP_TRIANGLES = 8192  # that a thread sets up at a time
RASTER_EDGE_SLACK_FRACTION = 1e-7  # of the sum of edge functions: a centre on a shared edge is in both triangles
RASTER_BOUND_SLACK_PIXELS = 1e-6  # by which a bounding box is widened
RASTER_FAR_PIXELS = 1e30  # the end of a span that an edge does not bound

Band = tuple[tuple[int, int], NDArray[np.int32]]  # rows [first, last), and the triangles that they show


@dataclass(frozen=True, eq=False)
class Raster:
    """The nearest triangle at each pixel centre.

    Attributes:
        face: (H, W) int32, the triangle, -1 where there is none.
        inverse_depth: (H, W) float32, 1 / depth along z, 0 where there is no surface.
        edges: (m, 3, 3) float64; row i of edges[f] at (x, y, 1) is proportional to corner i's barycentric coordinate,
            the three sum to 1 / depth.
    """

    face: NDArray[np.int32]
    inverse_depth: NDArray[np.float32]
    edges: NDArray[np.float64]

    def corner_shares(self, row: NDArray[np.intp], column: NDArray[np.intp]) -> NDArray[np.float64]:
        """(n, 3) barycentric coordinates of pixel centres in the triangles that are there: each has one."""
        at = np.stack([column + 0.5, row + 0.5, np.ones(len(row))], axis=1)
        over_depth = np.einsum("nkx,nx->nk", self.edges[self.face[row, column]], at)
        return np.asarray(over_depth / over_depth.sum(axis=1, keepdims=True))


@kernel()
def edge_functions(corners, faces, first, last, edges):
    """Compute the edge functions of triangles.

    With M = [c0 c1 c2] and b the barycentric coordinates over depth, M b = (x, y, 1): b = M^-1 (x, y, 1). They are zero
    for a triangle that is seen edge-on, and for one that is wholly behind the camera.

    Args:
        corners: (n, 3) homogeneous pixels (x w, y w, w).
        faces: (m, 3) indices of corners.
        edges: (m, 3, 3) result.
    """
    for f in range(first, last):
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
        behind = w0 <= 0 and w1 <= 0 and w2 <= 0
        scale = 0.0 if determinant == 0 or behind else 1.0 / determinant
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
def project_corners(corners, pixels):
    """Project homogeneous corners (n, 3) into pixels (n, 2), the result; meaningless where depth is not positive."""
    for i in range(corners.shape[0]):
        pixels[i, 0] = corners[i, 0] / corners[i, 2]
        pixels[i, 1] = corners[i, 1] / corners[i, 2]


@kernel(inline=True)
def clamped_ceil(low, size):
    """`low` rounded up, within 0 and `size`."""
    return np.int32(np.ceil(min(max(low, 0.0), size)))


@kernel(inline=True)
def clamped_floor(high, size):
    """`high` rounded down, within 0 and `size`."""
    return np.int32(np.floor(min(max(high, 0.0), size)))


@kernel()
def bound_faces(corners, pixels, faces, edges, width, height, slack, first, last, bounds):
    """Bound the pixels [top, bottom) x [left, right) that triangles may cover.

    A triangle that reaches behind the camera is bounded by the picture; one that covers nothing gets zeros.

    Args:
        corners: (n, 3) homogeneous pixels.
        pixels: (n, 2) of `project_corners`, so that no corner is divided for each of its triangles.
        faces: (m, 3) indices of corners.
        slack: Pixels by which bounds are widened.
        bounds: (m, 4) int32 result.
    """
    columns, rows, more = float(width), float(height), 0.5 + slack
    for f in range(first, last):
        i, j, k = np.uintp(faces[f, 0]), np.uintp(faces[f, 1]), np.uintp(faces[f, 2])
        top, bottom, left, right = np.int32(0), np.int32(0), np.int32(0), np.int32(0)
        if not ((edges[f, 0, 0] == 0) & (edges[f, 0, 1] == 0) & (edges[f, 0, 2] == 0)):
            if (corners[i, 2] > 0) & (corners[j, 2] > 0) & (corners[k, 2] > 0):
                x0, x1, x2 = pixels[i, 0], pixels[j, 0], pixels[k, 0]
                y0, y1, y2 = pixels[i, 1], pixels[j, 1], pixels[k, 1]
                top, bottom = clamped_ceil(min(y0, y1, y2) - more, rows), clamped_floor(max(y0, y1, y2) + more, rows)
                left = clamped_ceil(min(x0, x1, x2) - more, columns)
                right = clamped_floor(max(x0, x1, x2) + more, columns)
                if (top >= bottom) | (left >= right):
                    top, bottom, left, right = np.int32(0), np.int32(0), np.int32(0), np.int32(0)
            else:
                bottom, right = np.int32(height), np.int32(width)
        bounds[f, 0], bounds[f, 1], bounds[f, 2], bounds[f, 3] = top, bottom, left, right


@kernel()
def sort_into_bands(bounds, band, starts):
    """Sort triangles into bands of rows.

    Args:
        bounds: (m, 4) of `bound_faces`.
        starts: (bands + 1,) int64 result.

    Returns:
        Triangles in rising order in each band: those of band b are listing[starts[b] : starts[b + 1]].
    """
    starts[:] = 0
    for f in range(bounds.shape[0]):
        if bounds[f, 1] > bounds[f, 0]:
            for b in range(bounds[f, 0] // band, (bounds[f, 1] - 1) // band + 1):
                starts[b + 1] += 1
    for b in range(1, starts.shape[0]):
        starts[b] += starts[b - 1]
    listing = np.empty(starts[-1], np.int32)
    place = starts.copy()
    for f in range(bounds.shape[0]):
        if bounds[f, 1] > bounds[f, 0]:
            for b in range(bounds[f, 0] // band, (bounds[f, 1] - 1) // band + 1):
                listing[place[b]] = f
                place[b] += 1
    return listing


@kernel()
def edge_span(slope, along, constant):
    """The span where slope x + along y + constant >= 0 on row y: x >= a y + b and x <= c y + d, as a, b, c, d.

    An edge bounds the span on one side; the other end is far away. An edge along the rows takes all or nothing.
    """
    if slope > 0:
        root = -1.0 / slope
        return along * root, constant * root, 0.0, RASTER_FAR_PIXELS
    if slope < 0:
        root = -1.0 / slope
        return 0.0, -RASTER_FAR_PIXELS, along * root, constant * root
    return -RASTER_FAR_PIXELS * along, -RASTER_FAR_PIXELS * constant, 0.0, RASTER_FAR_PIXELS


@kernel()
def edge_spans(e, slack):
    """For edge functions b_i in e (3, 3) with sum q: `edge_span` of each b_i + slack q, and q's coefficients."""
    qx, qy, qc = e[0, 0] + e[1, 0] + e[2, 0], e[0, 1] + e[1, 1] + e[2, 1], e[0, 2] + e[1, 2] + e[2, 2]
    return (
        edge_span(e[0, 0] + slack * qx, e[0, 1] + slack * qy, e[0, 2] + slack * qc),
        edge_span(e[1, 0] + slack * qx, e[1, 1] + slack * qy, e[1, 2] + slack * qc),
        edge_span(e[2, 0] + slack * qx, e[2, 1] + slack * qy, e[2, 2] + slack * qc),
        (qx, qy, qc),
    )


@kernel()
def row_span(a, b, c, y, first, last):
    """The columns [left, right) within [first, last) of the row at y, from the `edge_spans` a, b, c."""
    left = max(max(a[0] * y + a[1], b[0] * y + b[1]), max(c[0] * y + c[1], first + 0.5))
    right = min(min(a[2] * y + a[3], b[2] * y + b[3]), min(c[2] * y + c[3], last - 0.5))
    if not left <= right:
        return first, first
    return int(np.ceil(left - 0.5)), int(np.floor(right + 0.5))


@kernel()
def draw_band(edges, bounds, listing, first, last, slack, face, inverse_depth):
    """Draw triangles into a band of rows. The nearest one is kept; ties go to the lower index.

    A pixel is inside where b_i + slack q >= 0 for the three edge functions b_i and their sum q, all linear in x along
    a row: each bounds the span from one side.

    Args:
        bounds: (m, 4) of `bound_faces`.
        listing: Triangles of this band.
        slack: Fraction of q.
        face: (H, W) result.
        inverse_depth: (H, W) result.
    """
    face[first:last] = -1
    inverse_depth[first:last] = 0
    for f in listing:
        a, b, c, q = edge_spans(edges[f], slack)
        for row in range(max(first, bounds[f, 0]), min(last, bounds[f, 1])):
            y = row + 0.5
            start = q[1] * y + q[2]
            left, right = row_span(a, b, c, y, bounds[f, 2], bounds[f, 3])
            for column in range(left, right):
                near = np.float32(q[0] * (column + 0.5) + start)
                if near > inverse_depth[row, column]:
                    inverse_depth[row, column] = near
                    face[row, column] = f


def rasterise(corners: NDArray[np.float64], faces: NDArray[np.int32], width: int, height: int) -> Raster:
    """Draw triangles.

    Args:
        corners: (n, 3) homogeneous pixels.
    """
    edges, pixels = np.empty((len(faces), 3, 3)), np.empty((len(corners), 2))
    bounds = np.empty((len(faces), 4), np.int32)
    face, inverse_depth = np.empty((height, width), np.int32), np.empty((height, width), np.float32)

    def draw(band: Band) -> None:
        rows, triangles = band
        draw_band(edges, bounds, triangles, *rows, RASTER_EDGE_SLACK_FRACTION, face, inverse_depth)

    parallel_map(draw, set_up_bands(corners, faces, width, height, edges, pixels, bounds))
    return Raster(face, inverse_depth, edges)


def set_up_bands(
    corners: NDArray[np.float64],
    faces: NDArray[np.int32],
    width: int,
    height: int,
    edges: NDArray[np.float64],
    pixels: NDArray[np.float64],
    bounds: NDArray[np.int32],
    slack: float = 0.0,
    band: int = RASTER_BAND_ROWS,
) -> list[Band]:
    """Compute the edge functions and bounds of triangles, and sort them into bands of rows.

    Args:
        corners: (n, 3) homogeneous pixels.
        edges: (m, 3, 3), written.
        pixels: (n, 2) of `project_corners`, written.
        bounds: (m, 4) of `bound_faces`, written.
        slack: Pixels by which bounds are widened, for samples beside the middles of pixels.

    Returns:
        For each band its triangles in rising order.
    """
    project_corners(corners, pixels)

    def set_up(part: tuple[int, int]) -> None:
        edge_functions(corners, faces, *part, edges)
        bound_faces(corners, pixels, faces, edges, width, height, RASTER_BOUND_SLACK_PIXELS + slack, *part, bounds)

    parallel_map(set_up, pieces(len(faces), RASTER_SET_UP_TRIANGLES))
    bands = pieces(height, band)
    starts = np.empty(len(bands) + 1, np.int64)
    listing = sort_into_bands(bounds, band, starts)
    return [(rows, listing[starts[i] : starts[i + 1]]) for i, rows in enumerate(bands)]


def rasterise_view(mesh: Mesh, camera: Camera) -> Raster:
    """The mesh as a camera sees it, at the camera's own size."""
    return rasterise(camera.homogeneous(mesh.vertices), mesh.faces, camera.width, camera.height)


def rasterise_atlas(mesh: Mesh, width: int, height: int) -> Raster:
    """The mesh laid out in its atlas: texel (row, column) has its centre at ((column + 0.5) / W, (row + 0.5) / H)."""
    assert mesh.uv is not None
    corners = np.ones((len(mesh.uv), 3))
    corners[:, :2] = mesh.uv.astype(np.float64) * (width, height)
    return rasterise(corners, mesh.faces, width, height)


def unproject(
    camera: Camera, row: NDArray[np.int64], column: NDArray[np.int64], inverse_depth: NDArray[np.float32]
) -> NDArray[np.float64]:
    """(n, 3) the points in the middles of pixels.

    Args:
        inverse_depth: (n,) of `Raster`, above 0.
    """
    rays = np.linalg.solve(camera.K, np.stack([column + 0.5, row + 0.5, np.ones(len(row))]))
    return np.asarray((rays / inverse_depth - camera.t[:, None]).T @ camera.R)
