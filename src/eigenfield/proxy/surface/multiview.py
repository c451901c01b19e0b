"""From photographs with known cameras to a surface: a depth map a view, fused, closed by visibility, and simplified.

There are two passes. The coarse one covers all depths that the cameras can resolve, unless points of structure from
motion are given. In the fine one each view covers the range of the points that it sees.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.capture.lightfield import LightField, View
from eigenfield.capture.photographs.lens import source_positions
from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.proxy.background import fill_background
from eigenfield.proxy.primitives.shapes import Primitive, insert_primitive
from eigenfield.proxy.simplify import PROXY_DEFAULT_TRIANGLES
from eigenfield.proxy.surface.depth_maps import DepthJob, WorkingPicture, make_depth_maps
from eigenfield.proxy.surface.fusion import DepthView, fuse_depth_maps
from eigenfield.proxy.surface.neighbours import choose_neighbours, frustum_points, inside_frame, spread_views
from eigenfield.proxy.surface.poisson import poisson_surface
from eigenfield.proxy.surface.trim import SurfaceError, simplify_with_error, trim_by_masks, trim_surface
from eigenfield.proxy.surface.visibility import add_weak_points
from eigenfield.runtime.parallel import tracked_map
from eigenfield.runtime.parts import Parts

log = logging.getLogger("eigenfield.proxy")


@dataclass(frozen=True)
class MultiviewTuning:
    """Constants of `surface_from_views`.

    Attributes:
        max_views: Views that get a depth map.
        max_pixels: Pixels of one depth map.
        max_total_pixels: Pixels of all depth maps together.
        coarse_pixels: Pixels of a depth map of the coarse pass.
        coarse_views: Views of the coarse pass.
        neighbours: Views that each is compared with.
        min_neighbours: A view with fewer neighbours gets no depth map.
        max_parallax_sides: Largest parallax of the coarse pass, in units of the picture's longer side.
        min_parallax_pixels: Smallest parallax of the coarse pass.
        range_margin_fraction: Added at both ends of the range of the points' inverse depths.
        range_percentiles: Percentiles of the points' inverse depths that bound the range.
        min_points: Points in view that determine a range.
        mask_border_fraction: Fraction of the pixels that a mask may hide beyond the lens's border and still be that
            border.
        points_per_triangle: Points a triangle of the result: more are merged, so that noise is averaged, not
            reconstructed.
        min_fused_points: Fused points, at least.
        background_fraction: Fraction of the triangles reserved for the background.
        tolerance_range: Smallest and largest relative tolerance of fusion.
    """

    max_views: int = 60
    max_pixels: int = 600_000
    max_total_pixels: int = 9_000_000
    coarse_pixels: int = 40_000
    coarse_views: int = 24
    neighbours: int = 8
    min_neighbours: int = 2
    max_parallax_sides: float = 0.5
    min_parallax_pixels: float = 0.1
    range_margin_fraction: float = 0.15
    range_percentiles: tuple[float, float] = (0.5, 99.5)
    min_points: int = 30
    mask_border_fraction: float = 0.01
    points_per_triangle: int = 16
    min_fused_points: int = 100_000
    background_fraction: float = 0.05
    tolerance_range: tuple[float, float] = (0.004, 0.02)


MULTIVIEW_TUNING = MultiviewTuning()


@dataclass(frozen=True, eq=False)
class ReconstructedSurface:
    """The result of `surface_from_views`.

    Attributes:
        mesh: Without UVs.
        error: Of its simplification, in pixels of the central camera.
        views: Number of depth maps.
        points: Number of fused points.
    """

    mesh: Mesh
    error: SurfaceError
    views: int
    points: int


def surface_from_views(
    light_field: LightField,
    points: NDArray[np.float64] | None = None,
    *,
    triangles: int = PROXY_DEFAULT_TRIANGLES,
    background: bool | None = None,
    primitives: Sequence[Primitive] = (),
    parts: Parts | None = None,
    progress: Progress | None = None,
) -> ReconstructedSurface:
    """The surface that the photographs show, by multi-view stereo and Poisson reconstruction.

    Args:
        light_field: Photographs with cameras.
        points: (n, 3) world points on the scene from structure from motion, for the range of depths and the choice of
            neighbours. Without them a coarse pass finds its own.
        triangles: Most triangles, approximately.
        background: Add a far surface (`fill_background`). None: unless there are masks.
        primitives: Shapes that replace the result of stereo.
        parts: Workers that make the depth maps; None: this process does.
        progress: Called for each view and step.

    Raises:
        ProxyError: `surface-masked`, `surface-no-points`, `surface-empty`; `surface-overlap`: no view shares enough
            with two others.
        CaptureError: A photograph cannot be read.
    """
    cameras = light_field.cameras
    if points is None or len(points) < MULTIVIEW_TUNING.min_points:
        chosen = spread_views(cameras, MULTIVIEW_TUNING.coarse_views)
        pictures = _pictures(light_field, chosen, MULTIVIEW_TUNING.coarse_pixels, progress)
        views, tolerance = _depth_views(pictures, None, None, progress)  # too little work to pay for workers
        limit = MULTIVIEW_TUNING.min_fused_points
        points = fuse_depth_maps(views, tolerance=tolerance, limit=limit, progress=progress).positions
        log.info("coarse pass: %d points", len(points))
    chosen = spread_views(cameras, MULTIVIEW_TUNING.max_views)
    most = min(MULTIVIEW_TUNING.max_pixels, MULTIVIEW_TUNING.max_total_pixels // len(chosen))
    pictures = _pictures(light_field, chosen, most, progress)
    views, tolerance = _depth_views(pictures, points, parts, progress)
    limit = max(MULTIVIEW_TUNING.points_per_triangle * triangles, MULTIVIEW_TUNING.min_fused_points)
    fused = fuse_depth_maps(views, tolerance=tolerance, limit=limit, progress=progress)
    masked = any(picture.mask is not None for picture in pictures)
    middle = cameras[_central_camera(cameras)]
    supported = add_weak_points(fused, views, tolerance, progress=progress)
    mesh = trim_surface(poisson_surface(supported, progress=progress), supported)
    if masked:
        mesh = trim_by_masks(mesh, [p.camera for p in pictures], [p.mask for p in pictures])
    closed = (not masked) if background is None else background
    share = 1 - MULTIVIEW_TUNING.background_fraction * closed
    mesh, error = simplify_with_error(mesh, fused, round(share * triangles), middle)
    for primitive in primitives:
        mesh = insert_primitive(mesh, primitive, cameras)
    if closed:
        mesh = fill_background(mesh, cameras)
    return ReconstructedSurface(mesh, error, len(chosen), len(fused))


def _central_camera(cameras: Sequence[Camera]) -> int:
    centres = np.array([camera.centre for camera in cameras])
    return int(np.linalg.norm(centres - centres.mean(axis=0), axis=1).argmin())


def _pictures(
    light_field: LightField, chosen: Sequence[int], most: int, progress: Progress | None
) -> list[WorkingPicture]:
    def load(index: int) -> WorkingPicture:
        photograph = light_field.photograph(index)
        camera = light_field.views[index].camera
        scale = min(1.0, float(np.sqrt(most / (camera.width * camera.height))))
        small = camera.resize(max(2, round(camera.width * scale)), max(2, round(camera.height * scale)))
        pixels = _resample(photograph.pixels, camera, small)
        mask = None if photograph.mask is None else _resample(photograph.mask, camera, small) > 0.5
        known = _lens_mask(light_field.views[index], small)
        if mask is not None and known is not None and (known & ~mask).mean() < MULTIVIEW_TUNING.mask_border_fraction:
            mask = None  # it only marks where the lens leaves no picture
        return WorkingPicture(small, np.rint(np.clip(pixels, 0, 1) * 255).astype(np.uint8), mask, known)

    return tracked_map(load, chosen, "photographs", progress)


def _lens_mask(view: View, small: Camera) -> NDArray[np.bool_] | None:
    """Where the removal of the lens leaves a picture, at the working resolution; None: everywhere."""
    if view.lens is None:
        return None
    _, _, inside = source_positions(view.camera.K, view.lens, view.camera.width, view.camera.height)
    return None if inside.all() else _resample(inside.astype(np.float32), view.camera, small) > 0.5


def _resample(pixels: NDArray[np.float32], camera: Camera, small: Camera) -> NDArray[np.float32]:
    """Pixels at the resolution of `small`.

    `Camera.resize` crops evenly, by less than a pixel of the smaller picture.
    """
    if (small.width, small.height) == (camera.width, camera.height):
        return pixels
    scale = max(small.width / camera.width, small.height / camera.height)
    across, down = small.width / scale, small.height / scale
    left, top = (camera.width - across) / 2, (camera.height - down) / 2
    shift = np.array([[1 / scale, 0, left + 0.5 / scale - 0.5], [0, 1 / scale, top + 0.5 / scale - 0.5]])
    sigma = 0.5 * np.sqrt(max(1 / scale**2 - 1, 0))
    blurred = cv2.GaussianBlur(pixels, (0, 0), sigma) if sigma > 0.2 else pixels
    flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
    result = cv2.warpAffine(blurred, shift, (small.width, small.height), flags=flags, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(result, np.float32)


def _depth_views(
    pictures: Sequence[WorkingPicture],
    points: NDArray[np.float64] | None,
    parts: Parts | None,
    progress: Progress | None,
) -> tuple[list[DepthView], float]:
    """The views that share enough with others, and the relative difference of depth up to which two of them agree."""
    cameras = [picture.camera for picture in pictures]
    if all(picture.mask is not None and not picture.mask.any() for picture in pictures):
        raise ProxyError(
            "surface-masked", "the masks hide every pixel", remedy="white counts, black is left out: invert the masks?"
        )
    stage = "coarse depth" if points is None else "depth"
    jobs = []
    for index, camera in enumerate(cameras):
        span = _inverse_range(camera, cameras, points)
        seen = frustum_points(camera, *span) if points is None else points[inside_frame(camera, points)]
        others = choose_neighbours(index, cameras, seen, MULTIVIEW_TUNING.neighbours)
        if len(others) < MULTIVIEW_TUNING.min_neighbours:
            log.warning("a view shares too little with the others: it gets no depth map")
        else:
            jobs.append(DepthJob(index, tuple(others), span))
    views, tolerances = make_depth_maps(jobs, pictures, parts, stage, progress)
    if len(views) < MULTIVIEW_TUNING.min_neighbours + 1:
        raise ProxyError(
            "surface-overlap",
            f"only {len(views)} of {len(pictures)} photographs share enough with two others",
            remedy="photographs must overlap and be taken from different places; check the calibration",
        )
    return views, float(np.clip(np.median(tolerances), *MULTIVIEW_TUNING.tolerance_range))


def _inverse_range(
    camera: Camera, cameras: Sequence[Camera], points: NDArray[np.float64] | None
) -> tuple[float, float]:
    """The range of inverse depths of the points in view.

    Without points: all that give a parallax between 0.1 pixels and half the picture between the nearest cameras.
    """
    if points is not None:
        seen = points[inside_frame(camera, points)]
        if len(seen) < MULTIVIEW_TUNING.min_points:
            seen = points[camera.project(points)[1] > 0]
        if len(seen):
            low, high = np.percentile(1 / camera.project(seen)[1], MULTIVIEW_TUNING.range_percentiles).tolist()
            room = MULTIVIEW_TUNING.range_margin_fraction * (high - low) + 1e-3 * high
            return max(low - room, 0.3 * low), high + room
    distances = np.sort([float(np.linalg.norm(other.centre - camera.centre)) for other in cameras])
    baseline = float(np.median(distances[distances > 0][:3])) if (distances > 0).any() else 1.0
    parallax = camera.K[0, 0] * baseline
    most = MULTIVIEW_TUNING.max_parallax_sides * max(camera.width, camera.height)
    return MULTIVIEW_TUNING.min_parallax_pixels / parallax, most / parallax
