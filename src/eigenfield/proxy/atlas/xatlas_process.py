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

RESOLUTION = 1024  # the packing's goal; packed charts end up on one about 1.7 times as large
PADDING = (4, 7)  # texels between charts on that: at least, and with few charts ..
PADDING_SHARE = 0.1  # .. of the side of a chart of mean size
MOST_TRIED = 400  # charts: up to here every place in the atlas is tried (in steps of 4), above random ones
LARGEST = 0.2  # of the surface: one chart that winds about the whole background would leave half of the atlas empty
MAX_COST = 8.0  # of growing a chart; xatlas' 2 cuts a noisy mesh into more pieces at no gain in stretch


def main() -> None:
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # whatever xatlas prints must not get into the answer
    message = io.BytesIO(sys.stdin.buffer.read())
    points, faces, chart = (np.load(message, allow_pickle=False) for _ in range(3))
    options = xatlas.PackOptions()
    options.resolution, options.padding, options.bilinear = RESOLUTION, PADDING[0], True
    atlas = xatlas.Atlas()
    if points.shape[1] == 3:  # a surface: cut it into charts
        charts = xatlas.ChartOptions()
        charts.max_cost = MAX_COST
        p = points[faces].astype(np.float64)
        areas = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2
        charts.max_chart_area = LARGEST * float(areas.sum())
        atlas.add_mesh(points, faces)
        atlas.generate(charts, options)
    else:  # charts that are laid out: only pack them, at the sizes they have
        count = len(np.unique(chart))
        options.padding = int(np.clip(PADDING_SHARE * RESOLUTION / np.sqrt(count), *PADDING))
        options.bruteForce = options.blockAlign = count <= MOST_TRIED
        atlas.add_uv_mesh(points, faces, chart[:, None])
        atlas.generate(pack_options=options)
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
