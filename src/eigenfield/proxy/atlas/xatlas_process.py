"""The process that runs xatlas: a mesh comes in on standard input, its atlas goes out on standard output.

It runs as a script that imports nothing of this package. xatlas takes minutes on a large mesh, is silent, cannot be
interrupted, and crashes on some meshes. Both messages are sequences of NumPy arrays (`numpy.save`).
"""

from __future__ import annotations

import io
import os
import sys

import numpy as np
import xatlas

XATLAS_RESOLUTION_TEXELS = 1024  # target of the packing; the result is about 1.7 times as large
XATLAS_PADDING_TEXELS = (4, 7)  # between charts: at least, and at most
XATLAS_PADDING_FRACTION = 0.1  # padding of few charts, in sides of a chart of mean size
XATLAS_MAX_BRUTE_FORCE_CHARTS = 400  # up to here every place in the atlas is tried (in steps of 4), above random ones
XATLAS_MAX_CHART_FRACTION = 0.2  # of the surface: one chart around the background would waste half of the atlas
XATLAS_MAX_CHART_COST = 8.0  # of growing a chart; the default of 2 cuts a noisy mesh into more charts


def main() -> None:
    """Read the mesh, cut or pack its charts, and write the atlas."""
    answer = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what xatlas prints must not get into the answer
    message = io.BytesIO(sys.stdin.buffer.read())
    points, faces, chart = (np.load(message, allow_pickle=False) for _ in range(3))
    options = xatlas.PackOptions()
    options.resolution, options.padding, options.bilinear = XATLAS_RESOLUTION_TEXELS, XATLAS_PADDING_TEXELS[0], True
    atlas = xatlas.Atlas()
    if points.shape[1] == 3:  # a surface: cut it into charts
        charts = xatlas.ChartOptions()
        charts.max_cost = XATLAS_MAX_CHART_COST
        p = points[faces].astype(np.float64)
        areas = np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1) / 2
        charts.max_chart_area = XATLAS_MAX_CHART_FRACTION * float(areas.sum())
        atlas.add_mesh(points, faces)
        atlas.generate(charts, options)
    else:  # charts that are laid out: only pack them, at the sizes they have
        count = len(np.unique(chart))
        options.padding = int(
            np.clip(XATLAS_PADDING_FRACTION * XATLAS_RESOLUTION_TEXELS / np.sqrt(count), *XATLAS_PADDING_TEXELS)
        )
        options.bruteForce = options.blockAlign = count <= XATLAS_MAX_BRUTE_FORCE_CHARTS
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
