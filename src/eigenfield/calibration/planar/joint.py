"""Joint refinement of a planar array's cameras and depth, by photo-consistency.

A nominal grid is never exact, and depth from inexact cameras is blurred. Both are estimated in alternation. The mean
texture over all views that see a point is what every photograph should show there. Each camera is moved until it does
(Gauss-Newton), then depth is estimated again. The array is grown from its centre, where disparities are small.
"""

from __future__ import annotations

import itertools
import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from eigenfield.calibration.planar.array import ARRAY_PARAMETERS, ARRAY_POSITION, ARRAY_SHIFT, ArrayModel
from eigenfield.calibration.planar.fit import PhotometricTarget, gauss_newton_step, select_textured_points
from eigenfield.calibration.planar.kernels import occlusion_votes
from eigenfield.calibration.planar.start import PlanarStart, irregularity, reverse_depth
from eigenfield.core.progress import Progress
from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.estimate import depth_scale, estimate_depth
from eigenfield.stereo.extend import extend_depth
from eigenfield.stereo.reference_view import ReferenceView
from eigenfield.stereo.refine import refine_depth
from eigenfield.stereo.semiglobal import semi_global_matching
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.sweep import SWEEP_MAX_DIFFERENCE_LEVELS, plane_sweep
from eigenfield.stereo.taps import OUTSIDE_PIXEL
from eigenfield.stereo.views import (
    HALF_FROM_FULL_INDEX,
    Pictures,
    halve_pictures,
    inside_pictures,
    pack_pictures,
    unpack_pictures,
)
from eigenfield.stereo.visibility import depth_buffers, mean_texture

log = logging.getLogger("eigenfield.calibration")


# Constants of `refine_planar`. Pixels are those of the outermost camera unless said otherwise.
PLANAR_TAU_LEVELS = 15.0  # scale of the Cauchy loss, grey levels
PLANAR_VISIBILITY_BIAS_PIXELS = 0.96  # distance behind the depth buffer at which a point still counts as visible
PLANAR_SWEEP_STEP_PIXELS = 1.2  # distance between two labels of a sweep
PLANAR_SWEEP_MAX_LABELS = 256  # labels of one sweep
PLANAR_SMOOTH_PIXELS = 1.2  # distance within which neighbours are one surface
PLANAR_LAST_SMOOTH_PIXELS = 0.6  # the same, in the last rounds
# curvature of the cost, squared grey levels per squared pixel, at which smoothing gives a depth half weight
PLANAR_HALF_CONFIDENCE = 2.7
PLANAR_DEPTH_STEP_PIXELS = (0.64, 0.48, 0.48, 0.32, 0.24)  # steps of the rounds of depth refinement
PLANAR_LAST_DEPTH_STEP_PIXELS = (0.24, 0.16)  # steps of the rounds after the cameras are final
PLANAR_REGULAR_PIXELS = 0.1  # cameras this close to a regular grid, or to their calibration, are not corrected
PLANAR_MIN_DEPTH_VIEW_FRACTION = 0.02  # fraction of the views that must see a point for its depth to be its own
PLANAR_SWEEP_MAX_VIEWS = 90  # views of a plane sweep
PLANAR_SWEEP_REACH_LABELS = 4.0  # labels that a sweep of an outer ring tries beyond the local range of the depth so far
PLANAR_SWEEP_WINDOW_PIXELS = 15  # window of that local range, at half resolution
# Range of disparities between neighbouring cameras up to which outer rings sweep so. With 26 they gain (Tarot 9x9),
# with 108 the depth so far is too often wrong (the sparse Tarot).
PLANAR_SWEEP_NEAR_MAX_PARALLAX_PIXELS = 50.0
PLANAR_VOTE_MAX_VIEWS = 12  # views of a ring that vote on which side is near
PLANAR_VOTE_GAP_PIXELS = 4.0  # distance between two surfaces in the outermost voter
PLANAR_VOTE_CONTRAST_LEVELS = 8.0  # difference of their colours, grey levels
PLANAR_VOTE_CLEAR_RATIO = 1.5  # ratio of the votes below which both orders are tried


@dataclass(frozen=True, eq=False)
class PlanarArray:
    """A refined planar array.

    Attributes:
        model: The fixed part of the cameras.
        parameters: (n, 10) of the cameras.
        reference: The view of the depth map.
        d: (h, w) labels (see `stereo`).
        texture: (h, w, 3) mean texture, grey levels.
        count: (h, w) number of views that see each point.
        error: (n,) root mean square difference of each photograph from the mean texture at textured points, grey
            levels.
        refined: Whether positions were corrected; False if a regular grid fits as well.
    """

    model: ArrayModel
    parameters: NDArray[np.float64]
    reference: ReferenceView
    d: NDArray[np.float32]
    texture: NDArray[np.float32]
    count: NDArray[np.int32]
    error: NDArray[np.float64]
    refined: bool


def reference_margin(start: PlanarStart) -> int:
    """Pixels by which the reference view is wider than a photograph on every side: the outermost camera's parallax."""
    side = np.abs(start.places).max()
    return int(np.ceil(side * max(abs(start.low), abs(start.high)) / 8)) * 8 + 8


def start_scale(start: PlanarStart) -> float:
    """The scale of photographs, at most 1, at which `refine_planar` takes bounded memory (`depth_scale`)."""
    reference = start.model.reference_view(reference_margin(start))
    matrices = start.model.matrices(reference, np.arange(len(start.parameters)), start.parameters)
    return depth_scale(matrices, reference.shape, start.low, start.high)


class _JointRefinement:
    """The state of the refinement: the parameters of all cameras and the depth map of the reference view."""

    def __init__(self, pictures: NDArray[np.uint32], start: PlanarStart) -> None:
        self.pictures = pictures
        self.start = start
        self.model = start.model
        self.parameters = start.parameters.copy()
        self.centre = start.centre
        self.low, self.high = start.low, start.high
        self.extent = self.extent_of(np.arange(len(pictures)))
        apart = float(np.median(np.asarray(cKDTree(start.places).query(start.places, 2)[0])[:, 1]))
        self.dense = apart * (start.high - start.low) <= PLANAR_SWEEP_NEAR_MAX_PARALLAX_PIXELS
        self.bias = PLANAR_VISIBILITY_BIAS_PIXELS / self.extent
        self.reference = self.model.reference_view(reference_margin(start))
        self.half_size = halve_pictures(pictures)
        shape = self.reference.shape
        self.d = np.zeros(shape, np.float32)
        self.texture = np.zeros((*shape, 3), np.float32)
        self.count = np.zeros(shape, np.int32)
        self.error = np.full(len(pictures), np.nan)
        self._buffers: NDArray[np.float32] | None = None

    def subset(self, views: NDArray[np.int64], pictures: NDArray[np.uint32]) -> NDArray[np.uint32]:
        """The pictures of some views, copied only if these are not all."""
        return pictures if len(views) == len(pictures) else pictures[views]

    def matrices(self, views: NDArray[np.int64]) -> NDArray[np.float64]:
        return self.model.matrices(self.reference, views, self.parameters[views])

    def update_texture(
        self, views: NDArray[np.int64], pictures: NDArray[np.uint32], buffers: NDArray[np.float32] | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        """Visibility and mean texture over `views`, from the present cameras and depth; or with a given visibility."""
        matrices = self.matrices(views)
        if buffers is None:
            shape = pictures.shape[1:3]
            if self._buffers is None or len(self._buffers) != len(views):
                self._buffers = None  # the old ones go before there are new ones
                self._buffers = np.zeros((len(views), *shape), np.float32)
            buffers = depth_buffers(matrices, self.d, shape, out=self._buffers)
        self.texture, self.count = mean_texture(pictures, matrices, self.d, buffers, self.bias)
        return matrices, buffers

    def make_target(
        self,
        views: NDArray[np.int64],
        pictures: NDArray[np.uint32],
        parameters: int,
        buffers: NDArray[np.float32] | None = None,
    ) -> PhotometricTarget:
        """What so many parameters of the cameras of `views` are fitted to: the mean texture over them."""
        _, buffers = self.update_texture(views, pictures, buffers)
        points = select_textured_points(self.d, self.texture, self.count, len(views), parameters)
        return PhotometricTarget(self.reference, pictures, buffers, *points, self.bias)

    def sweep_depth(self, views: NDArray[np.int64], coarser: float = 1.0, *, outer: bool = False) -> None:
        """Plane sweep at half resolution and semi-global matching.

        Args:
            coarser: Factor of the distance of labels.
            outer: Whether a ring around others is among the views: of a dense array, only labels near those of the
                depth that the others gave are tried.
        """
        small = self.reference.at_half_resolution()
        matrices = HALF_FROM_FULL_INDEX @ self.model.matrices(small, views, self.parameters[views])
        step = min(coarser * PLANAR_SWEEP_STEP_PIXELS / self.extent_of(views), (self.high - self.low) / 64)
        step = max(step, (self.high - self.low) / (PLANAR_SWEEP_MAX_LABELS - 1))
        labels = np.arange(self.low, self.high + step, step, dtype=np.float32)
        floor = ceiling = None
        if outer and self.dense:
            d = cv2.resize(self.d, small.shape[::-1], interpolation=cv2.INTER_NEAREST)
            window = np.ones((PLANAR_SWEEP_WINDOW_PIXELS,) * 2, np.uint8)
            reach = PLANAR_SWEEP_REACH_LABELS * step
            floor = np.asarray(cv2.erode(d, window) - reach, np.float32)
            ceiling = np.asarray(cv2.dilate(d, window) + reach, np.float32)
        reference, known = _pad_to_reference(self.half_size[self.centre], small.shape)
        cost = plane_sweep(
            self.half_size[views], matrices, small.shape, labels, reference=reference, known=known,
            unseen_cost=SWEEP_MAX_DIFFERENCE_LEVELS, floor=floor, ceiling=ceiling,
        )  # fmt: skip
        guide = cv2.cvtColor(reference, cv2.COLOR_RGB2GRAY).astype(np.float32)
        d, _ = semi_global_matching(cost, guide, labels)
        self.d = np.asarray(cv2.resize(d, self.reference.shape[::-1], interpolation=cv2.INTER_LINEAR), np.float32)
        log.info("sweep: %d views, %d labels", len(views), len(labels))

    def extent_of(self, views: NDArray[np.int64]) -> float:
        return float(max(np.linalg.norm(self.start.places[views], axis=1).max(), 1.0))

    def refine_cameras(
        self,
        views: NDArray[np.int64],
        count: int,
        rounds: int,
        *,
        pictures: NDArray[np.uint32] | None = None,
        tau: float = PLANAR_TAU_LEVELS,
        fixed: bool = True,
        buffers: NDArray[np.float32] | None = None,
    ) -> None:
        """Gauss-Newton of the first `count` parameters of each camera against the mean texture.

        Visibility is drawn once, or is that of `buffers`: the steps of a round hardly change it.
        """
        shown = self.subset(views, self.pictures if pictures is None else pictures)
        for _ in range(rounds):
            target = self.make_target(views, shown, count, buffers)
            buffers = target.buffers
            moved, self.error[views] = gauss_newton_step(self.model, views, self.parameters[views], target, count, tau)
            keep = self.parameters[self.centre].copy()
            self.parameters[views] = moved
            if fixed:
                self.parameters[self.centre] = keep
        self.fix_gauge(views)
        error = np.nanmedian(self.error[views])
        log.info("cameras: %d views, %d parameters, %.2f grey levels", len(views), count, error)

    def measure_errors(self, views: NDArray[np.int64]) -> None:
        """The error of each photograph against the mean texture, with unchanged cameras."""
        target = self.make_target(views, self.subset(views, self.pictures), ARRAY_PARAMETERS)
        fixed = self.parameters[views]
        _, self.error[views] = gauss_newton_step(self.model, views, fixed, target, 2, PLANAR_TAU_LEVELS)

    def fix_gauge(self, views: NDArray[np.int64]) -> None:
        """Remove the gauge freedom: shifts in proportion to positions are an offset of depth; the mean step is one."""
        if self.start.given:
            return  # the priors fix it
        p, s = self.parameters[views, ARRAY_POSITION], self.parameters[views, ARRAY_SHIFT]
        offset = (p * s).sum() / (p * p).sum()
        self.parameters[views, ARRAY_SHIFT] = s - offset * p
        planned = self.start.parameters[views, ARRAY_POSITION]
        scale = (p * planned).sum() / (planned * planned).sum()
        self.parameters[views, ARRAY_POSITION] = p / scale
        self.d = ((self.d - offset) * scale).astype(np.float32)
        self.low, self.high = (self.low - offset) * scale, (self.high - offset) * scale

    def refine_depth(
        self, views: NDArray[np.int64], step: float, smooth: float = PLANAR_SMOOTH_PIXELS
    ) -> NDArray[np.float32]:
        """Depth refined over `views`; returns the depth buffers that it had before."""
        pictures = self.subset(views, self.pictures)
        matrices, buffers = self.update_texture(views, pictures)
        apart = smooth / self.extent
        d, confidence = refine_depth(
            pictures, matrices, self.d, step / self.extent, buffers=buffers, texture=self.texture,
            bias=self.bias, depth_scale=apart,
        )  # fmt: skip
        half = PLANAR_HALF_CONFIDENCE * self.extent**2
        self.d = smooth_depth(d, confidence, self.texture, half_confidence=half, depth_scale=apart)
        self.extend(len(views))
        return buffers

    def extend(self, views: int) -> None:
        """Extrapolate depth outside the photographs' common part, where too few views look."""
        known = self.count >= max(2, PLANAR_MIN_DEPTH_VIEW_FRACTION * views)
        self.d = extend_depth(self.d, known, self.low, self.high)


def refine_planar(
    photographs: Pictures, start: PlanarStart, *, exact: bool = False, progress: Progress | None = None
) -> PlanarArray:
    """Estimate depth, and correct cameras unless they are exact.

    The result has near and far in the right order: if `start` does not know it, occlusion decides.

    Args:
        photographs: (n, H, W, 3) uint8, or packed.
        exact: Do not correct the cameras.
    """
    pictures = pack_pictures(photographs)
    joint = _JointRefinement(pictures, start)
    rings = _rings(start.places)
    total = len(rings) + len(PLANAR_DEPTH_STEP_PIXELS) + 1
    report = progress or (lambda stage, done, of: None)
    report("cameras and depth", 0, total)
    joint.sweep_depth(rings[0], 2.0)
    if not start.known_signs and _is_reversed(joint, rings[:2]):
        log.info("near and far are exchanged: the array runs the other way")
        joint = _JointRefinement(pictures, reverse_depth(start))
        joint.sweep_depth(rings[0], 2.0)
    if not exact:
        exact = not _correct_cameras(joint, rings, report, total)
    everything = np.arange(len(pictures))
    if exact:
        span = (joint.low, joint.high)
        joint.d = estimate_depth(pictures, joint.matrices(everything), joint.reference.shape, span)
        joint.update_texture(everything, pictures)
        joint.extend(len(pictures))
    joint.measure_errors(everything)
    report("cameras and depth", total, total)
    depth = joint.d, joint.texture, joint.count
    return PlanarArray(joint.model, joint.parameters, joint.reference, *depth, joint.error, not exact)


def _correct_cameras(joint: _JointRefinement, rings: Sequence[NDArray[np.int64]], report: Progress, total: int) -> bool:
    """Correct cameras and depth in alternation, from the inner rings outwards, then all together.

    False, and nothing changed, if the cameras already fit a regular grid or their calibration.
    """
    pictures = joint.pictures
    soft = np.stack(parallel_map(blurred, pictures))
    old: NDArray[np.int64] | None = None
    for number, views in enumerate(rings):
        if old is not None:
            _extrapolate(joint, old, np.setdiff1d(views, old))
        joint.refine_cameras(views, 4, 3, pictures=soft, tau=2 * PLANAR_TAU_LEVELS)
        joint.refine_cameras(views, 4, 2)
        joint.sweep_depth(_subsample(views), 2.0 if number == 0 else 1.0, outer=number > 0)
        joint.refine_cameras(views, 4, 2)
        if number == min(1, len(rings) - 1) and _is_regular(joint, views):
            return False
        joint.update_texture(views, joint.subset(views, pictures))
        joint.extend(len(views))
        old = views
        report("cameras and depth", number + 1, total)
    everything = np.arange(len(pictures))
    for number, step in enumerate(PLANAR_DEPTH_STEP_PIXELS):
        visible = joint.refine_depth(everything, step)
        count = 6 if number == 0 else ARRAY_PARAMETERS
        joint.refine_cameras(everything, count, 2, fixed=number == 0, buffers=visible)
        report("cameras and depth", len(rings) + number + 1, total)
    for step in PLANAR_LAST_DEPTH_STEP_PIXELS:
        joint.refine_depth(everything, step, PLANAR_LAST_SMOOTH_PIXELS)
    return True


def _is_regular(joint: _JointRefinement, views: NDArray[np.int64]) -> bool:
    """Whether refinement found nothing to correct in the cameras of `views`; their parameters are then restored."""
    moved = irregularity(joint.parameters, joint.start, views)
    log.info("cameras leave the %s by %.3f px", "calibration" if joint.start.given else "grid", moved)
    if moved >= PLANAR_REGULAR_PIXELS:
        return False
    joint.parameters[:] = joint.start.parameters
    return True


def _rings(places: NDArray[np.float64]) -> list[NDArray[np.int64]]:
    """Views within a quarter, half, three quarters and all of the array's extent, at least five in the first."""
    extent = np.abs(places).max(axis=0)
    distance = (np.abs(places) / np.where(extent > 0, extent, 1.0)).max(axis=1)
    rings: list[NDArray[np.int64]] = []
    for share in (0.25, 0.5, 0.75, 1.0):
        views = np.flatnonzero(distance <= share + 1e-6)
        if share == 1.0 or len(views) >= max(5, len(rings[-1]) + 1 if rings else 5):
            rings.append(views)
    return rings


def _subsample(views: NDArray[np.int64]) -> NDArray[np.int64]:
    """An evenly spread subset of many views: a sweep does not gain from more."""
    return views[:: -(-len(views) // PLANAR_SWEEP_MAX_VIEWS)]


def _extrapolate(joint: _JointRefinement, old: NDArray[np.int64], new: NDArray[np.int64]) -> None:
    """Start new cameras on the affine grid that the old ones fit."""
    if joint.start.given:
        return
    before, after = (np.hstack([joint.start.places[i], np.ones((len(i), 1))]) for i in (old, new))
    joint.parameters[new, :4] = after @ np.linalg.lstsq(before, joint.parameters[old, :4], rcond=None)[0]


def _is_reversed(joint: _JointRefinement, rings: Sequence[NDArray[np.int64]]) -> bool:
    """Whether the surface of smaller d occludes the other where two meet in one pixel of a view of these rings."""
    margin = joint.reference.margin
    height, width = joint.pictures.shape[1:3]
    inner = np.ascontiguousarray(joint.d[margin : margin + height, margin : margin + width])
    narrow = replace(joint.reference, camera=joint.model.reference, margin=0)
    reference = unpack_pictures(joint.pictures[joint.centre])
    larger = smaller = 0
    for number, ring in enumerate(rings):
        views = ring if number == 0 else np.setdiff1d(ring, rings[number - 1])
        views = views[views != joint.centre]
        views = views[:: max(1, len(views) // PLANAR_VOTE_MAX_VIEWS)]
        matrices = joint.model.matrices(narrow, views, joint.parameters[views])
        gap = PLANAR_VOTE_GAP_PIXELS / joint.extent_of(views)

        def votes(k: int, views=views, matrices=matrices, gap=gap) -> tuple[int, int]:  # type: ignore[no-untyped-def]
            near, far = np.full((height, width), -1, np.int64), np.full((height, width), -1, np.int64)
            picture = unpack_pictures(joint.pictures[views[k]])
            return occlusion_votes(picture, reference, matrices[k], inner, gap, PLANAR_VOTE_CONTRAST_LEVELS, near, far)

        counts = np.sum(parallel_map(votes, range(len(views))), axis=0)
        larger, smaller = larger + int(counts[0]), smaller + int(counts[1])
    log.info("occlusion: %d pixels say that larger disparities are nearer, %d the reverse", larger, smaller)
    voted = smaller > larger
    if max(larger, smaller) >= PLANAR_VOTE_CLEAR_RATIO * max(1, min(larger, smaller)):
        return voted
    ways = (joint.start, reverse_depth(joint.start))
    forward, backward = (_inner_error(joint.pictures, start, rings) for start in ways)
    log.info("remaining error: %.2f grey levels, with near and far exchanged %.2f", forward, backward)
    if (backward < forward) != voted:
        log.warning("occlusion hardly tells near from far: look at the result; name the photographs' own --format")
    return backward < forward


def _inner_error(pictures: NDArray[np.uint32], start: PlanarStart, rings: Sequence[NDArray[np.int64]]) -> float:
    """The remaining error of the photographs of `rings` after cameras and depth were corrected.

    Occluded points are left out, so that the wrong order of near and far leaves a larger error.
    """
    joint = _JointRefinement(pictures, start)
    joint.sweep_depth(rings[0], 2.0)
    joint.refine_cameras(rings[0], 4, 3)
    joint.sweep_depth(rings[0])
    for before, views in itertools.pairwise(rings):
        joint.refine_cameras(before, 4, 2)
        _extrapolate(joint, before, np.setdiff1d(views, before))
        joint.refine_cameras(views, 4, 2)
        joint.sweep_depth(views, outer=True)
    joint.refine_cameras(rings[-1], 4, 2)
    joint.measure_errors(rings[-1])
    return float(np.nanmean(joint.error[rings[-1]]))


def blurred(picture: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """A packed picture without its finest detail, in which cameras find their place from farther off."""
    soft = np.asarray(cv2.GaussianBlur(unpack_pictures(picture), (0, 0), 2.0), np.uint8)
    return np.asarray(pack_pictures(soft[None])[0] | (picture & OUTSIDE_PIXEL))


def _pad_to_reference(
    picture: NDArray[np.uint32], shape: tuple[int, int]
) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """The packed picture in the middle of the reference view with its edges replicated, and where it has pixels."""
    top, left = (shape[0] - picture.shape[0]) // 2, (shape[1] - picture.shape[1]) // 2
    bottom, right = shape[0] - picture.shape[0] - top, shape[1] - picture.shape[1] - left
    known = np.zeros(shape, np.bool_)
    known[top : top + picture.shape[0], left : left + picture.shape[1]] = inside_pictures(picture[None])[0]
    drawn_out = cv2.copyMakeBorder(unpack_pictures(picture), top, bottom, left, right, cv2.BORDER_REPLICATE)
    return np.asarray(drawn_out, np.uint8), known
