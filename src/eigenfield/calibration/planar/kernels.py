"""Inner loops of camera refinement."""

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel


@kernel(inline=True)
def _bilinear_rgb(picture, x, y):  # type: ignore[no-untyped-def]
    """The three channels of a picture (H, W, 3), bilinearly interpolated at index coordinates inside it."""
    i, j = int(x), int(y)
    fx, fy = np.float32(x - i), np.float32(y - j)
    one = np.float32(1)
    a, b, c, d = (one - fx) * (one - fy), fx * (one - fy), (one - fx) * fy, fx * fy
    return (
        a * picture[j, i, 0] + b * picture[j, i + 1, 0] + c * picture[j + 1, i, 0] + d * picture[j + 1, i + 1, 0],
        a * picture[j, i, 1] + b * picture[j, i + 1, 1] + c * picture[j + 1, i, 1] + d * picture[j + 1, i + 1, 1],
        a * picture[j, i, 2] + b * picture[j, i + 1, 2] + c * picture[j + 1, i, 2] + d * picture[j + 1, i + 1, 2],
    )


@kernel(fastmath=True)
def normal_equations(picture, points, colours, matrix, buffer, bias, tau, left, right):  # type: ignore[no-untyped-def]
    """Gauss-Newton sums of one camera's matrix over points with known colours that its photograph shows.

    With e = T - I(pi(p)) in each channel, J = grad I dpi/dtheta and Cauchy weights w = 1 / (1 + e^2 / tau^2):
    sum w J J^T and sum w J e. A point counts unless the depth buffer is nearer by more than `bias`.

    Theta are the twelve entries of the matrix. By them J is the product of h = (gx, gy, -(gx u + gy v)) and
    X = (x, y, d, 1) / z, so that J J^T is that of h h^T (summed over the channels) and X X^T. The sums by other
    parameters follow from these by the chain rule.

    Args:
        picture: (H, W, 4) uint8 of a packed picture.
        points: (k, 3) x, y, d.
        colours: (k, 3) T, grey levels.
        matrix: (3, 4) of the camera.
        buffer: (H, W) depth buffer.
        bias: Labels.
        tau: Grey levels.
        left: (3, 3, 16), added to: entry (i, j, 4 k + l) belongs to matrix entries (i, k) and (j, l).
        right: (3, 4), added to.

    Returns:
        The sum of e^2 over channels, and the number of points.
    """
    height, width = picture.shape[0], picture.shape[1]
    X, square = np.zeros(4), np.zeros(16)
    hh, he = np.zeros(9), np.zeros(3)
    total = 0.0
    seen = 0
    half = np.float32(0.5)
    for n in range(points.shape[0]):
        x, y, d = points[n, 0], points[n, 1], points[n, 2]
        z = matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2] * d + matrix[2, 3]
        u = (matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2] * d + matrix[0, 3]) / z
        v = (matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2] * d + matrix[1, 3]) / z
        if not (u >= 2 and v >= 2 and u < width - 3 and v < height - 3):
            continue
        if buffer[int(v + 0.5), int(u + 0.5)] > d + bias:
            continue
        if picture[int(v) - 2, int(u) - 2, 3] > 0 or picture[int(v) + 3, int(u) + 3, 3] > 0:
            continue
        here = _bilinear_rgb(picture, u, v)
        east, west = _bilinear_rgb(picture, u + half, v), _bilinear_rgb(picture, u - half, v)
        south, north = _bilinear_rgb(picture, u, v + half), _bilinear_rgb(picture, u, v - half)
        seen += 1
        xx = xy = yy = xe = ye = 0.0
        for c in range(3):
            e = colours[n, c] - here[c]
            gx, gy = east[c] - west[c], south[c] - north[c]
            w = 1 / (1 + e * e / (tau * tau))
            total += e * e
            xx += w * gx * gx
            xy += w * gx * gy
            yy += w * gy * gy
            xe += w * gx * e
            ye += w * gy * e
        # the third entry of h is -(u gx + v gy)
        xz, yz = -(u * xx + v * xy), -(u * xy + v * yy)
        hh[0], hh[1], hh[2] = xx, xy, xz
        hh[4], hh[5], hh[8] = yy, yz, -(u * xz + v * yz)
        he[0], he[1], he[2] = xe, ye, -(u * xe + v * ye)
        X[0], X[1], X[2], X[3] = x / z, y / z, d / z, 1 / z
        for k in range(4):
            for m in range(4):
                square[4 * k + m] = X[k] * X[m]
        for i in range(3):
            for k in range(4):
                right[i, k] += he[i] * X[k]
            for j in range(i, 3):
                for k in range(16):
                    left[i, j, k] += hh[3 * i + j] * square[k]
    for i in range(3):
        for j in range(i):
            left[i, j] = left[j, i]
    return total, seen


@kernel()
def occlusion_votes(picture, reference, matrix, d, gap, contrast, near, far):  # type: ignore[no-untyped-def]
    """Which of two surfaces is visible where both project to one pixel of a picture.

    Every pixel records the reference pixels of largest and smallest d that project onto it. It votes where these differ
    by more than `gap` in d and `contrast` in colour, and one is clearly closer to the observed colour.

    Args:
        picture: (H, W, 3) uint8.
        reference: (h, w, 3) uint8, the picture that d belongs to, without margin.
        matrix: (3, 4) from (x, y, d, 1) to index coordinates of the picture.
        d: (h, w) labels.
        gap: Labels.
        contrast: Grey levels.
        near, far: (H, W) int64 scratch, filled with -1.

    Returns:
        The votes for the larger d and for the smaller.
    """
    height, width = near.shape
    rows, columns = d.shape
    for y in range(rows):
        for x in range(columns):
            t = d[y, x]
            z = matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2] * t + matrix[2, 3]
            i = int(np.floor((matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2] * t + matrix[0, 3]) / z + 0.5))
            j = int(np.floor((matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2] * t + matrix[1, 3]) / z + 0.5))
            if i < 0 or j < 0 or i >= width or j >= height:
                continue
            here = y * columns + x
            k = near[j, i]
            if k < 0 or d[k // columns, k % columns] < t:
                near[j, i] = here
            k = far[j, i]
            if k < 0 or d[k // columns, k % columns] > t:
                far[j, i] = here
    larger = 0
    smaller = 0
    for j in range(height):
        for i in range(width):
            k, m = near[j, i], far[j, i]
            if k < 0 or k == m or d[k // columns, k % columns] - d[m // columns, m % columns] < gap:
                continue
            a = 0.0
            b = 0.0
            apart = 0.0
            for c in range(3):
                seen = np.float64(picture[j, i, c])
                one = np.float64(reference[k // columns, k % columns, c])
                other = np.float64(reference[m // columns, m % columns, c])
                a += abs(seen - one)
                b += abs(seen - other)
                apart += abs(one - other)
            if apart < 3 * contrast:
                continue
            if b - a > apart / 2:
                larger += 1
            elif a - b > apart / 2:
                smaller += 1
    return larger, smaller
