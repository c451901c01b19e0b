"""A sphere from its outline in several photographs.

The outline of a sphere in a pinhole camera is the image of a cone. With the centre's direction u and distance n in
camera axes, its half angle is rho = arcsin(R / n), and its rays are cos(rho) u + sin(rho) (e1 cos t + e2 sin t). The
fit maximises the colour difference across the outline, by the Nelder-Mead simplex. Every step is capped, so that
neither a strong edge of the background nor a caustic outweighs the rest.
"""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError, ProxyError
from eigenfield.core.observations import Observations, select_cameras
from eigenfield.core.progress import Progress, track
from eigenfield.imaging.sampling import distances_to, farthest_points
from eigenfield.proxy.primitives.shapes import SpherePrimitive

log = logging.getLogger("eigenfield.proxy")

SPHERE_FIT_MAX_VIEWS = 25  # photographs that take part
SPHERE_FIT_MAX_SIDE_PIXELS = 1024  # longer side of the pictures
SPHERE_FIT_MAX_STEP = 0.35  # sum of three channels' differences that counts as a full step
SPHERE_FIT_BLUR_SIGMA_PIXELS = (2.5, 1.2)  # blurs of the pictures, from coarse to fine
SPHERE_FIT_SIDE_DISTANCE_BLURS = 1.4  # distance of the two sides from the outline, in blurs
SPHERE_FIT_SWEPT_DEPTHS = 64  # depths tried
SPHERE_FIT_START_SHIFTS = (-0.2, -0.1, 0.0, 0.1, 0.2)  # shifts of the start's middle, in units of the box's radius
SPHERE_FIT_START_GROWTHS = (0.85, 0.95, 1.05, 1.15)  # factors of its radius
SPHERE_FIT_START_CIRCLES = 8  # best circles of the reference view, each tried at all depths
SPHERE_FIT_STARTS = 5  # best of those, optimised further
SPHERE_FIT_FINALISTS = 2  # best of these, optimised at the finest scale with all photographs
SPHERE_FIT_COARSE_VIEWS = 9  # photographs with which starts are compared
SPHERE_FIT_BOX_WEIGHT = 1.0  # cost of the squared deviation from the box, in units of its size
SPHERE_FIT_SEARCH_PIXELS = 5.0  # distance on both sides of the outline in which its step is searched
SPHERE_FIT_MIN_OUTLINE_FRACTION = 0.3  # fraction of the outline that a view must have in its frame
SPHERE_FIT_MIN_CONTRAST = 0.06  # mean step below which there is no outline

SPHERE_OUTLINE_ANGLES_RADIANS = np.radians(np.arange(0, 360, 3.0))


@dataclass(frozen=True)
class ViewRegion:
    """A box in one view, in pixels of the photograph.

    Attributes:
        view: The view's name as given.
        x: Left border.
        y: Top border.
        width: Pixels.
        height: Pixels.
    """

    view: str
    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class SphereFit:
    """A fitted sphere.

    Attributes:
        sphere: The sphere.
        residual: Median distance of the strongest colour step from the outline, within 5 pixels, over all views, in
            pixels.
        contrast: Mean capped step across the outline, 0..1.
        views: Number of photographs that took part.
    """

    sphere: SpherePrimitive
    residual: float
    contrast: float
    views: int


@dataclass(frozen=True, eq=False)
class _BlurredViews:
    """Cameras (V, ...), their pictures at each blur, and the scale of these against the photographs."""

    K: NDArray[np.float64]
    R: NDArray[np.float64]
    t: NDArray[np.float64]
    blurred: tuple[tuple[NDArray[np.float32], ...], ...]
    scale: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.blurred)

    def first(self, count: int) -> _BlurredViews:
        return _BlurredViews(self.K[:count], self.R[:count], self.t[:count], self.blurred[:count], self.scale[:count])


def parse_region(text: str) -> ViewRegion:
    """A region from its text form.

    Args:
        text: `VIEW:X,Y,W,H`.

    Raises:
        OptionError: `fit-sphere`.
    """
    view, colon, rest = text.rpartition(":")
    try:
        numbers = [float(part) for part in rest.split(",")]
    except ValueError:
        numbers = []
    if not colon or not view or len(numbers) != 4 or not np.isfinite(numbers).all():
        raise OptionError(
            "fit-sphere",
            f"{text!r} is no region of a view",
            remedy="write VIEW:X,Y,W,H: the photograph's name, and the box around the sphere in its pixels",
        )
    if numbers[2] <= 0 or numbers[3] <= 0:
        raise OptionError("fit-sphere", f"{text!r}: the box is empty", remedy="give a width and a height above 0")
    return ViewRegion(view, *numbers)


def find_view(region: ViewRegion, names: Sequence[str]) -> int:
    """The index of the region's view: by its name, else by its unique file name with or without the ending.

    Raises:
        OptionError: `fit-sphere-view`.
    """
    for shorten in (str, lambda name: name.rpartition("/")[2], lambda name: name.rpartition("/")[2].rpartition(".")[0]):
        fitting = [index for index, name in enumerate(names) if shorten(name) == region.view]
        if len(fitting) == 1:
            return fitting[0]
    raise OptionError(
        "fit-sphere-view",
        f"no view is called {region.view!r}" if not fitting else f"{len(fitting)} views are called {region.view!r}",
        remedy=f"name one as the capture does, as {names[0]!r}",
    )


def fit_sphere(
    view: int,
    region: ViewRegion,
    cameras: Sequence[Camera],
    observations: Observations,
    *,
    progress: Progress | None = None,
) -> SphereFit:
    """The sphere whose outline lies in a region of one view, from up to 25 photographs spread over the array.

    Args:
        view: Index of the camera that shows the region.
        observations: At any times: the sphere does not move.

    Raises:
        OptionError: `fit-sphere-region`: the box lies outside the view.
        ProxyError: `fit-sphere-outline`: no outline is found.
    """
    camera = cameras[view]
    middle = np.array([region.x + region.width / 2, region.y + region.height / 2])
    if not (0 < middle[0] < camera.width and 0 < middle[1] < camera.height):
        raise OptionError(
            "fit-sphere-region",
            f"the box's middle {middle[0]:g}, {middle[1]:g} lies outside the view of {camera.width}x{camera.height}",
            remedy="give the box in pixels of that photograph, its top-left corner first",
        )
    chosen = _choose_views(view, cameras)
    views = _blur_views(chosen, cameras, observations, progress)
    baseline = float(np.median([np.linalg.norm(cameras[i].centre - camera.centre) for i in chosen[1:]]))
    circle = np.array([*middle, (region.width + region.height) / 4])
    search = _Search(camera, baseline, circle, np.array([region.width, region.height]))
    coarse_views = views.first(SPHERE_FIT_COARSE_VIEWS)
    starts = _start_candidates(search, coarse_views)
    coarse = sorted((search.minimise(p, coarse_views, 0) for p in starts), key=lambda fit: fit[1])
    fine = [search.minimise(p, views, -1) for p, _ in coarse[:SPHERE_FIT_FINALISTS]]
    sphere = search.sphere(min(fine, key=lambda fit: fit[1])[0])
    contrast = _contrast(sphere, views, -1)
    if not contrast > SPHERE_FIT_MIN_CONTRAST:
        raise ProxyError(
            "fit-sphere-outline",
            f"no outline of a sphere is found around {middle[0]:g}, {middle[1]:g} (mean step {contrast:.3f})",
            remedy="draw the box tightly around the sphere, in a view that shows all of it",
        )
    fit = SphereFit(sphere, _outline_residual(sphere, views), contrast, len(views))
    log.info("%s: outline within %.2f px in %d views", sphere, fit.residual, fit.views)
    return fit


def sphere_outlines(
    sphere: SpherePrimitive,
    K: NDArray[np.float64],
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    grows: Sequence[float],
) -> NDArray[np.float64]:
    """(V, G, n, 2) pixels of a sphere's outline in V cameras; NaN for a camera that stands in the sphere.

    Args:
        K: (V, 3, 3) of the cameras.
        R: (V, 3, 3) likewise.
        t: (V, 3) likewise.
        grows: G distances outside the outline, pixels.
    """
    local = R @ np.array(sphere.centre) + t
    n = np.linalg.norm(local, axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        u = local / n[:, None]
        cone = np.where(local[:, 2] > 0, np.arcsin(sphere.radius / n), np.nan)
        rho = cone[:, None] + np.array(grows) / K[:, 0, 0, None] * u[:, 2, None]
        level = np.where(np.abs(u[:, 1:2]) < 0.9, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0])
        e1 = np.cross(u, level)
        e1 /= np.linalg.norm(e1, axis=1, keepdims=True)
        e2 = np.cross(u, e1)
        around = SPHERE_OUTLINE_ANGLES_RADIANS[:, None]
        ring = np.cos(around) * e1[:, None] + np.sin(around) * e2[:, None]
        rays = np.cos(rho)[..., None, None] * u[:, None, None] + np.sin(rho)[..., None, None] * ring[:, None]
        pixels = rays @ K.transpose(0, 2, 1)[:, None]
        return np.asarray(np.where(rays[..., 2:] > 0, pixels[..., :2] / pixels[..., 2:], np.nan))


@dataclass(frozen=True, eq=False)
class _Search:
    """The search of a sphere by four parameters in pixels.

    They are the outline's middle and radius in the reference view, and the parallax of its depth over the typical
    distance to the other cameras.

    Attributes:
        camera: Of the reference view.
        baseline: Typical distance to the other cameras, world units.
        circle: (3,) x, y and radius of the circle in the box in which the outline is searched.
        size: (2,) width and height of the box.
    """

    camera: Camera
    baseline: float
    circle: NDArray[np.float64]
    size: NDArray[np.float64]

    def sphere(self, p: NDArray[np.float64]) -> SpherePrimitive:
        focal = self.camera.K[0, 0]
        depth = focal * self.baseline / max(p[3], 1e-9)
        ray = np.linalg.inv(self.camera.K) @ np.array([p[0], p[1], 1.0])
        local = depth * ray
        angle = np.arctan(max(p[2], 1e-3) / focal * ray[2] / float(ray @ ray) ** 0.5)
        x, y, z = (self.camera.R.T @ (local - self.camera.t)).tolist()
        return SpherePrimitive((x, y, z), float(np.sin(angle) * np.linalg.norm(local)))

    def cost(self, p: NDArray[np.float64], views: _BlurredViews, level: int) -> float:
        """The negative mean step, plus the penalty for leaving the box."""
        off = np.append((p[:2] - self.circle[:2]) / self.size, np.log(max(p[2], 1e-3) / self.circle[2]))
        return SPHERE_FIT_BOX_WEIGHT * float(off @ off) - _contrast(self.sphere(p), views, level)

    def minimise(self, p: NDArray[np.float64], views: _BlurredViews, level: int) -> tuple[NDArray[np.float64], float]:
        step = SPHERE_FIT_BLUR_SIGMA_PIXELS[level]
        return _simplex(lambda q: self.cost(q, views, level), p, step, 250, 1e-5)


def _choose_views(view: int, cameras: Sequence[Camera]) -> list[int]:
    """The view and others with a similar direction, each as far as possible from those before."""
    axis = cameras[view].R[2]
    facing = np.array([camera.R[2] @ axis > 0.3 for camera in cameras])
    centres = np.array([camera.centre for camera in cameras])
    distance = distances_to(centres)
    count = SPHERE_FIT_MAX_VIEWS
    chosen = farthest_points(lambda index: np.where(facing, distance(index), -1), view, count).tolist()
    if len(chosen) < 2:
        raise ProxyError(
            "fit-sphere-outline", "no other camera looks the same way as that view", remedy="fit it in another view"
        )
    return chosen


def _blur_views(
    chosen: Sequence[int], cameras: Sequence[Camera], observations: Observations, progress: Progress | None
) -> _BlurredViews:
    some = select_cameras(observations, chosen)
    small, blurred, scales = [], [], []
    for index in track(range(len(some)), "fit sphere", len(some), progress):
        camera, pixels = cameras[chosen[some.camera_of(index)]], some.photograph(index).pixels
        scale = min(1.0, SPHERE_FIT_MAX_SIDE_PIXELS / max(camera.width, camera.height))
        small.append(camera.resize(max(1, round(camera.width * scale)), max(1, round(camera.height * scale))))
        if scale < 1:
            size = (small[-1].width, small[-1].height)
            pixels = np.asarray(cv2.resize(pixels, size, interpolation=cv2.INTER_AREA), np.float32)
        blurs = (cv2.GaussianBlur(pixels, (0, 0), sigma) for sigma in SPHERE_FIT_BLUR_SIGMA_PIXELS)
        blurred.append(tuple(np.asarray(blur, np.float32) for blur in blurs))
        scales.append(scale)
    K, R, t = (np.stack([getattr(camera, name) for camera in small]) for name in ("K", "R", "t"))
    return _BlurredViews(K, R, t, tuple(blurred), np.array(scales))


def _sample_colours(picture: NDArray[np.float32], at: NDArray[np.float64]) -> NDArray[np.float32]:
    """(a, b, 3) colours at pixels (a, b, 2); NaN outside."""
    height, width = picture.shape[:2]
    inside = (at[..., 0] >= 1) & (at[..., 0] <= width - 1) & (at[..., 1] >= 1) & (at[..., 1] <= height - 1)
    where = np.where(inside[..., None], at - 0.5, 0).astype(np.float32)
    x, y = np.ascontiguousarray(where[..., 0]), np.ascontiguousarray(where[..., 1])
    colours = cv2.remap(picture, x, y, cv2.INTER_LINEAR)
    return np.where(inside[..., None], np.asarray(colours, np.float32), np.float32(np.nan))


def _colour_steps(
    views: _BlurredViews,
    level: int,
    sphere: SpherePrimitive,
    grow: float = 0.0,
    cap: float = SPHERE_FIT_MAX_STEP,
) -> NDArray[np.float64]:
    """(V, n) capped colour steps across the outline, `grow` pixels outside it; NaN where it leaves the picture."""
    reach = SPHERE_FIT_SIDE_DISTANCE_BLURS * SPHERE_FIT_BLUR_SIGMA_PIXELS[level]
    sides = sphere_outlines(sphere, views.K, views.R, views.t, (grow + reach, grow - reach))
    steps = np.empty((len(views), len(SPHERE_OUTLINE_ANGLES_RADIANS)))
    for row, pictures, at in zip(steps, views.blurred, sides, strict=True):
        outer, inner = _sample_colours(pictures[level], at)
        row[:] = np.abs(outer - inner).sum(axis=1, dtype=np.float64)
    return np.minimum(steps, cap)


def _contrast(sphere: SpherePrimitive, views: _BlurredViews, level: int) -> float:
    """The mean step over the views that see enough of the outline; 0 if fewer than two (of several) do."""
    steps = _colour_steps(views, level, sphere)
    there = ~np.isnan(steps)
    enough = there.mean(axis=1) > SPHERE_FIT_MIN_OUTLINE_FRACTION
    if int(enough.sum()) < min(2, len(views)):
        return 0.0
    return float((np.where(there, steps, 0).sum(axis=1)[enough] / there.sum(axis=1)[enough]).mean())


def _simplex(
    cost: Callable[[NDArray[np.float64]], float],
    p: NDArray[np.float64],
    step: float,
    max_iterations: int,
    tolerance: float,
) -> tuple[NDArray[np.float64], float]:
    """The result of a Nelder-Mead simplex that starts `step` wide at p, and its cost."""
    simplex = p + np.vstack([np.zeros(len(p)), step * np.eye(len(p))])
    options = {"initial_simplex": simplex, "maxiter": max_iterations, "xatol": 0.02, "fatol": tolerance}
    found = minimize(cost, p, method="Nelder-Mead", options=options)  # type: ignore[call-overload]
    return np.asarray(found.x, np.float64), float(found.fun)


def _start_candidates(search: _Search, views: _BlurredViews) -> list[NDArray[np.float64]]:
    """The best circles of the reference view near the box, each at its best depths; the best of all these.

    Depths are parallaxes, evenly up to the picture's size.
    """
    nearest = 0.6 * max(search.camera.width, search.camera.height)
    depths = nearest * (np.arange(SPHERE_FIT_SWEPT_DEPTHS) + 0.5) / SPHERE_FIT_SWEPT_DEPTHS
    x, y, r = search.circle
    typical = float(np.median(depths))
    alone = views.first(1)

    def outline(p: NDArray[np.float64]) -> float:
        return search.cost(np.append(p, typical), alone, 0)

    shifts, growths = SPHERE_FIT_START_SHIFTS, SPHERE_FIT_START_GROWTHS
    grid = [np.array([x + dx * r, y + dy * r, g * r]) for dx in shifts for dy in shifts for g in growths]
    fits = [_simplex(outline, p, SPHERE_FIT_BLUR_SIGMA_PIXELS[0], 60, 1e-4) for p in grid]
    near = np.full(3, 0.03 * r)
    found, costs = (np.array(part) for part in zip(*fits, strict=True))
    circles = _best_distinct(costs, found, near, SPHERE_FIT_START_CIRCLES)
    solid = np.array([[*circle, w] for circle in circles for w in depths])
    costs = np.array([search.cost(p, views, 0) for p in solid])
    step = 1.5 * float(np.diff(depths).max())
    return _best_distinct(costs, solid, np.append(near, step), SPHERE_FIT_STARTS)


def _best_distinct(
    costs: NDArray[np.float64], candidates: NDArray[np.float64], near: NDArray[np.float64], count: int
) -> list[NDArray[np.float64]]:
    """The best few, none within `near` of a better one in all parameters."""
    chosen: list[NDArray[np.float64]] = []
    for index in np.argsort(costs, kind="stable"):
        if all((np.abs(candidates[index] - other) > near).any() for other in chosen):
            chosen.append(candidates[index])
        if len(chosen) == count:
            break
    return chosen


def _outline_residual(sphere: SpherePrimitive, views: _BlurredViews) -> float:
    offsets = np.arange(-SPHERE_FIT_SEARCH_PIXELS, SPHERE_FIT_SEARCH_PIXELS + 0.25, 0.25)
    steps = np.array([_colour_steps(views, -1, sphere, float(offset), 3.0) for offset in offsets])
    there = ~np.isnan(steps).any(axis=0)
    off = np.abs(offsets[np.where(np.isnan(steps), -1, steps).argmax(axis=0)]) / views.scale[:, None]
    return float(np.median(off[there])) if there.any() else float("nan")
