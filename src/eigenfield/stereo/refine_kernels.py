"""Inner loops of the refinement: the costs of a few labels around the present one, and their aggregation."""

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

REFINE_FAILED_COST = np.float32(1e4)  # of a label that too few views see
REFINE_MIN_NOISE_VARIANCE = np.float32(1.0)  # grey levels squared: the least that any photograph is assumed to have
REFINE_MAX_INDEPENDENT_VIEWS = np.float32(64)  # errors of more views are not independent
_ONE, _ZERO, _THIRD = np.float32(1), np.float32(0), np.float32(1 / 3)
_QUARTER = np.float32(0.25)


@kernel(fastmath=FASTMATH_ORDERED)
def _add_robust(count, floats, ints, centre, scale, sums):
    """sums (6 slots): w, w e (3), w |e|^2, 1 over visible views; e = colour - centre, w = 1 / (1 + |e|^2 scale)."""
    for i in range(count):
        r, g, b = bilinear_colour(floats, ints, i)
        r, g, b = r - centre[i], g - centre[i + TAP_RUN], b - centre[i + 2 * TAP_RUN]
        m = is_visible(floats, i)
        e = r * r + g * g + b * b
        w = m / (_ONE + e * scale)
        sums[i] += w
        sums[i + TAP_RUN] += w * r
        sums[i + 2 * TAP_RUN] += w * g
        sums[i + 3 * TAP_RUN] += w * b
        sums[i + 4 * TAP_RUN] += w * e
        sums[i + 5 * TAP_RUN] += m


@kernel(fastmath=FASTMATH_ORDERED)
def label_costs(
    first, last, pictures, buffers, matrices, height, width, d, texture, offsets, bias, tau, min_views, out, seen
):
    """Robust variance of the views that see (x, y, d + offsets[k]), for rows [first, last).

    With e the difference from the texture and w = 1 / (1 + |e|^2 / (3 tau^2)), the mean is free:
    (sum w |e|^2 - |sum w e|^2 / sum w) / (3 sum w) + tau^2 / 4 (1 - sum w / n).
    A point is hidden where the depth buffer is nearer than both the candidate and the present label. Otherwise a
    candidate behind the point's own surface would be hidden by that same surface.

    Args:
        first, last: Range of rows.
        pictures: (V, H W) packed.
        buffers: (V, H W) depth buffers, or (V, 0) for none.
        matrices: (V, 3, 4) of the views.
        height, width: Size of the views.
        d: (h, w) present labels.
        texture: (h, w, 3) mean of the pictures.
        offsets: (K,) added to d.
        bias: Labels behind the depth buffer at which a point still counts as visible.
        tau: Scale of the robust weight, grey levels.
        min_views: A label seen by fewer costs REFINE_FAILED_COST.
        out: (h, w, K) costs, written.
        seen: (h, w) number of views that see the present label, written.
    """
    columns, labels = d.shape[1], offsets.size
    floats, ints = np.zeros(TAP_FLOAT_SLOTS * TAP_RUN, np.float32), np.zeros(TAP_INT_SLOTS * TAP_RUN, np.uint32)
    label, limit = np.zeros((labels, TAP_RUN), np.float32), np.zeros((labels, TAP_RUN), np.float32)
    centre, sums = np.zeros(3 * TAP_RUN, np.float32), np.zeros((labels, 6 * TAP_RUN), np.float32)
    scale = _ONE / (np.float32(3) * tau * tau)
    for y in range(first, last):
        for x in range(0, columns, TAP_RUN):
            count = min(TAP_RUN, columns - x)
            for i in range(count):
                for c in range(3):
                    centre[i + c * TAP_RUN] = texture[y, x + i, c]
                for k in range(labels):
                    label[k, i] = d[y, x + i] + offsets[k]
                    limit[k, i] = max(label[k, i], d[y, x + i]) + bias
            sums[:] = 0
            for v in range(matrices.shape[0]):
                for k in range(labels):
                    project_run(matrices[v], y, x, count, label[k], limit[k], height, width, floats, ints)
                    fetch_run(pictures[v], buffers[v], width, count, floats, ints)
                    _add_robust(count, floats, ints, centre, scale, sums[k])
            for i in range(count):
                seen[y, x + i] = sums[labels // 2, i + 5 * TAP_RUN]
            for k in range(labels):
                s = sums[k]
                for i in range(count):
                    w, n = max(s[i], np.float32(1e-6)), s[i + 5 * TAP_RUN]
                    e = (
                        s[i + TAP_RUN] * s[i + TAP_RUN]
                        + s[i + 2 * TAP_RUN] * s[i + 2 * TAP_RUN]
                        + s[i + 3 * TAP_RUN] * s[i + 3 * TAP_RUN]
                    )
                    cost = (s[i + 4 * TAP_RUN] - e / w) * _THIRD / w + _QUARTER * tau * tau * (_ONE - w / max(n, _ONE))
                    out[y, x + i, k] = min(cost, REFINE_FAILED_COST) if n >= min_views else REFINE_FAILED_COST


@kernel(fastmath=FASTMATH_ORDERED)
def aggregate_rows(first, last, costs, seen, guide, d, radius, colour_scale, depth_scale, step, shift, confidence):
    """Sum the costs over a window and fit a parabola at the minimum, for rows [first, last).

    A point of the window weighs exp(-|colour difference| / colour_scale - |difference of d| / depth_scale).
    For n views of noise s^2 and a cost c(d) per view the variance of d is 2 s^2 / (n c''). The confidence is therefore
    n c'' / 2 over the least cost, which stands for the noise.

    Args:
        first, last: Range of rows.
        costs: (h, w, K) of `label_costs`.
        seen: (h, w) of `label_costs`; at most REFINE_MAX_INDEPENDENT_VIEWS count.
        guide: (h, w, 3) colours that weigh the window.
        d: (h, w) present labels.
        radius: The window has (2 radius + 1)^2 points.
        colour_scale: Grey levels, summed over the channels.
        depth_scale: Labels.
        step: Distance of the labels.
        shift: (h, w) change of d, written.
        confidence: (h, w), written; 0 where a label has failed.
    """
    height, width, labels = costs.shape
    total = np.zeros(labels, np.float32)
    for y in range(first, last):
        for x in range(width):
            shift[y, x] = _ZERO
            confidence[y, x] = _ZERO
            if costs[y, x, labels // 2] >= REFINE_FAILED_COST:
                continue
            sum_w = _ZERO
            total[:] = 0
            for j in range(max(0, y - radius), min(height, y + radius + 1)):
                for i in range(max(0, x - radius), min(width, x + radius + 1)):
                    complete = True
                    for k in range(labels):
                        complete &= costs[j, i, k] < REFINE_FAILED_COST
                    if not complete:
                        continue
                    c = abs(guide[j, i, 0] - guide[y, x, 0])
                    c += abs(guide[j, i, 1] - guide[y, x, 1])
                    c += abs(guide[j, i, 2] - guide[y, x, 2])
                    w = np.exp(-c / colour_scale - abs(d[j, i] - d[y, x]) / depth_scale)
                    sum_w += w
                    for k in range(labels):
                        total[k] += w * costs[j, i, k]
            if sum_w <= _ZERO:
                continue
            best = 1
            for k in range(1, labels - 1):
                if total[k] < total[best]:
                    best = k
            below, here, above = total[best - 1] / sum_w, total[best] / sum_w, total[best + 1] / sum_w
            curvature = below + above - np.float32(2) * here
            if curvature <= np.float32(1e-6):
                continue
            move = np.float32(0.5) * (below - above) / curvature
            shift[y, x] = (np.float32(best - labels // 2) + min(max(move, -_ONE), _ONE)) * step
            noise = max(here, REFINE_MIN_NOISE_VARIANCE)
            views = min(seen[y, x], REFINE_MAX_INDEPENDENT_VIEWS)
            confidence[y, x] = views * np.float32(0.5) * curvature / (step * step * noise)
