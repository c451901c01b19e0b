"""Whether a mesh's UV layout is a valid atlas, and its quality."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh, signed_areas, triangle_areas
from eigenfield.imaging.raster import rasterise_view
from eigenfield.proxy.atlas.kernels import count_layers
from eigenfield.proxy.surface.neighbours import spread_views
from eigenfield.proxy.topology import face_components

ATLAS_RASTER_TEXELS = 2048  # side of the raster on which overlap and fill are counted
ATLAS_MARGIN_TEXELS = 0.05  # of that raster: UVs are often printed with six digits
ATLAS_BORDER_UV = 5e-4  # UVs up to this far outside 0..1 (half a texel at 1024) are clipped
ATLAS_MAX_OVERLAP_FRACTION = 0.005  # covered texels in more than one triangle
ATLAS_MAX_FLAT_FRACTION = 0.01  # surface whose UV triangles have no area
ATLAS_STARVED_VIEWS = 8  # in which pixels of triangles are counted
ATLAS_STARVED_SIDE_PIXELS = 256  # longest side of these
ATLAS_STARVED_RATIO = 1 / 8  # of a triangle's texels a pixel to those of all
ATLAS_MAX_STARVED_FRACTION = 0.2  # of the pixels, in such triangles


@dataclass(frozen=True)
class AtlasStatistics:
    """Quality measures of an atlas.

    Attributes:
        charts: Number of charts, connected by vertices.
        fill: Fraction of the unit square that is covered.
        overlap: Fraction of the covered texels that lie in more than one triangle.
        flat: Fraction of the surface, by area, whose UV triangles have no area.
        stretch: L2 stretch of Sander et al. ("Texture Mapping Progressive Meshes", 2001), 1 at best: how unevenly
            texels are distributed, in size and in direction.
        anisotropy: Mean ratio of the singular values of the map, weighted by area; 1 where it is conformal.
    """

    charts: int
    fill: float
    overlap: float
    flat: float
    stretch: float
    anisotropy: float

    def __str__(self) -> str:
        return (
            f"{self.charts} charts, fill {self.fill:.1%}, overlap {self.overlap:.2%}, stretch {self.stretch:.3f}, "
            f"anisotropy {self.anisotropy:.3f}"
        )


def atlas_statistics(mesh: Mesh) -> AtlasStatistics:
    """Measure the UV layout of a mesh.

    The singular values of the map from UV to the surface are those of Ss = dP/du, St = dP/dv of each triangle.

    Args:
        mesh: With finite UVs, about in 0..1.
    """
    assert mesh.uv is not None
    uv = mesh.uv.astype(np.float64)
    layers = np.zeros((ATLAS_RASTER_TEXELS, ATLAS_RASTER_TEXELS), np.uint8)
    count_layers(uv * ATLAS_RASTER_TEXELS, mesh.faces, ATLAS_MARGIN_TEXELS, layers)
    covered, doubled = int((layers > 0).sum()), int((layers > 1).sum())
    q = uv[mesh.faces]
    p = mesh.vertices[mesh.faces].astype(np.float64)
    surface, signed = triangle_areas(p), signed_areas(q)
    laid = np.abs(signed) > 1e-14
    total = max(float(surface.sum()), 1e-300)
    stretch, anisotropy = _stretch(p[laid], q[laid], surface[laid], signed[laid])
    return AtlasStatistics(
        charts=int(chart_labels(mesh).max(initial=-1)) + 1,
        fill=float(np.abs(signed).sum()) * covered / max(int(layers.sum()), 1),
        overlap=doubled / covered if covered else 0.0,
        flat=float(surface[~laid].sum()) / total,
        stretch=stretch,
        anisotropy=anisotropy,
    )


def _stretch(
    p: NDArray[np.float64], q: NDArray[np.float64], surface: NDArray[np.float64], signed: NDArray[np.float64]
) -> tuple[float, float]:
    if len(p) == 0:
        return float("inf"), float("inf")
    s, t, twice = q[..., 0, None], q[..., 1, None], 2 * signed[:, None]
    along = (p[:, 0] * (t[:, 1] - t[:, 2]) + p[:, 1] * (t[:, 2] - t[:, 0]) + p[:, 2] * (t[:, 0] - t[:, 1])) / twice
    down = (p[:, 0] * (s[:, 2] - s[:, 1]) + p[:, 1] * (s[:, 0] - s[:, 2]) + p[:, 2] * (s[:, 1] - s[:, 0])) / twice
    a, b, c = (along**2).sum(axis=1), (along * down).sum(axis=1), (down**2).sum(axis=1)
    root = np.sqrt((a - c) ** 2 + 4 * b**2)
    large, small = np.sqrt((a + c + root) / 2), np.sqrt(np.maximum(a + c - root, 0) / 2)
    texels = float(np.abs(signed).sum())
    l2 = np.sqrt(((a + c) / 2 * surface).sum() / surface.sum() * texels / surface.sum())
    ratio = np.divide(large, small, out=np.full_like(large, 1e3), where=small > 1e-3 * large)
    return float(l2), float((ratio * surface).sum() / surface.sum())


def l2_stretch(vertices: NDArray[np.float64], uv: NDArray[np.float64], faces: NDArray[np.int32]) -> float:
    """L2 stretch of Sander et al., as in `AtlasStatistics`; infinite if a triangle has no area in the layout."""
    p, q = vertices[faces], uv[faces]
    surface, signed = triangle_areas(p), signed_areas(q)
    if (signed == 0).any() or surface.sum() == 0:
        return float("inf")
    return _stretch(p, q, surface, signed)[0]


def chart_labels(mesh: Mesh) -> NDArray[np.int32]:
    """(m,) index of the chart of each triangle: triangles that share a vertex are in one chart."""
    return face_components(mesh.faces, len(mesh.vertices))


def starved_fraction(mesh: Mesh, cameras: Sequence[Camera]) -> float:
    """The part of what the cameras see whose triangles have hardly any texels beside the others.

    A triangle's pixels are those of the camera that sees it largest.
    """
    assert mesh.uv is not None
    area, shown = np.zeros(len(mesh.faces)), np.zeros(len(mesh.faces))
    for index in spread_views(cameras, ATLAS_STARVED_VIEWS):
        scale = ATLAS_STARVED_SIDE_PIXELS / max(cameras[index].width, cameras[index].height)
        size = (max(1, round(scale * side)) for side in (cameras[index].width, cameras[index].height))
        camera = cameras[index].resize(*size)
        seen = rasterise_view(mesh, camera).face
        faces, pixels = np.unique(seen[seen >= 0], return_counts=True)
        flat, depth = camera.project(mesh.vertices[mesh.faces[faces]].reshape(-1, 3))
        whole = (depth.reshape(-1, 3) > 0).all(axis=1)
        faces, flat = faces[whole], flat.reshape(-1, 3, 2)[whole]
        area[faces] = np.maximum(area[faces], np.abs(signed_areas(flat)))
        shown[faces] = np.maximum(shown[faces], pixels[whole])
    texels = np.abs(signed_areas(mesh.uv[mesh.faces].astype(np.float64)))
    texels, area, shown = (values[area > 0] for values in (texels, area, shown))
    if len(area) == 0:
        return 0.0
    starved = texels / area < ATLAS_STARVED_RATIO * texels.sum() / area.sum()
    return float(shown[starved].sum() / shown.sum())


def atlas_fault(mesh: Mesh, cameras: Sequence[Camera] | None = None) -> str | None:
    """Why the mesh's own UVs are no atlas, as the end of a sentence; None if they are one.

    Args:
        cameras: Whose pictures the texels are for. None: any share of texels will do.
    """
    if mesh.uv is None:
        return "there are none"
    if not np.isfinite(mesh.uv).all():
        return "some are NaN or infinite"
    low, high = mesh.uv.min(axis=0), mesh.uv.max(axis=0)
    if low.min() < -ATLAS_BORDER_UV or high.max() > 1 + ATLAS_BORDER_UV:
        return f"they tile: they reach from {low.min():.4g} to {high.max():.4g}, outside 0..1"
    if (high - low).min() <= 1e-6:
        return "they all lie on one point or line"
    statistics = atlas_statistics(mesh)
    if statistics.flat > ATLAS_MAX_FLAT_FRACTION:
        return f"{statistics.flat:.1%} of the surface has no area in them"
    if statistics.overlap > ATLAS_MAX_OVERLAP_FRACTION:
        return f"{statistics.overlap:.1%} of the covered texels lie in more than one triangle"
    starved = starved_fraction(mesh, cameras) if cameras else 0.0
    if starved > ATLAS_MAX_STARVED_FRACTION:
        return f"{starved:.0%} of what the cameras see has hardly any texels, as where all triangles have equal ones"
    return None
