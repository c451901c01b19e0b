"""Depth of one canvas from many photographs: sweep, semi-global optimisation, refinement over all views."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.progress import Progress
from eigenfield.imaging.sampling import farthest_points
from eigenfield.stereo.canvas import Canvas, view_matrices
from eigenfield.stereo.detail import detail_pictures
from eigenfield.stereo.extend import extended
from eigenfield.stereo.refine import refine_depth
from eigenfield.stereo.semiglobal import semi_global
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.sweep import sweep
from eigenfield.stereo.views import Pictures, check_matrices, halve, halved_matrices, motion, pack, unpack
from eigenfield.stereo.visibility import depth_buffers, mean_texture

log = logging.getLogger(__name__)

STEPS = (0.08, 0.06, 0.04, 0.03)  # label units, of the rounds of refinement
FEWEST, PART = 3, 0.2  # views, and the part of them, that must look at a point outside the reference picture
SWEPT = 49  # views that take part in the sweeps: more tell nothing new of a label
STRIDE = 0.5  # pixels between two labels in the view that moves most
MOST_LABELS = 256
REACH = 3  # labels beyond the coarse map's local range that the fine sweep tries
WINDOW = 9  # pixels, of that local range
SWEEP_BIAS = 0.3  # label units
SWEEP_GAIN = 3.0
UNSEEN = 9.0  # grey levels, as a fair match costs: smoothness then decides where nobody looks
P1, P2 = 1.0, 12.0


@dataclass(frozen=True, eq=False)
class Depth:
    """A canvas's depth map.

    d: (h, w) float32 labels. confidence: (h, w) float32, about 1 / variance of d; 0 where nothing is known.
    count: (h, w) int32 views that see the point. texture: (h, w, 3) float32 their mean, grey levels.
    """

    d: NDArray[np.float32]
    confidence: NDArray[np.float32]
    count: NDArray[np.int32]
    texture: NDArray[np.float32]


def estimate_depth(
    pictures: Pictures,
    cameras: Sequence[Camera] | NDArray[np.float64],
    canvas: Canvas | tuple[int, int],
    d_range: tuple[float, float],
    *,
    rounds: int = len(STEPS),
    progress: Progress | None = None,
) -> Depth:
    """Depth of a canvas over [low, high] labels from V views.

    pictures: (V, H, W, 3) uint8 or packed. cameras: V cameras, or their matrices (V, 3, 4) on (x, y, d, 1). canvas: or
    its (height, width), with matrices. rounds: of refinement over all views.

    If the canvas's own camera is among the views, labels are first compared with its picture. Sweep and semi-global
    optimisation at half resolution over the whole range, by the best half of the views; again at full resolution round
    what was found, by the views that see a point; then `rounds` times: visibility, five labels a point over all views,
    local planes. The full sweep is repeated after the first round, when it is better known who sees what.
    """
    packed = pack(pictures)
    shape = canvas.shape if isinstance(canvas, Canvas) else canvas
    if isinstance(cameras, np.ndarray):
        matrices = check_matrices(cameras, len(packed))
    elif isinstance(canvas, Canvas):
        matrices = view_matrices(canvas, cameras)
    else:
        raise TypeError("cameras need a Canvas; a shape goes with matrices")
    low, high = float(d_range[0]), float(d_range[1])
    if not low < high:
        raise ValueError(f"an empty range of labels: {low} to {high}")
    total = 2 + rounds + 1

    def report(done: int) -> None:
        if progress is not None:
            progress("depth", done, total)

    report(0)
    frame = packed.shape[1:]
    chosen = spread_views(motion(matrices, shape, (low + high) / 2), SWEPT)
    step = _label_step(matrices, shape, low, high)
    sharp, detail = detail_pictures(packed[chosen], SWEEP_GAIN, soft=0), detail_pictures(packed)
    picture, known = reference_picture(packed, matrices, shape)

    def drawn_on(d: NDArray[np.float32]) -> NDArray[np.float32]:
        return extended(d, known | _looked_at(packed[chosen], matrices[chosen], d), low, high)

    d = _coarse(packed, matrices, shape, chosen, low, high, step)
    report(1)
    d = drawn_on(np.asarray(cv2.resize(d, (shape[1], shape[0]), interpolation=cv2.INTER_NEAREST), np.float32))
    d = drawn_on(_fine(packed, sharp, matrices, shape, chosen, d, low, high, step))
    report(2)
    confidence = np.zeros(shape, np.float32)
    buffers = np.empty((len(packed), *frame), np.float32)
    for number in range(rounds):
        depth_buffers(matrices, d, frame, out=buffers)
        inner, _ = mean_texture(detail, matrices, d, buffers)
        outer, _ = mean_texture(packed, matrices, d, buffers)
        guide = np.where(known[..., None], picture, outer).astype(np.float32)
        size = STEPS[min(number, len(STEPS) - 1)]
        d, confidence = refine_depth(detail, matrices, d, size, buffers=buffers, texture=inner, guide=guide)
        d = drawn_on(np.clip(smooth_depth(d, confidence, guide), low, high).astype(np.float32))
        if number == 0 and rounds > 1:
            d = drawn_on(_fine(packed, sharp, matrices, shape, chosen, d, low, high, step))
        report(3 + number)
    depth_buffers(matrices, d, frame, out=buffers)
    texture, count = mean_texture(packed, matrices, d, buffers)
    report(total)
    return Depth(d, confidence, count, texture)


def reference_picture(
    pictures: Pictures, matrices: NDArray[np.float64], shape: tuple[int, int]
) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """The picture of the canvas's own camera on the canvas, if it is among the views: ((h, w, 3), where it reaches).

    It is the view in which no point moves with its label.
    """
    packed = pack(pictures)
    own = np.abs(matrices[:, :, 2]).max(axis=1)
    scale = np.abs(motion(matrices, shape)).max(initial=0.0)
    index = int(own.argmin())
    if own[index] > 1e-6 * max(scale, 1e-9):
        return np.zeros((*shape, 3), np.float32), np.zeros(shape, np.bool_)
    homography = matrices[index][:, [0, 1, 3]]
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    size = (shape[1], shape[0])
    colours = unpack(packed[index]).astype(np.float32)
    warped = cv2.warpPerspective(colours, homography, size, flags=flags, borderMode=cv2.BORDER_REPLICATE)
    inside = cv2.warpPerspective(np.ones(colours.shape[:2], np.float32), homography, size, flags=flags)
    return np.asarray(warped, np.float32), inside > 0.999


def _looked_at(
    pictures: NDArray[np.uint32], matrices: NDArray[np.float64], d: NDArray[np.float32]
) -> NDArray[np.bool_]:
    """(h, w): points that fall into enough of the pictures to be judged without a picture of their own."""
    _, count = mean_texture(pictures, matrices, d)
    return count >= max(FEWEST, PART * len(pictures))


def _label_step(matrices: NDArray[np.float64], shape: tuple[int, int], low: float, high: float) -> float:
    fastest = np.hypot(*motion(matrices, shape, (low + high) / 2).T).max(initial=1e-9)
    return float(max(STRIDE / max(fastest, 1e-9), (high - low) / (MOST_LABELS - 1)))


def labels_over(low: float, high: float, step: float) -> NDArray[np.float32]:
    """At least three labels, evenly from low to high."""
    return np.linspace(low, high, max(3, int(np.ceil((high - low) / step)) + 1)).astype(np.float32)


def spread_views(moves: NDArray[np.float64], most: int) -> NDArray[np.int64]:
    """At most `most` views, spread evenly: each is the one farthest from those before; the first moves least."""
    if len(moves) <= most:
        return np.arange(len(moves))
    first = int(np.hypot(*moves.T).argmin())
    return np.sort(farthest_points(lambda index: np.hypot(*(moves - moves[index]).T), first, most))


def _fewest(views: int) -> int:
    """Views that must see a label for its cost to count: a few alone agree by chance."""
    return max(2, round(PART / 2 * views))


def _guide(
    detail: Pictures, matrices: NDArray[np.float64], shape: tuple[int, int], pictures: Pictures
) -> tuple[NDArray[np.float32] | None, NDArray[np.bool_], NDArray[np.float32]]:
    """What a sweep compares with (of the detail pictures), where, and the grey picture whose edges let depth jump."""
    compared, known = reference_picture(detail, matrices, shape)
    seen, _ = reference_picture(pictures, matrices, shape)
    return (compared if known.any() else None), known, seen.mean(axis=-1).astype(np.float32)


def _coarse(
    packed: NDArray[np.uint32], matrices: NDArray[np.float64], shape: tuple[int, int], chosen: NDArray[np.int64],
    low: float, high: float, step: float,
) -> NDArray[np.float32]:  # fmt: skip
    """Depth at half resolution over the whole range."""
    small_shape = ((shape[0] + 1) // 2, (shape[1] + 1) // 2)
    small = halve(packed[chosen])
    detail = detail_pictures(small, SWEEP_GAIN, soft=0)
    half = halved_matrices(matrices[chosen])
    compared, known, grey = _guide(detail, half, small_shape, small)
    labels = labels_over(low, high, 2 * step)
    cost = sweep(
        detail, half, small_shape, labels, reference=compared, known=known, unseen=UNSEEN, fewest=_fewest(len(chosen))
    )
    d, _ = semi_global(cost, grey, labels, P1, P2)
    return d


def _fine(
    packed: NDArray[np.uint32], sharp: NDArray[np.uint32], matrices: NDArray[np.float64], shape: tuple[int, int],
    chosen: NDArray[np.int64], before: NDArray[np.float32], low: float, high: float, step: float,
) -> NDArray[np.float32]:  # fmt: skip
    """Depth at full resolution, between the least and the largest label of the map `before` round each point.
    Views in which `before` hides a point are left out, and all others count: a label of the foreground must then fit
    in every view, which keeps outlines from growing.
    """
    labels = labels_over(low, high, step)
    window = np.ones((WINDOW, WINDOW), np.uint8)
    reach = REACH * float(labels[1] - labels[0])
    floor, ceiling = cv2.erode(before, window) - reach, cv2.dilate(before, window) + reach
    looks = matrices[chosen]
    buffers = depth_buffers(looks, before, packed.shape[1:])
    compared, known, grey = _guide(sharp, looks, shape, packed[chosen])
    cost = sweep(
        sharp, looks, shape, labels, reference=compared, known=known, floor=floor, ceiling=ceiling, buffers=buffers,
        unseen=UNSEEN, fewest=_fewest(len(chosen)),
        bias=SWEEP_BIAS, best=1.0,
    )  # fmt: skip
    d, _ = semi_global(cost, grey, labels, P1, P2)
    return d
