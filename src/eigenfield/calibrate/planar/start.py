"""Where a planar array's cameras stood, from their names and the photographs, before anything is refined."""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibrate.planar.array import GIVEN, PARAMETERS, POSITION, SHIFT, ArrayModel
from eigenfield.calibrate.planar.parallax import Parallax, measure_parallax
from eigenfield.calibrate.planar.tracks import Tracks, find_tracks
from eigenfield.capture.layout import Layout
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError
from eigenfield.core.viewplane import fit_view_plane

log = logging.getLogger("eigenfield.calibrate")

NOMINAL_ANGLE = math.radians(50)  # field of view of the longer side where nothing says the focal length
DISTANCES = (1, 2, 4)  # steps from the central camera at which views are searched for its points
STILL = 0.05  # pixels between photographs, which noise and compression alone move points by
AGREEING = 0.4  # share of the tracked points that must move as a grid
WIDENED = 0.12  # of the range of disparities, on both sides
SWAPPED = 0.5  # |sine| of the angle between an index's motion and its axis that cannot be a rolled camera


@dataclass(frozen=True, eq=False)
class PlanarStart:
    """A planar array before refinement.

    model, parameters: the cameras, (n, 10).
    places: (n, 2) their positions in steps from the central one, x right, y down. centre: its index.
    low, high: the range of disparities. known_signs: False where places and disparities may both be reversed.
    given: the cameras are a calibration's, not a regular grid's. exchanged: the names gave the column first, and rows
    and columns of the layout are exchanged in all this.
    """

    model: ArrayModel
    parameters: NDArray[np.float64]
    places: NDArray[np.float64]
    centre: int
    low: float
    high: float
    known_signs: bool
    given: bool = False
    exchanged: bool = False


def start_planar(
    pictures: Sequence[NDArray[np.uint8]] | NDArray[np.uint8], layout: Layout, names: Sequence[str]
) -> PlanarStart:
    """Estimate spacing, direction and disparities of a planar array from points tracked round its centre.

    Names that say which number is the row only by custom may have them in either order: the one that the points follow
    is taken. pictures: n of (H, W, 3), one size. Raises CaptureError: `grid-texture` (too few points), `grid-still`
    (points do not move at all), `grid-motion` (they do not move as the grid says), `grid-swapped` (rows are columns).
    """
    try:
        return _start_planar(pictures, layout, names)
    except CaptureError as error:
        if error.code not in ("grid-motion", "grid-swapped") or layout.measured or layout.signs:
            raise
        try:
            start = _start_planar(pictures, layout.exchanged(), names)
        except CaptureError:
            raise error from None
    log.warning("the photographs move as if the names gave the column first, then the row: taken so")
    return replace(start, exchanged=True)


def _start_planar(
    pictures: Sequence[NDArray[np.uint8]] | NDArray[np.uint8], layout: Layout, names: Sequence[str]
) -> PlanarStart:
    nominal = nominal_positions(layout)
    centre = int(np.argmin(np.linalg.norm(nominal - (nominal.min(axis=0) + nominal.max(axis=0)) / 2, axis=1)))
    nominal = nominal - nominal[centre]
    chosen = _around(layout, centre)
    tracks = find_tracks([pictures[i] for i in chosen], chosen.index(centre))
    moved = np.isfinite(tracks.found[..., 0]).sum(axis=0) > 2
    if moved.sum() < 30:
        raise CaptureError(
            "grid-texture",
            f"only {int(moved.sum())} points of {names[centre]} are found again in the photographs around it",
            remedy="sharp photographs with texture are needed; check that they show one scene",
        )
    _refuse_still(tracks, names[centre])
    parallax = measure_parallax(tracks, nominal[chosen])
    if parallax is None or parallax.support < AGREEING * moved.sum():
        agreeing = 0 if parallax is None else parallax.support
        raise CaptureError(
            "grid-motion",
            f"the photographs do not move as a grid of {len(set(layout.rows))} rows and {len(set(layout.columns))} "
            f"columns does: {agreeing} of {int(moved.sum())} points agree",
            remedy=f"check --grid and --format, and that {names[centre]} is of the scene; hand-held photographs need "
            "eigenfield calibrate",
        )
    _refuse_swapped(parallax, names[centre])
    low, high = _disparity_range(parallax)
    height, width = pictures[centre].shape[:2]
    model = _model(layout, len(pictures), width, height, low, high)
    parameters = np.zeros((len(pictures), PARAMETERS))
    # a rendered grid is what it says
    parameters[:, POSITION] = nominal if layout.exact else nominal @ parallax.steps.T
    log.info(
        "planar array: a row is %.3f of a column, disparities %.2f to %.2f px a step, %d points, residual %.2f px",
        abs(parallax.steps[1, 1]), low, high, parallax.support, parallax.residual,
    )  # fmt: skip
    return PlanarStart(model, parameters, parameters[:, POSITION].copy(), centre, low, high, layout.signs)


def _refuse_still(tracks: Tracks, name: str) -> None:
    motion = np.linalg.norm(tracks.found - tracks.points, axis=-1)
    if np.nanpercentile(motion, 90) < STILL:
        raise CaptureError(
            "grid-still",
            f"the points of {name} stay where they are in the photographs around it: the camera did not move",
            remedy="photographs from different places are needed; look for copies of one",
        )


def nominal_positions(layout: Layout) -> NDArray[np.float64]:
    """(n, 2) positions in steps, x right, y DOWN: one step is the median distance of neighbouring columns."""
    places = layout.positions * np.array([1.0, -1.0])
    if layout.measured:
        return places / _step(places, layout)
    steps = np.array([_spacing(places[:, axis]) for axis in (0, 1)])
    return places / steps


def _spacing(values: NDArray[np.float64]) -> float:
    gaps = np.diff(np.unique(values))
    return float(np.median(gaps)) if gaps.size else 1.0


def _step(places: NDArray[np.float64], layout: Layout) -> float:
    for index, axis in ((layout.columns, 0), (layout.rows, 1)):
        nodes = np.unique(index)
        if len(nodes) > 1:
            means = np.array([places[index == node, axis].mean() for node in nodes])
            return float(np.median(np.abs(np.diff(means))))
    return 1.0


def _around(layout: Layout, centre: int) -> list[int]:
    """Views of the eight directions round the central node, at DISTANCES nodes."""
    rows = np.searchsorted(np.unique(layout.rows), layout.rows)
    columns = np.searchsorted(np.unique(layout.columns), layout.columns)
    dr, dc = np.abs(rows - rows[centre]), np.abs(columns - columns[centre])
    ring = np.maximum(dr, dc)
    straight = (dr == 0) | (dc == 0) | (dr == dc)
    return [int(i) for i in np.flatnonzero((ring == 0) | (straight & np.isin(ring, DISTANCES)))]


def _refuse_swapped(parallax: Parallax, name: str) -> None:
    steps = parallax.steps / np.maximum(np.linalg.norm(parallax.steps, axis=0), 1e-12)
    if max(abs(steps[1, 0]), abs(steps[0, 1])) > SWAPPED:
        raise CaptureError(
            "grid-swapped",
            f"points of {name} move up or down along a row and sideways along a column",
            remedy="rows and columns are exchanged: name the right --format or --grid, or rename the photographs",
        )


def _disparity_range(parallax: Parallax) -> tuple[float, float]:
    d = parallax.disparity[np.isfinite(parallax.disparity)]
    low, high = np.percentile(d, [0.5, 99.5])
    spread = max(float(high - low), 0.2)
    return float(low - WIDENED * spread), float(high + WIDENED * spread)


def _model(layout: Layout, count: int, width: int, height: int, low: float, high: float) -> ArrayModel:
    """Intrinsics and the meaning of disparity; a frame in which all depths are positive and moderate, where neither
    focal length nor distance are known (any such frame draws the same pictures)."""
    focal = layout.focal or max(width, height) / 2 / math.tan(NOMINAL_ANGLE / 2)
    return ArrayModel.planar(count, width, height, focal, 1.0, 1 / (2.0 * max(abs(low), abs(high))))


def start_given(cameras: Sequence[Camera], low: float, high: float) -> PlanarStart:
    """An array whose cameras are known: depth is seen from the one nearest the middle.

    low, high: the range of inverse depths there, 1 / world units. Disparities are those of one step, the median
    distance to the nearest other camera.
    """
    centres = np.array([camera.centre for camera in cameras])
    plane = fit_view_plane(cameras)
    centre = int(np.argmin(np.linalg.norm(plane.coordinates(centres), axis=1)))
    reference = cameras[centre]
    apart = np.linalg.norm(centres[:, None] - centres[None], axis=-1)
    np.fill_diagonal(apart, np.inf)
    near = apart.min(axis=1)
    step = float(np.median(near[near > 1e-6 * np.ptp(centres, axis=0).max()]))
    places = ((centres - reference.centre) @ reference.R.T)[:, :2] / step
    scale = 1 / (float(np.sqrt(reference.K[0, 0] * reference.K[1, 1])) * step)
    distance = 2 / (low + high)
    anchor = reference.centre + reference.R[2] * distance
    model = ArrayModel(tuple(cameras), reference, anchor, step, distance, 0.0, scale, GIVEN)
    return PlanarStart(
        model, np.zeros((len(cameras), PARAMETERS)), places, centre, low / scale, high / scale, True, True
    )


def reversed_start(start: PlanarStart) -> PlanarStart:
    """The same motion with near and far exchanged."""
    parameters = start.parameters.copy()
    parameters[:, POSITION] *= -1
    return replace(start, parameters=parameters, places=-start.places, low=-start.high, high=-start.low)


def irregularity(parameters: NDArray[np.float64], start: PlanarStart, views: NDArray[np.int64]) -> float:
    """By how many pixels, root mean square over `views`, refined positions and shifts move points at the ends of the
    range of disparities away from a regular grid, or from the given calibration."""
    left = parameters[views, :4]
    if not start.given:
        design = np.hstack([start.places[views], np.ones((len(views), 1))])
        left = left - design @ np.linalg.lstsq(design, left, rcond=None)[0]
    reach = (start.high - start.low) / 2
    places, shifts = (left[:, part] ** 2 for part in (POSITION, SHIFT))
    return math.sqrt(float(places.sum(axis=1).mean()) * reach**2 + float(shifts.sum(axis=1).mean()))
