"""Where Gaussians lie on a proxy: where its array sees much, and closer where there is more to see.

The texels that cameras see are divided into cells, one a Gaussian, by Lloyd's iteration ("Least squares quantization in
PCM", 1982) over place and colour, so that cells keep to one side of an edge. A Gaussian has the middle, the shape and
the mean colour of its cell. Between such Gaussians a little of what is behind shows: behind
opaque surfaces there are therefore some larger ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.core.scene import Scene
from eigenfield.encoding.fitted.footprints import Footprints, open_footprints
from eigenfield.encoding.fitted.kernels import SHARE_ONE
from eigenfield.imaging.graph import vertex_components
from eigenfield.imaging.raster import rasterise_atlas
from eigenfield.rendering import mean_texture
from eigenfield.rendering.software.drawing import make_surface
from eigenfield.runtime.parallel import threads
from eigenfield.viewer.exports.maps import alpha_added
from eigenfield.viewer.exports.splats.gaussians import SH_ZERO, Gaussians, joined

DEFAULT_PIXELS = 2  # of one picture, for a Gaussian
DETAIL_FLOOR = 0.02  # added to the differences between texels: how many Gaussians an even surface gets
DETAIL_POWER = 1.0  # of these, in the number of Gaussians
COLOUR_TEXELS = 16.0  # a colour's whole range, as a distance between texels
LLOYD_ROUNDS = 4
CELL_SIGMAS = 1.7  # of a cell's standard deviations, in that of its Gaussian: neighbours overlap
BACKING_PART = 0.12  # of all Gaussians: large ones behind opaque surfaces, that show between the others
BACKING_SIGMAS = 1.9
BACKING_DISTANCE_SIGMAS = 1.5  # behind the surface
BACKING_MIN_OPACITY = 0.9
SPLAT_THICKNESS_RATIO = 0.05  # of the shorter side
SEEN_MIN_PX = 0.02  # of a camera's pixels, that a texel answers for: what is seen less gets no Gaussian
SOBEL_SUM = 8  # of the filter, for a difference of one from texel to texel
SEEN_MIN_OPACITY = 1 / 255
CHART_DISTANCE = 1e4  # between charts, in texels: no cell is in two
FULL_OPACITY = 0.99999  # that an opacity of one is taken for
SPLATS_MOST = 1_000_000


@dataclass(frozen=True, eq=False)
class Texels:
    """The n texels of an atlas that cameras see.

    Attributes:
        places: (n, 2) columns and rows.
        faces: (n,) the triangle that a texel lies on.
        seen: (n,) pixels of one camera that a texel answers for, the mean over cameras.
        colours: (n, 4) R, G, B and opacity.
        density: (n,) how many Gaussians it gets, relative to the others.
    """

    places: NDArray[np.float64]
    faces: NDArray[np.int64]
    seen: NDArray[np.float64]
    colours: NDArray[np.float32]
    density: NDArray[np.float64]

    def part(self, kept: NDArray[np.bool_], density: NDArray[np.float64]) -> Texels:
        """Those of a mask (n,), with another density."""
        return Texels(self.places[kept], self.faces[kept], self.seen[kept], self.colours[kept], density)


def place_gaussians(scene: Scene, cameras: Sequence[Camera], count: int | None = None) -> Gaussians:
    """Gaussians with the colours of the mean.

    Args:
        count: How many at most, fewer where the cameras see fewer texels; None: one for `DEFAULT_PIXELS` of what a
            camera sees, and no more than `SPLATS_MOST`.
    """
    texels = _seen_texels(scene, cameras)
    if count is None:
        count = min(max(1, int(texels.seen.sum()) // DEFAULT_PIXELS), SPLATS_MOST)
    solid = texels.colours[:, 3] > BACKING_MIN_OPACITY
    behind = int(BACKING_PART * count) if solid.any() else 0
    made = [_laid(scene, texels, count - behind, CELL_SIGMAS)]
    if behind:
        back = _laid(scene, texels.part(solid, texels.seen[solid]), behind, BACKING_SIGMAS)
        away = back.positions - np.mean([camera.centre for camera in cameras], axis=0)
        away *= BACKING_DISTANCE_SIGMAS * back.scales[:, :1] / np.linalg.norm(away, axis=1, keepdims=True)
        made.append(replace(back, positions=back.positions + away))
    return joined(made)


def _laid(scene: Scene, texels: Texels, count: int, sigmas: float) -> Gaussians:
    """At most `count` Gaussians on the surface, of `sigmas` times the standard deviations of their cells."""
    mesh = scene.proxy.mesh
    chart = vertex_components(mesh.faces, len(mesh.vertices))[mesh.faces[texels.faces, 0]]
    features = np.column_stack([texels.places, CHART_DISTANCE * chart, COLOUR_TEXELS * texels.colours])
    cell = _cells(features, texels.density, _first_sites(texels, count))
    return _gaussians_of(mesh, scene.appearance.atlas, texels, cell, sigmas)


def _seen_texels(scene: Scene, cameras: Sequence[Camera]) -> Texels:
    mesh, (height, width) = scene.proxy.mesh, scene.appearance.atlas
    surface = make_surface(mesh, height, width)
    with open_footprints(surface, cameras, 1.0, scene.proxy.sheets) as footprints:
        seen = cv2.blur(_answered_pixels(footprints), (3, 3))
    face = rasterise_atlas(mesh, width, height).face
    picture = alpha_added(scene)(mean_texture(scene)).clip(0, 1).astype(np.float32)
    if picture.shape[2] in (1, 2):
        picture = np.concatenate([np.repeat(picture[..., :1], 3, axis=2), picture[..., 1:]], axis=2)
    if picture.shape[2] == 3:
        picture = np.concatenate([picture, np.ones_like(picture[..., :1])], axis=2)
    kept = (face >= 0) & (seen > SEEN_MIN_PX) & (picture[..., 3] > SEEN_MIN_OPACITY)
    across, down = (np.abs(cv2.Sobel(picture, cv2.CV_32F, *order)) for order in ((1, 0), (0, 1)))
    detail = (across + down).max(axis=2) / SOBEL_SUM
    density = seen * (detail + DETAIL_FLOOR) ** DETAIL_POWER
    rows, columns = np.nonzero(kept)
    return Texels(
        np.column_stack([columns, rows]).astype(np.float64), face[kept].astype(np.int64), seen[kept].astype(np.float64),
        picture[kept], density[kept].astype(np.float64),
    )  # fmt: skip


def _answered_pixels(footprints: Footprints) -> NDArray[np.float32]:
    """(H, W) pixels that each texel answers for, the mean over cameras: a pixel is shared by what it shows."""
    height, width = footprints.surface.size
    total = np.zeros(height * width)
    for camera in range(len(footprints)):
        counts, coordinates, shares = footprints.of(camera)
        column, row = np.rint(coordinates).astype(np.int64).T
        several = counts[counts > 0]
        part = shares / SHARE_ONE if len(shares) else np.repeat(1 / several, several)
        texel = row.clip(0, height - 1) * width + column.clip(0, width - 1)
        total += np.bincount(texel, part, height * width)
    return (total / len(footprints)).reshape(height, width).astype(np.float32)


def _first_sites(texels: Texels, count: int) -> NDArray[np.int64]:
    """Texels along a curve that fills the atlas (Morton's), at even steps of their density; at most one a texel."""
    density = texels.density
    for _ in range(8):
        density = np.minimum(density, density.sum() / count)
    order = np.argsort(_morton(texels.places.astype(np.int64)), kind="stable")
    passed = np.cumsum(density[order])
    steps = (np.arange(count) + 0.5) * (passed[-1] / count)
    return np.unique(order[np.searchsorted(passed, steps).clip(0, len(order) - 1)])


def _morton(places: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n,) the bits of columns and rows (n, 2) in turns."""
    code = np.zeros(len(places), np.int64)
    for bit in range(16):
        code |= ((places[:, 0] >> bit & 1) << (2 * bit)) | ((places[:, 1] >> bit & 1) << (2 * bit + 1))
    return code


def _cells(features: NDArray[np.float64], density: NDArray[np.float64], first: NDArray[np.int64]) -> NDArray[np.int64]:
    """(n,) the cell of each texel, numbered from 0 without gaps; sites of cells move to the middle of their texels.

    Middles are weighted by the square of the density, since Lloyd's iteration spaces sites by a weight's root.
    """
    sites, weight = features[first], density**2
    cell = np.zeros(len(features), np.int64)
    for turn in range(LLOYD_ROUNDS):
        tree = KDTree(sites, balanced_tree=False, compact_nodes=False)
        cell = np.asarray(tree.query(features, workers=threads())[1], np.int64)
        if turn < LLOYD_ROUNDS - 1:
            total = np.bincount(cell, weight, len(sites))
            moved = [np.bincount(cell, weight * one, len(sites)) for one in features.T]
            sites = np.where(total[:, None] > 0, np.stack(moved, axis=1) / np.maximum(total, 1e-300)[:, None], sites)
    return np.unique(cell, return_inverse=True)[1].reshape(-1)


def _gaussians_of(
    mesh: Mesh, atlas: tuple[int, int], texels: Texels, cell: NDArray[np.int64], sigmas: float
) -> Gaussians:
    area = np.bincount(cell).astype(np.float64)

    def mean(values: NDArray[np.floating]) -> NDArray[np.float64]:
        return np.stack([np.bincount(cell, one) / area for one in values.T], axis=1)

    middle = mean(texels.places)
    off = texels.places - middle[cell]
    products = mean(np.stack([off[:, 0] ** 2, off[:, 0] * off[:, 1], off[:, 1] ** 2], axis=1))
    covariance = products[:, [0, 1, 1, 2]].reshape(-1, 2, 2) + np.eye(2) / 12  # of a texel
    nearest = np.lexsort([(off**2).sum(axis=1), cell])[np.concatenate([[0], np.cumsum(area[:-1]).astype(np.int64)])]
    corners, slopes = _faces_in_space(mesh, atlas, texels.faces[nearest])
    positions = corners[:, :, 0] + (slopes @ (middle - corners[:, :2, 1])[..., None])[..., 0]
    variances, axes = np.linalg.eigh(covariance)
    spread = slopes @ (axes * (sigmas * np.sqrt(variances))[:, None])
    left, scales, _ = np.linalg.svd(spread, full_matrices=False)
    normal = np.cross(left[:, :, 0], left[:, :, 1])
    overlap = 2 * np.pi * sigmas**2 * np.sqrt(np.linalg.det(covariance)) / area
    colours = mean(texels.colours)
    opacity = 1 - (1 - np.minimum(colours[:, 3], FULL_OPACITY)) ** (1 / overlap)
    return Gaussians(
        positions, np.concatenate([left, normal[:, :, None]], axis=2),
        np.column_stack([scales, SPLAT_THICKNESS_RATIO * scales[:, 1]]), opacity.astype(np.float32),
        ((colours[:, None, :3] - 0.5) / SH_ZERO).astype(np.float32),
    )  # fmt: skip


def _faces_in_space(
    mesh: Mesh, atlas: tuple[int, int], faces: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(n, 3, 2) a corner of each triangle in space, and (its first two numbers) in texels, whole at texel centres; and
    (n, 3, 2) how a place in space changes with column and row."""
    assert mesh.uv is not None
    size = np.array([atlas[1], atlas[0]])
    flat = mesh.uv[mesh.faces[faces]].astype(np.float64) * size - 0.5
    solid = mesh.vertices[mesh.faces[faces]].astype(np.float64)
    flat_edges, solid_edges = ((c[:, 1:] - c[:, :1]).transpose(0, 2, 1) for c in (flat, solid))
    corner = np.zeros((len(faces), 3, 2))
    corner[:, :, 0], corner[:, :2, 1] = solid[:, 0], flat[:, 0]
    return corner, solid_edges @ np.linalg.inv(flat_edges)
