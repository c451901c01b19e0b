"""The second layer of a relief: what the array sees behind the near side of each cut.

Where the first layer is cut, a view from the side sees past the near edge. How far follows from the array itself: a
jump J in d uncovers |m| J pixels, m being how many pixels a point moves in that view for one unit of d. There depth is
found as for the first layer, from the views that the first layer does not block; where none looks, the surface behind
goes on as a thin plate that hangs on the far side of the cut.
"""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, minimum_filter, uniform_filter
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import splu

from eigenfield.core.progress import Progress
from eigenfield.proxy.relief.layers_kernels import mark_revealed
from eigenfield.stereo.semiglobal import semi_global_matching
from eigenfield.stereo.sweep import plane_sweep
from eigenfield.stereo.views import Pictures, label_parallax, pack_pictures
from eigenfield.stereo.visibility import depth_buffers

log = logging.getLogger("eigenfield.proxy")

STAGE = "second layer"  # steps: what is uncovered; sweep and optimisation, which count twice; plate
MOST_VIEWS = 100  # for the sweep; more say little new
STEP = 0.8  # pixels that a label moves a point in the view with most parallax
MOST_LABELS = 128
SLACK = 0.3  # of a cut: how much nearer than the far side of a cut the layer behind may come ..
BENEATH = 0.3  # .. and how far it stays behind the first layer
BIAS = 0.3  # of a cut: bias of the depth test
FEWEST = 3  # views that must see past the first layer
MOST = 30.0  # grey levels, as in `plane_sweep`
UNSEEN = 21.0
SMOOTH = 5  # pixels, side of the window over which costs are averaged
STEEP = 60.0  # grey levels a label unit: how strongly the far side holds its depth in the optimisation
SMALL_STEP, LARGE_STEP = 1.5, 25.0  # penalties of `semi_global_matching`
RING = 12  # pixels of the far side on which the layer hangs
UNDER = 4  # pixels by which it reaches under the far side, so that no gap opens between them
SURE = 2.0  # confidence of `semi_global_matching` at which a depth has half its say
AGREED = 12.0  # grey levels above which photographs do not agree
PLATE, MEMBRANE, ANCHOR = (
    100.0,
    0.02,
    100.0,
)  # weights of curvature, of slope and of the far side, over those of a depth


def second_layer(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    valid: NDArray[np.bool_] | None = None,
    *,
    cut: float,
    progress: Progress | None = None,
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """(d2 (h, w) float32, valid2 (h, w) bool): the layer behind d (h, w), and where there is one.

    pictures, matrices: the array's views, as for `stereo.sweep`. valid: (h, w) where d counts. cut: jump of d at which
    the first layer is cut. Where valid2, d2 is below d; it reaches a few pixels under the far side of each cut.
    """
    d = np.ascontiguousarray(d, np.float32)
    valid = np.ones(d.shape, np.bool_) if valid is None else valid
    report = progress or (lambda stage, done, total: None)
    report(STAGE, 0, 4)
    moves = label_parallax(matrices, d.shape, float(np.median(d[valid])) if valid.any() else 0.0)
    want, ceiling = _revealed(d, valid, cut, moves)
    if not want.any():
        report(STAGE, 4, 4)
        return d.copy(), want
    report(STAGE, 1, 4)
    far = _far_side(d, valid, want, ceiling, cut)
    floor = _floor(d, far, want, moves) - np.float32(SLACK * cut)
    guess, trust = _swept(pictures, matrices, d, valid, want, floor, ceiling, cut, moves)
    report(STAGE, 3, 4)
    inside = want | far
    plate = _plate(np.where(want, guess, d), np.where(want, trust, ANCHOR), inside)
    report(STAGE, 4, 4)
    below = np.where(want, d - np.float32(BENEATH * cut), d - np.float32(0.1 * BENEATH * cut))
    result = np.where(want, np.minimum(np.maximum(plate, floor), np.minimum(ceiling, below)), below)
    return result.astype(np.float32), want | (far & binary_dilation(want, iterations=UNDER))


def _revealed(
    d: NDArray[np.float32], valid: NDArray[np.bool_], cut: float, moves: NDArray[np.float64]
) -> tuple[NDArray[np.bool_], NDArray[np.float32]]:
    """Pixels of the near sides that some view uncovers, and the largest d that the surface behind may have there."""
    want, ceiling = np.zeros(d.shape, np.bool_), np.full(d.shape, np.inf, np.float32)
    reach = np.maximum(np.r_[moves.max(axis=0), -moves.min(axis=0)], 0.0)
    mark_revealed(d, valid, np.float32(cut), reach, np.float32(SLACK * cut), want, ceiling)
    return want, ceiling


def _far_side(
    d: NDArray[np.float32], valid: NDArray[np.bool_], want: NDArray[np.bool_], ceiling: NDArray[np.float32], cut: float
) -> NDArray[np.bool_]:
    """Pixels beside the wanted ones that are no nearer than the surface behind may be."""
    ring = binary_dilation(want, iterations=RING) & ~want & valid
    allowed = minimum_filter(np.where(want, ceiling, np.inf), 2 * RING + 1)
    return np.asarray(ring & (d <= allowed + np.float32(SLACK * cut)))


def _floor(
    d: NDArray[np.float32], far: NDArray[np.bool_], want: NDArray[np.bool_], moves: NDArray[np.float64]
) -> NDArray[np.float32]:
    """The least d on the far side anywhere near: the layer behind would dive without it."""
    jump = float(d[want].max() - d[far].min()) if far.any() else 0.0
    near = 2 * int(np.ceil(np.abs(moves).max(initial=0.0) * jump)) + 2 * RING + 1
    least = minimum_filter(np.where(far, d, np.inf), min(near, 2 * max(d.shape) + 1))
    return np.where(np.isfinite(least), least, d[want].min()).astype(np.float32)


def _swept(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    valid: NDArray[np.bool_],
    want: NDArray[np.bool_],
    floor: NDArray[np.float32],
    ceiling: NDArray[np.float32],
    cut: float,
    moves: NDArray[np.float64],
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Depth of the wanted pixels from the views that see past the first layer, and how far it is to be trusted
    (0..1)."""
    chosen = np.arange(0, len(matrices), -(-len(matrices) // MOST_VIEWS))
    packed, matrices = pack_pictures(pictures[chosen]), matrices[chosen]
    low, high = float(floor[want].min()), float(ceiling[want].max())
    step = max(STEP / max(float(np.abs(moves).max()), 1e-9), (high - low) / (MOST_LABELS - 4))
    labels = (low - step + step * np.arange(int(np.ceil((high - low) / step)) + 3)).astype(np.float32)
    buffers = depth_buffers(matrices, d, packed.shape[1:], valid)
    cost = plane_sweep(
        packed, matrices, d.shape, labels, mask=want, floor=floor, ceiling=ceiling, buffers=buffers, bias=BIAS * cut,
        max_difference=MOST, min_views=FEWEST, unseen_cost=UNSEEN,
    )  # fmt: skip
    window = np.maximum(uniform_filter(want.astype(np.float32), SMOOTH), np.float32(1 / SMOOTH**2))
    best = np.full(d.shape, np.inf, np.float32)
    for index, label in enumerate(labels):
        tried = want & (cost[..., index] < 255)
        level = np.where(tried, cost[..., index] / np.float32(8), np.float32(MOST)) * want
        level = uniform_filter(level, SMOOTH) / window
        best = np.where(tried, np.minimum(best, level), best)
        anchored = np.minimum(np.float32(MOST), np.abs(label - d) * np.float32(STEEP))
        layer = np.where(want, np.where(tried, level, np.float32(MOST)), anchored)
        cost[..., index] = np.rint(np.clip(layer * 8, 0, 240)).astype(np.uint8)
    guess, confidence = semi_global_matching(cost, np.zeros(d.shape, np.float32), labels, SMALL_STEP, LARGE_STEP)
    trust = np.where(best < AGREED, confidence / (confidence + np.float32(SURE)), 0)
    return np.minimum(guess, np.where(want, ceiling, np.inf)).astype(np.float32), trust.astype(np.float32)


def _plate(guess: NDArray[np.float32], weight: NDArray[np.float32], inside: NDArray[np.bool_]) -> NDArray[np.float64]:
    """z over `inside` that makes sum weight (z - guess)^2 + PLATE |second differences|^2 + MEMBRANE |differences|^2
    least."""
    index = np.full(inside.shape, -1, np.int64)
    index[inside] = np.arange(inside.sum())
    n = int(inside.sum())
    normal = diags_array(weight[inside].astype(np.float64) + 1e-6)
    for stencil, factor in (
        (((0, -1, 1.0), (0, 0, -2.0), (0, 1, 1.0)), PLATE),
        (((-1, 0, 1.0), (0, 0, -2.0), (1, 0, 1.0)), PLATE),
        (((0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)), 2 * PLATE),
        (((0, 0, 1.0), (0, 1, -1.0)), MEMBRANE),
        (((0, 0, 1.0), (1, 0, -1.0)), MEMBRANE),
    ):
        rows = _stencil(index, stencil, n)
        normal = normal + factor * (rows.T @ rows)
    right = (weight * guess)[inside].astype(np.float64) + 1e-6 * guess[inside]
    result = guess.astype(np.float64)
    result[inside] = splu(normal.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve(right)
    return result


def _stencil(index: NDArray[np.int64], stencil: tuple[tuple[int, int, float], ...], n: int) -> csr_array:
    """One row for each place where all points of the stencil (row, column, factor) are inside."""
    padded = np.pad(index, 1, constant_values=-1)
    h, w = index.shape
    members = np.stack([padded[1 + y : 1 + y + h, 1 + x : 1 + x + w] for y, x, _ in stencil], axis=-1)
    members = members[(members >= 0).all(axis=-1)]
    rows = np.repeat(np.arange(len(members)), len(stencil))
    factors = np.tile([factor for _, _, factor in stencil], len(members))
    return coo_array((factors, (rows, members.reshape(-1))), shape=(len(members), n)).tocsr()
