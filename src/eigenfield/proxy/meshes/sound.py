"""What other programs' meshes have that no chart can be cut from: faces that are there twice, and mixed windings."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.proxy.topology_kernels import wind_alike

log = logging.getLogger("eigenfield.proxy")


SOUND_MAX_QUAD_HEIGHT = 0.05  # between the diagonals of a quad, over the shorter one: more is a tetrahedron


def make_sound(mesh: Mesh, path: Path | None) -> Mesh:
    """The mesh with every face once and neighbours wound alike; itself if it is so.

    Vertices at one place count as one, whatever their UVs. Of faces with the same three corners the first stays, and of
    two pairs of faces that cut one flat quad along both its diagonals. Then faces are turned until the two of every
    edge run it in opposite directions: of each patch those that are fewer. Edges of more than two faces join no
    patches.

    Args:
        mesh: Without degenerate faces.
    """
    place = number_places(mesh.vertices)
    count, total = int(place.max()) + 1, len(mesh.faces)
    corners = place[mesh.faces]
    kept = _first_of_each(np.sort(corners, axis=1), count)
    if kept is None:
        kept = np.arange(total)
    edges = _find_edges(corners[kept], count)
    again = _find_quads_again(mesh.vertices[mesh.faces[kept]], corners[kept], edges) if edges.crowded else None
    if again is not None:
        kept = kept[~again]
        edges = _find_edges(corners[kept], count)
    if len(kept) < total:
        log.warning("%s: %d of %d triangles are there twice: taken once", path or "mesh", total - len(kept), total)
        mesh = Mesh(mesh.vertices, mesh.faces[kept], mesh.uv)
    turned = _find_turned(edges, len(kept))
    if turned is not None:
        log.warning(
            "%s: %d of %d triangles are wound against their neighbours: turned", path or "mesh", turned.sum(), total
        )
        faces = mesh.faces.copy()
        faces[turned] = faces[turned][:, [0, 2, 1]]
        mesh = Mesh(mesh.vertices, faces, mesh.uv)
    return mesh


class _Edges(NamedTuple):
    """The edges of exactly two faces.

    Attributes:
        one: (e,) number of the edge in its first face: edge k of face f is 3 f + k, from corner k to the next.
        other: (e,) in its second face.
        against: (e,) whether both run it in one direction.
        crowded: Whether there are edges of more faces.
    """

    one: NDArray[np.int64]
    other: NDArray[np.int64]
    against: NDArray[np.bool_]
    crowded: bool


def _find_edges(corners: NDArray[np.int64], count: int) -> _Edges:
    """The edges of faces (m, 3) of places below `count`."""
    ends = np.roll(corners, -1, axis=1).reshape(-1)
    starts = corners.reshape(-1)
    key = np.minimum(starts, ends) * count + np.maximum(starts, ends)
    order = np.argsort(key, kind="stable")
    same = np.concatenate([[False], key[order][1:] == key[order][:-1], [False]])
    pair = np.flatnonzero(same[1:-1] & ~same[:-2] & ~same[2:])
    one, other = order[pair], order[pair + 1]
    return _Edges(one, other, starts[one] == starts[other], bool((same[1:] & same[:-1]).any()))


def _find_quads_again(
    positions: NDArray[np.float32], corners: NDArray[np.int64], edges: _Edges
) -> NDArray[np.bool_] | None:
    """(m,) faces that cut a quad along its other diagonal where two earlier ones cut it already; None without any.

    Args:
        positions: (m, 3, 3) of the corners.
        corners: (m, 3) their places.
    """
    faces = np.stack([edges.one // 3, edges.other // 3], axis=1)
    last = edges.other % 3
    total = mix_places(corners).sum(axis=1)[faces[:, 0]] + mix_places(corners[faces[:, 1], (last + 2) % 3])
    ordered = np.sort(total)
    several = np.isin(total, ordered[1:][ordered[1:] == ordered[:-1]])
    if not several.any():
        return None
    faces, k, last = faces[several], edges.one[several] % 3, last[several]
    at = [(faces[:, 0], k), (faces[:, 0], (k + 1) % 3), (faces[:, 0], (k + 2) % 3), (faces[:, 1], (last + 2) % 3)]
    a, b, c, d = (positions[each].astype(np.float64) for each in at)
    places = np.stack([corners[each] for each in at], axis=1)
    across, along = b - a, d - c
    normal = np.cross(across, along)
    inside = [(np.cross(across, c - a) * np.cross(across, d - a)).sum(axis=1) < 0,
              (np.cross(along, a - c) * np.cross(along, b - c)).sum(axis=1) < 0]  # fmt: skip
    shorter = np.minimum(np.linalg.norm(across, axis=1), np.linalg.norm(along, axis=1))
    height = np.abs((normal * (c - a)).sum(axis=1))
    flat = height <= SOUND_MAX_QUAD_HEIGHT * shorter * np.linalg.norm(normal, axis=1)
    quads = np.flatnonzero(inside[0] & inside[1] & flat)
    quads = quads[np.argsort(faces[quads].min(axis=1), kind="stable")]
    if len(quads) < 2:
        return None
    _, first, group = np.unique(np.sort(places[quads], axis=1), axis=0, return_index=True, return_inverse=True)
    original = quads[first[group.reshape(-1)]]
    later = (original != quads) & (np.sort(places[quads][:, :2]) == np.sort(places[original][:, 2:])).all(axis=1)
    again = np.zeros(len(corners), bool)
    again[faces[quads[later]]] = True
    again[faces[original[later]]] = False
    return again if again.any() else None


def number_places(vertices: NDArray[np.float32]) -> NDArray[np.int64]:
    """(n,) the number of each vertex's position: equal positions have one."""
    bits = np.ascontiguousarray(vertices + np.float32(0)).view(np.uint32).astype(np.uint64)  # + 0: -0 is 0
    found = bits[:, 0]
    for axis in (1, 2):
        found = np.unique(found << np.uint64(32) | bits[:, axis], return_inverse=True)[1].astype(np.uint64)
    return found.astype(np.int64)


def mix_places(place: NDArray[np.int64]) -> NDArray[np.uint64]:
    """Numbers of which the sums of two different sets hardly ever agree."""
    mixed = place.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)  # 2^64 over the golden ratio
    return mixed ^ mixed >> np.uint64(29)


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


def _find_turned(edges: _Edges, count: int) -> NDArray[np.bool_] | None:
    """Which of `count` faces to turn so that neighbours are wound alike; None if no turning helps."""
    if not edges.against.any():
        return None
    one, other, against = edges.one // 3, edges.other // 3, edges.against
    links = np.concatenate([one, other])
    by_face = np.argsort(links, kind="stable")
    first = np.searchsorted(links[by_face], np.arange(count + 1))
    turned = wind_alike(first, np.concatenate([other, one])[by_face], np.concatenate([against, against])[by_face])
    remaining = against ^ turned[one] ^ turned[other]
    return turned if remaining.sum() < against.sum() else None
