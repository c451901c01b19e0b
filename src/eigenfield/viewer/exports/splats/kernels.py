"""Gaussians as a camera sees them: one pass front to back, and its transpose (Kerbl, Kopanas, Leimkühler, Drettakis,
"3D Gaussian Splatting for Real-Time Radiance Field Rendering", 2023, equations 3 to 5)."""

# mypy: disable-error-code="no-untyped-def"

from __future__ import annotations

import math

import numpy as np

from eigenfield.runtime.jit import kernel

SPLAT_REACH_SIGMAS = 3.0  # where KHR_gaussian_splatting ends a Gaussian
SPLAT_LEAST_ALPHA = 1 / 255  # what is fainter is not drawn, as in viewers
SPLAT_LEAST_REST = 1e-3  # of the light: behind what leaves less, nothing is drawn


@kernel()
def splat(order, pixels, conics, reaches, opacity, colours, gather, image, rest, sums):
    """Draw Gaussians, or gather a picture into them by the weights with which they were drawn.

    Args:
        order: (n,) the Gaussians, front to back.
        pixels: (N, 2) float32 their middles.
        conics: (N, 3) float32 the inverse of their covariance in pixels: xx, xy, yy.
        reaches: (N, 2) float32 half the width and height that they cover.
        opacity: (N,) float32.
        colours: (N, 3) float32.
        gather: Whether `sums` is written, else `image`.
        image: (H, W, 3) float32, added to, or what is gathered.
        rest: (H, W) float32, ones: how much of what is behind shows, written.
        sums: (N, 4) float32, added to: the weighted sum of `image`, and the sum of weights.
    """
    height, width = rest.shape
    for i in order:
        x, y = pixels[i]
        left, right = max(0, math.ceil(x - reaches[i, 0] - 0.5)), min(width, math.floor(x + reaches[i, 0] + 0.5))
        top, bottom = max(0, math.ceil(y - reaches[i, 1] - 0.5)), min(height, math.floor(y + reaches[i, 1] + 0.5))
        xx, xy, yy = conics[i]
        for row in range(top, bottom):
            down = np.float32(row + 0.5) - y
            for column in range(left, right):
                if rest[row, column] < SPLAT_LEAST_REST:
                    continue
                across = np.float32(column + 0.5) - x
                distance = xx * across * across + np.float32(2) * xy * across * down + yy * down * down
                if distance > SPLAT_REACH_SIGMAS * SPLAT_REACH_SIGMAS:
                    continue
                alpha = opacity[i] * math.exp(np.float32(-0.5) * distance)
                if alpha < SPLAT_LEAST_ALPHA:
                    continue
                weight = rest[row, column] * alpha
                rest[row, column] -= weight
                if gather:
                    for c in range(3):
                        sums[i, c] += weight * image[row, column, c]
                    sums[i, 3] += weight
                else:
                    for c in range(3):
                        image[row, column, c] += weight * colours[i, c]
