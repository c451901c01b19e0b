"""Sheets as a camera sees them: composited front to back, with the depth test within a sheet only.

Each sheet is sampled once a pixel, in its middle: opacity makes the edges of sheets soft, so none is smoothed. A band
of rows is drawn sheet after sheet while it stays in the cache, and samples behind what is opaque are not filtered.
"""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.proxy import Sheets
from eigenfield.imaging.raster import RASTER_EDGE_SLACK_FRACTION, Band, set_up_bands
from eigenfield.rendering.software.composite import add_mean
from eigenfield.rendering.software.drawing import Framebuffer, Surface
from eigenfield.rendering.software.kernels import LAYER_CHANNELS, TILE_AREA, TILE_TEXELS, mark_tiles
from eigenfield.rendering.software.sheet_kernels import draw_sheets
from eigenfield.rendering.software.tiles import tile_shape
from eigenfield.runtime.parallel import parallel_map

SHEETS_BAND_ROWS = 32  # of samples, that a thread draws at a time
SHEETS_REACH_TEXELS = 3  # between texels that one sample reads


@dataclass(frozen=True, eq=False)
class Stack:
    """A surface's sheets, prepared for an atlas.

    Attributes:
        starts: (sheets + 1,) int32 first triangle of each sheet, back to front, and their number.
        opacity: (tiles, TILE_AREA) float32 at the atlas's size, not yet clipped.
        visible: (tile rows, tile columns) bool, whether any sample can see a texel of the tile.
    """

    starts: NDArray[np.int32]
    opacity: NDArray[np.float32]
    visible: NDArray[np.bool_]


def make_stack(sheets: Sheets, size: tuple[int, int]) -> Stack:
    """Bring sheets' opacity to the size (H, W) of the atlas, in texels."""
    starts = np.concatenate([[0], np.cumsum(sheets.faces)]).astype(np.int32)
    shape = tile_shape(size)
    tiles = np.zeros((shape[0] * shape[1], 1, TILE_AREA), np.float32)
    add_mean(sheets.opacity[..., None], size, np.arange(len(tiles)), np.ones((1, 1), np.float32), tiles)
    texels = tiles.reshape(*shape, TILE_TEXELS, TILE_TEXELS).transpose(0, 2, 1, 3) > 0
    reach = np.ones((2 * SHEETS_REACH_TEXELS + 1,) * 2, np.uint8)
    near = cv2.dilate(texels.reshape(shape[0] * TILE_TEXELS, -1).astype(np.uint8), reach)
    visible = near.reshape(shape[0], TILE_TEXELS, shape[1], TILE_TEXELS).any(axis=(1, 3))
    return Stack(starts, tiles[:, 0], np.asarray(visible))


def set_up_sheets(surface: Surface, camera: Camera, frame: Framebuffer) -> list[Band]:
    """Project the triangles of all sheets, and find the tiles that those in view read.

    Args:
        frame: Of the camera's size and sampling, written.

    Returns:
        For each band of rows of pixels its triangles in rising order.
    """
    k = frame.sampling.side
    size = (camera.width * k, camera.height * k)
    corners = (camera.resize(*size) if k > 1 else camera).homogeneous(surface.vertices)
    rows = max(1, SHEETS_BAND_ROWS // k)
    bands = set_up_bands(corners, surface.faces, *size, frame.edges, frame.pixels, frame.bounds, band=rows * k)
    frame.seen[:] = frame.bounds[:, 1] > frame.bounds[:, 0]
    mark_tiles(frame.seen, surface.reach, frame.needed)
    return [((first // k, last // k), listing) for (first, last), listing in bands]


def shade_sheets(
    surface: Surface,
    stack: Stack,
    bands: list[Band],
    frame: Framebuffer,
    layers: NDArray[np.float32],
    filter: str,
    background: NDArray[np.float32],
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Composite sheets.

    Args:
        frame: As `set_up_sheets` leaves it; overwritten.
        layers: (L, tiles, TILE_AREA, 4) the texture; `OPACITY_LANE` is `stack.opacity`.

    Returns:
        (H, W, C) the picture, and (H, W) how much of each pixel the sheets cover: 1 less the product of 1 - A.
    """
    picture, coverage = np.empty((*frame.size, len(background)), np.float32), np.empty(frame.size, np.float32)
    behind = np.zeros((len(layers), LAYER_CHANNELS), np.float32)
    behind.reshape(-1)[: len(background)] = background
    middles = frame.inverse_depth, frame.column_of, frame.row_of

    def draw(band: Band) -> None:
        rows, listing = band
        draw_sheets(
            surface.faces, surface.texels, frame.edges, frame.bounds, listing, stack.starts, *rows,
            RASTER_EDGE_SLACK_FRACTION, middles, frame.seen, layers, surface.size, filter == "bicubic",
            frame.sampling.side, behind, picture, coverage,
        )  # fmt: skip

    parallel_map(draw, bands)
    return picture, coverage
