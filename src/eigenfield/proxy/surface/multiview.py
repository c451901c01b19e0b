"""From photographs with known cameras to a surface: a depth map a view, fused, closed, trimmed and simplified.

Two passes: a coarse one over all depths that the cameras can resolve, unless structure from motion has left points, and
a fine one, each view within the range of the points that it sees.
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
from eigenfield.core.progress import Progress, track
from eigenfield.proxy.atlas.unwrap import DEFAULT_TRIANGLES
from eigenfield.proxy.background import coverage, fill_background
from eigenfield.proxy.primitives.shapes import Primitive, insert_primitive
from eigenfield.proxy.surface.fusion import DepthView, fuse
from eigenfield.proxy.surface.neighbours import choose_neighbours, frustum_points, inside_frame, spread_views
from eigenfield.proxy.surface.poisson import poisson_surface
from eigenfield.proxy.surface.trim import SurfaceError, simplified_with_error, trimmed, within_masks
from eigenfield.runtime.parallel import parallel_stream
from eigenfield.stereo import ReferenceView
from eigenfield.stereo.estimate import estimate_depth

log = logging.getLogger("eigenfield.proxy")

MOST_VIEWS = 60  # views that get a depth map
MOST_PIXELS = 600_000  # of one depth map
ALL_PIXELS = 9_000_000  # of all depth maps together
COARSE_PIXELS = 40_000  # of a depth map of the first pass
COARSE_VIEWS = 24
NEIGHBOURS = 8
FEWEST = 2  # neighbours without which a view gets no depth map
NEAREST = 0.5  # of the picture's longer side: the largest parallax of the first pass
FARTHEST = 0.1  # pixels: the smallest
BEYOND = 0.15  # of the range of the points' inverse depths, added at both ends
QUANTILES = (0.5, 99.5)  # percent, of the points' inverse depths
FEWEST_POINTS = 30  # in view, for a range of one's own
ROUNDS = 2  # of refinement of a depth map
END = 0.25  # pixels: depths this near the ends of the range are none
FRAYED = 0.01  # of the pixels: what a mask may hide beyond the lens's border and still be that border
POINTS_A_TRIANGLE = 16  # of the result: more are merged, so that noise is averaged, not reconstructed
FEWEST_FUSED = 100_000
FAR_SHARE = 0.05  # of the triangles, kept for the far surface
TOLERANCE = (0.004, 0.02)  # least and largest relative tolerance of fusion


@dataclass(frozen=True, eq=False)
class Surface:
    """What `surface_from_views` made.

    mesh: without UVs. error: of its simplification, in pixels of the camera in the middle. coverage: (n,) the part of
    each camera's pixels on which the mesh puts surface. views: how many depth maps. points: how many were fused.
    """

    mesh: Mesh
    error: SurfaceError
    coverage: NDArray[np.float64]
    views: int
    points: int


@dataclass(frozen=True, eq=False)
class _Picture:
    """A photograph at the working resolution: pixels (H, W, 3) uint8; mask (H, W) bool, the foreground, or None; known
    (H, W) bool, where the removal of the lens left a picture, or None."""

    camera: Camera
    pixels: NDArray[np.uint8]
    mask: NDArray[np.bool_] | None
    known: NDArray[np.bool_] | None


def surface_from_views(
    light_field: LightField,
    points: NDArray[np.float64] | None = None,
    *,
    triangles: int = DEFAULT_TRIANGLES,
    background: bool | None = None,
    primitives: Sequence[Primitive] = (),
    progress: Progress | None = None,
) -> Surface:
    """The surface that the photographs show, by multi-view stereo and Poisson reconstruction.

    points: (n, 3) world points on the scene, as structure from motion leaves them, for the range of depths and the
    choice of neighbours; without them a coarse pass finds its own. triangles: about so many at most. background: close
    it behind with a far surface (`fill_background`); None: unless there are masks. primitives: put in in place of what
    stereo made there.

    Raises ProxyError: `surface-masked`, `surface-no-points`, `surface-empty`, `surface-overlap` if no view shares
    enough with two others; CaptureError for a photograph that cannot be read.
    """
    cameras = light_field.cameras
    if points is None or len(points) < FEWEST_POINTS:
        chosen = spread_views(cameras, COARSE_VIEWS)
        pictures = _pictures(light_field, chosen, COARSE_PIXELS, progress)
        views, tolerance = _depth_views(pictures, None, progress)
        points = fuse(views, tolerance=tolerance, agreement=FEWEST, limit=FEWEST_FUSED, progress=progress).positions
        log.info("coarse pass: %d points", len(points))
    chosen = spread_views(cameras, MOST_VIEWS)
    pictures = _pictures(light_field, chosen, min(MOST_PIXELS, ALL_PIXELS // len(chosen)), progress)
    views, tolerance = _depth_views(pictures, points, progress)
    limit = max(POINTS_A_TRIANGLE * triangles, FEWEST_FUSED)
    fused = fuse(views, tolerance=tolerance, agreement=FEWEST, limit=limit, progress=progress)
    masked = any(picture.mask is not None for picture in pictures)
    middle = cameras[_central(cameras)]
    # masked pixels have no depth that could look through a patch: nothing without points stays there
    walls = () if masked else views
    mesh = trimmed(poisson_surface(fused, progress=progress), fused, views=walls, tolerance=tolerance)
    if masked:
        mesh = within_masks(mesh, [p.camera for p in pictures], [p.mask for p in pictures])
    closed = (not masked) if background is None else background
    mesh, error = simplified_with_error(mesh, fused, round((1 - FAR_SHARE * closed) * triangles), middle)
    for primitive in primitives:
        mesh = insert_primitive(mesh, primitive, cameras)
    if closed:
        mesh = fill_background(mesh, cameras)
    covered = coverage(mesh, cameras)
    log.info("surface: %d triangles, coverage %.4f (least %.4f)", len(mesh.faces), covered.mean(), covered.min())
    return Surface(mesh, error, covered, len(chosen), len(fused))


def _central(cameras: Sequence[Camera]) -> int:
    centres = np.array([camera.centre for camera in cameras])
    return int(np.linalg.norm(centres - centres.mean(axis=0), axis=1).argmin())


def _pictures(light_field: LightField, chosen: Sequence[int], most: int, progress: Progress | None) -> list[_Picture]:
    def one(index: int) -> _Picture:
        photograph = light_field.photograph(index)
        camera = light_field.views[index].camera
        scale = min(1.0, float(np.sqrt(most / (camera.width * camera.height))))
        small = camera.resized(max(2, round(camera.width * scale)), max(2, round(camera.height * scale)))
        pixels = _resampled(photograph.pixels, camera, small)
        mask = None if photograph.mask is None else _resampled(photograph.mask, camera, small) > 0.5
        known = _lens_frame(light_field.views[index], small)
        if mask is not None and known is not None and (known & ~mask).mean() < FRAYED:
            mask = None  # it says no more than where the lens left no picture
        return _Picture(small, np.rint(np.clip(pixels, 0, 1) * 255).astype(np.uint8), mask, known)

    return list(track(parallel_stream(one, chosen), "photographs", len(chosen), progress))


def _lens_frame(view: View, small: Camera) -> NDArray[np.bool_] | None:
    """Where the removal of the lens leaves a picture, at the working resolution; None: everywhere."""
    if view.lens is None:
        return None
    _, _, inside = source_positions(view.camera.K, view.lens, view.camera.width, view.camera.height)
    return None if inside.all() else _resampled(inside.astype(np.float32), view.camera, small) > 0.5


def _resampled(pixels: NDArray[np.float32], camera: Camera, small: Camera) -> NDArray[np.float32]:
    """Where `Camera.resized` crops, it does so evenly and by less than a pixel of the smaller picture."""
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
    pictures: Sequence[_Picture], points: NDArray[np.float64] | None, progress: Progress | None
) -> tuple[list[DepthView], float]:
    """The views that share enough with others, and the relative difference of depth up to which two of them agree."""
    cameras = [picture.camera for picture in pictures]
    if all(picture.mask is not None and not picture.mask.any() for picture in pictures):
        raise ProxyError(
            "surface-masked", "the masks hide every pixel", remedy="white counts, black is left out: invert the masks?"
        )
    stage = "coarse depth" if points is None else "depth"
    views, tolerances = [], []
    for index in track(range(len(pictures)), stage, len(pictures), progress):
        span = _range(cameras[index], cameras, points)
        seen = frustum_points(cameras[index], *span) if points is None else points[inside_frame(cameras[index], points)]
        others = choose_neighbours(index, cameras, seen, NEIGHBOURS)
        if len(others) < FEWEST:
            log.warning("a view shares too little with the others: it gets no depth map")
            continue
        inverse_depth, tolerance = _depth_map(index, others, pictures, span)
        tolerances.append(tolerance)
        picture = pictures[index]
        views.append(DepthView(picture.camera, inverse_depth, picture.pixels, picture.mask))
    if len(views) < FEWEST + 1:
        raise ProxyError(
            "surface-overlap",
            f"only {len(views)} of {len(pictures)} photographs share enough with two others",
            remedy="photographs must overlap and be taken from different places; check the calibration",
        )
    return views, float(np.clip(np.median(tolerances), *TOLERANCE))


def _range(camera: Camera, cameras: Sequence[Camera], points: NDArray[np.float64] | None) -> tuple[float, float]:
    """The inverse depths to look at: of the points in view, else all that give a parallax of 0.1 pixels up to half the
    picture between the nearest cameras."""
    if points is not None:
        seen = points[inside_frame(camera, points)]
        if len(seen) < FEWEST_POINTS:
            seen = points[camera.project(points)[1] > 0]
        if len(seen):
            low, high = np.percentile(1 / camera.project(seen)[1], QUANTILES).tolist()
            room = BEYOND * (high - low) + 1e-3 * high
            return max(low - room, 0.3 * low), high + room
    distances = np.sort([float(np.linalg.norm(other.centre - camera.centre)) for other in cameras])
    baseline = float(np.median(distances[distances > 0][:3])) if (distances > 0).any() else 1.0
    parallax = camera.K[0, 0] * baseline
    return FARTHEST / parallax, NEAREST * max(camera.width, camera.height) / parallax


def _depth_map(
    index: int, others: Sequence[int], pictures: Sequence[_Picture], span: tuple[float, float]
) -> tuple[NDArray[np.float32], float]:
    """Inverse depth (H, W) of one view, 0 outside its mask, and the relative depth that a pixel of parallax is."""
    own = pictures[index]
    cameras = [pictures[i].camera for i in others]
    axis = own.camera.R[2]
    across = [np.linalg.norm(d - (d @ axis) * axis) for d in (camera.centre - own.camera.centre for camera in cameras)]
    unit = 1 / (own.camera.K[0, 0] * max(float(np.median(across)), 1e-12))
    canvas = ReferenceView.with_margin(own.camera, 0, span[0], unit)
    reach = (span[1] - span[0]) / unit
    height, width = max(p.pixels.shape[0] for p in pictures), max(p.pixels.shape[1] for p in pictures)
    stack = np.zeros((len(others) + 1, height, width, 3), np.uint8)
    for slot, i in zip(stack, [index, *others], strict=True):
        part = pictures[i].pixels
        slot[: part.shape[0], : part.shape[1]] = part
    depth = estimate_depth(stack, [own.camera, *cameras], canvas, (0.0, reach), rounds=ROUNDS)
    w = canvas.offset + canvas.scale * depth.d
    w[(depth.d <= END) | (depth.d >= reach - END)] = 0
    for kept in (own.mask, own.known):
        if kept is not None:
            w[~kept] = 0
    return w.astype(np.float32), unit / float(np.median(w[w > 0])) if (w > 0).any() else 0.0
