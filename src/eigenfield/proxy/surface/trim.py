"""Trimming of the closed Poisson surface to the part that points support, and its simplification."""

from __future__ import annotations

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import binary_dilation
from scipy.spatial import KDTree

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.samples import surface_samples
from eigenfield.proxy.simplify import simplify_mesh
from eigenfield.proxy.surface.fusion import DepthView, OrientedPoints
from eigenfield.proxy.surface.neighbours import project_inside
from eigenfield.proxy.topology import face_patches, fill_holes, make_manifold, remove_islands

log = logging.getLogger("eigenfield.proxy")

TRIM_SUPPORT_SPACINGS = 4.0  # distance at which points support a surface
TRIM_MAX_GAP_SPACINGS = 30.0  # size of holes that are closed
TRIM_MIN_ISLAND_FRACTION = 0.005  # of the area: smaller patches are dropped
CLEAR_DEPTH_RATIO = 0.5  # of the depth of what is nearest to a view, up to which nothing shows it its back
CLEAR_DEPTH_PERCENTILE = 1.0  # of its depths, which is taken as the nearest
CLEAR_FIELD_RATIO = 2.0  # by which more than the view's field is cleared: simplification moves borders
CLEAR_MAX_LAYERS = 8
SURFACE_DISTANCE_SAMPLES = 200_000  # on a surface, to find the triangles near a point
SURFACE_ERROR_PROBES = 20_000  # points at which the error of a simplification is measured
SURFACE_DISTANCE_NEIGHBOURS = 4  # samples whose triangles are tried


@dataclass(frozen=True)
class SurfaceError:
    """Distances of points from a surface.

    Attributes:
        rms: Root mean square, world units.
        relative: rms over the diagonal of the points' box (1st to 99th percentiles).
        pixels: Root mean square in pixels of a camera, as if the whole distance were across the line of sight.
        pixels_p95: 95th percentile in pixels.
    """

    rms: float
    relative: float
    pixels: float
    pixels_p95: float

    def __str__(self) -> str:
        return f"{100 * self.relative:.3f} % of the scene, {self.pixels:.2f} px (95 % under {self.pixels_p95:.2f} px)"


def trim_surface(mesh: Mesh, points: OrientedPoints) -> Mesh:
    """Remove what no points support and close small holes; no small islands and nothing non-manifold remains.

    Raises:
        ProxyError: `surface-empty`: nothing remains.
    """
    spacing = float(np.median(points.spacing))
    gap_size = TRIM_MAX_GAP_SPACINGS * spacing
    supported = np.asarray(_has_support(mesh, points)[mesh.faces].all(axis=1), np.bool_)
    kept = supported | _small_patches(mesh, ~supported, gap_size)
    result = make_manifold(remove_islands(Mesh(mesh.vertices, mesh.faces[kept]), TRIM_MIN_ISLAND_FRACTION))
    result = remove_islands(fill_holes(result, gap_size), TRIM_MIN_ISLAND_FRACTION)
    if len(result.faces) == 0:
        raise ProxyError(
            "surface-empty",
            f"nothing is left of a surface of {len(mesh.faces)} triangles once what no points support is cut away",
            remedy="check the calibration (`eigenfield inspect CAPTURE`) and the depth range",
        )
    log.info("trimmed from %d to %d triangles", len(mesh.faces), len(result.faces))
    return result


def trim_by_masks(mesh: Mesh, cameras: Sequence[Camera], masks: Sequence[NDArray[np.bool_] | None]) -> Mesh:
    """Remove what no view has in its frame, and what more than a tenth of those that do see outside their masks.

    Args:
        masks: (H, W) bool at the cameras' sizes; one pixel outside is tolerated.

    Raises:
        ProxyError: `surface-empty`: nothing remains.
    """
    positions = mesh.vertices.astype(np.float64)
    seen, hidden = np.zeros(len(positions), np.int64), np.zeros(len(positions), np.int64)
    for camera, mask in zip(cameras, masks, strict=True):
        pixels, _, inside = project_inside(camera, positions)
        seen += inside
        if mask is not None:
            column, row = pixels[inside].astype(np.int64).T
            hidden[inside] += ~binary_dilation(mask, np.ones((3, 3), np.bool_))[row, column]
    kept = ((seen > 0) & (hidden * 10 <= seen))[mesh.faces].all(axis=1)
    result = make_manifold(remove_islands(Mesh(mesh.vertices, mesh.faces[kept]), TRIM_MIN_ISLAND_FRACTION))
    if len(result.faces) == 0:
        raise ProxyError(
            "surface-empty",
            "nothing of the surface lies within the masks of nine views in ten",
            remedy="check the calibration (`eigenfield inspect CAPTURE`), and that the masks are of these photographs",
        )
    return result


def clear_views(mesh: Mesh, views: Sequence[DepthView]) -> Mesh:
    """Remove what shows a view its back, far nearer than all that the view has found itself (`clear_view`)."""
    found = mesh
    for view in views:
        known = view.inverse_depth[np.isfinite(view.inverse_depth) & (view.inverse_depth > 0)]
        if len(known):
            found = clear_view(found, view.camera, float(np.percentile(known, 100 - CLEAR_DEPTH_PERCENTILE)))
    return mesh if found is mesh else make_manifold(found)


def clear_view(mesh: Mesh, camera: Camera, inverse_depth: float) -> Mesh:
    """The mesh without what shows a camera its back and would hide all from it; the same mesh where nothing does.

    Such is the wall in which a camera is mounted, and which others see.

    Args:
        inverse_depth: Of what is nearest to the camera.
    """
    K, faces = camera.K.copy(), mesh.faces
    K[:2, :2] /= CLEAR_FIELD_RATIO
    wide = replace(camera, K=K)
    for _ in range(CLEAR_MAX_LAYERS):
        seen = rasterise_view(Mesh(mesh.vertices, faces), wide)
        near = np.unique(seen.face[(seen.face >= 0) & (CLEAR_DEPTH_RATIO * seen.inverse_depth > inverse_depth)])
        corners = mesh.vertices[faces[near]].astype(np.float64)
        outwards = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        behind = near[((camera.centre - corners[:, 0]) * outwards).sum(axis=1) < 0]
        if not len(behind):
            break
        faces = np.delete(faces, behind, axis=0)
    if len(faces) == len(mesh.faces):
        return mesh
    log.info("%d triangles hid all from the camera behind them, and are removed", len(mesh.faces) - len(faces))
    return Mesh(mesh.vertices, faces)


def simplify_with_error(
    mesh: Mesh, points: OrientedPoints, triangles: int, camera: Camera
) -> tuple[Mesh, SurfaceError]:
    """At most about `triangles` triangles, still manifold, and the distance of the points from the result.

    Args:
        camera: Whose pixels measure the error.
    """
    result = mesh if len(mesh.faces) <= triangles else make_manifold(simplify_mesh(mesh, triangles))
    # not what trimming removed
    near = KDTree(mesh.vertices).query(points.positions)[0] <= TRIM_SUPPORT_SPACINGS * points.spacing
    error = surface_error(result, points.positions[near] if near.any() else points.positions, camera)
    log.info("simplified from %d to %d triangles: %s", len(mesh.faces), len(result.faces), error)
    return result, error


def surface_error(mesh: Mesh, positions: NDArray[np.float64], camera: Camera) -> SurfaceError:
    """Distances of points from a mesh, measured at no more than SURFACE_ERROR_PROBES of them.

    Args:
        camera: Whose pixels measure the error.
    """
    probes = positions[np.linspace(0, len(positions) - 1, min(len(positions), SURFACE_ERROR_PROBES)).astype(np.int64)]
    distance = surface_distances(mesh, probes)
    low, high = np.percentile(positions, [1, 99], axis=0)
    depth = camera.project(probes)[1]
    focal = (camera.K[0, 0] + camera.K[1, 1]) / 2
    ahead = depth > 1e-3 * float(np.median(np.abs(depth)))
    pixels = distance[ahead] * focal / depth[ahead]
    rms = float(np.sqrt((distance**2).mean()))
    return SurfaceError(
        rms,
        rms / (float(np.linalg.norm(high - low)) or 1.0),
        float(np.sqrt((pixels**2).mean())) if len(pixels) else 0.0,
        float(np.percentile(pixels, 95)) if len(pixels) else 0.0,
    )


def surface_distances(mesh: Mesh, positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """(n,) distances of points from a surface.

    The distance is the least over the triangles of the nearest samples: sometimes a little too large, never too small.
    """
    from trimesh.triangles import closest_point

    samples, face = surface_samples(mesh, SURFACE_DISTANCE_SAMPLES)
    tree = KDTree(samples)
    nearest = tree.query(positions, k=min(SURFACE_DISTANCE_NEIGHBOURS, len(samples)))[1].reshape(len(positions), -1)
    triangles = mesh.vertices.astype(np.float64)[mesh.faces]
    best = np.full(len(positions), np.inf)
    for column in nearest.T:
        closest = closest_point(triangles[face[column]], positions)
        best = np.minimum(best, np.linalg.norm(closest - positions, axis=1))
    return best


def _has_support(mesh: Mesh, points: OrientedPoints) -> NDArray[np.bool_]:
    """(n,) whether a point lies near each vertex, in units of its spacing or of half a typical edge."""
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    edge = float(np.median(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)))
    distance, nearest = KDTree(points.positions).query(mesh.vertices)
    return distance <= TRIM_SUPPORT_SPACINGS * np.maximum(points.spacing[nearest], edge / 2)


def _small_patches(mesh: Mesh, which: NDArray[np.bool_], size: float) -> NDArray[np.bool_]:
    """The faces in `which` whose patch is at most `size` across."""
    label = face_patches(mesh.faces, which)
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
