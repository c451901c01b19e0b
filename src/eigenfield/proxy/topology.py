"""What hangs together in a mesh: edges, islands, holes, and what no surface may have.

Everything here keeps the order of faces and vertices as far as it can, so the same mesh gives the same bytes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.imaging.graph import components, edge_components, face_edges
from eigenfield.proxy.topology_kernels import least_area

LONGEST_LOOP = 200  # edges of a hole that is filled at most: the triangulation takes the cube of it


def compact(mesh: Mesh) -> Mesh:
    """Without the vertices that no face uses; UVs are kept."""
    used, index = np.unique(mesh.faces, return_inverse=True)
    uv = None if mesh.uv is None else mesh.uv[used]
    return Mesh(mesh.vertices[used], index.reshape(mesh.faces.shape).astype(np.int32), uv)


def patches(faces: NDArray[np.int32], which: NDArray[np.bool_] | None = None) -> NDArray[np.int64]:
    """(m,) which patch of faces that share edges each one belongs to; -1 outside `which`."""
    label = np.full(len(faces), -1, np.int64)
    chosen = np.arange(len(faces)) if which is None else np.flatnonzero(which)
    label[chosen] = edge_components(faces[chosen])
    return label


def without_islands(mesh: Mesh, share: float) -> Mesh:
    """Without the patches that hold less than `share` of the whole area."""
    if len(mesh.faces) == 0:
        return mesh
    label, area = patches(mesh.faces), mesh.face_areas()
    sums = np.bincount(label, area)
    keep = sums[label] >= share * area.sum()
    return compact(Mesh(mesh.vertices, mesh.faces[keep], mesh.uv))


def manifold(mesh: Mesh) -> Mesh:
    """No face twice or without three corners, no edge with more than two faces (the largest stay, neighbours that run
    the edge in opposite senses first), no vertex that joins two fans (it is doubled). UVs are dropped."""
    faces = mesh.faces[(mesh.faces != np.roll(mesh.faces, 1, axis=1)).all(axis=1)]
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    faces = faces[np.sort(first)]
    while True:
        surplus = _surplus(Mesh(mesh.vertices, faces))
        if len(surplus) == 0:
            break
        faces = np.delete(faces, surplus, axis=0)
    return _single_fans(Mesh(mesh.vertices, faces))


def _surplus(mesh: Mesh) -> NDArray[np.int64]:
    """Of every edge that is run twice in one sense, the smaller face."""
    starts, ends = mesh.faces.reshape(-1), np.roll(mesh.faces, -1, axis=1).reshape(-1)
    run = starts.astype(np.int64) * (int(mesh.faces.max(initial=0)) + 1) + ends
    area = np.repeat(mesh.face_areas(), 3)
    order = np.lexsort((np.arange(len(run)), -area, run))
    again = np.flatnonzero(np.diff(run[order]) == 0) + 1
    return np.unique(order[again] // 3)


def _single_fans(mesh: Mesh) -> Mesh:
    """Vertices doubled so that the faces around each hang together by edges."""
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
    swap = corner[a_start] != corner[b_start]  # neighbours run their edge in opposite senses
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
    """The boundary of a `manifold` mesh: closed runs of vertices, each in the sense in which a face that fills it
    would run it (opposite to the mesh's own)."""
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


def filled(mesh: Mesh, size: float, *, edges: int = LONGEST_LOOP) -> Mesh:
    """The holes of a `manifold` mesh that are at most `size` across, world units, and have at most `edges` edges,
    closed by the triangulation of least area.

    A patch's outer border is no hole: what closes it would be larger than half the patch.
    """
    label, area = patches(mesh.faces), mesh.face_areas()
    patch_area = np.bincount(label, area) if len(label) else area
    patch_of = np.zeros(len(mesh.vertices), np.int64)
    patch_of[mesh.faces] = label[:, None]
    added = [mesh.faces]
    for loop in boundary_loops(mesh):
        corners = mesh.vertices[loop].astype(np.float64)
        if 3 <= len(loop) <= edges and np.linalg.norm(np.ptp(corners, axis=0)) <= size:
            fill = loop[least_area(corners)].astype(np.int32)
            if 2 * Mesh(mesh.vertices, fill).face_areas().sum() <= patch_area[patch_of[loop[0]]]:
                added.append(fill)
    return Mesh(mesh.vertices, np.concatenate(added))
