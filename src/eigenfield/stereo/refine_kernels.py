"""Refinement of depth over all views: the costs of a few labels round the present one, and their aggregation."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel
from eigenfield.stereo.taps import EXACT, REAL_SLOTS, RUN, WHOLE_SLOTS, channel, fetch, place, visible, weights

FAILED = np.float32(1e4)  # cost of a label that too few views see
NOISE = np.float32(1.0)  # grey levels squared: no photograph is taken to be less noisy
MANY = np.float32(64)  # views: errors of more are no longer independent
_ONE, _ZERO, _THIRD = np.float32(1), np.float32(0), np.float32(1 / 3)
_QUARTER = np.float32(0.25)


@kernel(fastmath=EXACT)
def _add_robust(count, real, whole, centre, scale, sums):
    """sums (6, RUN) flat: w, w e (3), w |e|^2, 1 over visible views; e = colour - centre, w = 1 / (1 + |e|^2 scale)."""
    for i in range(count):
        w00, w01, w10, w11 = weights(real, i)
        r = channel(whole, i, 0, w00, w01, w10, w11) - centre[i]
        g = channel(whole, i, 8, w00, w01, w10, w11) - centre[i + RUN]
        b = channel(whole, i, 16, w00, w01, w10, w11) - centre[i + 2 * RUN]
        m = visible(real, i)
        e = r * r + g * g + b * b
        w = m / (_ONE + e * scale)
        sums[i] += w
        sums[i + RUN] += w * r
        sums[i + 2 * RUN] += w * g
        sums[i + 3 * RUN] += w * b
        sums[i + 4 * RUN] += w * e
        sums[i + 5 * RUN] += m


@kernel(fastmath=EXACT)
def label_costs(
    first, last, pictures, buffers, matrices, height, width, d, texture, offsets, bias, tau, fewest, out, seen
):
    """out (h, w, K): robust variance of the views that see (x, y, d + offsets[k]), rows [first, last).

    With e the difference from the texture and w = 1 / (1 + |e|^2 / (3 tau^2)), the mean is free:
    (sum w |e|^2 - |sum w e|^2 / sum w) / (3 sum w) + tau^2 / 4 (1 - sum w / n).
    A point is hidden where the depth buffer is nearer than the nearer of the candidate and its present label: a
    candidate behind the point's own surface would otherwise be hidden by that very surface.
    """
    columns, labels = d.shape[1], offsets.size
    real, whole = np.zeros(REAL_SLOTS * RUN, np.float32), np.zeros(WHOLE_SLOTS * RUN, np.uint32)
    label, limit = np.zeros((labels, RUN), np.float32), np.zeros((labels, RUN), np.float32)
    centre, sums = np.zeros(3 * RUN, np.float32), np.zeros((labels, 6 * RUN), np.float32)
    scale = _ONE / (np.float32(3) * tau * tau)
    for y in range(first, last):
        for x in range(0, columns, RUN):
            count = min(RUN, columns - x)
            for i in range(count):
                for c in range(3):
                    centre[i + c * RUN] = texture[y, x + i, c]
                for k in range(labels):
                    label[k, i] = d[y, x + i] + offsets[k]
                    limit[k, i] = max(label[k, i], d[y, x + i]) + bias
            sums[:] = 0
            for v in range(matrices.shape[0]):
                for k in range(labels):
                    place(matrices[v], y, x, count, label[k], limit[k], height, width, real, whole)
                    fetch(pictures[v], buffers[v], width, count, real, whole)
                    _add_robust(count, real, whole, centre, scale, sums[k])
            for i in range(count):
                seen[y, x + i] = sums[labels // 2, i + 5 * RUN]
            for k in range(labels):
                s = sums[k]
                for i in range(count):
                    w, n = max(s[i], np.float32(1e-6)), s[i + 5 * RUN]
                    e = s[i + RUN] * s[i + RUN] + s[i + 2 * RUN] * s[i + 2 * RUN] + s[i + 3 * RUN] * s[i + 3 * RUN]
                    cost = (s[i + 4 * RUN] - e / w) * _THIRD / w + _QUARTER * tau * tau * (_ONE - w / max(n, _ONE))
                    out[y, x + i, k] = min(cost, FAILED) if n >= fewest else FAILED


@kernel(fastmath=EXACT)
def settle(first, last, costs, seen, guide, d, radius, colour, depth, step, shift, confidence):
    """Costs summed over a window, weights exp(-|colour difference| / colour - |difference of d| / depth), and the
    parabola through the least: shift of d, and as confidence its information, 0 where a label has failed.

    For n views of noise s^2 and a cost c(d) per view the variance of d is 2 s^2 / (n c''): the confidence is n c'' / 2
    over the cost at the least, which is the noise as seen (not taken under NOISE), n not over MANY.
    """
    height, width, labels = costs.shape
    total = np.zeros(labels, np.float32)
    for y in range(first, last):
        for x in range(width):
            shift[y, x] = _ZERO
            confidence[y, x] = _ZERO
            if costs[y, x, labels // 2] >= FAILED:
                continue
            sum_w = _ZERO
            total[:] = 0
            for j in range(max(0, y - radius), min(height, y + radius + 1)):
                for i in range(max(0, x - radius), min(width, x + radius + 1)):
                    whole = True
                    for k in range(labels):
                        whole &= costs[j, i, k] < FAILED
                    if not whole:
                        continue
                    c = abs(guide[j, i, 0] - guide[y, x, 0])
                    c += abs(guide[j, i, 1] - guide[y, x, 1])
                    c += abs(guide[j, i, 2] - guide[y, x, 2])
                    w = np.exp(-c / colour - abs(d[j, i] - d[y, x]) / depth)
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
            bend = below + above - np.float32(2) * here
            if bend <= np.float32(1e-6):
                continue
            move = np.float32(0.5) * (below - above) / bend
            shift[y, x] = (np.float32(best - labels // 2) + min(max(move, -_ONE), _ONE)) * step
            noise = max(here, NOISE)
            views = min(seen[y, x], MANY)
            confidence[y, x] = views * np.float32(0.5) * bend / (step * step * noise)
