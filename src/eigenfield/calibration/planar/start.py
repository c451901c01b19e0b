"""The initial cameras of a planar array, from the names and the photographs, before refinement."""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from eigenfield.calibration.planar.array import (
    ARRAY_GIVEN_SIGMA,
    ARRAY_PARAMETERS,
    ARRAY_POSITION,
    ARRAY_SHIFT,
    ArrayModel,
)
from eigenfield.calibration.planar.parallax import Parallax, measure_parallax
from eigenfield.calibration.planar.tracks import Tracks, find_tracks
from eigenfield.capture.layout import GridLayout
from eigenfield.core.camera import Camera
from eigenfield.core.errors import CaptureError
from eigenfield.core.viewplane import fit_view_plane

log = logging.getLogger("eigenfield.calibration")

START_NOMINAL_ANGLE_RADIANS = math.radians(50)  # field of view of the longer side if no focal length is known
START_TRACK_DISTANCES_STEPS = (1, 2, 4)  # from the central camera to the views that are searched for its points
START_STILL_PIXELS = 0.05  # noise and compression alone move points this far
START_MIN_AGREEING_FRACTION = 0.4  # tracked points that must move as the grid says
START_RANGE_MARGIN_FRACTION = 0.12  # added to the range of disparities on both sides
START_SWAPPED_SINE = 0.5  # |sine| of the angle between an index's motion and its axis: larger is no camera roll


@dataclass(frozen=True, eq=False)
class PlanarStart:
    """A planar array before refinement.

    Attributes:
        parameters: (n, 10) of the cameras.
        places: (n, 2) positions in steps from the central camera, x right, y down.
        centre: Index of the central camera.
        known_signs: False if positions and disparities may both be negated.
        given: The cameras are a calibration's, not a regular grid's.
        exchanged: The names gave the column first, so that rows and columns of the layout are swapped here.
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
    pictures: Sequence[NDArray[np.uint8]] | NDArray[np.uint8], layout: GridLayout, names: Sequence[str]
) -> PlanarStart:
    """Estimate spacing, direction and disparities of a planar array from points tracked around its centre.

    If only custom says which number in a name is the row, either order is possible; the one that the points follow is
    taken.

    Args:
        pictures: n of (H, W, 3), one size.

    Raises:
        CaptureError: `grid-texture`: too few points. `grid-still`: the points do not move. `grid-motion`: they do not
            move as the grid says. `grid-swapped`: rows are columns.
    """
    try:
        return _estimate_start(pictures, layout, names)
    except CaptureError as error:
        if error.code not in ("grid-motion", "grid-swapped") or layout.measured or layout.signs:
            raise
        try:
            start = _estimate_start(pictures, layout.transpose(), names)
        except CaptureError:
            raise error from None
    log.warning("the photographs move as if the names gave the column first, then the row: taken so")
    return replace(start, exchanged=True)


def _estimate_start(
    pictures: Sequence[NDArray[np.uint8]] | NDArray[np.uint8], layout: GridLayout, names: Sequence[str]
) -> PlanarStart:
    nominal = nominal_positions(layout)
    centre = int(np.argmin(np.linalg.norm(nominal - (nominal.min(axis=0) + nominal.max(axis=0)) / 2, axis=1)))
    nominal = nominal - nominal[centre]
    chosen = _views_around(layout, centre)
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
    if parallax is None or parallax.support < START_MIN_AGREEING_FRACTION * moved.sum():
        agreeing = 0 if parallax is None else parallax.support
        raise CaptureError(
            "grid-motion",
            f"the photographs do not move as a grid of {len(set(layout.rows))} rows and {len(set(layout.columns))} "
            f"columns does: {agreeing} of {int(moved.sum())} points agree",
            remedy=f"check --grid and --format, and that {names[centre]} is of the scene; hand-held photographs need "
            "`eigenfield calibrate CAPTURE`",
        )
    _refuse_swapped(parallax, names[centre])
    low, high = _disparity_range(parallax)
    height, width = pictures[centre].shape[:2]
    model = _array_model(layout, len(pictures), width, height, low, high)
    parameters = np.zeros((len(pictures), ARRAY_PARAMETERS))
    # a rendered grid is exact
    parameters[:, ARRAY_POSITION] = nominal if layout.exact else nominal @ parallax.steps.T
    log.info(
        "planar array: a row is %.3f of a column, disparities %.2f to %.2f px a step, %d points, residual %.2f px",
        abs(parallax.steps[1, 1]), low, high, parallax.support, parallax.residual,
    )  # fmt: skip
    return PlanarStart(model, parameters, parameters[:, ARRAY_POSITION].copy(), centre, low, high, layout.signs)


def _refuse_still(tracks: Tracks, name: str) -> None:
    motion = np.linalg.norm(tracks.found - tracks.points, axis=-1)
    if np.nanpercentile(motion, 90) < START_STILL_PIXELS:
        raise CaptureError(
            "grid-still",
            f"the points of {name} stay where they are in the photographs around it: the camera did not move",
            remedy="photographs from different places are needed; look for copies of one",
        )


def nominal_positions(layout: GridLayout) -> NDArray[np.float64]:
    """(n, 2) positions in steps, x right, y DOWN; one step is the median distance of neighbouring columns."""
    places = layout.positions * np.array([1.0, -1.0])
    if layout.measured:
        return places / _median_step(places, layout)
    steps = np.array([_median_spacing(places[:, axis]) for axis in (0, 1)])
    return places / steps


def _median_spacing(values: NDArray[np.float64]) -> float:
    gaps = np.diff(np.unique(values))
    return float(np.median(gaps)) if gaps.size else 1.0


def _median_step(places: NDArray[np.float64], layout: GridLayout) -> float:
    for index, axis in ((layout.columns, 0), (layout.rows, 1)):
        nodes = np.unique(index)
        if len(nodes) > 1:
            means = np.array([places[index == node, axis].mean() for node in nodes])
            return float(np.median(np.abs(np.diff(means))))
    return 1.0


def _views_around(layout: GridLayout, centre: int) -> list[int]:
    """Views in the eight directions around the central node, at START_TRACK_DISTANCES_STEPS nodes."""
    rows = np.searchsorted(np.unique(layout.rows), layout.rows)
    columns = np.searchsorted(np.unique(layout.columns), layout.columns)
    dr, dc = np.abs(rows - rows[centre]), np.abs(columns - columns[centre])
    ring = np.maximum(dr, dc)
    straight = (dr == 0) | (dc == 0) | (dr == dc)
    return [int(i) for i in np.flatnonzero((ring == 0) | (straight & np.isin(ring, START_TRACK_DISTANCES_STEPS)))]


def _refuse_swapped(parallax: Parallax, name: str) -> None:
    steps = parallax.steps / np.maximum(np.linalg.norm(parallax.steps, axis=0), 1e-12)
    if max(abs(steps[1, 0]), abs(steps[0, 1])) > START_SWAPPED_SINE:
        raise CaptureError(
            "grid-swapped",
            f"points of {name} move up or down along a row and sideways along a column",
            remedy="rows and columns are exchanged: name the right --format or --grid, or rename the photographs",
        )


def _disparity_range(parallax: Parallax) -> tuple[float, float]:
    d = parallax.disparity[np.isfinite(parallax.disparity)]
    low, high = np.percentile(d, [0.5, 99.5])
    spread = max(float(high - low), 0.2)
    return float(low - START_RANGE_MARGIN_FRACTION * spread), float(high + START_RANGE_MARGIN_FRACTION * spread)


def _array_model(layout: GridLayout, count: int, width: int, height: int, low: float, high: float) -> ArrayModel:
    """Intrinsics and the meaning of disparity.

    If neither focal length nor distance are known, the frame is chosen so that all depths are positive and moderate.
    Any such frame gives the same pictures.
    """
    focal = layout.focal or max(width, height) / 2 / math.tan(START_NOMINAL_ANGLE_RADIANS / 2)
    return ArrayModel.planar(count, width, height, focal, 1.0, 1 / (2.0 * max(abs(low), abs(high))))


def start_given(cameras: Sequence[Camera], low: float, high: float) -> PlanarStart:
    """An array with known cameras. Depth is seen from the camera nearest the middle.

    Disparities are those of one step, the median distance of a camera to its nearest neighbour.

    Args:
        low: Lowest inverse depth in the central camera, 1 / world unit.
        high: Highest inverse depth.
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
    model = ArrayModel(tuple(cameras), reference, anchor, step, distance, 0.0, scale, ARRAY_GIVEN_SIGMA)
    return PlanarStart(
        model, np.zeros((len(cameras), ARRAY_PARAMETERS)), places, centre, low / scale, high / scale, True, True
    )


def resized_start(start: PlanarStart, size: tuple[int, int]) -> PlanarStart:
    """The same array, its range of depths too, for photographs at another size.

    Args:
        size: (width, height).
    """
    model = start.model
    across, down = size[0] / model.reference.width, size[1] / model.reference.height
    ratio = math.sqrt(across * down)  # by which disparities grow

    def resized(camera: Camera) -> Camera:
        return replace(camera, K=np.diag([across, down, 1.0]) @ camera.K, width=size[0], height=size[1])

    bases, reference = tuple(resized(base) for base in model.bases), resized(model.reference)
    model = replace(model, bases=bases, reference=reference, scale=model.scale / ratio)
    return replace(start, model=model, low=ratio * start.low, high=ratio * start.high)


def reverse_depth(start: PlanarStart) -> PlanarStart:
    """The same motion with near and far exchanged."""
    parameters = start.parameters.copy()
    parameters[:, ARRAY_POSITION] *= -1
    return replace(start, parameters=parameters, places=-start.places, low=-start.high, high=-start.low)


def irregularity(parameters: NDArray[np.float64], start: PlanarStart, views: NDArray[np.int64]) -> float:
    """How far refined cameras depart from a regular grid, or from the given calibration.

    Args:
        parameters: (n, 10) refined parameters.
        start: The array before refinement.
        views: Indices of the views that count.

    Returns:
        Root mean square pixels by which points at the ends of the range of disparities are displaced.
    """
    left = parameters[views, :4]
    if not start.given:
        design = np.hstack([start.places[views], np.ones((len(views), 1))])
        left = left - design @ np.linalg.lstsq(design, left, rcond=None)[0]
    reach = (start.high - start.low) / 2
    places, shifts = (left[:, part] ** 2 for part in (ARRAY_POSITION, ARRAY_SHIFT))
    return math.sqrt(float(places.sum(axis=1).mean()) * reach**2 + float(shifts.sum(axis=1).mean()))
