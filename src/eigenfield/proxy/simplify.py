"""A mesh with fewer triangles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.proxy.topology import is_sliver, remove_unused_vertices

PROXY_DEFAULT_TRIANGLES = 30_000


def weld_vertices(mesh: Mesh) -> Mesh:
    """Merge vertices at identical positions and drop UVs: undoes the duplication along the seams of an atlas."""
    vertices, first, index = np.unique(mesh.vertices, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)  # keep the order of first occurrence
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    faces = rank[index.reshape(-1)][mesh.faces].astype(np.int32)
    whole = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return Mesh(vertices[order], faces[whole])


def simplify_mesh(mesh: Mesh, triangles: int) -> Mesh:
    """The mesh with at most about `triangles` triangles, by quadric edge collapse, without UVs.

    Raises:
        ProxyError: `proxy-degenerate`: nothing is left.
    """
    from fast_simplification import simplify

    centre, scale = normalisation(mesh)
    points, faces = simplify(
        (mesh.vertices.astype(np.float64) - centre) / scale, mesh.faces.astype(np.int64), target_count=triangles
    )
    vertices = (np.asarray(points, np.float64) * scale + centre).astype(np.float32)
    kept = np.asarray(faces, np.int32)
    kept = kept[~is_sliver(vertices, kept)]
    if len(kept) == 0:
        raise ProxyError(
            "proxy-degenerate",
            f"nothing is left of the mesh at {triangles} triangles",
            remedy="ask for more --triangles",
        )
    return remove_unused_vertices(Mesh(vertices, kept))


def normalisation(mesh: Mesh) -> tuple[NDArray[np.float64], float]:
    """Centre and mean edge length: thresholds of the libraries are absolute, meant for numbers near 1."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    edges = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    low, high = mesh.vertices.min(axis=0).astype(np.float64), mesh.vertices.max(axis=0).astype(np.float64)
    return (low + high) / 2, float(edges.mean()) or 1.0
