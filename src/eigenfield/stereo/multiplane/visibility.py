"""How well some view sees each texel of soft sheets."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.progress import Progress, track
from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.multiplane.drawing import draw_layers, view_rays
from eigenfield.stereo.multiplane.kernels import raise_texels
from eigenfield.stereo.multiplane.sheets import SoftSheets
from eigenfield.stereo.reference_view import ReferenceView, view_matrices
from eigenfield.stereo.views import HALF_FROM_FULL_INDEX


def sheet_visibility(
    sheets: SoftSheets, reference: ReferenceView, cameras: Sequence[Camera], progress: Progress | None = None
) -> NDArray[np.float32]:
    """(K, h, w) the part of each texel's light that reaches the view that sees it best, 0..1.

    Views are drawn at half their size, and a pixel stands for the four texels around its place.
    """
    seen = np.zeros(sheets.labels.shape, np.float32)
    matrices = HALF_FROM_FULL_INDEX @ view_matrices(reference, cameras)
    views = list(zip(matrices, cameras, strict=True))
    for matrix, camera in track(views, "what is seen", len(views), progress):
        shape = len(seen), (camera.height + 1) // 2, (camera.width + 1) // 2
        places, drawn = (np.empty((*shape, numbers), np.float32) for numbers in (2, 4))
        draw_layers(sheets.labels, sheets.layers, view_rays(matrix, shape[1:]), places, drawn)
        through = np.ones(shape, np.float32)
        for k in range(len(seen) - 2, -1, -1):
            through[k] = through[k + 1] * (1 - drawn[k + 1, ..., 3])
        parallel_map(partial(_raise, through, places, seen), range(len(seen)))
    return seen


def _raise(through: NDArray[np.float32], places: NDArray[np.float32], seen: NDArray[np.float32], sheet: int) -> None:
    raise_texels(through[sheet], places[sheet], seen[sheet])
