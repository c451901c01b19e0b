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
from eigenfield.core.scene import Scene
from eigenfield.encoding.residual import captured_pixels, with_differences
from eigenfield.imaging.raster import rasterise_view
from eigenfield.rendering import RenderJob, ViewWeights, at_resolution, camera_colour, camera_weights, viewpoint
from eigenfield.rendering.render_jobs import png, refuse_attributes
from eigenfield.runtime.parallel import parallel_map, pieces
from eigenfield.viewer.exports.folder import atomic_folder, put, write_listing
from eigenfield.viewer.exports.maps import mean_map
from eigenfield.viewer.exports.names import file_names

MOST, FEWEST = 50_000, 10_000  # points
TRACK = 8  # views named for a point: enough for every tool; all of 289 would outweigh the pictures
AT_ONCE = 4096  # points whose views are chosen at a time
BEHIND = 0.01  # of a vertex's depth, by which it may lie behind the drawn surface and still be seen


@dataclass(frozen=True, eq=False)
class RedrawnView:
    """A picture to draw: a name, a camera without skew, view weights, and the camera's own exposure if it has one."""

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
    """Write images/NAME.png for every captured camera, encoded or held out, and sparse/0/*.bin: pinholes without
    distortion, and points of the mesh in the mean's colours, with some of the views that see each.

    Captured cameras have their own exposure. The model's world is the capture's. points: (n, 2) viewpoints to draw in
    place of the captured cameras, as path_0000.png and so on. Skew, which COLMAP cannot say, is left out of the
    pictures too. residual: encoded cameras' pictures have their residual on them; the listing says which.
    Raises OutputError, OptionError as `Renderer.draw`, and `residual` where there is none, or with skew.
    """
    todo = _captured(job) if points is None else _along(job, points)
    files = file_names([shot.name for shot in todo])
    refuse_attributes(job.scene.appearance.channels)
    sparse = _sparse_points(job.scene, todo)
    plain = replace(job, resolution=None)
    if residual and (points is not None or any(camera.K[0, 1] for camera in job.scene.rig.cameras)):
        raise OptionError(
            "residual", "these are not the captured cameras", remedy="leave it out: it is of captured views alone"
        )
    exact: list[str] = []

    def draw(view: tuple[int, NDArray[np.float32] | None]) -> tuple[int, bytes]:
        number, difference = view
        shot = todo[number]
        if difference is None:
            return number, plain.png(shot.camera, shot.weights, shot.colour)
        exact.append(files[number])
        return number, png(captured_pixels(job, number, difference))

    drawn = plain.each(draw, with_differences(job.scene, range(len(todo)), residual))
    with atomic_folder(folder, overwrite) as part:
        images = part / "images"
        for number, data in track(drawn, "drawing", len(todo), progress):
            put(images / files[number], data)
        views = tuple(View(shot.name, images / file, shot.camera) for shot, file in zip(todo, files, strict=True))
        model = colmap_model(LightField(images, views, (), "colmap"), sparse)
        assert model is not None, "pinholes without skew have a model"
        for name, data in model.items():
            put(part / "sparse" / "0" / name, data)
        held = {} if points is not None else {"heldOut": [files[i] for i in np.flatnonzero(job.scene.rig.held_out)]}
        held |= {"residual": sorted(exact)} if residual else {}
        named = {shot.name: f"images/{file}" for shot, file in zip(todo, files, strict=True)}
        write_listing(part, "colmap", {"images": named, **held})


def _captured(job: RenderJob) -> list[RedrawnView]:
    scene = job.scene
    return [
        RedrawnView(
            name,
            _pinhole(camera, job.resolution),
            camera_weights(scene, index, job.weights),
            camera_colour(scene, index),
        )
        for index, (name, camera) in enumerate(zip(scene.rig.names, scene.rig.cameras, strict=True))
    ]


def _along(job: RenderJob, points: NDArray[np.float64]) -> list[RedrawnView]:
    made = []
    for number, (x, y) in enumerate(points.tolist()):
        camera, weights = viewpoint(job.scene, at=(x, y), weights=job.weights)
        made.append(RedrawnView(f"path_{number:04d}", _pinhole(camera, job.resolution), weights, None))
    return made


def _pinhole(camera: Camera, resolution: tuple[int, int] | None) -> Camera:
    sized = camera if resolution is None else at_resolution(camera, resolution)
    K = sized.K.copy()
    K[0, 1] = 0.0
    return replace(sized, K=K)


def _sparse_points(scene: Scene, views: Sequence[RedrawnView]) -> SparsePoints:
    """Points of the surface that two views or more see."""
    positions, uv = _surface_points(scene.proxy.mesh)
    seen = np.array(parallel_map(lambda redrawn: _seen(scene.proxy.mesh, redrawn.camera, positions), views))
    kept = np.flatnonzero(seen.sum(axis=0) >= min(2, len(views)))
    if len(kept) == 0:
        raise OptionError("no-points", "the views see nothing in common", remedy="give viewpoints that look at it")
    positions, uv, seen = positions[kept], uv[kept], seen[:, kept]
    parts = [_tracks(seen[:, first:last], first) for first, last in pieces(len(kept), AT_ONCE)]
    point, view = (np.concatenate(part) for part in zip(*parts, strict=True))
    pixels = np.empty((len(point), 2))
    for number, redrawn in enumerate(views):
        here = view == number
        pixels[here] = redrawn.camera.project(positions[point[here]])[0]
    return SparsePoints(positions, _mean_colours(scene, uv), np.zeros(len(kept)), point, view, pixels)


def _surface_points(mesh: Mesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(n, 3) positions and (n, 2) UVs: the vertices, evenly `MOST` of them if there are more; on a mesh of few,
    random points of the surface too, as many as make `FEWEST`."""
    assert mesh.uv is not None
    _, first = np.unique(mesh.vertices, axis=0, return_index=True)  # vertices on seams are doubled
    first.sort()
    chosen = first[np.linspace(0, len(first) - 1, min(MOST, len(first))).astype(np.int64)]
    positions, uv = mesh.vertices[chosen].astype(np.float64), mesh.uv[chosen].astype(np.float64)
    more = max(0, FEWEST - len(chosen))
    corners = mesh.vertices[mesh.faces].astype(np.float64)
    area = triangle_areas(corners)
    if more == 0 or area.sum() == 0:
        return positions, uv
    random = np.random.default_rng(0)
    faces = random.choice(len(area), more, p=area / area.sum())
    shares = random.dirichlet(np.ones(3), more)[..., None]  # evenly over a triangle
    inside = (corners[faces] * shares).sum(axis=1)
    return np.concatenate([positions, inside]), np.concatenate([uv, (mesh.uv[mesh.faces[faces]] * shares).sum(axis=1)])


def _seen(mesh: Mesh, camera: Camera, positions: NDArray[np.float64]) -> NDArray[np.bool_]:
    """(n,) whether nothing of the mesh hides a point from the camera."""
    near = rasterise_view(mesh, camera).inverse_depth
    pixels, depth = camera.project(positions)
    inside = (depth > 0) & (pixels >= 0).all(axis=1) & (pixels < (camera.width, camera.height)).all(axis=1)
    column, row = np.where(inside[:, None], pixels, 0).astype(np.int64).T
    return inside & (near[row, column] * depth <= 1 + BEHIND)


def _tracks(seen: NDArray[np.bool_], first: int) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Point, counted from `first`, and view of the observations kept of (views, points): `TRACK` a point at most,
    spread over those that see it; sorted by point."""
    rank = np.cumsum(seen, axis=0) - 1
    step = np.maximum(seen.sum(axis=0), TRACK) / TRACK
    kept = seen & (np.floor(rank / step) > np.floor((rank - 1) / step))
    point, view = np.nonzero(kept.T)
    return point.astype(np.int64) + first, view.astype(np.int64)


def _mean_colours(scene: Scene, uv: NDArray[np.float64]) -> NDArray[np.uint8]:
    """(n, 3) of the mean's texels at (n, 2) texture coordinates, greys repeated."""
    mean = mean_map(scene)
    size = np.array(mean.shape[1::-1])
    column, row = np.clip(uv * size, 0, size - 1).astype(np.int64).T
    texels = np.clip(np.rint(mean[row, column] * np.float32(255)), 0, 255).astype(np.uint8)
    return np.repeat(texels, 3, axis=1) if texels.shape[1] == 1 else texels
