"""Kernels of a multiplane image: its layers as a photograph sees them, composited, and the gradients of both."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.imaging.texels import add_scaled_texel, bilinear_slopes, gather_bilinear, scatter_bilinear
from eigenfield.runtime.jit import kernel
from eigenfield.stereo.taps import FASTMATH_ORDERED


@kernel()
def pixel_rays(base, slope, rays):
    """rays (H, W, 4) = u, v, s and t of each pixel of a photograph, which sees (u, v) + d (s, t) on the plane of label
    d; u is NaN where the plane is behind the camera.

    Args:
        base: (3, 3) float64, from the pixel (x, y, 1) to (u, v, 1), homogeneous.
        slope: (2, 3) float64, from the pixel to (s, t) times that scale.
        rays: Written.
    """
    for row in range(rays.shape[0]):
        y = np.float64(row)
        for column in range(rays.shape[1]):
            x = np.float64(column)
            scale = base[2, 0] * x + base[2, 1] * y + base[2, 2]
            over = 1 / scale
            u = np.float32((base[0, 0] * x + base[0, 1] * y + base[0, 2]) * over)
            rays[row, column, 0] = u if scale > 0 else np.float32(np.nan)
            rays[row, column, 1] = np.float32((base[1, 0] * x + base[1, 1] * y + base[1, 2]) * over)
            rays[row, column, 2] = np.float32((slope[0, 0] * x + slope[0, 1] * y + slope[0, 2]) * over)
            rays[row, column, 3] = np.float32((slope[1, 0] * x + slope[1, 1] * y + slope[1, 2]) * over)


@kernel()
def plane_places(height, width, rays, label, places):
    """places (H, W, 2) = column and row in a layer of what a photograph's pixels see of it; -1, -1 beyond its border.

    Args:
        height, width: Of the layer.
        rays: (H, W, 4) of `pixel_rays`.
        label: float32 of the plane.
        places: Written.
    """
    for row in range(places.shape[0]):
        for column in range(places.shape[1]):
            u, v = (
                rays[row, column, 0] + label * rays[row, column, 2],
                rays[row, column, 1] + label * rays[row, column, 3],
            )
            put_place(u, v, height, width, places, row, column)


@kernel(inline=True)
def label_at(flat, width, u, v, right, bottom):
    """Labels read bilinearly at the column u and row v, which may be beyond their border: right, bottom."""
    across, down = min(max(u, np.float32(0)), right), min(max(v, np.float32(0)), bottom)
    left, top = np.int64(across), np.int64(down)
    f, g, at = across - np.float32(left), down - np.float32(top), top * width + left
    above = flat[at] + f * (flat[at + 1] - flat[at])
    below = flat[at + width] + f * (flat[at + width + 1] - flat[at + width])
    return above + g * (below - above)


@kernel()
def field_places(labels, rays, start, iterations, tolerance, places):
    """As `plane_places`, of a height field: d is that of the place itself.

    A fixed point finds it while d changes by less than one over the parallax (s, t) from texel to texel. It begins with
    the label that the pixel above has found: the one beside would have the processor wait for it. Two iterations are
    enough for nearly all, and are done without asking, since a wrong guess of the answer costs as much as one.

    Args:
        labels: (height, width) float32.
        rays: (H, W, 4) of `pixel_rays`.
        start: float32 label to begin with.
        iterations: Of the fixed point, at most; at least two.
        tolerance: float32, pixels of the layer by which the last one moves the place, at most.
        places: Written.
    """
    height, width = labels.shape
    right, bottom, flat = np.float32(width - 1.001), np.float32(height - 1.001), labels.reshape(-1)
    found = np.full(places.shape[1], start, np.float32)
    for row in range(places.shape[0]):
        for column in range(places.shape[1]):
            u0, v0, s, t = rays[row, column, 0], rays[row, column, 1], rays[row, column, 2], rays[row, column, 3]
            if np.isnan(u0):
                found[column] = start
                places[row, column, 0], places[row, column, 1] = np.float32(-1), np.float32(-1)
                continue
            d, reach = found[column], max(abs(s), abs(t))
            before = label_at(flat, width, u0 + d * s, v0 + d * t, right, bottom)
            d = label_at(flat, width, u0 + before * s, v0 + before * t, right, bottom)
            for _ in range(2, iterations):
                if abs(d - before) * reach < tolerance:
                    break
                before, d = d, label_at(flat, width, u0 + d * s, v0 + d * t, right, bottom)
            found[column] = d
            put_place(u0 + d * s, v0 + d * t, height, width, places, row, column)


@kernel(inline=True)
def put_place(u, v, height, width, places, row, column):
    """places[row, column] = (u, v), or -1, -1 beyond the border of height x width, or if u is NaN."""
    inside = u >= 0 and v >= 0 and u < width - 1 and v < height - 1
    places[row, column, 0] = u if inside else np.float32(-1)
    places[row, column, 1] = v if inside else np.float32(-1)


@kernel()
def draw_layer(layer, places, picture):
    """picture (H, W, 4) = the layer (h, w, 4) read bilinearly at `places` (H, W, 2); 0 where these are negative."""
    flat, drawn, line = layer.reshape(-1), picture.reshape(-1), np.int64(4 * layer.shape[1])
    at = np.int64(0)
    for row in range(picture.shape[0]):
        for column in range(picture.shape[1]):
            u, v = places[row, column, 0], places[row, column, 1]
            if u >= 0:
                left, top = np.int64(u), np.int64(v)
                right, below = u - np.float32(left), v - np.float32(top)
                gather_bilinear(flat, top * line + 4 * left, line, right, below, drawn, at)
            else:
                drawn[at : at + 4] = 0
            at += 4


@kernel()
def add_layer_gradient(gradient, places, layer_gradient):
    """The transpose of `draw_layer`: adds what a picture's gradient (H, W, 4) is for the layer (h, w, 4)."""
    flat, drawn, line = layer_gradient.reshape(-1), gradient.reshape(-1), np.int64(4 * layer_gradient.shape[1])
    at = np.int64(0)
    for row in range(gradient.shape[0]):
        for column in range(gradient.shape[1]):
            u, v = places[row, column, 0], places[row, column, 1]
            if u >= 0:
                left, top = np.int64(u), np.int64(v)
                right, below = u - np.float32(left), v - np.float32(top)
                scatter_bilinear(flat, top * line + 4 * left, line, right, below, drawn, at)
            at += 4


@kernel()
def add_label_gradient(gradient, places, layer, rays, label_gradient):
    """Add what a picture's gradient (H, W, 4) is for the labels (h, w) of a height field.

    A label moves the place at which a pixel reads the layer along (s, t), see `pixel_rays`: its gradient is that of
    the pixel times the layer's slope along (s, t).

    Args:
        gradient: (H, W, 4).
        places: (H, W, 2).
        layer: (h, w, 4).
        rays: (H, W, 4) of `pixel_rays`.
        label_gradient: (h, w), added to.
    """
    flat, drawn, line = layer.reshape(-1), gradient.reshape(-1), np.int64(4 * layer.shape[1])
    at = np.int64(-4)
    for row in range(gradient.shape[0]):
        for column in range(gradient.shape[1]):
            u, v = places[row, column, 0], places[row, column, 1]
            at += 4
            if u < 0:
                continue
            left, top = np.int64(u), np.int64(v)
            f, g = u - np.float32(left), v - np.float32(top)
            across, down = bilinear_slopes(flat, top * line + 4 * left, line, f, g, drawn, at)
            moved = across * rays[row, column, 2] + down * rays[row, column, 3]
            right = f * moved
            rest = moved - right
            label_gradient[top, left] += (np.float32(1) - g) * rest
            label_gradient[top, left + 1] += (np.float32(1) - g) * right
            label_gradient[top + 1, left] += g * rest
            label_gradient[top + 1, left + 1] += g * right


@kernel()
def composite(layers, top, bottom, picture):
    """picture = the layers one over the other, for rows from `top` to `bottom`.

    Args:
        layers: (D, H, W, 4) R, G, B and opacity, back to front.
        top, bottom: First row, and the one after the last.
        picture: (H, W, 3), written.
    """
    for row in range(top, bottom):
        for column in range(picture.shape[1]):
            r, g, b = np.float32(0), np.float32(0), np.float32(0)
            for d in range(layers.shape[0]):
                a = layers[d, row, column, 3]
                r += a * (layers[d, row, column, 0] - r)
                g += a * (layers[d, row, column, 1] - g)
                b += a * (layers[d, row, column, 2] - b)
            picture[row, column, 0], picture[row, column, 1], picture[row, column, 2] = r, g, b


@kernel()
def composite_gradient(layers, codes, top, bottom, behind):
    """Replace the layers by the gradient of the squared error, for rows from `top` to `bottom`; returns that error.

    With T the transmittance of what lies in front of a layer, c its colour, a its opacity, b what lies behind it,
    composited, and e the picture's error, the gradient is 2 T a e for the colour and 2 T e . (c - b) for the opacity.

    Args:
        layers: As of `composite`.
        codes: (H, W, 3) uint8 the photograph.
        top, bottom: As of `composite`.
        behind: (D, 3) float32 scratch.
    """
    total, scale = 0.0, np.float32(1 / 255)
    for row in range(top, bottom):
        for column in range(layers.shape[2]):
            r, g, b = np.float32(0), np.float32(0), np.float32(0)
            for d in range(layers.shape[0]):
                behind[d, 0], behind[d, 1], behind[d, 2] = r, g, b
                a = layers[d, row, column, 3]
                r += a * (layers[d, row, column, 0] - r)
                g += a * (layers[d, row, column, 1] - g)
                b += a * (layers[d, row, column, 2] - b)
            r -= scale * np.float32(codes[row, column, 0])
            g -= scale * np.float32(codes[row, column, 1])
            b -= scale * np.float32(codes[row, column, 2])
            total += np.float64(r * r + g * g + b * b)
            through = np.float32(2)
            for d in range(layers.shape[0] - 1, -1, -1):
                red, green, blue = layers[d, row, column, 0], layers[d, row, column, 1], layers[d, row, column, 2]
                a = layers[d, row, column, 3]
                moved = r * (red - behind[d, 0]) + g * (green - behind[d, 1]) + b * (blue - behind[d, 2])
                layers[d, row, column, 3] = through * moved
                part = through * a
                layers[d, row, column, 0], layers[d, row, column, 1] = part * r, part * g
                layers[d, row, column, 2] = part * b
                through *= np.float32(1) - a
    return total


@kernel(fastmath=FASTMATH_ORDERED, inline=True)
def slope(difference, inverse_width):
    """Derivative of the Huber function, which is quadratic up to 1 / inverse_width and then of slope 1."""
    return min(max(difference * inverse_width, np.float32(-1)), np.float32(1))


@kernel(fastmath=FASTMATH_ORDERED)
def add_priors(layer, channels, scale, variation, price, doubt, inverse_width, gradient):
    """gradient = scale gradient + that of the total variation and of two prices for each number.

    Args:
        layer: (h, w C) float32, texels of C numbers.
        channels: C.
        scale: Of the gradient so far.
        variation: (w C) of each column: weight of the difference of neighbours.
        price: (w C) of each column: cost of the number x itself.
        doubt: (w C) of each column: cost of x (1 - x).
        inverse_width: Of `slope`.
        gradient: (h, w C) float32, changed.
    """
    rows, columns = layer.shape
    inner = columns - channels
    left_variation, right_variation = variation[:inner], variation[channels:]
    for row in range(rows):
        here, out = layer[row], gradient[row]
        above, below = layer[max(row - 1, 0)], layer[min(row + 1, rows - 1)]
        # parts of rows, since an index that may be negative keeps a loop from being vectorised
        left, right, left_out, right_out = here[:inner], here[channels:], out[:inner], out[channels:]
        for i in range(columns):
            vertical = slope(here[i] - above[i], inverse_width) + slope(here[i] - below[i], inverse_width)
            own = price[i] + doubt[i] * (np.float32(1) - np.float32(2) * here[i])
            out[i] = scale * out[i] + variation[i] * vertical + own
        for i in range(inner):
            right_out[i] += right_variation[i] * slope(right[i] - left[i], inverse_width)
        for i in range(inner):
            left_out[i] += left_variation[i] * slope(left[i] - right[i], inverse_width)


@kernel()
def restrict(fine, row_at, row_part, column_at, column_part, coarse):
    """coarse = the transpose of `prolong`, of the fine grid.

    Args:
        fine: (h, w, C).
        row_at, row_part: (h,) the coarse row before each fine one, ascending, and the weight of the next.
        column_at, column_part: (w,) likewise.
        coarse: (h', w', C), written.
    """
    height, width, channels = fine.shape
    source = fine.reshape(height, channels * width)
    first, second = np.zeros(channels * width, np.float32), np.zeros(channels * width, np.float32)
    coarse[:] = 0
    out, row = coarse.reshape(-1), 0
    for into in range(coarse.shape[0]):
        line_at = into * coarse.shape[1] * channels
        for i in range(channels * width):
            first[i], second[i] = second[i], np.float32(0)
        while row < height and row_at[row] == into:
            part, line = row_part[row], source[row]
            rest = np.float32(1) - part
            for i in range(channels * width):
                first[i] += rest * line[i]
                second[i] += part * line[i]
            row += 1
        for column in range(width):
            at, part = column_at[column], column_part[column]
            rest = np.float32(1) - part
            if channels == 4:
                add_scaled_texel(out, line_at + 4 * at, rest, first, 4 * column)
                add_scaled_texel(out, line_at + 4 * at + 4, part, first, 4 * column)
            else:
                for channel in range(channels):
                    value = first[channels * column + channel]
                    coarse[into, at, channel] += rest * value
                    coarse[into, at + 1, channel] += part * value


@kernel()
def prolong(coarse, row_at, row_part, column_at, column_part, fine):
    """fine += the coarse grid, interpolated bilinearly. Arguments as of `restrict`."""
    height, width, channels = fine.shape
    numbers = channels * coarse.shape[1]
    line, source, out = np.zeros(numbers, np.float32), coarse.reshape(-1, numbers), fine.reshape(-1)
    for row in range(height):
        above, below = source[row_at[row]], source[row_at[row] + 1]
        part = row_part[row]
        rest = np.float32(1) - part
        for i in range(numbers):
            line[i] = rest * above[i] + part * below[i]
        into = row * width * channels
        for column in range(width):
            at, right = channels * column_at[column], column_part[column]
            left = np.float32(1) - right
            if channels == 4:
                add_scaled_texel(out, into, left, line, at)
                add_scaled_texel(out, into, right, line, at + 4)
            else:
                for channel in range(channels):
                    out[into + channel] += left * line[at + channel] + right * line[at + channels + channel]
            into += channels


@kernel()
def adam_step(gradient, mean, square, mean_decay, square_decay, mean_correction, square_correction):
    """Replace a gradient by the step of Adam, of a rate of 1.

    Args:
        gradient: (n,) float32, changed.
        mean: (n,) its running mean, changed.
        square: (n,) the running mean of its square, changed.
        mean_decay, square_decay: Of the running means.
        mean_correction, square_correction: By which they are multiplied for their start at zero.
    """
    for i in range(gradient.size):
        value = gradient[i]
        mean[i] = mean_decay * mean[i] + (np.float32(1) - mean_decay) * value
        square[i] = square_decay * square[i] + (np.float32(1) - square_decay) * value * value
        gradient[i] = -mean[i] * mean_correction / (np.sqrt(square[i] * square_correction) + np.float32(1e-8))


@kernel()
def move(layer, step, rate, low, high):
    """layer += rate times the step, clamped. All are (h, n), but rate, low and high (n,) of each column."""
    for row in range(layer.shape[0]):
        here, there = layer[row], step[row]
        for i in range(layer.shape[1]):
            here[i] = min(max(here[i] + rate[i] * there[i], low[i]), high[i])


@kernel()
def raise_texels(values, places, texels):
    """Raise texels (h, w) to the largest of the values (H, W) of the pixels that read them at `places` (H, W, 2)."""
    for row in range(values.shape[0]):
        for column in range(values.shape[1]):
            u, v = places[row, column, 0], places[row, column, 1]
            if u >= 0:
                left, top = np.int64(u), np.int64(v)
                for below in range(top, top + 2):
                    for beside in range(left, left + 2):
                        texels[below, beside] = max(texels[below, beside], values[row, column])
