"""Charts that keep their shape and direction, packed into a square: first fit on a raster, largest first."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from eigenfield.core.mesh import signed_areas
from eigenfield.proxy.relief.kernels import first_fit, label_pixels
from eigenfield.proxy.relief.sheet import Sheet, sheet_components, used_part
from eigenfield.proxy.relief.triangulation import LATTICE

FULL = 0.6  # part of its box that a piece should fill
SMALLEST = 24.0  # pixels, longer side of a box that is not divided further
ROOMS = (0.05, 0.1, 0.2, 0.4)  # of the first part's longer side: widths of the strips beside it that are tried
WORTH = 0.9  # of the box's area: what the boxes of a division may have
TRIALS = 9  # places at which a division is tried
CELLS = 320  # about this many cells make a side of the raster
GROWTH = 1.01  # from one side that is too small to the next


def packed_layers(
    first: Sheet, others: Sequence[Sheet], gutter: float
) -> tuple[list[Sheet], list[NDArray[np.float64]], float]:
    """The first layer whole and the others in pieces, by how much each moves, and the side of the square that holds
    all.

    Pieces too wide for the strips that a square leaves beside the first layer would waste most of it: several widths
    are tried, and the smallest square is taken.
    """
    if not others:
        return [first], *pack([first], gutter)
    longer = max(np.ptp(first.x), np.ptp(first.y))
    trials = []
    for room in ROOMS:
        pieces = [piece for sheet in others for piece in pieces_of(sheet, max(SMALLEST, room * longer))]
        parts = [first, *sorted(pieces, key=lambda piece: -sheet_area(piece))]
        trials.append((parts, *pack(parts, gutter)))
    return min(trials, key=lambda trial: trial[2])


def pieces_of(sheet: Sheet, room: float) -> list[Sheet]:
    """A sheet divided into pieces that hang together, fill their boxes and fit into a strip `room` wide; largest
    first."""
    pieces: list[NDArray[np.int64]] = []
    corners = np.stack([sheet.x, sheet.y], axis=1)[sheet.faces]
    component = sheet_components(sheet.faces, len(sheet.x))
    waiting = [np.flatnonzero(component == c) for c in range(component.max(initial=-1) + 1)]
    while waiting:
        faces = waiting.pop()
        part = _divided(corners[faces], room)
        if part is None:
            pieces.append(faces)
            continue
        for half in (faces[part], faces[~part]):
            label = sheet_components(sheet.faces[half], len(sheet.x))
            waiting += [half[label == c] for c in range(label.max() + 1)]
    area = [_area(corners[faces]) for faces in pieces]
    order = sorted(range(len(pieces)), key=lambda i: (-area[i], int(pieces[i][0])))
    return [used_part(sheet, np.sort(pieces[i])) for i in order]


def sheet_area(sheet: Sheet) -> float:
    """In squared pixels."""
    return _area(np.stack([sheet.x, sheet.y], axis=1)[sheet.faces])


def _area(corners: NDArray[np.float64]) -> float:
    return float(np.abs(signed_areas(corners)).sum())


def _box(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(corners.max(axis=(0, 1)) - corners.min(axis=(0, 1)))


def _divided(corners: NDArray[np.float64], room: float) -> NDArray[np.bool_] | None:
    """The triangles on one side of a line along x or y that makes the boxes of both sides small; None to leave them."""
    size = _box(corners)
    middle = corners.mean(axis=1)
    wide = size.min() > room
    if not wide and (size.max() < SMALLEST or _area(corners) > FULL * size.prod()):
        return None
    best, found = (np.inf if wide else WORTH) * float(size.prod()), None
    for axis in (0, 1):
        for at in np.quantile(middle[:, axis], np.arange(1, TRIALS + 1) / (TRIALS + 1)):
            low = middle[:, axis] < at
            if low.any() and not low.all():
                cost = float(_box(corners[low]).prod() + _box(corners[~low]).prod())
                if cost < best:
                    best, found = cost, low
    return found


def pack(parts: Sequence[Sheet], gutter: float) -> tuple[list[NDArray[np.float64]], float]:
    """((2,) by how much each part moves, side of the square) such that parts are `gutter` pixels apart, and half as far
    from the border. Parts are taken in the order in which they come."""
    reach = int(np.ceil(gutter / 2)) + 1
    masks, corners = zip(*(_mask(part, reach) for part in parts), strict=True)
    filled = sum(int(mask.sum()) for mask in masks)
    cell = max(1, round(np.sqrt(filled) / CELLS))
    coarse = [_pooled(mask, cell) for mask in masks]
    side = max(int(np.sqrt(sum(int(mask.sum()) for mask in coarse))), *(max(mask.shape) for mask in coarse), 1)
    while True:
        taken = np.zeros((side, side), np.bool_)
        places = np.zeros((len(coarse), 2), np.int64)
        if all(first_fit(taken, mask, place) for mask, place in zip(coarse, places, strict=True)):
            break
        side = int(np.ceil(side * GROWTH))
    offsets = [place[::-1] * cell - corner for place, corner in zip(places, corners, strict=True)]
    return [np.asarray(offset, np.float64) for offset in offsets], float(side * cell)


def _mask(part: Sheet, reach: int) -> tuple[NDArray[np.bool_], NDArray[np.float64]]:
    """The pixels within about `reach` of a part, and where the raster's top left pixel begins."""
    low = np.floor([part.x.min(), part.y.min()]) - reach - 1
    high = np.ceil([part.x.max(), part.y.max()]) + reach + 1
    width, height = (high - low).astype(int) + 1
    xy = np.stack([part.x, part.y], axis=1) - low
    owner = np.empty((height, width), np.int32)
    label_pixels(np.rint(xy * LATTICE).astype(np.int64), part.faces.astype(np.int64), len(part.faces), owner)
    mask = owner >= 0
    column, row = np.rint(xy).astype(int).T
    mask[row, column] = True
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    return binary_dilation(mask, x * x + y * y <= reach * reach), low - 0.5


def _pooled(mask: NDArray[np.bool_], cell: int) -> NDArray[np.bool_]:
    h, w = -(-mask.shape[0] // cell), -(-mask.shape[1] // cell)
    whole = np.zeros((h * cell, w * cell), np.bool_)
    whole[: mask.shape[0], : mask.shape[1]] = mask
    return np.asarray(whole.reshape(h, cell, w, cell).any(axis=(1, 3)))
