"""Depth of what moves before, or elsewhere than, a surface that stands still: from the photographs of one frame.

A label of the reference view is as good as the photographs agree on it (`plane_sweep`), and as it lies in all cameras
on pixels that have changed: what moves changes every camera that sees it. The label of the still surface needs no
change, and is preferred. So where light or a shadow changes, the surface stays; where something stands elsewhere in
depth, or is seen for the first time behind what has left, another label explains the photographs better.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, label, mean, sum_labels

from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.detail import detail_pictures
from eigenfield.stereo.estimate import (
    DEPTH_SWEEP_BIAS_LABELS,
    DEPTH_SWEEP_DETAIL_GAIN,
    DEPTH_UNSEEN_COST_LEVELS,
    label_step,
    least_views,
    spaced_labels,
    warp_reference_picture,
)
from eigenfield.stereo.semiglobal import semi_global_matching
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.sweep import plane_sweep
from eigenfield.stereo.sweep_kernels import SWEEP_COST_UNITS_PER_LEVEL, SWEEP_EXCLUDED_COST
from eigenfield.stereo.taps import EMPTY_DEPTH_LABEL
from eigenfield.stereo.views import halve_pictures, halved_matrices, label_parallax, pack_pictures
from eigenfield.stereo.visibility import depth_buffers, mean_texture

MOVING_NEAR_FRACTION = 0.6  # of the still surface's range of labels, by which it is widened
MOVING_NEAR_WIDTHS = 0.1  # of the picture, that what moves may stand apart from the still surface in the outermost view
MOVING_RANGE_PERCENTILES = (0.5, 99.5)  # of its labels, which are its range
MOVING_UNCHANGED_LEVELS = 12.0  # cost of a label that no camera sees changed
MOVING_MIN_CHANGED_SHARE = 0.6  # of the cameras that see a point, where something may move
MOVING_MIN_VIEWS_SHARE = 0.4  # of all cameras, that must see such a point: few agree by chance
MOVING_SHARE_SCALE = 4  # of pixels and of labels at which changed pixels are counted
MOVING_ROOM_PIXELS = 16  # around the part that is looked at
MOVING_ROOM_STEPS = 3  # of labels, that are tried beyond those at which enough cameras see a change
MOVING_STILL_LEVELS = 1.5  # by which another label must be better than the still surface
MOVING_NEAR_STILL_LABELS = 1.5  # steps of labels from the still surface that count as on it
MOVING_KEPT_SHARE = 0.7  # of a label of the frame before, where the views show the same as then
MOVING_SAME_LEVELS = 8.0  # difference from the frame before at which that is halved
MOVING_MIN_GAIN_LEVELS = 1.0  # by which a region's labels must be better than the still surface, on average
MOVING_MIN_REGION_FRACTION = 0.0002  # of the reference view; smaller regions are errors
MOVING_HOLE_REGIONS = 4  # of such regions, up to which a hole is closed
MOVING_FINE_PIXELS = 8  # from what moves at half the resolution, in which it is looked for at the whole one
MOVING_EDGE_RADIUS_PIXELS, MOVING_EDGE_LEVELS = 2, 6.0  # of the guided filter that finds outlines


@dataclass(frozen=True, eq=False)
class StillDepth:
    """The surface that stands still, and the cameras that see it.

    Attributes:
        matrices: (V, 3, 4) of the views.
        d: (h, w) its labels.
        labels: (L,) that are tried for what moves, evenly spaced.
    """

    matrices: NDArray[np.float64]
    d: NDArray[np.float32]
    labels: NDArray[np.float32]

    @staticmethod
    def of(matrices: NDArray[np.float64], d: NDArray[np.float32]) -> StillDepth:
        """With the labels of its range, and of what may move before it."""
        low, high = (float(one) for one in np.percentile(d, MOVING_RANGE_PERCENTILES))
        fastest = float(np.hypot(*label_parallax(matrices, d.shape, high).T).max(initial=1e-9))
        last = high + max(MOVING_NEAR_FRACTION * (high - low), MOVING_NEAR_WIDTHS * d.shape[1] / fastest)
        return StillDepth(matrices, d, spaced_labels(low, last, label_step(matrices, d.shape, low, last)))

    @property
    def step(self) -> float:
        """Between two labels."""
        return float(self.labels[1] - self.labels[0])


@dataclass(frozen=True, eq=False)
class MovingDepth:
    """What moves in a frame.

    Attributes:
        d: (h, w) float32 its labels, continued smoothly where nothing moves; those of the still surface if nothing
            moves at all.
        opacity: (h, w) float32, 1 where it is seen, 0 elsewhere, soft at outlines.
        texture: (h, w, 3) float32 what the views show there, in grey levels.
    """

    d: NDArray[np.float32]
    opacity: NDArray[np.float32]
    texture: NDArray[np.float32]


def find_moving(
    pictures: NDArray[np.uint8],
    changed: NDArray[np.bool_],
    still: StillDepth,
    before: MovingDepth | None = None,
    shown: NDArray[np.bool_] | None = None,
) -> MovingDepth:
    """What moves in a frame.

    Args:
        pictures: (V, H, W, 3) photographs of the frame.
        changed: (V, H, W) of `changed_pixels`; also where a photograph of what stands still is not known.
        before: Of the frame before.
        shown: (V, H, W) pixels that count. Default: all.
    """
    if shown is not None:
        some = shown.any(axis=(1, 2))
        pictures, changed, shown = pictures[some], changed[some], shown[some]
        still = replace(still, matrices=still.matrices[some])
    matrices, d = still.matrices, still.d
    packed = pack_pictures(pictures)
    hidden = None if shown is None else np.where(shown, EMPTY_DEPTH_LABEL, -EMPTY_DEPTH_LABEL)
    flags = _as_pictures(changed)
    at_rest = mean_texture(flags, matrices, d, hidden)[0][..., 0] < 1
    buffers = depth_buffers(matrices, d, packed.shape[1:], at_rest)
    views = _Views(packed, matrices, buffers if hidden is None else np.maximum(buffers, hidden), hidden)
    opacity, texture = np.zeros(d.shape, np.float32), mean_texture(packed, matrices, d, hidden)[0]
    window = _Window.around(_changed_share(replace(views, packed=flags), still), still)
    if window is None:
        return MovingDepth(d, opacity, texture)
    part = window.part
    views = replace(views, matrices=window.still.matrices)
    cut = None if before is None else MovingDepth(before.d[part], before.opacity[part], before.texture[part])
    found = _match(views, window, cut)
    if found is None:
        return MovingDepth(d, opacity, texture)
    opacity[part], texture[part] = found.opacity, found.texture
    around = [(one.start, size - one.stop) for one, size in zip(part, d.shape, strict=True)]
    return MovingDepth(np.pad(found.d, around, mode="edge"), opacity, texture)


@dataclass(frozen=True, eq=False)
class _Views:
    """The photographs of a frame.

    Attributes:
        packed: (V, H, W).
        matrices: (V, 3, 4).
        buffers: (V, H, W) of what hides points.
        hidden: (V, H, W) that hide pixels that do not count, and are part of `buffers`; None: all count.
    """

    packed: NDArray[np.uint32]
    matrices: NDArray[np.float64]
    buffers: NDArray[np.float32]
    hidden: NDArray[np.float32] | None

    def halved(self) -> _Views:
        """The same at half the resolution. A pixel hides what all of its four pixels hide."""
        packed, matrices = halve_pictures(self.packed), halved_matrices(self.matrices)
        hidden = None if self.hidden is None else _halved_buffers(self.hidden)
        return _Views(packed, matrices, _halved_buffers(self.buffers), hidden)


def _halved_buffers(buffers: NDArray[np.float32]) -> NDArray[np.float32]:
    return np.array([_of_four(cv2.erode, one) for one in buffers], np.float32)


def _of_four(pick: Callable[..., Any], picture: NDArray[Any]) -> NDArray[Any]:
    """A picture of half the size: of each four pixels the least (cv2.erode) or the greatest (cv2.dilate)."""
    return np.asarray(pick(picture, np.ones((2, 2), np.uint8), anchor=(0, 0))[::2, ::2])


@dataclass(frozen=True, eq=False)
class _Window:
    """The part of the reference view in which something may move.

    Attributes:
        part: Its rows and columns, which begin with multiples of MOVING_SHARE_SCALE.
        still: Of the part alone, with the labels that are tried there.
        share: (h, w, L) of `_changed_share`, at a resolution `scale` times lower and with every `scale`th label.
        scale: See above.
        may_move: (h, w).
        floor: (h, w) lowest label that is tried.
        ceiling: (h, w) highest label that is tried.
    """

    part: tuple[slice, slice]
    still: StillDepth
    share: NDArray[np.uint8]
    scale: int
    may_move: NDArray[np.bool_]
    floor: NDArray[np.float32]
    ceiling: NDArray[np.float32]

    @staticmethod
    def around(share: NDArray[np.uint8], still: StillDepth) -> _Window | None:
        """The window for a whole `_changed_share`; None: nothing may move."""
        scale, changed = MOVING_SHARE_SCALE, share >= MOVING_MIN_CHANGED_SHARE * 255
        some = np.asarray(changed.any(axis=2))
        if not some.any():
            return None
        (top, bottom), (left, right) = ((at.min(), at.max() + 1) for at in np.nonzero(some))
        room = MOVING_ROOM_PIXELS // scale
        low = slice(max(0, top - room), bottom + room), slice(max(0, left - room), right + room)
        height, width = still.d.shape
        part = (
            slice(scale * low[0].start, min(scale * low[0].stop, height)),
            slice(scale * low[1].start, min(scale * low[1].stop, width)),
        )
        share, changed, d = share[low], changed[low], still.d[part]
        steps = still.labels[::scale]
        first, last = changed.argmax(axis=2), len(steps) - 1 - changed[..., ::-1].argmax(axis=2)

        def whole(values: NDArray[Any]) -> NDArray[Any]:
            return _enlarged(values, scale, d.shape)

        may_move, more = whole(some[low]), MOVING_ROOM_STEPS * np.float32(still.step)
        lowest, highest = (np.where(may_move, whole(steps[k]), d) for k in (first, last))
        around = np.ones((5, 5), np.uint8)
        floor = np.asarray(cv2.erode(np.minimum(lowest, d) - more, around), np.float32)
        ceiling = np.asarray(cv2.dilate(np.maximum(highest, d) + more, around), np.float32)
        may_move = cv2.dilate(may_move.astype(np.uint8), np.ones((3, 3), np.uint8)) > 0
        shift = np.eye(4)
        shift[0, 3], shift[1, 3] = part[1].start, part[0].start
        whole_range = StillDepth(still.matrices @ shift, d, still.labels)
        return _Window(part, whole_range, share, scale, may_move, floor, ceiling).with_fewer_labels()

    def with_fewer_labels(self) -> _Window:
        """The same with the labels that are tried somewhere."""
        labels, scale = self.still.labels, self.scale
        ends = np.searchsorted(labels, (self.floor[self.may_move].min(), self.ceiling[self.may_move].max()))
        least = 2 * scale + 1  # three at the scale of the share
        begin = max(0, min(int(ends[0]), len(labels) - least)) // scale * scale
        labels = labels[begin : max(int(ends[1]), begin + least)]
        return replace(self, still=replace(self.still, labels=labels), share=self.share[..., begin // scale :])

    def halved(self) -> _Window:
        """The same at half the resolution, with every second label."""
        still, may_move = self.still, _of_four(cv2.dilate, self.may_move.astype(np.uint8)) > 0
        floor, ceiling = _of_four(cv2.erode, self.floor), _of_four(cv2.dilate, self.ceiling)
        small = StillDepth(halved_matrices(still.matrices), still.d[::2, ::2], still.labels[::2])
        return _Window(self.part, small, self.share, self.scale // 2, may_move, floor, ceiling)

    def near(self, d: NDArray[np.float32], moves: NDArray[np.bool_]) -> _Window:
        """The same where something moves or stands still beside it, with the labels of both."""
        around = np.ones((2 * MOVING_FINE_PIXELS + 1,) * 2, np.uint8)
        may_move = self.may_move & (cv2.dilate(moves.astype(np.uint8), around) > 0)
        d, more = np.where(moves, d, self.still.d), np.float32(MOVING_ROOM_STEPS * self.still.step)
        floor = np.maximum(self.floor, cv2.erode(np.minimum(d, self.still.d), around) - more)
        ceiling = np.minimum(self.ceiling, cv2.dilate(np.maximum(d, self.still.d), around) + more)
        return replace(self, may_move=may_move, floor=floor, ceiling=ceiling).with_fewer_labels()


def _enlarged(values: NDArray[Any], scale: int, shape: tuple[int, ...]) -> NDArray[Any]:
    """A picture in which each pixel stands for scale x scale ones, cut to a shape."""
    return values.repeat(scale, axis=0).repeat(scale, axis=1)[: shape[0], : shape[1]]


@dataclass(frozen=True, eq=False)
class _Match:
    """What moves in a window.

    Attributes:
        d: (h, w) labels.
        moves: (h, w) where they are those of something that moves.
        confidence: (h, w) of `semi_global_matching`.
        guide: (h, w, 3) what the views show, in grey levels.
    """

    d: NDArray[np.float32]
    moves: NDArray[np.bool_]
    confidence: NDArray[np.float32]
    guide: NDArray[np.float32]

    @staticmethod
    def of(views: _Views, window: _Window, d: NDArray[np.float32]) -> _Match:
        """By a sweep over the labels of the window.

        Args:
            d: (h, w) labels at which colours are taken that steer the matching.
        """
        packed, matrices, still = views.packed, views.matrices, window.still
        detail = detail_pictures(packed, DEPTH_SWEEP_DETAIL_GAIN, blur_sigma=0)
        compared, known = warp_reference_picture(detail, matrices, still.d.shape)
        own, _ = warp_reference_picture(packed, matrices, still.d.shape)
        if views.hidden is not None:
            known &= warp_reference_picture(_as_pictures(views.hidden < 0), matrices, still.d.shape)[0][..., 0] > 254
        cost = plane_sweep(
            detail, matrices, still.d.shape, still.labels, reference=compared, known=known, mask=window.may_move,
            floor=window.floor, ceiling=window.ceiling, buffers=views.buffers, bias=DEPTH_SWEEP_BIAS_LABELS,
            half_plane_fraction=1.0, min_views=least_views(len(packed)), unseen_cost=DEPTH_UNSEEN_COST_LEVELS,
        )  # fmt: skip
        beside = mean_texture(packed, matrices, d, views.buffers, DEPTH_SWEEP_BIAS_LABELS)[0]
        guide = np.where(known[..., None], own, beside).astype(np.float32)
        cost, gain = _priced(cost, window)
        found, confidence = semi_global_matching(cost, guide.mean(axis=2), still.labels)
        return _Match(found, _moving_regions(found, gain, still, window.may_move), confidence, guide)


def _match(views: _Views, window: _Window, before: MovingDepth | None) -> MovingDepth | None:
    """What moves in a window, first at half the resolution; None: nothing.

    Args:
        before: Of the frame before, in the window.
    """
    still, packed, matrices = window.still, views.packed, views.matrices
    half = window.halved()
    coarse = _Match.of(views.halved(), half, half.still.d)
    if not coarse.moves.any():
        return None
    d, moves = (_enlarged(one, 2, still.d.shape) for one in (coarse.d, coarse.moves))
    hides = depth_buffers(matrices, d, packed.shape[1:], moves)
    views = replace(views, buffers=np.maximum(views.buffers, hides))
    fine = _Match.of(views, window.near(d, moves), np.where(moves, d, still.d))
    moves, guide = fine.moves, fine.guide
    if not moves.any():
        return None
    known = moves & _is_apart(fine.d, still)
    nearest = distance_transform_edt(~known, return_distances=False, return_indices=True)
    smooth = smooth_depth(fine.d[tuple(nearest)], np.where(known, fine.confidence, 0), guide)
    if before is not None:
        smooth = smooth + _kept_share(packed, still, before, views.hidden) * (before.d - smooth)
    smooth = np.clip(smooth, still.labels[0], still.labels[-1])
    texture, count = mean_texture(packed, matrices, np.where(moves, smooth, still.d), views.hidden)
    return MovingDepth(smooth, _soft_outlines(moves, guide), np.where(count[..., None] > 0, texture, guide))


def _as_pictures(masks: NDArray[np.bool_]) -> NDArray[np.uint32]:
    """Packed pictures of masks, white where they are True."""
    return np.where(masks, np.uint32(0xFFFFFF), np.uint32(0))


def _changed_share(flags: _Views, still: StillDepth) -> NDArray[np.uint8]:
    """(h / scale, w / scale, labels) uint8 how many of the views that see a point see a changed pixel there, 255: all;
    0 where few see it. The scale is MOVING_SHARE_SCALE, of pixels and of labels.

    Args:
        flags: White where a pixel has changed.
    """
    shape, scale = still.d.shape, 1
    while scale < MOVING_SHARE_SCALE:
        flags, shape, scale = flags.halved(), ((shape[0] + 1) // 2, (shape[1] + 1) // 2), 2 * scale
    labels = still.labels[::scale]
    share = np.empty((*shape, len(labels)), np.uint8)
    for k, value in enumerate(labels):
        plane = np.full(shape, value, np.float32)
        white, count = mean_texture(flags.packed, flags.matrices, plane, flags.buffers, DEPTH_SWEEP_BIAS_LABELS)
        share[..., k] = np.where(count >= MOVING_MIN_VIEWS_SHARE * len(flags.packed), white[..., 0], 0)
    return share


def _kept_share(
    packed: NDArray[np.uint32], still: StillDepth, before: MovingDepth, hidden: NDArray[np.float32] | None
) -> NDArray[np.float32]:
    """(h, w) how much of the labels of the frame before stays: much where the views show the same as then."""
    d = np.where(before.opacity >= 0.5, before.d, still.d)
    now = mean_texture(packed, still.matrices, d, hidden)[0]
    apart = np.abs(now - before.texture).max(axis=2) / np.float32(MOVING_SAME_LEVELS)
    share = MOVING_KEPT_SHARE / (1 + apart**2) * (before.opacity >= 0.5)
    return np.asarray(share, np.float32)


def _priced(cost: NDArray[np.uint8], window: _Window) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """(h, w, L) costs of labels with all that speaks for or against them, and (h, w) by how many grey levels the
    photographs agree better on the best label than on the still surface."""
    still, units, top = window.still, float(SWEEP_COST_UNITS_PER_LEVEL), SWEEP_EXCLUDED_COST - 1
    index = np.arange(len(still.labels), dtype=np.float32)
    base = np.clip((still.d - still.labels[0]) / still.step, 0, index[-1])
    result, gain = np.empty_like(cost), np.zeros(cost.shape[:2], np.float32)
    below = np.arange(len(index)) // window.scale
    above = np.minimum(below + 1, window.share.shape[2] - 1)
    between = index / window.scale - below.astype(np.float32)

    def price(row: int) -> None:  # one row at a time: the volume is large
        on_still = np.abs(index - base[row][:, None]) <= MOVING_NEAR_STILL_LABELS
        result[row] = np.where(on_still, 0, top)
        at = np.flatnonzero(window.may_move[row])
        agree, on_still = cost[row, at].astype(np.float32), on_still[at]
        share = window.share[row // window.scale, at // window.scale].astype(np.float32)
        share = share[:, below] + between * (share[:, above] - share[:, below])
        moving = agree + units * MOVING_UNCHANGED_LEVELS / 255 * (255 - share)
        stays = np.where(on_still, agree, np.inf).min(axis=1, initial=top)
        gain[row, at] = (stays - np.where(on_still, top, moving).min(axis=1, initial=top)) / units
        own = np.where(on_still, np.maximum(stays - units * MOVING_STILL_LEVELS, 0)[:, None], moving)
        result[row, at] = np.minimum(np.rint(own), top)

    parallel_map(price, range(len(cost)))
    return result, gain


def _is_apart(d: NDArray[np.float32], still: StillDepth) -> NDArray[np.bool_]:
    """(h, w) which labels are not the still surface's; one may lie half a step beside that which was tried."""
    return np.abs(d - still.d) > (MOVING_NEAR_STILL_LABELS + 0.5) * still.step


def _moving_regions(
    found: NDArray[np.float32], gain: NDArray[np.float32], still: StillDepth, may_move: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """(h, w) pixels whose label is not the still surface's, in regions that are large and pay; holes are closed."""
    moves = may_move & _is_apart(found, still)
    least = max(4, round(MOVING_MIN_REGION_FRACTION * moves.size))
    regions, count = label(moves)
    numbers = np.arange(1, count + 1)
    kept = np.zeros(count + 1, np.bool_)
    if count:
        kept[1:] = np.asarray(sum_labels(moves, regions, numbers)) >= least
        kept[1:] &= np.asarray(mean(gain, regions, numbers)) >= MOVING_MIN_GAIN_LEVELS
    moves = kept[regions]
    holes, count = label(~moves)
    small = np.bincount(holes.ravel(), minlength=count + 1) < MOVING_HOLE_REGIONS * least
    small[0] = False
    return moves | small[holes]


def _soft_outlines(moves: NDArray[np.bool_], guide: NDArray[np.float32]) -> NDArray[np.float32]:
    """(h, w) opacity: a guided filter of the mask, whose outlines follow those of the photographs.

    He, Sun and Tang, Guided Image Filtering, PAMI 2013, with the mean of three grey guides.
    """
    side = 2 * MOVING_EDGE_RADIUS_PIXELS + 1

    def blur(values: NDArray[np.float32]) -> NDArray[np.float32]:
        return np.asarray(cv2.blur(values, (side, side)), np.float32)

    mask = moves.astype(np.float32)[..., None].repeat(3, axis=2)
    centre, share = blur(guide), blur(mask)
    spread = blur(guide * guide) - centre * centre + np.float32(MOVING_EDGE_LEVELS**2)
    slope = np.asarray((blur(guide * mask) - centre * share) / spread, np.float32)
    drawn = blur(slope) * guide + blur(share - slope * centre)
    return np.clip(1.5 * (drawn.mean(axis=2) - 0.5) + 0.5, 0, 1).astype(np.float32)
