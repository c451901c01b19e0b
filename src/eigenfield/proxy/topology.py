"""Topology of meshes: edges, patches, islands, holes, and repair of non-manifold faces.

All functions keep the order of faces and vertices as far as possible, so that the same mesh gives the same bytes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh, triangle_areas
from eigenfield.imaging.graph import components, edge_components, face_edges, vertex_components
from eigenfield.proxy.topology_kernels import triangulate_least_area

MESH_SLIVER_RATIO = 1e-9  # area over the square of the longest edge: below, a triangle is degenerate
HOLE_MAX_EDGES = 200  # of a hole that is filled: the triangulation is cubic in it


def remove_unused_vertices(mesh: Mesh) -> Mesh:
    """The mesh without vertices that no face uses; UVs are kept."""
    used = np.zeros(len(mesh.vertices), bool)
    used[mesh.faces] = True
    index = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return Mesh(mesh.vertices[used], index[mesh.faces], None if mesh.uv is None else mesh.uv[used])


def face_patches(faces: NDArray[np.int32], which: NDArray[np.bool_] | None = None) -> NDArray[np.int64]:
    """(m,) index of the edge-connected patch of each face; -1 outside `which`.

    Args:
        which: (m,) faces that count. Default: all.
    """
    label = np.full(len(faces), -1, np.int64)
    chosen = np.arange(len(faces)) if which is None else np.flatnonzero(which)
    label[chosen] = edge_components(faces[chosen])
    return label


def face_components(faces: NDArray[np.int32], vertices: int) -> NDArray[np.int32]:
    """(m,) index of the vertex-connected component of each triangle."""
    label = vertex_components(faces, vertices)
    return np.unique(label[faces[:, 0]], return_inverse=True)[1].astype(np.int32)


def remove_islands(mesh: Mesh, min_fraction: float) -> Mesh:
    """The mesh without patches of less than a fraction of the whole area."""
    if len(mesh.faces) == 0:
        return mesh
    label, area = face_patches(mesh.faces), mesh.face_areas()
    sums = np.bincount(label, area)
    keep = sums[label] >= min_fraction * area.sum()
    return remove_unused_vertices(Mesh(mesh.vertices, mesh.faces[keep], mesh.uv))


def make_manifold(mesh: Mesh) -> Mesh:
    """The mesh without non-manifold parts; UVs are dropped.

    No face is there twice or degenerate. No edge has more than two faces: the largest stay, preferring neighbours that
    run the edge in opposite directions. A vertex that joins two fans is duplicated.
    """
    faces = mesh.faces[(mesh.faces != np.roll(mesh.faces, 1, axis=1)).all(axis=1)]
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    faces = faces[np.sort(first)]
    while True:
        surplus = _surplus_faces(Mesh(mesh.vertices, faces))
        if len(surplus) == 0:
            break
        faces = np.delete(faces, surplus, axis=0)
    return _split_fans(Mesh(mesh.vertices, faces))


def _surplus_faces(mesh: Mesh) -> NDArray[np.int64]:
    """The smaller face of every edge that is run twice in one direction."""
    starts, ends = mesh.faces.reshape(-1), np.roll(mesh.faces, -1, axis=1).reshape(-1)
    run = starts.astype(np.int64) * (int(mesh.faces.max(initial=0)) + 1) + ends
    area = np.repeat(mesh.face_areas(), 3)
    order = np.lexsort((np.arange(len(run)), -area, run))
    again = np.flatnonzero(np.diff(run[order]) == 0) + 1
    return np.unique(order[again] // 3)


def _split_fans(mesh: Mesh) -> Mesh:
    """The mesh with vertices duplicated so that the faces around each are connected by edges."""
    count = len(mesh.faces)
    if count == 0:
        return Mesh(mesh.vertices[:0], mesh.faces)
    _, number = face_edges(mesh.faces)
    order = np.argsort(number, kind="stable")
    same = np.flatnonzero(np.diff(number[order]) == 0)
    a, b = order[same], order[same + 1]
    corner = mesh.faces.reshape(-1)
    a_start, a_end = a, a // 3 * 3 + (a % 3 + 1) % 3
    b_start, b_end = b, b // 3 * 3 + (b % 3 + 1) % 3
    swap = corner[a_start] != corner[b_start]  # neighbours run their edge in opposite directions
    left = np.concatenate([a_start, a_end])
    right = np.concatenate([np.where(swap, b_end, b_start), np.where(swap, b_start, b_end)])
    fan = components(3 * count, left, right)
    _, first, index = np.unique(fan, return_index=True, return_inverse=True)
    order = np.argsort(corner[first], kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    faces = rank[index.reshape(-1)].reshape(-1, 3).astype(np.int32)
    return Mesh(mesh.vertices[corner[first][order]], faces)


def boundary_loops(mesh: Mesh) -> list[NDArray[np.int64]]:
    """The boundary of a manifold mesh: closed loops of vertices, each in the direction of a face that would fill it.

    Args:
        mesh: Of `make_manifold`.
    """
    starts, ends = mesh.faces.reshape(-1).astype(np.int64), np.roll(mesh.faces, -1, axis=1).reshape(-1).astype(np.int64)
    _, number = face_edges(mesh.faces)
    alone = np.bincount(number)[number] == 1
    following = dict(zip(ends[alone].tolist(), starts[alone].tolist(), strict=True))
    loops = []
    for first in sorted(following):
        if first not in following:
            continue
        loop = [first]
        current = following.pop(first)
        while current != first and current in following:
            loop.append(current)
            current = following.pop(current)
        if current == first:
            loops.append(np.array(loop))
    return loops


def fill_holes(mesh: Mesh, max_size: float) -> Mesh:
    """The mesh with its small holes closed by the triangulation of least area.

    The outer border of a patch is no hole: what closes it would be larger than half the patch.

    Args:
        mesh: Of `make_manifold`.
        max_size: Largest extent of a hole, world units.
    """
    label, area = face_patches(mesh.faces), mesh.face_areas()
    patch_area = np.bincount(label, area) if len(label) else area
    patch_of = np.zeros(len(mesh.vertices), np.int64)
    patch_of[mesh.faces] = label[:, None]
    added = [mesh.faces]
    for loop in boundary_loops(mesh):
        corners = mesh.vertices[loop].astype(np.float64)
        if 3 <= len(loop) <= HOLE_MAX_EDGES and np.linalg.norm(np.ptp(corners, axis=0)) <= max_size:
            fill = loop[triangulate_least_area(corners)].astype(np.int32)
            if 2 * Mesh(mesh.vertices, fill).face_areas().sum() <= patch_area[patch_of[loop[0]]]:
                added.append(fill)
    return Mesh(mesh.vertices, np.concatenate(added))


def is_sliver(vertices: NDArray[np.float32], faces: NDArray[np.integer]) -> NDArray[np.bool_]:
    """(m,) whether a triangle is degenerate at float32 precision."""
    corners = vertices[faces].astype(np.float64)
    sides = corners - np.roll(corners, 1, axis=1)
    longest = (sides**2).sum(axis=2).max(axis=1)
    return np.asarray(triangle_areas(corners) <= MESH_SLIVER_RATIO * longest)
