"""Another mesh in a scene whose textures stay as they are."""

from __future__ import annotations

from dataclasses import replace
from typing import TypeVar

import numpy as np

from eigenfield.core.arguments import checked
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.scene import Scene
from eigenfield.encoding.geometry.coded import DEPTH_ERROR_PX, coded_mesh
from eigenfield.proxy.meshes.formats import RawMesh
from eigenfield.proxy.meshes.read import check_mesh
from eigenfield.proxy.relief.find_lattice import relief_proxy

S = TypeVar("S", bound=Scene)
SHAPES = "give (n, 3), (m, 3) and (n, 2)"  # what an error says of vertices, faces and texture coordinates
EXCHANGE_UV_SLACK = 1e-4  # of the atlas, by which texture coordinates may be rounded beyond it


@checked
def with_mesh(scene: S, mesh: Mesh) -> S:
    """The scene on another mesh, whose texture coordinates are places in the same atlas. The textures stay as they are,
    so the mesh may be cut, moved or simplified. For another atlas the photographs are encoded anew.

    The mesh is coded as `encode` codes it, which rounds it. Scores and residual are those of the former mesh and go. A
    scene with sheets needs as many triangles as it has, in their order.

    Args:
        scene: The scene.
        mesh: With texture coordinates.

    Raises:
        ProxyError: `proxy-no-uv`, `proxy-uv`, `proxy-shape`, `proxy-sheets`; as for reading a mesh.
    """
    sheets = scene.proxy.sheets
    raw = _raw(mesh)
    sound = check_mesh(raw, None)
    if sheets is not None and len(raw.faces) != sum(sheets.faces):
        message = f"the mesh has {len(raw.faces)} triangles, and the scene's sheets have {sum(sheets.faces)}"
        raise ProxyError("proxy-sheets", message, remedy="keep all of them, in their order")
    if sheets is not None:  # they are counted by triangles, of which none may be left out
        sound = Mesh(raw.vertices.astype(np.float32), raw.faces.astype(np.int32), np.asarray(raw.uv, np.float32))
    proxy = replace(relief_proxy(sound, scene.rig.cameras, DEPTH_ERROR_PX), sheets=sheets)
    made = coded_mesh(proxy, scene.rig.cameras, scene.rig.reference)
    payloads = scene.payloads.without("mesh") | made.payloads
    return replace(scene, proxy=made.value, payloads=payloads, scores={}, residual=None)


def _raw(mesh: Mesh) -> RawMesh:
    """The mesh with checked shapes and texture coordinates."""
    if mesh.uv is None:
        remedy = "give it those of the scene's mesh, or encode the photographs with it"
        raise ProxyError("proxy-no-uv", "the mesh has no texture coordinates", remedy=remedy)
    try:
        vertices, faces, uv = np.asarray(mesh.vertices, float), np.asarray(mesh.faces), np.asarray(mesh.uv, float)
    except (TypeError, ValueError):
        message = "vertices, faces and texture coordinates are no arrays of numbers"
        raise ProxyError("proxy-shape", message, remedy=SHAPES) from None
    count = vertices.shape[:1]
    if (vertices.shape, faces.shape, uv.shape) != ((*count, 3), (*faces.shape[:1], 3), (*count, 2)):
        message = f"vertices {vertices.shape}, faces {faces.shape} and texture coordinates {uv.shape} make no mesh"
        raise ProxyError("proxy-shape", message, remedy=SHAPES)
    if faces.dtype.kind not in "iu":
        message = f"faces of {faces.dtype} are no indices of vertices"
        raise ProxyError("proxy-shape", message, remedy="give whole numbers")
    if not ((uv >= -EXCHANGE_UV_SLACK) & (uv <= 1 + EXCHANGE_UV_SLACK)).all():
        message = "texture coordinates lie outside the atlas"
        raise ProxyError("proxy-uv", message, remedy="give numbers from 0 to 1, v down")
    return RawMesh(vertices, faces.astype(np.int64), uv.clip(0, 1))
