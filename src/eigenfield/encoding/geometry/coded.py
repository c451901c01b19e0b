"""Mesh and cameras as a file keeps them in few bytes: rounded first, so that what follows is made for what is drawn.

How far a rounding moves anything is said in pixels of the photographs.
"""

from __future__ import annotations

import contextlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.coding.codecs import encoder
from eigenfield.core.camera import Camera
from eigenfield.core.lattice import camera_lattice, world_lattice
from eigenfield.core.mesh import Mesh
from eigenfield.core.payloads import Coded, Payload, Payloads, cameras_key, mesh_key
from eigenfield.gltf.layout_geometry import cameras_of
from eigenfield.proxy.relief.find_lattice import relief_lattice

PIXEL_STEP = 0.25  # pixels of the reference camera, for meshes that are no relief
DEPTH_ERROR = 0.04  # pixels by which a rounded depth moves a point in the camera that is farthest from the reference
WORLD_STEP = 0.1  # pixels of the reference camera at the median depth: of a mesh that is not all before that camera
CAMERA_STEP = 0.04  # pixels
UV_BITS = 12
MESH_CODEC = "mesh-1"
CAMERAS_CODEC = "cameras-1"


def coded_mesh(mesh: Mesh, cameras: Sequence[Camera], reference: int) -> Coded[Mesh]:
    """The mesh as a file will have it: rounded to pixels and inverse depth of the camera that a relief was made in,
    else of the reference camera where that has all of the mesh before it, else to a grid in the world."""
    return mesh_of_stream(*_code_mesh(mesh, cameras, reference))


def mesh_of_stream(stream: bytes, mesh: Mesh) -> Coded[Mesh]:
    """The mesh that a stream of MESH_CODEC decodes to, with it."""
    return Coded(mesh, Payloads({mesh_key(mesh): [Payload(MESH_CODEC, stream)]}))


def _code_mesh(mesh: Mesh, cameras: Sequence[Camera], reference: int) -> tuple[bytes, Mesh]:
    encode = encoder(MESH_CODEC)
    relief = relief_lattice(mesh, cameras, DEPTH_ERROR)
    if relief is not None:
        with contextlib.suppress(ValueError):  # too far off the picture for the lattice
            return encode(mesh, relief[0], uv_bits=UV_BITS, fine=relief[1])
    camera = cameras[reference]
    depth = camera.project(mesh.vertices)[1]
    if (depth > 0).all():
        shifts = np.array([(camera.K @ camera.R @ (camera.centre - other.centre))[:2] for other in cameras])
        inverse = 2 * DEPTH_ERROR / max(float(np.linalg.norm(shifts, axis=1).max()), 1e-9)
        inverse = max(inverse, float(1 / depth.min() / 2**19))
        matrix = camera.K @ np.hstack([camera.R, camera.t[:, None]])
        with contextlib.suppress(ValueError):  # as above
            return encode(mesh, camera_lattice(matrix, PIXEL_STEP, inverse), uv_bits=UV_BITS)
    low, high = mesh.vertices.min(axis=0).astype(np.float64), mesh.vertices.max(axis=0).astype(np.float64)
    near = float(np.median(depth[depth > 0])) if (depth > 0).any() else float(np.linalg.norm(high - low))
    step = max(WORLD_STEP * near / float(camera.K[0, 0]), float((high - low).max()) / 2**19)
    return encode(mesh, world_lattice(low, step), uv_bits=UV_BITS)


def coded_cameras(cameras: Sequence[Camera], mesh: Mesh, grid: NDArray[np.int64] | None) -> Coded[tuple[Camera, ...]]:
    """The cameras as a file will have them: each number is off by at most CAMERA_STEP / 2 pixels at the mesh's median
    depth."""
    focal = float(np.median([camera.K[0, 0] for camera in cameras]))
    depth = np.concatenate(
        [camera.project(mesh.vertices[:: max(1, len(mesh.vertices) // 200)])[1] for camera in cameras]
    )
    near = float(np.median(depth[depth > 0])) if (depth > 0).any() else 1.0
    stream, intrinsics, poses = encoder(CAMERAS_CODEC)(
        cameras, intrinsic_step=CAMERA_STEP, rotation_step=CAMERA_STEP / focal,
        centre_step=CAMERA_STEP * near / focal, grid=grid,
    )  # fmt: skip
    made = cameras_of(intrinsics, poses, np.array([[camera.width, camera.height] for camera in cameras]))
    return Coded(made, Payloads({cameras_key(made): [Payload(CAMERAS_CODEC, stream)]}))
