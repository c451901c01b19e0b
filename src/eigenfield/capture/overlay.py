"""The proxy's lines over photographs: a flipped axis, a wrong frame or a wrong scale is seen at once."""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from eigenfield.capture.lightfield import LightField
from eigenfield.capture.pairing import scale_camera
from eigenfield.core.camera import Camera
from eigenfield.core.mesh import Mesh
from eigenfield.imaging.raster import rasterise_view

OVERLAY_TILE_PIXELS = 640  # longest side of a photograph on the sheet, pixels
OVERLAY_CAPTION_PIXELS = 26  # pixels
OVERLAY_COLUMNS = 3
OVERLAY_MIN_JUMP_RATIO = 0.02  # second difference of inverse depth over one pixel to itself that is a depth edge
OVERLAY_MAX_CREASE_COSINE = 0.6  # cosine of the angle between neighbouring faces' normals below which there is a crease
OVERLAY_OUTLINE_RGB = (1.0, 0.0, 0.75)
OVERLAY_CREASE_RGB = (0.0, 0.9, 1.0)


@dataclass(frozen=True, eq=False)
class ProxyLines:
    """Where the proxy's lines are.

    Attributes:
        outline: (H, W) its outline and depth edges.
        crease: (H, W) its creases.
        covered: (H, W) the pixels that it covers.
    """

    outline: NDArray[np.bool_]
    crease: NDArray[np.bool_]
    covered: NDArray[np.bool_]


def proxy_lines(mesh: Mesh, camera: Camera) -> ProxyLines:
    """Outline, depth edges and creases of the mesh as a camera sees it.

    On a plane inverse depth is linear over the picture, so its second difference is zero but at edges.
    """
    raster = rasterise_view(mesh, camera)
    covered = raster.face >= 0
    outline = np.zeros_like(covered)
    crease = np.zeros_like(covered)
    normals = np.vstack([mesh.face_normals(), np.zeros(3)])[raster.face]
    turns: list[Callable[[NDArray[Any]], NDArray[Any]]] = [lambda a: a, lambda a: a.swapaxes(0, 1)]
    for turn in turns:  # along columns, then along rows
        here, there = turn(covered)[:-1], turn(covered)[1:]
        turn(outline)[:-1] |= here != there
        q = turn(raster.inverse_depth)
        before, middle, after = q[:-2], q[1:-1], q[2:]
        inner = np.minimum(np.minimum(before, middle), after) > 0
        turn(outline)[1:-1] |= inner & (np.abs(before - 2 * middle + after) > OVERLAY_MIN_JUMP_RATIO * middle)
        cosine = np.einsum("ijk,ijk->ij", turn(normals)[:-1], turn(normals)[1:])
        turn(crease)[:-1] |= here & there & (cosine < OVERLAY_MAX_CREASE_COSINE)
    return ProxyLines(outline, crease & ~outline, covered)


def draw_overlay(light_field: LightField, mesh: Mesh, indices: Sequence[int]) -> tuple[bytes, list[float]]:
    """A contact sheet of some views with the proxy's lines over them, as PNG, and what part of each is covered."""
    tiles, coverage = [], []
    for index in indices:
        view = light_field.views[index]
        picture = light_field.photograph(index).pixels
        scale = OVERLAY_TILE_PIXELS / max(picture.shape[:2])
        width, height = (max(1, round(scale * side)) for side in (picture.shape[1], picture.shape[0]))
        shrunk = cv2.resize(picture, (width, height), interpolation=cv2.INTER_AREA if scale < 1 else cv2.INTER_LINEAR)
        lines = proxy_lines(mesh, scale_camera(view.camera, width, height))
        part = float(lines.covered.mean())
        coverage.append(part)
        tiles.append((_draw_lines(np.asarray(shrunk, np.float32), lines), f"{view.name}   {part:.0%} covered"))
    return _contact_sheet(tiles), coverage


def _draw_lines(picture: NDArray[np.float32], lines: ProxyLines) -> Image.Image:
    """Lines over the photograph, the uncovered part dimmed."""
    out = np.where(lines.covered[..., None], picture, 0.45 * picture)
    halo = cv2.dilate(lines.outline.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool)
    out[lines.crease] = 0.5 * out[lines.crease] + 0.5 * np.array(OVERLAY_CREASE_RGB)
    out[halo & ~lines.outline] *= 0.35
    out[lines.outline] = OVERLAY_OUTLINE_RGB
    return Image.fromarray(np.rint(np.clip(out, 0, 1) * 255).astype(np.uint8))


def _contact_sheet(tiles: Sequence[tuple[Image.Image, str]]) -> bytes:
    columns = min(OVERLAY_COLUMNS, len(tiles))
    cell = max(tile.width for tile, _ in tiles) + 8, max(tile.height for tile, _ in tiles) + OVERLAY_CAPTION_PIXELS
    sheet = Image.new("RGB", (columns * cell[0], -(-len(tiles) // columns) * cell[1]), (24, 24, 24))
    draw = ImageDraw.Draw(sheet)
    font = ImageFont.load_default(15)
    for number, (tile, caption) in enumerate(tiles):
        left, top = number % columns * cell[0] + 4, number // columns * cell[1]
        sheet.paste(tile, (left, top + OVERLAY_CAPTION_PIXELS - 2))
        draw.text((left + 2, top + 4), caption, fill=(235, 235, 235), font=font)
    buffer = io.BytesIO()
    sheet.save(buffer, "PNG")
    return buffer.getvalue()
