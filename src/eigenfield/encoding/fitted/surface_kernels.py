"""Kernel of the surface fit: how the pictures change as the surface moves."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

EDGE_ON_MAX_RATIO = 1e-6  # of the tangents' product: at most so much is seen edge-on, without a derivative


@kernel()
def gather_steps(matrix, tangents, points, steps, owners, slopes, asked, seen, out):
    """Add one observation to out (t, 5) float64: texel by texel the sums of g r, g g s, g s, s and r, where g is the
    change of the picture for a unit of the step, s the pixels that the texel answers for and r their residual.

    Args:
        matrix: (3, 4) of its camera.
        tangents: (m, 2, 3) how a texel to the right and one down move in the world.
        points: (t, 3) places of the texels in the world.
        steps: (t, 3) how a unit moves them.
        owners: (t,) the face of each texel.
        slopes: (t, 2) the mean's, for a texel right and down.
        asked: (t,) r.
        seen: (t,) s.
        out: The sums.
    """
    for t in range(points.shape[0]):
        s = seen[t]
        if s <= 0:
            continue
        x = matrix[0, 3]
        y = matrix[1, 3]
        w = matrix[2, 3]
        for k in range(3):
            x += matrix[0, k] * points[t, k]
            y += matrix[1, k] * points[t, k]
            w += matrix[2, k] * points[t, k]
        if w <= 0:
            continue
        x, y = x / w, y / w
        right_x = right_y = down_x = down_y = step_x = step_y = 0.0
        face = owners[t]
        for k in range(3):
            along_x, along_y = matrix[0, k] - x * matrix[2, k], matrix[1, k] - y * matrix[2, k]
            right_x += along_x * tangents[face, 0, k]
            right_y += along_y * tangents[face, 0, k]
            down_x += along_x * tangents[face, 1, k]
            down_y += along_y * tangents[face, 1, k]
            step_x += along_x * steps[t, k]
            step_y += along_y * steps[t, k]
        area = right_x * down_y - right_y * down_x
        size = (abs(right_x) + abs(right_y)) * (abs(down_x) + abs(down_y))
        if abs(area) <= EDGE_ON_MAX_RATIO * size:
            continue
        # the picture's point stays where the surface moved by the step: the texel there is that many back
        back_right = (step_x * down_y - step_y * down_x) / area
        back_down = (right_x * step_y - right_y * step_x) / area
        g = -(slopes[t, 0] * back_right + slopes[t, 1] * back_down)
        out[t, 0] += g * asked[t]
        out[t, 1] += g * g * s
        out[t, 2] += g * s
        out[t, 3] += s
        out[t, 4] += np.float64(asked[t])
