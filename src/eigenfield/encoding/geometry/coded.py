"""Mesh and cameras as a file keeps them in few bytes: rounded first, so that what follows is made for what is drawn.

Rounding steps are in pixels of the photographs.
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.codecs import encoder
from eigenfield.coding.mesh.coder import whole_faces
from eigenfield.core.camera import Camera
from eigenfield.core.lattice import Lattice, camera_lattice, world_lattice
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Coded, Payload, Payloads, cameras_key, mesh_key
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.gltf.layout_geometry import cameras_of

MESH_STEP_PX = 0.25  # in the reference camera, of meshes that are no relief
DEPTH_ERROR_PX = 0.04  # by which a rounded depth moves a point in the camera that is farthest from the reference
WORLD_STEP_PX = 0.1  # in the reference camera at the median depth, of a mesh that is not all before that camera
CAMERA_STEP_PX = 0.04
UV_BITS = 12
MESH_CODEC = "mesh-2"
CAMERAS_CODEC = "cameras-2"


def coded_mesh(proxy: Proxy, cameras: Sequence[Camera], reference: int) -> Coded[Proxy]:
    """The proxy with its mesh as a file will have it, rounded to a lattice.

    The lattice is pixels and inverse depth of the camera that a relief was made in, else of the reference camera where
    all of the mesh lies before it, else a grid in the world. Sheets of which rounding leaves no face are left out.

    Args:
        proxy: With its lattice if it is a relief. The opacity of its sheets stays as it is, and is not coded.
        cameras: All cameras of the file.
    """
    mesh, lattice = proxy.mesh, proxy.lattice
    if lattice is not None:
        with contextlib.suppress(ValueError):  # too far off the picture for the lattice
            return _code(proxy, lattice)
    camera = cameras[reference]
    depth = camera.project(mesh.vertices)[1]
    if (depth > 0).all():
        shifts = np.array([(camera.K @ camera.R @ (camera.centre - other.centre))[:2] for other in cameras])
        inverse = 2 * DEPTH_ERROR_PX / max(float(np.linalg.norm(shifts, axis=1).max()), 1e-9)
        inverse = max(inverse, float(1 / depth.min() / 2**19))
        with contextlib.suppress(ValueError):  # as above
            return _code(proxy, camera_lattice(camera.matrix, MESH_STEP_PX, inverse))
    low, high = mesh.vertices.min(axis=0).astype(np.float64), mesh.vertices.max(axis=0).astype(np.float64)
    near = float(np.median(depth[depth > 0])) if (depth > 0).any() else float(np.linalg.norm(high - low))
    step = max(WORLD_STEP_PX * near / float(camera.K[0, 0]), float((high - low).max()) / 2**19)
    return _code(proxy, world_lattice(low, step))


def _code(proxy: Proxy, lattice: Lattice) -> Coded[Proxy]:
    sheets = proxy.sheets
    faces = () if sheets is None else sheets.faces
    stream, mesh = encoder(MESH_CODEC)(proxy.mesh, lattice, uv_bits=UV_BITS, fine=lattice.fine, sheets=faces)
    if sheets is not None:
        sheets = Sheets(faces_left(faces, whole_faces(proxy.mesh, lattice)), sheets.opacity)
    return proxy_of_stream(stream, mesh, sheets)


def faces_left(sheets: tuple[int, ...], kept: NDArray[np.bool_]) -> tuple[int, ...]:
    """Number of faces of each sheet of which some are kept; () for no sheets.

    Args:
        sheets: Number of faces of each, at least 1.
        kept: (m,) whether each face of the mesh is.
    """
    if not sheets:
        return ()
    left = np.add.reduceat(kept, np.cumsum((0, *sheets[:-1])), dtype=np.int64)
    return tuple(left[left > 0].tolist())


def proxy_of_stream(stream: bytes, mesh: Mesh, sheets: Sheets | None = None) -> Coded[Proxy]:
    """The proxy whose mesh a stream of MESH_CODEC decodes to, with it."""
    return Coded(Proxy(mesh, sheets=sheets), Payloads({mesh_key(mesh): [Payload(MESH_CODEC, stream)]}))


def coded_cameras(cameras: Sequence[Camera], mesh: Mesh, grid: NDArray[np.int64] | None) -> Coded[tuple[Camera, ...]]:
    """The cameras as a file will have them: each number is off by at most CAMERA_STEP_PX / 2 at the median depth.

    Args:
        mesh: Whose median depth counts.
        grid: (rows, columns) of indices of cameras that stand on a regular array; None where they do not.
    """
    focal = float(np.median([camera.K[0, 0] for camera in cameras]))
    points = mesh.vertices[:: max(1, len(mesh.vertices) // 200)]
    depth = np.concatenate([camera.project(points)[1] for camera in cameras])
    near = float(np.median(depth[depth > 0])) if (depth > 0).any() else 1.0
    stream, intrinsics, poses = encoder(CAMERAS_CODEC)(
        cameras, intrinsic_step=CAMERA_STEP_PX, rotation_step=CAMERA_STEP_PX / focal,
        centre_step=CAMERA_STEP_PX * near / focal, grid=grid,
    )  # fmt: skip
    made = cameras_of(intrinsics, poses, np.array([[camera.width, camera.height] for camera in cameras]))
    return Coded(made, Payloads({cameras_key(made): [Payload(CAMERAS_CODEC, stream)]}))
