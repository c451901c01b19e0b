"""The second layer of a relief: what the array sees behind the near side of each cut.

Where the first layer is cut, a view from the side sees past the near edge. The array determines how far: a jump J in d
uncovers |m| J pixels, with m the parallax of that view for one unit of d. Depth there is estimated as for the first
layer, from the views that the first layer does not block. Where no view looks, the surface behind continues as a thin
plate that is attached to the far side of the cut.
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
from eigenfield.runtime.parallel import parallel_stream
from eigenfield.stereo.semiglobal import semi_global_matching
from eigenfield.stereo.sweep import plane_sweep
from eigenfield.stereo.views import Pictures, label_parallax, pack_pictures
from eigenfield.stereo.visibility import depth_buffers

log = logging.getLogger("eigenfield.proxy")

SECOND_LAYER_STAGE = "second layer"  # steps: uncovered pixels; sweep and optimisation (two); plate


SECOND_LAYER_SWEEP_MAX_VIEWS = 100  # views of the sweep. More views tell little new
SECOND_LAYER_SWEEP_STEP_PIXELS = 0.8  # distance of two labels in the view with most parallax
SECOND_LAYER_SWEEP_MAX_LABELS = 128
SECOND_LAYER_NEARER_CUTS = 0.3  # how much nearer than the far side of a cut the second layer may come, in cuts
SECOND_LAYER_BEHIND_CUTS = 0.3  # how far it stays behind the first layer, in cuts
SECOND_LAYER_VISIBILITY_BIAS_CUTS = 0.3  # bias of the depth test, in cuts
SECOND_LAYER_MIN_VIEWS = 3  # views that must see past the first layer
SECOND_LAYER_MAX_DIFFERENCE_LEVELS = 30.0  # grey levels at which differences are cut off
SECOND_LAYER_UNSEEN_COST_LEVELS = 21.0  # cost of points that too few views see
SECOND_LAYER_COST_WINDOW_PIXELS = 5  # side of the window over which costs are averaged
SECOND_LAYER_ANCHOR_LEVELS_PER_LABEL = 60.0  # how strongly the far side holds its depth in the optimisation
SECOND_LAYER_SGM_P1_LEVELS = 1.5  # penalty of `semi_global_matching` for a step of one label
SECOND_LAYER_SGM_P2_LEVELS = 25.0  # penalty for a jump
SECOND_LAYER_RING_PIXELS = 12  # width of the far side to which the layer is attached
SECOND_LAYER_OVERLAP_PIXELS = 4  # width by which the layer extends under the far side, so that no gap opens
SECOND_LAYER_HALF_CONFIDENCE = 2.0  # confidence of `semi_global_matching` at which a depth has half its weight
SECOND_LAYER_MAX_COST_LEVELS = 12.0  # cost above which photographs do not agree
SECOND_LAYER_CURVATURE_WEIGHT = 100.0  # weight of curvature, relative to a depth
SECOND_LAYER_SLOPE_WEIGHT = 0.02
SECOND_LAYER_FAR_SIDE_WEIGHT = 100.0


def estimate_second_layer(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    valid: NDArray[np.bool_] | None = None,
    *,
    cut: float,
    progress: Progress | None = None,
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """The layer behind a depth map.

    Args:
        valid: (h, w) where it has surface. Default: everywhere.
        cut: Difference of neighbouring labels at which the first layer is cut.

    Returns:
        (h, w) float32 labels of the second layer, below d, and (h, w) bool where there is one. It extends a few pixels
        under the far side of each cut.
    """
    d = np.ascontiguousarray(d, np.float32)
    valid = np.ones(d.shape, np.bool_) if valid is None else valid
    report = progress or (lambda stage, done, total: None)
    report(SECOND_LAYER_STAGE, 0, 4)
    parallax = label_parallax(matrices, d.shape, float(np.median(d[valid])) if valid.any() else 0.0)
    want, ceiling = _find_revealed(d, valid, cut, parallax)
    if not want.any():
        report(SECOND_LAYER_STAGE, 4, 4)
        return d.copy(), want
    report(SECOND_LAYER_STAGE, 1, 4)
    far = _far_side(d, valid, want, ceiling, cut)
    floor = _label_floor(d, far, want, parallax) - np.float32(SECOND_LAYER_NEARER_CUTS * cut)
    guess, trust = _sweep_behind(pictures, matrices, d, valid, want, floor, ceiling, cut, parallax)
    report(SECOND_LAYER_STAGE, 3, 4)
    inside = want | far
    weight = np.where(want, trust, SECOND_LAYER_FAR_SIDE_WEIGHT)
    plate = _fit_thin_plate(np.where(want, guess, d), weight, inside)
    report(SECOND_LAYER_STAGE, 4, 4)
    behind = SECOND_LAYER_BEHIND_CUTS
    below = d - np.where(want, np.float32(behind * cut), np.float32(0.1 * behind * cut))
    result = np.where(want, np.minimum(np.maximum(plate, floor), np.minimum(ceiling, below)), below)
    overlap = far & binary_dilation(want, iterations=SECOND_LAYER_OVERLAP_PIXELS)
    return result.astype(np.float32), want | overlap


def _find_revealed(
    d: NDArray[np.float32], valid: NDArray[np.bool_], cut: float, parallax: NDArray[np.float64]
) -> tuple[NDArray[np.bool_], NDArray[np.float32]]:
    """Pixels of the near sides that some view uncovers, and the largest d that the surface behind may have there."""
    want, ceiling = np.zeros(d.shape, np.bool_), np.full(d.shape, np.inf, np.float32)
    reach = np.maximum(np.r_[parallax.max(axis=0), -parallax.min(axis=0)], 0.0)
    mark_revealed(d, valid, np.float32(cut), reach, np.float32(SECOND_LAYER_NEARER_CUTS * cut), want, ceiling)
    return want, ceiling


def _far_side(
    d: NDArray[np.float32], valid: NDArray[np.bool_], want: NDArray[np.bool_], ceiling: NDArray[np.float32], cut: float
) -> NDArray[np.bool_]:
    """Pixels beside the uncovered ones that are no nearer than the surface behind may be."""
    ring = binary_dilation(want, iterations=SECOND_LAYER_RING_PIXELS) & ~want & valid
    allowed = minimum_filter(np.where(want, ceiling, np.inf), 2 * SECOND_LAYER_RING_PIXELS + 1)
    return np.asarray(ring & (d <= allowed + np.float32(SECOND_LAYER_NEARER_CUTS * cut)))


def _label_floor(
    d: NDArray[np.float32], far: NDArray[np.bool_], want: NDArray[np.bool_], parallax: NDArray[np.float64]
) -> NDArray[np.float32]:
    """The smallest d on the far side in the neighbourhood: without it the second layer would drop away."""
    jump = float(d[want].max() - d[far].min()) if far.any() else 0.0
    near = 2 * int(np.ceil(np.abs(parallax).max(initial=0.0) * jump)) + 2 * SECOND_LAYER_RING_PIXELS + 1
    least = minimum_filter(np.where(far, d, np.inf), min(near, 2 * max(d.shape) + 1))
    return np.where(np.isfinite(least), least, d[want].min()).astype(np.float32)


def _sweep_behind(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    d: NDArray[np.float32],
    valid: NDArray[np.bool_],
    want: NDArray[np.bool_],
    floor: NDArray[np.float32],
    ceiling: NDArray[np.float32],
    cut: float,
    parallax: NDArray[np.float64],
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Depth of the uncovered pixels from the views that see past the first layer, and its weight (0..1)."""
    chosen = np.arange(0, len(matrices), -(-len(matrices) // SECOND_LAYER_SWEEP_MAX_VIEWS))
    packed, matrices = pack_pictures(pictures[chosen]), matrices[chosen]
    low, high = float(floor[want].min()), float(ceiling[want].max())
    fastest = max(float(np.abs(parallax).max()), 1e-9)
    fewest = (high - low) / (SECOND_LAYER_SWEEP_MAX_LABELS - 4)
    step = max(SECOND_LAYER_SWEEP_STEP_PIXELS / fastest, fewest)
    labels = (low - step + step * np.arange(int(np.ceil((high - low) / step)) + 3)).astype(np.float32)
    buffers = depth_buffers(matrices, d, packed.shape[1:], valid)
    cost = plane_sweep(
        packed, matrices, d.shape, labels, mask=want, floor=floor, ceiling=ceiling, buffers=buffers,
        bias=SECOND_LAYER_VISIBILITY_BIAS_CUTS * cut, max_difference=SECOND_LAYER_MAX_DIFFERENCE_LEVELS,
        min_views=SECOND_LAYER_MIN_VIEWS, unseen_cost=SECOND_LAYER_UNSEEN_COST_LEVELS,
    )  # fmt: skip
    side, most = SECOND_LAYER_COST_WINDOW_PIXELS, np.float32(SECOND_LAYER_MAX_DIFFERENCE_LEVELS)
    window = np.maximum(uniform_filter(want.astype(np.float32), side), np.float32(1 / side**2))

    def smooth(index: int) -> NDArray[np.floating]:
        """Smooth the cost of a label in its place; (h, w) what it was in levels, infinite where it was not tried."""
        tried = want & (cost[..., index] < 255)
        level = np.where(tried, cost[..., index] / np.float32(8), most) * want
        level = uniform_filter(level, side) / window
        anchored = np.abs(labels[index] - d) * np.float32(SECOND_LAYER_ANCHOR_LEVELS_PER_LABEL)
        layer = np.where(want, np.where(tried, level, most), np.minimum(most, anchored))
        cost[..., index] = np.rint(np.clip(layer * 8, 0, 240)).astype(np.uint8)
        return np.where(tried, level, np.float32(np.inf))

    best = np.full(d.shape, np.inf, np.float32)
    for level in parallel_stream(smooth, range(len(labels))):
        np.minimum(best, level, out=best)
    penalties = SECOND_LAYER_SGM_P1_LEVELS, SECOND_LAYER_SGM_P2_LEVELS
    guess, confidence = semi_global_matching(cost, np.zeros(d.shape, np.float32), labels, *penalties)
    sure = confidence / (confidence + np.float32(SECOND_LAYER_HALF_CONFIDENCE))
    trust = np.where(best < SECOND_LAYER_MAX_COST_LEVELS, sure, 0)
    return np.minimum(guess, np.where(want, ceiling, np.inf)).astype(np.float32), trust.astype(np.float32)


def _fit_thin_plate(
    guess: NDArray[np.float32], weight: NDArray[np.float32], inside: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """z over `inside` that minimises a thin plate under tension.

    It minimises sum weight (z - guess)^2 + curvature_weight |second differences|^2 + slope_weight |differences|^2.
    """
    index = np.full(inside.shape, -1, np.int64)
    index[inside] = np.arange(inside.sum())
    n = int(inside.sum())
    normal = diags_array(weight[inside].astype(np.float64) + 1e-6)
    for stencil, factor in (
        (((0, -1, 1.0), (0, 0, -2.0), (0, 1, 1.0)), SECOND_LAYER_CURVATURE_WEIGHT),
        (((-1, 0, 1.0), (0, 0, -2.0), (1, 0, 1.0)), SECOND_LAYER_CURVATURE_WEIGHT),
        (((0, 0, 1.0), (0, 1, -1.0), (1, 0, -1.0), (1, 1, 1.0)), 2 * SECOND_LAYER_CURVATURE_WEIGHT),
        (((0, 0, 1.0), (0, 1, -1.0)), SECOND_LAYER_SLOPE_WEIGHT),
        (((0, 0, 1.0), (1, 0, -1.0)), SECOND_LAYER_SLOPE_WEIGHT),
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
