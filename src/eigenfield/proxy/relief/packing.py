"""Packing of charts that keep their shape and direction into a square: first fit on a raster, largest first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation

from eigenfield.core.mesh import signed_areas
from eigenfield.proxy.relief.height_field import HeightFieldMesh, extract_faces
from eigenfield.proxy.relief.kernels import label_pixels, place_first_fit
from eigenfield.proxy.relief.triangulation import DELAUNAY_STEPS_PER_PIXEL
from eigenfield.proxy.topology import face_components

PACK_MIN_BOX_FILL = 0.6  # fraction of its box that a piece should fill
PACK_MIN_BOX_PIXELS = 24.0  # longer side of a box that is not divided further
PACK_STRIP_WIDTHS = (0.05, 0.1, 0.2, 0.4)  # of the strips beside the first layer, in units of its longer side
PACK_SHEET_WIDTHS = (0.4, 1.0)  # of the pieces of sheets, in units of the longest sheet
PACK_GUTTER_PIXELS = 4.0  # of the reference view, between charts: six texels at density 1.5
PACK_MAX_DIVISION_AREA_RATIO = 0.9  # area of the boxes of a division relative to the whole box, at most
PACK_DIVISION_TRIALS = 9  # places along each axis
PACK_RASTER_CELLS = 320  # along a side, approximately
PACK_SHEET_RASTER_CELLS = 160  # the same for sheets, whose charts are large
PACK_SIDE_GROWTH = 1.01  # from a side that is too small to the next


def pack_layers(
    first: HeightFieldMesh, others: Sequence[HeightFieldMesh]
) -> tuple[list[HeightFieldMesh], list[NDArray[np.float64]], float]:
    """The first layer whole and the others in pieces, packed into a square.

    Pieces too wide for the strips that a square leaves beside the first layer would waste most of it. Several widths
    are tried, and the smallest square is taken.

    Returns:
        The parts, (2,) by how much each moves, and the side of the square.
    """
    if not others:
        return [first], *_pack_charts([first])
    longer = max(np.ptp(first.x), np.ptp(first.y))
    trials = []
    for width in PACK_STRIP_WIDTHS:
        room = max(PACK_MIN_BOX_PIXELS, width * longer)
        pieces = [piece for mesh in others for piece in _divide_into_pieces(mesh, room)]
        parts = [first, *sorted(pieces, key=lambda piece: -_area(_corners(piece)))]
        trials.append((parts, *_pack_charts(parts)))
    return min(trials, key=lambda trial: trial[2])


def pack_sheets(
    meshes: Sequence[HeightFieldMesh],
) -> tuple[list[HeightFieldMesh], list[int], list[NDArray[np.float64]], float]:
    """Several layers, each in pieces, packed into a square.

    Returns:
        The parts, the layer of each, (2,) by how much each moves, and the side of the square.
    """
    longer = max(float(max(np.ptp(mesh.x), np.ptp(mesh.y))) for mesh in meshes)
    trials = []
    for width in PACK_SHEET_WIDTHS:
        room = max(PACK_MIN_BOX_PIXELS, width * longer)
        pieces = [(piece, k) for k, mesh in enumerate(meshes) for piece in _divide_into_pieces(mesh, room)]
        pieces.sort(key=lambda piece: -_area(_corners(piece[0])))
        parts, owners = [part for part, _ in pieces], [owner for _, owner in pieces]
        trials.append((parts, owners, *_pack_charts(parts, PACK_SHEET_RASTER_CELLS)))
    return min(trials, key=lambda trial: trial[3])


@dataclass(frozen=True, eq=False)
class ChartPixels:
    """The pixels of the reference view that a packed part keeps for itself, half its gutter included.

    Attributes:
        mask: (h, w) those pixels.
        owner: (h, w) the triangle on each, -1 beside them.
        first: (2,) column and row of the top left pixel in the reference view.
    """

    mask: NDArray[np.bool_]
    owner: NDArray[np.int32]
    first: NDArray[np.int64]


def chart_pixels(part: HeightFieldMesh) -> ChartPixels:
    """The pixels of a part.

    Args:
        part: As it was packed.
    """
    reach = int(np.ceil(PACK_GUTTER_PIXELS / 2)) + 1  # half the gutter to the border
    low = np.floor([part.x.min(), part.y.min()]) - reach - 1
    high = np.ceil([part.x.max(), part.y.max()]) + reach + 1
    width, height = (high - low).astype(int) + 1
    xy = np.stack([part.x, part.y], axis=1) - low
    owner = np.empty((height, width), np.int32)
    steps = np.rint(xy * DELAUNAY_STEPS_PER_PIXEL).astype(np.int64)
    label_pixels(steps, part.faces.astype(np.int64), len(part.faces), owner)
    mask = owner >= 0
    column, row = np.rint(xy).astype(int).T
    mask[row, column] = True
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    return ChartPixels(binary_dilation(mask, x * x + y * y <= reach * reach), owner, low.astype(np.int64))


def _divide_into_pieces(mesh: HeightFieldMesh, room: float) -> list[HeightFieldMesh]:
    """A mesh divided into connected pieces that fill their boxes and fit into a strip of that width, largest first."""
    pieces: list[NDArray[np.int64]] = []
    corners = _corners(mesh)
    component = face_components(mesh.faces, len(mesh.x))
    waiting = [np.flatnonzero(component == c) for c in range(component.max(initial=-1) + 1)]
    while waiting:
        faces = waiting.pop()
        part = _find_division(corners[faces], room)
        if part is None:
            pieces.append(faces)
            continue
        for half in (faces[part], faces[~part]):
            label = face_components(mesh.faces[half], len(mesh.x))
            waiting += [half[label == c] for c in range(label.max() + 1)]
    area = [_area(corners[faces]) for faces in pieces]
    order = sorted(range(len(pieces)), key=lambda i: (-area[i], int(pieces[i][0])))
    return [extract_faces(mesh, np.sort(pieces[i])) for i in order]


def _corners(mesh: HeightFieldMesh) -> NDArray[np.float64]:
    """(m, 3, 2) pixels."""
    return np.stack([mesh.x, mesh.y], axis=1)[mesh.faces]


def _area(corners: NDArray[np.float64]) -> float:
    return float(np.abs(signed_areas(corners)).sum())


def _box(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(corners.max(axis=(0, 1)) - corners.min(axis=(0, 1)))


def _find_division(corners: NDArray[np.float64], room: float) -> NDArray[np.bool_] | None:
    """The triangles on one side of a line along x or y that makes both boxes small; None if none is worth it."""
    size = _box(corners)
    middle = corners.mean(axis=1)
    wide = size.min() > room
    if not wide and (size.max() < PACK_MIN_BOX_PIXELS or _area(corners) > PACK_MIN_BOX_FILL * size.prod()):
        return None
    best, found = (np.inf if wide else PACK_MAX_DIVISION_AREA_RATIO) * float(size.prod()), None
    for axis in (0, 1):
        for at in np.quantile(middle[:, axis], np.arange(1, PACK_DIVISION_TRIALS + 1) / (PACK_DIVISION_TRIALS + 1)):
            low = middle[:, axis] < at
            if low.any() and not low.all():
                cost = float(_box(corners[low]).prod() + _box(corners[~low]).prod())
                if cost < best:
                    best, found = cost, low
    return found


def _pack_charts(
    parts: Sequence[HeightFieldMesh], cells: int = PACK_RASTER_CELLS
) -> tuple[list[NDArray[np.float64]], float]:
    """(2,) by how much each part moves to lie in a square, packed in the given order, and the side of the square.

    cells: along a side of the raster, approximately.
    """
    charts = [chart_pixels(part) for part in parts]
    masks, corners = [chart.mask for chart in charts], [chart.first - 0.5 for chart in charts]
    filled = sum(int(mask.sum()) for mask in masks)
    cell = max(1, round(np.sqrt(filled) / cells))
    coarse = [_max_pool(mask, cell) for mask in masks]
    side = max(int(np.sqrt(sum(int(mask.sum()) for mask in coarse))), *(max(mask.shape) for mask in coarse), 1)
    while True:
        taken = np.zeros((side, side), np.bool_)
        places = np.zeros((len(coarse), 2), np.int64)
        if all(place_first_fit(taken, mask, place) for mask, place in zip(coarse, places, strict=True)):
            break
        side = int(np.ceil(side * PACK_SIDE_GROWTH))
    offsets = [place[::-1] * cell - corner for place, corner in zip(places, corners, strict=True)]
    return [np.asarray(offset, np.float64) for offset in offsets], float(side * cell)


def _max_pool(mask: NDArray[np.bool_], cell: int) -> NDArray[np.bool_]:
    h, w = -(-mask.shape[0] // cell), -(-mask.shape[1] // cell)
    whole = np.zeros((h * cell, w * cell), np.bool_)
    whole[: mask.shape[0], : mask.shape[1]] = mask
    return np.asarray(whole.reshape(h, cell, w, cell).any(axis=(1, 3)))
