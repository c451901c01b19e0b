"""A far surface behind everything, so that every ray of every camera ends somewhere.

Both kinds are a relief over directions from a centre: vertex = centre + direction / w, with one inverse distance w a
direction. For cameras that look one way it is a sheet over the plane of a virtual camera in the array's middle; for
cameras that look at each other's places, a dome about them. In each direction b_i is the farthest of what was
reconstructed, and a morphological opening takes out what stands before it and is small: the sheet goes on behind it. w
is the thin plate under tension, with c_i the share of samples,

    sum_i c_i (w_i - b_i)^2 + STIFFNESS sum_i (L w)_i^2 + TENSION w . L w,

so a plane, affine in w, is continued for a while beyond what was seen of it, and nothing runs away.
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
from eigenfield.proxy.surface.trim import surface_samples
from eigenfield.proxy.topology import compact
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.proxy")

CELLS = 56  # of the sheet along its longer side
WIDEST = 70.0  # degrees from the middle axis that a sheet reaches; cameras that look farther aside get a dome
BEYOND = 0.08  # of the sheet's size, added on every side
BEHIND = 0.01  # relative: the sheet is that much farther than what it hides
STIFFNESS = 30.0  # against one direction that is full of samples: bends are a few directions wide
TENSION = 0.5
OPENING = 8  # directions: what is less than twice as wide counts as standing before the background
SAMPLES = 200_000
FARTHEST = 0.1  # quantile of inverse distance in a cell that counts as its background
LIMIT = 0.5  # of the scene's smallest inverse distance (1st percentile): the background is no farther
DOME_LEVEL = 4  # subdivisions of an icosahedron: 2562 directions
CLEARANCE = 1.3  # times the distance of a camera from the dome's centre
LOOK = 256  # longer side of the pictures in which is looked what of the background is seen
ROUNDS = 6  # of pulling the sheet behind what still sticks through it


@dataclass(frozen=True, eq=False)
class Directions:
    """A fan of directions from a centre, joined by triangles that face the centre.

    centre: (3,). vectors: (n, 3), not of unit length in a sheet: their component along the axis is 1, so that w is
    inverse depth. faces: (m, 3). axis: (3, 3) rotation to the middle camera for a sheet; None: a dome.
    """

    centre: NDArray[np.float64]
    vectors: NDArray[np.float64]
    faces: NDArray[np.int32]
    axis: NDArray[np.float64] | None

    def of(self, positions: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(n, 2 or 3) keys in which directions are near each other, and (n,) w, of points; w <= 0 behind a sheet."""
        offset = positions - self.centre
        if self.axis is None:
            length = np.maximum(np.linalg.norm(offset, axis=1), 1e-12)
            return offset / length[:, None], 1 / length
        local = offset @ self.axis.T
        with np.errstate(divide="ignore", invalid="ignore"):
            return local[:, :2] / local[:, 2:], 1 / local[:, 2]

    @property
    def keys(self) -> NDArray[np.float64]:
        """`of` the directions themselves."""
        return self.of(self.centre + self.vectors)[0]


def fill_background(mesh: Mesh, cameras: Sequence[Camera]) -> Mesh:
    """The mesh and a far surface behind it: every pixel of every camera is covered.

    Cameras that look one way get a sheet, others a dome around them all. Only what some camera sees of it is kept,
    with a ring of triangles around. The mesh's UVs are dropped. Raises ProxyError `surface-empty` for an empty mesh.
    """
    if len(mesh.faces) == 0:
        raise ProxyError("surface-empty", "the surface is empty", remedy="check the calibration and the depth range")
    samples, _ = surface_samples(mesh, SAMPLES)
    directions = _sheet(samples, cameras) or _dome(samples, cameras)
    far = _relief(directions, samples, cameras)
    for _ in range(ROUNDS):
        w, hidden = _pulled(directions, far, mesh, cameras)
        if not hidden:
            break
        far = w
    background = Mesh((directions.centre + directions.vectors / far[:, None]).astype(np.float32), directions.faces)
    both = joined(mesh, background)
    kept = np.append(np.ones(len(mesh.faces), np.bool_), seen_faces(both, cameras)[len(mesh.faces) :])
    kept[len(mesh.faces) :] = with_ring(background.faces, kept[len(mesh.faces) :])
    log.info(
        "background: a %s of %d triangles", "dome" if directions.axis is None else "sheet", kept.sum() - len(mesh.faces)
    )
    return compact(Mesh(both.vertices, both.faces[kept]))


def joined(*meshes: Mesh) -> Mesh:
    """Several meshes as one, their vertices apart, without UVs."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    return Mesh(
        np.concatenate([mesh.vertices for mesh in meshes]),
        np.concatenate([mesh.faces + np.int32(start) for mesh, start in zip(meshes, starts, strict=False)]),
    )


def coverage(mesh: Mesh, cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """(n,) the part of each camera's pixels on which the mesh puts surface."""
    return np.array(parallel_map(lambda camera: float((rasterise_view(mesh, camera).face >= 0).mean()), cameras))


def seen_faces(mesh: Mesh, cameras: Sequence[Camera]) -> NDArray[np.bool_]:
    """(m,) which faces are nearest at some pixel of some camera, looked at in small pictures."""
    seen = np.zeros(len(mesh.faces), np.bool_)
    for faces in parallel_map(lambda camera: np.unique(rasterise_view(mesh, _small(camera)).face), cameras):
        seen[faces[faces >= 0]] = True
    return seen


def _small(camera: Camera) -> Camera:
    scale = min(1.0, LOOK / max(camera.width, camera.height))
    return camera.resized(max(1, round(camera.width * scale)), max(1, round(camera.height * scale)))


def with_ring(faces: NDArray[np.int32], chosen: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """With all faces that share a corner with the chosen ones."""
    touched = np.zeros(int(faces.max()) + 1, np.bool_)
    touched[faces[chosen]] = True
    return np.asarray(touched[faces].any(axis=1))


def corner_rays(camera: Camera) -> NDArray[np.float64]:
    """(16, 3) world directions of depth 1 around a camera's frame."""
    t = np.linspace(0, 1, 5)[:-1]
    x = np.concatenate([t, np.ones(4), 1 - t, np.zeros(4)]) * camera.width
    y = np.concatenate([np.zeros(4), t, np.ones(4), 1 - t]) * camera.height
    return np.stack([x, y, np.ones(16)], axis=1) @ np.linalg.inv(camera.K).T @ camera.R


def _sheet(samples: NDArray[np.float64], cameras: Sequence[Camera]) -> Directions | None:
    """Directions over the plane of a camera in the array's middle; None where a ray would look past its reach."""
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
    w_low, w_high = _range(1 / depth[ahead])
    low, high = np.full(2, np.inf), np.full(2, -np.inf)
    steepest = np.tan(np.radians(WIDEST))
    for camera in cameras:
        rays = corner_rays(camera) @ axis.T
        if (rays[:, 2] * steepest <= np.hypot(rays[:, 0], rays[:, 1])).any():
            return None
        local = axis @ (camera.centre - centre)
        for w in (w_low, w_high):
            step = (1 / w - local[2]) / rays[:, 2:]
            if (step <= 0).any():
                continue  # a camera ahead of the nearest things: only the far end counts
            at = (local[:2] + step * rays[:, :2]) * w
            low, high = np.minimum(low, at.min(axis=0)), np.maximum(high, at.max(axis=0))
    size = high - low
    low, high = low - BEYOND * size.max(), high + BEYOND * size.max()
    cell = float((high - low).max()) / CELLS
    columns, rows = (int(n) for n in np.ceil((high - low) / cell).astype(int) + 1)
    x, y = np.meshgrid(low[0] + cell * np.arange(columns), low[1] + cell * np.arange(rows))
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    # y is down and the sheet faces the camera: counter-clockwise as it sees it
    faces = np.concatenate(
        [
            np.stack([first, first + columns, first + 1], axis=1),
            np.stack([first + 1, first + columns, first + columns + 1], axis=1),
        ]
    )
    vectors = np.stack([x.ravel(), y.ravel(), np.ones(x.size)], axis=1) @ axis
    return Directions(centre, vectors, faces.astype(np.int32), axis)


def _dome(samples: NDArray[np.float64], cameras: Sequence[Camera]) -> Directions:
    """All directions from the middle of the cameras."""
    import trimesh

    sphere = trimesh.creation.icosphere(DOME_LEVEL)
    centre = np.mean([camera.centre for camera in cameras], axis=0)
    faces = np.ascontiguousarray(np.asarray(sphere.faces)[:, ::-1]).astype(np.int32)  # seen from inside
    return Directions(centre, np.asarray(sphere.vertices, np.float64), faces, None)


def _range(w: NDArray[np.float64]) -> tuple[float, float]:
    """The smallest and the largest inverse distance that the background may have."""
    low, high = np.percentile(w, [1, 99])
    return LIMIT * float(low), float(high)


def _relief(directions: Directions, samples: NDArray[np.float64], cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """(n,) w of each direction: see the module."""
    from scipy.spatial import KDTree

    key, w = directions.of(samples)
    ceiling = _clearance(directions, cameras)
    tree = KDTree(directions.keys)
    if directions.axis is not None:
        ahead = w > 0
        key, w = key[ahead], w[ahead]
    nearest = np.asarray(tree.query(key)[1], np.int64)
    count = len(directions.vectors)
    outside = w < ceiling[nearest]  # what lies between the cameras is no background
    low = _range(w[outside] if outside.any() else ceiling)[0]
    target, weight = _quantiles(nearest[outside], w[outside], count)
    if not (weight > 0).any():
        target, weight = ceiling * 0.5, np.full(count, 1e-3)
    target = _opened(directions.faces, target, weight > 0)
    smooth = np.clip(_plate(directions.faces, target, weight), low, w[outside].max() if outside.any() else None)
    envelope = np.minimum(_minimum(nearest[outside], w[outside], count), ceiling)
    result = np.minimum(smooth, envelope * (1 - BEHIND))
    return _eased(np.clip(result, low, None), directions.faces)


def _plate(faces: NDArray[np.int32], target: NDArray[np.float64], weight: NDArray[np.float64]) -> NDArray[np.float64]:
    count = len(target)
    laplacian = _laplacian(faces, count)
    ends, number = face_edges(faces)
    inner = np.ones(count)
    inner[ends[np.bincount(number)[number] == 1]] = 0  # the bend is not defined at the border
    bend = diags_array(inner) @ laplacian
    stiff = STIFFNESS * (bend.T @ bend) + TENSION * laplacian + diags_array(weight + 1e-9)
    return np.asarray(spsolve(stiff.tocsc(), weight * target))


def _opened(faces: NDArray[np.int32], target: NDArray[np.float64], known: NDArray[np.bool_]) -> NDArray[np.float64]:
    """The target without peaks less than 2 OPENING directions wide; unchanged where it is not known."""
    a = faces.reshape(-1)
    b = np.roll(faces, -1, axis=1).reshape(-1)

    def spread(values: NDArray[np.float64], least: np.ufunc) -> NDArray[np.float64]:
        for _ in range(OPENING):
            result = values.copy()
            least.at(result, a, values[b])
            least.at(result, b, values[a])
            values = result
        return values

    eroded = spread(np.where(known, target, np.inf), np.minimum)
    opened = spread(np.where(np.isfinite(eroded), eroded, -np.inf), np.maximum)
    return np.where(known, np.minimum(target, opened), target)


def _quantiles(
    cell: NDArray[np.int64], w: NDArray[np.float64], count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Of the samples in each cell, the low quantile of w, and a weight of 0 (none) to 1 (as many as in most)."""
    order = np.lexsort((w, cell))
    number = np.bincount(cell, minlength=count)
    first = np.cumsum(number) - number
    target = np.zeros(count)
    full = number > 0
    target[full] = w[order][(first + FARTHEST * np.maximum(number - 1, 0)).astype(np.int64)[full]]
    typical = float(np.median(number[full])) if full.any() else 1.0
    return target, np.minimum(number / typical, 1.0)


def _minimum(cell: NDArray[np.int64], w: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    result = np.full(count, np.inf)
    np.minimum.at(result, cell, w)
    return result


def _clearance(directions: Directions, cameras: Sequence[Camera]) -> NDArray[np.float64]:
    """(n,) the largest w that keeps every camera well on the near side."""
    if directions.axis is not None:
        return np.full(len(directions.vectors), np.inf)
    farthest = max(float(np.linalg.norm(camera.centre - directions.centre)) for camera in cameras)
    return np.full(len(directions.vectors), 1 / (CLEARANCE * farthest) if farthest > 0 else np.inf)


def _adjacency(faces: NDArray[np.int32], count: int) -> csr_array:
    a = faces.reshape(-1)
    b = np.roll(faces, -1, axis=1).reshape(-1)
    matrix = coo_array((np.ones(len(a)), (a, b)), shape=(count, count)).tocsr()
    matrix = matrix + matrix.T
    matrix.data[:] = 1
    return matrix


def _laplacian(faces: NDArray[np.int32], count: int) -> csr_array:
    neighbours = _adjacency(faces, count)
    return diags_array(np.asarray(neighbours.sum(axis=1)).ravel()) - neighbours


def _eased(w: NDArray[np.float64], faces: NDArray[np.int32]) -> NDArray[np.float64]:
    """Steps rounded off, but nowhere nearer than before: the least of each vertex and the mean around it, twice."""
    neighbours = _adjacency(faces, len(w))
    degree = np.asarray(neighbours.sum(axis=1)).ravel()
    for _ in range(2):
        w = np.minimum(w, (neighbours @ w) / degree)
    return w


def _pulled(
    directions: Directions, w: NDArray[np.float64], mesh: Mesh, cameras: Sequence[Camera]
) -> tuple[NDArray[np.float64], bool]:
    """w, smaller at the faces that hide a part of the mesh from some camera, and whether there were any."""
    background = Mesh((directions.centre + directions.vectors / w[:, None]).astype(np.float32), directions.faces)

    def hiding(camera: Camera) -> NDArray[np.int32]:
        small = _small(camera)
        front, back = rasterise_view(mesh, small), rasterise_view(background, small)
        return np.unique(back.face[(front.face >= 0) & (back.inverse_depth > front.inverse_depth)])

    faces = np.unique(np.concatenate(parallel_map(hiding, cameras)))
    result = w.copy()
    result[np.unique(directions.faces[faces])] *= 0.9
    return _eased(result, directions.faces), bool(len(faces))
