"""Take a GLB apart and put it together again, changed: how the tests damage files."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield import gltf as scene_format
from eigenfield.coding import limits
from eigenfield.coding import stacking as pictures
from eigenfield.core.errors import FormatError
from eigenfield.gltf.container import parse_glb
from eigenfield.gltf.packed import unpack

EXTENSION = "EIGENFIELD_eigen_textures"
CODECS = ("png", "webp", "avif")
DOCUMENT = Path(__file__).parents[2] / "docs" / "format.md"


def split(data: bytes) -> tuple[dict[str, Any], bytes]:
    """JSON and binary chunk; of a packed file the JSON that a plain one has over the same chunk."""
    gltf, binary = split_packed(data)
    if "packed" not in gltf["extensions"][EXTENSION]:
        return gltf, binary
    return deepcopy(unpack(parse_glb(data)).json), binary


def split_packed(data: bytes) -> tuple[dict[str, Any], bytes]:
    """JSON and binary chunk as they are."""
    first = binary_start(data)
    return json.loads(data[20 : first - 8]), data[first : first + struct.unpack_from("<I", data, first - 8)[0]]


def binary_start(data: bytes) -> int:
    """The first byte of the binary chunk's data."""
    return 20 + struct.unpack_from("<I", data, 12)[0] + 8


def behind(data: bytes) -> bytes:
    """The chunks behind the binary one."""
    first = binary_start(data)
    return data[first + struct.unpack_from("<I", data, first - 8)[0] :]


def join(gltf: Any, binary: bytes, behind: bytes = b"") -> bytes:
    """A GLB of any JSON value (NaN too), binary chunk and chunks behind it."""
    return join_text(json.dumps(gltf).encode(), binary, behind)


def join_text(text: bytes, binary: bytes, behind: bytes = b"") -> bytes:
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    size = 12 + 8 + len(text) + 8 + len(binary) + len(behind)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    return struct.pack("<4sII", b"glTF", 2, size) + chunks + behind


def changed(data: bytes, change: Callable[[dict[str, Any], dict[str, Any], bytearray], None]) -> bytes:
    """`data` after `change(gltf, our extension, binary)`, which changes what it is given."""
    gltf, binary = split(data)
    body = bytearray(binary)
    change(gltf, gltf["extensions"][EXTENSION], body)
    return join(gltf, bytes(body), behind(data))


def view_end(gltf: dict[str, Any], index: int) -> int:
    """The first byte behind a buffer view in the binary chunk."""
    view = gltf["bufferViews"][index]
    return view.get("byteOffset", 0) + view["byteLength"]


def view_of(gltf: dict[str, Any], accessor: int) -> tuple[int, int]:
    """First and last byte of an accessor in the binary chunk."""
    view = gltf["bufferViews"][gltf["accessors"][accessor]["bufferView"]]
    return view["byteOffset"], view["byteOffset"] + view["byteLength"]


def outcome(path: Path, data: bytes, read: Callable[[Path], object] = scene_format.load) -> str | None:
    """The code with which `read` refuses `data`, None if it takes it; `validate` must agree, no other error escape."""
    path.write_bytes(data)
    findings = scene_format.validate(path)
    errors = [finding for finding in findings if finding.severity == "error"]
    try:
        read(path)
    except FormatError as error:
        assert error.path == str(path) and error.where and str(error).startswith(str(path))
        assert "\n" not in str(error)
        assert error.code in [finding.code for finding in errors]
        assert f"`{error.code}`" in DOCUMENT.read_text(encoding="utf-8"), error.code
        return error.code
    finally:
        path.unlink()
    # what only other viewers need, and captured views; and of a file that ends within its textures the rest is drawn
    others = ("/images", "/materials", "/meshes", "/textures", "/accessors", f"/extensions/{EXTENSION}/residual")
    assert all(finding.where.startswith(others) or finding.code == "truncated" for finding in errors)
    return None


def without(*keys):
    def change(gltf, extension, binary):
        place = gltf
        for key in keys[:-1]:
            place = place[key]
        del place[keys[-1]]

    return change


def setting(*keys, value):
    def change(gltf, extension, binary):
        place = gltf
        for key in keys[:-1]:
            place = place[key]
        place[keys[-1]] = value

    return change


def ours(*keys, value):
    return setting("extensions", limits.EXTENSION, *keys, value=value)


def not_ours(*keys):
    return without("extensions", limits.EXTENSION, *keys)


def numbers(where, dtype, index, value):
    """Overwrite one number of an accessor; `where(gltf, extension)` is its index."""

    def change(gltf, extension, binary):
        start, end = view_of(gltf, where(gltf, extension))
        array = np.frombuffer(bytes(binary[start:end]), dtype).copy()
        array[index] = value
        binary[start:end] = array.tobytes()

    return change


def attribute(name):
    return lambda gltf, extension: gltf["meshes"][0]["primitives"][0]["attributes"][name]


def indices(gltf, extension):
    return gltf["meshes"][0]["primitives"][0]["indices"]


def weights(gltf, extension):
    return extension["planes"][0]["bases"][0]["weights"]


def camera(name):
    return lambda gltf, extension: extension["cameras"][name]


def hull(gltf, extension):
    return extension["viewPlane"]["triangles"]


def one_texture_of(channels_last_picture):
    def change(gltf, extension, binary):
        data = pictures.encode(channels_last_picture, "png", 0)
        gltf["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data + bytes(-len(data) % 4)
        gltf["buffers"][0]["byteLength"] = len(binary)
        entry = extension["planes"][0]["bases"][0]["textures"][1]
        entry |= {"bufferView": len(gltf["bufferViews"]) - 1, "mimeType": "image/png"}

    return change


def chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack("<I4s", len(data), kind) + data


def glb(*chunks: bytes, version: int = 2) -> bytes:
    body = b"".join(chunks)
    return struct.pack("<4sII", b"glTF", version, 12 + len(body)) + body
