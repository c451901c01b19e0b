"""A script that runs Poisson reconstruction in a process of its own.

pycolmap's wrapper keeps options of one call for the next, writes files, and cannot be stopped; a child process contains
all three. Argument: a folder for its files. Standard input: a float32 array (n, 6) of positions and normals, then
(depth,). Standard output: vertices (n, 3) float32 and faces (m, 3) int32, as `numpy.save` writes them.
"""

from __future__ import annotations

import io
import os
import sys
from pathlib import Path

import numpy as np
from trimesh.exchange.ply import load_ply


def main() -> None:
    """Read the points, reconstruct, and write the mesh."""
    message = io.BytesIO(sys.stdin.buffer.read())
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what the library prints must not get into the answer
    points, (depth,) = (np.load(message, allow_pickle=False) for _ in range(2))
    source, result = (Path(sys.argv[1]) / name for name in ("points.ply", "mesh.ply"))
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
    with result.open("rb") as file:
        mesh = load_ply(file, fix_texture=False, skip_materials=True)
    written = io.BytesIO()
    for array in (mesh["vertices"].astype(np.float32), mesh["faces"].astype(np.int32)):
        np.save(written, array, allow_pickle=False)
    with answer:
        answer.write(written.getvalue())


if __name__ == "__main__":
    main()
