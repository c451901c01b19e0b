"""Kernels of the fit: photographs against what is drawn of them, and back into the textures; coarse textures made finer
and back. What goes back is the exact transpose of what is drawn, so that least squares can be solved by it."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.jit import kernel
from eigenfield.rendering.kernels import filter_weights


@kernel()
def place_pixels(near, column_of, row_of, height, width, places):
    """places (h, w, 2) float32: column and row in an atlas of height x width that each pixel shows, -1 where it shows
    none; near, column_of, row_of (h, at least w): of a covered `Frame`."""
    for row in range(places.shape[0]):
        for pixel in range(places.shape[1]):
            inverse = near[row, pixel]
            if inverse > 0:
                x, y = column_of[row, pixel] / inverse, row_of[row, pixel] / inverse
                places[row, pixel, 0] = min(max(x, np.float32(0)), np.float32(width - 1))
                places[row, pixel, 1] = min(max(y, np.float32(0)), np.float32(height - 1))
            else:
                places[row, pixel, 0] = np.float32(-1)
                places[row, pixel, 1] = np.float32(-1)


@kernel(inline=True)
def set_taps(x, y, height, width, at):
    """at (16,): flat addresses of the 4 x 4 texels around column x, row y; returns fractions of both."""
    left, top = np.int64(x), np.int64(y)
    if 1 <= left < width - 2 and 1 <= top < height - 2:
        first = (top - 1) * width + left - 1
        for tap in range(4):
            at[4 * tap] = first
            at[4 * tap + 1] = first + 1
            at[4 * tap + 2] = first + 2
            at[4 * tap + 3] = first + 3
            first += width
    else:
        for down in range(4):
            row = min(max(top + down - 1, 0), height - 1) * width
            for across in range(4):
                at[4 * down + across] = row + min(max(left + across - 1, 0), width - 1)
    return x - np.float32(left), y - np.float32(top)


@kernel()
def draw_back(places, texture, codes, matrix, weight, first, step, out):
    """For the covered pixels, every `step`-th from `first` in each row: out += G^T w (target - G texture), where G
    draws with Catmull-Rom and w weighs the pixels. Returns the sum of w (target - G texture)^2 and the sum of w.

    places (h, w, 2): see `place_pixels`. texture, out (C, H, W) float32. The target is matrix (C, 3) times the codes
    (h, w, 3) uint8; codes of no pixels stand for zero, and the sign is turned: out += G^T w G texture. weight (h, w)
    float32, or (0, 0): ones.
    """
    channels, height, width = texture.shape
    given, weighed = codes.shape[0] > 0, weight.shape[0] > 0
    sign = np.float32(1) if given else np.float32(-1)
    squares, total = 0.0, 0.0
    at = np.zeros(16, np.uintp)
    for row in range(places.shape[0]):
        line_squares, line_total = np.float32(0), np.float32(0)
        for pixel in range((first + row) % step, places.shape[1], step):
            x, y = places[row, pixel, 0], places[row, pixel, 1]
            w = weight[row, pixel] if weighed else np.float32(1)
            if x < 0 or w <= 0:
                continue
            fx, fy = set_taps(x, y, height, width, at)
            a0, a1, a2, a3 = filter_weights(4, fx)
            d0, d1, d2, d3 = filter_weights(4, fy)
            for k in range(channels):
                flat = texture[k].reshape(-1)
                value = d0 * ((a0 * flat[at[0]] + a1 * flat[at[1]]) + (a2 * flat[at[2]] + a3 * flat[at[3]]))
                value += d1 * ((a0 * flat[at[4]] + a1 * flat[at[5]]) + (a2 * flat[at[6]] + a3 * flat[at[7]]))
                value += d2 * ((a0 * flat[at[8]] + a1 * flat[at[9]]) + (a2 * flat[at[10]] + a3 * flat[at[11]]))
                value += d3 * ((a0 * flat[at[12]] + a1 * flat[at[13]]) + (a2 * flat[at[14]] + a3 * flat[at[15]]))
                rest = -value
                if given:
                    rest += (
                        matrix[k, 0] * np.float32(codes[row, pixel, 0])
                        + matrix[k, 1] * np.float32(codes[row, pixel, 1])
                        + matrix[k, 2] * np.float32(codes[row, pixel, 2])
                    )
                line_squares += w * rest * rest
                back = sign * w * rest
                into = out[k].reshape(-1)
                b0, b1, b2, b3 = back * d0, back * d1, back * d2, back * d3
                into[at[0]] += b0 * a0
                into[at[1]] += b0 * a1
                into[at[2]] += b0 * a2
                into[at[3]] += b0 * a3
                into[at[4]] += b1 * a0
                into[at[5]] += b1 * a1
                into[at[6]] += b1 * a2
                into[at[7]] += b1 * a3
                into[at[8]] += b2 * a0
                into[at[9]] += b2 * a1
                into[at[10]] += b2 * a2
                into[at[11]] += b2 * a3
                into[at[12]] += b3 * a0
                into[at[13]] += b3 * a1
                into[at[14]] += b3 * a2
                into[at[15]] += b3 * a3
            line_total += w
        squares += np.float64(line_squares)
        total += np.float64(line_total)
    return squares, total


@kernel()
def enlarge(coarse, row_at, row_weight, column_at, column_weight, spans, lines, start, fine):
    """fine (C, H, W) = start (C, H, W), or (0, 0, 0) for zeros, + coarse (C, h, w) by the taps of
    `eigenfield.rendering.resample.Taps`, within `spans`.

    spans (H, 2): first and last + 1 column that is needed of each fine row, equal where none is; what lies outside
    stays as it is. lines (h, W): room.
    """
    low, high, begun = spans[:, 0].min(), spans[:, 1].max(), start.shape[0] > 0
    for k in range(coarse.shape[0]):
        for row in range(coarse.shape[1]):
            line, out = coarse[k, row], lines[row]
            for x in range(low, high):
                a, w = column_at[x], column_weight[x]
                out[x] = (w[0] * line[a[0]] + w[1] * line[a[1]]) + (w[2] * line[a[2]] + w[3] * line[a[3]])
        for y in range(fine.shape[1]):
            first, last = spans[y, 0], spans[y, 1]
            if first == last:
                continue
            w, out = row_weight[y], fine[k, y]
            l0, l1, l2, l3 = lines[row_at[y, 0]], lines[row_at[y, 1]], lines[row_at[y, 2]], lines[row_at[y, 3]]
            if begun:
                before = start[k, y]
                for x in range(first, last):
                    out[x] = before[x] + ((w[0] * l0[x] + w[1] * l1[x]) + (w[2] * l2[x] + w[3] * l3[x]))
            else:
                for x in range(first, last):
                    out[x] = (w[0] * l0[x] + w[1] * l1[x]) + (w[2] * l2[x] + w[3] * l3[x])


@kernel()
def reduce(fine, row_at, row_weight, column_at, column_weight, spans, lines, coarse):
    """coarse (C, h, w) = the transpose of `enlarge` on fine (C, H, W), which counts as zero outside `spans`."""
    low, high = spans[:, 0].min(), spans[:, 1].max()
    for k in range(coarse.shape[0]):
        lines[:] = 0
        for y in range(fine.shape[1]):
            first, last = spans[y, 0], spans[y, 1]
            if first == last:
                continue
            source = fine[k, y]
            for tap in range(4):
                w, out = row_weight[y, tap], lines[row_at[y, tap]]
                for x in range(first, last):
                    out[x] += w * source[x]
        for row in range(coarse.shape[1]):
            line, out = lines[row], coarse[k, row]
            out[:] = 0
            for x in range(low, high):
                value = line[x]
                for tap in range(4):
                    out[column_at[x, tap]] += column_weight[x, tap] * value


@kernel()
def add_laplacian(texture, strength, out):
    """out (C, H, W) += strength times the Laplacian of texture: 4 x itself less its neighbours, those beyond
    the border counting as itself."""
    channels, height, width = texture.shape
    for k in range(channels):
        for y in range(height):
            for x in range(width):
                here = texture[k, y, x]
                rest = np.float32(0)
                if y > 0:
                    rest += here - texture[k, y - 1, x]
                if y + 1 < height:
                    rest += here - texture[k, y + 1, x]
                if x > 0:
                    rest += here - texture[k, y, x - 1]
                if x + 1 < width:
                    rest += here - texture[k, y, x + 1]
                out[k, y, x] += strength * rest
