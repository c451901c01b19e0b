"""The lattice that a relief was made on: the camera whose pixels its texture coordinates are.

A relief is the picture of one camera pushed into depth: its texture coordinates are that camera's pixels, but for a
scale, and a shift of each chart; vertices stand on whole pixels, those of contours between them. Found again, such a
vertex costs its depth and little else. That camera is one of the array, or a virtual one that tells itself by rows and
columns.
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

SOME = 4000  # vertices that the camera is fitted to
REACH = 2**20 - 1  # of lattice coordinates, either way
OFF = 0.05  # pixels of the lattice by which vertices may be off the fitted camera
WHOLE = 0.7  # of the vertices must stand on whole pixels
NEAR = 0.5  # pixels of the lattice that texture coordinates may be off the camera's, shifted chart by chart ..
NEARLY_ALL = 0.999  # .. at so much of the vertices: what stands before a flat wall is no relief for the wall's sake
FINE = 2  # binary digits that those of contours may have
BINS, OVER = 2**16, 8  # of a chart's extent, in which columns are looked for; how much finer their number is looked at
FEWEST_COLUMNS, MOST_COLUMNS = 16, 8192  # of a chart
CLEAR = 0.75  # of the longest sum, for the coarsest columns
STRAY = 6.0  # times what a sum of random turns has


def relief_proxy(mesh: Mesh, cameras: Sequence[Camera], depth_error: float) -> Proxy:
    """The mesh with its lattice, if it is a relief; arguments as `relief_lattice`."""
    return Proxy(mesh, relief_lattice(mesh, cameras, depth_error))


def relief_lattice(mesh: Mesh, cameras: Sequence[Camera], depth_error: float) -> Lattice | None:
    """The lattice that a relief was made on; None for other meshes.

    Args:
        mesh: With UVs.
        cameras: Those that may have made it, and in which a rounded depth counts.
        depth_error: Pixels by which a rounded depth may move a point in the camera that it moves most.
    """
    assert mesh.uv is not None
    label = vertex_components(mesh.faces, len(mesh.vertices))
    chart = np.flatnonzero(label == np.argmax(np.bincount(label)))
    chart = chart[np.linspace(0, len(chart) - 1, min(SOME, len(chart))).astype(int)]
    place, uv = mesh.vertices[chart].astype(np.float64), mesh.uv[chart].astype(np.float64)
    matrix = _of_columns(place, uv)
    if matrix is None:
        matrix = next((m for m in map(_matrix, cameras) if _draws(m, place, uv)), None)
    if matrix is None:
        return None
    found = mesh.vertices.astype(np.float64) @ matrix[:, :3].T + matrix[:, 3]
    if not (found[:, 2] > 0).all():
        return None
    drawn = found[:, :2] / found[:, 2:]
    if not _shifted(drawn, mesh.uv.astype(np.float64), label, chart):
        return None
    origin = _phase(drawn)
    fine = 0 if _whole(drawn - origin) > 0.999 else FINE
    centre = -np.linalg.inv(matrix[:, :3]) @ matrix[:, 3]
    moved = np.linalg.norm([(matrix[:, :3] @ (centre - camera.centre))[:2] for camera in cameras], axis=1).max()
    step = max(2 * depth_error / max(float(moved), 1e-9), float(1 / found[:, 2].min() / 2**19))
    lattice = camera_lattice(matrix, 2.0**-fine, step, (float(origin[0]), float(origin[1])))
    return replace(lattice, fine=fine) if _keeps(lattice, mesh, cameras) else None


def _keeps(lattice: Lattice, mesh: Mesh, cameras: Sequence[Camera]) -> bool:
    """Whether rounding to the lattice leaves vertices within a pixel: not where the fitted camera is next to none."""
    steps = np.rint(lattice.coordinates(mesh.vertices))
    if not (np.abs(steps) < REACH).all():
        return False
    rounded = lattice.points(steps.astype(np.int64))
    for camera in (cameras[0], cameras[-1]):
        before, depth = camera.project(mesh.vertices)
        moved = np.abs(camera.project(rounded)[0] - before)[depth > 0]
        if not (moved < 1).all():
            return False
    return True


def _of_columns(place: NDArray[np.float64], uv: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """The camera of a relief whose vertices stand in rows and columns: those are its pixels."""
    spacing = np.array([_spacing(uv[:, 0]), _spacing(uv[:, 1])])
    if len(place) < 16 or not (spacing > 0).all():
        return None
    matrix = _camera_of(place, uv / spacing)
    if matrix is None:
        return None
    found = place @ matrix[:, :3].T + matrix[:, 3]
    drawn = found[:, :2] / found[:, 2:]
    if not (found[:, 2] > 0).all() or np.quantile(np.abs(drawn - uv / spacing), 0.99) > OFF:
        return None
    return matrix if _whole(drawn - _phase(drawn)) > WHOLE else None


def _matrix(camera: Camera) -> NDArray[np.float64]:
    matrix: NDArray[np.float64] = camera.K @ np.hstack([camera.R, camera.t[:, None]])
    return matrix


def _draws(matrix: NDArray[np.float64], place: NDArray[np.float64], uv: NDArray[np.float64]) -> bool:
    """Whether texture coordinates are an affine map of a camera's pixels."""
    found = place @ matrix[:, :3].T + matrix[:, 3]
    if not (found[:, 2] > 0).all() or len(place) < 16:
        return False
    pixels = np.concatenate([found[:, :2] / found[:, 2:], np.ones((len(place), 1))], axis=1)
    affine = np.linalg.lstsq(pixels, uv, rcond=None)[0]
    size = np.sqrt(abs(np.linalg.det(affine[:2])))
    return bool(size > 0 and np.quantile(np.abs(pixels @ affine - uv), 0.99) < OFF * size)


def _shifted(
    pixels: NDArray[np.float64], uv: NDArray[np.float64], label: NDArray[np.int32], chart: NDArray[np.int64]
) -> bool:
    """Whether texture coordinates are pixels under the same affine map everywhere, but for a shift of each chart.
    label: (n,) charts of the vertices. chart: vertices of one, which the map is fitted to."""
    affine = np.linalg.lstsq(np.column_stack([uv[chart], np.ones(len(chart))]), pixels[chart], rcond=None)[0]
    off = pixels - uv @ affine[:2]
    shift = [median(along, label, np.arange(label.max() + 1)) for along in off.T]
    off -= np.stack(shift, axis=1)[label]
    return bool((np.abs(off).max(axis=1) < NEAR).mean() > NEARLY_ALL)


def _whole(pixels: NDArray[np.float64]) -> float:
    """The part of (n, 2) coordinates that are whole."""
    return float(np.mean(np.abs(pixels - np.rint(pixels)).max(axis=1) < OFF))


def _spacing(values: NDArray[np.float64]) -> float:
    """How far neighbouring columns (or rows) of vertices are apart in texture coordinates; 0 where they stand in none.

    The most vertices stand on whole columns where the sum of their turns exp(2 pi i n u), at n columns to the atlas, is
    longest. Finer ones have sums as long: half a column is as far from none.
    """
    low, high = float(values.min()), float(values.max())
    if len(values) < 16 or not high - low > 0:
        return 0.0
    bins = np.bincount(((values - low) / (high - low) * (BINS - 1)).round().astype(np.int64), minlength=BINS)
    length = np.abs(np.fft.rfft(bins, OVER * BINS))[: OVER * MOST_COLUMNS] / len(values)
    length[: OVER * FEWEST_COLUMNS] = 0
    first = int(np.argmax(length > CLEAR * length.max()))
    if not length[first] > STRAY / np.sqrt(len(values)):
        return 0.0
    near = first + int(np.argmax(length[first : first + OVER]))
    columns = near * (BINS - 1) / (OVER * BINS) / (high - low)
    for step in (0.1, 0.01, 0.001):  # of a column over the whole extent
        tried = columns + np.arange(-10, 11) * step / (high - low)
        columns = float(tried[np.argmax(np.abs(np.exp(2j * np.pi * np.outer(tried, values)).mean(axis=1)))])
    return 1 / columns


def _camera_of(places: NDArray[np.float64], pixels: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """(3, 4) the camera that sees (n, 3) places at (n, 2) pixels, by the direct linear transform; its last row measures
    depth in the world's unit."""
    x, p = places, pixels
    middle, size = x.mean(axis=0), max(float(x.std()), 1e-12)
    centre, reach = p.mean(axis=0), max(float(p.std()), 1e-12)
    h = np.concatenate([(x - middle) / size, np.ones((len(x), 1))], axis=1)
    q = (p - centre) / reach
    zero = np.zeros_like(h)
    rows = np.concatenate([np.hstack([h, zero, -q[:, :1] * h]), np.hstack([zero, h, -q[:, 1:] * h])])
    _, values, vectors = np.linalg.svd(rows, full_matrices=False)
    if values[-2] < 1e-7 * values[0]:  # flat: no depth to tell the camera by
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
