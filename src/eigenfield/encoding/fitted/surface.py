"""The proxy's surface moved to where the photographs agree on it.

A mesh that was estimated or scanned is off by fractions of a pixel nearly everywhere, which blurs the mean and has
eigen textures spent on parallax. Each vertex may move along a line, a relief's along the ray of the camera that it
was made on, others along their normal. Where a point moves, a camera draws another texel of the mean there: by the
mean's slopes, the picture changes by g for a unit of the step. Gauss-Newton on all vertices: what the mean leaves of
the photographs, r, is to be g x for the steps x, less what is the same in all of them, for the mean takes that. Then
the mean is fitted again on the moved mesh, in turns.

Errors are divided by those around, so that glass and gloss, which no depth draws, move nothing. A prior keeps vertices
near their given places and together with their neighbours where the photographs do not determine them. Open edges of
what is no relief stay where they are: another surface may touch them there without a common vertex, and a gap would
show what is behind.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import logging
from collections.abc import Sequence
from contextlib import nullcontext
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter
from scipy.sparse import coo_array, csr_array, diags_array
from scipy.sparse.linalg import cg

from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh, vertex_normals
from eigenfield.core.observations import Observations, cameras_of, select_cameras
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy
from eigenfield.encoding.fitted.colour import split_matrix
from eigenfield.encoding.fitted.fit import FIT_MEAN_ITERATIONS, fit_mean
from eigenfield.encoding.fitted.kernels import adjoint, forward
from eigenfield.encoding.fitted.model import PlaneModel
from eigenfield.encoding.fitted.observations import FitData, open_fit_data, open_on_proxy, open_subsampled
from eigenfield.encoding.fitted.passes import MINUS
from eigenfield.encoding.fitted.solve import measure_scales, squared_shares
from eigenfield.encoding.fitted.surface_kernels import gather_steps
from eigenfield.encoding.geometry.distortion import spread_cameras, texels_of
from eigenfield.imaging.graph import face_edges
from eigenfield.runtime.parallel import parallel_map, parallel_stream, pieces

log = logging.getLogger("eigenfield.fit")

STEP_TASK_TEXELS = 1 << 16  # whose equations one thread adds to at a time

SURFACE_ROUNDS = 4  # of Gauss-Newton steps, at most
SURFACE_MEAN_ITERATIONS = 5  # of conjugate gradients, by which the mean follows the mesh after a round
SURFACE_MAX_CAMERAS = 49  # spread over the array, whose photographs are decoded
SURFACE_SUBSAMPLE_OBSERVATIONS = 25  # of these, from which every second pixel each way is enough
SURFACE_SUBSAMPLE_PIXELS = 1 << 25  # of all of them together, from which it is
SURFACE_STOP_FRACTION = 0.003  # of the squared error that a round must be expected to take off
SURFACE_STIFFNESS = 0.5  # cost of vertices a texel apart being a pixel further apart, beside the data's weight
SURFACE_RIDGE = 0.015  # likewise, of a texel being a pixel off its given place
SURFACE_MAX_STEP_PIXELS = 4.0  # of a vertex in a round
SURFACE_ERROR_SIGMA_TEXELS = 4.0  # standard deviation of the window in which errors are averaged
SURFACE_MIN_ERROR = 0.002  # in the photographs' range, that rounding leaves
SURFACE_MIN_SHARE_FRACTION = 1 / 8  # of the median texel's pixels that must show a texel for it to count
SURFACE_MAX_SIDE_TEXELS = 2048  # of the atlas
SURFACE_SAMPLE_POINTS = 2000  # by which the length of lines in pixels is measured


@dataclass(frozen=True, eq=False)
class MovableMesh:
    """A mesh as it was given, whose p points may move along lines.

    Attributes:
        given: The mesh, of n vertices.
        lattice: Of a relief; None for other meshes.
        lines: (p, 3) along which points move; a unit is about a pixel in the camera that moves most.
        shape: Rows and columns of the atlas.
        same: (n,) the point at which each vertex is; vertices that are doubled for their texture are at one.
        free: (p,) whether each point may move.
        owners: (rows, columns) the face of each texel, -1 where there is none.
        spread: (t, p) from points to the t covered texels.
        prior: (p, p) cost of displacements.
    """

    given: Mesh
    lattice: Lattice | None
    lines: NDArray[np.float64]
    shape: tuple[int, int]
    same: NDArray[np.int64]
    free: NDArray[np.bool_]
    owners: NDArray[np.int32]
    spread: csr_array
    prior: csr_array

    def displaced_mesh(self, off: NDArray[np.float64]) -> Mesh:
        """The mesh with its points `off` (p,) units from their given places."""
        vertices = self.given.vertices + (off[:, None] * self.lines)[self.same]
        return replace(self.given, vertices=vertices.astype(np.float32))


def fit_surface(
    proxy: Proxy,
    cameras: Sequence[Camera],
    observations: Observations,
    side: int,
    work: Path | None = None,
    progress: Progress | None = None,
) -> Proxy:
    """The proxy with its vertices moved to where a mean texture draws the photographs best; as it was where that does
    not help.

    Args:
        proxy: With UVs, the same at all times of the observations. Vertices of a relief stay on their rays of its
            lattice, others move along their normals.
        observations: Those of SURFACE_MAX_CAMERAS cameras, spread over the array, are decoded.
        side: Texels of the atlas, about a pixel each.

    Raises:
        CaptureError: A photograph cannot be read.
        OutputError: `disk-full`.
    """
    chosen = spread_cameras(cameras, SURFACE_MAX_CAMERAS)
    some, used = select_cameras(observations, chosen), [cameras[index] for index in chosen]
    shape = (min(side, SURFACE_MAX_SIDE_TEXELS),) * 2
    pixels = sum(used[camera].width * used[camera].height for camera in cameras_of(some))
    step = 2 if len(some) >= SURFACE_SUBSAMPLE_OBSERVATIONS or pixels > SURFACE_SUBSAMPLE_PIXELS else 1
    mesh = proxy.mesh
    movable = _movable_mesh(mesh, proxy.lattice, used, shape)
    best, reached, off = mesh, -np.inf, np.zeros(len(movable.lines))
    model = PlaneModel.grey(split_matrix()[0], shape)
    with open_fit_data(used, some, proxy, shape, work) as every:
        for number in range(SURFACE_ROUNDS + 1):
            if progress is not None:
                progress("fit surface", number, SURFACE_ROUNDS + 1)
            moved = open_on_proxy(every, used, replace(proxy, mesh=mesh), work) if number else nullcontext(every)
            with moved as whole, open_subsampled(whole, step, work) as data:
                iterations = SURFACE_MEAN_ITERATIONS if number else FIT_MEAN_ITERATIONS
                mean_alone = fit_mean(data, model, measure_scales(data, model), iterations)
                if not mean_alone.pixels.any():
                    break
                log.info("surface, after round %d: %.2f dB by the mean alone", number, mean_alone.psnr)
                if mean_alone.psnr <= reached:
                    break
                best, reached = mesh, mean_alone.psnr
                if number == SURFACE_ROUNDS:
                    break
                further, promised = _step(movable, mesh, off, data, used, model)
            if promised < SURFACE_STOP_FRACTION:
                break
            off += further
            mesh = movable.displaced_mesh(off)
    if progress is not None:
        progress("fit surface", SURFACE_ROUNDS + 1, SURFACE_ROUNDS + 1)
    return replace(proxy, mesh=best)


def _movable_mesh(
    mesh: Mesh, lattice: Lattice | None, cameras: Sequence[Camera], shape: tuple[int, int]
) -> MovableMesh:
    assert mesh.uv is not None
    found, same = np.unique(mesh.vertices, axis=0, return_inverse=True)
    points, same = found.astype(np.float64), same.reshape(-1)
    owners, corners, weights = texels_of(mesh, shape)
    rows = np.repeat(np.arange(len(corners)), 3)
    size = len(corners), len(points)
    spread = coo_array((weights.reshape(-1), (rows, same[corners].reshape(-1))), shape=size).tocsr()
    area: NDArray[np.float64] = np.asarray(spread.sum(axis=0)).reshape(-1)
    uv = mesh.uv.astype(np.float64) * [shape[1], shape[0]]
    stiff = SURFACE_STIFFNESS * _laplacian(same, mesh.faces, uv)
    prior = stiff + SURFACE_RIDGE * diags_array(np.maximum(area, 1))
    lines = _lines(points, same[mesh.faces], lattice, cameras)
    free = np.ones(len(points), bool)
    if lattice is None:
        free[_open_points(same[mesh.faces])] = False
    return MovableMesh(mesh, lattice, lines, shape, same, free, owners, spread, prior.tocsr())


def _step(
    movable: MovableMesh,
    mesh: Mesh,
    off: NDArray[np.float64],
    data: FitData,
    cameras: Sequence[Camera],
    model: PlaneModel,
) -> tuple[NDArray[np.float64], float]:
    """The (p,) steps of points that are `off` (p,), as in `mesh`, in a round, and the fraction of the squared error
    that they are expected to take off."""
    step, spread, free = np.zeros(len(off)), movable.spread, np.flatnonzero(movable.free)
    if not len(free):
        return step, 0.0
    pull, weight, scale, squares = _step_equations(movable, mesh, data, cameras, model)
    normal = (spread.T @ diags_array(weight) @ spread + movable.prior).tocsr()[free][:, free]
    right = np.asarray(spread.T @ pull - movable.prior @ off)[free]
    found, _ = cg(normal, right, rtol=1e-4, maxiter=400, M=diags_array(1 / normal.diagonal()))
    step[free] = found.clip(-SURFACE_MAX_STEP_PIXELS, SURFACE_MAX_STEP_PIXELS)
    moved = spread @ step
    less = ((2 * moved * pull - moved * moved * weight) / scale).sum()
    return step, float(less) / max(squares, 1e-12)


def _step_equations(
    movable: MovableMesh, mesh: Mesh, data: FitData, cameras: Sequence[Camera], model: PlaneModel
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], float]:
    """Least squares of the steps of points in t covered texels: the sum of weight (step - pull / weight)^2.

    Returns:
        (t,) pull. (t,) weight: the squared change for a unit over the mean squared error around, less for fewer
        cameras. (t,) by which both are greater than in the pictures. The squared error of all pictures.
    """
    covered, mean, observations = movable.owners >= 0, model.mean[0], data.observations
    places = np.zeros(movable.lines.shape)
    places[movable.same] = mesh.vertices
    points, steps = movable.spread @ places, movable.spread @ movable.lines
    slopes = np.stack([np.gradient(mean, axis=1)[covered], np.gradient(mean, axis=0)[covered]], axis=1)
    tangents, faces = _tangents(mesh, movable.lattice, movable.shape), movable.owners[covered]

    def backproject(index: int) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.float32]]:
        footprint, weight, image = data.footprint(index), observations.weights(index), data.target(index, model.matrix)
        forward(*footprint, data.size, model.mean, MINUS, image)
        asked, seen, errors = (np.zeros_like(model.mean) for _ in range(3))
        adjoint(*footprint, data.size, image, weight, asked)
        adjoint(*squared_shares(footprint), data.size, np.ones_like(image), weight, seen)
        adjoint(*footprint, data.size, np.square(image), weight, errors)
        return asked[0][covered], seen[0][covered], errors[0]

    sums, squares = np.zeros((len(points), 5)), np.zeros_like(mean)
    tasks = [slice(*part) for part in pieces(len(points), STEP_TASK_TEXELS)]
    for index, (asked, seen, errors) in enumerate(parallel_stream(backproject, range(len(data)))):
        projection = cameras[observations.camera_of(index)].matrix

        def gather(some: slice, projection=projection, asked=asked, seen=seen) -> None:  # type: ignore[no-untyped-def]
            texels = (each[some] for each in (points, steps, faces, slopes, asked, seen, sums))
            gather_steps(projection, tangents, *texels)

        parallel_map(gather, tasks)
        squares += errors
    pull, weight, first, shown, rest = sums.T.copy()
    least = np.maximum(shown, 1e-6)
    weight -= np.square(first) / least  # what is the same in all of them the mean takes
    pull -= first * rest / least
    usual = float(np.median(shown[shown > 0])) if (shown > 0).any() else 1.0
    trusted = (weight > 0) & (shown > SURFACE_MIN_SHARE_FRACTION * usual)
    often = np.zeros_like(mean)
    often[covered] = shown
    sigma = SURFACE_ERROR_SIGMA_TEXELS
    error = gaussian_filter(squares, sigma) / np.maximum(gaussian_filter(often, sigma), 1e-6)
    sure = len(cameras) / SURFACE_MAX_CAMERAS  # fewer cameras separate light from depth less well
    scale = sure / (usual * np.maximum(error[covered].astype(np.float64), SURFACE_MIN_ERROR**2))
    return np.where(trusted, pull, 0) * scale, np.where(trusted, weight, 0) * scale, scale, float(squares.sum())


def _lines(
    points: NDArray[np.float64], faces: NDArray[np.int64], lattice: Lattice | None, cameras: Sequence[Camera]
) -> NDArray[np.float64]:
    """(p, 3) of a `MovableMesh`; longer with the square of the distance, so that a unit is as much parallax everywhere.
    faces: (m, 3) of points."""
    if lattice is not None:
        exact = lattice.coordinates(points)
        lines = lattice.points(exact + np.array([0, 0, 1])) - lattice.points(exact)
    else:
        normals = vertex_normals(points, faces)
        middle = np.mean([camera.centre for camera in cameras], axis=0)
        lines = normals * np.square(points - middle).sum(axis=1, keepdims=True)
    few = np.unique(np.linspace(0, len(points) - 1, min(len(points), SURFACE_SAMPLE_POINTS)).astype(int))
    length = max(float(np.linalg.norm(lines[few])), 1e-30)
    small = 1e-4 * float(np.linalg.norm(points[few] - cameras[0].centre)) / length
    most = 0.0
    for camera in cameras:
        (at, depth), (beside, _) = camera.project(points[few]), camera.project(points[few] + small * lines[few])
        if (depth > 0).any():
            most = max(most, float(np.median(np.linalg.norm(beside - at, axis=1)[depth > 0])) / small)
    return lines / most if most > 0 else np.zeros_like(lines)


def _tangents(mesh: Mesh, lattice: Lattice | None, shape: tuple[int, int]) -> NDArray[np.float64]:
    """(m, 2, 3) for each face how the world's point moves for a texel to the right, and one down. A relief's faces are
    taken as if they faced its camera: those that are steep, across steps of depth, would outweigh all others."""
    assert mesh.uv is not None
    uv = (mesh.uv.astype(np.float64) * [shape[1], shape[0]])[mesh.faces]
    points = mesh.vertices.astype(np.float64)[mesh.faces]
    if lattice is not None:
        exact = lattice.coordinates(points.reshape(-1, 3)).reshape(-1, 3, 3)
        exact[..., 2] = exact[..., 2].mean(axis=1, keepdims=True)
        points = lattice.points(exact.reshape(-1, 3)).reshape(-1, 3, 3)
    (a, b), (c, d) = (uv[:, 1] - uv[:, 0]).T, (uv[:, 2] - uv[:, 0]).T
    one, other = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    area = a * d - b * c
    over = np.divide(1, area, out=np.zeros_like(area), where=np.abs(area) > 1e-12)[:, None]
    return np.stack([(one * d[:, None] - other * b[:, None]) * over, (other * a[:, None] - one * c[:, None]) * over], 1)


def _open_points(faces: NDArray[np.int64]) -> NDArray[np.int64]:
    """Points on edges of one face only. faces: (m, 3) of points."""
    ends, edge = face_edges(faces)
    return np.unique(ends[np.bincount(edge)[edge] == 1])


def _laplacian(same: NDArray[np.int64], faces: NDArray[np.int32], uv: NDArray[np.float64]) -> coo_array:
    """(p, p) of the mesh's edges, the weight of one in inverse proportion to its length in texels, which are what uv
    (n, 2) counts. same: see `MovableMesh`."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    ends, some = np.unique(np.sort(same[edges], axis=1), axis=0, return_index=True)
    strength = 1 / np.maximum(np.linalg.norm(uv[edges[some, 0]] - uv[edges[some, 1]], axis=1), 1)
    one, other = ends.T
    places = np.concatenate([one, other, one, other]), np.concatenate([one, other, other, one])
    count = int(same.max()) + 1
    return coo_array((np.concatenate([strength, strength, -strength, -strength]), places), shape=(count, count))
