"""What the pictures lose where the depth of a relief is off.

A point whose inverse depth is off by d is drawn b d pixels off in a camera, b being its parallax there. With the
gradient g of the photograph the error is (g . b) d, squared and summed over the cameras that see the point; what is
the same in all of them is no loss, the texture takes it. However far it is off, it is not worse than something
else in its place: the variance of the photographs around. Only where the surface is gone and none lies behind, the
picture is black. Of sheets with an opacity, a camera sees a point as far as it is opaque and what is in front is not.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, uniform_filter

from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh, barycentric_coordinates, signed_areas
from eigenfield.core.observations import Observations, select_cameras
from eigenfield.core.proxy import Sheets
from eigenfield.encoding.geometry.distortion_kernels import add_camera
from eigenfield.encoding.geometry.raster_kernels import HALF_TEXEL_STEPS, TEXEL_STEPS, CostMap, draw_owners
from eigenfield.imaging.colour import LUMA_BT709
from eigenfield.imaging.raster import rasterise, rasterise_view
from eigenfield.imaging.sampling import distances_to, farthest_points
from eigenfield.runtime.parallel import parallel_map, parallel_stream, pieces

DISTORTION_MAX_CAMERAS = 25  # spread over the array, whose photographs are decoded
HOLE_MAX_CAMERAS = 9  # likewise, for holes
DISTORTION_MAX_SIDE_TEXELS = 1536
DISTORTION_TASK_TEXELS = 1 << 16  # of one thread's task
DISTORTION_WINDOW_TEXELS = 3  # over which errors are averaged
VARIANCE_WINDOW_PX = 9  # over which the variance of photographs is taken
VISIBLE_MAX_DEPTH_RATIO = 0.004  # of inverse depth, by which a visible point may lie behind what is drawn
COVER_CELL_PX = 4  # within which one point must lie behind another to stand for it
COVER_MIN_DEPTH_RATIO = 0.01  # of inverse depth, by which it must
REMAP_MAX_POINTS = 32000  # in a row of OpenCV, whose sides are 16 bits


@dataclass(frozen=True, eq=False)
class DistortionMap:
    """What depths of a relief that are off cost in the photographs.

    Attributes:
        cost_map: Texel by texel.
        to_map: Texels of the map along an axis of the atlas, and (2,) where the atlas begins in it.
        seen: Pixels of all photographs that see a texel, the median.
    """

    cost_map: CostMap
    to_map: tuple[float, NDArray[np.float64]]
    seen: float

    def places(self, uv: NDArray[np.float32]) -> NDArray[np.int64]:
        """(n, 2) texture coordinates as the kernels have them."""
        return _places(uv, *self.to_map)


def luma_of(observations: Observations, index: int) -> NDArray[np.float32]:
    """(h, w) BT.709's luma of an observation, from its sRGB-coded numbers."""
    return np.asarray(observations.photograph(index).pixels @ np.array(LUMA_BT709, np.float32), np.float32)


def depth_distortion(
    mesh: Mesh,
    lattice: Lattice,
    cameras: Sequence[Camera],
    observations: Observations,
    sheets: Sheets | None = None,
) -> DistortionMap:
    """Squared error of all photographs together for wrong depths of a relief.

    Args:
        mesh: The relief, with UVs.
        observations: Those of DISTORTION_MAX_CAMERAS cameras, spread over the array, are decoded.
        sheets: Of the mesh; None: it is opaque.
    """
    assert mesh.uv is not None
    exact, pixel = lattice.coordinates(mesh.vertices), 2.0**lattice.fine  # steps
    side = _side(mesh, exact, pixel)
    start = 1 - _phase(mesh.uv.astype(np.float64) * side)
    places = _places(mesh.uv, side, start)
    owners = np.zeros((side + 2, side + 2), np.int32)
    draw_owners(places, mesh.faces, owners)
    given = owners >= 0
    corners, weights = texel_weights(places, mesh.faces, owners)
    points = np.einsum("tk,tkx->tx", weights, exact[corners])
    depth = np.zeros(owners.shape, np.float32)
    depth[given] = points[:, 2]
    world, deeper = lattice.points(points), lattice.points(points + np.array([0, 0, 1]))
    layers = None if sheets is None else _Layers.of(mesh, sheets, owners[given], corners, weights)

    chosen = spread_cameras(cameras, DISTORTION_MAX_CAMERAS)
    some = select_cameras(observations, chosen)

    def look(index: int) -> _Look:
        return _Look.of(mesh, layers, cameras[chosen[some.camera_of(index)]], luma_of(some, index), world)

    sums, drawn = np.zeros((6, len(points))), 0
    for found in parallel_stream(look, range(len(some))):
        drawn += found.pixels
        parallel_map(partial(found.add, world, deeper, sums), pieces(len(points), DISTORTION_TASK_TEXELS))
    shares, seen, first, second, most, black = sums
    if not seen.any():
        return DistortionMap(_cost_map(depth, given, np.zeros((3, len(points)))), (side, start), 0.0)
    of_texel = len(observations) / len(some) * drawn / float(shares.sum())
    if layers is None:
        curve, usual = second - np.square(first) / np.maximum(seen, 1), float(np.median(seen[seen > 0]))
        for values in (curve, most):  # what nobody here sees another camera may: as the usual, by one of them
            values[seen == 0] = np.median(values[seen > 0] / seen[seen > 0])
        behind = _has_surface_behind(points / [pixel, pixel, 1])
    else:
        curve, usual = second - np.square(first) / np.maximum(seen, 1e-6), float(len(some))
        behind = layers.of_texel > 0
    bare = np.where(behind, most, np.maximum(black, most))
    cost_map = _cost_map(depth, given, np.stack([curve, most, bare]) * of_texel)
    return DistortionMap(cost_map, (side, start), usual * of_texel)


@dataclass(frozen=True, eq=False)
class _Layers:
    """Sheets as a distortion map has them.

    Attributes:
        of_texel: (t,) the sheet of each covered texel.
        opacity: (t,) of each covered texel.
    """

    mesh: Mesh
    sheets: Sheets
    of_texel: NDArray[np.int64]
    opacity: NDArray[np.float32]

    @classmethod
    def of(
        cls,
        mesh: Mesh,
        sheets: Sheets,
        owner: NDArray[np.int32],
        corners: NDArray[np.int32],
        weights: NDArray[np.float64],
    ) -> _Layers:
        """owner: (t,) the face of each covered texel; corners, weights: of `texel_weights`."""
        assert mesh.uv is not None
        uv = np.einsum("tk,tkx->tx", weights, mesh.uv[corners])
        number = np.searchsorted(np.cumsum(sheets.faces), owner, side="right")
        return cls(mesh, sheets, number, _read_opacity(sheets, uv))

    def shares(
        self, camera: Camera, inside: NDArray[np.bool_], row: NDArray[np.int64], column: NDArray[np.int64]
    ) -> NDArray[np.float32]:
        """(t,) the share that each covered texel has in its pixel.

        Args:
            inside: (t,) whether a texel is in the picture.
            row: (t,) of its pixel.
            column: (t,) of its pixel.
        """
        assert self.mesh.uv is not None
        corners, uv = camera.homogeneous(self.mesh.vertices), self.mesh.uv
        through = np.ones((camera.height, camera.width), np.float32)
        shares, ends = np.zeros(len(inside), np.float32), np.cumsum((0, *self.sheets.faces))
        for number in reversed(range(len(self.sheets.faces))):
            here = inside & (self.of_texel == number)
            shares[here] = self.opacity[here] * through[row[here], column[here]]
            faces = self.mesh.faces[ends[number] : ends[number + 1]]
            drawn = rasterise(corners, faces, camera.width, camera.height)
            y, x = np.nonzero(drawn.face >= 0)
            at = np.einsum("nk,nkx->nx", drawn.corner_shares(y, x), uv[faces[drawn.face[y, x]]])
            through[y, x] *= 1 - _read_opacity(self.sheets, at)
        return shares


def _read_opacity(sheets: Sheets, uv: NDArray[np.float64]) -> NDArray[np.float32]:
    """(n,) the opacity at texture coordinates (n, 2)."""
    height, width = sheets.opacity.shape
    at = (uv * (width, height) - 0.5).astype(np.float32)
    column, row = (np.ascontiguousarray(at[None, :, axis]) for axis in range(2))
    rows = [
        cv2.remap(sheets.opacity, column[:, part], row[:, part], cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)[0]
        for part in (slice(k, k + REMAP_MAX_POINTS) for k in range(0, len(at), REMAP_MAX_POINTS))
    ]
    return np.concatenate(rows) if rows else np.zeros(0, np.float32)


def texels_of(mesh: Mesh, shape: tuple[int, ...]) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float64]]:
    """Of an atlas of (rows, columns): (rows, columns) the face that covers each texel or -1, and as `texel_weights`."""
    assert mesh.uv is not None
    owners = np.zeros(shape, np.int32)
    places = _places(mesh.uv, np.array(shape[::-1]), np.zeros(2))
    draw_owners(places, mesh.faces, owners)
    return owners, *texel_weights(places, mesh.faces, owners)


def texel_weights(
    places: NDArray[np.int64], faces: NDArray[np.int32], owners: NDArray[np.int32]
) -> tuple[NDArray[np.int32], NDArray[np.float64]]:
    """(t, 3) the corners of the faces over covered texels, and their barycentric coordinates."""
    row, column = np.nonzero(owners >= 0)
    corners, centres = faces[owners[row, column]], np.stack([column, row], axis=1) * TEXEL_STEPS + HALF_TEXEL_STEPS
    return corners, barycentric_coordinates(places[corners], centres)


@dataclass(frozen=True, eq=False)
class _Look:
    """What a camera sees of a mesh, for a distortion map.

    Attributes:
        matrix: (3, 4) of the camera.
        nearest: (h, w) inverse depth of what it draws; (0, 0): of sheets, which hide nothing.
        shares: (t,) of covered texels in their pixels; (0,): 1 of what is visible.
        pictures: (h, w) each: the slopes of its photograph's luma to the right and down, its variance, and luma itself.
        pixels: Number of those that show the mesh.
    """

    matrix: NDArray[np.float64]
    nearest: NDArray[np.float32]
    shares: NDArray[np.float32]
    pictures: tuple[NDArray[np.float32], ...]
    pixels: int

    @classmethod
    def of(
        cls,
        mesh: Mesh,
        layers: _Layers | None,
        camera: Camera,
        picture: NDArray[np.float32],
        world: NDArray[np.float64],
    ) -> _Look:
        """world: (t, 3) points of covered texels."""
        drawn = rasterise_view(mesh, camera)
        nearest, shares = drawn.inverse_depth, np.zeros(0, np.float32)
        if layers is not None:
            nearest = np.zeros((0, 0), np.float32)
            inside, row, column, _ = visible_points(camera, world, np.zeros_like(drawn.inverse_depth))
            shares = layers.shares(camera, inside, row, column)
        down, right = map(np.asarray, np.gradient(picture))
        pictures = right, down, local_variance(picture), picture
        return cls(camera.matrix, nearest, shares, pictures, int((drawn.face >= 0).sum()))

    def add(
        self,
        world: NDArray[np.float64],
        deeper: NDArray[np.float64],
        sums: NDArray[np.float64],
        texels: tuple[int, int],
    ) -> None:
        """Add what it sees of a range of texels to `sums`; deeper: (t, 3) their points a step of depth away."""
        ratio = 1 - VISIBLE_MAX_DEPTH_RATIO
        add_camera(*texels, self.matrix, world, deeper, self.nearest, ratio, self.shares, *self.pictures, sums)


def visible_points(
    camera: Camera, world: NDArray[np.float64], inverse_depth: NDArray[np.float32]
) -> tuple[NDArray[np.bool_], NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Whether a camera sees each of n points of a mesh that it draws with these inverse depths; the row and the column
    of the pixel, (0, 0) for points that are not in the picture; (n, 2) their places in it."""
    at, depth = camera.project(world)
    column, row = np.floor(np.nan_to_num(at, nan=-1.0).clip(-1, 1e6)).astype(np.int64).T
    seen = (depth > 0) & (column >= 0) & (row >= 0) & (column < camera.width) & (row < camera.height)
    column, row = np.where(seen, column, 0), np.where(seen, row, 0)
    with np.errstate(divide="ignore"):
        seen &= 1 / depth >= inverse_depth[row, column] * (1 - VISIBLE_MAX_DEPTH_RATIO)
    return seen, row, column, at


def local_variance(picture: NDArray[np.float32]) -> NDArray[np.float32]:
    """(h, w) the variance of a picture in a window of VARIANCE_WINDOW_PX."""
    mean = uniform_filter(picture, VARIANCE_WINDOW_PX)
    return np.maximum(uniform_filter(np.square(picture), VARIANCE_WINDOW_PX) - np.square(mean), 0)


def _has_surface_behind(points: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(t,) whether more of the surface lies behind each of some points (pixel, pixel, inverse depth)."""
    _, cell = np.unique(np.floor(points[:, :2] / COVER_CELL_PX), axis=0, return_inverse=True)
    cell = cell.reshape(-1)
    farthest = np.full(int(cell.max(initial=-1)) + 1, np.inf)
    np.minimum.at(farthest, cell, points[:, 2])
    return points[:, 2] > farthest[cell] * (1 + COVER_MIN_DEPTH_RATIO)


def hole_error(
    given: Mesh, mesh: Mesh, cameras: Sequence[Camera], observations: Observations
) -> tuple[float, NDArray[np.int64]]:
    """Squared error of luma, summed over all observations, where a camera sees through `mesh` but not through `given`.

    It is estimated from HOLE_MAX_CAMERAS cameras far apart, which see the most of what lies behind.

    Args:
        given: The mesh before it was simplified.
        mesh: The simplified one.
        observations: Those of the chosen cameras are decoded.

    Returns:
        The error, and the vertices of `given` that are seen there.
    """
    chosen = spread_cameras(cameras, HOLE_MAX_CAMERAS)
    some = select_cameras(observations, chosen)
    error, seen = 0.0, []
    for index in range(len(some)):
        camera = cameras[chosen[some.camera_of(index)]]
        before = rasterise_view(given, camera).face
        through = (rasterise_view(mesh, camera).face < 0) & (before >= 0)
        if through.any():
            error += float(np.square(luma_of(some, index)[through], dtype=np.float64).sum())
            seen.append(given.faces[before[through]].reshape(-1))
    vertices = np.unique(np.concatenate(seen)) if seen else np.zeros(0, np.int64)
    return error * len(observations) / len(some), vertices.astype(np.int64)


def _cost_map(depth: NDArray[np.float32], given: NDArray[np.bool_], costs: NDArray[np.float64]) -> CostMap:
    """The curve smoothed; beside the surface a texel costs what the nearest on it does. costs: (3, t) the curve, most
    and bare of covered texels."""
    full = np.zeros((3, *given.shape), np.float32)
    full[:, given] = costs
    share = np.maximum(uniform_filter(given.astype(np.float32), DISTORTION_WINDOW_TEXELS), 1e-6)
    smooth = np.where(given, uniform_filter(full[0], DISTORTION_WINDOW_TEXELS) / share, 0).astype(np.float32)
    row, column = distance_transform_edt(~given, return_distances=False, return_indices=True)
    return CostMap(
        depth, given.astype(np.uint8), smooth, np.ascontiguousarray(full[1][row, column]), full[2],
        np.zeros(given.shape, np.int16),
    )  # fmt: skip


def _places(uv: NDArray[np.float32], side: float | NDArray[np.int64], start: NDArray[np.float64]) -> NDArray[np.int64]:
    return np.rint((uv.astype(np.float64) * side + start) * TEXEL_STEPS).astype(np.int64)


def _phase(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2,) the fraction, 0 to 1, at which coordinates usually are: corners of faces are to be corners of texels, where
    no texel's centre is on a border."""
    return np.asarray(np.angle(np.exp(2j * np.pi * values).mean(axis=0)) / (2 * np.pi) % 1)


def _side(mesh: Mesh, exact: NDArray[np.float64], pixel: float) -> int:
    """Texels of the atlas along an axis, about a pixel each."""
    assert mesh.uv is not None

    def areas(points: NDArray[np.float64]) -> float:
        return 2 * float(np.abs(signed_areas(points[mesh.faces])).sum())

    pixels = areas(exact[:, :2]) / pixel**2 / max(areas(mesh.uv.astype(np.float64)), 1e-12)
    return int(np.clip(round(np.sqrt(pixels)), 16, DISTORTION_MAX_SIDE_TEXELS))


def spread_cameras(cameras: Sequence[Camera], count: int) -> list[int]:
    """Indices of cameras, each the farthest from those before; the first is the middle one."""
    centres = np.array([camera.centre for camera in cameras])
    middle = int(np.argmin(np.linalg.norm(centres - centres.mean(axis=0), axis=1)))
    return farthest_points(distances_to(centres), middle, count).tolist()
