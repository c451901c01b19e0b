"""Semi-global optimisation of a cost volume (Hirschmüller, PAMI 2008): eight paths, edge-adaptive jumps, sub-label."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.semiglobal_kernels import accumulate, take_best
from eigenfield.stereo.sweep_kernels import UNIT

BAND = 16  # rows
CONTRAST = 10.0  # grey levels of the guide at which a jump costs half
PARALLEL_BYTES = 1 << 29  # above this the two passes share one volume of sums, one after the other


def semi_global(
    cost: NDArray[np.uint8],
    guide: NDArray[np.float32],
    labels: NDArray[np.float32],
    p1: float = 1.0,
    p2: float = 12.0,
    contrast: float = CONTRAST,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The depth map of least cost and smoothness: (d, confidence), each (h, w) float32.

    cost: of `sweep`, (h, w, L) uint8. guide: (h, w) grey levels; at its edges jumps are cheap. labels: (L,), even.
    p1, p2: penalties in grey levels for a step of one label and for a jump. confidence: curvature of the summed cost at
    its least, grey levels per squared label unit; 0 where it lies at the range's end.
    """
    guide = np.ascontiguousarray(guide, np.float32)
    labels = np.ascontiguousarray(labels, np.float32)
    small, large = np.int32(round(p1 * float(UNIT))), np.float32(p2 * float(UNIT))
    d, confidence = np.empty(cost.shape[:2], np.float32), np.empty(cost.shape[:2], np.float32)
    shared = 4 * cost.size > PARALLEL_BYTES
    forward = np.zeros(cost.shape, np.uint16)
    backward = forward if shared else np.zeros(cost.shape, np.uint16)
    passes = [(False, forward), (True, backward)]

    def run(item: tuple[bool, NDArray[np.uint16]]) -> None:
        accumulate(cost, guide, small, large, np.float32(contrast), item[0], item[1])

    if shared:
        for item in passes:
            run(item)
        backward = np.zeros((0, 0, 0), np.uint16)
    else:
        parallel_map(run, passes)
    fixed = (cost, forward, backward, labels, d, confidence)
    parallel_map(lambda rows: take_best(*rows, *fixed), pieces(cost.shape[0], BAND))
    return d, confidence
