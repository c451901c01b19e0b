"""The process in which xatlas works: a mesh comes in on standard input, its atlas goes out on standard output.

Run as a script, with nothing of this package imported: xatlas takes minutes on a large mesh, says nothing, cannot be
interrupted, and ends the process on some meshes. What is sent each way is a row of NumPy arrays (`numpy.save`).
"""

from __future__ import annotations

import io
import os
import sys

import numpy as np
import xatlas

RESOLUTION = 1024  # the packing's goal; charts in many small pieces end up on a somewhat larger one
PADDING = 4  # texels between charts at that size
MAX_COST = 8.0  # of growing a chart; xatlas' 2 cuts a noisy mesh into more pieces at no gain in stretch


def main() -> None:
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever xatlas prints must not get into the answer
    message = io.BytesIO(sys.stdin.buffer.read())
    vertices, faces = (np.load(message, allow_pickle=False) for _ in range(2))
    charts = xatlas.ChartOptions()
    charts.max_cost = MAX_COST
    packing = xatlas.PackOptions()
    packing.resolution, packing.padding, packing.bilinear = RESOLUTION, PADDING, True
    atlas = xatlas.Atlas()
    atlas.add_mesh(vertices, faces)
    atlas.generate(charts, packing)
    origin, corners, uv = atlas.get_mesh(0)
    sheet, _ = atlas.get_mesh_vertex_assignment(0)  # -1, as uint32, where a vertex is in no chart
    laid_out = np.asarray(sheet).astype(np.uint32) == 0
    result = io.BytesIO()
    for array in (origin, corners, uv, laid_out, np.array([atlas.width, atlas.height])):
        np.save(result, array, allow_pickle=False)
    with answer:
        answer.write(result.getvalue())


if __name__ == "__main__":
    main()
