"""Cameras and depth of a planar array corrected together, by photo-consistency.

A nominal grid is never exact, and depth from inexact cameras is blurred. Both are found in turn: the mean texture over
all views that see a point is what every photograph should show there, and each camera is moved until it does
(Gauss-Newton); then the depths are searched anew. The array is grown from its centre, where disparities are small.
"""

from __future__ import annotations

import itertools
import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.planar.array import PARAMETERS, POSITION, SHIFT, ArrayModel
from eigenfield.calibrate.planar.fit import Sight, camera_step, textured_points
from eigenfield.calibrate.planar.kernels import occlusion_votes
from eigenfield.calibrate.planar.start import PlanarStart, irregularity, reversed_start
from eigenfield.core.camera import Camera
from eigenfield.core.progress import Progress
from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo.estimate import estimate_depth
from eigenfield.stereo.extend import extend_depth
from eigenfield.stereo.reference_view import ReferenceView
from eigenfield.stereo.refine import refine_depth
from eigenfield.stereo.semiglobal import semi_global_matching
from eigenfield.stereo.smooth import smooth_depth
from eigenfield.stereo.sweep import SWEEP_MAX_DIFFERENCE_LEVELS, plane_sweep
from eigenfield.stereo.views import HALF_FROM_FULL_INDEX, halve_pictures, pack_pictures, unpack_pictures
from eigenfield.stereo.visibility import depth_buffers, mean_texture

log = logging.getLogger("eigenfield.calibrate")

SEEN = 0.15  # of the views must see a point
TAU = 15.0  # grey levels: residuals beyond count less (Cauchy)
BIAS = 0.96  # pixels at the outermost camera by which a buffer may hide a point
SWEEP_STEP = 1.2  # pixels at the outermost camera between two labels
SMOOTH = 1.2  # pixels at the outermost camera within which neighbours are one surface
FINE = 0.6  # likewise, in the last rounds
SURE = 2.7  # squared grey levels per squared pixel there: curvature of the cost that makes a depth half sure
DEPTH_STEPS = (0.64, 0.48, 0.48, 0.32, 0.24)  # likewise, of the rounds of refinement
LAST_STEPS = (0.24, 0.16)  # and of those after the cameras are done
REGULAR = 0.1  # pixels: cameras this close to a regular grid, or to their calibration, are left as they are
LOOKING = 0.02  # of the views must see a point for its depth to be its own
SWEPT = 90  # views of a plane sweep
VOTERS = 12  # views of a ring that vote on which side is near
VOTE_GAP = 4.0  # pixels in the outermost voter between two surfaces
VOTE_CONTRAST = 8.0  # grey levels between them
VOTE_CLEAR = 1.5  # ratio of the votes; below it both ways are tried


@dataclass(frozen=True, eq=False)
class Planar:
    """A refined planar array.

    model, parameters: the cameras.
    canvas, d, confidence, texture, count: depth seen from the centre (see `stereo`). low, high: the range of d.
    error: (n,) root mean square difference of each photograph from the mean texture, grey levels, at textured points.
    refined: whether positions were corrected; False where a regular grid is as good.
    """

    model: ArrayModel
    parameters: NDArray[np.float64]
    canvas: ReferenceView
    d: NDArray[np.float32]
    confidence: NDArray[np.float32]
    texture: NDArray[np.float32]
    count: NDArray[np.int32]
    error: NDArray[np.float64]
    low: float
    high: float
    refined: bool


class _Joint:
    """What the steps change: the parameters of all cameras and the depth map of the canvas."""

    def __init__(self, pictures: NDArray[np.uint32], start: PlanarStart) -> None:
        self.pictures = pictures
        self.start = start
        self.model = start.model
        self.parameters = start.parameters.copy()
        self.centre = start.centre
        self.low, self.high = start.low, start.high
        self.reach = self.reach_of(np.arange(len(pictures)))
        side = np.abs(start.places).max()
        margin = int(np.ceil(side * max(abs(start.low), abs(start.high)) / 8)) * 8 + 8
        self.canvas = self.model.canvas(margin)
        self.half = halve_pictures(pictures)
        shape = self.canvas.shape
        self.d = np.zeros(shape, np.float32)
        self.confidence = np.zeros(shape, np.float32)
        self.texture = np.zeros((*shape, 3), np.float32)
        self.count = np.zeros(shape, np.int32)
        self.error = np.full(len(pictures), np.nan)
        self._buffers: NDArray[np.float32] | None = None

    def chosen(self, views: NDArray[np.int64], pictures: NDArray[np.uint32]) -> NDArray[np.uint32]:
        """A copy only where it is not all of them."""
        return pictures if len(views) == len(pictures) else pictures[views]

    def matrices(self, views: NDArray[np.int64]) -> NDArray[np.float64]:
        return self.model.matrices(self.canvas, views, self.parameters[views])

    def look(
        self, views: NDArray[np.int64], pictures: NDArray[np.uint32]
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        """Visibility and mean texture over `views`, from the present cameras and depth."""
        matrices = self.matrices(views)
        height, width = pictures.shape[1:3]
        if self._buffers is None or len(self._buffers) != len(views):
            self._buffers = None
            self._buffers = np.zeros((len(views), height, width), np.float32)
        buffers = depth_buffers(matrices, self.d, (height, width), out=self._buffers)
        self.texture, self.count = mean_texture(pictures, matrices, self.d, buffers, BIAS / self.reach)
        return matrices, buffers

    def first_depth(self, views: NDArray[np.int64], coarser: float = 1.0) -> None:
        """Plane sweep at half resolution and semi-global optimisation."""
        small = self.canvas.halved()
        matrices = HALF_FROM_FULL_INDEX @ self.model.matrices(small, views, self.parameters[views])
        step = min(coarser * SWEEP_STEP / self.reach_of(views), (self.high - self.low) / 64)
        labels = np.arange(self.low, self.high + step, step, dtype=np.float32)
        reference, known = _framed(unpack_pictures(self.half[self.centre]), small.shape)
        cost = plane_sweep(
            self.half[views],
            matrices,
            small.shape,
            labels,
            reference=reference,
            known=known,
            unseen_cost=SWEEP_MAX_DIFFERENCE_LEVELS,
        )
        guide = cv2.cvtColor(reference, cv2.COLOR_RGB2GRAY).astype(np.float32)
        d, _ = semi_global_matching(cost, guide, labels)
        self.d = np.asarray(cv2.resize(d, self.canvas.shape[::-1], interpolation=cv2.INTER_LINEAR), np.float32)
        log.info("sweep: %d views, %d labels", len(views), len(labels))

    def reach_of(self, views: NDArray[np.int64]) -> float:
        return float(max(np.linalg.norm(self.start.places[views], axis=1).max(), 1.0))

    def move_cameras(
        self,
        views: NDArray[np.int64],
        count: int,
        rounds: int,
        *,
        pictures: NDArray[np.uint32] | None = None,
        tau: float = TAU,
        fixed: bool = True,
    ) -> None:
        """Gauss-Newton of the first `count` parameters of each camera against the mean texture."""
        shown = self.chosen(views, self.pictures if pictures is None else pictures)
        for _ in range(rounds):
            _, buffers = self.look(views, shown)
            points = textured_points(self.d, self.texture, self.count > max(2, SEEN * len(views)))
            sight = Sight(self.canvas, shown, buffers, *points, BIAS / self.reach)
            moved, self.error[views] = camera_step(self.model, views, self.parameters[views], sight, count, tau)
            keep = self.parameters[self.centre].copy()
            self.parameters[views] = moved
            if fixed:
                self.parameters[self.centre] = keep
        self.fix_gauge(views)
        error = np.nanmedian(self.error[views])
        log.info("cameras: %d views, %d parameters, %.2f grey levels", len(views), count, error)

    def measure(self, views: NDArray[np.int64]) -> None:
        """How far each photograph is from the mean texture, cameras as they are."""
        pictures = self.chosen(views, self.pictures)
        _, buffers = self.look(views, pictures)
        points = textured_points(self.d, self.texture, self.count > max(2, SEEN * len(views)))
        sight = Sight(self.canvas, pictures, buffers, *points, BIAS / self.reach)
        _, self.error[views] = camera_step(self.model, views, self.parameters[views], sight, 2, TAU)

    def fix_gauge(self, views: NDArray[np.int64]) -> None:
        """Shifts in proportion to positions are an offset of depth; the mean step is one."""
        if self.start.given:
            return  # the priors hold it
        p, s = self.parameters[views, POSITION], self.parameters[views, SHIFT]
        offset = (p * s).sum() / (p * p).sum()
        self.parameters[views, SHIFT] = s - offset * p
        planned = self.start.parameters[views, POSITION]
        scale = (p * planned).sum() / (planned * planned).sum()
        self.parameters[views, POSITION] = p / scale
        self.d = ((self.d - offset) * scale).astype(np.float32)
        self.low, self.high = (self.low - offset) * scale, (self.high - offset) * scale

    def refine_depth(self, views: NDArray[np.int64], step: float, smooth: float = SMOOTH) -> None:
        pictures = self.chosen(views, self.pictures)
        matrices, buffers = self.look(views, pictures)
        apart = smooth / self.reach
        d, confidence = refine_depth(
            pictures, matrices, self.d, step / self.reach, buffers=buffers, texture=self.texture,
            bias=BIAS / self.reach, depth_scale=apart,
        )  # fmt: skip
        half = SURE * self.reach**2
        self.d, self.confidence = (
            smooth_depth(d, confidence, self.texture, half_confidence=half, depth_scale=apart),
            confidence,
        )
        self.extend(len(views))

    def extend(self, views: int) -> None:
        """Outside the photographs' common part, where (too) few look, depth is drawn on from inside."""
        self.d = extend_depth(self.d, self.count >= max(2, LOOKING * views), self.low, self.high)


def refine_planar(
    photographs: NDArray[np.uint8], start: PlanarStart, *, exact: bool = False, progress: Progress | None = None
) -> Planar:
    """Estimate depth, and correct cameras unless they are `exact`.

    photographs: (n, H, W, 3). The result has near and far the right way round: where `start` does not know, occlusion
    decides.
    """
    pictures = pack_pictures(photographs)
    joint = _Joint(pictures, start)
    rings = _rings(start.places)
    total = len(rings) + len(DEPTH_STEPS) + 1
    report = progress or (lambda stage, done, of: None)
    report("cameras and depth", 0, total)
    joint.first_depth(rings[0], 2.0)
    if not start.known_signs and _is_reversed(joint, rings[:2]):
        log.info("near and far are exchanged: the array runs the other way")
        joint = _Joint(pictures, reversed_start(start))
        joint.first_depth(rings[0], 2.0)
    if not exact:
        exact = not _correct(joint, rings, report, total)
    everything = np.arange(len(pictures))
    if exact:
        depth = estimate_depth(pictures, joint.matrices(everything), joint.canvas.shape, (joint.low, joint.high))
        joint.d, joint.confidence = depth.d, depth.confidence
        joint.look(everything, pictures)
        joint.extend(len(pictures))
    joint.measure(everything)
    report("cameras and depth", total, total)
    return Planar(
        joint.model, joint.parameters, joint.canvas, joint.d, joint.confidence, joint.texture, joint.count,
        joint.error, joint.low, joint.high, not exact,
    )  # fmt: skip


def _correct(joint: _Joint, rings: Sequence[NDArray[np.int64]], report: Progress, total: int) -> bool:
    """Correct cameras and depth in turn, from the inner rings outwards, then all together.

    False, and nothing done, where the cameras are a regular grid's or their calibration's.
    """
    pictures = joint.pictures
    blurred = np.stack(parallel_map(_blurred, pictures))
    old: NDArray[np.int64] | None = None
    for number, views in enumerate(rings):
        if old is not None:
            _extrapolate(joint, old, np.setdiff1d(views, old))
        joint.move_cameras(views, 4, 3, pictures=blurred, tau=2 * TAU)
        joint.move_cameras(views, 4, 2)
        joint.first_depth(_thinned(views), 2.0 if number == 0 else 1.0)
        joint.move_cameras(views, 4, 2)
        if number == min(1, len(rings) - 1) and _is_regular(joint, views):
            return False
        joint.look(views, joint.chosen(views, pictures))
        joint.extend(len(views))
        old = views
        report("cameras and depth", number + 1, total)
    everything = np.arange(len(pictures))
    for number, step in enumerate(DEPTH_STEPS):
        joint.refine_depth(everything, step)
        joint.move_cameras(everything, 6 if number == 0 else PARAMETERS, 2, fixed=number == 0)
        report("cameras and depth", len(rings) + number + 1, total)
    for step in LAST_STEPS:
        joint.refine_depth(everything, step, FINE)
    return True


def _is_regular(joint: _Joint, views: NDArray[np.int64]) -> bool:
    """Whether correcting the cameras of `views` found nothing to correct; then they are put back."""
    moved = irregularity(joint.parameters, joint.start, views)
    log.info("cameras leave the %s by %.3f px", "calibration" if joint.start.given else "grid", moved)
    if moved >= REGULAR:
        return False
    joint.parameters[:] = joint.start.parameters
    return True


def register_views(
    planar: Planar,
    known: NDArray[np.int64],
    photographs: NDArray[np.uint8],
    new: NDArray[np.int64],
    positions: NDArray[np.float64],
    bases: Sequence[Camera] | None = None,
) -> Planar:
    """The array with views that took no part in it, each fitted to its texture and depth by its own photograph alone.

    known, new: indices of the array's views and of the others among all n. photographs: (len(new), H, W, 3).
    positions: (n, 2) of all views, any unit: new cameras start on the affine grid of the known. bases: of all n, where
    cameras were given.
    """
    before, after = (np.hstack([positions[i], np.ones((len(i), 1))]) for i in (known, new))
    parameters = np.zeros((len(positions), PARAMETERS))
    parameters[known] = planar.parameters
    parameters[new, :4] = after @ np.linalg.lstsq(before, planar.parameters[:, :4], rcond=None)[0]
    model = replace(planar.model, bases=tuple(bases or planar.model.bases[:1] * len(positions)))
    error = np.full(len(positions), np.nan)
    error[known] = planar.error
    sharp = pack_pictures(photographs)
    soft = np.stack(parallel_map(_blurred, sharp))
    reach = max(1.0, float(np.linalg.norm(planar.parameters[:, POSITION], axis=1).max()))
    points = textured_points(planar.d, planar.texture, planar.count > max(2, SEEN * len(known)))
    for pictures, count, tau, rounds in ((soft, 4, 2 * TAU, 3), (sharp, 4, TAU, 2), (sharp, PARAMETERS, TAU, 3)):
        for _ in range(rounds):
            matrices = model.matrices(planar.canvas, new, parameters[new])
            buffers = depth_buffers(matrices, planar.d, pictures.shape[1:3])
            sight = Sight(planar.canvas, pictures, buffers, *points, BIAS / reach)
            parameters[new], error[new] = camera_step(model, new, parameters[new], sight, count, tau)
    return replace(planar, model=model, parameters=parameters, error=error)


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


def _thinned(views: NDArray[np.int64]) -> NDArray[np.int64]:
    """Of many views an evenly spread part: a sweep does not gain from more."""
    return views[:: -(-len(views) // SWEPT)]


def _extrapolate(joint: _Joint, old: NDArray[np.int64], new: NDArray[np.int64]) -> None:
    """New cameras start on the affine grid that the old ones fit."""
    if joint.start.given:
        return
    before, after = (np.hstack([joint.start.places[i], np.ones((len(i), 1))]) for i in (old, new))
    joint.parameters[new, :4] = after @ np.linalg.lstsq(before, joint.parameters[old, :4], rcond=None)[0]


def _is_reversed(joint: _Joint, rings: Sequence[NDArray[np.int64]]) -> bool:
    """Whether the surface of smaller d is what shows where two meet in one pixel of a view of these rings."""
    margin = joint.canvas.margin
    height, width = joint.pictures.shape[1:3]
    inner = np.ascontiguousarray(joint.d[margin : margin + height, margin : margin + width])
    narrow = replace(joint.canvas, camera=joint.model.reference, margin=0)
    reference = unpack_pictures(joint.pictures[joint.centre])
    larger = smaller = 0
    for number, ring in enumerate(rings):
        views = ring if number == 0 else np.setdiff1d(ring, rings[number - 1])
        views = views[views != joint.centre]
        views = views[:: max(1, len(views) // VOTERS)]
        matrices = joint.model.matrices(narrow, views, joint.parameters[views])
        gap = VOTE_GAP / joint.reach_of(views)

        def votes(k: int, views=views, matrices=matrices, gap=gap) -> tuple[int, int]:  # type: ignore[no-untyped-def]
            near, far = np.full((height, width), -1, np.int64), np.full((height, width), -1, np.int64)
            picture = unpack_pictures(joint.pictures[views[k]])
            return occlusion_votes(picture, reference, matrices[k], inner, gap, VOTE_CONTRAST, near, far)

        counts = np.sum(parallel_map(votes, range(len(views))), axis=0)
        larger, smaller = larger + int(counts[0]), smaller + int(counts[1])
    log.info("occlusion: %d pixels say that larger disparities are nearer, %d the reverse", larger, smaller)
    voted = smaller > larger
    if max(larger, smaller) >= VOTE_CLEAR * max(1, min(larger, smaller)):
        return voted
    ways = (joint.start, reversed_start(joint.start))
    forward, backward = (_inner_error(joint.pictures, start, rings) for start in ways)
    log.info("grey levels that are left over: %.2f, with near and far exchanged %.2f", forward, backward)
    if (backward < forward) != voted:
        log.warning("occlusion hardly tells near from far: look at the result; name the photographs' own --format")
    return backward < forward


def _inner_error(pictures: NDArray[np.uint32], start: PlanarStart, rings: Sequence[NDArray[np.int64]]) -> float:
    """How far the photographs of `rings` stay from their mean texture once cameras and depth were corrected: occluded
    points are left out, so that the wrong order of near and far leaves more."""
    joint = _Joint(pictures, start)
    joint.first_depth(rings[0], 2.0)
    joint.move_cameras(rings[0], 4, 3)
    joint.first_depth(rings[0])
    for before, views in itertools.pairwise(rings):
        joint.move_cameras(before, 4, 2)
        _extrapolate(joint, before, np.setdiff1d(views, before))
        joint.move_cameras(views, 4, 2)
        joint.first_depth(views)
    joint.move_cameras(rings[-1], 4, 2)
    joint.measure(rings[-1])
    return float(np.nanmean(joint.error[rings[-1]]))


def _blurred(picture: NDArray[np.uint32]) -> NDArray[np.uint32]:
    return pack_pictures(np.asarray(cv2.GaussianBlur(unpack_pictures(picture), (0, 0), 2.0), np.uint8)[None])[0]


def _framed(picture: NDArray[np.uint8], shape: tuple[int, int]) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
    """The picture in the middle of a canvas, its edges drawn out, and where it is itself."""
    top, left = (shape[0] - picture.shape[0]) // 2, (shape[1] - picture.shape[1]) // 2
    bottom, right = shape[0] - picture.shape[0] - top, shape[1] - picture.shape[1] - left
    known = np.zeros(shape, np.bool_)
    known[top : top + picture.shape[0], left : left + picture.shape[1]] = True
    drawn_out = cv2.copyMakeBorder(picture, top, bottom, left, right, cv2.BORDER_REPLICATE)
    return np.asarray(drawn_out, np.uint8), known
