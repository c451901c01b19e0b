"""Kernels of sheets with an opacity: what each pixel shows of them, and how it changes with their opacity."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.encoding.fitted.kernels import SHARE_ONE, bicubic_taps, draw_at_border, part_of, share_of, tap_index
from eigenfield.encoding.fitted.point_taps import draw_point, return_two
from eigenfield.runtime.jit import kernel

SHEET_MIN_SHARE = np.float32(1 / 1024)  # of a pixel, of a point that counts
SHEET_MIN_REST = np.float32(1 / 512)  # of a pixel, that what is behind is seen through


@kernel()
def sheet_points(near, column_of, row_of, opacity, rest, counts, starts, coordinates, shares):
    """Add a sheet behind those that were added before: what each pixel shows of it.

    Args:
        near: (h, at least w) inverse depth in the sheet, 0 where a pixel does not show it.
        column_of, row_of: (h, at least w) texel coordinates over depth.
        opacity: (H, W) float32 of the finest atlas, read by Catmull-Rom and clipped to 0..1.
        rest: (h, w) float32, the part of a pixel that shows what lies behind; changed.
        counts: (h, w) uint8 points of a pixel so far; changed.
        starts: (h, w) int64, where a pixel's points begin; empty to count alone.
        coordinates: (n, 2) written.
        shares: (n,) written.
    """
    shape, flat, one = (1, *opacity.shape), opacity.reshape(-1), np.float32(1)
    right, bottom = np.float32(opacity.shape[1] - 1), np.float32(opacity.shape[0] - 1)
    put, point, value = starts.shape[0] > 0, np.empty(2, np.float32), np.empty(1, np.float32)
    for row in range(counts.shape[0]):
        for pixel in range(counts.shape[1]):
            behind, inverse = rest[row, pixel], near[row, pixel]
            if behind <= 0 or inverse <= 0:
                continue
            point[0] = min(max(column_of[row, pixel] / inverse, np.float32(0)), right)
            point[1] = min(max(row_of[row, pixel] / inverse, np.float32(0)), bottom)
            value[0] = 0
            if not draw_point(flat, shape, (one, one), point, 0, one, value, 0, 0):
                draw_at_border(flat, shape, (one, one), point, 0, one, value, 0, 0)
            share = behind * min(max(value[0], np.float32(0)), np.float32(1))
            if share < SHEET_MIN_SHARE:
                continue
            if behind - share < SHEET_MIN_REST:
                share = behind
            rest[row, pixel] = behind - share
            if put:
                at = starts[row, pixel] + counts[row, pixel]
                coordinates[at, 0], coordinates[at, 1] = point[0], point[1]
                shares[at] = np.uint16(share * np.float32(SHARE_ONE) + np.float32(0.5))
            counts[row, pixel] += 1


@kernel()
def opacity_steps(counts, coordinates, shares, texture, image, weight, out):
    """Add one observation to out (2, H, W): texel by texel of an opacity as large as the atlas the sums of g r and g g,
    where g is the change of a pixel for a unit of the opacity of a point, T (c - b): T is what the points before let
    through, c what the point shows, and b what is seen behind it. r is what the photograph has more than is drawn.

    Args:
        coordinates: As `forward`, in an atlas as large as the texture.
        shares: (n,) uint16.
        texture: (1, H, W) what is drawn.
        image: (1, h, w) r.
    """
    shape, flat, points, one = texture.shape, texture.reshape(-1), coordinates.reshape(-1), np.float32(1)
    height, width, ratio = shape[1], shape[2], (one, one)
    colours, parts = np.empty(256, np.float32), np.empty(256, np.float32)
    gain, norm = out[0].reshape(-1), out[1].reshape(-1)
    at = 0
    for row in range(counts.shape[0]):
        for pixel in range(counts.shape[1]):
            count, whole = counts[row, pixel], part_of(weight, row, pixel)
            first = at
            at += count
            if count < 2 or whole <= 0:
                continue
            behind, light = np.float32(0), np.float32(0)  # of what was passed, from the back on: colours and parts
            for k in range(count):
                colours[k] = 0
                if not draw_point(flat, shape, ratio, points, first + k, one, colours, 0, k):
                    draw_at_border(flat, shape, ratio, points, first + k, one, colours, 0, k)
                parts[k] = share_of(count, shares, first + k)
            for k in range(count - 1, -1, -1):
                if light > SHEET_MIN_REST:
                    through = light + parts[k]
                    g = through * (colours[k] - behind / light)
                    value, size = whole * g * image[0, row, pixel], whole * g * g
                    if not return_two(gain, norm, shape, ratio, points, first + k, value, size):
                        left, top, a, d = bicubic_taps(coordinates[first + k], one, one, width, height)
                        for v in range(4):
                            for u in range(4):
                                into = tap_index(left, top, u, v, width, height)
                                gain[into] += d[v] * a[u] * value
                                norm[into] += abs(d[v] * a[u]) * size
                behind += parts[k] * colours[k]
                light += parts[k]
