"""What a relief's faces cost in the pictures, texel by texel.

Texels are squares of TEXEL_STEPS x TEXEL_STEPS whole numbers, their centres half a texel from their corners. Corners of
faces are whole numbers too, so that on which side of an edge a centre lies is exact, and a centre on an edge belongs to
one of the two faces beside it.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.jit import kernel

TEXEL_STEPS = 256
HALF_TEXEL_STEPS = TEXEL_STEPS // 2


class CostMap(NamedTuple):
    """What errors of (h, w) texels cost, as squared errors of all pictures together, and how many faces cover each.

    Attributes:
        depth: float32, of the given surface.
        given: uint8, 1 where that is.
        curve: float32, the error for a squared step of depth, while it is small.
        most: float32, the error where something else is seen.
        bare: float32, the error where no face is left: as `most` if more of the given surface lies behind, else of
            black.
        cover: int16, the number of faces of the present mesh.
    """

    depth: NDArray[np.float32]
    given: NDArray[np.uint8]
    curve: NDArray[np.float32]
    most: NDArray[np.float32]
    bare: NDArray[np.float32]
    cover: NDArray[np.int16]


@kernel()
def texels_within(ax, ay, bx, by, cx, cy, row, columns, tie):
    """First and last column of the texels of a row whose centres are in the triangle a, b, c of positive area. tie: 1
    if all centres on its edges are, 0 if those that are not in the face beside it."""
    y = row * TEXEL_STEPS + HALF_TEXEL_STEPS
    low = max((min(ax, bx, cx) - HALF_TEXEL_STEPS + TEXEL_STEPS - 1) // TEXEL_STEPS, 0)
    high = min((max(ax, bx, cx) - HALF_TEXEL_STEPS) // TEXEL_STEPS, columns - 1)
    for edge in range(3):
        px, py, qx, qy = ax, ay, bx, by
        if edge == 1:
            px, py, qx, qy = bx, by, cx, cy
        elif edge == 2:
            px, py, qx, qy = cx, cy, ax, ay
        dx, dy = qx - px, qy - py
        # inside where dx (y - py) - dy (x - px) > 0; a centre on the edge is inside if that runs up, or to the right
        at = dx * (y - py) + dy * px - dy * HALF_TEXEL_STEPS
        if dy > 0:
            high = min(high, (at - 1 + tie) // (dy * TEXEL_STEPS))
        elif dy < 0:
            low = max(low, -(at // (-dy * TEXEL_STEPS)))
        elif at < 0 or (at == 0 and dx < 0 and not tie):
            high = low - 1
    return low, high


@kernel()
def face_cost(cost_map, places, depth, a, b, c, add, holes):
    """Cost of the texels in the face a, b, c, of either sense; `add` goes to their cover.

    holes: take off the cost of a texel without any face, where this face changes whether it has one.
    """
    ax, ay, bx, by, cx, cy = places[a, 0], places[a, 1], places[b, 0], places[b, 1], places[c, 0], places[c, 1]
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if area == 0:
        return 0.0
    if area < 0:
        b, c, bx, by, cx, cy, area = c, b, cx, cy, bx, by, -area
    rows, columns = cost_map.depth.shape
    top = max((min(ay, by, cy) - HALF_TEXEL_STEPS + TEXEL_STEPS - 1) // TEXEL_STEPS, 0)
    bottom = min((max(ay, by, cy) - HALF_TEXEL_STEPS) // TEXEL_STEPS, rows - 1)
    db, dc = depth[b] - depth[a], depth[c] - depth[a]
    slope_x = (db * (cy - ay) - dc * (by - ay)) / area
    slope_y = (dc * (bx - ax) - db * (cx - ax)) / area
    total = 0.0
    for row in range(top, bottom + 1):
        low, high = texels_within(ax, ay, bx, by, cx, cy, row, columns, 0)
        start = depth[a] + slope_x * (HALF_TEXEL_STEPS - ax) + slope_y * (row * TEXEL_STEPS + HALF_TEXEL_STEPS - ay)
        for column in range(low, high + 1):
            covered = cost_map.cover[row, column]
            cost_map.cover[row, column] = covered + add
            most = float(cost_map.most[row, column])
            if not cost_map.given[row, column]:
                total += most
                continue
            off = start + slope_x * TEXEL_STEPS * column - cost_map.depth[row, column]
            cost = cost_map.curve[row, column] * off * off
            if cost > 0.0:
                total += cost * most / (cost + most)
            if holes and covered + min(add, 0) == 0:
                total -= cost_map.bare[row, column]
    return total


@kernel()
def mesh_cost(cost_map, places, depth, faces):
    """Cost of a whole mesh, faces (m, 3) with -1 for those that are gone; fills `cover`."""
    cost_map.cover[:] = 0
    total = 0.0
    for f in range(faces.shape[0]):
        if faces[f, 0] >= 0:
            total += face_cost(cost_map, places, depth, faces[f, 0], faces[f, 1], faces[f, 2], 1, False)
    for row in range(cost_map.depth.shape[0]):
        for column in range(cost_map.depth.shape[1]):
            if cost_map.given[row, column] and cost_map.cover[row, column] == 0:
                total += cost_map.bare[row, column]
    return total


@kernel()
def draw_owners(places, faces, owners):
    """owners (h, w) int32: the face that covers each texel, the last where several do, -1 where none does. Centres on a
    border count."""
    owners[:] = -1
    rows, columns = owners.shape
    for f in range(faces.shape[0]):
        a, b, c = faces[f, 0], faces[f, 1], faces[f, 2]
        ax, ay, bx, by, cx, cy = places[a, 0], places[a, 1], places[b, 0], places[b, 1], places[c, 0], places[c, 1]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if area == 0:
            continue
        if area < 0:
            bx, by, cx, cy = cx, cy, bx, by
        top = max((min(ay, by, cy) - HALF_TEXEL_STEPS + TEXEL_STEPS - 1) // TEXEL_STEPS, 0)
        for row in range(top, min((max(ay, by, cy) - HALF_TEXEL_STEPS) // TEXEL_STEPS, rows - 1) + 1):
            low, high = texels_within(ax, ay, bx, by, cx, cy, row, columns, 1)
            for column in range(low, high + 1):
                owners[row, column] = f
