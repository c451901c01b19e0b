"""Kernels of smooth edges: which pixels show several things, and the samples of those (docs/decisions/024)."""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

import numpy as np

from eigenfield.imaging.raster import edge_spans, row_span
from eigenfield.rendering.software.simd import SAMPLES, draw_four
from eigenfield.runtime.jit import kernel

BLOCK = 8  # pixels of a row whose edges are found without a search; bytes of a word
NOWHERE = np.float32(1e6)  # texels
NEARER = 1 + 1e-6  # times an inverse depth: more than its rounding


@kernel(inline=True)
def bent(a, b, c, limit):
    """Whether b is off the middle between a and c: by more than half of `limit`, as where one lies off by `limit`."""
    return abs((a + c) - np.float32(2) * b) > limit


@kernel()
def flatten(near, column, row, columns, rows):
    """columns, rows (W,): texel coordinates; far away from all where there is nothing."""
    for i in range(columns.shape[0]):
        shows = near[i] > 0
        inverse = np.float32(1) / (near[i] if shows else np.float32(1))
        columns[i] = column[i] * inverse if shows else NOWHERE
        rows[i] = row[i] * inverse if shows else NOWHERE


@kernel(inline=True)
def mark_near(near, start, step, first, end, mark):
    """mark (at least W,) is set in columns [first, end) where an inverse depth, start + column step, is not below near
    (at least W,)."""
    for i in range(first, end):
        mark[i] |= start + step * i >= near[i]


@kernel()
def mark_ends(edges, bounds, listing, rims, near, first, last, slack, offsets, marks):
    """marks (at least last - first rows, at least W) out: the pixels of rows [first, last) through which an edge of a
    triangle in `listing` runs as near to the middle as samples lie, if the triangle has a rim, rims (m,) bool: what is
    thinner than a pixel is seen by no neighbour's middle. Not where the triangle lies behind what the middle shows:
    that ends within the pixel too, if the triangle is to be seen. edges, bounds, slack: see `draw_texels`, near: its
    inverse_depth; offsets: `draw_samples`."""
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
        x, y = q[0] * NEARER, q[1] * NEARER  # 1 / depth is linear; the most of it within a pixel, and its rounding
        one = (e[0, 2] + e[1, 2] + e[2, 2]) * NEARER + (x + y + abs(x) + abs(y)) / 2
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
def find_bends(near, column, row, first, last, limit, columns, rows, marks, places, starts, sums):
    """Which pixels of rows [first, last) to look at closer: those in `marks`, those that lie in the atlas not about
    half way between their neighbours, left and right or above and below, and all at the picture's border.

    near, column, row (H, at least W): middles of pixels, see `draw_texels`. columns, rows (at least last - first + 2,
    W): scratch. marks (at least last - first, BLOCK blocks): of `mark_ends`; changed. places out: their columns, row by
    row. starts (last - first, blocks + 1) out: how many there are before a row's column BLOCK b; at the end, to the
    row's end. sums (last - first + 1, blocks + 1) out: how many lie above a row and left of a block.
    """
    height, width, found = near.shape[0], columns.shape[1], 0
    blocks, words = marks.shape[1] // BLOCK, marks.view(np.uint64)  # a word is a block
    for line in range(max(first - 1, 0), min(last + 1, height)):
        at = line - first + 1
        flatten(near[line], column[line], row[line], columns[at], rows[at])
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
                    bent(u[i - 1], u[i], u[i + 1], limit) | bent(v[i - 1], v[i], v[i + 1], limit)
                    | bent(u_up[i], u[i], u_down[i], limit) | bent(v_up[i], v[i], v_down[i], limit)
                )  # fmt: skip
        sums[at + 1, 0] = 0
        for block in range(blocks):
            starts[at, block] = found
            if words[at, block]:
                for i in range(block * BLOCK, block * BLOCK + BLOCK):
                    if mark[i]:
                        places[found] = i
                        found += 1
            sums[at + 1, block + 1] = sums[at, block + 1] + found - starts[at, 0]
        starts[at, blocks] = found


@kernel()
def draw_samples(
    faces, texels, edges, bounds, listing, first, last, slack, offsets, places, starts, sums, samples, seen
):  # fmt: skip
    """As `draw_texels`, the four samples of some pixels: places, starts, sums as `find_bends` makes them, offsets
    (4, 2) right of and below the pixel's middle. samples (at least as many as places, 3, 4) out: 1 / depth and texel
    coordinates over depth."""
    samples[: starts[last - first - 1, starts.shape[1] - 1]] = 0
    flat, more = samples.reshape(-1), np.empty(3 * SAMPLES)
    for f in listing:
        left, right = bounds[f, 2], bounds[f, 3]
        low, high = left // BLOCK, (right - 1) // BLOCK + 1
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
        for s in range(SAMPLES):
            over, down = offsets[s, 0], offsets[s, 1]
            more[s] = ax * over + ay * down
            more[SAMPLES + s] = bx * over + by * down
            more[2 * SAMPLES + s] = cx * over + cy * down
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
                    drawn |= draw_four(flat, 3 * SAMPLES * at, more, a, b, c, slack, u, v)
                at += 1
        if drawn:
            seen[f] = 1


@kernel(inline=True)
def is_parted(near, column, row, samples, limit):
    """Whether a pixel's four samples (3, 4) and its middle do not lie on one piece of the atlas: the middle is not half
    way between two opposite ones, by `limit` texels along a side, or some show something and some nothing."""
    shown = 0
    for s in range(4):
        shown += samples[0, s] > 0
    if near <= 0 or shown < 4:
        return shown + (near > 0) > 0
    x, y = column / near, row / near
    for s in range(2):  # 0 and 3 lie opposite each other, 1 and 2 too
        one, other = samples[0, s], samples[0, 3 - s]
        if bent(samples[1, s] / one, x, samples[1, 3 - s] / other, limit):
            return True
        if bent(samples[2, s] / one, y, samples[2, 3 - s] / other, limit):
            return True
    return False


@kernel()
def keep_parted(near, column, row, places, starts, samples, limit, first, last, spans, parted, finer):
    """Of the pixels of rows [first, last) that were looked at, the parted ones.

    near, column, row, places, starts: see `find_bends`; samples: `draw_samples`; limit: `parted`. parted (n,) int32
    out: their columns, finer (3, 4 n) their samples, row by row; spans (H, 2) out: where a row's begin and end. Rows
    have W numbers of their own.
    """
    for line in range(first, last):
        found = first * parted.shape[0] // near.shape[0] if line == first else spans[line - 1, 1]
        spans[line, 0] = found
        for at in range(starts[line - first, 0], starts[line - first, starts.shape[1] - 1]):
            i = places[at]
            if is_parted(near[line, i], column[line, i], row[line, i], samples[at], limit):
                parted[found] = i
                for s in range(4):
                    for part in range(3):
                        finer[part, 4 * found + s] = samples[at, part, s]
                found += 1
        spans[line, 1] = found
