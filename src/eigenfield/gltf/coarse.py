"""A coarse proxy and its picture for viewers without a decoder of ours: in a small file they are small."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

import numpy as np

from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy

T = TypeVar("T")

COARSE_TRIANGLES = (128, 64, 32, 16)  # with fewer than the first the rim of Tarot's ball comes apart
SHEETS_COARSE_TRIANGLES = (256, *COARSE_TRIANGLES)  # with 128 the floor of Fern, of eight sheets, is not there
PREVIEW_MAX_BYTES_RATIO = 0.1  # of the mesh to what is coded, and of the picture
COARSE_MAX_EXCESS_RATIO = 1.5  # of the triangles of a simplified mesh to those asked for; beyond, it is clustered


def first_affordable(ways: Iterable[T], size: Callable[[T], int], coded: int) -> T:
    """The first of some candidates, in falling order, within PREVIEW_MAX_BYTES_RATIO x `coded` bytes; else the last.

    Args:
        ways: The candidates.
        size: Bytes of one.
        coded: Bytes of the coded parts.
    """
    ways = iter(ways)
    found = next(ways)
    while size(found) > PREVIEW_MAX_BYTES_RATIO * coded and (smaller := next(ways, None)) is not None:
        found = smaller
    return found


def shown_mesh(proxy: Proxy, coded: int) -> Mesh:
    """The mesh in as many triangles as `coded`, the bytes of the coded parts, allow."""
    counts = COARSE_TRIANGLES if proxy.sheets is None else SHEETS_COARSE_TRIANGLES
    return first_affordable((coarse_mesh(proxy.mesh, triangles) for triangles in counts), _plain_bytes, coded)


def _plain_bytes(mesh: Mesh) -> int:
    """Bytes of a small mesh as plain floats with a byte a corner."""
    assert mesh.uv is not None
    return mesh.vertices.nbytes + mesh.uv.nbytes + mesh.faces.size


def coarse_mesh(mesh: Mesh, triangles: int = COARSE_TRIANGLES[0]) -> Mesh:
    """The mesh simplified; of collapsed vertices the nearest to their common place gives the texture coordinates."""
    import fast_simplification

    assert mesh.uv is not None
    if len(mesh.faces) <= triangles:
        return mesh
    _, _, collapses = fast_simplification.simplify(
        mesh.vertices, mesh.faces, target_count=triangles, return_collapses=True
    )
    points, faces, fell = fast_simplification.replay_simplification(mesh.vertices, mesh.faces, collapses)
    if not len(faces):
        return mesh
    if len(faces) > COARSE_MAX_EXCESS_RATIO * triangles:  # many pieces, none of which it lets vanish: a relief's layers
        clustered = _cluster_charts(mesh, triangles)
        if clustered is not None:
            return clustered
    apart = np.linalg.norm(mesh.vertices - points[fell], axis=1)
    uv = np.zeros((len(points), 2))
    farthest_first = np.argsort(-apart, kind="stable")
    uv[fell[farthest_first]] = mesh.uv[farthest_first]  # the last to be written stays
    used, corners = np.unique(faces, return_inverse=True)
    return Mesh(
        np.ascontiguousarray(points[used], np.float32), corners.reshape(-1, 3).astype(np.int32),
        np.ascontiguousarray(uv[used], np.float32),
    )  # fmt: skip


def _cluster_charts(mesh: Mesh, triangles: int) -> Mesh | None:
    """One vertex for each chart in each cell of a square grid over the atlas, that nearest to the middle of those in
    it; the finest grid with at most `triangles`. None where none has."""
    from eigenfield.imaging.graph import vertex_components

    assert mesh.uv is not None
    finest = None
    chart = vertex_components(mesh.faces, len(mesh.vertices))
    for cells in range(2, 128):
        cell = np.floor(mesh.uv * cells).astype(np.int64) @ [1, 1 << 10] + (chart.astype(np.int64) << 20)
        _, own, count = np.unique(cell, return_inverse=True, return_counts=True)
        middle = np.stack([np.bincount(own, axis) / count for axis in mesh.uv.T], axis=1)
        apart = np.square(mesh.uv - middle[own]).sum(axis=1)
        chosen = np.zeros(len(count), np.int64)
        farthest_first = np.argsort(-apart, kind="stable")
        chosen[own[farthest_first]] = farthest_first
        faces = own[mesh.faces]
        kept = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        _, first = np.unique(np.sort(faces[kept], axis=1), axis=0, return_index=True)
        if len(first) > triangles:
            break
        if len(first):
            used, corners = np.unique(faces[kept][np.sort(first)], return_inverse=True)
            finest = Mesh(mesh.vertices[chosen[used]], corners.reshape(-1, 3).astype(np.int32), mesh.uv[chosen[used]])
    return finest
