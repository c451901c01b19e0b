"""Semi-global matching of a cost volume, with eight paths, edge-adaptive jumps and sub-label precision.

Hirschmüller, Stereo Processing by Semiglobal Matching and Mutual Information, PAMI 2008.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.stereo.semiglobal_kernels import accumulate_path_costs, select_label_rows
from eigenfield.stereo.sweep_kernels import SWEEP_COST_UNITS_PER_LEVEL

SGM_ROWS_PER_TASK = 16
SGM_HALF_JUMP_LEVELS = 10.0  # difference of the guide at which a jump costs half
SGM_MAX_PARALLEL_BYTES = 1 << 29  # above, the two passes run one after the other and share one volume


def semi_global_matching(
    cost: NDArray[np.uint8],
    guide: NDArray[np.float32],
    labels: NDArray[np.float32],
    p1: float = 1.0,
    p2: float = 12.0,
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """The depth map of least matching cost plus smoothness penalty.

    Args:
        cost: (h, w, L) uint8 of `plane_sweep`.
        guide: (h, w) grey levels; jumps are cheap at its edges.
        p1: Penalty in grey levels for a step of one label.
        p2: Penalty in grey levels for a jump.

    Returns:
        (h, w) float32 labels, and (h, w) float32 confidence: curvature of the summed cost at its minimum, in grey
        levels per squared label; 0 where the minimum lies at the end of the range.
    """
    guide = np.ascontiguousarray(guide, np.float32)
    labels = np.ascontiguousarray(labels, np.float32)
    units = float(SWEEP_COST_UNITS_PER_LEVEL)
    small, large = np.int32(round(p1 * units)), np.float32(p2 * units)
    d, confidence = np.empty(cost.shape[:2], np.float32), np.empty(cost.shape[:2], np.float32)
    shared = 4 * cost.size > SGM_MAX_PARALLEL_BYTES
    forward = np.zeros(cost.shape, np.uint16)
    backward = forward if shared else np.zeros(cost.shape, np.uint16)
    passes = [(False, forward), (True, backward)]

    def run(item: tuple[bool, NDArray[np.uint16]]) -> None:
        accumulate_path_costs(cost, guide, small, large, np.float32(SGM_HALF_JUMP_LEVELS), *item)

    if shared:
        for item in passes:
            run(item)
        backward = np.zeros((0, 0, 0), np.uint16)
    else:
        parallel_map(run, passes)
    fixed = (cost, forward, backward, labels, d, confidence)
    parallel_map(lambda rows: select_label_rows(*rows, *fixed), pieces(cost.shape[0], SGM_ROWS_PER_TASK))
    return d, confidence
