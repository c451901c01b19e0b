"""The unstructured lumigraph, pixel by pixel."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

TINY = 1e-12  # radians: below this an angle is none
RIM = 1e-3  # pixels: nearest a frame's border that a penalty is taken at


@kernel(inline=True)
def _cubic(t):
    """Catmull-Rom at distance t."""
    t = abs(t)
    if t < 1.0:
        return (1.5 * t - 2.5) * t * t + 1.0
    if t < 2.0:
        return ((-0.5 * t + 2.5) * t - 4.0) * t + 2.0
    return 0.0


@kernel(inline=True)
def _farthest(depths, start, width, height, x, y):
    """The smallest of the four inverse depths round (x, y); pixel centres at +0.5, clamped to the frame."""
    column, row = int(np.floor(x - 0.5)), int(np.floor(y - 0.5))
    farthest = np.inf
    for dr in range(2):
        for dc in range(2):
            r, c = min(max(row + dr, 0), height - 1), min(max(column + dc, 0), width - 1)
            farthest = min(farthest, depths[start + r * width + c])
    return farthest


@kernel()
def blend_views(
    first, last, rays, centre, inverse_depth, matrices, centres, sizes, starts, codes, depths, biases, k, feather,
    image, found,
):  # fmt: skip
    """Rows [first, last): image (H, W, 3) float32, 0..1, and found (H, W) uint8, how many photographs a pixel is of.

    The surface point X = centre + rays (x, y, 1) / q, q the inverse depth, has to camera c the penalty p_c, the angle
    at X between centre and c's, over how far from the frame's border X is seen (1 from `feather` of the frame on,
    falling to 0 at the border). Among the cameras that see X, the k of least penalty weigh (1 - p_c / p_k+1) / p_c, so
    that one fades before it is replaced; where no k + 1 see it, 1 / p_c.

    codes: uint8, all photographs in one row, three channels interleaved; depths: float32, their inverse depths; both
    begin at pixel starts[c] and have sizes[c] = width, height. biases: of the inverse depths. matrices (n, 3, 4).
    """
    pens, who, at = np.empty(k + 1), np.empty(k + 1, np.int64), np.empty((k + 1, 2))
    taps = np.empty((2, 4))
    for row in range(first, last):
        for column in range(inverse_depth.shape[1]):
            found[row, column] = 0
            image[row, column, 0], image[row, column, 1], image[row, column, 2] = 0.0, 0.0, 0.0
            if inverse_depth[row, column] <= 0:
                continue
            z = 1.0 / np.float64(inverse_depth[row, column])
            u, v = column + 0.5, row + 0.5
            dx = z * (rays[0, 0] * u + rays[0, 1] * v + rays[0, 2])
            dy = z * (rays[1, 0] * u + rays[1, 1] * v + rays[1, 2])
            dz = z * (rays[2, 0] * u + rays[2, 1] * v + rays[2, 2])
            px, py, pz = centre[0] + dx, centre[1] + dy, centre[2] + dz
            dx, dy, dz = centre[0] - px, centre[1] - py, centre[2] - pz
            scale = 1.0 / np.sqrt(dx * dx + dy * dy + dz * dz)
            dx, dy, dz = dx * scale, dy * scale, dz * scale
            n = 0
            for c in range(matrices.shape[0]):
                vx, vy, vz = centres[c, 0] - px, centres[c, 1] - py, centres[c, 2] - pz
                scale = 1.0 / np.sqrt(vx * vx + vy * vy + vz * vz)
                vx, vy, vz = vx * scale - dx, vy * scale - dy, vz * scale - dz
                chord = np.sqrt(vx * vx + vy * vy + vz * vz)
                if n == k + 1 and chord >= pens[k]:
                    continue
                m = matrices[c]
                w = m[2, 0] * px + m[2, 1] * py + m[2, 2] * pz + m[2, 3]
                if w <= 0:
                    continue
                x = (m[0, 0] * px + m[0, 1] * py + m[0, 2] * pz + m[0, 3]) / w
                y = (m[1, 0] * px + m[1, 1] * py + m[1, 2] * pz + m[1, 3]) / w
                width, height = sizes[c, 0], sizes[c, 1]
                inside = min(min(x, width - x), min(y, height - y))
                if not inside >= 0:
                    continue
                reach = feather * min(width, height)
                pen = 2.0 * np.arcsin(min(1.0, chord / 2.0)) / min(1.0, max(inside, RIM) / reach)
                if n == k + 1 and pen >= pens[k]:
                    continue
                if 1.0 / w < _farthest(depths, starts[c], width, height, x, y) - biases[c]:
                    continue
                place = n if n <= k else k
                while place > 0 and pens[place - 1] > pen:
                    pens[place], who[place] = pens[place - 1], who[place - 1]
                    at[place, 0], at[place, 1] = at[place - 1, 0], at[place - 1, 1]
                    place -= 1
                pens[place], who[place], at[place, 0], at[place, 1] = pen, c, x, y
                n = min(n + 1, k + 1)
            if n == 0:
                continue
            most = pens[k] if n == k + 1 and pens[k] > pens[0] else np.inf  # all alike: none fades
            red, green, blue, total = 0.0, 0.0, 0.0, 0.0
            for i in range(min(n, k)):
                weight = (1.0 - pens[i] / most) / (pens[i] + TINY)
                if weight <= 0:
                    continue
                c = who[i]
                width, height = sizes[c, 0], sizes[c, 1]
                left, top = int(np.floor(at[i, 0] - 0.5)) - 1, int(np.floor(at[i, 1] - 0.5)) - 1
                for t in range(4):
                    taps[0, t] = _cubic(left + t + 0.5 - at[i, 0])
                    taps[1, t] = _cubic(top + t + 0.5 - at[i, 1])
                for j in range(4):
                    r = min(max(top + j, 0), height - 1)
                    for t in range(4):
                        place = 3 * (starts[c] + r * width + min(max(left + t, 0), width - 1))
                        part = weight * taps[1, j] * taps[0, t]
                        red += part * codes[place]
                        green += part * codes[place + 1]
                        blue += part * codes[place + 2]
                total += weight
                found[row, column] += 1
            image[row, column, 0] = red / (255.0 * total)
            image[row, column, 1] = green / (255.0 * total)
            image[row, column, 2] = blue / (255.0 * total)
