"""A script that runs Poisson reconstruction in a process of its own.

pycolmap's wrapper keeps options of one call for the next, writes files, and cannot be stopped; a child process contains
all three. Standard input: a float32 array (n, 6) of positions and normals, then (depth,). Standard output: vertices (n,
3) float32 and faces (m, 3) int32, as `numpy.save` writes them.
"""

from __future__ import annotations

import io
import os
import sys
import tempfile
from pathlib import Path

import numpy as np


def main() -> None:
    """Read the points, reconstruct, and write the mesh."""
    message = io.BytesIO(sys.stdin.buffer.read())
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what the library prints must not get into the answer
    points, (depth,) = (np.load(message, allow_pickle=False) for _ in range(2))
    with tempfile.TemporaryDirectory(prefix="eigenfield-poisson-") as folder:
        source, result = Path(folder) / "points.ply", Path(folder) / "mesh.ply"
        names = ("x", "y", "z", "nx", "ny", "nz")
        header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
        header += [f"property float {name}" for name in names]
        header += [f"property uchar {name}" for name in ("red", "green", "blue")] + ["end_header\n"]
        table = np.zeros(len(points), np.dtype([("p", "<f4", 6), ("c", "u1", 3)]))
        table["p"] = points
        source.write_bytes("\n".join(header).encode() + table.tobytes())

        import pycolmap

        pycolmap.logging.minloglevel = 2
        options = pycolmap.PoissonMeshingOptions()
        options.depth, options.trim, options.color, options.num_threads = int(depth), 0.0, False, 1
        pycolmap.poisson_meshing(source, result, options)
        vertices, faces = _read_ply(result)
    written = io.BytesIO()
    for array in (vertices, faces):
        np.save(written, array, allow_pickle=False)
    with answer:
        answer.write(written.getvalue())


def _read_ply(path: Path) -> tuple[np.ndarray, np.ndarray]:
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = [line.split() for line in data[:end].decode().splitlines()]
    counts = {line[1]: int(line[2]) for line in lines if line[0] == "element"}
    vertex_lines = lines[: next(i for i, line in enumerate(lines) if line[:2] == ["element", "face"])]
    kinds = {"float": "<f4", "uchar": "u1", "int": "<i4", "double": "<f8"}
    fields = [(line[2], kinds[line[1]]) for line in vertex_lines if line[0] == "property"]
    (listing,) = [line for line in lines if line[:2] == ["property", "list"]]
    vertex, face = np.dtype(fields), np.dtype([("count", kinds[listing[2]]), ("corners", kinds[listing[3]], 3)])
    table = np.frombuffer(data, vertex, counts["vertex"], end)
    corners = np.frombuffer(data, face, counts["face"], end + counts["vertex"] * vertex.itemsize)["corners"]
    return np.stack([table[name] for name in ("x", "y", "z")], axis=1).astype(np.float32), corners.astype(np.int32)


if __name__ == "__main__":
    main()
