"""Where a depth map is cut: chains of points between pixels, straightened.

The edge between two neighbouring pixels is cut if only one of them is valid, or if their depths differ by more than a
threshold. The chain runs through the middles of cut edges, from the centre of one 2 x 2 cell to the next. Cells with
other than two cut edges are its ends and junctions. The middles lie within half a pixel of the true contour, evenly on
both sides, so that a line fitted to many of them is accurate to a fraction of a pixel.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from eigenfield.proxy.relief.kernels import split_chain

CONTOUR_ANCHOR_WEIGHT = 1e-3  # of a knot's old position: decides where the fit leaves it free
CONTOUR_MAX_KNOT_SHIFT_PIXELS = 0.75  # by the fit
CONTOUR_CORNER_WINDOW_POINTS = 10  # of the chain, by which a corner may be detected late


def find_cut_edges(
    d: NDArray[np.float32], valid: NDArray[np.bool_], cut: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Which edges between neighbouring pixels are cut.

    Args:
        cut: Difference of labels at which an edge is cut.

    Returns:
        (h, w - 1) between horizontal neighbours, and (h - 1, w) between vertical ones.
    """

    def between_rows(d: NDArray[np.float32], valid: NDArray[np.bool_]) -> NDArray[np.bool_]:
        steps = np.abs(d[1:] - d[:-1]) > np.float32(cut)
        return (valid[1:] != valid[:-1]) | (valid[1:] & valid[:-1] & steps)

    return between_rows(d.T, valid.T).T, between_rows(d, valid)


def trace_contours(beside: NDArray[np.bool_], below: NDArray[np.bool_]) -> list[NDArray[np.float64]]:
    """Chains of (x, y) index coordinates, each (n, 2), in a fixed order; closed ones end where they begin.

    Args:
        beside: (h, w - 1) cut edges between horizontal neighbours.
        below: (h - 1, w) cut edges between vertical neighbours.
    """
    h, w = below.shape[0] + 1, beside.shape[1] + 1
    links = _node_links(beside, below)
    neighbours: dict[int, list[int]] = {}
    for a, b in links.tolist():
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    first_below, first_cell = h * (w - 1), h * (w - 1) + (h - 1) * w
    starts = [n for n in sorted(neighbours) if len(neighbours[n]) != 2]
    used: set[tuple[int, int]] = set()
    chains: list[list[int]] = []

    def follow(start: int, step: int) -> None:
        chain = [start, step]
        used.update(((start, step), (step, start)))
        while len(neighbours[chain[-1]]) == 2 and chain[-1] != start:
            here, (one, other) = chain[-1], neighbours[chain[-1]]
            chain.append(other if one == chain[-2] else one)
            used.update(((here, chain[-1]), (chain[-1], here)))
        chains.append(chain)

    for node in [*starts, *sorted(neighbours)]:  # the rest after the starts are closed loops
        for step in neighbours[node]:
            if (node, step) not in used:
                follow(node, step)

    def place(nodes: NDArray[np.int64]) -> NDArray[np.float64]:
        y0, x0 = np.divmod(nodes, w - 1)
        y1, x1 = np.divmod(nodes - first_below, w)
        y2, x2 = np.divmod(nodes - first_cell, w - 1)
        x = np.where(nodes < first_below, x0 + 0.5, np.where(nodes < first_cell, x1, x2 + 0.5))
        y = np.where(nodes < first_below, y0, np.where(nodes < first_cell, y1 + 0.5, y2 + 0.5))
        return np.stack([x, y], axis=1)

    return [place(np.array(chain, np.int64)) for chain in chains]


def _node_links(beside: NDArray[np.bool_], below: NDArray[np.bool_]) -> NDArray[np.int64]:
    """(n, 2) connected nodes: edges between columns first, then edges between rows, then cells."""
    h, w = below.shape[0] + 1, beside.shape[1] + 1
    first_below, first_cell = h * (w - 1), h * (w - 1) + (h - 1) * w
    row, column = np.mgrid[: h - 1, : w - 1]
    cell = first_cell + row * (w - 1) + column
    upper, left = row * (w - 1) + column, first_below + row * w + column
    ids = np.stack([upper, upper + w - 1, left, left + 1], axis=-1)
    on = np.stack([beside[:-1], beside[1:], below[:, :-1], below[:, 1:]], axis=-1)
    count = on.sum(axis=-1)
    through = ids[count == 2][on[count == 2]].reshape(-1, 2)
    ends = (count > 0) & (count != 2)
    single = np.stack([np.broadcast_to(cell[..., None], on.shape)[ends][on[ends]], ids[ends][on[ends]]], axis=-1)
    return np.concatenate([through, single]).astype(np.int64)


def straighten_chain(chain: NDArray[np.float64], tolerance: float) -> NDArray[np.float64]:
    """A polyline with one line for each straight run of the chain, fitted to all points; the ends stay.

    Args:
        tolerance: Pixels within which a run is straight.
    """
    if len(chain) < 4:
        return chain
    kept = np.zeros(len(chain), np.bool_)
    split_chain(chain, tolerance, CONTOUR_CORNER_WINDOW_POINTS, kept)
    return _fit_knots(chain, np.flatnonzero(kept))


def _fit_knots(chain: NDArray[np.float64], knots: NDArray[np.int64]) -> NDArray[np.float64]:
    """Least squares of a piecewise linear curve with given knots: hat functions of the length along the chain."""
    found = chain[knots]
    inner = len(knots) - 2
    if inner < 1:
        return found
    along = np.r_[0, np.cumsum(np.linalg.norm(np.diff(chain, axis=0), axis=1))]
    part = np.clip(np.searchsorted(knots, np.arange(len(chain)), side="right") - 1, 0, len(knots) - 2)
    start, stop = along[knots[part]], along[knots[part + 1]]
    t = (along - start) / (stop - start)
    n = len(knots)
    diagonal = np.bincount(part, (1 - t) ** 2, n) + np.bincount(part + 1, t**2, n) + CONTOUR_ANCHOR_WEIGHT
    beside = np.bincount(part, t * (1 - t), n)[:-1]
    sums = [np.bincount(part, (1 - t) * c, n) + np.bincount(part + 1, t * c, n) for c in chain.T]
    right = np.stack(sums, axis=1) + CONTOUR_ANCHOR_WEIGHT * chain[knots]
    right[1] -= beside[0] * found[0]
    right[-2] -= beside[-1] * found[-1]
    bands = np.zeros((2, inner))
    bands[1], bands[0, 1:] = diagonal[1:-1], beside[1:-1]
    solved = solveh_banded(bands, right[1:-1]) if inner > 1 else right[1:-1] / bands[1]  # LAPACK wants two rows
    moved = solved - found[1:-1]
    far = np.linalg.norm(moved, axis=1, keepdims=True)
    found[1:-1] += moved * np.minimum(1, CONTOUR_MAX_KNOT_SHIFT_PIXELS / np.maximum(far, 1e-12))
    return found
