"""The lattice of a relief: the camera whose pixels its texture coordinates are.

A relief is the picture of one camera pushed into depth. Its texture coordinates are that camera's pixels, up to a
scale, and a shift of each chart. Vertices stand on whole pixels, those of contours between them. On the recovered
lattice such a vertex costs little more than its depth. The camera is one of the array, or a virtual one that is found
by the rows and columns of vertices.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median

from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice, camera_lattice
from eigenfield.core.mesh import Mesh
from eigenfield.core.proxy import Proxy
from eigenfield.imaging.graph import vertex_components

LATTICE_MAX_VERTICES = 4000  # vertices that the camera is fitted to
LATTICE_MAX_COORDINATE_STEPS = 2**20 - 1  # largest magnitude of a lattice coordinate
LATTICE_MAX_ERROR_PIXELS = 0.05  # distance of vertices from the fitted camera, in pixels of the lattice
LATTICE_MIN_WHOLE_FRACTION = 0.7  # fraction of the vertices that must stand on whole pixels
LATTICE_MAX_UV_ERROR_PIXELS = 0.5  # distance of texture coordinates from the camera's pixels, shifted chart by chart
# Fraction of the vertices that must keep it: a flat wall behind a scene does not make it a relief
LATTICE_MIN_UV_FRACTION = 0.999
LATTICE_CONTOUR_DIGITS = 2  # binary digits that vertices of contours may have
LATTICE_SPECTRUM_BINS = 2**16  # bins of a chart's extent, in which columns are searched
LATTICE_SPECTRUM_OVERSAMPLING = 8  # how much finer than the bins their number is searched
LATTICE_MIN_COLUMNS = 16  # columns of a chart, at least
LATTICE_MAX_COLUMNS = 8192  # columns of a chart, at most
LATTICE_MIN_PEAK_FRACTION = 0.75  # height of the coarsest peak, relative to the highest
LATTICE_SAME_PEAK_FRACTION = 0.95  # two peaks are equally high if the lower has this fraction of the other
LATTICE_MIN_PEAK_NOISE_RATIO = 6.0  # height of a peak, relative to that of random phases


def relief_proxy(mesh: Mesh, cameras: Sequence[Camera], depth_error: float) -> Proxy:
    """The mesh with its lattice, if it is a relief."""
    return Proxy(mesh, relief_lattice(mesh, cameras, depth_error))


def relief_lattice(mesh: Mesh, cameras: Sequence[Camera], depth_error: float) -> Lattice | None:
    """The lattice of a relief; None for other meshes.

    Args:
        cameras: The array, one of which may be the relief's camera.
        depth_error: Pixels by which a rounded depth may move a point in the camera that it moves most.
    """
    assert mesh.uv is not None
    label = vertex_components(mesh.faces, len(mesh.vertices))
    chart = np.flatnonzero(label == np.argmax(np.bincount(label)))
    chart = chart[np.linspace(0, len(chart) - 1, min(LATTICE_MAX_VERTICES, len(chart))).astype(int)]
    place, uv = mesh.vertices[chart].astype(np.float64), mesh.uv[chart].astype(np.float64)
    matrix = _camera_from_columns(place, uv)
    if matrix is None:
        matrices = (camera.matrix for camera in cameras)
        matrix = next((m for m in matrices if _is_camera_of(m, place, uv)), None)
    if matrix is None:
        return None
    found = mesh.vertices.astype(np.float64) @ matrix[:, :3].T + matrix[:, 3]
    if not (found[:, 2] > 0).all():
        return None
    drawn = found[:, :2] / found[:, 2:]
    if not _is_affine_by_chart(drawn, mesh.uv.astype(np.float64), label, chart):
        return None
    fine = 0 if _whole_fraction(drawn - _phase(drawn)) > 0.999 else LATTICE_CONTOUR_DIGITS
    return _lattice(matrix, mesh, cameras, depth_error, _phase(drawn), fine)


def lattice_of_camera(
    matrix: NDArray[np.float64], mesh: Mesh, cameras: Sequence[Camera], depth_error: float
) -> Lattice | None:
    """The lattice of a relief whose camera is known; None if rounding to it would move vertices.

    Args:
        matrix: (3, 4) of that camera, whose pixels' centres most vertices stand on.
    """
    return _lattice(matrix, mesh, cameras, depth_error, np.array([0.5, 0.5]), LATTICE_CONTOUR_DIGITS)


def _lattice(
    matrix: NDArray[np.float64],
    mesh: Mesh,
    cameras: Sequence[Camera],
    depth_error: float,
    origin: NDArray[np.float64],
    fine: int,
) -> Lattice | None:
    nearest = (mesh.vertices.astype(np.float64) @ matrix[2, :3] + matrix[2, 3]).min()
    centre = -np.linalg.inv(matrix[:, :3]) @ matrix[:, 3]
    moved = np.linalg.norm([(matrix[:, :3] @ (centre - camera.centre))[:2] for camera in cameras], axis=1).max()
    step = max(2 * depth_error / max(float(moved), 1e-9), float(1 / nearest / 2**19))
    lattice = camera_lattice(matrix, 2.0**-fine, step, (float(origin[0]), float(origin[1])))
    return replace(lattice, fine=fine) if _rounding_is_harmless(lattice, mesh, cameras) else None


def _rounding_is_harmless(lattice: Lattice, mesh: Mesh, cameras: Sequence[Camera]) -> bool:
    """Whether rounding to the lattice moves vertices by less than a pixel; a degenerate camera fails."""
    steps = np.rint(lattice.coordinates(mesh.vertices))
    if not (np.abs(steps) < LATTICE_MAX_COORDINATE_STEPS).all():
        return False
    rounded = lattice.points(steps.astype(np.int64))
    for camera in (cameras[0], cameras[-1]):
        before, depth = camera.project(mesh.vertices)
        moved = np.abs(camera.project(rounded)[0] - before)[depth > 0]
        if not (moved < 1).all():
            return False
    return True


def _camera_from_columns(place: NDArray[np.float64], uv: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """The camera of a relief whose vertices stand in rows and columns: those are its pixels."""
    spacing = np.array([_column_spacing(uv[:, 0]), _column_spacing(uv[:, 1])])
    if len(place) < 16 or not (spacing > 0).all():
        return None
    matrix = _direct_linear_transform(place, uv / spacing)
    if matrix is None:
        return None
    found = place @ matrix[:, :3].T + matrix[:, 3]
    drawn = found[:, :2] / found[:, 2:]
    if not (found[:, 2] > 0).all() or np.quantile(np.abs(drawn - uv / spacing), 0.99) > LATTICE_MAX_ERROR_PIXELS:
        return None
    return matrix if _whole_fraction(drawn - _phase(drawn)) > LATTICE_MIN_WHOLE_FRACTION else None


def _is_camera_of(matrix: NDArray[np.float64], place: NDArray[np.float64], uv: NDArray[np.float64]) -> bool:
    """Whether texture coordinates are an affine map of a camera's pixels."""
    found = place @ matrix[:, :3].T + matrix[:, 3]
    if not (found[:, 2] > 0).all() or len(place) < 16:
        return False
    pixels = np.concatenate([found[:, :2] / found[:, 2:], np.ones((len(place), 1))], axis=1)
    affine = np.linalg.lstsq(pixels, uv, rcond=None)[0]
    size = np.sqrt(abs(np.linalg.det(affine[:2])))
    return bool(size > 0 and np.quantile(np.abs(pixels @ affine - uv), 0.99) < LATTICE_MAX_ERROR_PIXELS * size)


def _is_affine_by_chart(
    pixels: NDArray[np.float64], uv: NDArray[np.float64], label: NDArray[np.int32], chart: NDArray[np.int64]
) -> bool:
    """Whether texture coordinates are pixels under one affine map, up to a shift of each chart.

    label: (n,) charts of the vertices. chart: vertices of one chart, to which the map is fitted.
    """
    affine = np.linalg.lstsq(np.column_stack([uv[chart], np.ones(len(chart))]), pixels[chart], rcond=None)[0]
    off = pixels - uv @ affine[:2]
    shift = [median(along, label, np.arange(label.max() + 1)) for along in off.T]
    off -= np.stack(shift, axis=1)[label]
    return bool((np.abs(off).max(axis=1) < LATTICE_MAX_UV_ERROR_PIXELS).mean() > LATTICE_MIN_UV_FRACTION)


def _whole_fraction(pixels: NDArray[np.float64]) -> float:
    """The fraction of (n, 2) coordinates that are whole."""
    return float(np.mean(np.abs(pixels - np.rint(pixels)).max(axis=1) < LATTICE_MAX_ERROR_PIXELS))


def _column_spacing(values: NDArray[np.float64]) -> float:
    """Distance of neighbouring columns (or rows) of vertices in texture coordinates; 0 if there are none.

    The most vertices stand on whole columns where |sum exp(2 pi i n u)|, at n columns to the atlas, is largest. Finer
    columns have equally large sums, because half a column fits as well.
    """
    low, high = float(values.min()), float(values.max())
    if len(values) < 16 or not high - low > 0:
        return 0.0
    bins, finer = LATTICE_SPECTRUM_BINS, LATTICE_SPECTRUM_OVERSAMPLING
    counts = np.bincount(((values - low) / (high - low) * (bins - 1)).round().astype(np.int64), minlength=bins)
    length = np.abs(np.fft.rfft(counts, finer * bins))[: finer * LATTICE_MAX_COLUMNS] / len(values)
    length[: finer * LATTICE_MIN_COLUMNS] = 0

    def coarsest_peak(height: float) -> int:
        first = int(np.argmax(length > height))
        return first + int(np.argmax(length[first : first + finer]))

    near = coarsest_peak(LATTICE_MIN_PEAK_FRACTION * length.max())
    near = coarsest_peak(LATTICE_SAME_PEAK_FRACTION * length[near])  # a coarser one may just miss the limit
    if not length[near] > LATTICE_MIN_PEAK_NOISE_RATIO / np.sqrt(len(values)):
        return 0.0
    columns = near * (bins - 1) / (finer * bins) / (high - low)
    for step in (0.1, 0.01, 0.001):  # of a column, over the whole extent
        tried = columns + np.arange(-10, 11) * step / (high - low)
        columns = float(tried[np.argmax(np.abs(np.exp(2j * np.pi * np.outer(tried, values)).mean(axis=1)))])
    return 1 / columns


def _direct_linear_transform(places: NDArray[np.float64], pixels: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """(3, 4) matrix of the camera that sees (n, 3) places at (n, 2) pixels, by the direct linear transform.

    Its last row measures depth in the world's unit.
    """
    x, p = places, pixels
    middle, size = x.mean(axis=0), max(float(x.std()), 1e-12)
    centre, reach = p.mean(axis=0), max(float(p.std()), 1e-12)
    h = np.concatenate([(x - middle) / size, np.ones((len(x), 1))], axis=1)
    q = (p - centre) / reach
    zero = np.zeros_like(h)
    rows = np.concatenate([np.hstack([h, zero, -q[:, :1] * h]), np.hstack([zero, h, -q[:, 1:] * h])])
    _, values, vectors = np.linalg.svd(rows, full_matrices=False)
    if values[-2] < 1e-7 * values[0]:  # flat: the camera is not determined
        return None
    back = np.array([[reach, 0, centre[0]], [0, reach, centre[1]], [0, 0, 1]])
    into = np.diag([1 / size, 1 / size, 1 / size, 1.0])
    into[:3, 3] = -middle / size
    matrix: NDArray[np.float64] = back @ vectors[-1].reshape(3, 4) @ into
    length = np.linalg.norm(matrix[2, :3])
    if length < 1e-12 * np.abs(matrix).max() or abs(np.linalg.det(matrix[:, :3])) < 1e-12 * length**3:
        return None
    matrix /= length
    return matrix if (places @ matrix[2, :3] + matrix[2, 3]).mean() > 0 else -matrix


def _phase(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """(2,) the fraction of a pixel at which most coordinates stand."""
    turns = np.exp(2j * np.pi * values)
    first = np.angle(turns.mean(axis=0)) / (2 * np.pi)
    rest = values - first
    near = np.abs(rest - np.rint(rest)) < 0.1
    return np.asarray(first + np.array([np.median((rest - np.rint(rest))[near[:, k], k]) for k in range(2)]))
