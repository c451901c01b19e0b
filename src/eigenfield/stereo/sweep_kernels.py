"""The inner loops of the plane sweep."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel
from eigenfield.stereo.taps import (
    FASTMATH_ORDERED,
    TAP_FLOAT_SLOTS,
    TAP_INT_SLOTS,
    TAP_RUN,
    bilinear_colour,
    fetch_run,
    is_visible,
    project_run,
)

SWEEP_COST_UNITS_PER_LEVEL = np.float32(8)  # costs are stored in eighths of a grey level
SWEEP_EXCLUDED_COST = 255  # marks a label that may not be taken
_ONE, _ZERO = np.float32(1), np.float32(0)


@kernel(fastmath=FASTMATH_ORDERED)
def _add_colours(count, floats, ints, centre, scale_levels, total):
    """total += w (r, g, b, 1) over visible points.

    w = 1 / (1 + (distance to `centre` / scale_levels)^2), or 1 if scale_levels is 0.
    """
    scale = np.float32(1) / (scale_levels * scale_levels) if scale_levels > _ZERO else _ZERO
    for i in range(count):
        r, g, b = bilinear_colour(floats, ints, i)
        er, eg, eb = r - centre[i], g - centre[i + TAP_RUN], b - centre[i + 2 * TAP_RUN]
        w = is_visible(floats, i) / (_ONE + (er * er + eg * eg + eb * eb) * scale)
        total[i] += w * r
        total[i + TAP_RUN] += w * g
        total[i + 2 * TAP_RUN] += w * b
        total[i + 3 * TAP_RUN] += w


@kernel(fastmath=FASTMATH_ORDERED)
def _add_moments(count, floats, ints, centre, max_difference, moments):
    """moments (2 slots): number, and sum of min(|colour - centre|^2, 3 max_difference^2) over visible points."""
    max_square = np.float32(3) * max_difference * max_difference
    for i in range(count):
        r, g, b = bilinear_colour(floats, ints, i)
        r, g, b = r - centre[i], g - centre[i + TAP_RUN], b - centre[i + 2 * TAP_RUN]
        m = is_visible(floats, i)
        moments[i] += m
        moments[i + TAP_RUN] += m * min(r * r + g * g + b * b, max_square)


@kernel(fastmath=FASTMATH_ORDERED)
def _robust_mean(
    pictures, buffers, matrices, x, y, count, label, limit, height, width, scale_levels, floats, ints, total, mean,
):  # fmt: skip
    """mean: the robust mean colour of all visible views, one step from the plain mean."""
    for attempt in range(2):
        total[:] = 0
        for v in range(matrices.shape[0]):
            project_run(matrices[v], y, x, count, label, limit, height, width, floats, ints)
            fetch_run(pictures[v], buffers[v], width, count, floats, ints)
            _add_colours(count, floats, ints, mean, scale_levels if attempt else _ZERO, total)
        for i in range(count):
            inverse = _ONE / max(total[i + 3 * TAP_RUN], np.float32(1e-6))
            for c in range(3):
                mean[i + c * TAP_RUN] = total[i + c * TAP_RUN] * inverse


@kernel()
def _half_planes(sector, groups, fraction):
    """(n, 2) int64: the runs (first, how many) of sectors whose spread is measured.

    They are the half-planes, those with the same views once, or all sectors as one where `fraction` is at least 1.
    """
    views = np.zeros(groups, np.int64)
    for v in range(sector.size):
        if sector[v] >= 0:
            views[sector[v]] += 1
    half_planes = np.zeros((groups, 2), np.int64)
    if fraction >= _ONE:
        half_planes[0, 1] = groups
        return half_planes[:1]
    masks = np.zeros(groups, np.int64)
    count = 0
    for first in range(groups):
        mask = 0
        for k in range(groups // 2):
            if views[(first + k) % groups] > 0:
                mask |= 1 << ((first + k) % groups)
        is_new = mask != 0
        for other in range(count):
            is_new &= masks[other] != mask
        if is_new:
            masks[count] = mask
            half_planes[count, 0], half_planes[count, 1] = first, groups // 2
            count += 1
    return half_planes[:count]


@kernel(fastmath=FASTMATH_ORDERED)
def _sum_groups(moments, first, size, sums):
    """sums (2 slots): the moments of the groups first .. first + size - 1."""
    groups = moments.shape[0]
    sums[:] = 0
    for k in range(size):
        part = moments[(first + k) % groups]
        for i in range(2 * TAP_RUN):
            sums[i] += part[i]


@kernel(fastmath=FASTMATH_ORDERED)
def _add_spread(count, sums, need, lowest):
    """lowest = min(lowest, mean square of the summed moments), where they hold `need` views."""
    for i in range(count):
        n, q = sums[i], sums[i + TAP_RUN]
        v = q / (np.float32(3) * max(n, _ONE))
        lowest[i] = min(lowest[i], v) if n >= need[i] else lowest[i]


@kernel(fastmath=FASTMATH_ORDERED)
def _half_plane_cost(count, moments, half_planes, min_views, fraction, unseen_cost, sums, need, cost):
    """cost: the least spread over the half-planes of directions that hold enough of the visible views."""
    _sum_groups(moments, 0, moments.shape[0], sums)
    for i in range(count):
        need[i] = max(fraction * sums[i], _ONE)
        need[i + TAP_RUN] = sums[i]
        cost[i] = np.float32(1e9)
    for k in range(half_planes.shape[0]):
        if half_planes[k, 1] < moments.shape[0]:
            _sum_groups(moments, half_planes[k, 0], half_planes[k, 1], sums)
        _add_spread(count, sums, need, cost)
    for i in range(count):
        cost[i] = np.sqrt(max(cost[i], _ZERO)) if need[i + TAP_RUN] >= min_views else unseen_cost


@kernel(fastmath=FASTMATH_ORDERED)
def sweep_rows(
    first, last, pictures, buffers, matrices, sector, height, width, reference, known, labels, low, high,
    max_difference, min_views, fraction, unseen_cost, bias, out,
):  # fmt: skip
    """Matching costs of rows [first, last), for labels [low, high) of each pixel.

    A view's colour is compared with the reference picture where that is known, else with the visible views' robust
    mean. The views are grouped by the direction of their parallax. An occluder hides a point from the views on one
    side. The cost is therefore the least, over the eight half-planes of directions that hold at least `fraction` of the
    visible views (1: all of them together), of the root of the mean of min(3 max_difference^2, |e|^2) / 3.

    Args:
        first, last: Range of rows.
        pictures: (V, H W) packed.
        buffers: (V, H W) depth buffers, or (V, 0) for none.
        matrices: (V, 3, 4) of the views.
        sector: (V,) sector of each view's parallax, 0..7; -1: the view is left out.
        height, width: Size of the views.
        reference: (h, w, 3) reference picture.
        known: (h, w) where it is valid.
        labels: (L,) increasing.
        low, high: (h, w) range of the labels tried at each pixel.
        max_difference: Grey levels at which differences are cut off.
        min_views: Views that must see a point.
        fraction: See above.
        unseen_cost: Grey levels, where fewer than `min_views` see a point.
        bias: Labels behind the depth buffer at which a point still counts as visible.
        out: (h, w, L) uint8, written for the labels tried.
    """
    columns = known.shape[1]
    groups = 8
    floats, ints = np.zeros(TAP_FLOAT_SLOTS * TAP_RUN, np.float32), np.zeros(TAP_INT_SLOTS * TAP_RUN, np.uint32)
    label, limit = np.zeros(TAP_RUN, np.float32), np.zeros(TAP_RUN, np.float32)
    centre, mean = np.zeros(3 * TAP_RUN, np.float32), np.zeros(3 * TAP_RUN, np.float32)
    total = np.zeros(4 * TAP_RUN, np.float32)
    moments, sums = np.zeros((groups, 2 * TAP_RUN), np.float32), np.zeros(2 * TAP_RUN, np.float32)
    half_planes = _half_planes(sector, groups, fraction)
    need = np.zeros(2 * TAP_RUN, np.float32)
    cost = np.zeros(TAP_RUN, np.float32)
    for y in range(first, last):
        following = 0
        while following < columns:
            x = following
            unreferenced = not known[y, x]
            count = 0  # a run ends where the reference picture does: only the rest needs its own mean
            while count < TAP_RUN and x + count < columns and known[y, x + count] != unreferenced:
                count += 1
            following = x + count
            longest = 0
            for i in range(count):
                longest = max(longest, high[y, x + i] - low[y, x + i])
                for c in range(3):
                    centre[i + c * TAP_RUN] = reference[y, x + i, c]
            for k in range(longest):
                for i in range(count):
                    at = max(min(low[y, x + i] + k, high[y, x + i] - 1), 0)
                    label[i] = labels[at]
                    limit[i] = labels[at] + bias
                if unreferenced:
                    mean[:] = 0
                    _robust_mean(
                        pictures, buffers, matrices, x, y, count, label, limit, height, width, max_difference, floats,
                        ints, total, mean,
                    )  # fmt: skip
                    for i in range(len(mean)):  # numba takes two seconds longer to compile `centre[:] = mean`
                        centre[i] = mean[i]
                moments[:] = 0
                for v in range(matrices.shape[0]):
                    g = sector[v]
                    if g < 0:
                        continue
                    project_run(matrices[v], y, x, count, label, limit, height, width, floats, ints)
                    fetch_run(pictures[v], buffers[v], width, count, floats, ints)
                    _add_moments(count, floats, ints, centre, max_difference, moments[g])
                _half_plane_cost(count, moments, half_planes, min_views, fraction, unseen_cost, sums, need, cost)
                for i in range(count):
                    at = low[y, x + i] + k
                    if at < high[y, x + i]:
                        rounded = cost[i] * SWEEP_COST_UNITS_PER_LEVEL + np.float32(0.5)
                        out[y, x + i, at] = np.uint8(min(rounded, np.float32(SWEEP_EXCLUDED_COST - 1)))
