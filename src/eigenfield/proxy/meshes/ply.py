"""PLY (Turk, "The PLY Polygon File Format", 1994): ASCII and binary, with lists of any length.

UVs are those of the vertices (`s t`, `u v`, `texture_u texture_v`) or a list `texcoord` of each face, as MeshLab writes
it, with v up.
"""

from __future__ import annotations

import logging
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.proxy.meshes.formats import MeshFormat, RawMesh, parse_numbers
from eigenfield.proxy.meshes.ply_kernels import copy_lists, measure_rows
from eigenfield.proxy.meshes.polygons import (
    Polygons,
    check_range,
    split_seams,
    strip_triangles,
    triangulate_polygons,
)

log = logging.getLogger("eigenfield.proxy")

PLY_UV_NAMES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))
_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip
_FORMATS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_LINE_MAX_BYTES = 4096


class _Property(NamedTuple):
    """A property of an element: its name, the type of its numbers, and of a list's length, empty for a scalar."""

    name: str
    kind: str
    length: str


class _Element(NamedTuple):
    """An element as the header announces it."""

    name: str
    rows: int
    properties: list[_Property]

    def lists(self) -> list[_Property]:
        return [each for each in self.properties if each.length]


class _Table(NamedTuple):
    """The rows of an element.

    Attributes:
        scalars: (rows,) of each scalar property.
        lists: Numbers of all rows of each list property, one row after the other, and (rows,) how many each row has.
        end: The first byte, or number of an ASCII file, behind it.
    """

    scalars: dict[str, NDArray[np.float64]]
    lists: dict[str, tuple[NDArray[np.float64], NDArray[np.int64]]]
    end: int


def read_ply(data: bytes, path: Path) -> RawMesh:
    """Geometry and texture coordinates of a PLY file.

    Raises:
        ProxyError: `proxy-index-range`, `proxy-polygon`.
        ValueError: Damaged data.
    """
    order, elements, start = _read_header(data)
    names = {element.name: [each.name for each in element.properties if not each.length] for element in elements}
    if "vertex" not in names:
        raise ValueError(f"it has no element vertex, but {', '.join(names) or 'none'}")
    if not all(axis in names["vertex"] for axis in "xyz"):
        raise ValueError("its vertices have no x, y and z")
    tables = _read_ascii(data, elements, start) if order == "" else _read_binary(data, elements, start, order)
    vertex = tables["vertex"]
    vertices = np.stack([vertex.scalars[axis] for axis in "xyz"], axis=1)
    faces, uv = np.zeros((0, 3), np.int64), None
    for element in elements:
        if element.name in ("tristrips", "face") and element.rows:
            table = tables[element.name]
            name = _index_list(element)
            corners, sizes = table.lists[name]
            polygons = Polygons(corners.astype(np.int64), sizes)
            if element.name == "tristrips":
                ends = np.insert(polygons.corners, np.cumsum(sizes)[:-1], -1)
                check_range(ends[ends != -1], len(vertices))
                faces = np.concatenate([faces, strip_triangles(ends)])
                continue
            uv = _corner_uv(table, sizes)
            found, uv = triangulate_polygons(polygons, uv, vertices)
            faces = np.concatenate([faces, found])
    if uv is not None and len(uv) == len(faces):
        origin, faces, uv = split_seams(faces, uv)
        return RawMesh(vertices[origin], faces, _flip_v(uv))
    for u, v in PLY_UV_NAMES:
        if u in vertex.scalars and v in vertex.scalars:
            return RawMesh(vertices, faces, _flip_v(np.stack([vertex.scalars[u], vertex.scalars[v]], axis=1)))
    return RawMesh(vertices, faces, None)


def _index_list(element: _Element) -> str:
    """The list that names a face's vertices: by its name, else the first of whole numbers."""
    names = [each.name for each in element.lists() if each.kind[0] != "f"]
    known = [name for name in ("vertex_indices", "vertex_index") if name in names]
    if not names:
        raise ValueError(f"its element {element.name} has no list of vertices")
    return (known or names)[0]


def _corner_uv(table: _Table, sizes: NDArray[np.int64]) -> NDArray[np.float64] | None:
    if "texcoord" not in table.lists:
        return None
    texels, counts = table.lists["texcoord"]
    if (counts == 2 * sizes).all():
        return texels.reshape(-1, 2)
    log.warning("texture coordinates of some faces only: ignored")
    return None


def _flip_v(uv: NDArray[np.float64]) -> NDArray[np.float64]:
    return uv * (1.0, -1.0) + (0.0, 1.0)


def _read_header(data: bytes) -> tuple[str, list[_Element], int]:
    """The byte order ("" for ASCII), the elements, and where their data begin."""
    first = data[:_LINE_MAX_BYTES]
    ending = b"\r\n" if first[3:5] == b"\r\n" else b"\r" if first[3:4] == b"\r" else b"\n"
    order, elements, at = None, list[_Element](), 0
    for number in range(1, 1 << 16):
        end = data.find(ending, at, at + _LINE_MAX_BYTES)
        if end < 0:
            raise ValueError("its header does not end")
        words = data[at:end].decode("latin-1").split()
        at = end + len(ending)
        match words:
            case ["ply"] if number == 1:
                pass
            case _ if number == 1:
                raise ValueError("does not begin with ply")
            case ["format", name, *_] if name in _FORMATS:
                order = _FORMATS[name]
            case ["format", *_]:
                raise ValueError(f"line {number}: an unknown format")
            case ["element", name, count]:
                elements.append(_Element(name, int(count), []))
                if int(count) < 0:
                    raise ValueError(f"line {number}: {count} elements")
            case ["property", "list", length, kind, name] if elements and length in _TYPES and kind in _TYPES:
                if _TYPES[length][0] == "f":
                    raise ValueError(f"line {number}: a list's length is no whole number")
                elements[-1].properties.append(_Property(name, _TYPES[kind], _TYPES[length]))
            case ["property", kind, name] if elements and kind in _TYPES:
                elements[-1].properties.append(_Property(name, _TYPES[kind], ""))
            case ["end_header"]:
                if order is None:
                    raise ValueError("its header names no format")
                return order, elements, at
            case [] | ["comment" | "obj_info", *_]:
                pass
            case _:
                raise ValueError(f"line {number} of the header: {' '.join(words)[:60]!r} is unknown")
    raise ValueError("its header does not end")


def _read_binary(data: bytes, elements: list[_Element], start: int, order: str) -> dict[str, _Table]:
    raw = np.frombuffer(data, np.uint8)
    tables = {}
    for element in elements:
        sizes = [np.dtype(each.kind).itemsize for each in element.properties]
        lengths = [np.dtype(each.length).itemsize if each.length else 0 for each in element.properties]
        signed = [each.length.startswith("i") for each in element.properties]
        table = _equal_rows(data, element, start, order)
        if table is None:
            layout = np.array([lengths, sizes, signed], np.int64)
            counts = np.zeros((element.rows, len(sizes)), np.int64)
            end = measure_rows(raw, start, layout, order == ">", counts)
            if end < 0:
                raise ValueError(_cut_off(element, -1 - end))
            table = _Table({}, {}, end)
            for k, each in enumerate(element.properties):
                kind = np.dtype(order + each.kind)
                copied = np.empty(int(counts[:, k].sum()) * kind.itemsize, np.uint8)
                copy_lists(raw, start, layout, counts, k, copied)
                numbers = copied.view(kind).astype(np.float64)
                if each.length:
                    table.lists[each.name] = numbers, counts[:, k]
                else:
                    table.scalars[each.name] = numbers
        tables[element.name] = table
        start = table.end
    if start < len(data):
        log.info("%d bytes behind the last element are ignored", len(data) - start)
    return tables


def _equal_rows(data: bytes, element: _Element, start: int, order: str) -> _Table | None:
    """The rows of an element whose lists are all as long as those of the first row; None if they are not."""
    fields, at = list[tuple[str, str, int]](), start
    lengths = {}
    for k, each in enumerate(element.properties):
        count = 1
        if each.length:
            kind = np.dtype(order + each.length)
            if element.rows == 0 or at + kind.itemsize > len(data):
                count = 0
            else:
                count = int(np.frombuffer(data, kind, 1, at)[0])
            at += kind.itemsize
            fields.append((f"n{k}", kind.str, 1))
            lengths[k] = count
        if not 0 <= count <= len(data):
            return None
        fields.append((f"p{k}", order + each.kind, count))
        at += count * np.dtype(each.kind).itemsize
    row = np.dtype([(name, kind, (count,)) for name, kind, count in fields])
    end = start + element.rows * row.itemsize
    if end > len(data):
        if not lengths:
            raise ValueError(_cut_off(element, (len(data) - start) // row.itemsize))
        return None
    rows = np.frombuffer(data, row, element.rows, start) if row.itemsize else np.zeros(element.rows, row)
    if any((rows[f"n{k}"] != count).any() for k, count in lengths.items()):
        return None
    table = _Table({}, {}, end)
    for k, each in enumerate(element.properties):
        numbers = rows[f"p{k}"].reshape(-1).astype(np.float64)
        if each.length:
            table.lists[each.name] = numbers, np.full(element.rows, lengths[k], np.int64)
        else:
            table.scalars[each.name] = numbers
    return table


def _cut_off(element: _Element, found: int) -> str:
    return f"{element.rows} rows of its element {element.name} announced, {found} found"


def _read_ascii(data: bytes, elements: list[_Element], start: int) -> dict[str, _Table]:
    """Rows are read number by number, wherever lines end; blank lines do no harm."""
    try:
        numbers = parse_numbers(data[start:])
    except ValueError:
        raise ValueError(_no_number(data, start)) from None
    tables, at = {}, 0
    begins = []
    for element in elements:
        layout = np.array([[bool(each.length) for each in element.properties], [1] * len(element.properties)], np.int64)
        layout = np.concatenate([layout, np.zeros((1, layout.shape[1]), np.int64)])
        counts = np.zeros((element.rows if element.properties else 0, len(element.properties)), np.int64)
        end = measure_rows(numbers, at, layout, False, counts)
        if end < 0:
            raise ValueError(_cut_off(element, -1 - end))
        table = _Table({}, {}, end)
        for k, each in enumerate(element.properties):
            copied = np.empty(int(counts[:, k].sum()))
            copy_lists(numbers, at, layout, counts, k, copied)
            if each.length:
                table.lists[each.name] = copied, counts[:, k]
            else:
                table.scalars[each.name] = copied
        widths = counts.sum(axis=1) + layout[0].sum()
        begins.append(at + np.cumsum(widths) - widths)
        tables[element.name] = table
        at = end
    if at < len(numbers):
        _check_lines(data, start, np.concatenate(begins) if begins else np.zeros(0, np.int64))
        log.info("%d numbers behind the last element are ignored", len(numbers) - at)
    return tables


def _check_lines(data: bytes, start: int, begins: NDArray[np.int64]) -> None:
    """Every row begins a line: where numbers are left over, lines may hold more than their rows."""
    body = np.frombuffer(data, np.uint8, offset=start)
    blank = body <= 32
    token = np.flatnonzero(~blank & np.concatenate([[True], blank[:-1]]))
    line = np.cumsum((body == 10) | ((body == 13) & ~np.concatenate([body[1:] == 10, [False]])))[token]
    inside = begins[(begins > 0)]
    wrong = inside[line[inside] == line[inside - 1]]
    if len(wrong):
        number = int(line[wrong[0]]) + len(data[:start].splitlines()) + 1
        raise ValueError(f"line {number} holds more numbers than a row of its element")


def _no_number(data: bytes, start: int) -> str:
    """Which line of an ASCII file does not consist of numbers."""
    for number, line in enumerate(data.splitlines(), 1):
        if number > len(data[:start].splitlines()):
            try:
                for word in line.split():
                    float(word)
            except ValueError:
                return f"line {number} does not consist of numbers"
    return "a line does not consist of numbers"


PLY = MeshFormat(
    "PLY", (".ply",), read_ply,
    "text and binary of both byte orders; numbers and lists of any type and length; polygons and `tristrips`; UVs of "
    "vertices (`s t`, `u v`, `texture_u texture_v`) or of corners (`texcoord`); comments in any encoding, blank lines",
    "data that end early, rows of a text that hold more than the header says, a file without an element `vertex`",
    "colours, normals, other elements, what follows the last element",
    "trimesh 5.2, Blender 5.0 (bpy), MeshLab (pymeshlab 2025.7), eigenfield",
)  # fmt: skip
