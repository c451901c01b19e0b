"""Triangulation of polygons, and one UV a vertex: vertices are duplicated where a seam gives them several."""

from __future__ import annotations

import logging
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import area_normals
from eigenfield.proxy.meshes.polygon_kernels import clip_ears
from eigenfield.proxy.meshes.sound import mix_places, number_places

log = logging.getLogger("eigenfield.proxy")

POLYGON_BLOCK = 1 << 16  # polygons that are checked at a time
POLYGON_FLAT = 1e-12  # of a polygon's area: a smaller triangle is not turned against it
POLYGON_MAX_CONCAVE_CORNERS = 10_000  # of a polygon whose ears are clipped: the time grows with the square


class Polygons(NamedTuple):
    """Polygons, stored one after the other.

    Attributes:
        corners: (c,) vertex indices.
        sizes: (p,) number of corners of each polygon.
    """

    corners: NDArray[np.int64]
    sizes: NDArray[np.int64]


def triangulate_polygons(
    polygons: Polygons, uv: NDArray[np.float64] | None, vertices: NDArray[np.float64]
) -> tuple[NDArray[np.int64], NDArray[np.float64] | None]:
    """Triangles of polygons; those with fewer than three corners give none.

    A polygon is a fan from its first corner where all triangles of the fan have the polygon's orientation. Others are
    cut by ear clipping (Meisters, "Polygons have ears", 1975), in the plane along two axes that shows most of them.

    Args:
        uv: (c, 2) UVs of the corners, if any.

    Returns:
        (m, 3) vertices, and (m, 3, 2) UVs of the corners.

    Raises:
        ProxyError: `proxy-index-range`; `proxy-polygon`: a concave polygon has too many corners.
    """
    check_range(polygons.corners, len(vertices))
    first, count = np.cumsum(polygons.sizes) - polygons.sizes, np.maximum(polygons.sizes - 2, 0)
    begin = np.cumsum(count) - count
    start = np.repeat(first, count)
    step = np.arange(count.sum()) - np.repeat(begin, count)
    corner = np.stack([start, start + step + 1, start + step + 2], axis=1)
    if count.max(initial=0) < 2:
        return polygons.corners[corner], None if uv is None else uv[corner]
    concave = _find_concave(vertices, polygons.corners, corner, begin, count)
    if len(concave):
        most = int(polygons.sizes[concave].max())
        if most > POLYGON_MAX_CONCAVE_CORNERS:
            message = f"a polygon that is not convex has {most} corners, {POLYGON_MAX_CONCAVE_CORNERS} are allowed"
            raise ProxyError("proxy-polygon", message, remedy="export it as triangles")
        crossing = clip_ears(
            np.ascontiguousarray(vertices, np.float64), polygons.corners, first[concave], polygons.sizes[concave],
            begin[concave], corner,
        )  # fmt: skip
        log.info("%d polygons that are not convex are cut by ear clipping", len(concave))
        if crossing:
            log.warning("%d polygons cross themselves: their triangles are a guess; export triangles", crossing)
    _cut_alike(vertices, polygons, first, begin, corner)
    return polygons.corners[corner], None if uv is None else uv[corner]


def _cut_alike(
    vertices: NDArray[np.float64],
    polygons: Polygons,
    first: NDArray[np.int64],
    begin: NDArray[np.int64],
    triangles: NDArray[np.int64],
) -> None:
    """Cut a polygon that is there again, begun or wound elsewise, into the triangles (corners) of the first.

    Two polygons are one if they run the same edges. What is there twice is then taken once triangle by triangle.
    """
    with np.errstate(over="ignore"):
        place = number_places(vertices.astype(np.float32))[polygons.corners]
    mixed = mix_places(place)
    for size in np.unique(polygons.sizes[polygons.sizes > 3]):
        which = np.flatnonzero(polygons.sizes == size)
        corners = first[which, None] + np.arange(size)
        if len(np.unique(mixed[corners].sum(axis=1))) == len(which):
            continue
        ends = place[corners]
        following = np.roll(ends, -1, axis=1)
        edges = np.sort(np.minimum(ends, following) * len(vertices) + np.maximum(ends, following), axis=1)
        _, earliest, group = np.unique(edges, axis=0, return_index=True, return_inverse=True)
        original = earliest[group.reshape(-1)]
        again = np.flatnonzero(original != np.arange(len(which)))
        original = original[again]
        by_place = np.argsort(ends, axis=1, kind="stable")
        rank = np.argsort(by_place, axis=1)
        rows = np.arange(size - 2)
        cut = triangles[begin[which[original], None] + rows] - first[which[original], None, None]
        line = np.arange(len(again))[:, None, None]
        triangles[begin[which[again], None] + rows] = (
            by_place[again][line, rank[original][line, cut]] + first[which[again], None, None]
        )


def _find_concave(
    vertices: NDArray[np.float64],
    corners: NDArray[np.int64],
    fans: NDArray[np.int64],
    begin: NDArray[np.int64],
    count: NDArray[np.int64],
) -> NDArray[np.int64]:
    """The polygons of whose fan (`count` rows of `fans`, from `begin`) a triangle is turned against the whole."""
    found = [np.zeros(0, np.int64)]
    for block in range(0, len(count), POLYGON_BLOCK):
        which = block + np.flatnonzero(count[block : block + POLYGON_BLOCK] > 1)
        many = count[which]
        of = np.repeat(np.arange(len(which)), many)
        rows = np.repeat(begin[which] - np.cumsum(many) + many, many) + np.arange(many.sum())
        with np.errstate(invalid="ignore", over="ignore"):
            normals = area_normals(vertices[corners[fans[rows]]])
            whole = np.stack([np.bincount(of, normals[:, axis], len(which)) for axis in range(3)], axis=1)
            against = (normals * whole[of]).sum(axis=1) < -POLYGON_FLAT * (whole**2).sum(axis=1)[of]
        found.append(which[np.unique(of[against])])
    return np.concatenate(found)


def strip_triangles(indices: NDArray[np.int64]) -> NDArray[np.int64]:
    """(m, 3) triangles of strips, all wound alike; those that name a vertex twice, which join strips, are left out.

    Args:
        indices: (n,) vertices; -1 ends a strip.
    """
    if len(indices) < 3:
        return np.zeros((0, 3), np.int64)
    ends = np.flatnonzero(indices == -1)
    begin = np.zeros(len(indices), np.int64)
    begin[ends] = ends + 1
    odd = (np.arange(len(indices)) - np.maximum.accumulate(begin))[:-2] % 2 == 1
    faces = np.stack([indices[:-2], indices[1:-1], indices[2:]], axis=1)
    faces[odd] = faces[odd][:, [0, 2, 1]]
    return faces[(faces >= 0).all(axis=1) & (faces != np.roll(faces, 1, axis=1)).all(axis=1)]


def split_seams(
    faces: NDArray[np.int64], uv: NDArray[np.float64] | None
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """One UV a vertex from one UV a corner.

    Args:
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

    Raises:
        ProxyError: `proxy-index-range`.
    """
    if len(indices) == 0 or (indices.min() >= 0 and indices.max() < count):
        return
    wrong = indices[(indices < 0) | (indices >= count)]
    raise ProxyError(
        "proxy-index-range",
        f"{len(wrong)} face corners name vertices that are not there: {wrong[0]}, of {count}",
        path=path,
        remedy="export it again",
    )
