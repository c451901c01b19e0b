"""The proxy as a file keeps it: a mesh, the lattice that its vertices stand on, and sheets with an opacity."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.brief import brief_repr
from eigenfield.core.lattice import Lattice
from eigenfield.core.mesh import Mesh


@dataclass(frozen=True, eq=False)
class Sheets:
    """Parts of a mesh that are drawn one over the other, each as opaque as a picture over the atlas says.

    A pixel is composited back to front: what a sheet shows in its nearest point, times its opacity there, covers what
    is behind. Sheets share neither vertices nor texels.

    Attributes:
        faces: Number of faces of each sheet; the mesh has them sheet by sheet, back to front.
        opacity: (H, W) float32 in 0..1 over the whole atlas, at a density of its own. It is read as colours are, by
            the same filter, and clipped to 0..1.
    """

    faces: tuple[int, ...]
    opacity: NDArray[np.float32]

    __repr__ = brief_repr


@dataclass(frozen=True, eq=False)
class Proxy:
    """The surface that a scene is drawn on.

    Attributes:
        mesh: With UVs.
        lattice: Pixels and inverse depths of the camera in which a relief was made; None for other meshes, and before
            it was searched.
        sheets: None: one opaque surface.
    """

    mesh: Mesh
    lattice: Lattice | None = None
    sheets: Sheets | None = None

    __repr__ = brief_repr


@dataclass(frozen=True, eq=False)
class MovingProxy:
    """A proxy over the frames of a clip. Faces, texture coordinates and the division into sheets stay as they are.

    Attributes:
        proxy: Of the first frame.
        positions: (T, v, 3) float32, the vertices of each frame.
        opacity: (T, H, W) float32 in 0..1 of each frame, maybe of a file on disk; None without sheets.
    """

    proxy: Proxy
    positions: NDArray[np.float32]
    opacity: NDArray[np.float32] | None = None

    __repr__ = brief_repr


def opaque_mesh(proxy: Proxy) -> Mesh:
    """The mesh; of sheets the faces in whose middle they are at least half opaque."""
    mesh, sheets = proxy.mesh, proxy.sheets
    if sheets is None:
        return mesh
    assert mesh.uv is not None
    size = sheets.opacity.shape
    column, row = (mesh.uv[mesh.faces].mean(axis=1) * (size[1], size[0])).astype(np.int64).T
    opaque = sheets.opacity[row.clip(0, size[0] - 1), column.clip(0, size[1] - 1)] >= 0.5
    return mesh.part(opaque)
