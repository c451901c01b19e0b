"""Where a depth map is cut: chains of points between pixels, straightened.

A side between two neighbouring pixels is cut where one of them is valid and the other is not, or where their depths
differ by more than a threshold. The chain runs through the middles of cut sides, from the centre of one 2 x 2 cell to
the next; cells with other than two cut sides are its ends and junctions. The middles lie within half a pixel of the
true edge and on both sides of it evenly, so that a line fitted to many of them is known to a fraction of a pixel.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from eigenfield.proxy.relief.kernels import split_chain

ANCHOR = 1e-3  # weight of where the knots were in the fit of a chain: decides where the fit leaves them free
FIT_LIMIT = 0.75  # pixels by which the fit may move a knot
WINDOW = 10  # points of the chain by which a corner may be found late


def cut_sides(
    d: NDArray[np.float32], valid: NDArray[np.bool_], cut: float
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """(h, w - 1) sides between horizontal neighbours that are cut, and (h - 1, w) between vertical ones."""
    beside = (valid[:, 1:] != valid[:, :-1]) | (
        valid[:, 1:] & valid[:, :-1] & (np.abs(d[:, 1:] - d[:, :-1]) > np.float32(cut))
    )
    below = (valid[1:] != valid[:-1]) | (valid[1:] & valid[:-1] & (np.abs(d[1:] - d[:-1]) > np.float32(cut)))
    return beside, below


def contour_chains(beside: NDArray[np.bool_], below: NDArray[np.bool_]) -> list[NDArray[np.float64]]:
    """Chains of (x, y) index coordinates, each (n, 2); closed ones end where they begin. In a fixed order."""
    h, w = below.shape[0] + 1, beside.shape[1] + 1
    links = _links(beside, below)
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

    for node in [*starts, *sorted(neighbours)]:  # what is left after the starts are closed loops
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


def _links(beside: NDArray[np.bool_], below: NDArray[np.bool_]) -> NDArray[np.int64]:
    """(n, 2) nodes that hang together: sides between columns first, then sides between rows, then cells."""
    h, w = below.shape[0] + 1, beside.shape[1] + 1
    first_below, first_cell = h * (w - 1), h * (w - 1) + (h - 1) * w
    row, column = np.mgrid[: h - 1, : w - 1]
    cell = first_cell + row * (w - 1) + column
    ids = np.stack(
        [
            row * (w - 1) + column,
            (row + 1) * (w - 1) + column,
            first_below + row * w + column,
            first_below + row * w + column + 1,
        ],
        axis=-1,
    )
    on = np.stack([beside[:-1], beside[1:], below[:, :-1], below[:, 1:]], axis=-1)
    count = on.sum(axis=-1)
    through = ids[count == 2][on[count == 2]].reshape(-1, 2)
    ends = (count > 0) & (count != 2)
    single = np.stack([np.broadcast_to(cell[..., None], on.shape)[ends][on[ends]], ids[ends][on[ends]]], axis=-1)
    return np.concatenate([through, single]).astype(np.int64)


def straightened(chain: NDArray[np.float64], tolerance: float) -> NDArray[np.float64]:
    """A polyline with a line for each run of the chain that is straight within `tolerance` pixels, its joints moved to
    where it fits all points best. The ends stay."""
    if len(chain) < 4:
        return chain
    kept = np.zeros(len(chain), np.bool_)
    split_chain(chain, tolerance, WINDOW, kept)
    knots = np.flatnonzero(kept)
    return _fitted(chain, knots)


def _fitted(chain: NDArray[np.float64], knots: NDArray[np.int64]) -> NDArray[np.float64]:
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
    diagonal = np.bincount(part, (1 - t) ** 2, n) + np.bincount(part + 1, t**2, n) + ANCHOR
    beside = np.bincount(part, t * (1 - t), n)[:-1]
    right = (
        np.stack([np.bincount(part, (1 - t) * c, n) + np.bincount(part + 1, t * c, n) for c in chain.T], axis=1)
        + ANCHOR * chain[knots]
    )
    right[1] -= beside[0] * found[0]
    right[-2] -= beside[-1] * found[-1]
    bands = np.zeros((2, inner))
    bands[1], bands[0, 1:] = diagonal[1:-1], beside[1:-1]
    solved = solveh_banded(bands, right[1:-1]) if inner > 1 else right[1:-1] / bands[1]  # LAPACK wants two rows
    moved = solved - found[1:-1]
    far = np.linalg.norm(moved, axis=1, keepdims=True)
    found[1:-1] += moved * np.minimum(1, FIT_LIMIT / np.maximum(far, 1e-12))
    return found
