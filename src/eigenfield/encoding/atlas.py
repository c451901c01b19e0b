"""Where the texels of an atlas lie in the world."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import Mesh, signed_areas
from eigenfield.imaging.raster import rasterise_atlas, rasterise_view

ATLAS_SIDE_STEP_TEXELS = 64  # sides are multiples of this
ATLAS_MAX_TEXELS_PER_PIXEL = 2.0  # of all photographs together, where a density is asked for
ATLAS_SIDE_CAP_TEXELS = 4096  # where a density is asked for; `atlas=` may ask for more


@dataclass(frozen=True, eq=False)
class Atlas:
    """The texels whose centre lies in a triangle ("chart texels"), n of them, in row-major order.

    Attributes:
        mesh: With UVs.
        texel: (n,) int64, row * width + column.
        face: (n,) int32.
        position: (n, 3) float32, world.
        normal: (m, 3) float32 of each face.
        along: (m, 3) float32, how far one texel to the right leads in the world, on each face.
        down: (m, 3) float32, how far one texel down does.
    """

    mesh: Mesh
    width: int
    height: int
    texel: NDArray[np.int64]
    face: NDArray[np.int32]
    position: NDArray[np.float32]
    normal: NDArray[np.float32]
    along: NDArray[np.float32]
    down: NDArray[np.float32]

    @property
    def count(self) -> int:
        return len(self.texel)

    def image(self, values: NDArray[np.float32], blank: float = 0.0) -> NDArray[np.float32]:
        """(n, C) values at the chart texels as an (H, W, C) picture, `blank` elsewhere."""
        picture = np.full((self.height * self.width, values.shape[1]), blank, np.float32)
        picture[self.texel] = values
        return picture.reshape(self.height, self.width, -1)


def make_atlas(mesh: Mesh, width: int, height: int) -> Atlas:
    """Rasterise a mesh in UV space: the inverse texturing map at every texel centre.

    Raises:
        ProxyError: `atlas-empty`, no texel centre lies in a triangle.
    """
    assert mesh.uv is not None
    raster = rasterise_atlas(mesh, width, height)
    texel = np.flatnonzero(raster.face >= 0)
    if len(texel) == 0:
        message = f"no texel of a {width}x{height} atlas lies in a triangle"
        raise ProxyError("atlas-empty", message, remedy="ask for a larger --atlas")
    face = raster.face.reshape(-1)[texel]
    row, column = np.divmod(texel, width)
    centre = np.stack([column + 0.5, row + 0.5, np.ones(len(texel))], axis=1)
    corners = mesh.vertices[mesh.faces].astype(np.float64)  # (m, 3, 3)
    affine = np.einsum("fke,fkx->fxe", raster.edges, corners)  # (m, 3, 3): world = affine @ (column, row, 1)
    position = np.empty((len(texel), 3), np.float32)
    for start in range(0, len(texel), 1 << 18):  # the gathered matrices are the largest thing here
        part = slice(start, start + (1 << 18))
        position[part] = np.einsum("nxe,ne->nx", affine[face[part]], centre[part])
    normal, along, down = (a.astype(np.float32) for a in (mesh.face_normals(), affine[:, :, 0], affine[:, :, 1]))
    return Atlas(mesh, width, height, texel, face, position, normal, along, down)


def texels_per_pixel(mesh: Mesh, camera: Camera) -> float:
    """Median over the visible surface of sqrt(UV area / pixel area): times the atlas side, this is the density.

    Raises:
        ProxyError: `proxy-not-seen`, the camera sees nothing of the mesh.
    """
    assert mesh.uv is not None
    seen = rasterise_view(mesh, camera).face
    faces, pixels = np.unique(seen[seen >= 0], return_counts=True)
    uv = mesh.uv[mesh.faces[faces]].astype(np.float64)
    flat, depth = camera.project(mesh.vertices[mesh.faces[faces]].reshape(-1, 3))
    ahead = (depth.reshape(-1, 3) > 0).all(axis=1)
    area = np.abs(signed_areas(flat.reshape(-1, 3, 2)))
    usable = ahead & (area > 0)
    ratio, mass = np.sqrt(np.abs(signed_areas(uv))[usable] / area[usable]), pixels[usable]
    if not ahead.all():  # a floor, or a wall, that runs on behind the camera: by its pixels
        near = _ratios_of_pixels(mesh, camera, np.where(np.isin(seen, faces[~ahead]), seen, -1))
        ratio, mass = np.concatenate([ratio, near]), np.concatenate([mass, np.ones(len(near), mass.dtype)])
    if not len(ratio):
        message = "the camera nearest the centre of the array sees nothing of the mesh"
        remedy = "bring the mesh into the frame of the cameras "
        remedy += "(`eigenfield inspect CAPTURE --proxy MESH --overlay overlay.png` shows both)"
        raise ProxyError("proxy-not-seen", message, remedy=remedy)
    order = np.argsort(ratio, kind="stable")
    passed = np.cumsum(mass[order])
    return float(ratio[order][np.searchsorted(passed, passed[-1] / 2)])


def _ratios_of_pixels(mesh: Mesh, camera: Camera, seen: NDArray[np.int32]) -> NDArray[np.float64]:
    """(n,) sqrt(UV area / pixel area) in each pixel whose triangle `seen` (H, W) names, -1 for none.

    A pixel's place in texture coordinates is a homography of the pixel, whose area changes by its determinant and the
    third power of its last row.
    """
    assert mesh.uv is not None
    row, column = np.nonzero(seen >= 0)
    corners = mesh.faces[seen[row, column]]
    flat = np.stack([column + 0.5, row + 0.5, np.ones(len(row))], axis=1)
    shown = (mesh.vertices.astype(np.float64) @ camera.R.T + camera.t) @ camera.K.T  # homogeneous pixels
    to_corners = np.linalg.inv(shown[corners].transpose(0, 2, 1))
    last = (to_corners.sum(axis=1) * flat).sum(axis=1)
    uv = mesh.uv[corners].astype(np.float64)
    whole = 2 * np.abs(signed_areas(uv)) * np.abs(np.linalg.det(to_corners))
    ratio: NDArray[np.float64] = np.sqrt(whole / np.abs(last) ** 3)
    return ratio


def atlas_side(mesh: Mesh, camera: Camera, density: float, pixels: int | None = None) -> int:
    """Side of a square atlas whose density in `camera` is at least `density`, at most ATLAS_SIDE_CAP_TEXELS.

    Args:
        density: Atlas texels per photograph pixel along one axis.
        pixels: Of all photographs together. The atlas has at most ATLAS_MAX_TEXELS_PER_PIXEL times as many texels:
            where most of the surface is seen by one camera alone, as behind a ring of them, more would hold nothing.
    """
    side = density / texels_per_pixel(mesh, camera)
    if pixels is not None:
        side = min(side, math.sqrt(ATLAS_MAX_TEXELS_PER_PIXEL * pixels))
    steps = math.ceil(min(side, ATLAS_SIDE_CAP_TEXELS) / ATLAS_SIDE_STEP_TEXELS)
    return min(max(steps, 1) * ATLAS_SIDE_STEP_TEXELS, ATLAS_SIDE_CAP_TEXELS)
