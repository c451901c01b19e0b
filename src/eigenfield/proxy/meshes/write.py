"""Writing a mesh: PLY, with UVs as `s t` and v up, or binary glTF."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh
from eigenfield.core.version import __version__
from eigenfield.runtime.files import write_bytes

GLTF_VERTICES_TARGET, GLTF_INDICES_TARGET = 34962, 34963  # of a buffer view


def write_ply(mesh: Mesh, path: Path, *, origin: NDArray[np.float64] | None = None, overwrite: bool = False) -> None:
    """Write a little-endian PLY. Positions, and UVs that are multiples of 2^-24, are restored exactly.

    Args:
        origin: (3,) added to every position, which are float64 then; None or zero: nothing.

    Raises:
        OutputError: The file cannot be written.
    """
    is_far = origin is not None and bool(origin.any())
    columns = [(name, "<f8" if is_far else "<f4") for name in "xyz"] + [(name, "<f4") for name in "st"] * (
        mesh.uv is not None
    )
    table = np.empty(len(mesh.vertices), columns)
    for axis, name in enumerate("xyz"):
        table[name] = mesh.vertices[:, axis]
        if origin is not None and is_far:
            table[name] += origin[axis]
    if mesh.uv is not None:
        table["s"], table["t"] = mesh.uv[:, 0], np.float32(1) - mesh.uv[:, 1]
    faces = np.empty(len(mesh.faces), np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    faces["count"], faces["corners"] = 3, mesh.faces
    header = [
        "ply",
        "format binary_little_endian 1.0",
        f"element vertex {len(table)}",
        *(f"property {'double' if kind == '<f8' else 'float'} {name}" for name, kind in columns),
        f"element face {len(faces)}",
        "property list uchar int vertex_indices",
        "end_header",
    ]
    data = ("\n".join(header) + "\n").encode() + table.tobytes() + faces.tobytes()
    write_bytes(path, data, overwrite=overwrite)


def write_mesh(mesh: Mesh, path: Path, *, origin: NDArray[np.float64] | None = None, overwrite: bool = False) -> None:
    """Write a mesh as .ply or .glb, by the name's ending.

    Args:
        origin: (3,) as of `write_ply`; a .glb keeps it in its node.

    Raises:
        OptionError: `mesh-suffix`.
        OutputError: The file cannot be written.
    """
    check_mesh_name(path)
    if path.suffix.lower() == ".ply":
        write_ply(mesh, path, origin=origin, overwrite=overwrite)
    else:
        write_bytes(path, _glb(mesh, origin), overwrite=overwrite)


def check_mesh_name(path: Path) -> None:
    """Check that `write_mesh` can write a file of this name.

    Raises:
        OptionError: `mesh-suffix`.
    """
    if path.suffix.lower() not in (".ply", ".glb"):
        raise OptionError("mesh-suffix", f"{path.name} is neither .ply nor .glb", remedy="name one of these")


def _glb(mesh: Mesh, origin: NDArray[np.float64] | None) -> bytes:
    """glTF 2.0 in one binary chunk, with coordinates in the cameras' world."""
    from eigenfield.gltf.accessors import FLOAT, UINT32
    from eigenfield.gltf.buffer import Buffer
    from eigenfield.gltf.container import BINARY_CHUNK, CHUNK, file_head, json_bytes

    node = {"mesh": 0, "name": "proxy"}
    place = {} if origin is None or not origin.any() else {"translation": origin.tolist()}
    buffer = Buffer()
    bounds = {"min": mesh.vertices.min(axis=0).tolist(), "max": mesh.vertices.max(axis=0).tolist()}
    attributes = {"POSITION": buffer.accessor(mesh.vertices, FLOAT, "VEC3", GLTF_VERTICES_TARGET, **bounds)}
    if mesh.uv is not None:
        attributes["TEXCOORD_0"] = buffer.accessor(mesh.uv, FLOAT, "VEC2", GLTF_VERTICES_TARGET)
    indices = buffer.accessor(mesh.faces.reshape(-1), UINT32, "SCALAR", GLTF_INDICES_TARGET)
    document = {
        "asset": {"version": "2.0", "generator": f"eigenfield {__version__}"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [node | place],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": indices}]}],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": buffer.length}],
    }
    head = file_head(json_bytes(document), CHUNK.size + buffer.length, None)
    return b"".join([head, CHUNK.pack(buffer.length, BINARY_CHUNK), *buffer.parts])
