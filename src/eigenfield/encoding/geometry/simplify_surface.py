"""A mesh that is no relief, simplified by rate and distortion.

A mesh of photogrammetry has more than its pictures need: each takes bytes of the mesh, and makes charts smaller.
Where a simplified mesh puts a pixel's point elsewhere, a texture of what the other cameras see is off: by what they see
beside the point, the mean over them of gradient times displacement. A view that no camera has is drawn so. However far
it is off, it is no worse than something else in its place: the variance of the photograph around. At a silhouette
another surface is in its place: two unlike values differ by twice their variance, and no texture corrects that. Where
nothing is left, the picture is black.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.observations import Observations, select_cameras
from eigenfield.encoding.geometry.distortion import local_variance, luma_of, spread_cameras, visible_points
from eigenfield.encoding.geometry.simplify_relief import REMAINING_LOSS_RATIO
from eigenfield.imaging.raster import rasterise_view, unproject
from eigenfield.proxy import PROXY_DEFAULT_TRIANGLES, simplify_mesh, weld_vertices
from eigenfield.proxy.surface.trim import clear_view
from eigenfield.proxy.topology import remove_unused_vertices
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.encode")

TRIANGLE_MAX_CAMERAS = 16  # spread over the array, whose photographs are decoded
TRIANGLE_VIEW_MAX_PX = 1 << 20  # of a view: larger ones are scaled down
TRIANGLE_VIEW_SAMPLES = 8000  # pixels of each view, evenly spread
TRIANGLE_COUNT_RATIO = 2**0.5  # of one count to the next that is tried
TRIANGLE_MIN_COUNT = 250  # below, a mesh takes next to nothing
TRIANGLE_BYTES = 4.0  # its own 1.3 to 2.6, and what its share of the charts' borders takes: demo's scene and the cube
SILHOUETTE_MIN_DEPTH_RATIO = 0.01  # of inverse depth, by which another surface lies before or behind the given,
SILHOUETTE_MIN_PX = 2.0  # and by which its points are farther off beside another camera: more than a surface that moved
TRIANGLE_MAX_KEPT_RATIO = 0.6  # of the triangles, or less, must be enough for new charts to be cut


@dataclass(frozen=True, eq=False)
class _View:
    """What an observation shows of the mesh.

    Attributes:
        camera: Of the observation, scaled down.
        time: Of the observation.
        grey: (h, w) luma.
        right: (h, w) its gradient along a row.
        down: (h, w) its gradient along a column.
        around: (h, w) its variance in a window.
        inverse_depth: (h, w) of the mesh.
        pixels: Of the photograph, for one of these.
    """

    camera: Camera
    time: int
    grey: NDArray[np.float32]
    right: NDArray[np.float32]
    down: NDArray[np.float32]
    around: NDArray[np.float32]
    inverse_depth: NDArray[np.float32]
    pixels: float


@dataclass(frozen=True, eq=False)
class _Points:
    """Some pixels of a view, and the mesh's points there.

    Attributes:
        pixel: (n,) rows and (n,) columns.
        world: (n, 3) the points.
        each: Pixels of the view that one of them stands for.
        beside: For each other view at the same time, whether it sees the points, where, and its gradient there.
    """

    pixel: tuple[NDArray[np.int64], NDArray[np.int64]]
    world: NDArray[np.float64]
    each: float
    beside: list[tuple[_View, NDArray[np.bool_], NDArray[np.float64], NDArray[np.float64]]]

    @property
    def seen(self) -> NDArray[np.int64]:
        """(n,) in how many views, this one too."""
        return np.ones(len(self.world), np.int64) + sum(there for _, there, _, _ in self.beside)


def simplify_surface_rd(
    mesh: Mesh, cameras: Sequence[Camera], observations: Observations, lambda_: float, silhouettes: bool = True
) -> Mesh | None:
    """The mesh with the triangles of least rate-distortion cost, by `proxy.simplify_mesh`.

    Args:
        observations: Those of TRIANGLE_MAX_CAMERAS cameras, spread over the array, are decoded.
        lambda_: Squared error for one byte, for each pixel that a texel is seen in, at one texel a pixel.
        silhouettes: Whether the mesh's silhouettes are the scene's; those of an estimated surface are often noise.

    Returns:
        The mesh without UVs; None where as many as it has, at most PROXY_DEFAULT_TRIANGLES, are best.
    """
    chosen = spread_cameras(cameras, TRIANGLE_MAX_CAMERAS)
    some = select_cameras(observations, chosen)

    def view(index: int) -> _View:
        return _view(mesh, cameras[chosen[some.camera_of(index)]], some.time_of(index), luma_of(some, index))

    views = parallel_map(view, range(len(some)))
    samples = parallel_map(lambda number: _points(views, number), range(len(views)))
    share = len(observations) / len(some)
    seen = np.concatenate([points.seen for points in samples])
    if not (seen > 1).any():
        return None  # one camera determines no depth
    times = len({view.time for view in views})  # a texel is seen about as often at each
    lambda_ *= share * times * float(np.median(seen)) * TRIANGLE_BYTES
    whole = weld_vertices(mesh)
    most = min(len(whole.faces), PROXY_DEFAULT_TRIANGLES)
    best, least, simpler, count = None, lambda_ * most, whole, float(most)
    # Fewer than of a mesh that is worse may still be better
    while (count := count / TRIANGLE_COUNT_RATIO) >= TRIANGLE_MIN_COUNT and lambda_ * count < least:
        if count >= len(simpler.faces):  # more went than was asked for
            continue
        # The library's collapses are good for an open mesh after a few rounds, for a closed one at once
        starts = (whole,) if simpler is whole else (whole, simpler)
        tried = [one for start in starts if (one := _simplified(start, int(count))) is not None]
        if not tried:
            break
        loss, simpler = min(((_loss(one, views, samples, silhouettes), one) for one in tried), key=lambda pair: pair[0])
        remaining = REMAINING_LOSS_RATIO * share * loss
        cost = lambda_ * len(simpler.faces) + remaining
        log.debug("%d triangles: cost %.4g, of it bytes %.4g", len(simpler.faces), cost, cost - remaining)
        if cost < least:
            best, least = simpler, cost
        if remaining > least:  # fewer lose more
            break
    if best is None or len(best.faces) > TRIANGLE_MAX_KEPT_RATIO * most:
        return None
    return _cleared(best, views)


def _cleared(mesh: Mesh, views: Sequence[_View]) -> Mesh:
    """The mesh with the holes in a wall, through which cameras look and which may have closed."""
    for view in views:
        if nearest := float(view.inverse_depth.max(initial=0.0)):
            mesh = clear_view(mesh, view.camera, nearest)
    return remove_unused_vertices(mesh)


def _simplified(mesh: Mesh, triangles: int) -> Mesh | None:
    """None where nothing is left."""
    try:
        return simplify_mesh(mesh, triangles)
    except ProxyError:
        return None


def _view(mesh: Mesh, camera: Camera, time: int, grey: NDArray[np.float32]) -> _View:
    pixels = max(1.0, camera.width * camera.height / TRIANGLE_VIEW_MAX_PX)
    if pixels > 1:
        camera = camera.resize(int(camera.width / np.sqrt(pixels)), int(camera.height / np.sqrt(pixels)))
        grey = np.asarray(cv2.resize(grey, (camera.width, camera.height), interpolation=cv2.INTER_AREA), np.float32)
    down, right = map(np.asarray, np.gradient(grey))
    inverse_depth = rasterise_view(mesh, camera).inverse_depth
    return _View(camera, time, grey, right, down, local_variance(grey), inverse_depth, pixels)


def _points(views: Sequence[_View], number: int) -> _Points:
    view = views[number]
    step = max(1, int(np.sqrt((view.inverse_depth > 0).sum() / TRIANGLE_VIEW_SAMPLES)))
    row, column = step * np.array(np.nonzero(view.inverse_depth[::step, ::step] > 0))
    world = unproject(view.camera, row, column, view.inverse_depth[row, column])
    beside = []
    for other in views:
        if other is not view and other.time == view.time:
            there, y, x, at = visible_points(other.camera, world, other.inverse_depth)
            gradient = np.stack([other.right[y, x], other.down[y, x]], axis=1).astype(np.float64)
            beside.append((other, there, at, gradient))
    each = float((view.inverse_depth > 0).sum()) / max(len(row), 1)
    return _Points((row, column), world, each, beside)


def _loss(mesh: Mesh, views: Sequence[_View], samples: Sequence[_Points], silhouettes: bool) -> float:
    """Squared error of luma in all views together, of which textures leave REMAINING_LOSS_RATIO.

    What no texture corrects counts for more: where another surface is seen, or none is left.
    """

    def of_view(number: int) -> float:
        view, points = views[number], samples[number]
        drawn = rasterise_view(mesh, view.camera).inverse_depth
        black = (drawn <= 0) & (view.inverse_depth > 0)
        holes = float(np.square(view.grey[black], dtype=np.float64).sum())
        here = drawn[points.pixel]
        moved = unproject(view.camera, *points.pixel, np.where(here > 0, here, 1).astype(np.float32))
        error, farthest = np.zeros((2, len(moved)))
        for other, there, at, gradient in points.beside:
            shift = np.nan_to_num(other.camera.project(moved)[0] - at)
            error += np.where(there, (gradient * shift).sum(axis=1), 0)
            farthest = np.maximum(farthest, np.where(there, np.abs(shift).max(axis=1), 0))
        around = view.around[points.pixel]
        squares = np.minimum(np.square(error / np.maximum(points.seen - 1, 1)), around)
        if silhouettes:
            unlike = np.abs(here / view.inverse_depth[points.pixel] - 1) > SILHOUETTE_MIN_DEPTH_RATIO
            unlike &= farthest > SILHOUETTE_MIN_PX
            squares[unlike] = 2 * around[unlike] / REMAINING_LOSS_RATIO
        return view.pixels * (points.each * float(squares[here > 0].sum()) + holes / REMAINING_LOSS_RATIO)

    return sum(parallel_map(of_view, range(len(views))))
