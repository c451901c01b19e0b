"""Soft sheets of a capture, and whether they or an opaque surface draw views better that neither was made from."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera, axis_angles
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.imaging.metrics import psnr
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy import soft_relief
from eigenfield.runtime.parallel import parallel_map
from eigenfield.stereo import ReferenceView, view_matrices
from eigenfield.stereo.multiplane import SoftSheets, fit_sheets
from eigenfield.stereo.views import Pictures, codes_of, halve_pictures, inside_pictures, label_parallax

log = logging.getLogger("eigenfield.reconstruction")

Range = tuple[float, float]  # of inverse depths along the axis of the central camera, 1 / world unit


# Constants of soft sheets. Pixels are those of the view that moves most.
LAYERS_MIN_VIEWS = 3  # photographs of a capture that has sheets
LAYERS_MAX_AXIS_ANGLE_DEGREES = 25.0  # angle between a camera's axis and the mean axis
LAYERS_DENSE_VIEWS = 25  # number of views of an array from which sheets must gain more
LAYERS_COUNTS = (4, 8)  # Numbers of sheets that are tried. 12 draw views left out by at most 0.11 dB better than 8.
LAYERS_MAX_PLANE_STEP_PIXELS = 1.5  # displacement from plane to plane at the size that planes are fitted at
LAYERS_MIN_PLANES = 8  # number of planes, at least
LAYERS_MAX_PLANES = 64  # number of planes, at most
LAYERS_PLANES_SIDE_PIXELS = 320  # longer side of the photographs to which they are halved for the planes, at most
LAYERS_SHEETS_SIDE_PIXELS = 800  # the same for the sheets
LAYERS_TRIAL_SIDE_PIXELS = 300  # the same for the sheets of a trial
LAYERS_TRIAL_STEP = 4  # every so many photographs, one is left out of a trial
# part of the range of inverse depths, from the farthest on, up to which the reference view holds every camera's frame
LAYERS_MARGIN_PART = 0.1
LAYERS_MARGIN_FRACTION = 0.15  # of the longer side, by which the reference view is widened for the descent, at most
LAYERS_MAX_MARGIN_FRACTION = 0.5  # the same after the descent
LAYERS_TOLERANCE_PIXELS = 0.1  # distance of the mesh from a sheet
LAYERS_DEPTH_ERROR_PIXELS = 0.04  # by which the lattice's depths move a point
LAYERS_HIDDEN_RATIO = 1.02  # of inverse depths, from which on a photograph does not see a point of the opaque surface
# By which sheets must draw the views of a trial better than the opaque surface. With 4 dB they were better (Fern),
# with 0.6 worse (the sparse Tarot).
LAYERS_MIN_GAIN_DB = 1.0
# The same of a dense array, on whose opaque surface the fit then gains more, in fewer bytes. With 3.7 dB sheets were
# better (Boxes); with 3.5 (Amethyst), 2.0 (Shop) and 1.0 (Antinous) they were worse.
LAYERS_DENSE_MIN_GAIN_DB = 3.6
LAYERS_COUNT_GAIN_DB = 0.15  # by which more sheets must draw them better than fewer
LAYERS_MAX_COUNT_GAIN_DB = 1.3  # by which more sheets draw them better than the fewest, at most: 0.9 were seen (Fern)


def layers_fault(cameras: Sequence[Camera]) -> str | None:
    """Why cameras cannot have sheets; None if they can."""
    if len(cameras) < LAYERS_MIN_VIEWS:
        return f"{len(cameras)} photographs are too few for layers"
    angle = axis_angles(cameras).max()
    if angle > LAYERS_MAX_AXIS_ANGLE_DEGREES:
        return f"the cameras do not look one way: one looks {angle:.0f} degrees off the others"
    return None


def layers_proxy(
    pictures: Pictures, cameras: Sequence[Camera], bounds: Range, *, count: int, triangles: int,
    progress: Progress | None = None,
) -> Proxy:  # fmt: skip
    """The proxy of the soft sheets that draw photographs best.

    Args:
        pictures: (V, H, W, 3) uint8 the photographs, or packed.
        cameras: V of them, at the same size.
        bounds: Inverse depths of the farthest and the nearest plane.
    """
    pictures, cameras = halved(pictures, cameras, LAYERS_SHEETS_SIDE_PIXELS)
    reference, (fitted,) = fit_views(pictures, cameras, bounds, [count], progress=progress)
    reference, sheets = _widened(reference, fitted, cameras, bounds)
    tolerance = LAYERS_TOLERANCE_PIXELS / _reach(reference, cameras)
    return soft_relief(
        reference, sheets, cameras, tolerance=tolerance, depth_error=LAYERS_DEPTH_ERROR_PIXELS,
        triangles=triangles, progress=progress,
    ).proxy  # fmt: skip


def fit_views(
    pictures: Pictures, cameras: Sequence[Camera], bounds: Range, counts: Sequence[int],
    enough: Callable[[ReferenceView, SoftSheets], bool] | None = None, progress: Progress | None = None,
) -> tuple[ReferenceView, list[SoftSheets]]:  # fmt: skip
    """The reference view of photographs, and their soft sheets for each of some numbers of sheets.

    Args:
        counts: The numbers, of which those above the number of planes are taken as that.
        enough: Called with the reference view and the sheets of each number; True leaves out those that follow.
    """
    longer = max(pictures.shape[1:3])
    central = _middle_camera(cameras)
    margin = min(_margin(central, cameras, bounds), round(LAYERS_MARGIN_FRACTION * longer))
    reference = ReferenceView.with_margin(central, margin, 0.0, 1.0)
    halvings = max(1, math.ceil(math.log2(longer / LAYERS_PLANES_SIDE_PIXELS)))
    steps = _reach(reference, cameras) * (bounds[1] - bounds[0]) / 2**halvings / LAYERS_MAX_PLANE_STEP_PIXELS
    planes = min(max(math.ceil(steps) + 1, LAYERS_MIN_PLANES), LAYERS_MAX_PLANES)
    sheets = fit_sheets(
        pictures, view_matrices(reference, cameras), reference.shape, np.linspace(*bounds, planes),
        [min(count, planes) for count in counts], halvings=halvings, progress=progress,
        enough=None if enough is None else partial(enough, reference),
    )  # fmt: skip
    return reference, sheets


def compare_held_out(
    pictures: Pictures, cameras: Sequence[Camera], bounds: Range, mesh: Mesh | None, *, counts: Sequence[int],
    min_gain: float = -math.inf, progress: Progress | None = None,
) -> tuple[list[float], float]:  # fmt: skip
    """How well sheets and a mesh draw photographs left out: the mean PSNR for each number of sheets, and of the mesh.

    At a small size, sheets are fitted to the other photographs. On the mesh, a pixel is the mean of the other
    photographs that see its point.

    Args:
        mesh: The opaque surface; None: sheets are compared with each other.
        min_gain: PSNR by which sheets are to be better than the mesh. Where the first number is so far from it that
            more sheets cannot reach it either, these are left out and have the same PSNR.
    """
    pictures, cameras = halved(pictures, cameras, LAYERS_TRIAL_SIDE_PIXELS)
    left_out = np.zeros(len(cameras), np.bool_)
    left_out[LAYERS_TRIAL_STEP // 2 :: LAYERS_TRIAL_STEP] = True
    others, shown = np.flatnonzero(~left_out).tolist(), np.flatnonzero(left_out).tolist()
    known, unknown = [cameras[i] for i in others], [cameras[i] for i in shown]
    codes, inside = codes_of(pictures), inside_pictures(pictures)
    hard = [(codes[i], inside[i]) for i in shown]
    if mesh is not None:
        hard = draw_means(mesh, unknown, pictures[others], known)
    places = ((i, mean, covered & inside[i]) for i, (mean, covered) in zip(shown, hard, strict=True))
    counted = [(i, mean, seen) for i, mean, seen in places if seen.any()]
    if not counted:
        return [math.inf] * len(counts), -math.inf
    means = np.array([psnr(mean, codes[i], seen) for i, mean, seen in counted], np.float64)
    of_mesh = -math.inf if mesh is None else float(means.mean())
    scores: list[float] = []

    def hopeless(reference: ReferenceView, sheets: SoftSheets) -> bool:
        matrices = view_matrices(reference, [cameras[i] for i, _, _ in counted])
        drawn = (sheets.draw(matrix, pictures.shape[1:3]) for matrix in matrices)
        rounded = (np.rint(np.clip(one, 0, 1) * 255).astype(np.uint8) for one in drawn)
        figures = [psnr(one, codes[i], seen) for one, (i, _, seen) in zip(rounded, counted, strict=True)]
        scores.append(float(np.array(figures, np.float64).mean()))
        return max(scores) + LAYERS_MAX_COUNT_GAIN_DB < of_mesh + min_gain

    fit_views(pictures[others], known, bounds, counts, hopeless, progress)
    return scores + scores[-1:] * (len(counts) - len(scores)), of_mesh


def best_count(counts: Sequence[int], scores: Sequence[float]) -> int:
    """The index of the least number of sheets that draws about as well as any.

    Args:
        counts: Numbers of sheets, ascending.
        scores: PSNR of each.
    """
    return next(k for k in range(len(counts)) if scores[k] + LAYERS_COUNT_GAIN_DB >= max(scores))


def draw_means(
    mesh: Mesh, views: Sequence[Camera], pictures: Pictures, cameras: Sequence[Camera]
) -> list[tuple[NDArray[np.uint8], NDArray[np.bool_]]]:
    """Each view of a mesh: (H, W, 3) at every pixel the mean of the photographs that see its point; (H, W) where any.

    Args:
        pictures: (V, H, W, 3) photographs, or packed.
        cameras: V of them.
    """
    codes = codes_of(pictures)
    whole = parallel_map(lambda camera: rasterise_view(mesh, camera).inverse_depth, cameras)
    depths = [depth * inside for depth, inside in zip(whole, inside_pictures(pictures), strict=True)]

    def draw(view: Camera) -> tuple[NDArray[np.uint8], NDArray[np.bool_]]:
        inverse = rasterise_view(mesh, view).inverse_depth
        row, column = np.indices(inverse.shape) + 0.5
        rays = np.stack([column, row, np.ones_like(row)], axis=-1) @ np.linalg.inv(view.K).T
        points = (rays / np.maximum(inverse, 1e-30)[..., None] - view.t) @ view.R
        total, count = np.zeros((*inverse.shape, 3), np.float32), np.zeros(inverse.shape, np.float32)
        for picture, camera, depth in zip(codes, cameras, depths, strict=True):
            pixels, distance = camera.project(points.reshape(-1, 3))
            at = np.clip(np.nan_to_num(pixels), -2, (camera.width + 1, camera.height + 1)).astype(np.float32) - 0.5
            at, distance = at.reshape(*inverse.shape, 2), distance.reshape(inverse.shape)
            nearest = _read(depth, at, cv2.INTER_NEAREST)
            seen = (inverse > 0) & (nearest > 0) & (distance > 0) & (distance * nearest < LAYERS_HIDDEN_RATIO)
            total += seen[..., None] * _read(picture, at, cv2.INTER_LINEAR)
            count += seen
        return np.rint(total / np.maximum(count, 1)[..., None]).astype(np.uint8), count > 0

    return parallel_map(draw, views)


def _read(picture: NDArray[Any], at: NDArray[np.float32], how: int) -> NDArray[Any]:
    """A picture at (H, W, 2) index coordinates, 0 beyond its border."""
    return np.asarray(cv2.remap(picture, at[..., 0], at[..., 1], how))


def halved(pictures: Pictures, cameras: Sequence[Camera], side: int) -> tuple[Pictures, Sequence[Camera]]:
    """Photographs and cameras at half the size, until the longer side is at most that.

    Args:
        pictures: (V, H, W, 3) uint8 photographs, or packed.
        cameras: V of them.
        side: Pixels.
    """
    while max(pictures.shape[1:3]) > side:
        pictures = halve_pictures(pictures)
        height, width = pictures.shape[1:3]
        half = np.diag([0.5, 0.5, 1.0])
        cameras = [replace(camera, K=half @ camera.K, width=width, height=height) for camera in cameras]
    return pictures, cameras


def _middle_camera(cameras: Sequence[Camera]) -> Camera:
    """The camera in the middle of all, which looks as the central one."""
    centres = np.array([camera.centre for camera in cameras])
    middle = centres.mean(axis=0)
    central = cameras[int(np.argmin(np.linalg.norm(centres - middle, axis=1)))]
    return replace(central, t=-central.R @ middle)


def _margin(central: Camera, cameras: Sequence[Camera], bounds: Range) -> int:
    """Pixels by which a camera's frame is widened to hold all others' up to LAYERS_MARGIN_PART of the range."""
    part = bounds[0] + LAYERS_MARGIN_PART * (bounds[1] - bounds[0])
    most = LAYERS_MAX_MARGIN_FRACTION * max(central.width, central.height)
    beyond = 0.0
    for camera in cameras:
        corners = np.array([(x, y, 1.0) for x in (0, camera.width) for y in (0, camera.height)])
        rays = corners @ np.linalg.inv(camera.K).T @ camera.R @ central.R.T
        start = central.R @ camera.centre + central.t
        for inverse in (bounds[0], part):
            points = start + rays * ((1 / inverse - start[2]) / np.maximum(rays[:, 2:], 1e-6))
            pixels = (points @ central.K.T)[:, :2] * inverse
            beyond = max(beyond, float(-pixels.min()), float((pixels - (central.width, central.height)).max()))
    return math.ceil(min(beyond, most)) + 2


def _widened(
    reference: ReferenceView, sheets: SoftSheets, cameras: Sequence[Camera], bounds: Range
) -> tuple[ReferenceView, SoftSheets]:
    """A reference view that holds every camera's frame, to whose border the backmost sheet goes on."""
    more = _margin(_middle_camera(cameras), cameras, bounds) - reference.margin
    if more <= 0:
        return reference, sheets
    wide = ReferenceView.with_margin(reference.camera, more, reference.offset, reference.scale)
    around = (0, 0), (more, more), (more, more)
    layers = np.pad(sheets.layers, (*around, (0, 0)), mode="edge")
    layers[1:, ..., 3] = np.pad(sheets.layers[1:, ..., 3], around)
    return replace(wide, margin=reference.margin + more), SoftSheets(np.pad(sheets.labels, around, mode="edge"), layers)


def _reach(reference: ReferenceView, cameras: Sequence[Camera]) -> float:
    """Pixels by which one unit of a label moves a point in the view that it moves most."""
    parallax = label_parallax(view_matrices(reference, cameras), reference.shape)
    return float(np.linalg.norm(parallax, axis=1).max())
