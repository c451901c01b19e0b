"""Inner loop of a distortion map: what one camera adds to the texels that it sees."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel


@kernel()
def add_camera(first, last, matrix, world, deeper, nearest, ratio, shares, right, down, variance, picture, sums):
    """Add a camera to sums (6, t) of texels [first, last): the share that each has in the camera's picture, 0 or 1 on
    an opaque mesh, and its square; times this the error for a step of depth and its square, the variance around and
    the picture's square.

    Args:
        matrix: (3, 4) of the camera.
        world: (t, 3) points of the texels.
        deeper: (t, 3) the points a step of depth away.
        nearest: (h, w) 1 / depth of what the camera draws; (0, 0): nothing hides.
        ratio: Of `nearest`, from which on a point is visible.
        shares: (t,) float32 of the points in the picture; (0,): 1 where a point is visible.
        right: (h, w) the picture's slope to the right.
        down: (h, w) its slope down.
        variance: (h, w) of the picture around.
        picture: (h, w) luma.
        sums: (6, t) float64.
    """
    height, width = picture.shape
    for t in range(first, last):
        x = matrix[0, 0] * world[t, 0] + matrix[0, 1] * world[t, 1] + matrix[0, 2] * world[t, 2] + matrix[0, 3]
        y = matrix[1, 0] * world[t, 0] + matrix[1, 1] * world[t, 1] + matrix[1, 2] * world[t, 2] + matrix[1, 3]
        z = matrix[2, 0] * world[t, 0] + matrix[2, 1] * world[t, 1] + matrix[2, 2] * world[t, 2] + matrix[2, 3]
        if not z > 0:
            continue
        x, y = x / z, y / z
        if not (x >= 0 and y >= 0 and x < width and y < height):
            continue
        column, row = int(x), int(y)
        if len(nearest) and 1 / z < nearest[row, column] * ratio:
            continue
        share = np.float64(shares[t]) if len(shares) else 1.0
        square = share * share
        sums[0, t] += share
        sums[1, t] += square
        u = matrix[0, 0] * deeper[t, 0] + matrix[0, 1] * deeper[t, 1] + matrix[0, 2] * deeper[t, 2] + matrix[0, 3]
        v = matrix[1, 0] * deeper[t, 0] + matrix[1, 1] * deeper[t, 1] + matrix[1, 2] * deeper[t, 2] + matrix[1, 3]
        w = matrix[2, 0] * deeper[t, 0] + matrix[2, 1] * deeper[t, 1] + matrix[2, 2] * deeper[t, 2] + matrix[2, 3]
        if w > 0:
            error = right[row, column] * (u / w - x) + down[row, column] * (v / w - y)
            sums[2, t] += error * square
            sums[3, t] += error * error * square
        sums[4, t] += np.float64(variance[row, column]) * square
        sums[5, t] += np.float64(picture[row, column]) * picture[row, column] * square
