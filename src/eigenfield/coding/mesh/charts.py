"""Charts of an atlas; those of a relief, laid out as a camera sees it, are an affine map of lattice coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.mesh.corner_kernels import MAPPED, MIRRORED
from eigenfield.core.mesh import signed_areas
from eigenfield.imaging.graph import vertex_components

MAPPED_CHART_MIN_VERTICES = 24  # of a chart with a map of its own, which takes 24 bytes


def chart_kinds(
    faces: NDArray[np.int32], places: NDArray[np.float64], uv: NDArray[np.float64], tolerance: float
) -> tuple[NDArray[np.int32], NDArray[np.int8], NDArray[np.int64]]:
    """Charts, which are components connected by vertices.

    Args:
        faces: (m, 3).
        places: (v, 3) lattice coordinates.
        uv: (v, 2).
        tolerance: A chart is MAPPED if u and v are within this of a x + b y + c.

    Returns:
        (v,) the chart of every vertex, (charts,) kinds, (charts, 6) bits of the maps' float32 numbers.
    """
    label = vertex_components(faces, len(places))
    charts = int(label.max(initial=-1)) + 1
    area = np.bincount(label[faces[:, 0]], signed_areas(uv[faces]), charts)
    kinds = np.where(area < 0, MIRRORED, 0).astype(np.int8)
    maps = np.zeros((charts, 6), np.int64)
    order = np.argsort(label, kind="stable")
    first = np.searchsorted(label[order], np.arange(charts + 1))
    last = None
    for chart in range(charts):
        members = order[first[chart] : first[chart + 1]]
        found = _affine(places[members, :2], uv[members], last, tolerance) if len(members) else None
        if found is not None:
            kinds[chart], maps[chart], last = MAPPED, found.view(np.uint32), found
    return label, kinds, maps


def _affine(
    xy: NDArray[np.float64], uv: NDArray[np.float64], last: NDArray[np.float32] | None, tolerance: float
) -> NDArray[np.float32] | None:
    """(6,) a u-row, a v-row, the offset; with the linear part of the last if that will do, which is cheaper."""
    if last is not None:
        same = _with_offset(last[:4], xy, uv, tolerance)
        if same is not None:
            return same
    if len(xy) < MAPPED_CHART_MIN_VERTICES:
        return None
    middle = xy.mean(axis=0)
    slope = np.linalg.lstsq(xy - middle, uv - uv.mean(axis=0), rcond=None)[0]
    return _with_offset(np.ascontiguousarray(slope.T, np.float32).reshape(4), xy, uv, tolerance)


def _with_offset(
    linear: NDArray[np.float32], xy: NDArray[np.float64], uv: NDArray[np.float64], tolerance: float
) -> NDArray[np.float32] | None:
    rest = uv - xy @ linear.astype(np.float64).reshape(2, 2).T
    offset = ((rest.min(axis=0) + rest.max(axis=0)) / 2).astype(np.float32)
    return np.concatenate([linear, offset]) if np.abs(rest - offset).max() <= tolerance else None


def mapped_texture(places: NDArray[np.int64], maps: NDArray[np.int64]) -> NDArray[np.float64]:
    """(v, 2) texture coordinates at lattice coordinates places (v, 3) by maps (v, 6)."""
    x, y = places[:, 0].astype(np.float64), places[:, 1].astype(np.float64)
    with np.errstate(all="ignore"):
        m = maps.astype(np.uint32).view(np.float32).astype(np.float64)
        return np.stack([m[:, 0] * x + m[:, 1] * y + m[:, 4], m[:, 2] * x + m[:, 3] * y + m[:, 5]], axis=1)
