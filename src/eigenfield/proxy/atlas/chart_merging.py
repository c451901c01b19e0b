"""Merging of small charts with their neighbours.

xatlas cuts a noisy surface into charts whose triangles face in similar directions, and makes a chart of every bump.
Each chart stores its border twice in a file and needs a gutter in the atlas, and a coarse texture shows its seams.
Every small chart is therefore merged with the neighbour with which it shares the longest border, if both together can
be laid out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.imaging.graph import components
from eigenfield.runtime.parallel import parallel_map

MERGE_MAX_SMALL_FRACTION = 1 / 400  # of the triangles: larger charts are not merged into others
MERGE_MAX_ROUNDS = 8  # in each round a chart merges into one that does not itself merge

LayoutFunction = Callable[[NDArray[np.float64], NDArray[np.int32]], NDArray[np.float64] | None]


@dataclass(frozen=True, eq=False)
class Chart:
    """A chart of a mesh.

    Attributes:
        faces: (k,) faces of the mesh.
        vertices: (n,) vertices of the mesh.
        corners: (k, 3) indices into `vertices`.
        uv: (n, 2) layout.
        conformal: Whether the layout is that of `conformal_map`.
    """

    faces: NDArray[np.int64]
    vertices: NDArray[np.int64]
    corners: NDArray[np.int32]
    uv: NDArray[np.float64]
    conformal: bool


@dataclass(frozen=True, eq=False)
class SharedEdges:
    """Edges at which two triangles meet.

    Attributes:
        face: (e, 2) the triangles.
        corner: (e, 2) the corner at which the edge begins in each triangle; the second runs the other way.
        length: (e,) lengths.
    """

    face: NDArray[np.int64]
    corner: NDArray[np.int64]
    length: NDArray[np.float64]


def merge_charts(mesh: Mesh, charts: Sequence[Chart], layout: LayoutFunction) -> list[Chart]:
    """The charts of a mesh after small ones were merged into others.

    Args:
        layout: Lays out (n, 3) vertices with (m, 3) corners as (n, 2) UVs; None if there is no usable layout.
    """
    edges = shared_edges(mesh.vertices, mesh.faces)
    label = np.empty(len(mesh.faces), np.int64)
    current = dict(enumerate(charts))
    for number, chart in current.items():
        label[chart.faces] = number
    refused: set[tuple[int, int]] = set()  # small charts, and those into which they cannot merge

    def grow(candidate: tuple[int, list[int]]) -> tuple[Chart, list[int]]:
        target, small = candidate
        return _grow_chart(mesh, edges, label, current[target], {number: current[number] for number in small}, layout)

    for _ in range(MERGE_MAX_ROUNDS):
        candidates = _merge_candidates(current, label, edges, refused)
        if not candidates:
            break
        for (target, small), (chart, merged) in zip(candidates, parallel_map(grow, candidates), strict=True):
            refused |= {(number, target) for number in small if number not in merged}
            for number in merged:
                del current[number]
            current[target] = chart
            label[chart.faces] = target
    return list(current.values())


def shared_edges(vertices: NDArray[np.float32], faces: NDArray[np.int32]) -> SharedEdges:
    """Edges of exactly two triangles, which run along them in opposite directions.

    Args:
        vertices: (n, 3); vertices at the same place count as one.
    """
    place = np.unique(vertices, axis=0, return_inverse=True)[1].reshape(-1)[faces].astype(np.int64)
    begin, end = place.reshape(-1), np.roll(place, -1, axis=1).reshape(-1)
    ends = np.sort(np.stack([begin, end], axis=1), axis=1)
    _, edge, count = np.unique(ends, axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(edge.reshape(-1), kind="stable")
    first = np.cumsum(count)[count == 2] - 2
    pair = np.stack([order[first], order[first + 1]], axis=1)
    pair = pair[(begin[pair[:, 0]] == end[pair[:, 1]]) & (begin[pair[:, 0]] != end[pair[:, 0]])]
    face, corner = pair // 3, pair % 3
    points = vertices.astype(np.float64)[faces]
    along = points[face[:, 0], corner[:, 0]] - points[face[:, 0], (corner[:, 0] + 1) % 3]
    return SharedEdges(face, corner, np.linalg.norm(along, axis=1))


def _merge_candidates(
    charts: Mapping[int, Chart], label: NDArray[np.int64], edges: SharedEdges, refused: set[tuple[int, int]]
) -> list[tuple[int, list[int]]]:
    """Charts, and the small ones to merge into each.

    Each small chart gets the neighbour of more triangles with the longest common border, unless that one merges itself.
    """
    of_faces = label[edges.face]
    apart = of_faces[:, 0] != of_faces[:, 1]
    pairs, index = np.unique(np.sort(of_faces[apart], axis=1), axis=0, return_inverse=True)
    lengths = np.bincount(index.reshape(-1), edges.length[apart], len(pairs))
    beside: dict[int, list[tuple[float, int]]] = {}
    for (one, other), length in zip(pairs.tolist(), lengths.tolist(), strict=True):
        beside.setdefault(one, []).append((length, -other))
        beside.setdefault(other, []).append((length, -one))
    rank = {n: place for place, n in enumerate(sorted(charts, key=lambda n: (-len(charts[n].faces), n)))}
    candidates: dict[int, list[int]] = {}
    joining = set()
    for number in rank:  # the largest first
        if len(charts[number].faces) > MERGE_MAX_SMALL_FRACTION * len(label):
            continue
        larger = [(length, n) for length, n in beside.get(number, []) if rank[-n] < rank[number]]
        possible = [(length, n) for length, n in larger if (number, -n) not in refused]
        if possible and (target := -max(possible)[1]) not in joining:
            joining.add(number)
            candidates.setdefault(target, []).append(number)
    return list(candidates.items())


def _grow_chart(
    mesh: Mesh,
    edges: SharedEdges,
    label: NDArray[np.int64],
    chart: Chart,
    small: Mapping[int, Chart],
    layout: LayoutFunction,
) -> tuple[Chart, list[int]]:
    """A chart with as many of the small ones as can be merged, and which these are: all, else of either half."""
    whole = _join_charts(mesh, edges, label, [chart, *small.values()], layout)
    if whole is not None:
        return whole, list(small)
    if len(small) == 1:
        return chart, []
    numbers, merged = list(small), []
    for half in (numbers[: len(small) // 2], numbers[len(small) // 2 :]):
        chart, some = _grow_chart(mesh, edges, label, chart, {number: small[number] for number in half}, layout)
        merged += some
    return chart, merged


def _join_charts(
    mesh: Mesh, edges: SharedEdges, label: NDArray[np.int64], parts: Sequence[Chart], layout: LayoutFunction
) -> Chart | None:
    """Several charts as one, joined along the edges that triangles of different `label` share."""
    faces = np.concatenate([part.faces for part in parts])
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    corners = np.concatenate([part.corners + start for part, start in zip(parts, starts[:-1], strict=True)])
    place = np.full(len(label), -1)
    place[faces] = np.arange(len(faces))
    face, seams = place[edges.face], label[edges.face]
    is_seam = (face >= 0).all(axis=1) & (seams[:, 0] != seams[:, 1])
    (one, other), (begin, end) = face[is_seam].T, edges.corner[is_seam].T
    same = components(
        int(starts[-1]),
        np.concatenate([corners[one, begin], corners[one, (begin + 1) % 3]]),
        np.concatenate([corners[other, (end + 1) % 3], corners[other, end]]),
    )
    _, first, index = np.unique(same[corners], return_index=True, return_inverse=True)
    vertices = np.concatenate([part.vertices for part in parts])[corners.reshape(-1)[first]]
    corners = index.reshape(-1, 3).astype(np.int32)
    uv = layout(mesh.vertices[vertices].astype(np.float64), corners)
    return None if uv is None else Chart(faces, vertices, corners, uv - uv.min(axis=0), True)
