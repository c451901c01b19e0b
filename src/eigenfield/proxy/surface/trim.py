"""From the surface that Poisson reconstruction closes everywhere to what the points show, in few triangles."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation, maximum_filter
from scipy.spatial import KDTree

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.proxy.atlas.unwrap import simplified
from eigenfield.proxy.surface.fusion import DepthView, Points
from eigenfield.proxy.topology import filled, manifold, patches, without_islands
from eigenfield.runtime.parallel import parallel_map

log = logging.getLogger("eigenfield.proxy")

REACH = 4.0  # times their spacing: as far as points support a surface
GAP = 30.0  # times their spacing: holes up to this size are closed
WALL = 120.0  # times their spacing: patches without points up to this size stay where nothing is seen through them
THROUGH = 2  # depth maps that must see something behind a point for it to be in the air
ISLAND = 0.005  # of the area: a smaller patch is dropped
SAMPLES = 200_000  # on a surface, to find the triangles near a point
PROBES = 20_000  # points that the error of a simplification is measured at
NEAREST = 4  # samples whose triangles are tried


@dataclass(frozen=True)
class SurfaceError:
    """How far points lie from a surface: the root mean square and the 95th percentile.

    rms, p95: world units. relative: rms over the diagonal of the points' box (1st to 99th percentiles).
    pixels, pixels_p95: seen by a camera, as pixels that the whole distance would cover across the line of sight.
    """

    rms: float
    p95: float
    relative: float
    pixels: float
    pixels_p95: float

    def __str__(self) -> str:
        return f"{100 * self.relative:.3f} % of the scene, {self.pixels:.2f} px (95 % under {self.pixels_p95:.2f} px)"


def trimmed(
    mesh: Mesh,
    points: Points,
    *,
    views: Sequence[DepthView] = (),
    tolerance: float = 0.01,
    reach: float = REACH,
    gap: float = GAP,
    wall: float = WALL,
    island: float = ISLAND,
) -> Mesh:
    """Without what no points support, but with small holes closed; no small islands, nothing non-manifold.

    reach: in units of the points' spacing, how far from a point the surface counts as supported. gap: in the same
    units (median), the size up to which unsupported patches stay and holes are closed. island: share of the area below
    which a patch is dropped. views: with them, patches up to `wall` (in the same units) stay too where no two depth
    maps look through them, to something farther by more than twice the relative `tolerance`: bare walls give no points.
    Raises ProxyError `surface-empty`.
    """
    spacing = float(np.median(points.spacing))
    gap_size = gap * spacing
    supported = np.asarray(_supported(mesh, points, reach)[mesh.faces].all(axis=1), np.bool_)
    kept = supported | _small_patches(mesh, ~supported, gap_size)
    if views:
        solid = ~supported & ~_looked_through(mesh, views, tolerance)[mesh.faces].any(axis=1)
        kept |= _small_patches(mesh, solid, wall * spacing)
    result = manifold(without_islands(Mesh(mesh.vertices, mesh.faces[kept]), island))
    result = without_islands(filled(result, gap_size), island)
    if len(result.faces) == 0:
        raise ProxyError(
            "surface-empty",
            f"nothing is left of a surface of {len(mesh.faces)} triangles once what no points support is cut away",
            remedy="check the calibration (eigenfield inspect) and the depth range",
        )
    log.info("trimmed from %d to %d triangles", len(mesh.faces), len(result.faces))
    return result


def within_masks(
    mesh: Mesh, cameras: Sequence[Camera], masks: Sequence[NDArray[np.bool_] | None], *, island: float = ISLAND
) -> Mesh:
    """Without what no view has in its frame, and what more than a tenth of those that do see outside their masks.

    masks: (H, W) bool at the cameras' sizes; a pixel outside is forgiven. Raises ProxyError `surface-empty`.
    """
    positions = mesh.vertices.astype(np.float64)
    seen, hidden = np.zeros(len(positions), np.int64), np.zeros(len(positions), np.int64)
    for camera, mask in zip(cameras, masks, strict=True):
        pixels, depth = camera.project(positions)
        with np.errstate(invalid="ignore"):
            inside = (depth > 0) & (pixels >= 0).all(axis=1)
            inside &= (pixels[:, 0] < camera.width) & (pixels[:, 1] < camera.height)
        seen += inside
        if mask is not None:
            column, row = pixels[inside].astype(np.int64).T
            hidden[inside] += ~binary_dilation(mask, np.ones((3, 3), np.bool_))[row, column]
    kept = ((seen > 0) & (hidden * 10 <= seen))[mesh.faces].all(axis=1)
    result = manifold(without_islands(Mesh(mesh.vertices, mesh.faces[kept]), island))
    if len(result.faces) == 0:
        raise ProxyError(
            "surface-empty",
            "nothing of the surface lies within the masks of nine views in ten",
            remedy="check that the masks belong to these photographs, and the calibration (eigenfield inspect)",
        )
    return result


def simplified_with_error(mesh: Mesh, points: Points, triangles: int, camera: Camera) -> tuple[Mesh, SurfaceError]:
    """At most about `triangles` of them, still manifold, and how far the points on `mesh` lie from what comes out."""
    result = mesh if len(mesh.faces) <= triangles else manifold(simplified(mesh, triangles))
    near = KDTree(mesh.vertices).query(points.positions)[0] <= REACH * points.spacing  # not what trimming gave up
    error = surface_error(result, points.positions[near] if near.any() else points.positions, camera)
    log.info("simplified from %d to %d triangles: %s", len(mesh.faces), len(result.faces), error)
    return result, error


def surface_error(mesh: Mesh, positions: NDArray[np.float64], camera: Camera) -> SurfaceError:
    """How far points (n, 3) lie from a mesh; at most 20,000 of them, evenly taken, are looked at."""
    probes = positions[np.linspace(0, len(positions) - 1, min(len(positions), PROBES)).astype(np.int64)]
    distance = distances(mesh, probes)
    low, high = np.percentile(positions, [1, 99], axis=0)
    depth = camera.project(probes)[1]
    focal = (camera.K[0, 0] + camera.K[1, 1]) / 2
    ahead = depth > 1e-3 * float(np.median(np.abs(depth)))
    pixels = distance[ahead] * focal / depth[ahead]
    rms = float(np.sqrt((distance**2).mean()))
    return SurfaceError(
        rms,
        float(np.percentile(distance, 95)),
        rms / (float(np.linalg.norm(high - low)) or 1.0),
        float(np.sqrt((pixels**2).mean())) if len(pixels) else 0.0,
        float(np.percentile(pixels, 95)) if len(pixels) else 0.0,
    )


def distances(mesh: Mesh, positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) distances of points (n, 3) from the surface: the least over the triangles of the nearest samples on it, so
    at times a little too large, never too small."""
    from trimesh.triangles import closest_point

    samples, face = surface_samples(mesh, SAMPLES)
    tree = KDTree(samples)
    nearest = tree.query(positions, k=min(NEAREST, len(samples)))[1].reshape(len(positions), -1)
    triangles = mesh.vertices.astype(np.float64)[mesh.faces]
    best = np.full(len(positions), np.inf)
    for column in nearest.T:
        closest = closest_point(triangles[face[column]], positions)
        best = np.minimum(best, np.linalg.norm(closest - positions, axis=1))
    return best


def surface_samples(mesh: Mesh, count: int) -> tuple[NDArray[np.float64], NDArray[np.int64]]:
    """About `count` points spread evenly over a mesh, at least one a triangle, and the triangle of each.

    The R2 sequence (Roberts, 2018) folded into each triangle: no chance, so the same mesh gives the same points.
    """
    area = mesh.face_areas()
    number = np.maximum(np.rint(count * area / max(float(area.sum()), 1e-300)), 1).astype(np.int64)
    face = np.repeat(np.arange(len(area)), number)
    step = np.arange(len(face)) - np.repeat(np.cumsum(number) - number, number)
    u, v = (0.5 + 0.7548776662466927 * step) % 1, (0.5 + 0.5698402909980532 * step) % 1
    fold = u + v > 1
    u, v = np.where(fold, 1 - u, u), np.where(fold, 1 - v, v)
    p = mesh.vertices.astype(np.float64)[mesh.faces[face]]
    return p[:, 0] + u[:, None] * (p[:, 1] - p[:, 0]) + v[:, None] * (p[:, 2] - p[:, 0]), face


def _supported(mesh: Mesh, points: Points, reach: float) -> NDArray[np.bool_]:
    """(n,) whether a point lies near each vertex, within `reach` of the point's own spacing or of a typical edge."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    edge = float(np.median(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)))
    distance, nearest = KDTree(points.positions).query(mesh.vertices)
    return distance <= reach * np.maximum(points.spacing[nearest], edge / 2)


def _looked_through(mesh: Mesh, views: Sequence[DepthView], tolerance: float) -> NDArray[np.bool_]:
    """(n,) which vertices at least THROUGH depth maps have something clearly behind of, all around them."""
    positions = mesh.vertices.astype(np.float64)

    def behind(view: DepthView) -> NDArray[np.bool_]:
        nearest = maximum_filter(np.where(view.inverse_depth > 0, view.inverse_depth, np.inf), 3)
        pixels, depth = view.camera.project(positions)
        with np.errstate(invalid="ignore"):
            inside = (depth > 0) & (pixels >= 0).all(axis=1)
            inside &= (pixels[:, 0] < view.camera.width) & (pixels[:, 1] < view.camera.height)
        column, row = pixels[inside].astype(np.int64).T
        result = np.zeros(len(positions), np.bool_)
        result[inside] = nearest[row, column] * depth[inside] < 1 - 2 * tolerance
        return result

    return np.asarray(np.sum(parallel_map(behind, views), axis=0) >= THROUGH)


def _small_patches(mesh: Mesh, which: NDArray[np.bool_], size: float) -> NDArray[np.bool_]:
    """Of the faces in `which`, those whose patch is at most `size` across."""
    label = patches(mesh.faces, which)
    count = int(label.max(initial=-1)) + 1
    if count == 0:
        return np.zeros(len(which), np.bool_)
    chosen = label >= 0
    low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
    for corner in range(3):
        at = mesh.vertices[mesh.faces[chosen, corner]]
        np.minimum.at(low, label[chosen], at)
        np.maximum.at(high, label[chosen], at)
    small = np.linalg.norm(high - low, axis=1) <= size
    return chosen & small[label]
