"""Kernels of the fit: what is drawn of textures of any size, its exact transpose, so that least squares can be solved
by them; upsampling of coarse textures; steps of conjugate gradients."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.encoding.fitted.point_taps import draw_point, return_point
from eigenfield.rendering.software.kernels import filter_weights
from eigenfield.runtime.jit import kernel

# The footprint of a camera: `counts` (h, w) uint8 says of how many points of the atlas each pixel is the weighted sum;
# `coordinates` (n, 2) float32 are their columns and rows in the atlas, pixel by pixel. On sheets with an opacity,
# `shares` (n,) uint16 are the weights in units of 1 / SHARE_ONE, and the points of a pixel come front to back. On an
# opaque surface there are none: a single point is all that its pixel shows, each of up to four is a quarter of it.
SHARE_ONE = 1 << 14
WHOLE_MIN_PART = np.float32(0.95)  # of a pixel that is to show the photograph's whole value: opacity is coded


@kernel()
def footprint_counts(near, spans, multisampled, samples, counts):
    """Fill `counts` from a covered `Framebuffer`; returns how many points that makes. Of a pixel at the border of the
    surface those samples count that show something, if there are two: a single one says too little of a photograph's
    pixel."""
    total = 0
    for row in range(counts.shape[0]):
        for pixel in range(counts.shape[1]):
            counts[row, pixel] = near[row, pixel] > 0
        for at in range(spans[row, 0], spans[row, 1]):
            hits = 0
            for sample in range(4 * at, 4 * at + 4):
                hits += samples[0, sample] > 0
            counts[row, multisampled[at]] = 0 if hits == 1 else hits
        for pixel in range(counts.shape[1]):
            total += counts[row, pixel]
    return total


@kernel(inline=True)
def put_coordinates(near, column, row, right, bottom, coordinates, at):
    """coordinates[at] = a sample's column and row, if it shows something, which is returned."""
    if near > 0:
        coordinates[at, 0] = min(max(column / near, np.float32(0)), right)
        coordinates[at, 1] = min(max(row / near, np.float32(0)), bottom)
    return near > 0


@kernel()
def footprint_coordinates(near, column_of, row_of, spans, multisampled, samples, height, width, counts, coordinates):
    """Fill `coordinates`, for `counts` as `footprint_counts` makes it, in an atlas of height x width."""
    right, bottom = np.float32(width - 1), np.float32(height - 1)
    count = 0
    for row in range(counts.shape[0]):
        at = spans[row, 0]
        for pixel in range(counts.shape[1]):
            if at < spans[row, 1] and multisampled[at] == pixel:
                if counts[row, pixel]:
                    for s in range(4 * at, 4 * at + 4):
                        count += put_coordinates(
                            samples[0, s], samples[1, s], samples[2, s], right, bottom, coordinates, count
                        )
                at += 1
            elif counts[row, pixel]:
                count += put_coordinates(
                    near[row, pixel], column_of[row, pixel], row_of[row, pixel], right, bottom, coordinates, count
                )  # fmt: skip


@kernel(inline=True)
def share_of(count, shares, at):
    """What a point of a pixel that has `count` is of it."""
    if shares.shape[0] > 0:
        return np.float32(shares[at]) * np.float32(1 / SHARE_ONE)
    return np.float32(1) if count == 1 else np.float32(0.25)


@kernel()
def target(counts, coordinates, shares, codes, matrix, image):
    """image (C, h, w) = matrix (C, 4) times the codes (h, w, 3) uint8 and 1, and times the part of a pixel that shows
    the surface: what `forward` is to draw."""
    at = 0
    for row in range(counts.shape[0]):
        for pixel in range(counts.shape[1]):
            part = np.float32(0)
            for _ in range(counts[row, pixel]):
                part += share_of(counts[row, pixel], shares, at)
                at += 1
            part = np.float32(1) if part > WHOLE_MIN_PART else part
            for k in range(image.shape[0]):
                value = np.float32(0)
                if part > 0:
                    value = part * (
                        matrix[k, 0] * np.float32(codes[row, pixel, 0])
                        + matrix[k, 1] * np.float32(codes[row, pixel, 1])
                        + matrix[k, 2] * np.float32(codes[row, pixel, 2])
                        + matrix[k, 3]
                    )
                image[k, row, pixel] = value


@kernel(inline=True)
def position(coordinate, ratio, last):
    """A coordinate in the atlas among texels of another size, `ratio` of them to one of the atlas's; clamped to
    0..last."""
    half = np.float32(0.5)
    return min(max((coordinate + half) * ratio - half, np.float32(0)), last)


@kernel(inline=True)
def bicubic_taps(point, across, down, width, height):
    """Column and row of the texel left above a point in a texture of width x height, and Catmull-Rom's weights of the
    columns and rows from the one before on.

    Args:
        point: (2,) in the finest atlas.
        across: `ratio` of `position` along rows.
        down: `ratio` of `position` along columns.
    """
    x = position(point[0], across, np.float32(width - 1))
    y = position(point[1], down, np.float32(height - 1))
    left, top = np.int64(x), np.int64(y)
    return left, top, filter_weights(4, x - np.float32(left)), filter_weights(4, y - np.float32(top))


@kernel(inline=True)
def tap_index(left, top, u, v, width, height):
    """Where tap (u, v) of a point lies in its texture, those beyond the border on it."""
    return min(max(top + v - 1, 0), height - 1) * width + min(max(left + u - 1, 0), width - 1)


@kernel()
def draw_at_border(flat, shape, ratio, points, at, part, image, area, pixel):
    """`point_taps.draw_point` where taps are beyond the border."""
    channels, height, width = shape
    left, top, a, d = bicubic_taps(points[2 * at : 2 * at + 2], ratio[1], ratio[0], width, height)
    for k in range(channels):
        for v in range(4):
            for u in range(4):
                value = flat[k * height * width + tap_index(left, top, u, v, width, height)]
                image[k * area + pixel] += part * d[v] * a[u] * value


@kernel()
def return_at_border(flat, shape, ratio, points, at, part, image, area, pixel):
    """The transpose of `draw_at_border`."""
    channels, height, width = shape
    left, top, a, d = bicubic_taps(points[2 * at : 2 * at + 2], ratio[1], ratio[0], width, height)
    for k in range(channels):
        for v in range(4):
            for u in range(4):
                into = k * height * width + tap_index(left, top, u, v, width, height)
                flat[into] += d[v] * a[u] * part * image[k * area + pixel]


@kernel(inline=True)
def ratio_of(shape, size):
    """Rows, and columns, of a texture of `shape` for one of the finest atlas."""
    return np.float32(shape[1] / size[0]), np.float32(shape[2] / size[1])


@kernel()
def forward(counts, coordinates, shares, size, texture, sign, image):
    """image += sign G texture: the texture drawn by Catmull-Rom.

    Args:
        counts: (h, w) uint8, see above.
        coordinates: (n, 2) float32, in an atlas of `size`.
        shares: (n,) or (0,) uint16.
        size: (H, W), which need not be the texture's.
        texture: (C, rows, columns).
        sign: 1 or -1.
        image: (C, h, w).
    """
    shape, flat, points, drawn = texture.shape, texture.reshape(-1), coordinates.reshape(-1), image.reshape(-1)
    ratio, area, wide = ratio_of(shape, size), image.shape[1] * image.shape[2], image.shape[2]
    at = 0
    for row in range(counts.shape[0]):
        for column in range(counts.shape[1]):
            count, pixel = counts[row, column], row * wide + column
            for _ in range(count):
                part = sign * share_of(count, shares, at)
                if not draw_point(flat, shape, ratio, points, at, part, drawn, area, pixel):
                    draw_at_border(flat, shape, ratio, points, at, part, drawn, area, pixel)
                at += 1


@kernel(inline=True)
def part_of(weight, row, pixel):
    """What a pixel counts for, 0 to 1. weight (h, w) uint8, 255 for whole; (0, 0): all do."""
    return np.float32(weight[row, pixel]) * np.float32(1 / 255) if weight.shape[0] > 0 else np.float32(1)


@kernel()
def adjoint(counts, coordinates, shares, size, image, weight, out):
    """The transpose of `forward`: out += G^T w image.

    Args:
        image: (C, h, w).
        weight: w, see `part_of`.
        out: (C, rows, columns).
    """
    shape, flat, points, drawn = out.shape, out.reshape(-1), coordinates.reshape(-1), image.reshape(-1)
    ratio, area, wide = ratio_of(shape, size), image.shape[1] * image.shape[2], image.shape[2]
    at = 0
    for row in range(counts.shape[0]):
        for column in range(counts.shape[1]):
            count, pixel, whole = counts[row, column], row * wide + column, part_of(weight, row, column)
            if whole <= 0:
                at += count
                continue
            for _ in range(count):
                part = whole * share_of(count, shares, at)
                if not return_point(flat, shape, ratio, points, at, part, drawn, area, pixel):
                    return_at_border(flat, shape, ratio, points, at, part, drawn, area, pixel)
                at += 1


@kernel()
def squares_of(counts, image, weight):
    """Over the covered pixels: the sum of w image^2, and of w. weight: see `part_of`."""
    squares, total = 0.0, 0.0
    for row in range(counts.shape[0]):
        line_squares, line_total = np.float32(0), np.float32(0)
        for pixel in range(counts.shape[1]):
            w = part_of(weight, row, pixel)
            if counts[row, pixel] == 0 or w <= 0:
                continue
            for k in range(image.shape[0]):
                line_squares += w * image[k, row, pixel] * image[k, row, pixel]
            line_total += w
        squares += np.float64(line_squares)
        total += np.float64(line_total)
    return squares, total


@kernel()
def robust_weights(image, weight, variance, out):
    """out = weight / (1 + e^2 / variance), Cauchy's weight of iteratively reweighted least squares for an error of e,
    all channels together.

    Args:
        image: (C, h, w), the errors.
        variance: sigma^2, the squared error of pixels that count half.
        out: (h, w) uint8, 255 for whole.
    """
    for row in range(out.shape[0]):
        for pixel in range(out.shape[1]):
            square = np.float32(0)
            for k in range(image.shape[0]):
                square += image[k, row, pixel] * image[k, row, pixel]
            robust = part_of(weight, row, pixel) / (np.float32(1) + square / variance)
            out[row, pixel] = np.uint8(np.float32(255) * robust + np.float32(0.5))


@kernel()
def upsample(coarse, row_at, row_weight, column_at, column_weight, spans, lines, start, fine):
    """fine (C, H, W) = start (C, H, W), or (0, 0, 0) for zeros, + coarse (C, h, w) by the taps of
    `eigenfield.rendering.software.resample.Taps`, within `spans`.

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


# One part of a conjugate gradient's vectors, (C, h, w): the mean, or one component. Its diagonal is about
# energy x (share + extra), share (h, w) what a texel answers for.


@kernel(inline=True)
def preconditioner(share, extra, energy):
    """The inverse of the diagonal."""
    return np.float32(1) / (energy * (share + extra) + np.float32(1e-6))


@kernel()
def add_laplacian(direction, strength, image):
    """image += strength times the Laplacian of direction: 4 x itself less its neighbours, those beyond the border
    counting as itself. Returns their scalar product."""
    channels, height, width = direction.shape
    total = 0.0
    for k in range(channels):
        for y in range(height):
            for x in range(width):
                here = direction[k, y, x]
                rest = np.float32(0)
                if y > 0:
                    rest += here - direction[k, y - 1, x]
                if y + 1 < height:
                    rest += here - direction[k, y + 1, x]
                if x > 0:
                    rest += here - direction[k, y, x - 1]
                if x + 1 < width:
                    rest += here - direction[k, y, x + 1]
                image[k, y, x] += strength * rest
                total += np.float64(here) * np.float64(image[k, y, x])
    return total


@kernel()
def take_step(state, rest, direction, image, length, share, extra, energy):
    """state += length direction, rest -= length image; returns rest . preconditioned rest."""
    channels, height, width = state.shape
    total = 0.0
    for k in range(channels):
        for y in range(height):
            for x in range(width):
                state[k, y, x] += length * direction[k, y, x]
                left = rest[k, y, x] - length * image[k, y, x]
                rest[k, y, x] = left
                total += np.float64(left) * np.float64(left * preconditioner(share[y, x], extra, energy))
    return total


@kernel()
def next_direction(direction, rest, ratio, share, extra, energy):
    """direction = preconditioned rest + ratio direction; returns rest . preconditioned rest."""
    channels, height, width = direction.shape
    total = 0.0
    for k in range(channels):
        for y in range(height):
            for x in range(width):
                ready = rest[k, y, x] * preconditioner(share[y, x], extra, energy)
                direction[k, y, x] = ready + ratio * direction[k, y, x]
                total += np.float64(rest[k, y, x]) * np.float64(ready)
    return total
