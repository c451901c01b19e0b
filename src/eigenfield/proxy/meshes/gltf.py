"""glTF 2.0 and GLB: all triangles of the scene, with node transforms applied.

trimesh reads TEXCOORD_0 only of primitives with a material, and a material only with its images. Every primitive is
therefore given one empty material, and materials, textures and images are removed before trimesh sees the file.
"""

from __future__ import annotations

import io
import json
import logging
import struct
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.proxy.meshes.polygons import check_range

log = logging.getLogger("eigenfield.proxy")

_GLB_MAGIC, _GLB_JSON_CHUNK = 0x46546C67, 0x4E4F534A


def read_gltf(
    data: bytes, suffix: str, path: Path
) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.float64] | None]:
    """All triangles of a scene.

    Args:
        data: The file.
        suffix: ".gltf" or ".glb".
        path: Of the file, for external buffers and messages.

    Returns:
        (n, 3) positions, (m, 3) faces and, if every primitive has them, (n, 2) UVs with v down.
    """
    import trimesh
    from trimesh.resolvers import FilePathResolver

    glb = suffix == ".glb"
    scene = trimesh.load_scene(
        io.BytesIO(_strip_glb(data) if glb else _strip_materials(data)),
        file_type=suffix[1:],
        resolver=FilePathResolver(str(path)),
        process=False,
    )
    vertices, faces, uvs, without = [], [], [], 0
    start = 0
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        part = scene.geometry[name]
        if not isinstance(part, trimesh.Trimesh):
            continue
        points = np.asarray(part.vertices, np.float64)
        triangles = np.asarray(part.faces, np.int64)
        check_range(triangles.reshape(-1), len(points))
        if np.linalg.det(transform[:3, :3]) < 0:
            triangles = triangles[:, ::-1]
        uv = getattr(part.visual, "uv", None)
        without += uv is None or len(uv) != len(points)
        vertices.append(points @ transform[:3, :3].T + transform[:3, 3])
        faces.append(triangles + start)
        uvs.append(np.zeros((len(points), 2)) if uv is None else np.asarray(uv, np.float64) * (1, -1) + (0, 1))
        start += len(points)
    if not vertices:
        return np.zeros((0, 3)), np.zeros((0, 3), np.int64), None
    if 0 < without < len(vertices):
        log.info(
            "%s: %d of %d parts have no texture coordinates: those of the others are ignored", path, without, len(uvs)
        )
    return np.concatenate(vertices), np.concatenate(faces), None if without else np.concatenate(uvs)


def _strip_glb(data: bytes) -> bytes:
    """The GLB with its JSON chunk stripped of materials."""
    magic, version, length = struct.unpack_from("<III", data, 0)
    size, kind = struct.unpack_from("<II", data, 12)
    if magic != _GLB_MAGIC or version != 2 or kind != _GLB_JSON_CHUNK:
        raise ValueError("no glTF 2.0 header")
    if length > len(data) or 20 + size > length:
        raise ValueError(f"{length} bytes announced, {len(data)} found")
    text = _strip_materials(data[20 : 20 + size])
    text += b" " * (-len(text) % 4)
    rest = data[20 + size : length]
    head = struct.pack("<IIIII", _GLB_MAGIC, 2, 20 + len(text) + len(rest), len(text), _GLB_JSON_CHUNK)
    return head + text + rest


def _strip_materials(text: bytes) -> bytes:
    tree: dict[str, Any] = json.loads(text)
    for key in ("images", "textures", "samplers", "extensions"):
        tree.pop(key, None)
    tree["materials"] = [{}]
    required = set(tree.pop("extensionsRequired", [])) & {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}
    if required:
        raise ValueError(f"its geometry is compressed ({', '.join(sorted(required))})")
    for mesh in tree.get("meshes", []):
        for primitive in mesh.get("primitives", []):
            primitive["material"] = 0
    return json.dumps(tree).encode()
