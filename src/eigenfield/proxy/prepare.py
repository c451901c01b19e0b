"""From a mesh file and the cameras to the proxy that `encode` uses."""

from __future__ import annotations

import logging
import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.progress import Progress
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.atlas.layout import atlas_fault
from eigenfield.proxy.atlas.unwrap import unwrap_mesh
from eigenfield.proxy.meshes.read import check_mesh, raw_of, read_mesh
from eigenfield.proxy.surface.neighbours import project_inside
from eigenfield.proxy.topology import remove_unused_vertices

log = logging.getLogger("eigenfield.proxy")

FAR_MIN_RATIO = 20.0  # of a vertex's distance from the mesh's middle to the usual one of vertices and cameras
FAR_SEEN_MIN_RATIO = 1000.0  # likewise, of a vertex that some camera has in its frame
FAR_MIN_JUMP = 20.0  # of that distance to another corner's: meshes that reach far reach there gradually
PREPARE_THUMBNAIL_PIXELS = 64  # side of the pictures in which a mesh is searched whose vertices all lie outside


def prepare_proxy(
    path_or_mesh: str | os.PathLike[str] | Mesh,
    cameras: Sequence[Camera],
    *,
    origin: NDArray[np.float64] | None = None,
    triangles: int | None = None,
    simplified: Callable[[Mesh], Mesh | None] | None = None,
    progress: Progress | None = None,
) -> Mesh:
    """Read (or check) a mesh, make sure that a camera sees it, and give it an atlas.

    Args:
        path_or_mesh: A mesh file, or a mesh in the cameras' world.
        origin: (3,) the origin of the cameras' world in that of a mesh file. None: they are the same.
        simplified: Returns the mesh with fewer triangles and without UVs, or None where all are to stay.

    Raises:
        ProxyError: As `read_mesh` and `unwrap_mesh`; `proxy-not-seen`: no camera sees the mesh.
        OptionError: As `unwrap_mesh`.
    """
    path = None if isinstance(path_or_mesh, Mesh) else Path(path_or_mesh)
    given = path_or_mesh
    mesh = check_mesh(raw_of(given), None) if isinstance(given, Mesh) else read_mesh(given, origin)
    _check_seen(mesh, cameras, path)
    mesh = without_far_vertices(mesh, cameras, path)
    try:
        simpler = None if simplified is None else simplified(mesh)
        if simpler is not None:
            log.info("the mesh is simplified from %d to %d triangles", len(mesh.faces), len(simpler.faces))
            mesh = simpler
        return unwrap_mesh(mesh, triangles=triangles, cameras=cameras, progress=progress)
    except ProxyError as error:
        raise ProxyError(error.code, error.message, path=path, remedy=error.remedy) from error


def _check_seen(mesh: Mesh, cameras: Sequence[Camera], path: Path | None) -> None:
    """Raise ProxyError `proxy-not-seen` where nothing of the mesh is in any camera's frame."""
    behind = 0
    for camera in cameras:
        _, depth, inside = project_inside(camera, mesh.vertices)
        if inside.any():
            return
        behind += not (depth > 0).any()
    if any(_covers_pixels(mesh, camera) for camera in cameras):
        return
    where = "lies behind" if behind == len(cameras) else "lies outside the frame of"
    middle = mesh.vertices.astype(np.float64).mean(axis=0)
    array = np.mean([camera.centre for camera in cameras], axis=0)
    raise ProxyError(
        "proxy-not-seen",
        f"the mesh {where} all {len(cameras)} cameras (its middle is at {_point(middle)}, theirs at {_point(array)})",
        path=path,
        remedy="bring both into one frame: look for flipped axes (y and z between OpenGL and OpenCV), another scale or "
        "another reconstruction's coordinates; `eigenfield inspect CAPTURE --proxy MESH --overlay overlay.png` shows "
        "both",
    )


def without_far_vertices(mesh: Mesh, cameras: Sequence[Camera], path: Path | None) -> Mesh:
    """The mesh without the triangles that lead to single vertices far outside, which programs leave behind.

    Charts are as large as their surface, so that such a triangle leaves no texels for the rest. A mesh with an atlas of
    its own stays as it is.
    """
    points = mesh.vertices.astype(np.float64)
    middle = np.median(points, axis=0)
    away = np.linalg.norm(points - middle, axis=1)
    usual = max(float(np.median(away)), float(np.median([np.linalg.norm(c.centre - middle) for c in cameras])))
    far = away > FAR_MIN_RATIO * usual
    if not far.any():
        return mesh
    seen = np.logical_or.reduce([project_inside(camera, points[far])[2] for camera in cameras])
    far[far] = ~seen | (away[far] > FAR_SEEN_MIN_RATIO * usual)
    corners = away[mesh.faces]
    jumps = corners.min(axis=1) * FAR_MIN_JUMP < corners.max(axis=1)
    spike = np.zeros(len(points), bool)
    spike[mesh.faces[jumps]] = True
    spike &= far
    left_out = spike[mesh.faces].any(axis=1)
    if not left_out.any() or left_out.all() or atlas_fault(mesh) is None:
        return mesh
    log.warning(
        "%s: %d of %d triangles are left out, whose corners lie far outside the rest, as at %s",
        path or "mesh", left_out.sum(), len(mesh.faces), _point(points[np.argmax(np.where(spike, away, 0))]),
    )  # fmt: skip
    return remove_unused_vertices(Mesh(mesh.vertices, mesh.faces[~left_out], mesh.uv))


def _covers_pixels(mesh: Mesh, camera: Camera) -> bool:
    small = camera.resize(PREPARE_THUMBNAIL_PIXELS, PREPARE_THUMBNAIL_PIXELS)
    return bool((rasterise_view(mesh, small).face >= 0).any())


def _point(position: NDArray[np.float64]) -> str:
    return "(" + ", ".join(f"{x:.3g}" for x in position) + ")"
