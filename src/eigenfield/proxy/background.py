"""A far surface behind everything, so that every ray of every camera hits something.

Both kinds are height fields over directions from a centre: vertex = centre + direction / w, with one inverse distance w
a direction. Cameras that look in one direction get a sheet over the plane of a virtual camera in the array's middle.
Cameras that look at each other's places get a dome around them. In each direction b_i is the farthest of what was
reconstructed. A morphological opening removes small objects before it, and the sheet continues behind them. w is the
thin plate under tension, with c_i the fraction of samples, that minimises

    sum_i c_i (w_i - b_i)^2 + stiffness sum_i (L w)_i^2 + tension w . L w.

A plane is affine in w and therefore continues for a while beyond its visible part, and nothing diverges.
"""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import spsolve

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.graph import face_edges
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.samples import surface_samples
from eigenfield.proxy.topology import remove_unused_vertices
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.proxy")

BACKGROUND_SHEET_CELLS = 56  # cells of the sheet along its longer side
# Angle from the middle axis that a sheet reaches; cameras that look farther aside get a dome
BACKGROUND_SHEET_MAX_ANGLE_DEGREES = 70.0
BACKGROUND_SHEET_BORDER_SIZES = 0.08  # added on every side, in units of the sheet's size
BACKGROUND_BEHIND_FRACTION = 0.01  # relative distance of the background behind what it hides
# Weight of curvature against one direction that is full of samples: bends are a few directions wide
BACKGROUND_STIFFNESS = 30.0
BACKGROUND_TENSION = 0.5  # weight of slope
# Radius of the morphological opening: what is less than twice as wide stands before the background
BACKGROUND_OPENING_DIRECTIONS = 8
BACKGROUND_SURFACE_SAMPLES = 200_000
BACKGROUND_FAR_QUANTILE = 0.1  # quantile of inverse distance in a cell that counts as its background
BACKGROUND_MIN_INVERSE_RATIO = 0.5  # smallest inverse distance, in units of the scene's smallest (1st percentile)
BACKGROUND_DOME_SUBDIVISIONS = 4  # subdivisions of an icosahedron; 4 give 2562 directions
# Least distance of the dome, in units of the farthest camera's distance from its centre
BACKGROUND_DOME_CLEARANCE_RATIO = 1.3
BACKGROUND_VISIBILITY_PIXELS = 256  # longer side of the pictures in which visible faces are determined
BACKGROUND_PUSH_ROUNDS = 6  # rounds that push the background behind what it still hides


@dataclass(frozen=True, eq=False)
class Directions:
    """Directions from a centre, joined by triangles that face the centre.

    Attributes:
        centre: (3,).
        vectors: (n, 3). In a sheet their component along the axis is 1, so that w is inverse depth; in a dome they have
            unit length.
        faces: (m, 3).
        axis: (3, 3) rotation to the middle camera for a sheet; None: a dome.
    """

    centre: NDArray[np.float64]
    vectors: NDArray[np.float64]
    faces: NDArray[np.int32]
    axis: NDArray[np.float64] | None

    def keys_of(self, positions: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Coordinates in which neighbouring directions are near each other, and w, of points.

        Returns:
            (n, 2) for a sheet or (n, 3) for a dome, and (n,) w, not positive behind a sheet.
        """
        offset = positions - self.centre
        if self.axis is None:
            length = np.maximum(np.linalg.norm(offset, axis=1), 1e-12)
            return offset / length[:, None], 1 / length
        local = offset @ self.axis.T
        with np.errstate(divide="ignore", invalid="ignore"):
            return local[:, :2] / local[:, 2:], 1 / local[:, 2]

    @property
    def keys(self) -> NDArray[np.float64]:
        """`keys_of` the directions themselves."""
        return self.keys_of(self.centre + self.vectors)[0]


def fill_background(mesh: Mesh, cameras: Sequence[Camera]) -> Mesh:
    """The mesh and a far surface behind it, so that every pixel of every camera is covered.

    Cameras that look in one direction get a sheet, others a dome around them all. Only the part that some camera sees
    is kept, with one ring of triangles around it. The mesh's UVs are dropped.

    Raises:
        ProxyError: `surface-empty`: the mesh is empty.
    """
    if len(mesh.faces) == 0:
        raise ProxyError("surface-empty", "the surface is empty", remedy="check the calibration and the depth range")
    samples, _ = surface_samples(mesh, BACKGROUND_SURFACE_SAMPLES)
    directions = _sheet_directions(samples, cameras) or _dome_directions(cameras)
    far = _fit_inverse_distance(directions, samples, cameras)
    for _ in range(BACKGROUND_PUSH_ROUNDS):
        w, hidden = _push_behind(directions, far, mesh, cameras)
        if not hidden:
            break
        far = w
    background = Mesh((directions.centre + directions.vectors / far[:, None]).astype(np.float32), directions.faces)
    result, added = add_seen_faces(mesh, background, cameras)
    log.info("background: a %s of %d triangles", "dome" if directions.axis is None else "sheet", added)
    return result


def add_seen_faces(mesh: Mesh, other: Mesh, cameras: Sequence[Camera]) -> tuple[Mesh, int]:
    """A mesh with those faces of another that some camera sees in a small picture, and those next to them; how many."""
    both = join_meshes(mesh, other)
    seen = np.zeros(len(both.faces), np.bool_)
    for faces in parallel_map(lambda camera: np.unique(rasterise_view(both, _small_camera(camera)).face), cameras):
        seen[faces[faces >= 0]] = True
    touched = np.zeros(len(other.vertices), np.bool_)
    touched[other.faces[seen[len(mesh.faces) :]]] = True
    chosen = touched[other.faces].any(axis=1)
    kept = np.append(np.ones(len(mesh.faces), np.bool_), chosen)
    return remove_unused_vertices(Mesh(both.vertices, both.faces[kept])), int(chosen.sum())


def join_meshes(*meshes: Mesh) -> Mesh:
    """Several meshes as one, without shared vertices and without UVs."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + np.int32(start) for mesh, start in zip(meshes, starts, strict=False)]),
    )


def camera_coverage(mesh: Mesh, cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """(n,) fraction of each camera's pixels that the mesh covers."""
    return np.array(parallel_map(lambda camera: float((rasterise_view(mesh, camera).face >= 0).mean()), cameras))


def _small_camera(camera: Camera) -> Camera:
    scale = min(1.0, BACKGROUND_VISIBILITY_PIXELS / max(camera.width, camera.height))
    return camera.resize(max(1, round(camera.width * scale)), max(1, round(camera.height * scale)))


def _corner_rays(camera: Camera) -> NDArray[np.float64]:
    """(16, 3) world directions of depth 1 around the border of a camera's frame."""
    t = np.linspace(0, 1, 5)[:-1]
    x = np.concatenate([t, np.ones(4), 1 - t, np.zeros(4)]) * camera.width
    y = np.concatenate([np.zeros(4), t, np.ones(4), 1 - t]) * camera.height
    return np.stack([x, y, np.ones(16)], axis=1) @ np.linalg.inv(camera.K).T @ camera.R


def _sheet_directions(samples: NDArray[np.float64], cameras: Sequence[Camera]) -> Directions | None:
    """Directions over the plane of a camera in the array's middle; None if a ray would leave its reach."""
    centres = np.array([camera.centre for camera in cameras])
    centre = centres.mean(axis=0)
    mean = np.mean([camera.R for camera in cameras], axis=0)
    u, s, vt = np.linalg.svd(mean)
    if s[-1] < 0.3 or np.linalg.det(u @ vt) < 0:  # no common direction
        return None
    axis = u @ vt
    depth = (samples - centre) @ axis[2]
    reach = float(((centres - centre) @ axis[2]).max())
    ahead = depth > 0
    if not ahead.any() or np.percentile(depth[ahead], 90) < 1.5 * reach:
        return None
    w_low, w_high = _inverse_range(1 / depth[ahead])
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    steepest = np.tan(np.radians(BACKGROUND_SHEET_MAX_ANGLE_DEGREES))
    for camera in cameras:
        rays = _corner_rays(camera) @ axis.T
        if (rays[:, 2] * steepest <= np.hypot(rays[:, 0], rays[:, 1])).any():
            return None
        local = axis @ (camera.centre - centre)
        for w in (w_low, w_high):
            step = (1 / w - local[2]) / rays[:, 2:]
            if (step <= 0).any():
                continue  # a camera ahead of the nearest points: only the far end counts
            at = (local[:2] + step * rays[:, :2]) * w
            low, high = np.minimum(low, at.min(axis=0)), np.maximum(high, at.max(axis=0))
    size = high - low
    border = BACKGROUND_SHEET_BORDER_SIZES * size.max()
    low, high = low - border, high + border
    cell = float((high - low).max()) / BACKGROUND_SHEET_CELLS
    columns, rows = (int(n) for n in np.ceil((high - low) / cell).astype(int) + 1)
    x, y = np.meshgrid(low[0] + cell * np.arange(columns), low[1] + cell * np.arange(rows))
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    # y is down and the sheet faces the camera: counter-clockwise as it sees it
    halves = ((first, first + columns, first + 1), (first + 1, first + columns, first + columns + 1))
    faces = np.concatenate([np.stack(half, axis=1) for half in halves])
    vectors = np.stack([x.ravel(), y.ravel(), np.ones(x.size)], axis=1) @ axis
    return Directions(centre, vectors, faces.astype(np.int32), axis)


def _dome_directions(cameras: Sequence[Camera]) -> Directions:
    """All directions from the middle of the cameras."""
    import trimesh

    sphere = trimesh.creation.icosphere(BACKGROUND_DOME_SUBDIVISIONS)
    centre = np.mean([camera.centre for camera in cameras], axis=0)
    faces = np.ascontiguousarray(np.asarray(sphere.faces)[:, ::-1]).astype(np.int32)  # seen from inside
    return Directions(centre, np.asarray(sphere.vertices, np.float64), faces, None)


def _inverse_range(w: NDArray[np.float64]) -> tuple[float, float]:
    """The smallest and the largest inverse distance that the background may have."""
    low, high = np.percentile(w, [1, 99])
    return BACKGROUND_MIN_INVERSE_RATIO * float(low), float(high)


def _fit_inverse_distance(
    directions: Directions, samples: NDArray[np.float64], cameras: Sequence[Camera]
) -> NDArray[np.float64]:
    """(n,) w of each direction; see the module."""
    from scipy.spatial import KDTree

    key, w = directions.keys_of(samples)
    ceiling = _max_inverse_distance(directions, cameras)
    tree = KDTree(directions.keys)
    if directions.axis is not None:
        ahead = w > 0
        key, w = key[ahead], w[ahead]
    nearest = np.asarray(tree.query(key)[1], np.int64)
    count = len(directions.vectors)
    outside = w < ceiling[nearest]  # points between the cameras are no background
    low = _inverse_range(w[outside] if outside.any() else ceiling)[0]
    target, weight = _quantiles(nearest[outside], w[outside], count)
    if not (weight > 0).any():
        target, weight = ceiling * 0.5, np.full(count, 1e-3)
    target = _open_morphologically(directions.faces, target, weight > 0)
    highest = w[outside].max() if outside.any() else None
    smooth = np.clip(_fit_thin_plate(directions.faces, target, weight), low, highest)
    envelope = np.full(count, np.inf)
    np.minimum.at(envelope, nearest[outside], w[outside])
    envelope = np.minimum(envelope, ceiling)
    result = np.minimum(smooth, envelope * (1 - BACKGROUND_BEHIND_FRACTION))
    return _ease_steps(np.clip(result, low, None), directions.faces)


def _fit_thin_plate(
    faces: NDArray[np.int32], target: NDArray[np.float64], weight: NDArray[np.float64]
) -> NDArray[np.float64]:
    count = len(target)
    neighbours, degree = _adjacency(faces, count)
    laplacian = diags_array(degree) - neighbours
    ends, number = face_edges(faces)
    inner = np.ones(count)
    inner[ends[np.bincount(number)[number] == 1]] = 0  # the bend is not defined at the border
    bend = diags_array(inner) @ laplacian
    stiff = BACKGROUND_STIFFNESS * (bend.T @ bend) + BACKGROUND_TENSION * laplacian
    return np.asarray(spsolve((stiff + diags_array(weight + 1e-9)).tocsc(), weight * target))


def _open_morphologically(
    faces: NDArray[np.int32], target: NDArray[np.float64], known: NDArray[np.bool_]
) -> NDArray[np.float64]:
    """The target without peaks narrower than twice `opening_directions`; unchanged where it is unknown."""
    a = faces.reshape(-1)
    b = np.roll(faces, -1, axis=1).reshape(-1)

    def spread_extremes(values: NDArray[np.float64], least: np.ufunc) -> NDArray[np.float64]:
        for _ in range(BACKGROUND_OPENING_DIRECTIONS):
            result = values.copy()
            least.at(result, a, values[b])
            least.at(result, b, values[a])
            values = result
        return values

    eroded = spread_extremes(np.where(known, target, np.inf), np.minimum)
    opened = spread_extremes(np.where(np.isfinite(eroded), eroded, -np.inf), np.maximum)
    return np.where(known, np.minimum(target, opened), target)


def _quantiles(
    cell: NDArray[np.int64], w: NDArray[np.float64], count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The low quantile of w of the samples in each cell, and a weight from 0 (none) to 1 (as many as in most cells)."""
    order = np.lexsort((w, cell))
    number = np.bincount(cell, minlength=count)
    first = np.cumsum(number) - number
    target = np.zeros(count)
    full = number > 0
    target[full] = w[order][(first + BACKGROUND_FAR_QUANTILE * np.maximum(number - 1, 0)).astype(np.int64)[full]]
    typical = float(np.median(number[full])) if full.any() else 1.0
    return target, np.minimum(number / typical, 1.0)


def _max_inverse_distance(directions: Directions, cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """(n,) the largest w that keeps every camera on the near side."""
    farthest = max(float(np.linalg.norm(camera.centre - directions.centre)) for camera in cameras)
    if directions.axis is not None or farthest == 0:
        return np.full(len(directions.vectors), np.inf)
    return np.full(len(directions.vectors), 1 / (BACKGROUND_DOME_CLEARANCE_RATIO * farthest))


def _adjacency(faces: NDArray[np.int32], count: int) -> tuple[csr_array, NDArray[np.float64]]:
    """The (count, count) matrix of neighbours, and (count,) how many each has."""
    a = faces.reshape(-1)
    b = np.roll(faces, -1, axis=1).reshape(-1)
    matrix = coo_array((np.ones(len(a)), (a, b)), shape=(count, count)).tocsr()
    matrix = matrix + matrix.T
    matrix.data[:] = 1
    return matrix, np.asarray(matrix.sum(axis=1)).ravel()


def _ease_steps(w: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """Round off steps, but nowhere nearer than before: the minimum of each vertex and the mean around it, twice."""
    neighbours, degree = _adjacency(faces, len(w))
    for _ in range(2):
        w = np.minimum(w, (neighbours @ w) / degree)
    return w


def _push_behind(
    directions: Directions, w: NDArray[np.float64], mesh: Mesh, cameras: Sequence[Camera]
) -> tuple[NDArray[np.float64], bool]:
    """w, reduced at the faces that hide a part of the mesh from some camera, and whether there were any."""
    background = Mesh((directions.centre + directions.vectors / w[:, None]).astype(np.float32), directions.faces)

    def hiding_faces(camera: Camera) -> NDArray[np.int32]:
        small = _small_camera(camera)
        front, back = rasterise_view(mesh, small), rasterise_view(background, small)
        return np.unique(back.face[(front.face >= 0) & (back.inverse_depth > front.inverse_depth)])

    faces = np.unique(np.concatenate(parallel_map(hiding_faces, cameras)))
    result = w.copy()
    result[np.unique(directions.faces[faces])] *= 0.9
    return _ease_steps(result, directions.faces), bool(len(faces))
