"""What a relief's faces cost in the pictures, texel by texel.

Texels are squares of STEPS x STEPS whole numbers with their centres HALF a texel from their corners. Corners of faces
are whole numbers too, so that on which side of an edge a centre lies is exact, and a centre on an edge belongs to one
of the two faces beside it.
"""

# mypy: disable-error-code="no-untyped-def,no-untyped-call"

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.runtime.jit import kernel

STEPS = 256
HALF = STEPS // 2


class Ground(NamedTuple):
    """What is known of (h, w) texels, and how many faces cover each.

    depth: float32, of the given surface. given: uint8, 1 where that is. curve: float32, squared error of all pictures
    together for a squared step of depth, while it is small. most: float32, the squared error where something else is
    seen. bare: float32, where the sheet is gone: as `most` if there is more of the given surface behind, else of black.
    cover: int16, of the sheet in hand.
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
    y = row * STEPS + HALF
    low = max((min(ax, bx, cx) - HALF + STEPS - 1) // STEPS, 0)
    high = min((max(ax, bx, cx) - HALF) // STEPS, columns - 1)
    for edge in range(3):
        px, py, qx, qy = ax, ay, bx, by
        if edge == 1:
            px, py, qx, qy = bx, by, cx, cy
        elif edge == 2:
            px, py, qx, qy = cx, cy, ax, ay
        dx, dy = qx - px, qy - py
        # inside where dx (y - py) - dy (x - px) > 0; a centre on the edge is inside if that runs up, or to the right
        at = dx * (y - py) + dy * px - dy * HALF
        if dy > 0:
            high = min(high, (at - 1 + tie) // (dy * STEPS))
        elif dy < 0:
            low = max(low, -(at // (-dy * STEPS)))
        elif at < 0 or (at == 0 and dx < 0 and not tie):
            high = low - 1
    return low, high


@kernel()
def face_cost(ground, places, depth, a, b, c, add, holes):
    """What the texels in the face a, b, c cost, of either sense; `add` goes to their cover. holes: less what a texel
    costs that nothing covers, where this changes whether that is so."""
    ax, ay, bx, by, cx, cy = places[a, 0], places[a, 1], places[b, 0], places[b, 1], places[c, 0], places[c, 1]
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if area == 0:
        return 0.0
    if area < 0:
        b, c, bx, by, cx, cy, area = c, b, cx, cy, bx, by, -area
    rows, columns = ground.depth.shape
    top = max((min(ay, by, cy) - HALF + STEPS - 1) // STEPS, 0)
    bottom = min((max(ay, by, cy) - HALF) // STEPS, rows - 1)
    db, dc = depth[b] - depth[a], depth[c] - depth[a]
    slope_x = (db * (cy - ay) - dc * (by - ay)) / area
    slope_y = (dc * (bx - ax) - db * (cx - ax)) / area
    total = 0.0
    for row in range(top, bottom + 1):
        low, high = texels_within(ax, ay, bx, by, cx, cy, row, columns, 0)
        start = depth[a] + slope_x * (HALF - ax) + slope_y * (row * STEPS + HALF - ay)
        for column in range(low, high + 1):
            covered = ground.cover[row, column]
            ground.cover[row, column] = covered + add
            most = float(ground.most[row, column])
            if not ground.given[row, column]:
                total += most
                continue
            off = start + slope_x * STEPS * column - ground.depth[row, column]
            cost = ground.curve[row, column] * off * off
            if cost > 0.0:
                total += cost * most / (cost + most)
            if holes and covered + min(add, 0) == 0:
                total -= ground.bare[row, column]
    return total


@kernel()
def sheet_cost(ground, places, depth, faces):
    """What a whole sheet costs, faces (m, 3) with -1 for those that are gone; fills `cover`."""
    ground.cover[:] = 0
    total = 0.0
    for f in range(faces.shape[0]):
        if faces[f, 0] >= 0:
            total += face_cost(ground, places, depth, faces[f, 0], faces[f, 1], faces[f, 2], 1, False)
    for row in range(ground.depth.shape[0]):
        for column in range(ground.depth.shape[1]):
            if ground.given[row, column] and ground.cover[row, column] == 0:
                total += ground.bare[row, column]
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
        top = max((min(ay, by, cy) - HALF + STEPS - 1) // STEPS, 0)
        for row in range(top, min((max(ay, by, cy) - HALF) // STEPS, rows - 1) + 1):
            low, high = texels_within(ax, ay, bx, by, cx, cy, row, columns, 1)
            for column in range(low, high + 1):
                owners[row, column] = f
