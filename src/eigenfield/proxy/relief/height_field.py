"""A depth map as a triangulated height field: few triangles where it is smooth, cut along its discontinuities.

The contours of `contours` are edges of a constrained Delaunay triangulation. It is cut open along them, so that both
sides of a cut have their own vertices and depths. Pixels are inserted until the mesh is within a tolerance of the depth
map. Finally, the depths of all vertices are fitted to all pixels together.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, distance_transform_edt
from scipy.sparse import coo_array, diags_array
from scipy.sparse.linalg import cg

from eigenfield.core.mesh import Mesh, barycentric_coordinates
from eigenfield.imaging.graph import components
from eigenfield.proxy.relief.contours import find_cut_edges, straighten_chain, trace_contours
from eigenfield.proxy.relief.kernels import label_pixels, refine_greedily, wedge_moments
from eigenfield.proxy.relief.triangulation import (
    DELAUNAY_STEPS_PER_PIXEL,
    delaunay_triangulate,
    insert_segments,
    restore_delaunay,
)
from eigenfield.stereo import ReferenceView

log = logging.getLogger("eigenfield.proxy")

# Distance of cut edges from their line: a straight edge leaves them up to 0.5 off
HEIGHT_FIELD_CONTOUR_TOLERANCE_PIXELS = 0.6
HEIGHT_FIELD_MAX_CONTOUR_TOLERANCE_PIXELS = 4.0  # the same, when the limit of triangles leaves no other way
HEIGHT_FIELD_MAX_CONTOUR_FRACTION = 0.6  # fraction of the limit that triangles at contours may take
HEIGHT_FIELD_PADDING_PIXELS = 2  # pixels added around the depth map
HEIGHT_FIELD_FRAME_PIXELS = 4  # distance of the enclosing rectangle from the depth map
HEIGHT_FIELD_WEDGE_PIXELS = 4  # distance from a contour's vertex within which it may take depths
HEIGHT_FIELD_SLOPE_RIDGE = 0.03  # ridge on the slope of a vertex plane, squared pixels
HEIGHT_FIELD_DEPTH_WEIGHT = 0.05  # weight of a vertex's present depth in the last fit, in pixels
HEIGHT_FIELD_MIN_INVERSE_RATIO = 0.0001  # smallest inverse depth, relative to the nearest vertex
HEIGHT_FIELD_OUTLIER_TOLERANCES = 3.0  # errors beyond this many tolerances do not take part in the last fit


@dataclass(frozen=True, eq=False)
class HeightFieldMesh:
    """Triangles over a depth map.

    Attributes:
        x: (n,) float64 index coordinates to the right.
        y: (n,) float64 index coordinates downwards.
        d: (n,) float64 labels.
        faces: (m, 3) int32, of positive area in (x, y), y down.
    """

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    d: NDArray[np.float64]
    faces: NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class _Triangulation:
    """The arrays of `triangulation`."""

    points: NDArray[np.int64]
    tri: NDArray[np.int64]
    adjacent: NDArray[np.int64]
    constrained: NDArray[np.int64]


def triangulate_height_field(
    d: NDArray[np.float32], valid: NDArray[np.bool_], *, cut: float, tolerance: float, limit: int | None = None
) -> HeightFieldMesh:
    """Triangulate the valid part of a depth map, cut at its discontinuities.

    Except within a pixel of the cuts, the mesh is within `tolerance` of d at every valid pixel (the last fit may exceed
    it a little). If `limit` triangles do not suffice, it is as near as they allow, and the log says so.

    Args:
        cut: Difference of neighbouring labels at which the surface is cut.
        tolerance: In labels.
        limit: Most triangles. Default: no limit.
    """
    d, valid, ground = _pad_depth(d, valid)
    beside, below = find_cut_edges(d, ground, cut)
    at_contours = None if limit is None else int(HEIGHT_FIELD_MAX_CONTOUR_FRACTION * limit)
    triangulation = _triangulate_contours(trace_contours(beside, below), d.shape, at_contours)
    mesh = _refine(_cut_open(triangulation, ground), d, valid, _cut_pixels(beside, below, valid), tolerance, limit)
    pad = HEIGHT_FIELD_PADDING_PIXELS
    return HeightFieldMesh(mesh.x - pad, mesh.y - pad, mesh.d, mesh.faces)


def _pad_depth(
    d: NDArray[np.float32], valid: NDArray[np.bool_]
) -> tuple[NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_]]:
    """d and valid with padding, and the ground that the mesh should cover.

    The ground is one pixel larger than the valid part, so that straightening its border uncovers nothing. There d is
    that of the nearest valid pixel, which only determines where cuts continue.
    """
    d, valid = np.pad(d, HEIGHT_FIELD_PADDING_PIXELS), np.pad(valid, HEIGHT_FIELD_PADDING_PIXELS)
    if not valid.any():
        return d, valid, valid
    row, column = distance_transform_edt(~valid, return_distances=False, return_indices=True)
    return d[row, column], valid, binary_dilation(valid, np.ones((3, 3), np.bool_))


def _triangulate_contours(
    chains: list[NDArray[np.float64]], shape: tuple[int, int], limit: int | None
) -> _Triangulation:
    straight = HEIGHT_FIELD_CONTOUR_TOLERANCE_PIXELS
    while True:
        lines = [straighten_chain(chain, straight) for chain in chains]
        few = limit is None or sum(map(len, lines)) * 2 <= limit
        if few or straight >= HEIGHT_FIELD_MAX_CONTOUR_TOLERANCE_PIXELS:
            break
        straight *= 1.4
    if straight > HEIGHT_FIELD_CONTOUR_TOLERANCE_PIXELS:
        log.warning("contours are straightened by up to %.1f px to keep the number of triangles", straight)
    while True:
        triangulation, clash = _constrained_delaunay(lines, shape)
        if not clash.any():
            return triangulation
        for index in np.flatnonzero(clash):  # lines that cross are replaced by their chains, which do not
            lines[index] = chains[index]


def _constrained_delaunay(
    lines: list[NDArray[np.float64]], shape: tuple[int, int]
) -> tuple[_Triangulation, NDArray[np.bool_]]:
    """The triangulation that contains every line, and which lines cross another."""
    low = -HEIGHT_FIELD_FRAME_PIXELS
    bottom, right = (side + HEIGHT_FIELD_FRAME_PIXELS for side in shape)
    frame = [(low, low), (right, low), (right, bottom), (low, bottom)]
    points = np.rint(np.concatenate([np.array(frame, np.float64), *lines]) * DELAUNAY_STEPS_PER_PIXEL).astype(np.int64)
    sizes = np.array([len(each) for each in lines], np.int64)
    last = 4 + np.cumsum(sizes) - 1
    first = np.setdiff1d(np.arange(4, len(points)), last)
    line = np.repeat(np.arange(len(lines)), sizes - 1).astype(np.int64)
    n = len(points)
    tri, adjacent, constrained = (np.full((2 * n, 3), value, np.int64) for value in (-1, -1, 0))
    incident, alias, clash = np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros(len(lines), np.bool_)
    count = delaunay_triangulate(points, tri, adjacent, constrained, incident, alias)
    segments = np.stack([first, first + 1], axis=1)
    insert_segments(points, tri, adjacent, constrained, incident, segments, line, alias, clash)
    if not clash.any():
        restore_delaunay(points, tri, adjacent, constrained, incident, count)
    return _Triangulation(points, tri[:count], adjacent[:count], constrained[:count]), clash


def _cut_open(triangulation: _Triangulation, valid: NDArray[np.bool_]) -> _Triangulation:
    """The triangles on valid ground, cut apart at the contours: vertices are duplicated, edges there become borders."""
    owner = np.empty(valid.shape, np.int32)
    label_pixels(triangulation.points, triangulation.tri, len(triangulation.tri), owner)
    constrained, ground = _close_gaps(triangulation, owner[owner >= 0])
    votes = np.bincount(ground[owner[owner >= 0]], np.where(valid, 1, -1)[owner >= 0], ground.max() + 1)
    kept = votes[ground] > 0
    renumber = np.cumsum(kept) - 1
    adjacent = np.where((constrained == 0) & (triangulation.adjacent >= 0), triangulation.adjacent, -1)
    adjacent = np.where((adjacent >= 0) & kept[adjacent], renumber[adjacent], -1)[kept]
    tri = triangulation.tri[kept]
    t, k = np.nonzero(adjacent >= 0)
    u = adjacent[t, k]
    j = np.argmax(adjacent[u] == t[:, None], axis=1)
    one = np.r_[3 * t + (k + 1) % 3, 3 * t + (k + 2) % 3]
    other = np.r_[3 * u + (j + 2) % 3, 3 * u + (j + 1) % 3]
    vertex = components(3 * len(tri), one, other).astype(np.int64)
    points = np.zeros((vertex.max(initial=-1) + 1, 2), np.int64)
    points[vertex] = triangulation.points[tri.reshape(-1)]
    return _Triangulation(points, vertex.reshape(-1, 3), adjacent, np.zeros_like(adjacent))


def _close_gaps(
    triangulation: _Triangulation, owners: NDArray[np.int32]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """`constrained`, and each triangle's ground: a component that no contour crosses.

    Ground without a pixel (up to half a pixel wide, between straightened contours) would be a hole. It is joined to the
    neighbour along its longest side. owners: triangles with a pixel.
    """
    constrained = triangulation.constrained.copy()
    while True:
        t, k = np.nonzero((triangulation.adjacent >= 0) & (constrained == 0))
        ground = components(len(triangulation.tri), t, triangulation.adjacent[t, k]).astype(np.int64)
        owned = np.zeros(ground.max() + 1, np.bool_)
        owned[ground[owners]] = True
        t, k = np.nonzero((triangulation.adjacent >= 0) & (constrained != 0) & ~owned[ground][:, None])
        mine, other = ground[t], ground[triangulation.adjacent[t, k]]
        t, k, mine, other = (each[mine != other] for each in (t, k, mine, other))
        if not len(t):
            return constrained, ground
        ends = triangulation.points[triangulation.tri]
        sides = ends[t, (k + 1) % 3] - ends[t, (k + 2) % 3]
        pairs, pair = np.unique(np.stack([mine, other], axis=1), axis=0, return_inverse=True)
        pair = pair.reshape(-1)
        order = np.lexsort((-np.bincount(pair, np.hypot(*sides.T)), pairs[:, 0]))
        longest = order[np.unique(pairs[order, 0], return_index=True)[1]]
        t, k = (each[np.isin(pair, longest)] for each in (t, k))
        u = triangulation.adjacent[t, k]
        constrained[t, k] = constrained[u, np.argmax(triangulation.adjacent[u] == t[:, None], axis=1)] = 0


def _cut_pixels(beside: NDArray[np.bool_], below: NDArray[np.bool_], valid: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(h, w) pixels at a cut between two depths (not at a border): they may lie on either side of the contour."""
    beside, below = beside & valid[:, 1:] & valid[:, :-1], below & valid[1:] & valid[:-1]
    at_cut = np.zeros(valid.shape, np.bool_)
    at_cut[:, 1:] |= beside
    at_cut[:, :-1] |= beside
    at_cut[1:] |= below
    at_cut[:-1] |= below
    return at_cut


def _initial_depths(
    mesh: _Triangulation, d: NDArray[np.float32], valid: NDArray[np.bool_], at_cut: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """(n,) depth of every vertex: the plane through the pixels near it on its own side of the cuts."""
    n = len(mesh.points)
    clear, near = np.zeros((n, 9)), np.zeros((n, 9))
    wedge_moments(mesh.points, mesh.tri, d, valid, at_cut, HEIGHT_FIELD_WEDGE_PIXELS, clear, near)
    moments = np.where(clear[:, :1] > 0, clear, near)
    known = moments[:, 0] > 0
    depth = _fit_planes(moments)
    a, b = mesh.tri[:, [0, 1, 2]].reshape(-1), mesh.tri[:, [1, 2, 0]].reshape(-1)
    while not known.all():  # vertices without a pixel take the mean of their neighbours
        share = np.bincount(a, known[b], n) + np.bincount(b, known[a], n)
        value = np.bincount(a, known[b] * depth[b], n) + np.bincount(b, known[a] * depth[a], n)
        fresh = ~known & (share > 0)
        if not fresh.any():
            depth[~known] = depth[known].mean() if known.any() else 0.0
            break
        depth[fresh] = value[fresh] / share[fresh]
        known |= fresh
    return depth


def _fit_planes(moments: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) value at the origin of the planes with moments sum w (1, x, y, x x, x y, y y, d, x d, y d).

    A ridge holds the slope at zero if there are only few pixels in a row.
    """
    w, x, y, xx, xy, yy, d, xd, yd = moments.T
    ridge = HEIGHT_FIELD_SLOPE_RIDGE * w
    matrix = np.stack([w, x, y, x, xx + ridge, xy, y, xy, yy + ridge], axis=1).reshape(-1, 3, 3)
    matrix[w == 0] = np.eye(3)
    return np.asarray(np.linalg.solve(matrix, np.stack([d, xd, yd], axis=1)[..., None])[:, 0, 0])


def _refine(
    mesh: _Triangulation,
    d: NDArray[np.float32],
    valid: NDArray[np.bool_],
    at_cut: NDArray[np.bool_],
    tolerance: float,
    limit: int | None,
) -> HeightFieldMesh:
    count, vertices = len(mesh.tri), len(mesh.points)
    if count == 0:
        empty = np.zeros(0)
        return HeightFieldMesh(empty, empty, empty, np.zeros((0, 3), np.int32))
    rows = max(count, min(2 * int(valid.sum()) + count, count + 4 * valid.size if limit is None else limit)) + 2

    def roomy(a: NDArray[np.int64], size: int) -> NDArray[np.int64]:
        return np.concatenate([a, np.full((size - len(a), a.shape[1]), -1, np.int64)])

    tri, adjacent = roomy(mesh.tri, rows), roomy(mesh.adjacent, rows)
    points = roomy(mesh.points, vertices + rows - count)
    height = np.zeros(len(points))
    height[:vertices] = _initial_depths(mesh, d, valid, at_cut)
    incident = np.zeros(len(points), np.int64)
    incident[mesh.tri.reshape(-1)] = np.repeat(np.arange(count), 3)
    constrained = np.zeros_like(tri)
    vertices, count, worst = refine_greedily(
        points, height, tri, adjacent, constrained, incident, vertices, count, d, valid, at_cut, tolerance, rows - 2
    )
    if worst > tolerance:
        log.info("%d triangles leave an error of %.3g where %.3g was asked for", count, worst, tolerance)
    tri = tri[:count][tri[:count, 0] >= 0]
    height = _fit_depths(points, height[:vertices], tri, d, valid, at_cut, tolerance)
    x, y = points[:vertices].T / DELAUNAY_STEPS_PER_PIXEL
    return HeightFieldMesh(x, y, height, tri.astype(np.int32))


def _fit_depths(
    points: NDArray[np.int64],
    height: NDArray[np.float64],
    tri: NDArray[np.int64],
    d: NDArray[np.float32],
    valid: NDArray[np.bool_],
    at_cut: NDArray[np.bool_],
    tolerance: float,
) -> NDArray[np.float64]:
    """Least-squares depths of the vertices, over pixels away from cuts that were within a few tolerances.

    A^T (A z - d) + depth_weight (z - z0) = 0, with A the barycentric coordinates of the pixels.
    """
    owner = np.empty(d.shape, np.int32)
    label_pixels(points, tri, len(tri), owner)
    y, x = np.nonzero((owner >= 0) & valid & ~at_cut)
    corners = tri[owner[y, x]]
    weights = barycentric_coordinates(points[corners], np.stack([x, y], axis=1) * DELAUNAY_STEPS_PER_PIXEL)
    off = d[y, x] - (weights * height[corners]).sum(axis=1)
    most = HEIGHT_FIELD_OUTLIER_TOLERANCES * tolerance
    used = np.abs(off) <= most
    corners, weights, off = corners[used], weights[used], off[used]
    rows = np.repeat(np.arange(len(off)), 3)
    A = coo_array((weights.reshape(-1), (rows, corners.reshape(-1))), shape=(len(off), len(height))).tocsr()
    normal = A.T @ A + HEIGHT_FIELD_DEPTH_WEIGHT * diags_array(np.ones(len(height)))
    change, _ = cg(normal, A.T @ off, rtol=1e-4, maxiter=200, M=diags_array(1 / normal.diagonal()))
    return np.asarray(height + np.clip(change, -most, most))


def join_height_fields(meshes: Sequence[HeightFieldMesh]) -> HeightFieldMesh:
    """Several meshes as one.

    Args:
        meshes: Over the same depth map.
    """
    starts = np.cumsum([0, *(len(mesh.x) for mesh in meshes[:-1])])
    x, y, d = (np.concatenate([getattr(mesh, name) for mesh in meshes]) for name in "xyd")
    faces = [mesh.faces + np.int32(start) for mesh, start in zip(meshes, starts, strict=True)]
    return HeightFieldMesh(x, y, d, np.concatenate(faces))


def height_field_to_world(reference: ReferenceView, mesh: HeightFieldMesh) -> Mesh:
    """A mesh in the world, without UVs, counter-clockwise for the reference camera.

    Nothing is farther than 1 / `min_inverse_ratio` times the nearest vertex.
    """
    nearest = reference.offset + reference.scale * mesh.d.max()
    d = np.maximum(mesh.d, (HEIGHT_FIELD_MIN_INVERSE_RATIO * nearest - reference.offset) / reference.scale)
    faces = np.ascontiguousarray(mesh.faces[:, ::-1])  # y is down: positive area is clockwise for the camera
    return Mesh(reference.points(mesh.x, mesh.y, d).astype(np.float32), faces)


def extract_faces(mesh: HeightFieldMesh, faces: NDArray[np.int64] | None = None) -> HeightFieldMesh:
    """Some triangles of a mesh, with only the vertices that they use.

    Args:
        faces: Which. Default: all.
    """
    kept = mesh.faces if faces is None else mesh.faces[faces]
    used, index = np.unique(kept, return_inverse=True)
    return HeightFieldMesh(mesh.x[used], mesh.y[used], mesh.d[used], index.reshape(-1, 3).astype(np.int32))
