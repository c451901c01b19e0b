"""A mesh with fewer triangles, each corner with the texture coordinates of a corner of the whole mesh."""

from __future__ import annotations

import numpy as np

from eigenfield.core.mesh import Mesh

COARSE_MAX_EXCESS_RATIO = 1.5  # of the triangles of a simplified mesh to those asked for; beyond, it is clustered


def coarse_mesh(mesh: Mesh, triangles: int) -> Mesh:
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
        _, cluster, count = np.unique(cell, return_inverse=True, return_counts=True)
        middle = np.stack([np.bincount(cluster, axis) / count for axis in mesh.uv.T], axis=1)
        apart = np.square(mesh.uv - middle[cluster]).sum(axis=1)
        chosen = np.zeros(len(count), np.int64)
        farthest_first = np.argsort(-apart, kind="stable")
        chosen[cluster[farthest_first]] = farthest_first
        faces = cluster[mesh.faces]
        kept = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
        _, first = np.unique(np.sort(faces[kept], axis=1), axis=0, return_index=True)
        if len(first) > triangles:
            break
        if len(first):
            used, corners = np.unique(faces[kept][np.sort(first)], return_inverse=True)
            finest = Mesh(mesh.vertices[chosen[used]], corners.reshape(-1, 3).astype(np.int32), mesh.uv[chosen[used]])
    return finest
