"""Small charts joined to their neighbours.

xatlas cuts a noisy surface into charts whose triangles face about the same way, and makes one of every bump. Each costs
its border twice in a file and a gutter in the atlas, and where it meets others a coarse texture shows it. So every
small chart joins the neighbour with which it has the longest border, if both together can be laid out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.imaging.graph import components
from eigenfield.runtime.parallel import parallel_map

SMALL = 1 / 400  # of the triangles: charts of more stay by themselves, unless others join them
ROUNDS = 8  # in each a chart joins one that joins no other

Layout = Callable[[NDArray[np.float64], NDArray[np.int32]], NDArray[np.float64] | None]


@dataclass(frozen=True, eq=False)
class Chart:
    """faces (k,) and vertices (n,) of a mesh, corners (k, 3) among those vertices, uv (n, 2). conformal: laid out by
    `conformal_map`."""

    faces: NDArray[np.int64]
    vertices: NDArray[np.int64]
    corners: NDArray[np.int32]
    uv: NDArray[np.float64]
    conformal: bool


@dataclass(frozen=True, eq=False)
class Borders:
    """Edges at which two triangles meet. face: (e, 2) triangles. corner: (e, 2) at which of its corners each's edge
    begins, the second runs the other way. length: (e,)."""

    face: NDArray[np.int64]
    corner: NDArray[np.int64]
    length: NDArray[np.float64]


def merged_charts(mesh: Mesh, charts: Sequence[Chart], layout: Layout) -> list[Chart]:
    """The charts of a mesh, small ones joined to others.

    layout: (n, 2) for a chart's vertices (n, 3) and corners (m, 3); None where it has none that is of use.
    """
    borders = shared_edges(mesh.vertices, mesh.faces)
    label = np.empty(len(mesh.faces), np.int64)
    current = dict(enumerate(charts))
    for number, chart in current.items():
        label[chart.faces] = number
    refused: set[tuple[int, int]] = set()  # small charts, and those which they cannot join

    def grown(wish: tuple[int, list[int]]) -> tuple[Chart, list[int]]:
        target, small = wish
        return _grown(mesh, borders, label, current[target], {number: current[number] for number in small}, layout)

    for _ in range(ROUNDS):
        wishes = _wishes(current, label, borders, refused)
        if not wishes:
            break
        for (target, small), (chart, joined) in zip(wishes, parallel_map(grown, wishes), strict=True):
            refused |= {(number, target) for number in small if number not in joined}
            for number in joined:
                del current[number]
            current[target] = chart
            label[chart.faces] = target
    return list(current.values())


def shared_edges(vertices: NDArray[np.float32], faces: NDArray[np.int32]) -> Borders:
    """Edges of exactly two triangles, which run along them opposite ways; vertices at one place count as one."""
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
    return Borders(face, corner, np.linalg.norm(along, axis=1))


def _wishes(
    charts: Mapping[int, Chart], label: NDArray[np.int64], borders: Borders, refused: set[tuple[int, int]]
) -> list[tuple[int, list[int]]]:
    """Charts and the small ones that are to join them. Each small one has the neighbour of more triangles with which
    its border is longest, unless that is to join another."""
    of_faces = label[borders.face]
    apart = of_faces[:, 0] != of_faces[:, 1]
    pairs, index = np.unique(np.sort(of_faces[apart], axis=1), axis=0, return_inverse=True)
    lengths = np.bincount(index.reshape(-1), borders.length[apart], len(pairs))
    beside: dict[int, list[tuple[float, int]]] = {}
    for (one, other), length in zip(pairs.tolist(), lengths.tolist(), strict=True):
        beside.setdefault(one, []).append((length, -other))
        beside.setdefault(other, []).append((length, -one))
    rank = {n: place for place, n in enumerate(sorted(charts, key=lambda n: (-len(charts[n].faces), n)))}
    wishes: dict[int, list[int]] = {}
    joining = set()
    for number in rank:  # the largest first
        if len(charts[number].faces) > SMALL * len(label):
            continue
        larger = [(length, n) for length, n in beside.get(number, []) if rank[-n] < rank[number]]
        possible = [(length, n) for length, n in larger if (number, -n) not in refused]
        if possible and (target := -max(possible)[1]) not in joining:
            joining.add(number)
            wishes.setdefault(target, []).append(number)
    return list(wishes.items())


def _grown(
    mesh: Mesh, borders: Borders, label: NDArray[np.int64], chart: Chart, small: Mapping[int, Chart], layout: Layout
) -> tuple[Chart, list[int]]:
    """A chart with as many of the small ones as it can take, and which these are: all, else of either half."""
    whole = _joined(mesh, borders, label, [chart, *small.values()], layout)
    if whole is not None:
        return whole, list(small)
    if len(small) == 1:
        return chart, []
    numbers, joined = list(small), []
    for half in (numbers[: len(small) // 2], numbers[len(small) // 2 :]):
        chart, some = _grown(mesh, borders, label, chart, {number: small[number] for number in half}, layout)
        joined += some
    return chart, joined


def _joined(
    mesh: Mesh, borders: Borders, label: NDArray[np.int64], parts: Sequence[Chart], layout: Layout
) -> Chart | None:
    """Several charts as one, sewn together along the edges that triangles of different `label` share."""
    faces = np.concatenate([part.faces for part in parts])
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    corners = np.concatenate([part.corners + start for part, start in zip(parts, starts[:-1], strict=True)])
    place = np.full(len(label), -1)
    place[faces] = np.arange(len(faces))
    face, seams = place[borders.face], label[borders.face]
    sewn = (face >= 0).all(axis=1) & (seams[:, 0] != seams[:, 1])
    (one, other), (begin, end) = face[sewn].T, borders.corner[sewn].T
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
