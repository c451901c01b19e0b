"""Connected components of graphs, and triangles of a mesh that share vertices or edges."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

Indices = NDArray[np.signedinteger[Any]]


def components(count: int, one: Indices, other: Indices) -> NDArray[np.int32]:
    """The connected components of an undirected graph, by the first and second node of each link.

    Returns:
        (count,) the component of each node, numbered from 0 in the order of their first nodes.
    """
    links = coo_array((np.ones(len(one), np.int8), (one, other)), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1], np.int32)


def vertex_components(faces: NDArray[np.int32], vertices: int) -> NDArray[np.int32]:
    """(vertices,) the components of a mesh's vertices, joined by its triangles (m, 3)."""
    corners = faces.astype(np.int64)
    return components(vertices, np.r_[corners[:, 0], corners[:, 0]], np.r_[corners[:, 1], corners[:, 2]])


def edge_components(faces: NDArray[np.int32]) -> NDArray[np.int32]:
    """(m,) the components of triangles (m, 3), joined where they share an edge."""
    return components(len(faces), *edge_links(faces))


def edge_links(faces: NDArray[np.int32]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Pairs of triangles that share an edge, the later one first: two arrays of indices into faces (m, 3).

    An edge of k triangles gives k - 1 pairs.
    """
    _, edge = face_edges(faces)
    order = np.argsort(edge, kind="stable")
    same = np.flatnonzero(np.diff(edge[order]) == 0)
    return order[same + 1] // 3, order[same] // 3


def face_edges(faces: Indices) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The edges of triangles (m, 3): edge k of triangle f, from corner k to the next, is number 3 f + k.

    Returns:
        (3 m, 2) the vertices of each, the lower first, and (3 m,) the number of the undirected edge that it is.
    """
    ends = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2).astype(np.int64)
    ends.sort(axis=1)
    _, number = np.unique(ends[:, 0] * (int(faces.max(initial=0)) + 1) + ends[:, 1], return_inverse=True)
    return ends, number.reshape(-1)
