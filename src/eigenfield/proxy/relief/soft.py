"""A relief of soft sheets: each a height field of the reference view, with its own part of the atlas and an opacity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import cv2
import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, label, maximum, sum_labels

from eigenfield.core.camera import Camera
from eigenfield.core.errors import ProxyError
from eigenfield.core.mesh import barycentric_coordinates
from eigenfield.core.progress import Progress
from eigenfield.core.proxy import Proxy, Sheets
from eigenfield.proxy.relief.backdrop import cameras_between
from eigenfield.proxy.relief.find_lattice import lattice_of_camera
from eigenfield.proxy.relief.height_field import (
    HeightFieldMesh,
    height_field_to_world,
    join_height_fields,
    triangulate_height_field,
)
from eigenfield.proxy.relief.packing import chart_pixels, pack_sheets
from eigenfield.proxy.simplify import PROXY_DEFAULT_TRIANGLES
from eigenfield.stereo import ReferenceView
from eigenfield.stereo.multiplane import SoftSheets
from eigenfield.stereo.multiplane.visibility import sheet_visibility

# Visibility is the part of a texel's light that reaches the view that sees it best.
SOFT_RELIEF_MIN_VISIBILITY = 0.05  # of texels that are drawn, times their opacity
SOFT_RELIEF_MIN_PEAK = 0.2  # what some texel of a connected region must reach
SOFT_RELIEF_MIN_WEIGHT_TEXELS = 4.0  # visibility times opacity, summed over a connected region
SOFT_RELIEF_MIN_BACK_VISIBILITY = 0.02  # of texels of the backmost sheet
# By which a sheet reaches beyond what it draws: the widest filter, and a texel of its outline
SOFT_RELIEF_REACH_TEXELS = 3
SOFT_RELIEF_BACK_REACH_FRACTION = 0.03  # the same of the backmost sheet, of the reference view's width
SOFT_RELIEF_SHEET_MIN_FRACTION = 0.001  # of the reference view that a sheet must draw


@dataclass(frozen=True, eq=False)
class SoftRelief:
    """A proxy with sheets, and the colours that its sheets were fitted with.

    Attributes:
        proxy: Faces are counter-clockwise seen from the reference camera. The opacity has a texel for a pixel of the
            reference view.
        colours: (S, S, 3) float32 R, G, B of the atlas, as dense as the opacity; 0 where no sheet is.
    """

    proxy: Proxy
    colours: NDArray[np.float32]


def soft_relief(
    reference: ReferenceView,
    sheets: SoftSheets,
    cameras: Sequence[Camera],
    *,
    tolerance: float,
    depth_error: float,
    triangles: int | None = None,
    progress: Progress | None = None,
) -> SoftRelief:
    """The proxy of soft sheets, where some camera, or one between two, sees them draw something, and a little beyond.

    The backmost sheet is opaque and is drawn wherever others let something through: nothing is left open.

    Args:
        sheets: Back to front; sheets that draw next to nothing are left out.
        tolerance: Largest difference of the mesh from a sheet's labels.
        depth_error: Pixels by which the lattice's depths may move a point in the camera that they move most.
        triangles: Most triangles, at the cost of the tolerance. Default: PROXY_DEFAULT_TRIANGLES.

    Raises:
        ProxyError: `relief-empty`: no sheet draws anything.
    """
    limit = PROXY_DEFAULT_TRIANGLES if triangles is None else triangles
    views = [*cameras, *cameras_between(cameras)]
    visibility = sheet_visibility(sheets, reference, views, progress)
    masks = [_back_mask(visibility[0]), *map(_drawn_mask, visibility[1:], sheets.layers[1:, ..., 3])]
    kept = [k for k, mask in enumerate(masks) if mask.mean() > SOFT_RELIEF_SHEET_MIN_FRACTION]
    if not kept:
        raise ProxyError(
            "relief-empty", "no sheet draws anything", remedy="widen the depth range, or look at the masks"
        )
    total = sum(int(masks[k].sum()) for k in kept)
    meshes = []
    for k in kept:
        most = max(2, int(limit * masks[k].sum() / total))
        meshes.append(
            triangulate_height_field(sheets.labels[k], masks[k], cut=float("inf"), tolerance=tolerance, limit=most)
        )
    parts, owners, places, side = pack_sheets(meshes)
    packed = sorted(zip(parts, owners, places, strict=True), key=lambda one: one[1])
    mesh = height_field_to_world(reference, join_height_fields([part for part, _, _ in packed]))
    depth = reference.camera.homogeneous(mesh.vertices)[:, 2]
    ends = np.cumsum([len(part.x) for part, _, _ in packed])[:-1]
    layer = np.full((round(side), round(side), 4), np.nan, np.float32)
    counts = [0] * len(kept)
    for (part, owner, place), of_part in zip(packed, np.split(depth, ends), strict=True):
        draw_chart(sheets.layers[kept[owner]], part, of_part, place, layer)
        counts[owner] += len(part.faces)
    uv = np.concatenate([(np.stack([part.x, part.y], axis=1) + place) / side for part, _, place in packed])
    mesh = replace(mesh, uv=np.clip(uv, 0, 1).astype(np.float32))
    layer = _filled(layer)
    lattice = lattice_of_camera(reference.camera.matrix, mesh, cameras, depth_error)
    proxy = Proxy(mesh, lattice, Sheets(tuple(counts), np.clip(layer[..., 3], 0, 1)))
    return SoftRelief(proxy, layer[..., :3])


def _drawn_mask(visibility: NDArray[np.float32], opacity: NDArray[np.float32]) -> NDArray[np.bool_]:
    """(h, w) what is worth a triangle: regions that are seen and opaque enough, and what a filter reads around them."""
    weight = visibility * opacity
    regions, count = label(weight >= SOFT_RELIEF_MIN_VISIBILITY, np.ones((3, 3), np.int8))
    numbers = np.arange(1, count + 1)
    worth = np.zeros(count + 1, np.bool_)
    if count:
        worth[1:] = np.asarray(maximum(weight, regions, numbers)) >= SOFT_RELIEF_MIN_PEAK
        worth[1:] &= np.asarray(sum_labels(weight, regions, numbers)) >= SOFT_RELIEF_MIN_WEIGHT_TEXELS
    return _dilated(worth[regions], SOFT_RELIEF_REACH_TEXELS)


def _back_mask(visibility: NDArray[np.float32]) -> NDArray[np.bool_]:
    """(h, w) where the backmost sheet is drawn."""
    reach = round(SOFT_RELIEF_BACK_REACH_FRACTION * visibility.shape[1])
    seen = visibility >= SOFT_RELIEF_MIN_BACK_VISIBILITY
    return _dilated(seen, max(reach, SOFT_RELIEF_REACH_TEXELS))


def _dilated(mask: NDArray[np.bool_], reach: int) -> NDArray[np.bool_]:
    disc = cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (2 * reach + 1, 2 * reach + 1))
    return np.asarray(cv2.dilate(mask.astype(np.uint8), disc), np.bool_)


def draw_chart(
    layer: NDArray[np.float32],
    part: HeightFieldMesh,
    depth: NDArray[np.float64],
    place: NDArray[np.float64],
    atlas: NDArray[np.float32],
) -> None:
    """Draw what a sheet has at the texels of a part, and of its gutter, into the atlas.

    A texel's point lies on its triangle as its place among the texture coordinates says. With barycentric coordinates l
    and depths z of the corners, the reference view sees it at sum(l z x) / sum(l z), not at sum(l x).

    Args:
        layer: (h, w, 4) of the sheet, or (h, w) one of its channels.
        depth: (n,) of its vertices in the reference view.
        place: (2,) of the part in the atlas.
        atlas: (S, S, 4) or (S, S), drawn into.
    """
    chart = chart_pixels(part)
    row, column = np.nonzero(chart.owner >= 0)
    pixels = np.stack([column, row], axis=1) + chart.first
    faces = part.faces[chart.owner[row, column]]
    corners = np.stack([part.x, part.y], axis=1)[faces]
    weights = barycentric_coordinates(corners, pixels) * depth[faces]
    seen = (weights[..., None] * corners).sum(axis=1) / weights.sum(axis=1)[:, None]
    moved = np.zeros((*chart.owner.shape, 2), np.float32)
    moved[row, column] = seen - pixels
    nearest = distance_transform_edt(chart.owner < 0, return_distances=False, return_indices=True)
    grid = np.moveaxis(np.indices(chart.owner.shape)[::-1], 0, -1) + chart.first
    at = (grid + moved[tuple(nearest)]).astype(np.float32)
    drawn = cv2.remap(layer, at[..., 0], at[..., 1], cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
    into = grid + np.rint(place - 0.5).astype(int)
    inside = chart.mask & (into >= 0).all(axis=-1) & (into < len(atlas)).all(axis=-1)
    atlas[into[inside][:, 1], into[inside][:, 0]] = drawn[inside]


def _filled(atlas: NDArray[np.float32]) -> NDArray[np.float32]:
    """The atlas with the nearest texel of a sheet where there is none."""
    row, column = distance_transform_edt(np.isnan(atlas[..., 3]), return_distances=False, return_indices=True)
    return np.asarray(atlas[row, column], np.float32)
