"""The normal matrix of the fit, G^T w G, times textures: what a pixel shows goes back to the texels that it came from
while their addresses and weights are at hand, in half the time of `forward` and `adjoint` one after the other."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.encoding.fitted.kernels import draw_at_border, part_of, ratio_of, return_at_border, share_of
from eigenfield.encoding.fitted.point_taps import draw_point, multiply_point, multiply_point_twice, return_point
from eigenfield.runtime.jit import kernel


@kernel(inline=True)
def draw_points(flat, shape, ratio, points, first, count, shares, colour):
    """colour (C,) += what a pixel shows of a texture by `count` points."""
    for at in range(first, first + count):
        part = share_of(count, shares, at)
        if not draw_point(flat, shape, ratio, points, at, part, colour, 1, 0):
            draw_at_border(flat, shape, ratio, points, at, part, colour, 1, 0)


@kernel(inline=True)
def return_points(flat, shape, ratio, points, first, count, shares, whole, colour):
    """The transpose of `draw_points`, times `whole`."""
    for at in range(first, first + count):
        part = whole * share_of(count, shares, at)
        if not return_point(flat, shape, ratio, points, at, part, colour, 1, 0):
            return_at_border(flat, shape, ratio, points, at, part, colour, 1, 0)


@kernel()
def multiply(counts, coordinates, shares, size, weight, texture, product):
    """product += G^T w G texture.

    Args:
        weight: w, see `kernels.part_of`.
        texture: (C, rows, columns).
    """
    flat, into, points, shape = texture.reshape(-1), product.reshape(-1), coordinates.reshape(-1), texture.shape
    ratio, colour = ratio_of(shape, size), np.empty(texture.shape[0], np.float32)
    at = np.int64(0)
    for row in range(counts.shape[0]):
        for column in range(counts.shape[1]):
            count, whole = np.int64(counts[row, column]), part_of(weight, row, column)
            if count > 0 and whole > 0:
                part = share_of(count, shares, at)
                if count > 1 or not multiply_point(flat, into, shape, ratio, points, at, whole * part * part):
                    colour[:] = 0
                    draw_points(flat, shape, ratio, points, at, count, shares, colour)
                    return_points(into, shape, ratio, points, at, count, shares, whole, colour)
            at += count


@kernel()
def multiply_both(counts, coordinates, shares, size, weight, fine, coarse, fine_product, coarse_product):
    """fine_product += G^T w (G fine + G coarse), and coarse_product likewise.

    Args:
        weight: w, see `kernels.part_of`.
        fine: (C, H, W).
        coarse: (C, h, w).
    """
    one, one_into, one_shape = fine.reshape(-1), fine_product.reshape(-1), fine.shape
    other, other_into, other_shape = coarse.reshape(-1), coarse_product.reshape(-1), coarse.shape
    one_ratio, other_ratio = ratio_of(one_shape, size), ratio_of(other_shape, size)
    points, colour = coordinates.reshape(-1), np.empty(one_shape[0], np.float32)
    at = np.int64(0)
    for row in range(counts.shape[0]):
        for column in range(counts.shape[1]):
            count, whole = np.int64(counts[row, column]), part_of(weight, row, column)
            if count > 0 and whole > 0:
                part = share_of(count, shares, at)
                if count > 1 or not multiply_point_twice(
                    one, one_into, one_shape, one_ratio, other, other_into, other_shape, other_ratio, points, at,
                    whole * part * part,
                ):  # fmt: skip
                    colour[:] = 0
                    draw_points(one, one_shape, one_ratio, points, at, count, shares, colour)
                    draw_points(other, other_shape, other_ratio, points, at, count, shares, colour)
                    return_points(one_into, one_shape, one_ratio, points, at, count, shares, whole, colour)
                    return_points(other_into, other_shape, other_ratio, points, at, count, shares, whole, colour)
            at += count
