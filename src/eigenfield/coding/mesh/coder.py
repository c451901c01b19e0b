"""A triangle mesh with texture coordinates in few bytes.

Positions are rounded to a lattice; vertices of one sheet at one lattice point are one *place*. Then come, one after
the other:

1. the faces between places, each over an edge of those before (`mesh_kernels`), and with every new place its x, y and,
   where the lattice is not flat, z;
2. the z of a flat lattice, inverse depth (`mesh_value_kernels.code_depths`);
3. which vertex of its place each face's corner is, and the charts (`mesh_corner_kernels`);
4. texture coordinates of charts that are not a map of x and y (`mesh_value_kernels.code_textures`).

docs/coding.md describes the bytes.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding import limits
from eigenfield.coding.entropy import range_coder
from eigenfield.coding.mesh import corner_kernels
from eigenfield.coding.mesh.corner_kernels import MAPPED, MIRRORED, code_corners, corner_lists
from eigenfield.coding.mesh.face_kernels import Source, new_built, no_source, traverse
from eigenfield.coding.mesh.front_kernels import new_front
from eigenfield.coding.mesh.value_kernels import CONTEXTS, MIXTURES, code_depths, code_textures
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh, signed_areas
from eigenfield.imaging.graph import vertex_components

VERSION, OLD_VERSION = 2, 1
HEADER = struct.Struct("<BBBBIII16d")  # version, flat, digits of u and v, fine; places, faces, vertices; the lattice
OLD_OFFSET_DIGITS = 32  # the bits of a float32
OFFSET_RANGE_DIGITS = 3  # of an offset of a map beyond those of u and v: from -2 to 2, in halves of their step
MESH_MAX_STEPS = 2**20 - 1  # of lattice coordinates, either way
MESH_MAX_FINE_DIGITS = 8  # binary, the last ones of x and y
MESH_MAX_UV_DIGITS = 18  # binary, of texture coordinates in 0..1
MAPPED_CHART_MIN_VERTICES = 24  # of a chart with a map of its own, which takes 20 bytes


@dataclass(frozen=True, eq=False)
class _Welded:
    """A mesh on its lattice.

    Attributes:
        places: (n, 3) int64.
        place: (v,) of each vertex.
        faces: (m, 3) of vertices, no two corners at one place.
        sheet: (m,) of each face.
        label: Of each vertex its chart, whose `kinds` and `maps` are of `_chart_kinds`.
        codes: (v, 2) int64 texture coordinates.
        origin: (v,) which vertex of the given mesh each is.
    """

    places: NDArray[np.int64]
    place: NDArray[np.int32]
    faces: NDArray[np.int32]
    sheet: NDArray[np.int64]
    label: NDArray[np.int32]
    kinds: NDArray[np.int8]
    maps: NDArray[np.int64]
    codes: NDArray[np.int64]
    origin: NDArray[np.int64]


def encode_mesh(
    mesh: Mesh, lattice: Lattice, *, uv_bits: int = 12, fine: int = 0, sheets: Sequence[int] = ()
) -> tuple[bytes, Mesh]:
    """The bytes, and the mesh that they decode to: the same faces, each with its sense, in another order.

    The faces of a sheet stay together, and sheets in their order: those of the first come first. How many of each are
    left, `whole_faces` says.

    Positions are rounded to the lattice. Texture coordinates are off by at most half of 2^-uv_bits where they are
    coded; in charts that are an affine map of lattice x and y to within that, they are that map of the rounded x and
    y, so that texture and surface move together. Left out: vertices without a face, and faces two of whose corners
    are at one lattice point.

    Args:
        mesh: With texture coordinates.
        uv_bits: Binary digits of texture coordinates, 1 to 18.
        fine: On a flat lattice, the number of the last binary digits of x and y that are 0 at most vertices, 0 to 8.
            Where vertices inside a relief are at pixels and those of its contours between them, a step of 2^-fine
            pixels costs the latter alone.
        sheets: Number of faces of each sheet, in the mesh's order; sheets share no vertex. Empty: one.

    Raises:
        ValueError: The mesh has no texture coordinates, reaches 2^20 steps from the lattice's origin or behind its
            camera; or `uv_bits` or `fine` is out of range; or the sheets do not divide the mesh.
    """
    return _encode(mesh, lattice, uv_bits, fine, sheets)[:2]


def vertex_origins(data: bytes, mesh: Mesh, sheets: Sequence[int] = ()) -> NDArray[np.int64]:
    """(v,) which vertex of a mesh each vertex is that `decode_mesh` finds in the bytes of that mesh: the first of those
    that are one there.

    Args:
        sheets: As of `encode_mesh`.
    """
    _, flat, uv_bits, fine, _, _, _, *numbers = HEADER.unpack_from(data)
    lattice = Lattice(np.array(numbers).reshape(4, 4), bool(flat))
    again, _, origins = _encode(mesh, lattice, uv_bits, fine, sheets)
    assert again == data
    return origins


def _encode(
    mesh: Mesh, lattice: Lattice, uv_bits: int, fine: int, sheets: Sequence[int]
) -> tuple[bytes, Mesh, NDArray[np.int64]]:
    """As `encode_mesh`, and (v,) which vertex of the given mesh each one is."""
    if mesh.uv is None or not 1 <= uv_bits <= MESH_MAX_UV_DIGITS:
        raise ValueError("a mesh needs texture coordinates, of 1 to 18 binary digits")
    if not 0 <= fine <= (MESH_MAX_FINE_DIGITS if lattice.flat else 0):
        raise ValueError("0 to 8 fine digits, and only on a flat lattice")
    counts = sheets or (len(mesh.faces),)
    if sum(counts) != len(mesh.faces):
        raise ValueError("sheets that do not divide the mesh")
    welded = _weld_mesh(mesh, lattice, uv_bits, np.repeat(np.arange(len(counts)), counts))
    n, m, v = len(welded.places), len(welded.faces), len(welded.place)
    found: list[tuple[Mesh, NDArray[np.int64]]] = []

    def run(coder: Any) -> None:
        source, built = _source(welded), new_built(n, m)
        complete = traverse(coder, source, built, new_front(n, m), lattice.flat, fine)
        first, corners = corner_lists(built.faces, n)
        if lattice.flat:
            code_depths(coder, built, first, corners)
        blank = np.full(v, -1, np.int32)
        place, kinds, maps = source.number[welded.place], welded.kinds, welded.maps
        given = corner_kernels.Corners(welded.faces, welded.label, place, kinds, maps, blank, blank.copy())
        vertices = corner_kernels.new_vertices(v, n, m)
        offset_digits = uv_bits + OFFSET_RANGE_DIGITS
        complete = complete and code_corners(
            coder, given, source.face_order, built, vertices, first, corners, offset_digits
        )
        assert complete
        codes = welded.codes[given.order]
        code_textures(coder, vertices, lattice.points(built.points), codes, *corner_lists(vertices.faces, v))
        found[:] = [(_mesh(lattice, uv_bits, built, vertices, codes, VERSION), welded.origin[given.order])]

    header = HEADER.pack(VERSION, int(lattice.flat), uv_bits, fine, n, m, v, *lattice.matrix.reshape(-1))
    body = range_coder.coded_bytes(run, CONTEXTS, MIXTURES, room=4 * (n + m + v) + 1024)
    return range_coder.pad_bytes(header + body, max(n, m, v)), *found[0]


@dataclass(frozen=True, eq=False)
class PlacedMesh:
    """A mesh, and the (v, 3) int64 lattice coordinates of its vertices."""

    mesh: Mesh
    lattice: Lattice
    places: NDArray[np.int64]


def decode_mesh(data: bytes, where: str = "mesh", version: int = VERSION) -> Mesh:
    """The mesh of `encode_mesh`; see `decode_placed`."""
    return decode_placed(data, where, version).mesh


def decode_placed(data: bytes, where: str = "mesh", version: int = VERSION) -> PlacedMesh:
    """The mesh of `encode_mesh` on its lattice.

    Args:
        version: Of the codec: VERSION or OLD_VERSION.

    Raises:
        FormatError: `coded-truncated`, `coded-version`, `coded-size`, `coded-damaged`.
    """
    range_coder.check_header(data, HEADER.size, version, where)
    _, flat, uv_bits, fine, n, m, v, *numbers = HEADER.unpack_from(data)
    if n > limits.MAX_VERTICES or v > limits.MAX_VERTICES or m > limits.MAX_TRIANGLES:
        raise range_coder.damaged_error(f"{v} vertices and {m} faces, more than a scene may have", where)
    range_coder.check_numbers(data, max(n, m, v), limits.MAX_TRIANGLES, where)
    possible = flat <= 1 and 1 <= uv_bits <= MESH_MAX_UV_DIGITS and fine <= MESH_MAX_FINE_DIGITS * flat
    if not possible or not np.isfinite(numbers).all():
        raise range_coder.damaged_error("a lattice that cannot be", where)
    lattice = Lattice(np.array(numbers).reshape(4, 4), bool(flat))
    coder = range_coder.decoder(data[HEADER.size :], CONTEXTS, MIXTURES)
    built = new_built(n, m)
    if not traverse(coder, no_source(), built, new_front(n, m), lattice.flat, fine):
        raise range_coder.damaged_error("faces that cannot be", where)
    range_coder.check_end(coder, where)
    first, corners = corner_lists(built.faces, n)
    if lattice.flat:
        code_depths(coder, built, first, corners)
    vertices = corner_kernels.new_vertices(v, n, m)
    offset_digits = uv_bits + OFFSET_RANGE_DIGITS if version == VERSION else OLD_OFFSET_DIGITS
    none = corner_kernels.no_corners()
    if not code_corners(coder, none, np.zeros(0, np.int32), built, vertices, first, corners, offset_digits):
        raise range_coder.damaged_error("corners of faces that cannot be", where)
    codes = np.zeros((v, 2), np.int64)
    code_textures(coder, vertices, lattice.points(built.points), codes, *corner_lists(vertices.faces, v))
    range_coder.check_end(coder, where)
    mesh = _mesh(lattice, uv_bits, built, vertices, codes, version)
    assert mesh.uv is not None
    if not (np.abs(mesh.vertices) <= limits.MAX_NUMBER).all() or not (np.abs(mesh.uv) <= limits.MAX_NUMBER).all():
        raise range_coder.damaged_error("positions or texture coordinates that are not finite", where)
    return PlacedMesh(mesh, lattice, built.points[vertices.place])


def whole_faces(mesh: Mesh, lattice: Lattice) -> NDArray[np.bool_]:
    """(m,) whether the corners of a face are at three points of the lattice: `encode_mesh` leaves out the others."""
    return _whole_faces(np.rint(lattice.coordinates(mesh.vertices)), mesh.faces)


def _whole_faces(steps: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.bool_]:
    corner = steps[faces]
    return np.asarray((corner != np.roll(corner, 1, axis=1)).any(axis=2).all(axis=1))


def _weld_mesh(mesh: Mesh, lattice: Lattice, uv_bits: int, sheet: NDArray[np.int64]) -> _Welded:
    """The mesh on the lattice, without vertices that no face has; sheet: (m,) of each face."""
    assert mesh.uv is not None
    exact = lattice.coordinates(mesh.vertices)
    steps = np.rint(exact)
    if not (np.abs(steps) <= MESH_MAX_STEPS).all() or (lattice.flat and steps[:, 2].min(initial=0) < 0):
        raise ValueError("the mesh reaches beyond the lattice, or behind its camera")
    uv = mesh.uv.astype(np.float64)
    scale = 2.0**uv_bits
    if not (np.abs(uv) * scale <= MESH_MAX_STEPS).all():
        raise ValueError("texture coordinates that are not finite, or far beyond 0 to 1")
    label, kinds, maps = _chart_kinds(mesh.faces, exact, uv, uv_bits)
    codes = np.where((kinds[label] == MAPPED)[:, None], 0, np.rint(uv * scale)).astype(np.int64)
    alike = np.concatenate([steps.astype(np.int64), codes, label[:, None]], axis=1)
    _, first, same = np.unique(alike, axis=0, return_index=True, return_inverse=True)
    whole = _whole_faces(steps, mesh.faces)
    faces, sheet = first[same.reshape(-1)][mesh.faces[whole]], sheet[whole]
    used, faces = np.unique(faces, return_inverse=True)
    faces = faces.reshape(-1, 3)
    sheet_of = np.zeros((len(used), 1), np.int64)
    sheet_of[faces, 0] = sheet[:, None]
    if (sheet_of[faces, 0] != sheet[:, None]).any():
        raise ValueError("sheets that share a vertex")
    points = np.concatenate([steps[used].astype(np.int64).reshape(-1, 3), sheet_of], axis=1)
    points, place = np.unique(points, axis=0, return_inverse=True)
    return _Welded(
        np.ascontiguousarray(points[:, :3]), place.reshape(-1).astype(np.int32), faces.astype(np.int32), sheet,
        label[used], kinds, maps, codes[used], used,
    )  # fmt: skip


def _source(welded: _Welded) -> Source:
    n, m = len(welded.places), len(welded.faces)
    faces = welded.place[welded.faces]
    f = faces.astype(np.int64)
    edges = (f * n + np.roll(f, -1, axis=1)).reshape(-1)
    order = np.argsort(edges, kind="stable")
    seeds = np.lexsort([welded.places[f, 0].sum(axis=1), welded.sheet]).astype(np.int32)
    blank = np.full(n, -1, np.int32)
    return Source(
        welded.places, faces, seeds, edges[order], (order // 3).astype(np.int32), np.zeros(m, np.bool_), blank,
        blank.copy(), np.zeros(m, np.int32),
    )  # fmt: skip


def _mesh(lattice: Lattice, uv_bits: int, built: Any, vertices: Any, codes: NDArray[np.int64], version: int) -> Mesh:
    uv = codes / 2.0**uv_bits
    mapped = vertices.kinds[vertices.chart] == MAPPED
    place = vertices.place
    bits = uv_bits if version == VERSION else None
    uv[mapped] = _mapped_texture(built.points[place[mapped]], vertices.maps[vertices.chart[mapped]], bits)
    with np.errstate(over="ignore", invalid="ignore"):
        return Mesh(lattice.points(built.points)[place].astype(np.float32), vertices.faces, uv.astype(np.float32))


def _chart_kinds(
    faces: NDArray[np.int32], places: NDArray[np.float64], uv: NDArray[np.float64], uv_bits: int
) -> tuple[NDArray[np.int32], NDArray[np.int8], NDArray[np.int64]]:
    """(v,) the chart of every vertex, (charts,) kinds, (charts, 6) maps as `Vertices` has them.

    Charts are components connected by vertices. Those of a relief, laid out as a camera sees it, are an affine map of
    the lattice coordinates `places` (v, 3): a chart is MAPPED if u and v are within half a step of a x + b y + c.
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
        found = _affine(places[members, :2], uv[members], last, uv_bits) if len(members) else None
        if found is not None:
            last, offset = found
            kinds[chart], maps[chart] = MAPPED, np.concatenate([last.view(np.uint32), offset])
    return label, kinds, maps


def _affine(
    xy: NDArray[np.float64], uv: NDArray[np.float64], last: NDArray[np.float32] | None, uv_bits: int
) -> tuple[NDArray[np.float32], NDArray[np.int64]] | None:
    """(4,) a u-row, a v-row, and (2,) the codes of the offset; with the linear part of the last if that will do, which
    is cheaper."""
    if last is not None:
        same = _offset(last, xy, uv, uv_bits)
        if same is not None:
            return last, same
    if len(xy) < MAPPED_CHART_MIN_VERTICES:
        return None
    middle = xy.mean(axis=0)
    slope = np.linalg.lstsq(xy - middle, uv - uv.mean(axis=0), rcond=None)[0]
    linear = np.ascontiguousarray(slope.T, np.float32).reshape(4)
    offset = _offset(linear, xy, uv, uv_bits)
    return None if offset is None else (linear, offset)


def _offset(
    linear: NDArray[np.float32], xy: NDArray[np.float64], uv: NDArray[np.float64], uv_bits: int
) -> NDArray[np.int64] | None:
    """The codes of the offset of a map; None where a vertex would be more than half a step off."""
    rest = uv - xy @ linear.astype(np.float64).reshape(2, 2).T
    codes = np.rint((rest.min(axis=0) + rest.max(axis=0)) * 2.0**uv_bits) + 2.0 ** (uv_bits + 2)
    if not ((codes >= 0) & (codes < 2.0 ** (uv_bits + OFFSET_RANGE_DIGITS))).all():
        return None
    near = np.abs(rest - _offset_numbers(codes, uv_bits)).max() <= 0.5 / 2.0**uv_bits
    return codes.astype(np.int64) if near else None


def _offset_numbers(codes: NDArray[Any], uv_bits: int) -> NDArray[np.float64]:
    """The offsets of these codes, in halves of a step from -2."""
    return np.asarray(codes / 2.0 ** (uv_bits + 1) - 2.0, np.float64)


def _mapped_texture(places: NDArray[np.int64], maps: NDArray[np.int64], uv_bits: int | None) -> NDArray[np.float64]:
    """(v, 2) texture coordinates at lattice coordinates places (v, 3) by maps (v, 6). uv_bits: None where the offsets
    are the bits of float32 numbers."""
    x, y = places[:, 0].astype(np.float64), places[:, 1].astype(np.float64)
    with np.errstate(all="ignore"):
        m = maps.astype(np.uint32).view(np.float32).astype(np.float64)
        offset = m[:, 4:] if uv_bits is None else _offset_numbers(maps[:, 4:], uv_bits)
        return np.stack([m[:, 0] * x + m[:, 1] * y, m[:, 2] * x + m[:, 3] * y], axis=1) + offset
