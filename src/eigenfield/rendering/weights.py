"""View weights: how much of each encoded camera a viewpoint takes (equation 7 and its continuous relatives)."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from eigenfield.core.brief import brief_repr
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import signed_areas
from eigenfield.core.scene import Scene
from eigenfield.core.viewplane import find_grid

WEIGHT_MODES = ("delaunay", "nearest3", "bilinear")
WEIGHTS_FLAT_RATIO = 1e-6  # of area to longest side squared: flatter triangles count as a line
WEIGHTS_INSIDE_SLACK = 1e-9  # by which rounding may put a point on an edge outside of both its triangles, or cells
_Sparse = tuple[NDArray[np.integer], NDArray[np.float64]]  # (k,) encoded cameras, counted among themselves, and weights


@dataclass(frozen=True, eq=False)
class ViewWeights:
    """How much a picture takes of some observations; it takes nothing of the others.

    `ViewWeights()` takes nothing of any: it draws the mean.

    Attributes:
        rows: (k,) the observations, as rows of the weights (`Scene.rows`), none twice.
        values: (k,) float64 their weights.

    Raises:
        ValueError: The rows are not as many different ones as there are values, or one is below 0.
    """

    rows: NDArray[np.int64] = field(default_factory=lambda: np.zeros(0, np.int64))
    values: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))

    __repr__ = brief_repr

    def __post_init__(self) -> None:
        if self.rows.ndim != 1 or self.rows.shape != self.values.shape:
            raise ValueError(f"{self.values.shape} view weights of rows {self.rows.shape}")
        if len(np.unique(self.rows)) != len(self.rows) or (self.rows < 0).any():
            raise ValueError(f"view weights of the rows {self.rows.tolist()}: one is below 0 or stands twice")

    @classmethod
    def one(cls, row: int) -> ViewWeights:
        """An observation as it is: weight 1."""
        return cls(np.array([row]), np.ones(1))

    def dense(self, observations: int) -> NDArray[np.float64]:
        """(No,) a weight for each observation."""
        weights = np.zeros(observations)
        weights[self.rows] = self.values
        return weights

    def blend(self, matrix: NDArray[np.floating]) -> NDArray[np.float64]:
        """(n,) float64, equation 7: the weighted sum of rows of (No, n), added in their order on every machine."""
        return (self.values[:, None] * matrix[self.rows]).sum(axis=0)


def view_weights(scene: Scene, at: tuple[float, float], mode: str = "delaunay") -> ViewWeights:
    """The weights of a place: those of `place_weights`, for the observations of its cameras.

    Args:
        mode: One of `WEIGHT_MODES`.
    """
    cameras, values = place_weights(scene, at, mode)
    return ViewWeights(scene.rows(cameras), values)


def place_weights(
    scene: Scene, at: tuple[float, float], mode: str = "delaunay"
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """What a place on the view plane takes of the encoded cameras around it.

    `nearest3` is equation 7 as printed: barycentric coordinates in the triangle of the three nearest cameras, which
    jump where the third nearest changes and are negative outside the triangle. `delaunay` takes the triangle of the
    scene's triangulation that holds `at`, outside the hull its nearest point. `bilinear` needs a grid.

    Args:
        at: View-plane coordinates, clamped to the array's [-1, 1].
        mode: One of `WEIGHT_MODES`.

    Returns:
        (k,) ascending indices into `scene.rig.cameras`, and (k,) their weights, none 0, whose sum is 1.

    Raises:
        OptionError: `weights-mode`, `no-grid`, `viewpoint`.
    """
    among, weights = _sparse_weights(scene, at, mode)
    order = np.argsort(among)
    order = order[weights[order] != 0]
    return scene.rig.encoded[among[order]], weights[order]


def _sparse_weights(scene: Scene, at: tuple[float, float], mode: str) -> _Sparse:
    """As `place_weights`, in any order."""
    _check_mode(mode)
    x, y = float(at[0]), float(at[1])
    if not (np.isfinite(x) and np.isfinite(y)):
        raise OptionError("viewpoint", f"the viewpoint {x:g},{y:g} is not finite", remedy="give two from -1 to 1")
    point = np.clip([x, y], -1.0, 1.0)
    places = encoded_places(scene)
    if scene.rig.view_plane.is_line:
        point[1] = 0.0
    if mode == "delaunay":
        return delaunay_weights(point, places, scene.rig.triangles)
    if mode == "nearest3":
        return _nearest3(point, places)
    return _bilinear(point, places)


def _check_mode(mode: str) -> None:
    if mode not in WEIGHT_MODES:
        remedy = f"use one of {', '.join(WEIGHT_MODES)}"
        raise OptionError("weights-mode", f"no view weights are called {mode!r}", remedy=remedy)


def camera_weights(scene: Scene, index: int, mode: str = "delaunay") -> ViewWeights:
    """The weights of a capture camera: its own observation for an encoded one, else those of where it stands.

    Args:
        mode: One of `WEIGHT_MODES`.
    """
    _check_mode(mode)
    row = int(scene.rows(index))
    if row >= 0:
        return ViewWeights.one(row)
    x, y = scene.rig.view_plane.coordinates(scene.rig.cameras[index].centre)[0]
    return view_weights(scene, (float(x), float(y)), mode)


def delaunay_triangles(coordinates: ArrayLike) -> NDArray[np.int32]:
    """(T, 3) int32 triangles; none for cameras on a line or fewer than three.

    Grids have four cameras on each circle; the choice of diagonal is Qhull's, and the same for the same numbers.

    Args:
        coordinates: (n, 2) view-plane coordinates of the cameras.
    """
    from scipy.spatial import Delaunay, QhullError

    points = np.asarray(coordinates, dtype=np.float64).reshape(-1, 2)
    if len(points) < 3:
        return np.zeros((0, 3), np.int32)
    centred = points - points.mean(axis=0)
    spread = np.linalg.svd(centred, compute_uv=False)
    if spread[1] <= WEIGHTS_FLAT_RATIO * spread[0]:
        return np.zeros((0, 3), np.int32)
    try:
        found = Delaunay(points)
    except QhullError:
        return np.zeros((0, 3), np.int32)
    triangles = found.simplices.astype(np.int32)
    return np.ascontiguousarray(triangles[_area(points[triangles]) > WEIGHTS_FLAT_RATIO])


def encoded_places(scene: Scene) -> NDArray[np.float64]:
    """(Ne, 2) view-plane coordinates of the encoded cameras, computed once for a scene."""

    def make() -> NDArray[np.float64]:
        return scene.rig.view_plane.coordinates([camera.centre for camera in scene.rig.encoded_cameras])

    return scene.derive("view-plane coordinates", make)


def _area(corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """(T,) twice the area of (T, 3, 2) triangles over their longest side squared."""
    longest = np.square(corners - np.roll(corners, 1, axis=1)).sum(axis=2).max(axis=1)
    double = 2 * np.abs(signed_areas(corners))
    return np.divide(double, longest, out=np.zeros(len(corners)), where=longest > 0)


def _barycentric(point: NDArray[np.float64], corners: NDArray[np.float64]) -> NDArray[np.float64]:
    """(T, 3) barycentric coordinates of (2,) in (T, 3, 2), which must have area."""
    a, b, p = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], point - corners[:, 0]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    second = (p[:, 0] * b[:, 1] - p[:, 1] * b[:, 0]) / area
    third = (a[:, 0] * p[:, 1] - a[:, 1] * p[:, 0]) / area
    return np.stack([1 - second - third, second, third], axis=1)


def delaunay_weights(
    point: NDArray[np.float64], places: NDArray[np.float64], triangles: NDArray[np.int32]
) -> tuple[NDArray[np.integer], NDArray[np.float64]]:
    """What a point takes of places around it, as `place_weights` does of cameras.

    Args:
        point: (2,).
        places: (n, 2).
        triangles: (T, 3) of `delaunay_triangles`.

    Returns:
        (k,) indices of places, and (k,) their weights.
    """
    if len(triangles) == 0:
        return _along_line(point, places)
    inside = _barycentric(point, places[triangles])
    best = int(np.argmax(inside.min(axis=1)))
    if inside[best].min() >= -WEIGHTS_INSIDE_SLACK:
        part = np.maximum(inside[best], 0)
        return triangles[best], part / part.sum()
    return _on_segments(point, places, hull(triangles))


def hull(triangles: NDArray[np.int32]) -> NDArray[np.int32]:
    """(E, 2) edges that belong to one triangle of (T, 3) only."""
    edges = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    return unique[count == 1]


def nearest_on_segments(
    points: NDArray[np.float64], places: NDArray[np.float64], segments: NDArray[np.int32]
) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """The nearest segment of each point, and how far along it the nearest point lies.

    Args:
        points: (n, 2).
        places: (m, 2) ends of segments.
        segments: (E, 2) indices of places.

    Returns:
        (n,) indices of segments, the first of those equally near, and (n,) positions along them, 0..1.
    """
    start, along = places[segments[:, 0]], places[segments[:, 1]] - places[segments[:, 0]]
    length = (along**2).sum(axis=1)
    away = points[:, None] - start
    part = np.divide((away * along).sum(axis=2), length, out=np.zeros(away.shape[:2]), where=length > 0)
    part = np.clip(part, 0.0, 1.0)
    nearest = np.argmin(((part[..., None] * along - away) ** 2).sum(axis=2), axis=1)
    return nearest, part[np.arange(len(points)), nearest]


def _on_segments(point: NDArray[np.float64], places: NDArray[np.float64], segments: NDArray[np.int32]) -> _Sparse:
    """Linear weights on the nearest point of (E, 2) segments."""
    nearest, part = nearest_on_segments(point[None], places, segments)
    return segments[nearest[0]], np.array([1.0 - part[0], part[0]])


def _along_line(point: NDArray[np.float64], places: NDArray[np.float64]) -> _Sparse:
    """Cameras on a line, in the order of their positions along it: linear between neighbours, clamped at the ends."""
    if len(places) == 1:
        return np.zeros(1, np.int32), np.ones(1)
    axis = np.linalg.svd(places - places.mean(axis=0))[2][0]
    order = np.argsort(places @ axis, kind="stable").astype(np.int32)
    return _on_segments(point, places, np.stack([order[:-1], order[1:]], axis=1))


def _nearest3(point: NDArray[np.float64], places: NDArray[np.float64]) -> _Sparse:
    near = np.argsort(((places - point) ** 2).sum(axis=1), kind="stable")[:3].astype(np.int32)
    if len(near) < 3 or _area(places[near][None])[0] <= WEIGHTS_FLAT_RATIO:
        among, weights = _along_line(point, places[near])
        return near[among], weights
    return near, _barycentric(point, places[near][None])[0]


def _bilinear(point: NDArray[np.float64], places: NDArray[np.float64]) -> _Sparse:
    """Between the four cameras of the grid cell; on a jittering grid the cell's quadrilateral is inverted exactly."""
    grid = find_grid(places)
    if grid is None:
        message = "bilinear view weights need cameras on a regular grid"
        raise OptionError("no-grid", message, remedy="use --weights delaunay")
    if min(grid.index.shape) == 1:
        return _along_line(point, places)
    index = grid.index.astype(np.int32)
    cells = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1).reshape(-1, 4)
    corners = places[cells]
    ahead, towards = np.roll(corners, -1, axis=1) - corners, point - corners
    inside = (ahead[..., 0] * towards[..., 1] - ahead[..., 1] * towards[..., 0]).min(axis=1)
    best = int(np.argmax(inside))
    if inside[best] < -WEIGHTS_INSIDE_SLACK:
        rim = np.concatenate([index[0], index[1:, -1], index[-1, -2::-1], index[-2::-1, 0]])
        return _on_segments(point, places, np.stack([rim[:-1], rim[1:]], axis=1))
    s, t = _in_cell(point, corners[best])
    return cells[best], np.array([(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t])


def _in_cell(point: NDArray[np.float64], corners: NDArray[np.float64]) -> tuple[float, float]:
    """s, t in 0..1 with point = (1-s)(1-t) A + s(1-t) B + s t C + (1-s) t D in a convex quadrilateral A, B, C, D.

    With h = point - A, e = B - A, g = D - A and k = A - B + C - D, (h - t g) x (e + t k) = 0 is a quadratic in t;
    of its roots the one that stays finite as the cell becomes a parallelogram.
    """
    a, b, c, d = corners
    h, e, g, k = point - a, b - a, d - a, a - b + c - d
    constant, linear, square = _cross(h, e), _cross(h, k) - _cross(g, e), -_cross(g, k)
    root = np.sqrt(max(linear * linear - 4 * constant * square, 0.0))
    t = float(np.clip(-2 * constant / (linear + np.copysign(root, linear)), 0.0, 1.0))
    across = e + t * k
    s = float(np.clip((h - t * g) @ across / (across @ across), 0.0, 1.0))
    return s, t


def _cross(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    return float(a[0] * b[1] - a[1] * b[0])
