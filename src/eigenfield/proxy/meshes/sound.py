"""What other programs' meshes have that no chart can be cut from: faces that are there twice, and mixed windings."""

from __future__ import annotations

import logging
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.proxy.topology_kernels import wind_alike

log = logging.getLogger("eigenfield.proxy")


def make_sound(mesh: Mesh, path: Path | None) -> Mesh:
    """The mesh with every face once and neighbours wound alike; itself if it is so.

    Vertices at one place count as one, whatever their UVs. Of faces with the same three corners the first stays. Then
    faces are turned until the two of every edge run it in opposite directions: of each patch those that are fewer.
    Edges of more than two faces join no patches.

    Args:
        mesh: Without degenerate faces.
        path: Of the file, for the log.
    """
    place = number_places(mesh.vertices)
    count, total = int(place.max()) + 1, len(mesh.faces)
    corners = place[mesh.faces]
    kept = _first_of_each(np.sort(corners, axis=1), count)
    if kept is not None:
        log.warning("%s: %d of %d triangles are there twice: taken once", path or "mesh", total - len(kept), total)
        mesh, corners = Mesh(mesh.vertices, mesh.faces[kept], mesh.uv), corners[kept]
    turned = _find_turned(corners, count)
    if turned is not None:
        log.warning(
            "%s: %d of %d triangles are wound against their neighbours: turned", path or "mesh", turned.sum(), total
        )
        faces = mesh.faces.copy()
        faces[turned] = faces[turned][:, [0, 2, 1]]
        mesh = Mesh(mesh.vertices, faces, mesh.uv)
    return mesh


def number_places(vertices: NDArray[np.float32]) -> NDArray[np.int64]:
    """(n,) the number of each vertex's position: equal positions have one.

    Args:
        vertices: (n, 3).
    """
    bits = np.ascontiguousarray(vertices + np.float32(0)).view(np.uint32).astype(np.uint64)  # + 0: -0 is 0
    found = bits[:, 0]
    for axis in (1, 2):
        found = np.unique(found << np.uint64(32) | bits[:, axis], return_inverse=True)[1].astype(np.uint64)
    return found.astype(np.int64)


def _first_of_each(rows: NDArray[np.int64], count: int) -> NDArray[np.int64] | None:
    """The first of equal rows (m, 3) of numbers below `count`, in order; None if no two are equal."""
    pair = rows[:, 0] * count + rows[:, 1]
    if count >= 2**21:
        pair = np.unique(pair, return_inverse=True)[1]
    key = pair * count + rows[:, 2]
    ordered = np.sort(key)
    if not (ordered[1:] == ordered[:-1]).any():
        return None
    return np.sort(np.unique(key, return_index=True)[1])


def _find_turned(corners: NDArray[np.int64], count: int) -> NDArray[np.bool_] | None:
    """(m,) which faces to turn so that neighbours are wound alike; None if no turning helps."""
    ends = np.roll(corners, -1, axis=1).reshape(-1)
    starts = corners.reshape(-1)
    key = np.minimum(starts, ends) * count + np.maximum(starts, ends)
    order = np.argsort(key, kind="stable")
    same = np.concatenate([[False], key[order][1:] == key[order][:-1], [False]])
    pair = np.flatnonzero(same[1:-1] & ~same[:-2] & ~same[2:])  # edges of exactly two faces
    one, other = order[pair], order[pair + 1]
    against = starts[one] == starts[other]
    if not against.any():
        return None
    one, other = one // 3, other // 3
    links = np.concatenate([one, other])
    by_face = np.argsort(links, kind="stable")
    first = np.searchsorted(links[by_face], np.arange(len(corners) + 1))
    turned = wind_alike(first, np.concatenate([other, one])[by_face], np.concatenate([against, against])[by_face])
    remaining = against ^ turned[one] ^ turned[other]
    return turned if remaining.sum() < against.sum() else None
