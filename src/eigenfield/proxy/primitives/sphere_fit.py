"""A sphere from its outline in several photographs.

The outline of a sphere in a pinhole camera is the picture of a cone: with the centre's direction u and distance n in
camera axes, its half angle is rho = arcsin(R / n), and its rays are cos(rho) u + sin(rho) (e1 cos t + e2 sin t). The
sphere is fitted, by Nelder and Mead's simplex, so that colours just within and just without the outline differ most;
every step is capped, so that neither a strong edge of the background nor a caustic outweighs the rest.
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
from eigenfield.core.observations import Observations, of_cameras
from eigenfield.core.progress import Progress, track
from eigenfield.imaging.sampling import distances_to, farthest_points
from eigenfield.proxy.primitives.shapes import Sphere

log = logging.getLogger("eigenfield.proxy")

MOST_VIEWS = 25
LONGEST = 1024  # pixels of a picture's longer side
ANGLES = np.radians(np.arange(0, 360, 3.0))
CAP = 0.35  # sum of three channels' differences that counts as a full step
SCALES = (2.5, 1.2)  # pixels that pictures are blurred by, one after the other
REACH = 1.4  # the two sides of the outline lie this many blurs apart from it
DEPTHS = 64  # tried without a depth
SHIFTS = (-0.2, -0.1, 0.0, 0.1, 0.2)  # of the box's radius, by which its middle may be off
GROWTHS = (0.85, 0.95, 1.05, 1.15)  # and its radius
CIRCLES = 8  # the best in the reference view, each tried at all depths
STARTS = 5  # the best of those, taken on
FINALISTS = 2  # of these, taken to the finest scale with all photographs
COARSE_VIEWS = 9  # photographs that starts are judged by
PRIOR = 1.0  # cost of the squared deviation from the box, in parts of its size
SEARCH = 5.0  # pixels on both sides of the outline in which its step is looked for
SEEN = 0.3  # of the outline that a view must have in its frame to be asked
CLEAR = 0.06  # mean step below which there is no outline


@dataclass(frozen=True)
class Region:
    """A box in one view: the view's name as given, left, top, width, height in pixels of the photograph."""

    view: str
    x: float
    y: float
    width: float
    height: float


@dataclass(frozen=True)
class SphereFit:
    """A fitted sphere.

    residual: median distance, pixels, of the strongest colour step from the outline, within 5 pixels, all views.
    contrast: the mean capped step across the outline, 0..1. views: how many photographs took part.
    """

    sphere: Sphere
    residual: float
    contrast: float
    views: int


@dataclass(frozen=True, eq=False)
class _Looks:
    """Cameras (V, ...), their pictures at each of SCALES, and how much smaller these are than the photographs."""

    K: NDArray[np.float64]
    R: NDArray[np.float64]
    t: NDArray[np.float64]
    blurred: tuple[tuple[NDArray[np.float32], ...], ...]
    scale: NDArray[np.float64]

    def __len__(self) -> int:
        return len(self.blurred)

    def first(self, count: int) -> _Looks:
        return _Looks(self.K[:count], self.R[:count], self.t[:count], self.blurred[:count], self.scale[:count])


def parse_region(text: str) -> Region:
    """`VIEW:X,Y,W,H`. Raises OptionError `fit-sphere`."""
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
    return Region(view, *numbers)


def find_view(region: Region, names: Sequence[str]) -> int:
    """The index of the region's view: by its name, else by the file's name, with or without its ending, if one fits.

    Raises OptionError `fit-sphere-view`.
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
    region: Region,
    cameras: Sequence[Camera],
    observations: Observations,
    *,
    depth: float | None = None,
    progress: Progress | None = None,
) -> SphereFit:
    """The sphere whose outline lies in `region` of one view, from up to 25 photographs spread over the array.

    Args:
        view: number of the camera that shows the region.
        region: the box around the sphere.
        cameras: of the observations.
        observations: at any times: the sphere stands still.
        depth: of the sphere's middle along the view's axis, as far as it is known; without it depths are swept.
        progress: reports the photographs that are read.

    Raises OptionError `fit-sphere-region` for a box outside the view, ProxyError `fit-sphere-outline` where no outline
    is found.
    """
    camera = cameras[view]
    middle = np.array([region.x + region.width / 2, region.y + region.height / 2])
    if not (0 < middle[0] < camera.width and 0 < middle[1] < camera.height):
        raise OptionError(
            "fit-sphere-region",
            f"the box's middle {middle[0]:g}, {middle[1]:g} lies outside the view of {camera.width}x{camera.height}",
            remedy="give the box in pixels of that photograph, its top-left corner first",
        )
    chosen = _spread(view, cameras)
    looks = _looks(chosen, cameras, observations, progress)
    baseline = float(np.median([np.linalg.norm(cameras[i].centre - camera.centre) for i in chosen[1:]]))
    frame = _Frame(camera, baseline)
    start = np.array([*middle, (region.width + region.height) / 4])
    size = np.array([region.width, region.height])
    box = _Box(start, size)
    few = looks.first(COARSE_VIEWS)
    starts = _starts(_depths(frame, depth), frame, few, box)
    coarse = sorted((_minimise(p, frame, few, 0, box) for p in starts), key=lambda fit: fit[1])
    fine = [_minimise(p, frame, looks, len(SCALES) - 1, box) for p, _ in coarse[:FINALISTS]]
    best = min(fine, key=lambda fit: fit[1])[0]
    sphere = frame.sphere(best)
    contrast = _contrast(sphere, looks, len(SCALES) - 1)
    if not contrast > CLEAR:
        raise ProxyError(
            "fit-sphere-outline",
            f"no outline of a sphere is found around {middle[0]:g}, {middle[1]:g} (mean step {contrast:.3f})",
            remedy="draw the box tightly around the sphere, in a view that shows all of it",
        )
    fit = SphereFit(sphere, _residual(sphere, looks), contrast, len(looks))
    log.info("%s: outline within %.2f px in %d views", sphere, fit.residual, fit.views)
    return fit


def outline(sphere: Sphere, camera: Camera, grow: float = 0.0) -> NDArray[np.float64]:
    """(n, 2) pixels of a sphere's outline, `grow` pixels outside it; NaN where the camera stands in the sphere."""
    return _outlines(sphere, camera.K[None], camera.R[None], camera.t[None], (grow,))[0, 0]


def _outlines(
    sphere: Sphere,
    K: NDArray[np.float64],
    R: NDArray[np.float64],
    t: NDArray[np.float64],
    grows: Sequence[float],
) -> NDArray[np.float64]:
    """(V, G, n, 2) of V cameras, each outline grown by G numbers of pixels."""
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
        ring = np.cos(ANGLES)[:, None] * e1[:, None] + np.sin(ANGLES)[:, None] * e2[:, None]
        rays = np.cos(rho)[..., None, None] * u[:, None, None] + np.sin(rho)[..., None, None] * ring[:, None]
        pixels = rays @ K.transpose(0, 2, 1)[:, None]
        return np.asarray(np.where(rays[..., 2:] > 0, pixels[..., :2] / pixels[..., 2:], np.nan))


@dataclass(frozen=True, eq=False)
class _Box:
    """Where the outline is looked for: the circle (x, y, radius) inside the box, and the box's width and height."""

    circle: NDArray[np.float64]
    size: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Frame:
    """Four numbers in pixels: the outline's middle and radius in the reference view, and the parallax of its depth over
    the typical distance to the other cameras."""

    camera: Camera
    baseline: float

    def sphere(self, p: NDArray[np.float64]) -> Sphere:
        focal = self.camera.K[0, 0]
        depth = focal * self.baseline / max(p[3], 1e-9)
        ray = np.linalg.inv(self.camera.K) @ np.array([p[0], p[1], 1.0])
        local = depth * ray
        angle = np.arctan(max(p[2], 1e-3) / focal * ray[2] / float(ray @ ray) ** 0.5)
        x, y, z = (self.camera.R.T @ (local - self.camera.t)).tolist()
        return Sphere((x, y, z), float(np.sin(angle) * np.linalg.norm(local)))


def _spread(view: int, cameras: Sequence[Camera]) -> list[int]:
    """The view and others that look the same way, each as far as possible from those before."""
    axis = cameras[view].R[2]
    facing = np.array([camera.R[2] @ axis > 0.3 for camera in cameras])
    centres = np.array([camera.centre for camera in cameras])
    distance = distances_to(centres)
    chosen = farthest_points(lambda index: np.where(facing, distance(index), -1), view, MOST_VIEWS).tolist()
    if len(chosen) < 2:
        raise ProxyError(
            "fit-sphere-outline", "no other camera looks the same way as that view", remedy="fit it in another view"
        )
    return chosen


def _looks(
    chosen: Sequence[int], cameras: Sequence[Camera], observations: Observations, progress: Progress | None
) -> _Looks:
    some = of_cameras(observations, chosen)
    small, blurred, scales = [], [], []
    for index in track(range(len(some)), "fit sphere", len(some), progress):
        camera, pixels = cameras[chosen[some.camera_of(index)]], some.photograph(index).pixels
        scale = min(1.0, LONGEST / max(camera.width, camera.height))
        small.append(camera.resized(max(1, round(camera.width * scale)), max(1, round(camera.height * scale))))
        if scale < 1:
            size = (small[-1].width, small[-1].height)
            pixels = np.asarray(cv2.resize(pixels, size, interpolation=cv2.INTER_AREA), np.float32)
        blurred.append(tuple(np.asarray(cv2.GaussianBlur(pixels, (0, 0), s), np.float32) for s in SCALES))
        scales.append(scale)
    K, R, t = (np.stack([getattr(camera, name) for camera in small]) for name in ("K", "R", "t"))
    return _Looks(K, R, t, tuple(blurred), np.array(scales))


def _sampled(picture: NDArray[np.float32], at: NDArray[np.float64]) -> NDArray[np.float32]:
    """(a, b, 3) colours at pixels (a, b, 2); NaN outside."""
    height, width = picture.shape[:2]
    inside = (at[..., 0] >= 1) & (at[..., 0] <= width - 1) & (at[..., 1] >= 1) & (at[..., 1] <= height - 1)
    where = np.where(inside[..., None], at - 0.5, 0).astype(np.float32)
    x, y = np.ascontiguousarray(where[..., 0]), np.ascontiguousarray(where[..., 1])
    colours = cv2.remap(picture, x, y, cv2.INTER_LINEAR)
    return np.where(inside[..., None], np.asarray(colours, np.float32), np.float32(np.nan))


def _steps(looks: _Looks, level: int, sphere: Sphere, grow: float = 0.0, cap: float = CAP) -> NDArray[np.float64]:
    """(V, n) capped colour steps across the outline, `grow` pixels outside it; NaN where it leaves the picture."""
    reach = REACH * SCALES[level]
    sides = _outlines(sphere, looks.K, looks.R, looks.t, (grow + reach, grow - reach))
    steps = np.empty((len(looks), len(ANGLES)))
    for row, pictures, at in zip(steps, looks.blurred, sides, strict=True):
        outer, inner = _sampled(pictures[level], at)
        row[:] = np.abs(outer - inner).sum(axis=1, dtype=np.float64)
    return np.minimum(steps, cap)


def _cost(p: NDArray[np.float64], frame: _Frame, looks: _Looks, level: int, box: _Box) -> float:
    """Minus the mean step, and the price of leaving the box."""
    off = np.append((p[:2] - box.circle[:2]) / box.size, np.log(max(p[2], 1e-3) / box.circle[2]))
    return PRIOR * float(off @ off) - _contrast(frame.sphere(p), looks, level)


def _contrast(sphere: Sphere, looks: _Looks, level: int) -> float:
    """The mean step over the views that see some of the outline; 0 where fewer than two (of several) do."""
    steps = _steps(looks, level, sphere)
    there = ~np.isnan(steps)
    enough = there.mean(axis=1) > SEEN
    if int(enough.sum()) < min(2, len(looks)):
        return 0.0
    return float((np.where(there, steps, 0).sum(axis=1)[enough] / there.sum(axis=1)[enough]).mean())


def _minimise(
    p: NDArray[np.float64], frame: _Frame, looks: _Looks, level: int, box: _Box
) -> tuple[NDArray[np.float64], float]:
    return _simplex(lambda q: _cost(q, frame, looks, level, box), p, SCALES[level], 250, 1e-5)


def _simplex(
    cost: Callable[[NDArray[np.float64]], float], p: NDArray[np.float64], step: float, most: int, tolerance: float
) -> tuple[NDArray[np.float64], float]:
    """Where Nelder and Mead's simplex ends that starts `step` wide at p, and the cost there."""
    simplex = p + np.vstack([np.zeros(len(p)), step * np.eye(len(p))])
    options = {"initial_simplex": simplex, "maxiter": most, "xatol": 0.02, "fatol": tolerance}
    found = minimize(cost, p, method="Nelder-Mead", options=options)  # type: ignore[call-overload]
    return np.asarray(found.x, np.float64), float(found.fun)


def _depths(frame: _Frame, depth: float | None) -> NDArray[np.float64]:
    """Parallaxes to start from: evenly up to the picture's size, or around a known depth."""
    if depth is not None:
        return frame.camera.K[0, 0] * frame.baseline / depth * np.linspace(0.85, 1.15, 13)
    nearest = 0.6 * max(frame.camera.width, frame.camera.height)
    return nearest * (np.arange(DEPTHS) + 0.5) / DEPTHS


def _starts(depths: NDArray[np.float64], frame: _Frame, looks: _Looks, box: _Box) -> list[NDArray[np.float64]]:
    """The best circles of the reference view near the box, each at its best depths; the best of all these."""
    x, y, r = box.circle
    typical = float(np.median(depths))
    alone = looks.first(1)

    def outline(p: NDArray[np.float64]) -> float:
        return _cost(np.append(p, typical), frame, alone, 0, box)

    grid = [np.array([x + dx * r, y + dy * r, g * r]) for dx in SHIFTS for dy in SHIFTS for g in GROWTHS]
    fits = [_simplex(outline, p, SCALES[0], 60, 1e-4) for p in grid]
    near = np.full(3, 0.03 * r)
    circles = _distinct(np.array([cost for _, cost in fits]), np.array([fit for fit, _ in fits]), near, CIRCLES)
    solid = np.array([[*circle, w] for circle in circles for w in depths])
    costs = np.array([_cost(p, frame, looks, 0, box) for p in solid])
    step = 1.5 * float(np.diff(depths).max())
    return _distinct(costs, solid, np.append(near, step), STARTS)


def _distinct(
    costs: NDArray[np.float64], candidates: NDArray[np.float64], near: NDArray[np.float64], count: int
) -> list[NDArray[np.float64]]:
    """The best few, none within `near` of a better one in all numbers."""
    chosen: list[NDArray[np.float64]] = []
    for index in np.argsort(costs, kind="stable"):
        if all((np.abs(candidates[index] - other) > near).any() for other in chosen):
            chosen.append(candidates[index])
        if len(chosen) == count:
            break
    return chosen


def _residual(sphere: Sphere, looks: _Looks) -> float:
    level = len(SCALES) - 1
    offsets = np.arange(-SEARCH, SEARCH + 0.25, 0.25)
    steps = np.array([_steps(looks, level, sphere, float(offset), 3.0) for offset in offsets])
    there = ~np.isnan(steps).any(axis=0)
    off = np.abs(offsets[np.where(np.isnan(steps), -1, steps).argmax(axis=0)]) / looks.scale[:, None]
    return float(np.median(off[there])) if there.any() else float("nan")
