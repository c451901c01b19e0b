"""Weights of the eigen textures over the view plane, as a picture that a shader can look them up in."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.scene import Scene
from eigenfield.rendering.weights import WEIGHTS_INSIDE_SLACK, encoded_places, hull, nearest_on_segments, view_weights

WEIGHT_MAP_NODES = 129  # along an axis: 2^n + 1 puts the cameras of a 17 x 17, 9 x 9 or 5 x 5 grid on nodes


def weight_map(scene: Scene, mode: str = "delaunay", nodes: int = WEIGHT_MAP_NODES) -> NDArray[np.float32]:
    """(nodes, nodes, N) float32: ω(j) of equation 7 at Y, X of -1..1, with nodes on the edges.

    N counts the components of all bases of all planes.

    Args:
        mode: One of `WEIGHT_MODES`.
    """
    steps = np.linspace(-1.0, 1.0, nodes)
    rows = component_rows(scene)
    found = np.full((nodes, nodes, rows.shape[1]), np.nan)
    if mode == "delaunay" and len(scene.rig.triangles):
        _fill_triangles(scene, steps, rows[scene.rows()], found)
    if scene.rig.view_plane.is_line:  # Y counts for nothing
        found[:] = np.array([view_weights(scene, (x, 0.0), mode).blend(rows) for x in steps])
    for row, column in np.argwhere(np.isnan(found).any(axis=2)) if rows.shape[1] else ():
        found[row, column] = view_weights(scene, (steps[column], steps[row]), mode).blend(rows)
    return found.astype(np.float32)


def component_rows(scene: Scene) -> NDArray[np.float64]:
    """(No, N) float64: the weights of all bases of all planes, side by side."""
    parts = [basis.weights for plane in scene.appearance.planes for basis in plane.bases]
    return np.concatenate([np.zeros((scene.observations, 0)), *parts], axis=1, dtype=np.float64)


def _fill_triangles(
    scene: Scene, steps: NDArray[np.float64], rows: NDArray[np.float64], found: NDArray[np.float64]
) -> None:
    """Fill `found` (nodes, nodes, N) with the weights of every node: within a Delaunay triangle its corners', outside
    the hull those of the nearest point on it. steps: (nodes,) their coordinates along an axis. rows: (Ne, N)."""
    places = encoded_places(scene)
    for triangle in scene.rig.triangles:
        a, b, c = places[triangle]
        low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
        first = np.searchsorted(steps, low - WEIGHTS_INSIDE_SLACK)
        last = np.searchsorted(steps, high + WEIGHTS_INSIDE_SLACK, side="right")
        x, y = np.meshgrid(steps[first[0] : last[0]], steps[first[1] : last[1]])
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        second = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
        third = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
        parts = np.stack([1 - second - third, second, third], axis=-1)
        inside = parts.min(axis=-1) >= -WEIGHTS_INSIDE_SLACK
        block = found[first[1] : last[1], first[0] : last[0]]
        block[inside] = parts[inside] @ rows[triangle]
    outside = np.argwhere(np.isnan(found).any(axis=2))
    edges = hull(scene.rig.triangles)
    nearest, part = nearest_on_segments(steps[outside[:, ::-1]], places, edges)
    ends = rows[edges[nearest]]
    found[outside[:, 0], outside[:, 1]] = (1 - part)[:, None] * ends[:, 0] + part[:, None] * ends[:, 1]
