"""Inner loops of fusion: normals, agreement between views, and the pixels that represent a surface element.

All views lie one after the other in flat arrays; layout[v] = (first pixel, height, width). projections[v] (3, 4) takes
a world point to homogeneous index coordinates (the centre of the top-left pixel is (0, 0)) whose third entry is the
depth.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.runtime.jit import kernel

FUSION_MAX_SLOPE = 8.0  # tangent of the angle between normal and ray: beyond, it is a depth edge
FUSION_MIN_WINDOW_PIXELS = 10  # of the 25 of a window, on the same surface
FUSION_LEVELS_PER_OCTAVE = 2.0  # of pixel size
FUSION_MIN_NORMAL_COSINE = 0.5  # between two views' normals of one surface


@kernel()
def estimate_normals(inverse_depth, K, R, first, last, normals, level):
    """Normals and levels of pixel size of rows [first, last).

    A plane n . X = 1 seen by a camera is affine in the pixels p = (x, y, 1) of inverse depth, w = n . K^-1 p. A
    least-squares fit w = (a, b, c) . p over the window's pixels on the same surface therefore gives n = K^T (a, b, c).
    A pixel covers an area (Z / f)^2 / cos(angle) of the surface; its level is the logarithm of that area's side.

    Args:
        inverse_depth: (H, W) at index coordinates.
        K: (3, 3) for index coordinates.
        R: (3, 3) world to camera.
        first, last: Range of rows.
        normals: (H, W, 3) float32 world normals towards the camera, written; 0 where there is no surface.
        level: (H, W) int16, written; 0 where there is no surface.
    """
    height, width = inverse_depth.shape
    focal = 0.5 * (K[0, 0] + K[1, 1])
    slope = FUSION_MAX_SLOPE / focal
    for row in range(first, last):
        for column in range(width):
            w = inverse_depth[row, column]
            if not w > 0:
                continue
            count = 0
            sx, sy, sxx, sxy, syy, sw, sxw, syw = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for j in range(max(row - 2, 0), min(row + 3, height)):
                for i in range(max(column - 2, 0), min(column + 3, width)):
                    dx, dy = float(i - column), float(j - row)
                    other = inverse_depth[j, i]
                    if other > 0 and abs(other - w) <= slope * w * (abs(dx) + abs(dy)):
                        d = other - w
                        count += 1
                        sx += dx
                        sy += dy
                        sxx += dx * dx
                        sxy += dx * dy
                        syy += dy * dy
                        sw += d
                        sxw += dx * d
                        syw += dy * d
            if count < FUSION_MIN_WINDOW_PIXELS:
                continue
            sxx -= sx * sx / count
            sxy -= sx * sy / count
            syy -= sy * sy / count
            sxw -= sx * sw / count
            syw -= sy * sw / count
            determinant = sxx * syy - sxy * sxy
            if determinant < 1e-6 * count * count:
                continue
            a = (sxw * syy - syw * sxy) / determinant
            b = (syw * sxx - sxw * sxy) / determinant
            c = w - a * column - b * row
            nx = K[0, 0] * a
            ny = K[0, 1] * a + K[1, 1] * b
            nz = K[0, 2] * a + K[1, 2] * b + c
            length = np.sqrt(nx * nx + ny * ny + nz * nz)
            ry = (row - K[1, 2]) / K[1, 1]
            rx = (column - K[0, 2] - K[0, 1] * ry) / K[0, 0]
            cosine = w / (length * np.sqrt(rx * rx + ry * ry + 1.0))  # n . K^-1 p = w > 0: n points away
            if not cosine > 1.0 / FUSION_MAX_SLOPE / 2:
                continue
            for k in range(3):
                normals[row, column, k] = -(R[0, k] * nx + R[1, k] * ny + R[2, k] * nz) / length
            level[row, column] = np.int16(
                np.floor(FUSION_LEVELS_PER_OCTAVE * np.log2(1.0 / (w * focal * np.sqrt(cosine))))
            )


@kernel(inline=True)
def project_point(projection, x, y, z):
    """Index coordinates and depth of a world point.

    Args:
        projection: (3, 4).
        x, y, z: The point.
    """
    depth = projection[2, 0] * x + projection[2, 1] * y + projection[2, 2] * z + projection[2, 3]
    if depth <= 0:
        return 0.0, 0.0, 0.0
    px = (projection[0, 0] * x + projection[0, 1] * y + projection[0, 2] * z + projection[0, 3]) / depth
    py = (projection[1, 0] * x + projection[1, 1] * y + projection[1, 2] * z + projection[1, 3]) / depth
    return px, py, depth


@kernel()
def confirm_points(
    view, first, last, layout, projections, unprojections, centres, inverse_depth, normals, inside, tolerance,
    agreement, mean, counts,
):  # fmt: skip
    """Which points of rows [first, last) of one view other views confirm, and their mean position.

    A view confirms a point if its own inverse depth, nearest pixel or bilinear, is within a relative tolerance and the
    normals are similar. It contradicts the point if all four pixels around it are clearly farther.

    Args:
        view: Index of the view.
        first, last: Range of rows.
        layout: (V, 3).
        projections: (V, 3, 4).
        unprojections: (V, 3, 3) take index coordinates (x, y, 1) to the world direction of depth 1.
        centres: (V, 3).
        inverse_depth: Flat, of all views.
        normals: Flat, of all views.
        inside: Flat uint8, 0 outside a mask.
        tolerance: Relative difference of depth.
        agreement: How many views must confirm.
        mean: (H W, 3) mean of the positions, written.
        counts: (H W,) int16 number of confirming views, written; 0 if fewer than `agreement`, fewer than the
            contradicting ones, or if masks hide the point.
    """
    start, width = layout[view, 0], layout[view, 2]
    for row in range(first, last):
        for column in range(width):
            local = row * width + column
            pixel = start + local
            counts[local] = 0
            w = inverse_depth[pixel]
            nx, ny, nz = normals[pixel, 0], normals[pixel, 1], normals[pixel, 2]
            if not w > 0 or inside[pixel] == 0 or (nx == 0 and ny == 0 and nz == 0):
                continue
            unproject = unprojections[view]
            x = centres[view, 0] + (unproject[0, 0] * column + unproject[0, 1] * row + unproject[0, 2]) / w
            y = centres[view, 1] + (unproject[1, 0] * column + unproject[1, 1] * row + unproject[1, 2]) / w
            z = centres[view, 2] + (unproject[2, 0] * column + unproject[2, 1] * row + unproject[2, 2]) / w
            mx, my, mz = x, y, z
            confirmed, contradicted, hidden, seen = 0, 0, 0, 0
            for u in range(layout.shape[0]):
                if u == view:
                    continue
                px, py, depth = project_point(projections[u], x, y, z)
                other_start, other_height, other_width = layout[u]
                if depth <= 0 or not (0 <= px < other_width - 1 and 0 <= py < other_height - 1):
                    continue
                seen += 1
                i, j = int(px), int(py)
                corner = other_start + j * other_width + i
                fx, fy = px - i, py - j
                nearest = corner + (1 if fx > 0.5 else 0) + (other_width if fy > 0.5 else 0)
                if inside[nearest] == 0:
                    hidden += 1
                    continue
                w00, w01 = inverse_depth[corner], inverse_depth[corner + 1]
                w10, w11 = inverse_depth[corner + other_width], inverse_depth[corner + other_width + 1]
                low, high = min(w00, w01, w10, w11), max(w00, w01, w10, w11)
                theirs = inverse_depth[nearest]
                if low > 0 and high - low < tolerance * high:
                    theirs = (1 - fy) * ((1 - fx) * w00 + fx * w01) + fy * ((1 - fx) * w10 + fx * w11)
                difference = theirs * depth - 1.0
                if theirs > 0 and abs(difference) < tolerance:
                    facing = nx * normals[nearest, 0] + ny * normals[nearest, 1] + nz * normals[nearest, 2]
                    if facing > FUSION_MIN_NORMAL_COSINE:
                        confirmed += 1
                        unproject = unprojections[u]
                        mx += centres[u, 0] + (unproject[0, 0] * px + unproject[0, 1] * py + unproject[0, 2]) / theirs
                        my += centres[u, 1] + (unproject[1, 0] * px + unproject[1, 1] * py + unproject[1, 2]) / theirs
                        mz += centres[u, 2] + (unproject[2, 0] * px + unproject[2, 1] * py + unproject[2, 2]) / theirs
                elif low > 0 and high * depth < 1.0 - 2 * tolerance:
                    contradicted += 1
            if confirmed < agreement or contradicted > confirmed or hidden * 10 > seen:
                continue
            counts[local] = confirmed
            mean[local, 0] = mx / (confirmed + 1)
            mean[local, 1] = my / (confirmed + 1)
            mean[local, 2] = mz / (confirmed + 1)


@kernel()
def select_finest(view, first, last, layout, projections, mean, normals, level, confirmed, tolerance, keep):
    """Which confirmed pixels of rows [first, last) of one view represent their surface element.

    A pixel yields to another view's confirmed pixel of the same element with a finer level, or with the same level and
    an earlier view. That is a strict order, so that one pixel of every set on one element stays.

    Args:
        view: Index of the view.
        first, last: Range of rows.
        layout: (V, 3).
        projections: (V, 3, 4).
        mean: Flat positions of `confirm_points`, of all views.
        normals: Flat, of all views.
        level: Flat, of all views.
        confirmed: Flat counts of `confirm_points`, of all views.
        tolerance: Relative difference of depth.
        keep: (H W,) bool, written.
    """
    start, width = layout[view, 0], layout[view, 2]
    for row in range(first, last):
        for column in range(width):
            local = row * width + column
            pixel = start + local
            keep[local] = confirmed[pixel] > 0
            if not keep[local]:
                continue
            x, y, z = mean[pixel, 0], mean[pixel, 1], mean[pixel, 2]
            for u in range(layout.shape[0]):
                if u == view:
                    continue
                px, py, depth = project_point(projections[u], x, y, z)
                other_start, other_height, other_width = layout[u]
                if depth <= 0 or not (-0.5 < px < other_width - 0.5 and -0.5 < py < other_height - 0.5):
                    continue
                other = other_start + int(py + 0.5) * other_width + int(px + 0.5)
                if confirmed[other] == 0:
                    continue
                first_one = level[other] < level[pixel] or (level[other] == level[pixel] and u < view)
                if not first_one:
                    continue
                matrix = projections[u]
                ox, oy, oz = mean[other, 0], mean[other, 1], mean[other, 2]
                theirs = matrix[2, 0] * ox + matrix[2, 1] * oy + matrix[2, 2] * oz + matrix[2, 3]
                facing = normals[pixel, 0] * normals[other, 0] + normals[pixel, 1] * normals[other, 1]
                facing += normals[pixel, 2] * normals[other, 2]
                if abs(theirs - depth) < 2 * tolerance * depth and facing > FUSION_MIN_NORMAL_COSINE:
                    keep[local] = False
                    break
