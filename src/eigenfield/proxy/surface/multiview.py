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
from eigenfield.proxy.surface.trim import (
    SurfaceError,
    clear_views,
    simplify_with_error,
    trim_by_masks,
    trim_surface,
)
from eigenfield.proxy.surface.visibility import add_weak_points
from eigenfield.runtime.parallel import tracked_map
from eigenfield.runtime.parts import Parts

log = logging.getLogger("eigenfield.proxy")

MULTIVIEW_MAX_VIEWS = 60  # views that get a depth map
MULTIVIEW_MAX_PIXELS = 600_000  # pixels of one depth map
MULTIVIEW_MAX_TOTAL_PIXELS = 9_000_000  # pixels of all depth maps together
MULTIVIEW_COARSE_PIXELS = 40_000  # pixels of a depth map of the coarse pass
MULTIVIEW_COARSE_VIEWS = 24  # views of the coarse pass
MULTIVIEW_NEIGHBOURS = 8  # views that each is compared with
MULTIVIEW_MIN_NEIGHBOURS = 2  # a view with fewer neighbours gets no depth map
MULTIVIEW_MAX_PARALLAX_SIDES = 0.5  # largest parallax of the coarse pass, in units of the picture's longer side
MULTIVIEW_MIN_PARALLAX_PIXELS = 0.1  # smallest parallax of the coarse pass
MULTIVIEW_RANGE_MARGIN_FRACTION = 0.15  # added at both ends of the range of the points' inverse depths
MULTIVIEW_RANGE_PERCENTILES = (0.5, 99.5)  # percentiles of the points' inverse depths that bound the range
MULTIVIEW_MIN_POINTS = 30  # points in view that determine a range
# Fraction of the pixels that a mask may hide beyond the lens's border and still be that border
MULTIVIEW_MASK_BORDER_FRACTION = 0.01
# Points a triangle of the result: more are merged, so that noise is averaged, not reconstructed
MULTIVIEW_POINTS_PER_TRIANGLE = 16
MULTIVIEW_MIN_FUSED_POINTS = 100_000  # fused points, at least
MULTIVIEW_BACKGROUND_FRACTION = 0.05  # fraction of the triangles reserved for the background
MULTIVIEW_TOLERANCE_RANGE = (0.004, 0.02)  # smallest and largest relative tolerance of fusion


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
        points: (n, 3) world points on the scene from structure from motion, for the range of depths and the choice of
            neighbours. Without them a coarse pass finds its own.
        triangles: Most triangles, approximately.
        background: Add a far surface (`fill_background`). None: unless there are masks.
        primitives: Shapes that replace the result of stereo.
        parts: Workers that make the depth maps; None: this process does.

    Raises:
        ProxyError: `surface-masked`, `surface-no-points`, `surface-empty`; `surface-overlap`: no view shares enough
            with two others.
        CaptureError: A photograph cannot be read.
    """
    cameras = light_field.cameras
    if points is None or len(points) < MULTIVIEW_MIN_POINTS:
        chosen = spread_views(cameras, MULTIVIEW_COARSE_VIEWS)
        pictures = _pictures(light_field, chosen, MULTIVIEW_COARSE_PIXELS, progress)
        views, tolerance = _depth_views(pictures, None, None, progress)  # too little work to pay for workers
        limit = MULTIVIEW_MIN_FUSED_POINTS
        points = fuse_depth_maps(views, tolerance=tolerance, limit=limit, progress=progress).positions
        log.info("coarse pass: %d points", len(points))
    chosen = spread_views(cameras, MULTIVIEW_MAX_VIEWS)
    most = min(MULTIVIEW_MAX_PIXELS, MULTIVIEW_MAX_TOTAL_PIXELS // len(chosen))
    pictures = _pictures(light_field, chosen, most, progress)
    views, tolerance = _depth_views(pictures, points, parts, progress)
    limit = max(MULTIVIEW_POINTS_PER_TRIANGLE * triangles, MULTIVIEW_MIN_FUSED_POINTS)
    fused = fuse_depth_maps(views, tolerance=tolerance, limit=limit, progress=progress)
    masked = any(picture.mask is not None for picture in pictures)
    middle = cameras[_central_camera(cameras)]
    supported = add_weak_points(fused, views, tolerance, progress=progress)
    mesh = clear_views(trim_surface(poisson_surface(supported, progress=progress), supported), views)
    if masked:
        mesh = trim_by_masks(mesh, [p.camera for p in pictures], [p.mask for p in pictures])
    closed = (not masked) if background is None else background
    share = 1 - MULTIVIEW_BACKGROUND_FRACTION * closed
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
        if mask is not None and known is not None and (known & ~mask).mean() < MULTIVIEW_MASK_BORDER_FRACTION:
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
        others = choose_neighbours(index, cameras, seen, MULTIVIEW_NEIGHBOURS)
        if len(others) < MULTIVIEW_MIN_NEIGHBOURS:
            log.warning("a view shares too little with the others: it gets no depth map")
        else:
            jobs.append(DepthJob(index, tuple(others), span))
    views, tolerances = make_depth_maps(jobs, pictures, parts, stage, progress)
    if len(views) < MULTIVIEW_MIN_NEIGHBOURS + 1:
        raise ProxyError(
            "surface-overlap",
            f"only {len(views)} of {len(pictures)} photographs share enough with two others",
            remedy="photographs must overlap and be taken from different places; check the calibration",
        )
    return views, float(np.clip(np.median(tolerances), *MULTIVIEW_TOLERANCE_RANGE))


def _inverse_range(
    camera: Camera, cameras: Sequence[Camera], points: NDArray[np.float64] | None
) -> tuple[float, float]:
    """The range of inverse depths of the points in view.

    Without points: all that give a parallax between 0.1 pixels and half the picture between the nearest cameras.
    """
    if points is not None:
        seen = points[inside_frame(camera, points)]
        if len(seen) < MULTIVIEW_MIN_POINTS:
            seen = points[camera.project(points)[1] > 0]
        if len(seen):
            low, high = np.percentile(1 / camera.project(seen)[1], MULTIVIEW_RANGE_PERCENTILES).tolist()
            room = MULTIVIEW_RANGE_MARGIN_FRACTION * (high - low) + 1e-3 * high
            return max(low - room, 0.3 * low), high + room
    distances = np.sort([float(np.linalg.norm(other.centre - camera.centre)) for other in cameras])
    baseline = float(np.median(distances[distances > 0][:3])) if (distances > 0).any() else 1.0
    parallax = camera.K[0, 0] * baseline
    most = MULTIVIEW_MAX_PARALLAX_SIDES * max(camera.width, camera.height)
    return MULTIVIEW_MIN_PARALLAX_PIXELS / parallax, most / parallax
