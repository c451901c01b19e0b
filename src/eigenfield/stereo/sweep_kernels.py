"""The plane sweep's inner loop."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel
from eigenfield.stereo.taps import EXACT, REAL_SLOTS, RUN, WHOLE_SLOTS, channel, fetch, place, visible, weights

UNIT = np.float32(8)  # stored costs are eighths of a grey level
NEVER = 255  # a label that may not be taken
_ONE, _ZERO = np.float32(1), np.float32(0)


@kernel(fastmath=EXACT)
def _add_colours(count, real, whole, centre, reach, total):
    """total += w (r, g, b, 1) over visible points; w = 1 / (1 + (distance to `centre` / reach)^2), 1 if reach is 0."""
    scale = np.float32(1) / (reach * reach) if reach > _ZERO else _ZERO
    for i in range(count):
        w00, w01, w10, w11 = weights(real, i)
        r = channel(whole, i, 0, w00, w01, w10, w11)
        g = channel(whole, i, 8, w00, w01, w10, w11)
        b = channel(whole, i, 16, w00, w01, w10, w11)
        er, eg, eb = r - centre[i], g - centre[i + RUN], b - centre[i + 2 * RUN]
        w = visible(real, i) / (_ONE + (er * er + eg * eg + eb * eb) * scale)
        total[i] += w * r
        total[i + RUN] += w * g
        total[i + 2 * RUN] += w * b
        total[i + 3 * RUN] += w


@kernel(fastmath=EXACT)
def _add_moments(count, real, whole, centre, most, moments):
    """moments (5 slots): counts, sums of e, sum of |e|^2 over visible points, e = colour - centre.

    Where |e|^2 > 3 most^2 the point adds that much to the squares and nothing to the sums of e."""
    cut = np.float32(3) * most * most
    for i in range(count):
        w00, w01, w10, w11 = weights(real, i)
        r = channel(whole, i, 0, w00, w01, w10, w11) - centre[i]
        g = channel(whole, i, 8, w00, w01, w10, w11) - centre[i + RUN]
        b = channel(whole, i, 16, w00, w01, w10, w11) - centre[i + 2 * RUN]
        m = visible(real, i)
        e = r * r + g * g + b * b
        k = m if e < cut else _ZERO
        moments[i] += m
        moments[i + RUN] += k * r
        moments[i + 2 * RUN] += k * g
        moments[i + 3 * RUN] += k * b
        moments[i + 4 * RUN] += m * min(e, cut)


@kernel(fastmath=EXACT)
def _own_centre(
    pictures, buffers, matrices, x, y, count, label, limit, height, width, reach, real, whole, total, guess,
):  # fmt: skip
    """guess: the robust mean colour of all visible views, one step from the plain mean."""
    for attempt in range(2):
        total[:] = 0
        for v in range(matrices.shape[0]):
            place(matrices[v], y, x, count, label, limit, height, width, real, whole)
            fetch(pictures[v], buffers[v], width, count, real, whole)
            _add_colours(count, real, whole, guess, reach if attempt else _ZERO, total)
        for i in range(count):
            inverse = _ONE / max(total[i + 3 * RUN], np.float32(1e-6))
            for c in range(3):
                guess[i + c * RUN] = total[i + c * RUN] * inverse


@kernel()
def _parts(sector, groups, best):
    """(n, 2) int64: the runs (first, how many) of groups whose spread is looked at: the half-planes, those with the
    same views once, or all groups as one where `best` is not under 1."""
    views = np.zeros(groups, np.int64)
    for v in range(sector.size):
        if sector[v] >= 0:
            views[sector[v]] += 1
    parts = np.zeros((groups, 2), np.int64)
    if best >= _ONE:
        parts[0, 1] = groups
        return parts[:1]
    masks = np.zeros(groups, np.int64)
    count = 0
    for first in range(groups):
        mask = 0
        for k in range(groups // 2):
            if views[(first + k) % groups] > 0:
                mask |= 1 << ((first + k) % groups)
        fresh = mask != 0
        for other in range(count):
            fresh &= masks[other] != mask
        if fresh:
            masks[count] = mask
            parts[count, 0], parts[count, 1] = first, groups // 2
            count += 1
    return parts[:count]


@kernel(fastmath=EXACT)
def _add_up(moments, first, size, sums):
    """sums (5 slots): the moments of the groups first .. first + size - 1."""
    groups = moments.shape[0]
    sums[:] = 0
    for k in range(size):
        part = moments[(first + k) % groups]
        for i in range(5 * RUN):
            sums[i] += part[i]


@kernel(fastmath=EXACT)
def _half_spread(count, sums, need, free, lowest):
    """lowest = min(lowest, spread of the summed moments), where they hold `need` views.

    The reference counts as one more view, at e = 0: without it a single view would agree with itself."""
    for i in range(count):
        n, sr, sg, sb = sums[i], sums[i + RUN], sums[i + 2 * RUN], sums[i + 3 * RUN]
        q = sums[i + 4 * RUN]
        v = (q - free * (sr * sr + sg * sg + sb * sb) / (n + _ONE)) / (np.float32(3) * max(n, _ONE))
        lowest[i] = min(lowest[i], v) if n >= need[i] else lowest[i]


@kernel(fastmath=EXACT)
def _best_half(count, moments, parts, fewest, part, unseen, free, sums, need, cost):
    """cost: the least spread over the half-planes of directions that hold enough of the visible views."""
    _add_up(moments, 0, moments.shape[0], sums)
    for i in range(count):
        need[i] = max(part * sums[i], _ONE)
        need[i + RUN] = sums[i]
        cost[i] = np.float32(1e9)
    for k in range(parts.shape[0]):
        if parts[k, 1] < moments.shape[0]:
            _add_up(moments, parts[k, 0], parts[k, 1], sums)
        _half_spread(count, sums, need, free, cost)
    for i in range(count):
        cost[i] = np.sqrt(max(cost[i], _ZERO)) if need[i + RUN] >= fewest else unseen


@kernel(fastmath=EXACT)
def sweep_rows(
    first, last, pictures, buffers, matrices, sector, height, width, reference, known, labels, low, high, most, fewest,
    part, unseen, bias, free, out,
):  # fmt: skip
    """Costs of rows [first, last): out (h, w, L) uint8 for labels [low, high) of each pixel; others stay as they are.

    A view's colour is compared with the reference picture's where that is `known`, else with the visible views' robust
    mean. The views are grouped by the direction of their parallax (`sector`, 0..7). What hides a point hides it in the
    views on one side: the cost is the least, over the eight half-planes of directions that hold at least `part` of the
    visible views (part 1: all of them together), of the root of the mean of min(3 most^2, |e|^2 - free |mean e|^2) / 3.
    """
    columns = known.shape[1]
    groups = 8
    real, whole = np.zeros(REAL_SLOTS * RUN, np.float32), np.zeros(WHOLE_SLOTS * RUN, np.uint32)
    label, limit = np.zeros(RUN, np.float32), np.zeros(RUN, np.float32)
    centre, guess = np.zeros(3 * RUN, np.float32), np.zeros(3 * RUN, np.float32)
    total = np.zeros(4 * RUN, np.float32)
    moments, sums = np.zeros((groups, 5 * RUN), np.float32), np.zeros(5 * RUN, np.float32)
    parts = _parts(sector, groups, part)
    need = np.zeros(2 * RUN, np.float32)
    cost = np.zeros(RUN, np.float32)
    for y in range(first, last):
        following = 0
        while following < columns:
            x = following
            strangers = not known[y, x]
            count = 0  # a run ends where the reference picture does: its own centres cost the strangers dear
            while count < RUN and x + count < columns and known[y, x + count] != strangers:
                count += 1
            following = x + count
            longest = 0
            for i in range(count):
                longest = max(longest, high[y, x + i] - low[y, x + i])
                for c in range(3):
                    centre[i + c * RUN] = reference[y, x + i, c]
            for k in range(longest):
                for i in range(count):
                    at = max(min(low[y, x + i] + k, high[y, x + i] - 1), 0)
                    label[i] = labels[at]
                    limit[i] = labels[at] + bias
                if strangers:
                    guess[:] = 0
                    _own_centre(
                        pictures, buffers, matrices, x, y, count, label, limit, height, width, most, real, whole, total,
                        guess,
                    )  # fmt: skip
                    centre[:] = guess
                moments[:] = 0
                for v in range(matrices.shape[0]):
                    g = sector[v]
                    if g < 0:
                        continue
                    place(matrices[v], y, x, count, label, limit, height, width, real, whole)
                    fetch(pictures[v], buffers[v], width, count, real, whole)
                    _add_moments(count, real, whole, centre, most, moments[g])
                _best_half(count, moments, parts, fewest, part, unseen, free, sums, need, cost)
                for i in range(count):
                    at = low[y, x + i] + k
                    if at < high[y, x + i]:
                        out[y, x + i, at] = np.uint8(min(cost[i] * UNIT + np.float32(0.5), np.float32(NEVER - 1)))
