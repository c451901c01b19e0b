"""Clipping of a mesh at the zero of a function of space, such as a signed distance."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.mesh import Mesh
from eigenfield.imaging.graph import face_edges
from eigenfield.proxy.topology import remove_unused_vertices

DistanceFunction = Callable[[NDArray[np.float64]], NDArray[np.float64]]

CLIP_BISECTIONS = 40
CLIP_MAX_SPLIT_ROUNDS = 16


def clip_mesh(mesh: Mesh, distance: DistanceFunction) -> Mesh:
    """The part of a mesh with non-negative distance; triangles that cross zero are cut, without cracks.

    UVs are dropped. The distance is only evaluated at vertices: first split edges that are long against the clipped
    shape, by `split_long_edges`.
    """
    vertices = mesh.vertices.astype(np.float64)
    inside = distance(vertices) < 0
    number_inside = inside[mesh.faces].sum(axis=1)
    mixed = mesh.faces[(number_inside == 1) | (number_inside == 2)]
    whole = mesh.faces[number_inside == 0]
    if len(mixed) == 0:
        return remove_unused_vertices(Mesh(mesh.vertices, whole))
    ends, number = face_edges(mixed)
    _, first = np.unique(number, return_index=True)
    a, b = ends[first].T
    crossing = inside[a] != inside[b]
    place = np.full(len(first), -1)
    place[crossing] = len(vertices) + np.arange(int(crossing.sum()))
    cut = _zero_crossings(vertices[a[crossing]], vertices[b[crossing]], inside[a[crossing]], distance)
    edges = place[number].reshape(-1, 3)  # edge k of a face runs from corner k to the next
    count = inside[mixed].sum(axis=1)
    odd = np.where(count == 1, inside[mixed].argmax(axis=1), (~inside[mixed]).argmax(axis=1))
    rows = np.arange(len(mixed))
    tip, following, before = mixed[rows, odd], mixed[rows, (odd + 1) % 3], mixed[rows, (odd + 2) % 3]
    after_tip, before_tip = edges[rows, odd], edges[rows, (odd + 2) % 3]
    alone = count == 2  # only the tip remains
    rests = ((after_tip, following, before), (after_tip, before, before_tip))
    cut_off = np.stack([tip, after_tip, before_tip], axis=1)[alone]
    kept = np.concatenate([whole, cut_off, *(np.stack(rest, axis=1)[~alone] for rest in rests)])
    return remove_unused_vertices(Mesh(np.concatenate([mesh.vertices, cut.astype(np.float32)]), kept.astype(np.int32)))


def _zero_crossings(
    a: NDArray[np.float64], b: NDArray[np.float64], a_inside: NDArray[np.bool_], distance: DistanceFunction
) -> NDArray[np.float64]:
    """Where `distance` changes its sign between a and b, by bisection."""
    low, high = np.zeros(len(a)), np.ones(len(a))
    for _ in range(CLIP_BISECTIONS):
        middle = (low + high) / 2
        same = (distance(a + middle[:, None] * (b - a)) < 0) == a_inside
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return a + ((low + high) / 2)[:, None] * (b - a)


def split_long_edges(mesh: Mesh, distance: DistanceFunction, max_length: float) -> Mesh:
    """Split edges in the middle until none is longer than a limit, in triangles that may reach zero distance.

    Neighbours are split too, so that no crack opens. UVs are dropped.

    Args:
        max_length: World units.
    """
    vertices, faces = mesh.vertices.astype(np.float64), mesh.faces
    for _ in range(CLIP_MAX_SPLIT_ROUNDS):
        corners = vertices[faces]
        length = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2)  # edge k: corner k to the next
        near = np.abs(distance(corners.mean(axis=1))) <= length.max(axis=1)
        wanted = near[:, None] & (length > max_length)
        if not wanted.any():
            break
        vertices, faces = _split_edges(vertices, faces, wanted)
    return Mesh(vertices.astype(np.float32), faces)


def _split_edges(
    vertices: NDArray[np.float64], faces: NDArray[np.int32], wanted: NDArray[np.bool_]
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Every edge that some face marks gets a vertex in its middle; each face becomes 1 to 4."""
    ends, number = face_edges(faces)
    chosen = np.zeros(int(number.max()) + 1, np.bool_)
    chosen[number[wanted.reshape(-1)]] = True
    _, first = np.unique(number, return_index=True)
    place = np.full(len(chosen), -1)
    place[chosen] = len(vertices) + np.arange(int(chosen.sum()))
    middles = vertices[ends[first[chosen]]].mean(axis=1)
    edges = place[number].reshape(-1, 3)
    count = (edges >= 0).sum(axis=1)
    result = [faces[count == 0]]
    for shift in range(3):  # rotated so that the split edges come first
        f, e = np.roll(faces, -shift, axis=1), np.roll(edges, -shift, axis=1)
        (a, b, c), (ab, bc, ca) = f.T, e.T
        one = (count == 1) & (ab >= 0)
        result += [np.stack([a, ab, c], 1)[one], np.stack([ab, b, c], 1)[one]]
        two = (count == 2) & (ab >= 0) & (bc >= 0)
        result += [np.stack(t, 1)[two] for t in ((ab, b, bc), (a, ab, bc), (a, bc, c))]
    a, b, c = faces.T
    ab, bc, ca = edges.T
    result += [np.stack(t, 1)[count == 3] for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
    return np.concatenate([vertices, middles]), np.concatenate(result).astype(np.int32)
