"""The recurrence of semi-global matching."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel
from eigenfield.stereo.sweep_kernels import SWEEP_EXCLUDED_COST

_SGM_PADDING_COST = np.int32(1 << 14)


@kernel()
def _aggregate_path(cost, before, least, small, large, after, total):
    """after(l) = cost(l) + min(before(l), before(l -+ 1) + small, least + large) - least; total += after.

    before and after are (L + 2), padded with _SGM_PADDING_COST. Returns min after.
    """
    count = cost.size
    jump = np.int32(least + large)
    for k in range(count):
        t = min(before[k + 1], jump)
        t = min(t, min(before[k], before[k + 2]) + small)
        after[k + 1] = np.int32(cost[k]) + t - least
    lowest = _SGM_PADDING_COST
    for k in range(count):
        lowest = min(lowest, after[k + 1])
    for k in range(count):
        total[k] = np.uint16(total[k] + after[k + 1])
    return lowest


@kernel()
def accumulate_path_costs(cost, guide, small, large, contrast, backward, total):
    """Add the costs of four of the eight paths: from the left and from the three pixels above.

    The jump penalty falls at edges of the guide: max(small + 1, large / (1 + |difference| / contrast)).

    Args:
        cost: (h, w, L) uint8.
        guide: (h, w) grey levels.
        small: Penalty of one label, in units of `cost`.
        large: Penalty of a jump, in units of `cost`.
        contrast: Difference of the guide at which a jump costs half.
        backward: The paths come from the right and from the three pixels below instead.
        total: (h, w, L) uint16, added to.
    """
    height, width, count = cost.shape
    rows = np.full((2, 3, width + 2, count + 2), _SGM_PADDING_COST, np.int32)
    rows_least = np.zeros((2, 3, width + 2), np.int32)
    side = np.full((2, count + 2), _SGM_PADDING_COST, np.int32)
    start = np.full(count + 2, _SGM_PADDING_COST, np.int32)
    start[1 : count + 1] = 0
    towards = -1 if backward else 1
    for step in range(height):
        y = height - 1 - step if backward else step
        now, then = step % 2, 1 - step % 2
        least_side = np.int32(0)
        for across in range(width):
            x = width - 1 - across if backward else across
            came = side[across % 2]
            goes = side[1 - across % 2]
            if across == 0:
                least_side = _aggregate_path(cost[y, x], start, np.int32(0), small, large, goes, total[y, x])
            else:
                g = abs(guide[y, x] - guide[y, x - towards])
                jump = np.int32(max(np.float32(small + 1), large / (np.float32(1) + g / contrast)))
                least_side = _aggregate_path(cost[y, x], came, least_side, small, jump, goes, total[y, x])
            for k in range(3):
                above_x, above_y = x + k - 1, y - towards
                if step == 0 or above_x < 0 or above_x >= width:
                    rows_least[now, k, x] = _aggregate_path(
                        cost[y, x], start, np.int32(0), small, large, rows[now, k, x], total[y, x]
                    )
                    continue
                g = abs(guide[y, x] - guide[above_y, above_x])
                jump = np.int32(max(np.float32(small + 1), large / (np.float32(1) + g / contrast)))
                rows_least[now, k, x] = _aggregate_path(
                    cost[y, x], rows[then, k, above_x], rows_least[then, k, above_x], small, jump, rows[now, k, x],
                    total[y, x],
                )  # fmt: skip


@kernel()
def select_label_rows(first, last, cost, forward, backward, labels, d, confidence):
    """The label of the least sum, with a parabola through its neighbours, for rows [first, last).

    Labels of cost SWEEP_EXCLUDED_COST are not taken. Where there is no other, d is the lowest label.

    Args:
        first, last: Range of rows.
        cost: (h, w, L) uint8.
        forward: (h, w, L) sums of the forward pass, or of both passes.
        backward: (h, w, L) sums of the backward pass; empty if `forward` holds both.
        labels: (L,) evenly spaced.
        d: (h, w) labels, written.
        confidence: (h, w) curvature of the parabola per path, written; 0 where there is no parabola.
    """
    count = labels.size
    separate = backward.size > 0
    for y in range(first, last):
        for x in range(cost.shape[1]):
            best, at = np.int64(1) << 40, -1
            for k in range(count):
                if cost[y, x, k] != SWEEP_EXCLUDED_COST:
                    s = np.int64(forward[y, x, k]) + (np.int64(backward[y, x, k]) if separate else 0)
                    if s < best:
                        best, at = s, k
            d[y, x] = labels[max(at, 0)]
            confidence[y, x] = 0
            if (
                at <= 0
                or at >= count - 1
                or cost[y, x, at - 1] == SWEEP_EXCLUDED_COST
                or cost[y, x, at + 1] == SWEEP_EXCLUDED_COST
            ):
                continue
            below = np.float32(np.int64(forward[y, x, at - 1]) - best)
            above = np.float32(np.int64(forward[y, x, at + 1]) - best)
            if separate:
                below += np.float32(backward[y, x, at - 1])
                above += np.float32(backward[y, x, at + 1])
            curvature = below + above
            if curvature > 0:
                step = np.float32(0.5) * (labels[at + 1] - labels[at - 1])
                d[y, x] += np.float32(0.5) * (below - above) / curvature * step
                confidence[y, x] = curvature / (np.float32(16) * step * step)
