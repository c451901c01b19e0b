"""Edge-aware local plane fits."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel
from eigenfield.stereo.taps import EXACT, RUN

_ONE, _ZERO = np.float32(1), np.float32(0)

PASSES = 2  # the first finds the slope, the second forgives neighbours for lying on it
SUMS = 9
LEAST_EXPONENT = np.float32(-80)
LOG2_E = np.float32(1.4426950408889634)
MAGIC = np.float32(12582912)  # 1.5 * 2^23: added, it rounds to whole numbers


@kernel(inline=True)
def exponential(x):
    """e^x for x <= 0 to a relative 2e-7 (1 - x), in plain arithmetic that the compiler turns into vectors: 2^n 2^f, the
    fraction f in [-1/2, 1/2] by Taylor's series, the whole n by way of the exponent's bits."""
    t = max(x, LEAST_EXPONENT) * LOG2_E
    whole = (t + MAGIC) - MAGIC
    f = t - whole
    p = np.float32(1.5403530393381610e-4)
    p = p * f + np.float32(1.3333558146428443e-3)
    p = p * f + np.float32(9.6181291076284772e-3)
    p = p * f + np.float32(5.5504108664821580e-2)
    p = p * f + np.float32(2.4022650695910072e-1)
    p = p * f + np.float32(6.9314718055994531e-1)
    p = p * f + _ONE
    return p * np.int32((np.int32(whole) + np.int32(127)) << np.int32(23)).view(np.float32)


@kernel(fastmath=EXACT)
def _weigh_taps(count, here, there, sure, rate, fall, weight):
    """weight[k] = q exp(-|colour difference| / c - fall) for runs of points and their taps.

    here, there: three channels each of the guide; sure: q of the taps; rate[k]: 1 / c.
    """
    (r0, g0, b0), (r1, g1, b1) = here, there
    for k in range(count):
        c = abs(r1[k] - r0[k]) + abs(g1[k] - g0[k]) + abs(b1[k] - b0[k])
        weight[k] = sure[k] * exponential(-c * rate[k] - fall)


@kernel(fastmath=EXACT)
def _add_taps(count, u, v, here, there, weight, plane, rate, sums):
    """sums (9 slots) += w (1, u, v, u u, u v, v v, e, u e, v e), w the weight over the square of the robust term.

    here, there: d of the points and of their taps at (u, v); plane: 3 slots, of the pass before; rate[k]: 1 / s.
    """
    for k in range(count):
        e = there[k] - here[k]
        off = (e - plane[k] - plane[k + RUN] * u - plane[k + 2 * RUN] * v) * rate[k]
        robust = _ONE + off * off
        w = weight[k] / (robust * robust)
        we = w * e
        sums[k] += w
        sums[k + RUN] += w * u
        sums[k + 2 * RUN] += w * v
        sums[k + 3 * RUN] += w * u * u
        sums[k + 4 * RUN] += w * u * v
        sums[k + 5 * RUN] += w * v * v
        sums[k + 6 * RUN] += we
        sums[k + 7 * RUN] += we * u
        sums[k + 8 * RUN] += we * v


@kernel(fastmath=EXACT)
def _solve_planes(count, sums, plane):
    """plane (3 slots): height at the point, slopes along u and v, of least squares over the sums."""
    f = np.float32
    for k in range(count):
        sxx, syy = sums[k + 3 * RUN], sums[k + 5 * RUN]
        ridge = f(1e-3) * (sxx + syy) + f(1e-9)
        s = sums[k] + f(1e-12)
        mx, my, md = sums[k + RUN] / s, sums[k + 2 * RUN] / s, sums[k + 6 * RUN] / s
        vxx, vyy, vxy = sxx - s * mx * mx + ridge, syy - s * my * my + ridge, sums[k + 4 * RUN] - s * mx * my
        vxd, vyd = sums[k + 7 * RUN] - s * mx * md, sums[k + 8 * RUN] - s * my * md
        det = vxx * vyy - vxy * vxy
        gx, gy = (vxd * vyy - vyd * vxy) / det, (vyd * vxx - vxd * vxy) / det
        plane[k] = md - gx * mx - gy * my
        plane[k + RUN] = gx
        plane[k + 2 * RUN] = gy


@kernel(fastmath=EXACT)
def fit_planes(first, last, d, sure, planes, radius, spacing, colour, depth, loose_colour, loose_depth, out):
    """out: d of the plane fitted to (2 radius + 1)^2 taps `spacing` apart round each point of rows [first, last).

    sure: q in 0..1. planes: (3, h, w) the guide's channels. A tap at offset r weighs
    q exp(-|colour difference| / c - |r|^2 / radius^2) / (1 + (e / s)^2)^2,
    e its difference from the plane of the pass before (from d here, at first). Where the point itself is unsure the
    scales are relaxed, c = colour + (1 - q)^2 loose_colour and s likewise, or flat paint would be cut off from the
    lines drawn on it. Wide taps (spacing over 2) move a point by 1 - q of the way. Points go in runs of RUN neighbours
    of a row, the innermost loops over them, in vectors (`taps`).
    """
    height, width = d.shape
    f = np.float32
    fall = f(1) / f(radius * radius)
    side = 2 * radius + 1
    weight = np.zeros((side * side, RUN), np.float32)
    sums, plane = np.zeros(SUMS * RUN, np.float32), np.zeros(3 * RUN, np.float32)
    per_colour, per_depth = np.zeros(RUN, np.float32), np.zeros(RUN, np.float32)
    for y in range(first, last):
        for x in range(0, width, RUN):
            count = min(RUN, width - x)
            for k in range(count):
                relax = (_ONE - sure[y, x + k]) * (_ONE - sure[y, x + k])
                per_colour[k] = _ONE / (colour + relax * loose_colour)
                per_depth[k] = _ONE / (depth + relax * loose_depth)
            plane[:] = 0
            for turn in range(PASSES):
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
                        if turn == 0:
                            here = (planes[0, y, begin:], planes[1, y, begin:], planes[2, y, begin:])
                            there = (planes[0, j, i:], planes[1, j, i:], planes[2, j, i:])
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
