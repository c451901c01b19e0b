"""Reading a mesh file: UVs are converted to our convention, and unusable meshes are refused.

Texture coordinates have v up in OBJ and PLY and v down in glTF; here v is down. Each format has a reader of its own.
Materials and images are ignored.
"""

from __future__ import annotations

import codecs
import logging
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.errors import FormatError, ProxyError
from eigenfield.core.mesh import Mesh
from eigenfield.core.recognise import read_head, recognise, refuse_address
from eigenfield.proxy.meshes.formats import RawMesh
from eigenfield.proxy.meshes.gltf import GLTF
from eigenfield.proxy.meshes.obj import OBJ
from eigenfield.proxy.meshes.off import OFF
from eigenfield.proxy.meshes.ply import PLY
from eigenfield.proxy.meshes.polygons import check_range
from eigenfield.proxy.meshes.sound import make_sound
from eigenfield.proxy.meshes.stl import STL
from eigenfield.proxy.topology import is_sliver, remove_unused_vertices
from eigenfield.runtime.objects import local_copy

log = logging.getLogger("eigenfield.proxy")

MESH_FORMATS = (PLY, OBJ, GLTF, STL, OFF)
MESH_SUFFIXES = tuple(suffix for each in MESH_FORMATS for suffix in each.suffixes)
MESH_MAX_ROUNDING_RATIO = 1e-5  # float32 spacing over the mesh's extent: above, rounding is noticeable


def read_mesh(path: str | os.PathLike[str], origin: NDArray[np.float64] | None = None) -> Mesh:
    """Read a PLY, OBJ, GLB/glTF, STL or OFF file.

    The mesh has the file's own UVs (a valid atlas or not: see `unwrap_mesh`), one a vertex, with vertices duplicated on
    seams. All geometries of a glTF scene are joined, with node transforms applied. Polygons are triangulated. Unused
    vertices, degenerate triangles and those that are there twice are dropped, and neighbours are wound alike (see
    `make_sound`); the log counts these.

    Args:
        path: The file.
        origin: (3,) taken off every position before they become float32: the `origin` of a capture. None: nothing.

    Raises:
        ProxyError: `proxy-missing`, `proxy-format`, `proxy-unreadable`, `proxy-outside`, `proxy-extension`,
            `proxy-nodes`, `proxy-polygon`, `proxy-empty`, `proxy-no-faces`, `proxy-index-range`, `proxy-not-finite` or
            `proxy-degenerate`.
    """
    return check_mesh(read_raw(path, origin), local_copy(path))


def read_raw(path: str | os.PathLike[str], origin: NDArray[np.float64] | None = None) -> RawMesh:
    """What a mesh file says, not checked; otherwise as `read_mesh`."""
    file = local_copy(path)
    refuse_no_mesh(file)
    try:
        data = file.read_bytes()
    except OSError as error:
        raise ProxyError(
            "proxy-unreadable",
            f"cannot be read ({error.strerror})",
            path=file,
            remedy="check the file and its permissions",
        ) from error
    raw = _parse(data, file.suffix.lower(), file)
    return raw if origin is None else raw._replace(vertices=raw.vertices - origin)


def raw_of(mesh: Mesh) -> RawMesh:
    """A mesh in memory as if it came from a file."""
    uv = None if mesh.uv is None else np.asarray(mesh.uv, np.float64)
    return RawMesh(np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces, np.int64), uv)


def refuse_no_mesh(path: Path) -> None:
    """Before any work: refuse what is no file of a mesh, by its name and its first bytes.

    Raises:
        ProxyError: `proxy-missing`, `proxy-format`.
        OptionError: `web-address`.
    """
    path = local_copy(path)
    suffix, what = path.suffix.lower(), recognise(read_head(path))
    if what is not None:
        raise ProxyError("proxy-format", f"is {what}, and no mesh", path=path, remedy=_remedy("name a mesh"))
    if not path.exists():
        refuse_address(path)
    if path.is_dir() or (suffix in MESH_SUFFIXES and not path.exists()):
        what = "is a folder, and no mesh" if path.is_dir() else "this mesh does not exist"
        raise ProxyError("proxy-missing", what, path=path, remedy=_remedy("name the proxy's mesh file"))
    if suffix not in MESH_SUFFIXES:
        raise ProxyError(
            "proxy-format",
            f"meshes ending in {suffix or 'nothing'} are not read",
            path=path,
            remedy=f"convert it to one of {', '.join(MESH_SUFFIXES)}",
        )


def _remedy(remedy: str) -> str:
    return f"{remedy}, or leave it out: `eigenfield encode CAPTURE -o scene.glb` makes one from the photographs"


def _parse(data: bytes, suffix: str, file: Path) -> RawMesh:
    """A parser may raise anything on a damaged file; this is the only place that turns it into a ProxyError."""
    try:
        reader = next(each.read for each in MESH_FORMATS if suffix in each.suffixes)
        return reader(_without_mark(data), file)
    except ProxyError as error:
        raise ProxyError(error.code, error.message, path=file, remedy=error.remedy) from error
    except Exception as error:
        reason = error.message if isinstance(error, FormatError) else " ".join(str(error).split())
        raise ProxyError(
            "proxy-unreadable",
            f"is damaged, or no {suffix[1:]} file ({reason[:120] or type(error).__name__})",
            path=file,
            remedy="export it again as triangles",
        ) from error


def _without_mark(data: bytes) -> bytes:
    """The file without a byte order mark, and UTF-16 as UTF-8."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data.decode("utf-16").encode()
    return data.removeprefix(codecs.BOM_UTF8)


def check_mesh(raw: RawMesh, path: Path | None) -> Mesh:
    """The usable part of a mesh, as float32.

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
    used = np.zeros(len(vertices), bool)
    used[faces] = True
    broken = broken[used[broken]]
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
    if not used.all():
        log.info("%s: %d vertices that no triangle uses are dropped", path or "mesh", len(vertices) - used.sum())
    return remove_unused_vertices(make_sound(mesh, path))


def _warn_of_rounding(vertices: NDArray[np.float32], path: Path | None) -> None:
    extent = float(np.ptp(vertices.astype(np.float64), axis=0).max())
    spacing = float(np.spacing(np.abs(vertices).max()))
    if spacing > MESH_MAX_ROUNDING_RATIO * extent > 0:
        log.warning(
            "%s: vertices lie far from the origin for their extent of %g and are rounded to %g; move mesh and cameras "
            "nearer to it", path or "mesh", extent, spacing,
        )  # fmt: skip
