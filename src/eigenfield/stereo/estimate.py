"""Depth of one reference view from many photographs: sweep, semi-global matching, refinement over all views."""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.imaging.sampling import farthest_points
from eigenfield.stereo.detail import DETAIL_BASE_GAIN, detail_pictures
from eigenfield.stereo.extend import extend_depth
from eigenfield.stereo.refine import refine_depth
from eigenfield.stereo.semiglobal import semi_global_matching
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.sweep import plane_sweep
from eigenfield.stereo.views import (
    Pictures,
    check_matrices,
    halve_pictures,
    halved_matrices,
    inside_pictures,
    label_parallax,
    pack_pictures,
    unpack_pictures,
)
from eigenfield.stereo.visibility import depth_buffers, mean_texture

DEPTH_REFINEMENT_STEP_LABELS = (0.08, 0.06, 0.04, 0.03)  # distance of the labels that each round of refinement tries
DEPTH_MIN_VIEWS = 3  # views that must see a point outside the reference picture
DEPTH_MIN_VIEW_FRACTION = 0.2  # fraction of all views that must see it
DEPTH_SWEEP_MAX_VIEWS = 49  # views in the sweeps. More views tell nothing new about a label
DEPTH_SWEEP_STRIDE_PIXELS = 0.5  # movement between two labels in the view that moves most
DEPTH_SWEEP_MAX_LABELS = 256  # labels of one sweep
DEPTH_SWEEP_BYTES = 3  # for each pixel and label: its cost, and the sums of semi-global matching
DEPTH_MAX_BYTES = 4e9  # that a sweep takes so
DEPTH_MAX_PIXELS = 16_000_000  # of a reference view: each takes some 100 bytes beside
DEPTH_SWEEP_BIAS_LABELS = 0.3  # labels behind the depth buffer at which a point still counts as visible in a sweep
DEPTH_SWEEP_DETAIL_GAIN = 3.0  # gain of the detail pictures that are swept
# Cost in grey levels where too few views look, that of a fair match: smoothness then decides
DEPTH_UNSEEN_COST_LEVELS = 9.0
DEPTH_FINE_REACH_LABELS = 3  # labels that the fine sweep tries beyond the local range of the coarse map
DEPTH_FINE_WINDOW_PIXELS = 9  # window of that local range


def estimate_depth(
    pictures: Pictures,
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    d_range: tuple[float, float],
    *,
    rounds: int = len(DEPTH_REFINEMENT_STEP_LABELS),
) -> NDArray[np.float32]:
    """The depth map of a reference view from V views, (h, w) labels.

    Labels are first compared with the reference camera's own picture, if it is among the views. The first sweep and
    semi-global matching run at half resolution over the whole range, with the best half of the views. The second sweep
    runs at full resolution around the first result, with the views that see each point. Then each of `rounds` computes
    visibility, tries five labels a point over all views, and fits local planes. The fine sweep is repeated after the
    first round, when visibility is better known.

    Args:
        d_range: Lowest and highest label.

    Raises:
        ValueError: The range is empty, or pictures or matrices are malformed.
    """
    packed = pack_pictures(pictures)
    matrices = check_matrices(matrices, len(packed))
    low, high = float(d_range[0]), float(d_range[1])
    if not low < high:
        raise ValueError(f"an empty range of labels: {low} to {high}")
    frame = packed.shape[1:]
    chosen = spread_views(label_parallax(matrices, shape, (low + high) / 2), DEPTH_SWEEP_MAX_VIEWS)
    step = label_step(matrices, shape, low, high)
    sharp = detail_pictures(packed[chosen], DEPTH_SWEEP_DETAIL_GAIN, blur_sigma=0)
    detail = detail_pictures(packed)
    picture, known = warp_reference_picture(packed, matrices, shape)

    def extend(d: NDArray[np.float32]) -> NDArray[np.float32]:
        return extend_depth(d, known | _seen_by_enough(packed[chosen], matrices[chosen], d), low, high)

    d = sweep_coarse(packed, matrices, shape, chosen, low, high, step)
    d = extend(np.asarray(cv2.resize(d, (shape[1], shape[0]), interpolation=cv2.INTER_NEAREST), np.float32))
    d = extend(_sweep_fine(packed, sharp, matrices, shape, chosen, d, low, high, step))
    steps = DEPTH_REFINEMENT_STEP_LABELS
    buffers = np.empty((len(packed), *frame), np.float32)
    for number in range(rounds):
        depth_buffers(matrices, d, frame, out=buffers)
        inner, _ = mean_texture(detail, matrices, d, buffers)
        outer, _ = mean_texture(packed, matrices, d, buffers)
        guide = np.where(known[..., None], picture, outer).astype(np.float32)
        size = steps[min(number, len(steps) - 1)]
        d, confidence = refine_depth(detail, matrices, d, size, buffers=buffers, texture=inner, guide=guide)
        d = extend(np.clip(smooth_depth(d, confidence, guide), low, high).astype(np.float32))
        if number == 0 and rounds > 1:
            d = extend(_sweep_fine(packed, sharp, matrices, shape, chosen, d, low, high, step))
    return d


def warp_reference_picture(
    packed: NDArray[np.uint32], matrices: NDArray[np.float64], shape: tuple[int, int]
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """The reference camera's own picture, warped to the reference view, if it is among the views.

    It is the view in which no point moves with its label: (h, w, 3), and (h, w) where it has pixels.
    """
    moved = np.abs(matrices[:, :, 2]).max(axis=1)
    scale = np.abs(label_parallax(matrices, shape)).max(initial=0.0)
    index = int(moved.argmin())
    if moved[index] > 1e-6 * max(scale, 1e-9):
        return np.zeros((*shape, 3), np.float32), np.zeros(shape, np.bool_)
    homography = matrices[index][:, [0, 1, 3]]
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    size = (shape[1], shape[0])
    colours = unpack_pictures(packed[index]).astype(np.float32)
    warped = cv2.warpPerspective(colours, homography, size, flags=flags, borderMode=cv2.BORDER_REPLICATE)
    pixels = inside_pictures(packed[index : index + 1])[0].astype(np.float32)
    inside = cv2.warpPerspective(pixels, homography, size, flags=flags)
    return np.asarray(warped, np.float32), inside > 0.999


def _seen_by_enough(
    pictures: NDArray[np.uint32], matrices: NDArray[np.float64], d: NDArray[np.float32]
) -> NDArray[np.bool_]:
    """(h, w): points that enough of the pictures see to be judged without a reference picture."""
    _, count = mean_texture(pictures, matrices, d)
    return count >= max(DEPTH_MIN_VIEWS, DEPTH_MIN_VIEW_FRACTION * len(pictures))


def label_step(matrices: NDArray[np.float64], shape: tuple[int, int], low: float, high: float) -> float:
    """Distance of the labels of a sweep at full resolution."""
    step = _stride(matrices, shape, low, high)
    return float(max(step, (high - low) / (DEPTH_SWEEP_MAX_LABELS - 1)))


def _stride(matrices: NDArray[np.float64], shape: tuple[int, int], low: float, high: float) -> float:
    """Distance of labels that move a point by DEPTH_SWEEP_STRIDE_PIXELS in the view that moves most."""
    fastest = np.hypot(*label_parallax(matrices, shape, (low + high) / 2).T).max(initial=1e-9)
    return float(DEPTH_SWEEP_STRIDE_PIXELS / fastest)


def depth_scale(matrices: NDArray[np.float64], shape: tuple[int, int], low: float, high: float) -> float:
    """The scale of pictures and reference view, at most 1, at which `estimate_depth` stays within DEPTH_MAX_BYTES.

    With them fall the pixels of a sweep and, below DEPTH_SWEEP_MAX_LABELS, its labels.
    """
    pixels = shape[0] * shape[1]
    most = DEPTH_MAX_BYTES / (DEPTH_SWEEP_BYTES * pixels)  # labels
    asked = (high - low) / _stride(matrices, shape, low, high)
    swept = max((most / asked) ** (1 / 3), (most / DEPTH_SWEEP_MAX_LABELS) ** (1 / 2))
    return float(min(1.0, swept, (DEPTH_MAX_PIXELS / pixels) ** (1 / 2)))


def spaced_labels(low: float, high: float, step: float) -> NDArray[np.float32]:
    """At least three labels, evenly spaced.

    Args:
        step: Largest distance between neighbours.
    """
    return np.linspace(low, high, max(3, int(np.ceil((high - low) / step)) + 1)).astype(np.float32)


def spread_views(moves: NDArray[np.float64], max_views: int) -> NDArray[np.int64]:
    """At most `max_views` views, evenly spread: each is the farthest from those chosen before.

    Args:
        moves: (V, 2) parallax of each view (`label_parallax`). The view that moves least is chosen first.

    Returns:
        Sorted indices.
    """
    if len(moves) <= max_views:
        return np.arange(len(moves))
    first = int(np.hypot(*moves.T).argmin())
    return np.sort(farthest_points(lambda index: np.hypot(*(moves - moves[index]).T), first, max_views))


def least_views(views: int) -> int:
    """Number of views that must see a label for its cost to count: a few alone agree by chance."""
    return max(2, round(DEPTH_MIN_VIEW_FRACTION / 2 * views))


def sweep_and_match(
    detail: NDArray[np.uint32],
    pictures: NDArray[np.uint32],
    matrices: NDArray[np.float64],
    shape: tuple[int, int],
    labels: NDArray[np.float32],
    **options: Any,
) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    """Depth by a plane sweep and semi-global matching, and the costs of the sweep.

    Args:
        detail: (V, H, W) packed pictures that are compared.
        pictures: (V, H, W) packed; at edges of the reference camera's own one, depth may jump.
        options: Of `plane_sweep`.
    """
    compared, known = warp_reference_picture(detail, matrices, shape)
    grey = warp_reference_picture(pictures, matrices, shape)[0].mean(axis=-1).astype(np.float32)
    cost = plane_sweep(detail, matrices, shape, labels, reference=compared, known=known, **options)
    return semi_global_matching(cost, grey, labels)[0], cost


def sweep_coarse(
    packed: NDArray[np.uint32], matrices: NDArray[np.float64], shape: tuple[int, int], chosen: NDArray[np.int64],
    low: float, high: float, step: float, base_gain: float = DETAIL_BASE_GAIN,
) -> NDArray[np.float32]:  # fmt: skip
    """Depth at half resolution (rounded up) over the whole range.

    Args:
        chosen: Indices of the views that are compared.
        step: Of the labels at full resolution (`label_step`).
    """
    small_shape = ((shape[0] + 1) // 2, (shape[1] + 1) // 2)
    small = halve_pictures(packed[chosen])
    detail = detail_pictures(small, DEPTH_SWEEP_DETAIL_GAIN, blur_sigma=0, base_gain=base_gain)
    d, _ = sweep_and_match(
        detail, small, halved_matrices(matrices[chosen]), small_shape, spaced_labels(low, high, 2 * step),
        unseen_cost=DEPTH_UNSEEN_COST_LEVELS, min_views=least_views(len(chosen)),
    )  # fmt: skip
    return d


def _sweep_fine(
    packed: NDArray[np.uint32], sharp: NDArray[np.uint32], matrices: NDArray[np.float64], shape: tuple[int, int],
    chosen: NDArray[np.int64], before: NDArray[np.float32], low: float, high: float, step: float,
) -> NDArray[np.float32]:  # fmt: skip
    """Depth at full resolution, between the smallest and largest label of the map `before` around each point.

    Views in which `before` hides a point are left out, and all others count. A label of the foreground must then fit in
    every view, which keeps outlines from growing.
    """
    labels = spaced_labels(low, high, step)
    window = np.ones((DEPTH_FINE_WINDOW_PIXELS, DEPTH_FINE_WINDOW_PIXELS), np.uint8)
    reach = DEPTH_FINE_REACH_LABELS * float(labels[1] - labels[0])
    floor, ceiling = cv2.erode(before, window) - reach, cv2.dilate(before, window) + reach
    chosen_matrices = matrices[chosen]
    buffers = depth_buffers(chosen_matrices, before, packed.shape[1:])
    d, _ = sweep_and_match(
        sharp, packed[chosen], chosen_matrices, shape, labels, floor=floor, ceiling=ceiling, buffers=buffers,
        unseen_cost=DEPTH_UNSEEN_COST_LEVELS, min_views=least_views(len(chosen)),
        bias=DEPTH_SWEEP_BIAS_LABELS, half_plane_fraction=1.0,
    )  # fmt: skip
    return d
