"""Reading a mesh file: UVs are converted to our convention, and unusable meshes are refused.

Texture coordinates have v up in OBJ and PLY and v down in glTF; here v is down. PLY, glTF, STL and OFF are parsed by
trimesh, OBJ by `obj.py`. Materials and images are ignored.
"""

from __future__ import annotations

import io
import logging
import os
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh, triangle_areas
from eigenfield.proxy.meshes.gltf import read_gltf
from eigenfield.proxy.meshes.obj import read_obj
from eigenfield.proxy.meshes.polygons import Polygons, check_range, split_seams, triangulate_polygons
from eigenfield.proxy.topology import remove_unused_vertices

log = logging.getLogger("eigenfield.proxy")

MESH_SUFFIXES = (".ply", ".obj", ".glb", ".gltf", ".stl", ".off")
MESH_SLIVER_RATIO = 1e-9  # area over the square of the longest edge: below, a triangle is degenerate
MESH_MAX_ROUNDING_RATIO = 1e-5  # float32 spacing over the mesh's extent: above, rounding is noticeable
PLY_UV_NAMES = (("s", "t"), ("u", "v"), ("texture_u", "texture_v"))


class RawMesh(NamedTuple):
    """A mesh as a file stores it.

    Attributes:
        vertices: (n, 3) float64.
        faces: (m, 3) int64.
        uv: (n, 2) float64, v down, or None.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]
    uv: NDArray[np.float64] | None


def read_mesh(path: str | os.PathLike[str], origin: NDArray[np.float64] | None = None) -> Mesh:
    """Read a PLY, OBJ, GLB/glTF, STL or OFF file.

    The mesh has the file's own UVs (a valid atlas or not: see `unwrap_mesh`), one a vertex, with vertices duplicated on
    seams. All geometries of a glTF scene are joined, with node transforms applied. Polygons are triangulated. Unused
    vertices and degenerate triangles are dropped; the log counts these.

    Args:
        path: The file.
        origin: (3,) taken off every position before they become float32: the `origin` of a capture. None: nothing.

    Raises:
        ProxyError: `proxy-missing`, `proxy-format`, `proxy-unreadable`, `proxy-empty`, `proxy-no-faces`,
            `proxy-index-range`, `proxy-not-finite` or `proxy-degenerate`.
    """
    file = Path(path)
    suffix = file.suffix.lower()
    if suffix not in MESH_SUFFIXES:
        raise ProxyError(
            "proxy-format",
            f"meshes ending in {suffix or 'nothing'} are not read",
            path=file,
            remedy=f"convert it to one of {', '.join(MESH_SUFFIXES)}",
        )
    if file.is_dir() or not file.exists():
        what = "is a folder" if file.is_dir() else "does not exist"
        raise ProxyError("proxy-missing", what, path=file, remedy="name the proxy's mesh file")
    try:
        data = file.read_bytes()
    except OSError as error:
        raise ProxyError(
            "proxy-unreadable",
            f"cannot be read ({error.strerror})",
            path=file,
            remedy="check the file and its permissions",
        ) from error
    raw = _parse(data, suffix, file)
    return check_mesh(raw if origin is None else raw._replace(vertices=raw.vertices - origin), file)


def _parse(data: bytes, suffix: str, file: Path) -> RawMesh:
    """A parser may raise anything on a damaged file; this is the only place that turns it into a ProxyError."""
    try:
        if suffix == ".obj":
            return RawMesh(*read_obj(data))
        if suffix in (".glb", ".gltf"):
            return RawMesh(*read_gltf(data, suffix, file))
        if suffix == ".ply":
            return _read_ply(data)
        return _read_plain(data, suffix)
    except ProxyError as error:
        raise ProxyError(error.code, error.message, path=file, remedy=error.remedy) from error
    except Exception as error:
        reason = " ".join(str(error).split())[:120] or type(error).__name__
        raise ProxyError(
            "proxy-unreadable",
            f"is damaged, or no {suffix[1:]} file ({reason})",
            path=file,
            remedy="export it again as triangles",
        ) from error


def _read_ply(data: bytes) -> RawMesh:
    """UVs a vertex (`s t`, `u v`, `texture_u texture_v`) or a list `texcoord` a face, as MeshLab writes them.

    They come from trimesh's parsed elements, not from its mesh, which merges nearly equal UVs and reorders vertices.
    """
    from trimesh.exchange.ply import load_ply

    try:
        loaded = load_ply(io.BytesIO(data), fix_texture=False, skip_materials=True)
    except IndexError as error:
        raise ProxyError(
            "proxy-index-range", "a face names a vertex that is not there", remedy="export it again"
        ) from error
    elements = loaded["metadata"]["_ply_raw"]
    vertex, face = elements.get("vertex", {}), elements.get("face", {})
    if not vertex.get("length"):
        return RawMesh(np.zeros((0, 3)), np.zeros((0, 3), np.int64), None)
    vertices = np.stack([np.ravel(vertex["data"][axis]) for axis in "xyz"], axis=1).astype(np.float64)
    if len(vertices) != vertex["length"]:
        raise ValueError(f"{vertex['length']} vertices announced, {len(vertices)} found")
    if not face.get("length"):
        return RawMesh(vertices, np.zeros((0, 3), np.int64), None)
    names = _names(face["data"])
    indices = _rows(face["data"], next((n for n in ("vertex_indices", "vertex_index") if n in names), names[0]))
    if len(indices) != face["length"]:
        raise ValueError(f"{face['length']} faces announced, {len(indices)} found")
    polygons = Polygons.from_rows(indices)
    if "texcoord" in names:
        corners = _rows(face["data"], "texcoord")
        if all(len(uv) == 2 * len(row) for uv, row in zip(corners, indices, strict=True)):
            uv = np.concatenate([np.asarray(row, np.float64) for row in corners]).reshape(-1, 2)
            check_range(polygons.corners, len(vertices))
            origin, faces, uv = split_seams(*triangulate_polygons(polygons, uv))
            return RawMesh(vertices[origin], faces, _flip_v(uv))
        log.warning("texture coordinates of some faces only: ignored")
    faces, _ = triangulate_polygons(polygons, None)
    for u, v in PLY_UV_NAMES:
        if u in _names(vertex["data"]) and v in _names(vertex["data"]):
            uv = np.stack([np.ravel(vertex["data"][n]) for n in (u, v)], axis=1).astype(np.float64)
            return RawMesh(vertices, faces, _flip_v(uv))
    return RawMesh(vertices, faces, None)


def _names(data: Any) -> tuple[str, ...]:
    return tuple(data) if isinstance(data, dict) else tuple(data.dtype.names)


def _rows(data: Any, name: str) -> Any:
    """Lists of one element, one a row: trimesh stores binary ones as a field "f1" beside their length "f0"."""
    column = data[name]
    return column["f1"] if getattr(column.dtype, "names", None) else column


def _read_plain(data: bytes, suffix: str) -> RawMesh:
    """STL and OFF, which have no UVs; identical corners of an STL are merged."""
    from trimesh.exchange.off import load_off
    from trimesh.exchange.stl import load_stl

    loaded = (load_off if suffix == ".off" else load_stl)(io.BytesIO(data))
    if "vertices" not in loaded or "faces" not in loaded:
        raise ValueError("no single mesh in it")
    raw = RawMesh(np.asarray(loaded["vertices"], np.float64), np.asarray(loaded["faces"], np.int64), None)
    if suffix == ".off":
        return raw
    vertices, index = np.unique(raw.vertices, axis=0, return_inverse=True)
    return RawMesh(vertices, index.reshape(-1)[raw.faces], None)


def _flip_v(uv: NDArray[np.float64]) -> NDArray[np.float64]:
    return uv * (1.0, -1.0) + (0.0, 1.0)


def check_mesh(raw: RawMesh, path: Path | None) -> Mesh:
    """The usable part of a mesh, as float32.

    Args:
        raw: As read from a file.
        path: Of the file, for messages.

    Raises:
        ProxyError: See `read_mesh`.
    """
    vertices, faces, uv = raw
    if len(vertices) == 0:
        raise ProxyError("proxy-empty", "has no vertices", path=path, remedy="export it again")
    if len(faces) == 0:
        raise ProxyError(
            "proxy-no-faces",
            f"has {len(vertices)} points but no triangles",
            path=path,
            remedy="a proxy is a surface: mesh the point cloud (Poisson or Delaunay) first",
        )
    check_range(faces.reshape(-1), len(vertices), path)
    with np.errstate(over="ignore"):
        single = vertices.astype(np.float32)
    broken = np.flatnonzero(~np.isfinite(single).all(axis=1))
    used = np.unique(faces)
    broken = broken[np.isin(broken, used)]
    if len(broken):
        raise ProxyError(
            "proxy-not-finite",
            f"{len(broken)} vertices have NaN or infinite positions, the first is {broken[0]}",
            path=path,
            remedy="remove them and their faces",
        )
    _warn_of_rounding(single[used], path)
    kept = faces[~is_sliver(single, faces)]
    if len(kept) == 0:
        raise ProxyError(
            "proxy-degenerate", f"none of its {len(faces)} triangles has an area", path=path, remedy="export it again"
        )
    if len(kept) < len(faces):
        log.warning("%s: %d of %d triangles have no area: dropped", path or "mesh", len(faces) - len(kept), len(faces))
    mesh = Mesh(single, kept.astype(np.int32), None if uv is None else uv.astype(np.float32))
    return remove_unused_vertices(mesh)


def is_sliver(vertices: NDArray[np.float32], faces: NDArray[Any]) -> NDArray[np.bool_]:
    """(m,) whether a triangle is degenerate at float32 precision.

    Args:
        vertices: (n, 3).
        faces: (m, 3).
    """
    corners = vertices[faces].astype(np.float64)
    sides = corners - np.roll(corners, 1, axis=1)
    longest = (sides**2).sum(axis=2).max(axis=1)
    return np.asarray(triangle_areas(corners) <= MESH_SLIVER_RATIO * longest)


def _warn_of_rounding(vertices: NDArray[np.float32], path: Path | None) -> None:
    extent = float(np.ptp(vertices.astype(np.float64), axis=0).max())
    spacing = float(np.spacing(np.abs(vertices).max()))
    if spacing > MESH_MAX_ROUNDING_RATIO * extent > 0:
        log.warning(
            "%s: vertices lie far from the origin for their extent of %g and are rounded to %g; move mesh and cameras "
            "nearer to it", path or "mesh", extent, spacing,
        )  # fmt: skip
