"""Triangulation of polygons, and one UV a vertex: vertices are duplicated where a seam gives them several."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import ProxyError


class Polygons(NamedTuple):
    """Polygons, stored one after the other.

    Attributes:
        corners: (c,) vertex indices.
        sizes: (p,) number of corners of each polygon.
    """

    corners: NDArray[np.int64]
    sizes: NDArray[np.int64]

    @staticmethod
    def from_rows(rows: Sequence[Any] | NDArray[Any]) -> Polygons:
        """Polygons from lists of vertex indices.

        Args:
            rows: One list a polygon, or (p, k) if all have k corners.
        """
        if isinstance(rows, np.ndarray) and rows.ndim == 2:
            return Polygons(rows.reshape(-1).astype(np.int64), np.full(len(rows), rows.shape[1], np.int64))
        sizes = np.array([len(row) for row in rows], np.int64)
        return Polygons(np.concatenate([np.asarray(row) for row in rows]).astype(np.int64), sizes)


def triangulate_polygons(
    polygons: Polygons, uv: NDArray[np.float64] | None
) -> tuple[NDArray[np.int64], NDArray[np.float64] | None]:
    """Triangle fans from each polygon's first corner; polygons with fewer than three corners give none.

    Args:
        polygons: The polygons.
        uv: (c, 2) UVs of the corners, if any.

    Returns:
        (m, 3) vertices, and (m, 3, 2) UVs of the corners.
    """
    first = np.cumsum(polygons.sizes) - polygons.sizes
    count = np.maximum(polygons.sizes - 2, 0)
    start = np.repeat(first, count)
    step = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    corner = np.stack([start, start + step + 1, start + step + 2], axis=1)
    return polygons.corners[corner], None if uv is None else uv[corner]


def split_seams(
    faces: NDArray[np.int64], uv: NDArray[np.float64] | None
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """One UV a vertex from one UV a corner.

    Args:
        faces: (m, 3) vertices.
        uv: (m, 3, 2) UVs of the corners.

    Returns:
        (n,) the vertex that each new one copies, increasing; the new (m, 3) faces; and (n, 2) UVs.
    """
    assert uv is not None
    _, texel = np.unique(uv.reshape(-1, 2), axis=0, return_inverse=True)
    pairs = np.stack([faces.reshape(-1), texel.reshape(-1)], axis=1)
    kept, first, index = np.unique(pairs, axis=0, return_index=True, return_inverse=True)
    return kept[:, 0], index.reshape(faces.shape), uv.reshape(-1, 2)[first]


def check_range(indices: NDArray[np.int64], count: int, path: Path | None = None) -> None:
    """Check that all indices are in [0, count).

    Args:
        indices: Vertex indices.
        count: Number of vertices.
        path: Of the file, for the message.

    Raises:
        ProxyError: `proxy-index-range`.
    """
    wrong = indices[(indices < 0) | (indices >= count)]
    if len(wrong):
        raise ProxyError(
            "proxy-index-range",
            f"{len(wrong)} face corners name vertices that are not there: {wrong[0]}, of {count}",
            path=path,
            remedy="export it again",
        )
