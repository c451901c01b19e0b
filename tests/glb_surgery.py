"""Take a GLB apart and put it together again, changed: how the tests damage files."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from typing import Any

EXTENSION = "EIGENFIELD_eigen_textures"


def split(data: bytes) -> tuple[dict[str, Any], bytes]:
    """JSON and binary chunk."""
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[20 + length + 8 :]


def join(gltf: Any, binary: bytes) -> bytes:
    """A GLB of any JSON value (NaN too) and binary chunk."""
    return join_text(json.dumps(gltf).encode(), binary)


def join_text(text: bytes, binary: bytes) -> bytes:
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    size = 12 + 8 + len(text) + 8 + len(binary)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, size) + chunks


def changed(data: bytes, change: Callable[[dict[str, Any], dict[str, Any], bytearray], None]) -> bytes:
    """`data` after `change(gltf, our extension, binary)`, which changes what it is given."""
    gltf, binary = split(data)
    body = bytearray(binary)
    change(gltf, gltf["extensions"][EXTENSION], body)
    return join(gltf, bytes(body))


def view_of(gltf: dict[str, Any], accessor: int) -> tuple[int, int]:
    """First and last byte of an accessor in the binary chunk."""
    view = gltf["bufferViews"][gltf["accessors"][accessor]["bufferView"]]
    return view["byteOffset"], view["byteOffset"] + view["byteLength"]
