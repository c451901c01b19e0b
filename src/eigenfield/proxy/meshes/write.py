"""Writing a mesh: PLY, with UVs as `s t` and v up, or binary glTF."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.version import __version__
from eigenfield.runtime.files import write_bytes


def write_ply(mesh: Mesh, path: Path, *, overwrite: bool = False) -> None:
    """Write a little-endian PLY. Positions, and UVs that are multiples of 2^-24, are restored exactly.

    Args:
        mesh: The mesh.
        path: The file.
        overwrite: Replace an existing file.

    Raises:
        OutputError: The file cannot be written.
    """
    names = ["x", "y", "z"] + (["s", "t"] if mesh.uv is not None else [])
    table = mesh.vertices
    if mesh.uv is not None:
        table = np.hstack([mesh.vertices, mesh.uv[:, :1], np.float32(1) - mesh.uv[:, 1:]])
    faces = np.empty(len(mesh.faces), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"], faces["corners"] = 3, mesh.faces
    header = [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {len(table)}",
        *(f"property float {name}" for name in names),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    data = ("\n".join(header) + "\n").encode() + table.astype("<f4").tobytes() + faces.tobytes()
    write_bytes(path, data, overwrite=overwrite)


def write_mesh(mesh: Mesh, path: Path, *, overwrite: bool = False) -> None:
    """Write a mesh as .ply or .glb, by the name's ending.

    Args:
        mesh: The mesh.
        path: The file.
        overwrite: Replace an existing file.

    Raises:
        OptionError: `mesh-suffix`.
        OutputError: The file cannot be written.
    """
    check_mesh_name(path)
    if path.suffix.lower() == ".ply":
        write_ply(mesh, path, overwrite=overwrite)
    else:
        write_bytes(path, _glb(mesh), overwrite=overwrite)


def check_mesh_name(path: Path) -> None:
    """Check that `write_mesh` can write a file of this name.

    Args:
        path: The file.

    Raises:
        OptionError: `mesh-suffix`.
    """
    if path.suffix.lower() not in (".ply", ".glb"):
        raise OptionError("mesh-suffix", f"{path.name} is neither .ply nor .glb", remedy="name one of these")


def _glb(mesh: Mesh) -> bytes:
    """glTF 2.0 in one binary chunk, with coordinates in the cameras' world."""
    parts: list[tuple[str, Any, dict[str, Any]]] = [
        (
            "POSITION",
            mesh.vertices.astype("<f4"),
            {"type": "VEC3", "min": mesh.vertices.min(axis=0).tolist(), "max": mesh.vertices.max(axis=0).tolist()},
        )
    ]
    if mesh.uv is not None:
        parts.append(("TEXCOORD_0", mesh.uv.astype("<f4"), {"type": "VEC2"}))
    parts.append(("indices", mesh.faces.astype("<u4").reshape(-1), {"type": "SCALAR"}))
    views, accessors, attributes, data = [], [], {}, b""
    for number, (name, values, about) in enumerate(parts):
        indices = name == "indices"
        views.append(
            {
                "buffer": 0,
                "byteOffset": len(data),
                "byteLength": values.nbytes,
                "target": 34963 if indices else 34962,
            }
        )
        accessors.append(
            {"bufferView": number, "componentType": 5125 if indices else 5126, "count": len(values), **about}
        )
        if not indices:
            attributes[name] = number
        data += values.tobytes()
    document = {
        "asset": {"version": "2.0", "generator": f"eigenfield {__version__}"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "proxy"}],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": len(parts) - 1}]}],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(data)}],
    }
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    length = 12 + 8 + len(text) + 8 + len(data)
    return b"".join(
        [
            struct.pack("<4sII", b"glTF", 2, length),
            struct.pack("<I4s", len(text), b"JSON"),
            text,
            struct.pack("<I4s", len(data), b"BIN\0"),
            data,
        ]
    )
