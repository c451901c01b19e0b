"""A surface by visibility: what cameras see through is empty, what lies behind what they see is full.

The pixels of all depth maps are merged into the vertices of a Delaunay triangulation. Each line of sight votes for free
tetrahedra in front of its vertex and for a full one behind it, softly within the noise of depth. The surface is the
minimal cut between free and full ones, where a face also costs the more, the less it looks like one of a Delaunay
triangulation of the surface. It closes where few points support it: Labatut, Pons and Keriven, "Robust and Efficient
Surface Reconstruction from Range Data", 2009.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay, KDTree

from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.surface.fusion import (
    DepthView,
    OrientedPoints,
    StackedViews,
    join_points,
    sort_cells,
    stack_views,
    subsample_points,
)
from eigenfield.proxy.surface.neighbours import project_inside
from eigenfield.proxy.surface.visibility_kernels import SOURCE, back_slots, cast_votes, cut
from eigenfield.proxy.topology import remove_unused_vertices
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.proxy")

# Chosen on the cube
VISIBILITY_MAX_PIXELS = 800_000  # pixels of all depth maps together that are merged, approximately
VISIBILITY_MAX_VERTICES = 100_000  # vertices that they are merged into, at most
VISIBILITY_PIXELS_PER_VERTEX = 32  # and at most one for this many pixels
VISIBILITY_CELL_GROWTH_POWER = 0.4  # how fast cells grow until few enough vertices remain
# How far behind its vertex a line of sight votes for a full tetrahedron, in units of the noise
VISIBILITY_BEHIND_NOISES = 3.0
VISIBILITY_FACE_WEIGHT = 1.0  # cost of a face of the worst shape, in lines of sight
VISIBILITY_CAPACITY_SCALE = 1000.0  # costs are whole multiples of one over this, so that sums are exact
VISIBILITY_SMOOTHING_ROUNDS = 5  # of the cut, whose faces are as rough as the noise of depth
VISIBILITY_BOX_SIZES = 1.0  # room around vertices and cameras, in units of their extent
VISIBILITY_SAMPLE_PIXELS = 40_000  # pixels of a view in which the surface is sampled
# Between a sample's normal and its ray. What is seen more obliquely joins what is near to what is far
VISIBILITY_MIN_COSINE = 0.3
VISIBILITY_SUPPORT_SPACINGS = 4.0  # a sample this near to a fused point adds nothing, in spacings
VISIBILITY_MAX_WEAK_POINTS = 100_000  # samples that are added, at most
# Samples farther outside of the box of the fused points are left out, in units of its size
VISIBILITY_MARGIN_SIZES = 0.25


def add_weak_points(
    fused: OrientedPoints, views: Sequence[DepthView], tolerance: float, *, progress: Progress | None = None
) -> OrientedPoints:
    """Fused points, and samples of the surface by visibility where views see it far from any of them.

    Args:
        fused: Points that several views confirm.
        tolerance: Relative noise of their depths.
    """
    report = progress or (lambda stage, done, total: None)
    report("visibility", 0, 1)
    mesh = visible_surface(views, tolerance)
    seen = np.unique(_visible_samples(mesh, views)[1])  # without those that join near and far: smoothing would, too
    samples, _ = _visible_samples(_smoothed(remove_unused_vertices(Mesh(mesh.vertices, mesh.faces[seen]))), views)
    size = np.ptp(fused.positions, axis=0).max() * VISIBILITY_MARGIN_SIZES
    low, high = fused.positions.min(axis=0) - size, fused.positions.max(axis=0) + size
    distance, nearest = KDTree(fused.positions).query(samples.positions)
    reach = VISIBILITY_SUPPORT_SPACINGS * np.maximum(fused.spacing[nearest], samples.spacing / 2)
    weak = (distance > reach) & ((samples.positions > low) & (samples.positions < high)).all(axis=1)
    added = subsample_points(samples[weak], VISIBILITY_MAX_WEAK_POINTS)
    report("visibility", 1, 1)
    log.info("visibility: %d points where few views agree", len(added))
    return join_points(fused, added)


def visible_surface(views: Sequence[DepthView], tolerance: float) -> Mesh:
    """The minimal cut between what cameras see through and what lies behind what they see.

    Args:
        tolerance: Relative noise of their depths.
    """
    vertices, line_vertex, line_view = _merge_pixels(views)
    centres = np.array([view.camera.centre for view in views])
    distance = np.full(len(vertices), np.inf)
    np.minimum.at(distance, line_vertex, np.linalg.norm(vertices[line_vertex] - centres[line_view], axis=1))
    points = np.concatenate([vertices, _box_around(np.concatenate([vertices, centres]))])
    delaunay = Delaunay(points)
    tetrahedra, neighbours = delaunay.simplices.astype(np.int32), delaunay.neighbors.astype(np.int32)
    order = np.argsort(tetrahedra, axis=None, kind="stable")
    count = np.bincount(tetrahedra.reshape(-1), minlength=len(points))
    first = np.append(0, np.cumsum(count))
    used = count[line_vertex] > 0  # of two vertices at almost one place, one may be left out
    back = np.zeros(neighbours.shape, np.int8)
    back_slots(neighbours, back)
    capacity, excess = np.zeros(neighbours.shape), np.zeros(len(neighbours))
    cast_votes(
        points, tetrahedra, neighbours, back, first, order // 4, centres, line_vertex[used], line_view[used],
        np.ones(used.sum()), tolerance * distance, VISIBILITY_BEHIND_NOISES, capacity, excess,
    )  # fmt: skip
    capacity += VISIBILITY_FACE_WEIGHT * _face_costs(points, tetrahedra, neighbours, back)
    whole, rest = (np.rint(VISIBILITY_CAPACITY_SCALE * x).astype(np.int64) for x in (capacity, excess))
    tree = np.zeros(len(tetrahedra), np.int8)
    cut(neighbours, back, whole, rest, tree)
    full = tree != SOURCE
    t, k = np.nonzero(full[:, None] & (neighbours >= 0) & ~full[neighbours])
    a, b, c = (tetrahedra[t, (k + step) % 4] for step in (1, 2, 3))
    outwards = np.cross(points[b] - points[a], points[c] - points[a])
    inverted = ((points[tetrahedra[t, k]] - points[a]) * outwards).sum(axis=1) > 0
    faces = np.stack([a, np.where(inverted, c, b), np.where(inverted, b, c)], axis=1)
    log.info("visibility: %d triangles between %d tetrahedra", len(faces), len(tetrahedra))
    return remove_unused_vertices(Mesh(points.astype(np.float32), faces))


def _smoothed(mesh: Mesh) -> Mesh:
    """The mesh with every vertex moved half-way to the mean of its neighbours, a few times."""
    import trimesh

    rough = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False)
    trimesh.smoothing.filter_laplacian(rough, lamb=0.5, iterations=VISIBILITY_SMOOTHING_ROUNDS, volume_constraint=False)
    return Mesh(rough.vertices.astype(np.float32), mesh.faces)


def _merge_pixels(
    views: Sequence[DepthView],
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """(n, 3) vertices, and (L,) vertex and (L,) view of each line of sight."""
    stack = stack_views(views)
    step = max(1, round(np.sqrt(len(stack.inverse_depth) / VISIBILITY_MAX_PIXELS)))
    parts = parallel_map(lambda view: _pixel_points(stack, view, step), range(len(views)))
    positions, spacing = np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])
    number = np.repeat(np.arange(len(views)), [len(part[0]) for part in parts])
    factor, pixels = float(step), len(stack.inverse_depth)
    most = max(1, min(VISIBILITY_MAX_VERTICES, pixels // VISIBILITY_PIXELS_PER_VERTEX))
    while True:
        order, starts, _ = sort_cells(positions, spacing, factor)
        excess = len(starts) / most
        if excess <= 1:
            break
        factor *= max(1.05, excess**VISIBILITY_CELL_GROWTH_POWER)
    vertices = np.add.reduceat(positions[order], starts, axis=0) / np.diff(np.append(starts, len(order)))[:, None]
    vertex = np.repeat(np.arange(len(starts)), np.diff(np.append(starts, len(order))))
    lines = np.unique(vertex * len(views) + number[order])
    return vertices, lines // len(views), lines % len(views)


def _pixel_points(stack: StackedViews, view: int, step: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Positions (n, 3) and spacings (n,) of every step-th pixel of a view that lies on a surface."""
    start, height, width = stack.layout[view].tolist()
    row, column = (grid.ravel() for grid in np.mgrid[step // 2 : height : step, step // 2 : width : step])
    pixel = start + row * width + column
    known = stack.normals[pixel].any(axis=1)  # none at the edge of an object, nor where depth is noise
    pixel, at = pixel[known], np.stack([column, row, np.ones(len(row))], axis=1)[known]
    depth = 1 / stack.inverse_depth[pixel].astype(np.float64)
    return stack.centres[view] + at @ stack.unprojections[view].T * depth[:, None], stack.spacing(pixel)


def _visible_samples(mesh: Mesh, views: Sequence[DepthView]) -> tuple[OrientedPoints, NDArray[np.int32]]:
    """What the views see of a surface, without what they see obliquely and what their masks hide; the faces."""
    normals = mesh.face_normals()

    def sample(view: DepthView) -> tuple[OrientedPoints, NDArray[np.int32]]:
        camera = view.camera
        scale = min(1.0, float(np.sqrt(VISIBILITY_SAMPLE_PIXELS / (camera.width * camera.height))))
        small = camera.resize(max(2, round(camera.width * scale)), max(2, round(camera.height * scale)))
        raster = rasterise_view(mesh, small)
        row, column = np.nonzero(raster.face >= 0)
        depth = 1 / raster.inverse_depth[row, column].astype(np.float64)
        pixels = np.stack([column + 0.5, row + 0.5, np.ones(len(row))], axis=1)
        rays = pixels @ np.linalg.inv(small.K).T @ small.R
        face = raster.face[row, column]
        normal = normals[face]
        cosine = -(normal * rays).sum(axis=1) / np.linalg.norm(rays, axis=1)
        positions = camera.centre + rays * depth[:, None]
        kept = cosine > VISIBILITY_MIN_COSINE
        if view.mask is not None:
            at, _, inside = project_inside(camera, positions)
            across, down = np.where(inside[:, None], at, 0).astype(np.int64).T
            kept &= inside & view.mask[down, across]
        spacing = depth / (small.K[0, 0] * np.sqrt(np.maximum(cosine, VISIBILITY_MIN_COSINE)))
        return OrientedPoints(positions, normal.astype(np.float32), spacing.astype(np.float32))[kept], face[kept]

    points, faces = zip(*parallel_map(sample, views), strict=True)
    return join_points(*points), np.concatenate(faces)


def _box_around(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """(8, 3) corners of a box with room around points."""
    low, high = positions.min(axis=0), positions.max(axis=0)
    room = VISIBILITY_BOX_SIZES * float((high - low).max())
    corners = np.array(np.meshgrid([0, 1], [0, 1], [0, 1])).reshape(3, -1).T
    return np.where(corners == 0, low - room, high + room)


def _face_costs(
    points: NDArray[np.float64], tetrahedra: NDArray[np.int32], neighbours: NDArray[np.int32], back: NDArray[np.int8]
) -> NDArray[np.float64]:
    """(T, 4) 1 - min(cos) of the angles at which the spheres around the two tetrahedra meet each face.

    Faces of a densely sampled surface lie flat between two large spheres and cost little.
    """
    a = points[tetrahedra[:, 0]]
    b, c, d = (points[tetrahedra[:, corner]] - a for corner in (1, 2, 3))
    squared = [(edge * edge).sum(axis=1)[:, None] for edge in (b, c, d)]
    centre = squared[0] * np.cross(c, d) + squared[1] * np.cross(d, b) + squared[2] * np.cross(b, c)
    with np.errstate(divide="ignore", invalid="ignore"):
        centre /= 2 * (b * np.cross(c, d)).sum(axis=1)[:, None]
    radius = np.linalg.norm(centre, axis=1)
    cosine = np.empty(neighbours.shape)
    for k in range(4):
        first, second, third = (points[tetrahedra[:, (k + step) % 4]] for step in (1, 2, 3))
        normal = np.cross(second - first, third - first)
        inner = np.sign(((points[tetrahedra[:, k]] - first) * normal).sum(axis=1))
        with np.errstate(divide="ignore", invalid="ignore"):
            cosine[:, k] = inner * ((centre + a - first) * normal).sum(axis=1)
            cosine[:, k] /= np.linalg.norm(normal, axis=1) * radius
    cosine = np.where(np.isfinite(cosine), np.clip(cosine, -1, 1), -1)  # a flat tetrahedron
    return np.where(neighbours >= 0, 1 - np.minimum(cosine, cosine[neighbours, back]), 0)
