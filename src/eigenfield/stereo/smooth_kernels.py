"""The inner loops of edge-aware local plane fits."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel
from eigenfield.stereo.taps import FASTMATH_ORDERED, TAP_RUN

_ONE, _ZERO = np.float32(1), np.float32(0)

SMOOTH_PASSES = 2  # the first finds the slope, the second measures distances from the sloped plane
SMOOTH_SUM_SLOTS = 9
SMOOTH_MIN_EXPONENT = np.float32(-80)
SMOOTH_LOG2_E = np.float32(1.4426950408889634)
SMOOTH_ROUNDING_OFFSET = np.float32(12582912)  # 1.5 * 2^23: adding it rounds to whole numbers


@kernel(inline=True)
def exponential(x):
    """e^x for x <= 0, to a relative 2e-7 (1 - x), in arithmetic that the compiler vectorises.

    It is 2^n 2^f: the fraction f in [-1/2, 1/2] by a Taylor series, the whole n by the bits of the exponent.

    Args:
        x: float32; below SMOOTH_MIN_EXPONENT it counts as that.
    """
    t = max(x, SMOOTH_MIN_EXPONENT) * SMOOTH_LOG2_E
    whole = (t + SMOOTH_ROUNDING_OFFSET) - SMOOTH_ROUNDING_OFFSET
    f = t - whole
    p = np.float32(1.5403530393381610e-4)
    p = p * f + np.float32(1.3333558146428443e-3)
    p = p * f + np.float32(9.6181291076284772e-3)
    p = p * f + np.float32(5.5504108664821580e-2)
    p = p * f + np.float32(2.4022650695910072e-1)
    p = p * f + np.float32(6.9314718055994531e-1)
    p = p * f + _ONE
    return p * np.int32((np.int32(whole) + np.int32(127)) << np.int32(23)).view(np.float32)


@kernel(fastmath=FASTMATH_ORDERED)
def _weigh_taps(count, here, there, sure, rate, fall, weight):
    """weight[k] = q exp(-|colour difference| / c - fall) for runs of points and their taps.

    here, there: three channels of the guide each. sure: q of the taps. rate[k]: 1 / c.
    """
    (r0, g0, b0), (r1, g1, b1) = here, there
    for k in range(count):
        c = abs(r1[k] - r0[k]) + abs(g1[k] - g0[k]) + abs(b1[k] - b0[k])
        weight[k] = sure[k] * exponential(-c * rate[k] - fall)


@kernel(fastmath=FASTMATH_ORDERED)
def _add_taps(count, u, v, here, there, weight, plane, rate, sums):
    """sums (9 slots) += w (1, u, v, u u, u v, v v, e, u e, v e), w the weight over the square of the robust term.

    here, there: d of the points and of their taps at (u, v). plane: 3 slots, from the previous pass. rate[k]: 1 / s.
    """
    for k in range(count):
        e = there[k] - here[k]
        off = (e - plane[k] - plane[k + TAP_RUN] * u - plane[k + 2 * TAP_RUN] * v) * rate[k]
        robust = _ONE + off * off
        w = weight[k] / (robust * robust)
        we = w * e
        sums[k] += w
        sums[k + TAP_RUN] += w * u
        sums[k + 2 * TAP_RUN] += w * v
        sums[k + 3 * TAP_RUN] += w * u * u
        sums[k + 4 * TAP_RUN] += w * u * v
        sums[k + 5 * TAP_RUN] += w * v * v
        sums[k + 6 * TAP_RUN] += we
        sums[k + 7 * TAP_RUN] += we * u
        sums[k + 8 * TAP_RUN] += we * v


@kernel(fastmath=FASTMATH_ORDERED)
def _solve_planes(count, sums, plane):
    """plane (3 slots): height at the point and slopes along u and v, by least squares over the sums."""
    f = np.float32
    for k in range(count):
        sxx, syy = sums[k + 3 * TAP_RUN], sums[k + 5 * TAP_RUN]
        ridge = f(1e-3) * (sxx + syy) + f(1e-9)
        s = sums[k] + f(1e-12)
        mx, my, md = sums[k + TAP_RUN] / s, sums[k + 2 * TAP_RUN] / s, sums[k + 6 * TAP_RUN] / s
        vxx, vyy, vxy = sxx - s * mx * mx + ridge, syy - s * my * my + ridge, sums[k + 4 * TAP_RUN] - s * mx * my
        vxd, vyd = sums[k + 7 * TAP_RUN] - s * mx * md, sums[k + 8 * TAP_RUN] - s * my * md
        det = vxx * vyy - vxy * vxy
        gx, gy = (vxd * vyy - vyd * vxy) / det, (vyd * vxx - vxd * vxy) / det
        plane[k] = md - gx * mx - gy * my
        plane[k + TAP_RUN] = gx
        plane[k + 2 * TAP_RUN] = gy


@kernel(fastmath=FASTMATH_ORDERED)
def fit_planes(
    first, last, d, sure, guide, radius, spacing, colour_scale, depth_scale, loose_colour_scale, loose_depth_scale, out
):
    """Depth of the plane fitted to the taps around each point of rows [first, last).

    A tap at offset r weighs
    q exp(-|colour difference| / c - |r|^2 / radius^2) / (1 + (e / s)^2)^2,
    e its difference from the plane of the previous pass (from d here, in the first). Where the point itself is
    uncertain the scales are relaxed to c = colour_scale + (1 - q)^2 loose_colour_scale, and s likewise. Otherwise
    flat paint would be cut off from the lines drawn on it. Wide taps (spacing over 2) move a point by 1 - q of the way.
    Points are processed in runs of TAP_RUN neighbours of a row; the innermost loops over them are vectorised (`taps`).

    Args:
        first, last: Range of rows.
        d: (h, w) labels.
        sure: (h, w) weight q in 0..1 of each point.
        guide: (3, h, w) channels of the guide, grey levels.
        radius: A fit has (2 radius + 1)^2 taps.
        spacing: Distance of the taps, pixels.
        colour_scale: Grey levels, summed over the channels.
        depth_scale: Labels.
        loose_colour_scale: Added to `colour_scale` for uncertain points.
        loose_depth_scale: Added to `depth_scale` for uncertain points.
        out: (h, w) smoothed labels, written.
    """
    height, width = d.shape
    f = np.float32
    fall = f(1) / f(radius * radius)
    side = 2 * radius + 1
    weight = np.zeros((side * side, TAP_RUN), np.float32)
    sums, plane = np.zeros(SMOOTH_SUM_SLOTS * TAP_RUN, np.float32), np.zeros(3 * TAP_RUN, np.float32)
    per_colour, per_depth = np.zeros(TAP_RUN, np.float32), np.zeros(TAP_RUN, np.float32)
    for y in range(first, last):
        for x in range(0, width, TAP_RUN):
            count = min(TAP_RUN, width - x)
            for k in range(count):
                relax = (_ONE - sure[y, x + k]) * (_ONE - sure[y, x + k])
                per_colour[k] = _ONE / (colour_scale + relax * loose_colour_scale)
                per_depth[k] = _ONE / (depth_scale + relax * loose_depth_scale)
            plane[:] = 0
            for attempt in range(SMOOTH_PASSES):
                sums[:] = 0
                for jj in range(-radius, radius + 1):
                    j = y + jj * spacing
                    if j < 0 or j >= height:
                        continue
                    for ii in range(-radius, radius + 1):
                        begin = max(x, -ii * spacing)
                        size = min(x + count, width - ii * spacing) - begin
                        if size <= 0:
                            continue
                        tap, at, i = (jj + radius) * side + ii + radius, begin - x, begin + ii * spacing
                        u, v = f(ii), f(jj)
                        if attempt == 0:
                            here = (guide[0, y, begin:], guide[1, y, begin:], guide[2, y, begin:])
                            there = (guide[0, j, i:], guide[1, j, i:], guide[2, j, i:])
                            _weigh_taps(
                                size, here, there, sure[j, i:], per_colour[at:], (u * u + v * v) * fall,
                                weight[tap, at:],
                            )  # fmt: skip
                        _add_taps(
                            size, u, v, d[y, begin:], d[j, i:], weight[tap, at:], plane[at:], per_depth[at:], sums[at:]
                        )
                _solve_planes(count, sums, plane)
            for k in range(count):
                part = (_ONE - sure[y, x + k]) if spacing > 2 else _ONE
                out[y, x + k] = d[y, x + k] + plane[k] * part
