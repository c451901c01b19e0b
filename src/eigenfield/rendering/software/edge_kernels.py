"""Kernels of smooth edges: which pixels show several pieces of the surface, and their samples (docs/decisions/024)."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.imaging.raster import edge_spans, row_span
from eigenfield.rendering.software.simd import EDGE_SAMPLES, draw_four
from eigenfield.runtime.jit import kernel

BLOCK_PX = 8  # of a row whose marks are one word
NOWHERE_TEXELS = np.float32(1e6)  # texels
NEARER_RATIO = 1 + 1e-6  # of inverse depths: more than their rounding


@kernel(inline=True)
def is_off_midpoint(a, b, c, limit):
    """Whether b is off the middle between a and c by more than half of `limit`."""
    return abs((a + c) - np.float32(2) * b) > limit


@kernel()
def to_texel_coordinates(near, column, row, columns, rows):
    """Texel coordinates of a row of pixels; far away from all where there is nothing.

    Args:
        near: (at least W,) 1 / depth.
        column, row: (at least W,) texel coordinates over depth.
        columns, rows: (W,), written.
    """
    for i in range(columns.shape[0]):
        shows = near[i] > 0
        inverse = np.float32(1) / (near[i] if shows else np.float32(1))
        columns[i] = column[i] * inverse if shows else NOWHERE_TEXELS
        rows[i] = row[i] * inverse if shows else NOWHERE_TEXELS


@kernel(inline=True)
def mark_near(near, start, step, first, end, mark):
    """Mark the pixels [first, end) of a row where an inverse depth, start + step * column, is not below `near`.

    Args:
        near: (at least W,) 1 / depth of what is drawn.
        mark: (at least W,), set.
    """
    for i in range(first, end):
        mark[i] |= start + step * i >= near[i]


@kernel()
def mark_rims(edges, bounds, listing, rims, near, first, last, slack, offsets, marks):
    """Mark the pixels through which an edge of a rim triangle runs, as near to their middle as samples lie.

    A triangle thinner than a pixel may cover no middle, not even a neighbour's. Pixels whose middle shows something
    nearer are left out: if the triangle is visible there, that surface ends within the pixel too.

    Args:
        rims: (m,) bool, triangles with an edge that they share with no other.
        near: `inverse_depth` of `draw_texels`.
        marks: (at least last - first, at least W), written.
    """
    marks[: last - first] = False
    wide, narrow = np.empty((3, 3)), np.empty((3, 3))
    for f in listing:
        if not rims[f]:
            continue
        e, columns = edges[f], (bounds[f, 2], bounds[f, 3])
        for i in range(3):
            more = 0.0  # than in the pixel's middle, in one of its samples
            for s in range(offsets.shape[0]):
                more = max(more, abs(e[i, 0] * offsets[s, 0] + e[i, 1] * offsets[s, 1]))
            for k in range(3):
                wide[i, k] = narrow[i, k] = e[i, k]
            wide[i, 2] += more
            narrow[i, 2] -= more
        a, b, c, _ = edge_spans(wide, slack)
        a_in, b_in, c_in, q = edge_spans(narrow, slack)
        # 1 / depth is linear; the most of it within a pixel, and its rounding
        x, y = q[0] * NEARER_RATIO, q[1] * NEARER_RATIO
        one = (e[0, 2] + e[1, 2] + e[2, 2]) * NEARER_RATIO + (x + y + abs(x) + abs(y)) / 2
        for row in range(max(first, bounds[f, 0]), min(last, bounds[f, 1])):
            left, right = row_span(a, b, c, row + 0.5, *columns)
            inner = row_span(a_in, b_in, c_in, row + 0.5, *columns)
            start, mark = y * row + one, marks[row - first]
            if inner[0] < inner[1]:
                mark_near(near[row], start, x, left, inner[0], mark)
                mark_near(near[row], start, x, inner[1], right, mark)
            else:
                mark_near(near[row], start, x, left, right, mark)


@kernel()
def find_edge_pixels(near, column, row, first, last, limit, columns, rows, marks, places, starts, sums):
    """The pixels of rows [first, last) that may be edge pixels.

    These are the pixels in `marks`, those that do not lie half way in the atlas between their neighbours (left and
    right, or above and below), and all at the picture's border.

    Args:
        near, column, row: (H, at least W) middles of pixels, of `draw_texels`.
        limit: Texels by which the middle of an edge pixel deviates.
        columns, rows: (at least last - first + 2, W) scratch.
        marks: (at least last - first, BLOCK_PX * blocks) of `mark_rims`, changed.
        places: Columns of the pixels found, row by row, written.
        starts: (last - first, blocks + 1) number of those before each block of a row, and before the row's end,
            written.
        sums: (last - first + 1, blocks + 1) number of those above a row and left of a block, written.
    """
    height, width, found = near.shape[0], columns.shape[1], 0
    blocks, words = marks.shape[1] // BLOCK_PX, marks.view(np.uint64)  # a word is a block
    for line in range(max(first - 1, 0), min(last + 1, height)):
        at = line - first + 1
        to_texel_coordinates(near[line], column[line], row[line], columns[at], rows[at])
    sums[0] = 0
    for line in range(first, last):
        at = line - first
        mark = marks[at]
        if line == 0 or line == height - 1:
            mark[:width] = True
        else:
            u, v, u_up, v_up, u_down, v_down = (
                columns[at + 1], rows[at + 1], columns[at], rows[at], columns[at + 2], rows[at + 2]
            )  # fmt: skip
            mark[0], mark[width - 1] = True, True
            for i in range(1, width - 1):
                mark[i] |= (
                    is_off_midpoint(u[i - 1], u[i], u[i + 1], limit)
                    | is_off_midpoint(v[i - 1], v[i], v[i + 1], limit)
                    | is_off_midpoint(u_up[i], u[i], u_down[i], limit)
                    | is_off_midpoint(v_up[i], v[i], v_down[i], limit)
                )
        sums[at + 1, 0] = 0
        for block in range(blocks):
            starts[at, block] = found
            if words[at, block]:
                for i in range(block * BLOCK_PX, block * BLOCK_PX + BLOCK_PX):
                    if mark[i]:
                        places[found] = i
                        found += 1
            sums[at + 1, block + 1] = sums[at, block + 1] + found - starts[at, 0]
        starts[at, blocks] = found


@kernel()
def draw_samples(
    faces, texels, edges, bounds, listing, first, last, slack, offsets, places, starts, sums, samples, seen
):  # fmt: skip
    """As `draw_texels`, for the four samples of some pixels.

    Args:
        offsets: (4, 2) samples, in pixels right of and below a pixel's middle.
        places, starts, sums: Of `find_edge_pixels`.
        samples: (at least as many as places, 3, 4) 1 / depth and texel coordinates over depth, written.
    """
    samples[: starts[last - first - 1, starts.shape[1] - 1]] = 0
    flat, more = samples.reshape(-1), np.empty(3 * EDGE_SAMPLES)
    for f in listing:
        left, right = bounds[f, 2], bounds[f, 3]
        low, high = left // BLOCK_PX, (right - 1) // BLOCK_PX + 1
        top, bottom = max(first, bounds[f, 0]), min(last, bounds[f, 1])
        above, below = sums[top - first], sums[bottom - first]
        if below[high] - below[low] == above[high] - above[low]:
            continue  # most triangles have no such pixel anywhere near
        i, j, k = faces[f]
        u, v = (texels[i, 0], texels[j, 0], texels[k, 0]), (texels[i, 1], texels[j, 1], texels[k, 1])
        ax, ay, ac = edges[f, 0, 0], edges[f, 0, 1], edges[f, 0, 2]
        bx, by, bc = edges[f, 1, 0], edges[f, 1, 1], edges[f, 1, 2]
        cx, cy, cc = edges[f, 2, 0], edges[f, 2, 1], edges[f, 2, 2]
        # how much more than in its middle an edge function can be within a pixel
        a_more, b_more, c_more = (abs(ax) + abs(ay)) / 2, (abs(bx) + abs(by)) / 2, (abs(cx) + abs(cy)) / 2
        for s in range(EDGE_SAMPLES):
            over, down = offsets[s, 0], offsets[s, 1]
            more[s] = ax * over + ay * down
            more[EDGE_SAMPLES + s] = bx * over + by * down
            more[2 * EDGE_SAMPLES + s] = cx * over + cy * down
        drawn = False
        for row in range(top, bottom):
            at, end = starts[row - first, low], starts[row - first, high]
            while at < end and places[at] < left:
                at += 1
            y = row + 0.5
            a_row, b_row, c_row = ay * y + ac, by * y + bc, cy * y + cc
            while at < end and places[at] < right:
                x = places[at] + 0.5
                a, b, c = ax * x + a_row, bx * x + b_row, cx * x + c_row
                least = -slack * (a + b + c)
                if (a + a_more >= least) & (b + b_more >= least) & (c + c_more >= least):
                    drawn |= draw_four(flat, 3 * EDGE_SAMPLES * at, more, a, b, c, slack, u, v)
                at += 1
        if drawn:
            seen[f] = 1


@kernel(inline=True)
def is_multisampled(near, column, row, samples, limit):
    """Whether a pixel's four samples and its middle do not lie on one piece of the atlas.

    That is so where the middle is not half way between two opposite samples, or some show something and some nothing.

    Args:
        near, column, row: 1 / depth and texel coordinates over depth of the middle.
        samples: (3, 4) those of the samples.
        limit: Texels, along a side.
    """
    shown = 0
    for s in range(4):
        shown += samples[0, s] > 0
    if near <= 0 or shown < 4:
        return shown + (near > 0) > 0
    x, y = column / near, row / near
    for s in range(2):  # 0 and 3 lie opposite each other, 1 and 2 too
        one, other = samples[0, s], samples[0, 3 - s]
        if is_off_midpoint(samples[1, s] / one, x, samples[1, 3 - s] / other, limit):
            return True
        if is_off_midpoint(samples[2, s] / one, y, samples[2, 3 - s] / other, limit):
            return True
    return False


@kernel()
def keep_multisampled(near, column, row, places, starts, samples, limit, first, last, spans, multisampled, subsamples):
    """List those of the pixels found in rows [first, last) that are multi-sampled.

    Args:
        samples: Of `draw_samples`.
        spans: (H, 2) first and end of each row's pixels in the lists, written; a row has W places of its own.
        multisampled: (H W,) int32 columns of the multi-sampled pixels, row by row, written.
        subsamples: (3, 4 H W) their samples, written.
    """
    for line in range(first, last):
        found = first * multisampled.shape[0] // near.shape[0] if line == first else spans[line - 1, 1]
        spans[line, 0] = found
        for at in range(starts[line - first, 0], starts[line - first, starts.shape[1] - 1]):
            i = places[at]
            if is_multisampled(near[line, i], column[line, i], row[line, i], samples[at], limit):
                multisampled[found] = i
                for s in range(4):
                    for part in range(3):
                        subsamples[part, 4 * found + s] = samples[at, part, s]
                found += 1
        spans[line, 1] = found
