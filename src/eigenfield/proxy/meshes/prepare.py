"""From a mesh file and the cameras to the proxy that `encode` uses."""

from __future__ import annotations

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
from eigenfield.proxy.atlas.unwrap import unwrap_mesh
from eigenfield.proxy.meshes.formats import RawMesh
from eigenfield.proxy.meshes.read import check_mesh, read_mesh
from eigenfield.proxy.surface.neighbours import project_inside

PREPARE_THUMBNAIL_PIXELS = 64  # side of the pictures in which a mesh is searched whose vertices all lie outside


def prepare_proxy(
    path_or_mesh: str | os.PathLike[str] | Mesh,
    cameras: Sequence[Camera],
    *,
    origin: NDArray[np.float64] | None = None,
    triangles: int | Callable[[Mesh], int | None] | None = None,
    progress: Progress | None = None,
) -> Mesh:
    """Read (or check) a mesh, make sure that a camera sees it, and give it an atlas.

    Args:
        path_or_mesh: A mesh file, or a mesh in the cameras' world.
        cameras: All cameras.
        origin: (3,) the origin of the cameras' world in that of a mesh file. None: they are the same.
        triangles: As in `unwrap_mesh`, or a function that returns it for the mesh.
        progress: Called for each step.

    Raises:
        ProxyError: As `read_mesh` and `unwrap_mesh`; `proxy-not-seen`: no camera sees the mesh.
        OptionError: As `unwrap_mesh`.
    """
    path = None if isinstance(path_or_mesh, Mesh) else Path(path_or_mesh)
    mesh = _from_memory(path_or_mesh) if isinstance(path_or_mesh, Mesh) else read_mesh(path_or_mesh, origin)
    _check_seen(mesh, cameras, path)
    try:
        count = triangles(mesh) if callable(triangles) else triangles
        return unwrap_mesh(mesh, triangles=count, cameras=cameras, progress=progress)
    except ProxyError as error:
        raise ProxyError(error.code, error.message, path=path, remedy=error.remedy) from error


def _from_memory(mesh: Mesh) -> Mesh:
    uv = None if mesh.uv is None else np.asarray(mesh.uv, np.float64)
    return check_mesh(RawMesh(np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64), uv), None)


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


def _covers_pixels(mesh: Mesh, camera: Camera) -> bool:
    small = camera.resize(PREPARE_THUMBNAIL_PIXELS, PREPARE_THUMBNAIL_PIXELS)
    return bool((rasterise_view(mesh, small).face >= 0).any())


def _point(position: NDArray[np.float64]) -> str:
    return "(" + ", ".join(f"{x:.3g}" for x in position) + ")"
