"""A depth map as a triangulated sheet: few triangles where it is smooth, slit along its cuts.

The contours of `relief_contours` are edges of a constrained Delaunay triangulation. It is cut open along them, so that
both sides of a cut have vertices and depths of their own, and pixels are inserted until the sheet is within a tolerance
of the depth map. Last, the depths of all vertices are fitted to all pixels together.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, distance_transform_edt
from scipy.sparse import coo_array, diags_array
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import cg

from eigenfield.core.mesh import Mesh
from eigenfield.proxy.relief.contours import contour_chains, cut_sides, straightened
from eigenfield.proxy.relief.kernels import label_pixels, refine, wedge_moments
from eigenfield.proxy.relief.triangulation import LATTICE, constrain, restore, triangulate
from eigenfield.stereo import ReferenceView

log = logging.getLogger("eigenfield.proxy")

STRAIGHT = 0.6  # pixels that cut sides may be off their line: a straight edge leaves them up to 0.5
COARSEST = 4.0  # pixels, when the limit of triangles leaves no other way
BORDER_SHARE = 0.6  # of the limit that triangles at contours may take
PADDING = 2  # pixels
FRAME = 4  # pixels from the depth map to the rectangle round it
WEDGE = 4  # pixels round a vertex of a contour whose depths it may take
SLOPE_RIDGE = 0.03  # squared pixels
STIFF = 0.05  # weight of a vertex' present depth in the last fit, in pixels
FARTHEST = 1e-4  # of the nearest inverse depth: nothing is put farther away
OUTLIER = 3.0  # tolerances beyond which a pixel does not take part in the last fit


@dataclass(frozen=True, eq=False)
class Sheet:
    """Triangles over a depth map: x, y (n,) float64 index coordinates, d (n,) float64, faces (m, 3) int32 of positive
    area in (x, y), y down."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    d: NDArray[np.float64]
    faces: NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class _Triangulation:
    points: NDArray[np.int64]
    tri: NDArray[np.int64]
    across: NDArray[np.int64]
    fixed: NDArray[np.int64]


def make_sheet(
    d: NDArray[np.float32], valid: NDArray[np.bool_], *, cut: float, tolerance: float, limit: int | None = None
) -> Sheet:
    """Triangulate the valid part of a depth map d (h, w), slit where neighbours differ by more than `cut`.

    Outside a pixel's width of the cuts the sheet is within `tolerance` of d at every valid pixel (the last fit may
    exceed it a little), unless `limit` triangles do not suffice: then it is as near as they allow, and the log says so.
    """
    d, valid, ground = _bordered(d, valid)
    beside, below = cut_sides(d, ground, cut)
    flat = _outlined(contour_chains(beside, below), d.shape, None if limit is None else int(BORDER_SHARE * limit))
    sheet = _refined(_opened(flat, ground), d, valid, _mixed(beside, below, valid), tolerance, limit)
    return Sheet(sheet.x - PADDING, sheet.y - PADDING, sheet.d, sheet.faces)


def _bordered(
    d: NDArray[np.float32], valid: NDArray[np.bool_]
) -> tuple[NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_]]:
    """d and valid with PADDING pixels around, and the ground that the sheet is to take: a pixel more than is valid,
    so that straightening its border uncovers nothing. There d is that of the nearest valid pixel, which tells only
    where cuts go on."""
    d, valid = np.pad(d, PADDING), np.pad(valid, PADDING)
    if not valid.any():
        return d, valid, valid
    row, column = distance_transform_edt(~valid, return_distances=False, return_indices=True)
    return d[row, column], valid, binary_dilation(valid, np.ones((3, 3), np.bool_))


def _outlined(chains: list[NDArray[np.float64]], shape: tuple[int, int], limit: int | None) -> _Triangulation:
    straight = STRAIGHT
    while True:
        lines = [straightened(chain, straight) for chain in chains]
        if limit is None or straight >= COARSEST or sum(map(len, lines)) * 2 <= limit:
            break
        straight *= 1.4
    if straight > STRAIGHT:
        log.warning("contours are straightened by up to %.1f px to keep the number of triangles", straight)
    while True:
        flat, clash = _constrained(lines, shape)
        if not clash.any():
            return flat
        for index in np.flatnonzero(clash):  # lines that cross go back to the chains they came from, which do not
            lines[index] = chains[index]


def _constrained(lines: list[NDArray[np.float64]], shape: tuple[int, int]) -> tuple[_Triangulation, NDArray[np.bool_]]:
    """The triangulation with every line in it, and which lines cross another."""
    h, w = shape
    frame = [(-FRAME, -FRAME), (w + FRAME, -FRAME), (w + FRAME, h + FRAME), (-FRAME, h + FRAME)]
    points = np.rint(np.concatenate([np.array(frame, np.float64), *lines]) * LATTICE).astype(np.int64)
    sizes = np.array([len(each) for each in lines], np.int64)
    last = 4 + np.cumsum(sizes) - 1
    first = np.setdiff1d(np.arange(4, len(points)), last)
    line = np.repeat(np.arange(len(lines)), sizes - 1).astype(np.int64)
    n = len(points)
    tri, across, fixed = (np.full((2 * n, 3), value, np.int64) for value in (-1, -1, 0))
    at, alias, clash = np.zeros(n, np.int64), np.zeros(n, np.int64), np.zeros(len(lines), np.bool_)
    count = triangulate(points, tri, across, fixed, at, alias)
    constrain(points, tri, across, fixed, at, np.stack([first, first + 1], axis=1), line, alias, clash)
    if not clash.any():
        restore(points, tri, across, fixed, at, count)
    return _Triangulation(points, tri[:count], across[:count], fixed[:count]), clash


def _opened(flat: _Triangulation, valid: NDArray[np.bool_]) -> _Triangulation:
    """The triangles on valid ground, cut apart at the contours: vertices are doubled, edges there become borders."""
    owner = np.empty(valid.shape, np.int32)
    label_pixels(flat.points, flat.tri, len(flat.tri), owner)
    fixed, ground = _without_gaps(flat, owner[owner >= 0])
    votes = np.bincount(ground[owner[owner >= 0]], np.where(valid, 1, -1)[owner >= 0], ground.max() + 1)
    kept = votes[ground] > 0
    renumber = np.cumsum(kept) - 1
    across = np.where((fixed == 0) & (flat.across >= 0), flat.across, -1)
    across = np.where((across >= 0) & kept[across], renumber[across], -1)[kept]
    tri = flat.tri[kept]
    t, k = np.nonzero(across >= 0)
    u = across[t, k]
    j = np.argmax(across[u] == t[:, None], axis=1)
    one = np.r_[3 * t + (k + 1) % 3, 3 * t + (k + 2) % 3]
    other = np.r_[3 * u + (j + 2) % 3, 3 * u + (j + 1) % 3]
    vertex = _components(3 * len(tri), one, other)
    points = np.zeros((vertex.max(initial=-1) + 1, 2), np.int64)
    points[vertex] = flat.points[tri.reshape(-1)]
    return _Triangulation(points, vertex.reshape(-1, 3), across, np.zeros_like(across))


def _without_gaps(flat: _Triangulation, owners: NDArray[np.int32]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """`fixed` and each triangle's ground: what is connected, contours uncrossed. Ground without a pixel (up to half a
    one, between contours that were straightened) would be a hole: it goes to the neighbour along its longest side.

    owners: triangles with a pixel.
    """
    fixed = flat.fixed.copy()
    while True:
        t, k = np.nonzero((flat.across >= 0) & (fixed == 0))
        ground = _components(len(flat.tri), t, flat.across[t, k])
        owned = np.zeros(ground.max() + 1, np.bool_)
        owned[ground[owners]] = True
        t, k = np.nonzero((flat.across >= 0) & (fixed != 0) & ~owned[ground][:, None])
        mine, other = ground[t], ground[flat.across[t, k]]
        t, k, mine, other = (each[mine != other] for each in (t, k, mine, other))
        if not len(t):
            return fixed, ground
        sides = flat.points[flat.tri[t, (k + 1) % 3]] - flat.points[flat.tri[t, (k + 2) % 3]]
        pairs, pair = np.unique(np.stack([mine, other], axis=1), axis=0, return_inverse=True)
        pair = pair.reshape(-1)
        order = np.lexsort((-np.bincount(pair, np.hypot(*sides.T)), pairs[:, 0]))
        longest = order[np.unique(pairs[order, 0], return_index=True)[1]]
        t, k = (each[np.isin(pair, longest)] for each in (t, k))
        u = flat.across[t, k]
        fixed[t, k] = fixed[u, np.argmax(flat.across[u] == t[:, None], axis=1)] = 0


def _components(n: int, one: NDArray[np.int64], other: NDArray[np.int64]) -> NDArray[np.int64]:
    links = coo_array((np.ones(len(one), np.int8), (one, other)), shape=(n, n))
    return np.asarray(connected_components(links, directed=False)[1], np.int64)


def _mixed(beside: NDArray[np.bool_], below: NDArray[np.bool_], valid: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """(h, w) pixels at a cut between two depths (not at a border): which side of the contour they are on is open."""
    beside, below = beside & valid[:, 1:] & valid[:, :-1], below & valid[1:] & valid[:-1]
    mixed = np.zeros(valid.shape, np.bool_)
    mixed[:, 1:] |= beside
    mixed[:, :-1] |= beside
    mixed[1:] |= below
    mixed[:-1] |= below
    return mixed


def _first_depths(
    sheet: _Triangulation, d: NDArray[np.float32], valid: NDArray[np.bool_], mixed: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """(n,) of every vertex: the plane through the pixels near it on its own side of the cuts."""
    n = len(sheet.points)
    clear, near = np.zeros((n, 9)), np.zeros((n, 9))
    wedge_moments(sheet.points, sheet.tri, d, valid, mixed, WEDGE, clear, near)
    moments = np.where(clear[:, :1] > 0, clear, near)
    known = moments[:, 0] > 0
    depth = _planes(moments)
    a, b = sheet.tri[:, [0, 1, 2]].reshape(-1), sheet.tri[:, [1, 2, 0]].reshape(-1)
    while not known.all():  # slivers without a pixel take over from their neighbours
        share = np.bincount(a, known[b], n) + np.bincount(b, known[a], n)
        value = np.bincount(a, known[b] * depth[b], n) + np.bincount(b, known[a] * depth[a], n)
        fresh = ~known & (share > 0)
        if not fresh.any():
            depth[~known] = depth[known].mean() if known.any() else 0.0
            break
        depth[fresh] = value[fresh] / share[fresh]
        known |= fresh
    return depth


def _planes(moments: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) value at the origin of the planes with moments sum w (1, x, y, x x, x y, y y, d, x d, y d); few pixels in
    a row hold the slope at zero."""
    w, x, y, xx, xy, yy, d, xd, yd = moments.T
    ridge = SLOPE_RIDGE * w
    matrix = np.stack([w, x, y, x, xx + ridge, xy, y, xy, yy + ridge], axis=1).reshape(-1, 3, 3)
    matrix[w == 0] = np.eye(3)
    return np.asarray(np.linalg.solve(matrix, np.stack([d, xd, yd], axis=1)[..., None])[:, 0, 0])


def _refined(
    sheet: _Triangulation,
    d: NDArray[np.float32],
    valid: NDArray[np.bool_],
    mixed: NDArray[np.bool_],
    tolerance: float,
    limit: int | None,
) -> Sheet:
    count, vertices = len(sheet.tri), len(sheet.points)
    if count == 0:
        empty = np.zeros(0)
        return Sheet(empty, empty, empty, np.zeros((0, 3), np.int32))
    rows = max(count, min(2 * int(valid.sum()) + count, count + 4 * valid.size if limit is None else limit)) + 2

    def roomy(a: NDArray[np.int64], size: int) -> NDArray[np.int64]:
        return np.concatenate([a, np.full((size - len(a), a.shape[1]), -1, np.int64)])

    tri, across = roomy(sheet.tri, rows), roomy(sheet.across, rows)
    points = roomy(sheet.points, vertices + rows - count)
    height = np.zeros(len(points))
    height[:vertices] = _first_depths(sheet, d, valid, mixed)
    at = np.zeros(len(points), np.int64)
    at[sheet.tri.reshape(-1)] = np.repeat(np.arange(count), 3)
    fixed = np.zeros_like(tri)
    vertices, count, worst = refine(
        points, height, tri, across, fixed, at, vertices, count, d, valid, mixed, tolerance, rows - 2
    )
    if worst > tolerance:
        log.info("%d triangles leave an error of %.3g where %.3g was asked for", count, worst, tolerance)
    tri = tri[:count][tri[:count, 0] >= 0]
    height = _fitted(points, height[:vertices], tri, d, valid, mixed, tolerance)
    x, y = points[:vertices].T / LATTICE
    return Sheet(x, y, height, tri.astype(np.int32))


def _fitted(
    points: NDArray[np.int64],
    height: NDArray[np.float64],
    tri: NDArray[np.int64],
    d: NDArray[np.float32],
    valid: NDArray[np.bool_],
    mixed: NDArray[np.bool_],
    tolerance: float,
) -> NDArray[np.float64]:
    """Depths of the vertices for which the squared difference to the depth map is least, over pixels away from cuts
    that were within OUTLIER tolerances: A^T (A z - d) + STIFF (z - z0) = 0, A the barycentric coordinates of the
    pixels."""
    owner = np.empty(d.shape, np.int32)
    label_pixels(points, tri, len(tri), owner)
    y, x = np.nonzero((owner >= 0) & valid & ~mixed)
    corners = tri[owner[y, x]]
    weights = pixel_weights(points, corners, x, y)
    off = d[y, x] - (weights * height[corners]).sum(axis=1)
    used = np.abs(off) <= OUTLIER * tolerance
    corners, weights, off = corners[used], weights[used], off[used]
    rows = np.repeat(np.arange(len(off)), 3)
    A = coo_array((weights.reshape(-1), (rows, corners.reshape(-1))), shape=(len(off), len(height))).tocsr()
    normal = A.T @ A + STIFF * diags_array(np.ones(len(height)))
    change, _ = cg(normal, A.T @ off, rtol=1e-4, maxiter=200, M=diags_array(1 / normal.diagonal()))
    return np.asarray(height + np.clip(change, -OUTLIER * tolerance, OUTLIER * tolerance))


def pixel_weights(
    points: NDArray[np.int64], corners: NDArray[np.int64], x: NDArray[np.int64], y: NDArray[np.int64]
) -> NDArray[np.float64]:
    """(n, 3) barycentric coordinates of pixels x, y (n,) in the triangles of corners (n, 3)."""
    p = points[corners] - np.stack([x, y], axis=1)[:, None] * LATTICE
    one, other = np.roll(p, -1, axis=1), np.roll(p, -2, axis=1)
    area = (one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]).astype(np.float64)
    return np.asarray(area / area.sum(axis=1, keepdims=True))


def joined(sheets: Sequence[Sheet]) -> Sheet:
    """Several sheets as one."""
    starts = np.cumsum([0, *(len(sheet.x) for sheet in sheets[:-1])])
    x, y, d = (np.concatenate([getattr(sheet, name) for sheet in sheets]) for name in "xyd")
    faces = [sheet.faces + np.int32(start) for sheet, start in zip(sheets, starts, strict=True)]
    return Sheet(x, y, d, np.concatenate(faces))


def sheet_mesh(canvas: ReferenceView, sheet: Sheet) -> Mesh:
    """A sheet in the world, without UVs, counter-clockwise to the canvas's camera; nothing is put farther away than
    1 / FARTHEST times the nearest vertex."""
    nearest = canvas.offset + canvas.scale * sheet.d.max()
    d = np.maximum(sheet.d, (FARTHEST * nearest - canvas.offset) / canvas.scale)
    faces = np.ascontiguousarray(sheet.faces[:, ::-1])  # y is down: positive area is clockwise to the camera
    return Mesh(canvas.points(sheet.x, sheet.y, d).astype(np.float32), faces)


def sheet_components(faces: NDArray[np.int32], vertices: int) -> NDArray[np.int64]:
    """(m,) which of the pieces that hang together by vertices each triangle is in, in order of their first triangle."""
    f = faces.astype(np.int64)
    label = _components(vertices, np.r_[f[:, 0], f[:, 0]], np.r_[f[:, 1], f[:, 2]])[f[:, 0]]
    _, first, index = np.unique(label, return_index=True, return_inverse=True)
    return np.asarray(np.argsort(np.argsort(first))[index], np.int64)


def used_part(sheet: Sheet, faces: NDArray[np.int64] | None = None) -> Sheet:
    """Some triangles of a sheet (default: all), with only the vertices that they use."""
    kept = sheet.faces if faces is None else sheet.faces[faces]
    used, index = np.unique(kept, return_inverse=True)
    return Sheet(sheet.x[used], sheet.y[used], sheet.d[used], index.reshape(-1, 3).astype(np.int32))
