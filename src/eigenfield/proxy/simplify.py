"""A mesh with fewer triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh, vertex_normals
from eigenfield.imaging.graph import components, face_edges
from eigenfield.proxy.topology import is_sliver, remove_unused_vertices

PROXY_DEFAULT_TRIANGLES = 30_000
WELD_MAX_ULPS = 4  # of a point's largest coordinate: by so much float32 parts what was made to meet
FIN_EDGES = (
    4.0  # height on a border, in its edges there: beside triangles over 20 times as long as wide nothing collapses
)
FIN_MAX_ROUNDS = 4  # in which the triangles besides those of the fins become as many as asked for
FIN_MIN_RATIO = 0.97  # of the triangles asked for: close enough


def weld_vertices(mesh: Mesh) -> Mesh:
    """Merge vertices at one position and drop UVs: undoes the duplication along the seams of an atlas.

    Positions that differ by no more than float32's rounding are one, so that parts which were made to meet are joined.
    """
    _, first, index = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # keep the order of first occurrence
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    vertices = mesh.vertices[first[order]]
    place = _places(vertices)
    faces = place[rank[index.reshape(-1)][mesh.faces]].astype(np.int32)
    return Mesh(vertices[np.unique(place, return_index=True)[1]], faces[_is_whole(faces)])


def _places(vertices: NDArray[np.float32]) -> NDArray[np.int32]:
    """(n,) number of each vertex's place, in the order of their first: vertices that rounding parts share one."""
    largest = np.abs(vertices).max(axis=1)
    ulps = WELD_MAX_ULPS * np.spacing(largest).astype(np.float64)
    found = [np.zeros((0, 2), np.int64)]
    for reach in np.unique(ulps):  # by octaves: with the reach of what is far, all that is near would be one pair
        low = largest[ulps == reach].min() - reach
        some = np.flatnonzero((ulps <= reach) & (largest >= low))
        pairs = some[KDTree(vertices[some]).query_pairs(float(reach), output_type="ndarray")]
        apart = np.linalg.norm(np.diff(vertices[pairs].astype(np.float64), axis=1)[:, 0], axis=1)
        found.append(pairs[apart <= ulps[pairs].max(axis=1)])
    one, other = np.concatenate(found).T
    return components(len(vertices), one, other)


def _is_whole(faces: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(m,) whether a triangle's corners are three vertices."""
    return np.asarray((faces != np.roll(faces, 1, axis=1)).all(axis=1))


def simplify_mesh(mesh: Mesh, triangles: int) -> Mesh:
    """The mesh with at most about `triangles` triangles, by quadric edge collapse, without UVs.

    A border keeps its place as the surface does, so that parts which meet along an edge still meet.

    Raises:
        ProxyError: `proxy-degenerate`: nothing is left.
    """
    centre, scale = normalisation(mesh)
    points, faces = _collapsed((mesh.vertices.astype(np.float64) - centre) / scale, mesh.faces, triangles)
    vertices = (points * scale + centre).astype(np.float32)
    kept = faces[~is_sliver(vertices, faces)]
    if len(kept) == 0:
        raise ProxyError(
            "proxy-degenerate",
            f"nothing is left of the mesh at {triangles} triangles",
            remedy="ask for more --triangles",
        )
    return remove_unused_vertices(Mesh(vertices, kept))


def _collapsed(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], triangles: int
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Points and triangles after the library's collapses, which hold a border only by the fins on it."""
    from fast_simplification import simplify

    faces = faces[_is_whole(faces)]
    points, with_fins = _with_fins(vertices, faces)
    fins = len(with_fins) - len(faces)
    target = triangles + fins * triangles // max(len(faces), 1)
    found = []
    for _ in range(FIN_MAX_ROUNDS if fins else 1):
        moved, left, collapses = simplify(
            points, with_fins.astype(np.int64), target_count=min(target, len(with_fins)), return_collapses=True
        )
        count = int(_is_whole(_became(collapses, len(points))[faces].astype(np.int32)).sum())
        found.append((count > triangles, abs(triangles - count), moved, left[:count]))  # triangles keep their order
        if FIN_MIN_RATIO * triangles <= count <= triangles:
            break
        target = max(target + triangles - count, 1)
    _, _, moved, left = min(found, key=lambda one: one[:2])
    return moved, np.asarray(left, np.int32)


def _became(collapses: NDArray[np.int32], vertices: int) -> NDArray[np.int64]:
    """(vertices,) the vertex that each has become after collapses (k, 2) of the second onto the first."""
    onto = np.arange(vertices)
    onto[collapses[:, 1]] = collapses[:, 0]
    while (further := onto[onto] != onto).any():
        onto[further] = onto[onto[further]]
    return onto


def _with_fins(
    vertices: NDArray[np.float64], faces: NDArray[np.int32]
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Points and triangles, first the given ones, then a strip that stands on the borders.

    The library measures how far a vertex moves from the planes of its triangles, so that the border of a plane is free
    to move in it. With a strip across it is an edge like others. The strip's own border never collapses onto the mesh.
    """
    _, number = face_edges(faces)
    alone = np.bincount(number)[number] == 1
    normals = vertex_normals(vertices, faces)
    borders = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)[alone]
    starts, ends = borders[normals[borders].any(axis=2).all(axis=1)].T
    rim, above = np.unique([starts, ends], return_inverse=True)
    edges = np.linalg.norm(vertices[starts] - vertices[ends], axis=1)
    heights = FIN_EDGES * np.bincount(above.reshape(-1), np.tile(edges, 2)) / np.bincount(above.reshape(-1))
    above_starts, above_ends = above.reshape(2, -1).astype(np.int32) + np.int32(len(vertices))
    strip = [np.stack([ends, starts, above_starts], axis=1), np.stack([ends, above_starts, above_ends], axis=1)]
    return np.concatenate([vertices, vertices[rim] + heights[:, None] * normals[rim]]), np.concatenate([faces, *strip])


def normalisation(mesh: Mesh) -> tuple[NDArray[np.float64], float]:
    """Centre and mean edge length: thresholds of the libraries are absolute, meant for numbers near 1."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    low, high = mesh.vertices.min(axis=0).astype(np.float64), mesh.vertices.max(axis=0).astype(np.float64)
    return (low + high) / 2, float(edges.mean()) or 1.0
