"""Writing a mesh as PLY, its UVs as `s t` with v up."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from eigenfield.files import write_bytes
from eigenfield.mesh import Mesh


def write_ply(mesh: Mesh, path: Path, *, overwrite: bool = False) -> None:
    """Little-endian PLY. UVs that are multiples of 2^-24 come back to the bit, as positions always do.

    Raises OutputError.
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
