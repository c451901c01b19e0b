"""A mesh under a texture, as a camera sees it: rasterise, say which tiles are needed, shade."""

# mypy: disable-error-code="no-untyped-call"

from __future__ import annotations

import math
import mmap
from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from eigenfield.core.camera import Camera
from eigenfield.core.errors import OptionError
from eigenfield.core.mesh import Mesh, signed_areas
from eigenfield.imaging.graph import face_edges
from eigenfield.imaging.raster import (
    RASTER_BAND_ROWS,
    RASTER_BOUND_SLACK_PIXELS,
    RASTER_EDGE_SLACK_FRACTION,
    RASTER_SET_UP_TRIANGLES,
    bound_faces,
    edge_functions,
    project_corners,
    sort_into_bands,
)
from eigenfield.rendering.software.edge_kernels import BLOCK, draw_samples, find_bends, keep_parted, mark_ends
from eigenfield.rendering.software.kernels import DEPTH, TILE, draw_texels, mark_tiles, shade_rows
from eigenfield.rendering.software.simd import RUN
from eigenfield.runtime.parallel import parallel_map, pieces

MARGIN = 2  # texels that the widest filter reaches
SAMPLES_LIMIT = 4  # along a side of a pixel, when chosen automatically
ONE_SAMPLE = 1.5  # photograph pixels a pixel up to which one sample is enough
FOOTPRINTS = 256  # triangles from which the median footprint is taken
CENTRE = np.zeros((1, 2))
STANDARD = np.array([[-2, -6], [6, -2], [-6, 2], [2, 6]]) / 16  # where GPUs put four samples of a pixel
APART = 1.0  # photograph's pixels in texels: what bends by more within a pixel is not one piece of the atlas
LOOKED_AT = 0.5  # of that, between neighbouring pixels: enough to look at a pixel's samples


@dataclass(frozen=True, eq=False)
class Sampling:
    """Where a picture is sampled. side: k, a pixel being the mean of k x k samples. Or, with k = 1, of those at
    `offsets` (s, 2) from its middle, pixels right and down; where they lie on one piece of the atlas, as far as `limit`
    texels tell, its middle is looked at once."""

    side: int
    offsets: NDArray[np.float64]
    limit: float


@dataclass(frozen=True, eq=False)
class Surface:
    """A mesh prepared for an atlas of H x W texels.

    vertices: (n, 3) float64. faces: (m, 3) int32. texels: (n, 2) float64, UV in texels, whole at texel centres.
    reach: (m, 4) int32, the tiles [top, bottom] x [left, right] that a triangle's filter touches.
    used: (tile rows, tile columns) bool, whether any does.
    rims: (m,) bool, whether a triangle has an edge that it shares with no other, in space or in the atlas.
    size: H, W.
    """

    vertices: NDArray[np.float64]
    faces: NDArray[np.int32]
    texels: NDArray[np.float64]
    reach: NDArray[np.int32]
    used: NDArray[np.bool_]
    rims: NDArray[np.bool_]
    size: tuple[int, int]


def make_surface(mesh: Mesh, height: int, width: int) -> Surface:
    """Prepare a mesh, which must have UVs, for textures of `height` x `width`."""
    assert mesh.uv is not None, "a mesh without UVs cannot be textured"
    texels = mesh.uv.astype(np.float64) * (width, height) - 0.5
    last = np.array([width - 1, height - 1])
    corners = texels[mesh.faces]
    low = np.clip(np.floor(corners.min(axis=1)) - MARGIN, 0, last).astype(np.int32) // TILE
    high = np.clip(np.ceil(corners.max(axis=1)) + MARGIN, 0, last).astype(np.int32) // TILE
    reach = np.stack([low[:, 1], high[:, 1], low[:, 0], high[:, 0]], axis=1)
    used = np.zeros((-(-height // TILE), -(-width // TILE)), np.bool_)
    for top, bottom, left, right in np.unique(reach, axis=0):
        used[top : bottom + 1, left : right + 1] = True
    faces = np.ascontiguousarray(mesh.faces, dtype=np.int32)
    vertices = mesh.vertices.astype(np.float64)
    return Surface(vertices, faces, texels, np.ascontiguousarray(reach), used, _rims(faces), (height, width))


def _rims(faces: NDArray[np.int32]) -> NDArray[np.bool_]:
    """(m,) whether a triangle has an edge whose two vertices no other has."""
    _, edge = face_edges(faces)
    return np.asarray((np.bincount(edge)[edge] == 1).reshape(-1, 3).any(axis=1))


def sparse_zeros(shape: tuple[int, ...], dtype: type[np.float32] | type[np.int32]) -> NDArray[Any]:
    """Pages that nobody writes to take no memory; NumPy asks Linux for huge ones, of which a few places fill many."""
    return np.frombuffer(mmap.mmap(-1, max(1, 4 * math.prod(shape))), dtype, math.prod(shape)).reshape(shape)


class Scratch:
    """Room for what a thread finds out about a band's edges."""

    def __init__(self, width: int) -> None:
        blocks = -(-width // BLOCK)
        self.flat = np.empty((2, RASTER_BAND_ROWS + 2, width), np.float32)
        self.marks = np.empty((RASTER_BAND_ROWS, blocks * BLOCK), np.bool_)
        self.places = np.empty(RASTER_BAND_ROWS * width, np.int32)
        self.starts = np.empty((RASTER_BAND_ROWS, blocks + 1), np.int64)
        self.sums = np.empty((RASTER_BAND_ROWS + 1, blocks + 1), np.int64)
        self.samples = np.empty((RASTER_BAND_ROWS * width, 3, 4), np.float32)


class Frame:
    """The buffers of one picture in the making, used again for the next.

    inverse_depth, column_of, row_of: (H k, W k + RUN), see `draw_texels`. spans, parted, finer: see `keep_parted`.
    """

    def __init__(self, surface: Surface, height: int, width: int, sampling: Sampling) -> None:
        count, k = len(surface.faces), sampling.side
        self.size, self.sampling = (height, width), sampling
        self.edges = np.empty((count, 3, 3))
        self.bounds, self.pixels = np.empty((count, 4), np.int32), np.empty((len(surface.vertices), 2))
        # Never NaN, even where nothing was drawn yet
        self.inverse_depth, self.column_of, self.row_of = np.zeros((3, height * k, width * k + RUN), np.float32)
        most = height * width if len(sampling.offsets) > 1 else 0
        self.spans = np.zeros((height, 2), np.int64)
        self.parted = sparse_zeros((most,), np.int32)
        self.finer = sparse_zeros((3, 4 * most), np.float32)
        self.scratch: deque[Scratch] = deque()
        self.seen = np.empty(count, np.uint8)
        self.needed = np.empty(surface.used.shape, np.uint8)

    def fits(self, height: int, width: int, sampling: Sampling) -> bool:
        """Whether it has the room for such a picture."""
        mine = self.sampling
        return self.size == (height, width) and mine.side == sampling.side and mine.offsets is sampling.offsets


def cover(surface: Surface, camera: Camera, sampling: Sampling, frame: Frame) -> None:
    """Rasterise: where each sample lands in the atlas, and which tiles are needed."""
    k, offsets = sampling.side, sampling.offsets
    matrix = (camera.resize(camera.width * k, camera.height * k) if k > 1 else camera).matrix
    corners = surface.vertices @ matrix[:, :3].T
    corners += matrix[:, 3]
    height, width = camera.height * k, camera.width * k
    slack = RASTER_BOUND_SLACK_PIXELS + float(np.abs(offsets).max())
    frame.seen[:] = 0
    project_corners(corners, frame.pixels)

    def set_up(part: tuple[int, int]) -> None:
        edge_functions(corners, surface.faces, *part, frame.edges)
        bound_faces(corners, frame.pixels, surface.faces, frame.edges, width, height, slack, *part, frame.bounds)

    parallel_map(set_up, pieces(len(surface.faces), RASTER_SET_UP_TRIANGLES))
    bands = pieces(height, RASTER_BAND_ROWS)
    starts = np.empty(len(bands) + 1, np.int64)
    listing = sort_into_bands(frame.bounds, RASTER_BAND_ROWS, starts)
    middles = frame.inverse_depth, frame.column_of, frame.row_of

    def triangles_of(band: int) -> tuple[NDArray[Any], ...]:
        some = listing[starts[band] : starts[band + 1]]
        return surface.faces, surface.texels, frame.edges, frame.bounds, some

    def draw(band: int) -> None:
        draw_texels(*triangles_of(band), *bands[band], RASTER_EDGE_SLACK_FRACTION, *middles, frame.seen)

    def smooth(band: int) -> None:
        try:
            room = frame.scratch.pop()
        except IndexError:  # this thread is the first, or another was faster
            room = Scratch(width)
        triangles, rows, limit = triangles_of(band), bands[band], np.float32(sampling.limit)
        mark_ends(*triangles[2:], surface.rims, middles[0], *rows, RASTER_EDGE_SLACK_FRACTION, offsets, room.marks)
        listed = room.places, room.starts, room.sums
        find_bends(*middles, *rows, limit * np.float32(LOOKED_AT), *room.flat, room.marks, *listed)
        draw_samples(*triangles, *rows, RASTER_EDGE_SLACK_FRACTION, offsets, *listed, room.samples, frame.seen)
        keep_parted(
            *middles, room.places, room.starts, room.samples, limit, *rows, frame.spans, frame.parted, frame.finer
        )
        frame.scratch.append(room)

    parallel_map(draw, range(len(bands)))
    if len(offsets) > 1:
        parallel_map(smooth, range(len(bands)))
    mark_tiles(frame.seen, surface.reach, frame.needed)


def shade(
    surface: Surface,
    frame: Frame,
    layers: NDArray[np.float32],
    filter: str,
    background: NDArray[np.float32],
    picture: NDArray[Any],
    coverage: NDArray[np.float32],
) -> None:
    """Fill picture (H, W, C), uint8 or float32, and coverage (H, W) from a covered frame of that size, a texture in
    `layers` and a background (C,)."""
    height, width = surface.size
    behind = np.zeros((len(layers), DEPTH), np.float32)
    behind.reshape(-1)[: len(background)] = background
    parallel_map(
        lambda rows: shade_rows(
            frame.inverse_depth, frame.column_of, frame.row_of, frame.spans, frame.parted, frame.finer, layers,
            width, height, filter == "bicubic", frame.sampling.side, behind, picture.dtype == np.uint8, *rows, picture,
            coverage,
        ),
        pieces(picture.shape[0], RASTER_BAND_ROWS),
    )  # fmt: skip


def choose_sampling(surface: Surface, camera: Camera, asked: int | None = None, detail: float = 1.0) -> Sampling:
    """k x k samples a pixel if k is asked for. Else from the median footprint of the triangles in view: smooth edges
    in a picture as large as the photographs or larger, `grid_side` samples in a smaller one.

    detail: texels for one pixel of the photographs. Raises OptionError `samples` but for whole numbers from 1 to 16.
    """
    if asked is not None:
        if not isinstance(asked, int | np.integer) or not 1 <= asked <= 16:
            raise OptionError("samples", f"{asked} x {asked} samples a pixel", remedy="ask for 1 to 16")
        return Sampling(int(asked), CENTRE, 0)
    side = grid_side(surface, camera, detail)
    return smooth_edges(detail) if side == 1 else Sampling(side, CENTRE, 0)


def grid_side(surface: Surface, camera: Camera, detail: float) -> int:
    """k of the k x k samples a pixel that a picture takes by itself.

    Where `detail` is above 1 the atlas is denser than what it holds, and a captured view drawn at its own size needs
    one sample however many texels a pixel covers: more would blur what the photograph's own pixels have averaged
    already. Smaller pictures take as many samples as photograph pixels, at most `SAMPLES_LIMIT`.
    """
    footprint = median_footprint(surface, camera) / max(detail, 1.0)
    return 1 if footprint <= ONE_SAMPLE else min(int(np.ceil(footprint - 0.5)), SAMPLES_LIMIT)


def smooth_edges(detail: float) -> Sampling:
    """One sample a pixel, but four where they show different things. detail: texels for one pixel of the photographs;
    0 if nobody knows."""
    return Sampling(1, STANDARD, APART * (detail or 1.0))


def median_footprint(surface: Surface, camera: Camera) -> float:
    """Texels a pixel along a side, the median over picture area of (some of) the triangles in view; 0 if there are
    none."""
    some = surface.faces[:: max(1, len(surface.faces) // FOOTPRINTS)]
    return _footprint(surface, camera, some) or _footprint(surface, camera, surface.faces)


def _footprint(surface: Surface, camera: Camera, faces: NDArray[np.int32]) -> float:
    pixels, depth = camera.project(surface.vertices[faces].reshape(-1, 3))
    corners = np.where((depth > 0)[:, None], pixels, np.nan).reshape(-1, 3, 2)
    middle = corners.mean(axis=1)
    shown = ((middle >= 0) & (middle < (camera.width, camera.height))).all(axis=1)
    screen = np.abs(signed_areas(corners[shown]))
    atlas = np.abs(signed_areas(surface.texels[faces[shown]]))
    kept = screen > 0
    if not kept.any():
        return 0.0
    screen, atlas = screen[kept], atlas[kept]
    footprints = np.sqrt(atlas / screen)
    order = np.argsort(footprints, kind="stable")
    total = np.cumsum(screen[order])
    return float(footprints[order[np.searchsorted(total, total[-1] / 2)]])
