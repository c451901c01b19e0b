"""Re-drawn photographs with their cameras, as COLMAP, nerfstudio and splat trainers read a capture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.capture import LightField
from eigenfield.capture.lightfield import View
from eigenfield.capture.points import SparsePoints
from eigenfield.capture.writers.colmap import colmap_model
from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh, triangle_areas
from eigenfield.core.progress import Progress, track
from eigenfield.core.proxy import opaque_mesh
from eigenfield.core.scene import Scene
from eigenfield.encoding.residual.views import captured_pixels, with_differences
from eigenfield.imaging.raster import rasterise_view
from eigenfield.rendering import (
    RenderJob,
    ViewWeights,
    at_resolution,
    camera_colour,
    camera_weights,
    mean_texture,
    viewpoint,
)
from eigenfield.rendering.render_jobs import png, refuse_attributes
from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.viewer.exports.folder import atomic_folder, write_file, write_listing
from eigenfield.viewer.exports.names import file_names

COLMAP_MAX_POINTS, COLMAP_MIN_POINTS = 50_000, 10_000
COLMAP_TRACK_VIEWS = 8  # listed for a point: enough for every tool; all of 289 would outweigh the pictures
COLMAP_POINTS_PER_TASK = 4096
COLMAP_DEPTH_TOLERANCE_RATIO = 0.01  # of a point's depth: a visible point may lie so far behind the drawn surface


@dataclass(frozen=True, eq=False)
class RedrawnView:
    """A picture to draw.

    Attributes:
        camera: Without skew.
        colour: The camera's own exposure, of `Renderer.draw`; None: the common one.
    """

    name: str
    camera: Camera
    weights: ViewWeights
    colour: NDArray[np.float32] | None


def write_colmap(
    job: RenderJob,
    folder: Path,
    *,
    points: NDArray[np.float64] | None = None,
    residual: bool = False,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> None:
    """Write pictures (images/NAME.png) and a COLMAP model (sparse/0/*.bin).

    The pictures are of every captured camera, encoded or held out, with its own exposure. The model has pinholes
    without distortion, and points of the mesh in the mean's colours with some of the views that see each. Its world is
    the capture's. Skew, which COLMAP cannot express, is left out of the pictures too.

    Args:
        points: (n, 2) viewpoints to draw in place of the captured cameras, as path_0000.png and so on.
        residual: Whether the pictures of encoded cameras get their residual; the listing says which did.

    Raises:
        OptionError: `residual`: the scene has none, or its cameras skew; `no-points`; as `Renderer.draw`.
        OutputError: The folder cannot be written.
    """
    redrawn_views = _redrawn_views(job, points)
    files = file_names([redrawn.name for redrawn in redrawn_views])
    refuse_attributes(job.scene.appearance.channels)
    sparse = _sparse_points(job.scene, redrawn_views)
    plain = replace(job, resolution=None)
    if residual and (points is not None or any(camera.K[0, 1] for camera in job.scene.rig.cameras)):
        raise OptionError(
            "residual", "these are not the captured cameras", remedy="leave it out: it is of captured views alone"
        )
    exact: list[str] = []

    def draw(view: tuple[int, NDArray[np.float32] | None]) -> tuple[int, bytes]:
        number, difference = view
        redrawn = redrawn_views[number]
        if difference is None:
            return number, plain.png(redrawn.camera, redrawn.weights, redrawn.colour)
        exact.append(files[number])
        return number, png(captured_pixels(job, number, difference))

    drawn = plain.each(draw, with_differences(job.scene, range(len(redrawn_views)), residual))
    with atomic_folder(folder, overwrite) as part:
        images = part / "images"
        for number, data in track(drawn, "drawing", len(redrawn_views), progress):
            write_file(images / files[number], data)
        views = tuple(
            View(redrawn.name, images / file, redrawn.camera)
            for redrawn, file in zip(redrawn_views, files, strict=True)
        )
        origin = job.scene.origin
        moved = LightField(images, views, (), "colmap", origin=origin).where_it_stood()
        model = colmap_model(moved, sparse.transform(1.0, np.eye(3), origin) if origin.any() else sparse)
        assert model is not None, "pinholes without skew have a model"
        for name, data in model.items():
            write_file(part / "sparse" / "0" / name, data)
        held = {} if points is not None else {"heldOut": [files[i] for i in np.flatnonzero(job.scene.rig.held_out)]}
        held |= {"residual": sorted(exact)} if residual else {}
        named = {redrawn.name: f"images/{file}" for redrawn, file in zip(redrawn_views, files, strict=True)}
        write_listing(part, "colmap", {"images": named, **held}, job.scene.rights)


def _redrawn_views(job: RenderJob, points: NDArray[np.float64] | None) -> list[RedrawnView]:
    scene, views = job.scene, []
    if points is None:
        for index, (name, camera) in enumerate(zip(scene.rig.names, scene.rig.cameras, strict=True)):
            weights, colour = camera_weights(scene, index, job.weights), camera_colour(scene, index)
            views.append(RedrawnView(name, _pinhole(camera, job.resolution), weights, colour))
        return views
    for number, (x, y) in enumerate(points.tolist()):
        camera, weights = viewpoint(scene, at=(x, y), weights=job.weights)
        views.append(RedrawnView(f"path_{number:04d}", _pinhole(camera, job.resolution), weights, None))
    return views


def _pinhole(camera: Camera, resolution: tuple[int, int] | None) -> Camera:
    sized = camera if resolution is None else at_resolution(camera, resolution)
    K = sized.K.copy()
    K[0, 1] = 0.0
    return replace(sized, K=K)


def _sparse_points(scene: Scene, views: Sequence[RedrawnView]) -> SparsePoints:
    """Points of the surface that two views or more see."""
    mesh = opaque_mesh(scene.proxy)
    positions, uv = _surface_points(mesh)
    visible = np.array(parallel_map(lambda redrawn: _visible_points(mesh, redrawn.camera, positions), views))
    kept = np.flatnonzero(visible.sum(axis=0) >= min(2, len(views)))
    if len(kept) == 0:
        raise OptionError("no-points", "the views see nothing in common", remedy="give viewpoints that look at it")
    positions, uv, visible = positions[kept], uv[kept], visible[:, kept]
    parts = [_select_tracks(visible[:, first:last], first) for first, last in pieces(len(kept), COLMAP_POINTS_PER_TASK)]
    point, view = (np.concatenate(part) for part in zip(*parts, strict=True))
    pixels = np.empty((len(point), 2))
    for number, redrawn in enumerate(views):
        here = view == number
        pixels[here] = redrawn.camera.project(positions[point[here]])[0]
    return SparsePoints(positions, _mean_colours(scene, uv), np.zeros(len(kept)), point, view, pixels)


def _surface_points(mesh: Mesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(n, 3) positions and (n, 2) UVs: vertices, at most `COLMAP_MAX_POINTS` at even steps, and random points of
    the surface where these are fewer than `COLMAP_MIN_POINTS`."""
    assert mesh.uv is not None
    _, first = np.unique(mesh.vertices, axis=0, return_index=True)  # vertices on seams are doubled
    first.sort()
    chosen = first[np.linspace(0, len(first) - 1, min(COLMAP_MAX_POINTS, len(first))).astype(np.int64)]
    positions, uv = mesh.vertices[chosen].astype(np.float64), mesh.uv[chosen].astype(np.float64)
    more = max(0, COLMAP_MIN_POINTS - len(chosen))
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    area = triangle_areas(corners)
    if more == 0 or area.sum() == 0:
        return positions, uv
    random = np.random.default_rng(0)
    faces = random.choice(len(area), more, p=area / area.sum())
    shares = random.dirichlet(np.ones(3), more)[..., None]  # evenly over a triangle
    inside = (corners[faces] * shares).sum(axis=1)
    return np.concatenate([positions, inside]), np.concatenate([uv, (mesh.uv[mesh.faces[faces]] * shares).sum(axis=1)])


def _visible_points(mesh: Mesh, camera: Camera, positions: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n,) whether nothing of the mesh hides a point from the camera."""
    near = rasterise_view(mesh, camera).inverse_depth
    pixels, depth = camera.project(positions)
    inside = (depth > 0) & (pixels >= 0).all(axis=1) & (pixels < (camera.width, camera.height)).all(axis=1)
    column, row = np.where(inside[:, None], pixels, 0).astype(np.int64).T
    return inside & (near[row, column] * depth <= 1 + COLMAP_DEPTH_TOLERANCE_RATIO)


def _select_tracks(visible: NDArray[np.bool_], first: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Point, counted from `first`, and view of each entry of the tracks, sorted by point.

    Of the (views, points) in which a point is visible, at most `COLMAP_TRACK_VIEWS` at even steps are listed.
    """
    rank = np.cumsum(visible, axis=0) - 1
    step = np.maximum(visible.sum(axis=0), COLMAP_TRACK_VIEWS) / COLMAP_TRACK_VIEWS
    kept = visible & (np.floor(rank / step) > np.floor((rank - 1) / step))
    point, view = np.nonzero(kept.T)
    return point.astype(np.int64) + first, view.astype(np.int64)


def _mean_colours(scene: Scene, uv: NDArray[np.float64]) -> NDArray[np.uint8]:
    """(n, 3) of the mean's texels at (n, 2) texture coordinates, greys repeated."""
    mean = mean_texture(scene)
    size = np.array(mean.shape[1::-1])
    column, row = np.clip(uv * size, 0, size - 1).astype(np.int64).T
    texels = np.clip(np.rint(mean[row, column] * np.float32(255)), 0, 255).astype(np.uint8)
    return np.repeat(texels, 3, axis=1) if texels.shape[1] == 1 else texels
