"""Mesh files as other programs write them, made from plain arrays."""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import dataclass, field
from typing import Any

import numpy as np

COMPONENTS = {"i1": 5120, "u1": 5121, "<i2": 5122, "<u2": 5123, "<u4": 5125, "<f4": 5126}
KINDS = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}


@dataclass
class GltfFile:
    """A glTF file to which accessors are added one by one.

    Attributes:
        tree: The JSON but for its buffers.
        body: The bytes of the one buffer.
    """

    tree: dict[str, Any] = field(default_factory=lambda: {"asset": {"version": "2.0"}})
    body: bytes = b""

    def view(self, data: bytes, stride: int | None = None) -> int:
        """A buffer view of some bytes, by its index; others lie before it."""
        self.body += b"\x5a" * (-len(self.body) % 4 + 4)
        views = self.tree.setdefault("bufferViews", [])
        views.append({"buffer": 0, "byteOffset": len(self.body), "byteLength": len(data)})
        if stride is not None:
            views[-1]["byteStride"] = stride
        self.body += data
        return len(views) - 1

    def accessor(self, array, kind, *, stride=None, offset=0, sparse=None, base=True, **members) -> int:
        """An accessor of (n, k) or (n,) numbers of a type, by its index.

        Args:
            array: The numbers that a reader must find.
            kind: Their type, as NumPy calls it.
            stride: Bytes from one element to the next; None: packed.
            offset: Bytes before the first element, in the view.
            sparse: Elements that are wrong in the view and put right by `sparse`.
            base: Whether there is a view; if not, all that is not sparse is 0.
            members: Of the accessor.
        """
        rows = np.asarray(array, kind).reshape(len(array), -1)
        entry = {"componentType": COMPONENTS[kind], "count": len(rows), "type": KINDS[rows.shape[1]], **members}
        if sparse is not None:
            sparse = np.asarray(sparse, np.int64)
            entry["sparse"] = {
                "count": len(sparse),
                "indices": {"bufferView": self.view(sparse.astype("<u2").tobytes()), "componentType": 5123},
                "values": {"bufferView": self.view(b"\1\2" + rows[sparse].tobytes()), "byteOffset": 2},
            }
            rows = rows.copy()
            rows[sparse] = 1
        if base:
            packed = rows.shape[1] * rows.itemsize
            table = np.full((len(rows), stride or packed), 0x77, np.uint8)
            table[:, :packed] = np.ascontiguousarray(rows).view(np.uint8).reshape(len(rows), -1)
            data = b"\x11" * offset + table.tobytes()
            entry["bufferView"] = self.view(data[: len(data) - (stride or packed) + packed], stride)
            if offset:
                entry["byteOffset"] = offset
        self.tree.setdefault("accessors", []).append(entry)
        return len(self.tree["accessors"]) - 1

    def mesh(self, *primitives: dict[str, Any], **members) -> int:
        """A mesh, by its index; where there are no nodes yet, one shows it."""
        self.tree.setdefault("meshes", []).append({"primitives": list(primitives), **members})
        return len(self.tree["meshes"]) - 1

    def glb(self) -> bytes:
        """The file in one piece."""
        text = json.dumps({**self._tree(), "buffers": [{"byteLength": len(self.body)}]}).encode()
        text += b" " * (-len(text) % 4)
        body = self.body + bytes(-len(self.body) % 4)
        head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(body), len(text), 0x4E4F534A)
        return head + text + struct.pack("<II", len(body), 0x004E4942) + body

    def gltf(self, uri: str | None = None) -> bytes:
        """The file as text, with its data in it or at a URI."""
        uri = uri or "data:application/octet-stream;base64," + base64.b64encode(self.body).decode()
        return json.dumps({**self._tree(), "buffers": [{"byteLength": len(self.body), "uri": uri}]}).encode()

    def _tree(self) -> dict[str, Any]:
        shown = {"nodes": [{"mesh": i} for i in range(len(self.tree.get("meshes", [])))]}
        tree = {**shown, **self.tree}
        return {"scenes": [{"nodes": list(range(len(tree["nodes"])))}], "scene": 0, **tree}


def ply_file(elements, order="ascii", comments=(), newline=b"\n", blank=False, trailing=b"") -> bytes:
    """A PLY file.

    Args:
        elements: (name, properties, rows): properties are (name, type) or (name, type, type of the length), rows have a
            number or a list for each.
        order: "ascii", "<" or ">".
        comments: Bytes of lines of the header.
        newline: That ends a line.
        blank: Whether blank lines stand between the rows of a text.
        trailing: What follows the last element.
    """
    words = {"i1": "char", "u1": "uchar", "i2": "short", "u2": "ushort", "i4": "int", "u4": "uint", "f4": "float"}
    words["f8"] = "double"
    name = {"ascii": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    lines = [b"ply", f"format {name} 1.0".encode(), *(b"comment " + text for text in comments)]
    body = b""
    for element, properties, rows in elements:
        lines.append(f"element {element} {len(rows)}".encode())
        for each, kind, *length in properties:
            lines.append(f"property {f'list {words[length[0]]} ' if length else ''}{words[kind]} {each}".encode())
        for row in rows:
            if order == "ascii":
                numbers = []
                for (_, _, *length), value in zip(properties, row, strict=True):
                    numbers += [len(value), *value] if length else [value]
                body += " ".join(map(repr, np.array(numbers, object).tolist())).encode() + newline
                body += newline if blank else b""
                continue
            for (_, kind, *length), value in zip(properties, row, strict=True):
                if length:
                    body += np.array(len(value), order + length[0]).tobytes()
                body += np.array(value, order + kind).tobytes()
    return newline.join([*lines, b"end_header"]) + newline + body + trailing
