"""A triangle mesh with texture coordinates in few bytes."""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from eigenfield.errors import FormatError
from eigenfield.format import limits
from eigenfield.format.mesh_front_kernels import new_front
from eigenfield.format.mesh_corner_kernels import (
    MAPPED, MIRRORED, Corners, code_corners, corner_lists, new_vertices, no_corners,
)
from eigenfield.format.mesh_kernels import Source, new_built, no_source, traverse
from eigenfield.format.mesh_value_kernels import CONTEXTS, MIXTURES, code_depths, code_textures
from eigenfield.format.range_coder import coded, decoder, check_end
from eigenfield.mesh import Mesh

HEADER = struct.Struct("<BBBBIII16d")
VERSION = 1
REACH = 2**20 - 1
RATIO = 16  # vertices or faces that a byte stands for, at most: bounds what a decoder allocates
SPARE = 1024  # and so many more


@dataclass(frozen=True, eq=False)
class Lattice:
    """The grid to which positions are rounded: matrix (4, 4) float64 from (i, j, k, 1), whole numbers, to homogeneous
    world coordinates. flat: i and j are pixels of a camera in front of all, k is inverse depth: depth is coded over them.
    """

    matrix: NDArray[np.float64]
    flat: bool

    def points(self, steps: NDArray[np.int64]) -> NDArray[np.float64]:
        """(n, 3) lattice coordinates to world positions."""
        x, y, z = steps.astype(np.float64).T
        m = self.matrix
        with np.errstate(all="ignore"):
            row = [m[r, 0] * x + m[r, 1] * y + m[r, 2] * z + m[r, 3] for r in range(4)]
            return np.stack([row[0] / row[3], row[1] / row[3], row[2] / row[3]], axis=1)

    def coordinates(self, positions: ArrayLike) -> NDArray[np.float64]:
        """(n, 3) world positions to lattice coordinates, not rounded; not finite behind the camera."""
        p = np.asarray(positions, np.float64)
        h = np.concatenate([p, np.ones((len(p), 1))], axis=1) @ np.linalg.inv(self.matrix).T
        with np.errstate(all="ignore"):
            return h[:, :3] / h[:, 3:]


def camera_lattice(matrix: ArrayLike, step: float, inverse_step: float, origin: tuple[float, float] = (0.5, 0.5)) -> Lattice:
    m = np.asarray(matrix, np.float64)
    turn = np.linalg.inv(m[:, :3])
    centre = -turn @ m[:, 3]
    result = np.zeros((4, 4))
    result[:3, 0], result[:3, 1] = step * turn[:, 0], step * turn[:, 1]
    result[:3, 2], result[3, 2] = inverse_step * centre, inverse_step
    result[:3, 3] = turn @ np.array([*origin, 1.0]) + inverse_step / 2 * centre
    result[3, 3] = inverse_step / 2
    return Lattice(result, True)


def world_lattice(origin: ArrayLike, step: ArrayLike) -> Lattice:
    result = np.eye(4)
    result[:3, :3] = np.diag(np.broadcast_to(np.asarray(step, np.float64), 3))
    result[:3, 3] = origin
    return Lattice(result, False)


def encode_mesh(mesh: Mesh, lattice: Lattice, *, uv_bits: int = 12, uv_tolerance: float = 0.0):
    assert mesh.uv is not None
    steps = np.rint(lattice.coordinates(mesh.vertices))
    if not (np.abs(steps) <= REACH).all():
        raise ValueError("the mesh does not fit the lattice")
    points = steps.astype(np.int64)
    codes = np.rint(mesh.uv.astype(np.float64) * 2**uv_bits).astype(np.int64)
    places, place = np.unique(points, axis=0, return_inverse=True)
    place = place.reshape(-1).astype(np.int32)
    f = place[mesh.faces]
    faces = mesh.faces[(f != np.roll(f, 1, axis=1)).all(axis=1)]
    # one vertex for those alike in everything
    key, alike = np.unique(np.concatenate([place[:, None], codes], axis=1), axis=0, return_inverse=True)
    alike = alike.reshape(-1)
    used = np.unique(faces)
    n, m, v = len(np.unique(place[used])), len(faces), len(used)
    label, kinds, maps = _charts(mesh, faces, lattice.coordinates(mesh.vertices), codes, uv_tolerance)
    header = HEADER.pack(VERSION, int(lattice.flat), uv_bits, 0, n, m, v, *lattice.matrix.reshape(-1))
    out = {}

    def run(coder):
        source = _source(places, place[faces])
        built = new_built(n, m)
        fault = traverse(coder, source, built, new_front(n, m), lattice.flat)
        assert fault == 0
        first, corners = corner_lists(built.faces, n)
        if lattice.flat:
            coder.bits[31] = 20
            code_depths(coder, built, first, corners)
        vertices = new_vertices(v, n, m)
        full = np.full(len(points), -1, np.int32)
        given = Corners(faces, label, source.index[place], kinds, maps, full, full.copy())
        coder.bits[31] = 22
        assert code_corners(coder, given, source.face_order, built, vertices, first, corners)
        out["order"] = given.order[:v].copy()
        uv = codes[out["order"]]
        coder.bits[31] = 21
        code_textures(coder, vertices, lattice.points(built.points), uv, *corner_lists(vertices.faces, v))
        out["bits"]=coder.bits

    body = coded(run, CONTEXTS, MIXTURES, room=4 * (n + m) + 1024)
    data = header + body
    data += bytes(max(0, -(-(max(v, m) - SPARE) // RATIO) - len(data)))
    return data, out


def _charts(mesh, faces, places, codes, tolerance):
    """Charts by vertices; affine maps from lattice x, y to u, v where that is what they are."""
    count = len(mesh.vertices)
    f = faces.astype(np.int64)
    links = coo_array((np.ones(2 * len(f), np.int8), (np.r_[f[:, 0], f[:, 0]], np.r_[f[:, 1], f[:, 2]])), shape=(count, count))
    labels, label = connected_components(links, directed=False)
    kinds = np.zeros(labels, np.int8)
    maps = np.zeros((labels, 6), np.int64)
    uv = mesh.uv.astype(np.float64)
    corner = codes[f]
    one, two = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    area = np.bincount(label[f[:, 0]], one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0], labels)
    kinds[area < 0] = MIRRORED
    order = np.argsort(label, kind="stable")
    starts = np.searchsorted(label[order], np.arange(labels + 1))
    linear = None
    for c in range(labels):
        members = order[starts[c] : starts[c + 1]]
        if len(members) < 3 or tolerance <= 0:
            continue
        fit = _affine(places[members, :2], uv[members], linear, tolerance)
        if fit is not None:
            kinds[c] = MAPPED
            maps[c] = fit.view(np.uint32)
            linear = fit[:4]
    return label.astype(np.int32), kinds, maps


def _affine(xy, uv, linear, tolerance):
    """The float32 map."""
    if linear is not None:
        A = linear.astype(np.float64).reshape(2, 2)
        rest = uv - xy @ A.T
        shift = ((rest.min(axis=0) + rest.max(axis=0)) / 2).astype(np.float32)
        if np.abs(rest - shift).max() <= tolerance:
            return np.concatenate([linear, shift])
    B = np.concatenate([xy, np.ones((len(xy), 1))], axis=1)
    solution = np.linalg.lstsq(B, uv, rcond=None)[0]
    A = solution[:2].T.astype(np.float32)
    rest = uv - xy @ A.T.astype(np.float64)
    shift = ((rest.min(axis=0) + rest.max(axis=0)) / 2).astype(np.float32)
    if np.abs(rest - shift).max() > tolerance:
        return None
    return np.concatenate([A.reshape(-1), shift])


def _source(points, faces):
    n, m = len(points), len(faces)
    f = faces.astype(np.int64)
    edges = (f * n + np.roll(f, -1, axis=1)).reshape(-1)
    order = np.argsort(edges, kind="stable")
    seeds = np.argsort(points[f, 0].sum(axis=1), kind="stable").astype(np.int32)
    blank = np.full(n, -1, np.int32)
    return Source(points, faces, seeds, edges[order], (order // 3).astype(np.int32), np.zeros(m, np.bool_),
                  blank, blank.copy(), np.zeros(m, np.int32))


def decode_mesh(data: bytes, where: str = "mesh"):
    if len(data) < HEADER.size:
        raise FormatError("mesh-coded", "too short", where=where)
    version, flat, bits, _, n, m, v, *matrix = HEADER.unpack_from(data)
    lattice = Lattice(np.array(matrix).reshape(4, 4), bool(flat))
    coder = decoder(data[HEADER.size:], CONTEXTS, MIXTURES)
    built = new_built(n, m)
    fault = traverse(coder, no_source(), built, new_front(n, m), lattice.flat)
    if fault: raise FormatError("mesh-coded", f"fault {fault}", where=where)
    first, corners = corner_lists(built.faces, n)
    if lattice.flat:
        code_depths(coder, built, first, corners)
    vertices = new_vertices(v, n, m)
    if not code_corners(coder, no_corners(), np.zeros(0, np.int32), built, vertices, first, corners): raise FormatError("mesh-coded","corners", where=where)
    codes = np.zeros((v, 2), np.int64)
    world = lattice.points(built.points)
    code_textures(coder, vertices, world, codes, *corner_lists(vertices.faces, v))
    uv = codes / 2.0**bits
    maps = vertices.maps.astype(np.uint32).view(np.float32).astype(np.float64)[vertices.chart]
    mapped = vertices.kinds[vertices.chart] == MAPPED
    x, y = built.points[vertices.place, 0], built.points[vertices.place, 1]
    uv[mapped] = np.stack([maps[:, 0] * x + maps[:, 1] * y + maps[:, 4], maps[:, 2] * x + maps[:, 3] * y + maps[:, 5]], axis=1)[mapped]
    return Mesh(world[vertices.place].astype(np.float32), vertices.faces, uv.astype(np.float32))
