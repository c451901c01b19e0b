"""Edge-aware local plane fits."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.jit import kernel
from eigenfield.stereo.taps import EXACT

_ONE, _ZERO = np.float32(1), np.float32(0)


PASSES = 2  # the first finds the slope, the second forgives neighbours for lying on it


@kernel(fastmath=EXACT)
def fit_planes(first, last, d, sure, guide, radius, spacing, colour, depth, loose_colour, loose_depth, out):
    """out: d of the plane fitted to (2 radius + 1)^2 taps `spacing` apart round each point of rows [first, last).

    sure: q in 0..1. A tap at offset r weighs q exp(-|colour difference| / c - |r|^2 / radius^2) / (1 + (e / s)^2)^2,
    e its difference from the plane of the pass before (from d here, at first). Where the point itself is unsure the
    scales are relaxed, c = colour + (1 - q)^2 loose_colour and s likewise, or flat paint would be cut off from the
    lines drawn on it. Wide taps (spacing over 2) move a point by 1 - q of the way.
    """
    height, width = d.shape
    f = np.float32
    fall = f(1) / f(radius * radius)
    for y in range(first, last):
        for x in range(width):
            here = d[y, x]
            q = sure[y, x]
            relax = (_ONE - q) * (_ONE - q)
            per_colour = _ONE / (colour + relax * loose_colour)
            per_depth = _ONE / (depth + relax * loose_depth)
            plane, gx, gy = _ZERO, _ZERO, _ZERO
            for _ in range(PASSES):
                s, sx, sy, sxx, sxy, syy, sd, sxd, syd = _ZERO, _ZERO, _ZERO, _ZERO, _ZERO, _ZERO, _ZERO, _ZERO, _ZERO
                for jj in range(-radius, radius + 1):
                    j = y + jj * spacing
                    if j < 0 or j >= height:
                        continue
                    for ii in range(-radius, radius + 1):
                        i = x + ii * spacing
                        if i < 0 or i >= width:
                            continue
                        c = abs(guide[j, i, 0] - guide[y, x, 0])
                        c += abs(guide[j, i, 1] - guide[y, x, 1])
                        c += abs(guide[j, i, 2] - guide[y, x, 2])
                        u, v = f(ii), f(jj)
                        e = d[j, i] - here
                        off = (e - plane - gx * u - gy * v) * per_depth
                        robust = _ONE + off * off
                        w = sure[j, i] * np.exp(-c * per_colour - (u * u + v * v) * fall) / (robust * robust)
                        s += w
                        sx += w * u
                        sy += w * v
                        sxx += w * u * u
                        sxy += w * u * v
                        syy += w * v * v
                        sd += w * e
                        sxd += w * u * e
                        syd += w * v * e
                ridge = f(1e-3) * (sxx + syy) + f(1e-9)
                s += f(1e-12)
                mx, my, md = sx / s, sy / s, sd / s
                vxx, vyy, vxy = sxx - s * mx * mx + ridge, syy - s * my * my + ridge, sxy - s * mx * my
                vxd, vyd = sxd - s * mx * md, syd - s * my * md
                det = vxx * vyy - vxy * vxy
                gx, gy = (vxd * vyy - vyd * vxy) / det, (vyd * vxx - vxd * vxy) / det
                plane = md - gx * mx - gy * my
            out[y, x] = here + plane * ((_ONE - q) if spacing > 2 else _ONE)
