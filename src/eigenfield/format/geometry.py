"""Mesh and cameras as a file keeps them in few bytes: rounded first, so that what follows is made for what is drawn.

How far a rounding moves anything is said in pixels of the photographs.
"""

from __future__ import annotations

import contextlib
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from eigenfield.camera import Camera
from eigenfield.errors import FormatError
from eigenfield.format.camera_coder import code_cameras, decode_cameras
from eigenfield.format.lattice import camera_lattice, world_lattice
from eigenfield.format.mesh_coder import decode_mesh, encode_mesh
from eigenfield.format.relief_lattice import relief_lattice
from eigenfield.mesh import Mesh
from eigenfield.scene import Scene

PIXEL_STEP = 0.25  # pixels of the reference camera, for meshes that are no relief
DEPTH_ERROR = 0.04  # pixels by which a rounded depth moves a point in the camera that is farthest from the reference
WORLD_STEP = 0.1  # pixels of the reference camera at the median depth: of a mesh that is not all before that camera
CAMERA_STEP = 0.02  # pixels
UV_BITS = 12
COARSE = 256  # triangles of the mesh that other viewers show


def code_mesh(mesh: Mesh, cameras: Sequence[Camera], reference: int) -> tuple[bytes, Mesh]:
    """The stream, and the mesh that it holds: rounded to pixels and inverse depth of the camera that a relief was made
    in, else of the reference camera where that has all of the mesh before it, else to a grid in the world."""
    relief = relief_lattice(mesh, cameras, DEPTH_ERROR)
    if relief is not None:
        with contextlib.suppress(ValueError):  # too far off the picture for the lattice
            return encode_mesh(mesh, relief[0], uv_bits=UV_BITS, fine=relief[1])
    camera = cameras[reference]
    depth = camera.project(mesh.vertices)[1]
    if (depth > 0).all():
        shifts = np.array([(camera.K @ camera.R @ (camera.centre - other.centre))[:2] for other in cameras])
        inverse = 2 * DEPTH_ERROR / max(float(np.linalg.norm(shifts, axis=1).max()), 1e-9)
        inverse = max(inverse, float(1 / depth.min() / 2**19))
        matrix = camera.K @ np.hstack([camera.R, camera.t[:, None]])
        with contextlib.suppress(ValueError):  # as above
            return encode_mesh(mesh, camera_lattice(matrix, PIXEL_STEP, inverse), uv_bits=UV_BITS)
    low, high = mesh.vertices.min(axis=0).astype(np.float64), mesh.vertices.max(axis=0).astype(np.float64)
    near = float(np.median(depth[depth > 0])) if (depth > 0).any() else float(np.linalg.norm(high - low))
    step = max(WORLD_STEP * near / float(camera.K[0, 0]), float((high - low).max()) / 2**19)
    return encode_mesh(mesh, world_lattice(low, step), uv_bits=UV_BITS)


def code_cameras_of(
    cameras: Sequence[Camera], mesh: Mesh, grid: NDArray[np.int64] | None
) -> tuple[bytes, tuple[Camera, ...]]:
    """The stream, and the cameras that it holds: each number is off by at most CAMERA_STEP / 2 pixels at the mesh's
    median depth."""
    focal = float(np.median([camera.K[0, 0] for camera in cameras]))
    depth = np.concatenate(
        [camera.project(mesh.vertices[:: max(1, len(mesh.vertices) // 200)])[1] for camera in cameras]
    )
    near = float(np.median(depth[depth > 0])) if (depth > 0).any() else 1.0
    stream, intrinsics, poses = code_cameras(
        cameras, intrinsic_step=CAMERA_STEP, rotation_step=CAMERA_STEP / focal,
        centre_step=CAMERA_STEP * near / focal, grid=grid,
    )  # fmt: skip
    return stream, _cameras(intrinsics, poses, cameras)


def _cameras(intrinsics: NDArray[np.float32], poses: NDArray[np.float32], of: Sequence[Camera]) -> tuple[Camera, ...]:
    made = []
    for (fx, fy, skew, cx, cy), pose, camera in zip(intrinsics.astype(float), poses.astype(float), of, strict=True):
        K = np.array([[fx, skew, cx], [0, fy, cy], [0, 0, 1]])
        made.append(Camera(K, np.ascontiguousarray(pose[:, :3]), pose[:, 3].copy(), camera.width, camera.height))
    return tuple(made)


def camera_numbers(cameras: Sequence[Camera]) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Intrinsics (Nc, 5): fx, fy, skew, cx, cy; poses (Nc, 12): [R t], row by row; as a file has them."""
    intrinsics = np.array([[c.K[0, 0], c.K[1, 1], c.K[0, 1], c.K[0, 2], c.K[1, 2]] for c in cameras], np.float32)
    poses = np.array([np.hstack([c.R, c.t[:, None]]).ravel() for c in cameras], np.float32)
    return intrinsics, poses


def checked_streams(scene: Scene) -> Mapping[str, bytes]:
    """Those of the scene's streams that decode to what it has: a changed copy of a scene may carry others."""
    found = {}
    for name, stream in scene.streams.items():
        try:
            same = _same_mesh(stream, scene.mesh) if name == "mesh" else _same_cameras(stream, scene.cameras)
        except FormatError:
            same = False
        if same:
            found[name] = stream
    return found


def _same_mesh(stream: bytes, mesh: Mesh) -> bool:
    other = decode_mesh(stream)
    assert other.uv is not None and mesh.uv is not None
    pairs = ((other.vertices, mesh.vertices), (other.faces, mesh.faces), (other.uv, mesh.uv))
    return all(np.array_equal(a, b) for a, b in pairs)


def _same_cameras(stream: bytes, cameras: Sequence[Camera]) -> bool:
    intrinsics, poses = decode_cameras(stream)
    mine = camera_numbers(cameras)
    return np.array_equal(intrinsics, mine[0]) and np.array_equal(poses.reshape(len(poses), 12), mine[1])


def coarse_mesh(mesh: Mesh, triangles: int = COARSE) -> Mesh:
    """The mesh simplified for viewers that know nothing of ours; of the vertices that fell together the one nearest to
    where they came to lie gives the texture coordinates."""
    import fast_simplification

    assert mesh.uv is not None
    if len(mesh.faces) <= triangles:
        return mesh
    _, _, collapses = fast_simplification.simplify(
        mesh.vertices, mesh.faces, target_count=triangles, return_collapses=True
    )
    points, faces, fell = fast_simplification.replay_simplification(mesh.vertices, mesh.faces, collapses)
    if not len(faces):
        return mesh
    apart = np.linalg.norm(mesh.vertices - points[fell], axis=1)
    uv = np.zeros((len(points), 2))
    farthest_first = np.argsort(-apart, kind="stable")
    uv[fell[farthest_first]] = mesh.uv[farthest_first]  # the last to be written stays
    used, corners = np.unique(faces, return_inverse=True)
    return Mesh(
        np.ascontiguousarray(points[used], np.float32), corners.reshape(-1, 3).astype(np.int32),
        np.ascontiguousarray(uv[used], np.float32),
    )  # fmt: skip
